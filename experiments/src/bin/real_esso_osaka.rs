//! Fits Esso Osaka to training runs and prints the errors on test runs beside those of two baselines.
//! The recordings are not part of the project: the study file says where they are looked for.

use std::process::ExitCode;
use trimtab_experiments::folders::figures;
use trimtab_experiments::real::error::RealError;
use trimtab_experiments::real::esso_osaka;
use trimtab_experiments::real::output::{write_csv, write_png};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("real_esso_osaka: {error}");
            ExitCode::from(2)
        }
    }
}

fn run() -> Result<(), RealError> {
    let judged = esso_osaka::run(&esso_osaka::FITTED_MODELS, 1)?;
    for fit in &judged.fits {
        println!("{}", fit.report());
    }
    println!("{} windows of training runs; mean cVDM [%] on test windows:", judged.train);
    let (cvdm, gain) = (judged.cvdm_table(), judged.gain_table());
    println!("{cvdm}\n{gain}");
    write_csv(&figures().join("real_esso_osaka.csv"), &cvdm)?;
    write_csv(&figures().join("real_esso_osaka_gain.csv"), &gain)?;
    write_png(&figures().join("real_esso_osaka.png"), &judged.cvdm_figure())?;
    write_png(&figures().join("real_esso_osaka_windows.png"), &judged.windows_figure())
}
