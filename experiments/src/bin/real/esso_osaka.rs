//! Fits Esso Osaka to training runs and prints the errors on test runs beside those of two baselines.
//! The recordings are not part of the project: the study file says where they are looked for.

use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use trimtab_experiments::folders::{Folder, exit};
use trimtab_experiments::real::error::RealError;
use trimtab_experiments::real::hulls::esso_osaka;
use trimtab_experiments::real::output::{write_csv, write_png};

/// Fits Esso Osaka and prints the errors on test runs beside those of two baselines.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    folder: Folder,
}

fn main() -> ExitCode {
    exit("real_esso_osaka", run(&Arguments::parse().folder.path()))
}

fn run(folder: &Path) -> Result<(), RealError> {
    let judged = esso_osaka::run(&esso_osaka::FITTED_MODELS, 1)?;
    for fit in &judged.fits {
        println!("{}", fit.report());
    }
    println!("{} windows of training runs; mean cVDM [%] on test windows:", judged.train);
    let (cvdm, gain) = (judged.cvdm_table(), judged.gain_table());
    println!("{cvdm}\n{gain}");
    write_csv(&folder.join("real_esso_osaka.csv"), &cvdm)?;
    write_csv(&folder.join("real_esso_osaka_gain.csv"), &gain)?;
    write_png(&folder.join("real_esso_osaka.png"), &judged.cvdm_figure())?;
    write_png(&folder.join("real_esso_osaka_windows.png"), &judged.windows_figure())
}
