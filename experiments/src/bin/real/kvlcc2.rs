//! Fits KVLCC2 to the zigzags of its free-running tests and prints its turning circles beside the measured ones.
//! The recordings are not part of the project: the study file says where they are looked for.

use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use trimtab_experiments::folders::{Folder, exit};
use trimtab_experiments::real::error::RealError;
use trimtab_experiments::real::hulls::kvlcc2;
use trimtab_experiments::real::output::{write_csv, write_png};

/// Fits KVLCC2 to its zigzags and prints its turning circles beside the measured ones.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    folder: Folder,
}

fn main() -> ExitCode {
    exit("real_kvlcc2", run(&Arguments::parse().folder.path()))
}

fn run(folder: &Path) -> Result<(), RealError> {
    let outcome = kvlcc2::run()?;
    for fit in &outcome.fits {
        println!("{}", fit.report());
    }
    let table = outcome.table();
    println!("{table}");
    if let Some(asymmetry) = outcome.asymmetry() {
        println!("{asymmetry}");
    }
    write_csv(&folder.join("real_kvlcc2.csv"), &table)?;
    write_png(&folder.join("real_kvlcc2_circles.png"), &outcome.circles_figure())?;
    write_png(&folder.join("real_kvlcc2_zigzags.png"), &outcome.zigzags_figure())
}
