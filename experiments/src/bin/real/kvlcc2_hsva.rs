//! Fits KVLCC2 to nine zigzags of its 7 m model and prints four others beside the measured ones; with `--repeat`, also the
//! freed fit from other starts and under other limits. The recordings are not part of the project: see the study file.

use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use trimtab_experiments::folders::{Folder, exit};
use trimtab_experiments::real::error::RealError;
use trimtab_experiments::real::hulls::kvlcc2_hsva::{self, LIMITS, STARTS, repeats_table};
use trimtab_experiments::real::output::{write_csv, write_png};

/// Fits KVLCC2 to nine zigzags of its 7 m model and prints four others beside the measured ones.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    folder: Folder,
    /// Repeat the freed fit from other starts and under other limits of the resistance.
    #[arg(long)]
    repeat: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    exit("real_kvlcc2_hsva", run(&arguments.folder.path(), arguments.repeat))
}

fn run(folder: &Path, repeat: bool) -> Result<(), RealError> {
    let predicted = kvlcc2_hsva::run()?;
    for fit in &predicted.trials.fits {
        println!("{}", fit.report());
    }
    let (overshoots, errors) = (predicted.trials.table(), predicted.cvdm_table());
    println!("{overshoots}\n{errors}");
    write_csv(&folder.join("real_kvlcc2_hsva.csv"), &overshoots)?;
    write_csv(&folder.join("real_kvlcc2_hsva_cvdm.csv"), &errors)?;
    write_png(&folder.join("real_kvlcc2_hsva.png"), &predicted.figure())?;
    if repeat {
        let repeats = kvlcc2_hsva::repeat(&LIMITS, STARTS, |limit| eprintln!("limit of R: {limit:?} N"))?;
        let table = repeats_table(&repeats);
        println!("{table}");
        write_csv(&folder.join("real_kvlcc2_hsva_starts.csv"), &table)?;
    }
    Ok(())
}
