//! Fits KVLCC2 to the zigzags of its free-running tests and prints its turning circles beside the measured ones.
//! The recordings are not part of the project: the study file says where they are looked for.

use std::process::ExitCode;
use trimtab_experiments::folders::figures;
use trimtab_experiments::real::error::RealError;
use trimtab_experiments::real::kvlcc2;
use trimtab_experiments::real::output::{write_csv, write_png};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("real_kvlcc2: {error}");
            ExitCode::from(2)
        }
    }
}

fn run() -> Result<(), RealError> {
    let outcome = kvlcc2::run()?;
    for fit in &outcome.fits {
        println!("{}", fit.report());
    }
    let table = outcome.table();
    println!("{table}");
    if let Some(asymmetry) = outcome.asymmetry() {
        println!("{asymmetry}");
    }
    write_csv(&figures().join("real_kvlcc2.csv"), &table)?;
    write_png(&figures().join("real_kvlcc2_circles.png"), &outcome.circles_figure())?;
    write_png(&figures().join("real_kvlcc2_zigzags.png"), &outcome.zigzags_figure())
}
