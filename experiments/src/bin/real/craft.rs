//! Fits two small craft with actuators of their own and judges the fits on recordings that they have not seen, beside steady motion.
//! The recordings are not part of the project: see the study files.

use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use trimtab_experiments::folders::{Folder, exit};
use trimtab_experiments::real::error::RealError;
use trimtab_experiments::real::hulls::craft::{self, STUDIES};
use trimtab_experiments::real::output::{write_csv, write_png};

/// Fits a catamaran with two thrusters and a tug with Voith-Schneider propellers, and judges the fits on unseen recordings.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    folder: Folder,
}

fn main() -> ExitCode {
    exit("real_craft", run(&Arguments::parse().folder.path()))
}

fn run(folder: &Path) -> Result<(), RealError> {
    for study in STUDIES {
        let judged = craft::run(study)?;
        println!("{}", judged.fit.report());
        let table = judged.table();
        println!("{table}");
        write_csv(&folder.join(format!("real_{}.csv", study.0)), &table)?;
        write_png(&folder.join(format!("real_{}.png", study.0)), &judged.figure())?;
    }
    Ok(())
}
