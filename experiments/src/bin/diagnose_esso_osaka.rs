//! Diagnoses Esso Osaka without its wind, compares the findings with the withheld anemometer, then diagnoses with the wind.
//! The recordings are not part of the project: the study file says where they are looked for.

use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use trimtab_experiments::folders::{Folder, exit};
use trimtab_experiments::real::agreement::table;
use trimtab_experiments::real::case::findings_table;
use trimtab_experiments::real::error::RealError;
use trimtab_experiments::real::frame::steps_table;
use trimtab_experiments::real::hulls::esso_osaka_diagnosed;
use trimtab_experiments::real::output::{write_csv, write_png};
use trimtab_experiments::real::pull::pulls_table;

/// Diagnoses Esso Osaka without its wind and compares the findings with the anemometer.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    folder: Folder,
}

fn main() -> ExitCode {
    exit("diagnose_esso_osaka", run(&Arguments::parse().folder.path()))
}

fn run(folder: &Path) -> Result<(), RealError> {
    let found = esso_osaka_diagnosed::run()?;
    let kinematics = table(&found.kinematics);
    let findings = findings_table(&found.cases);
    let (recordings, left) = (pulls_table(&found.pulls), pulls_table(&found.left));
    let by_session = pulls_table(&found.by_session);
    let steps = steps_table(&found.steps);
    println!("Kinematics of the recordings, without a model:\n{kinematics}");
    for case in &found.cases {
        println!("{}: {}", case.name, case.diagnosis.headline);
    }
    println!("{findings}\nQuestions asked one by one:\n{steps}");
    println!("Earth-fixed force in each session, wind withheld, beside the anemometer:\n{by_session}");
    println!("Earth-fixed force in each recording:\n{recordings}");
    println!("Earth-fixed force in each session with the measured wind in the model:\n{left}");
    println!("{}", found.agreement());
    println!("{}\n{}", found.load(), found.walk());
    write_csv(&folder.join("diagnose_esso_osaka.csv"), &findings)?;
    write_csv(&folder.join("diagnose_esso_osaka_kinematics.csv"), &kinematics)?;
    write_csv(&folder.join("diagnose_esso_osaka_sessions.csv"), &by_session)?;
    write_csv(&folder.join("diagnose_esso_osaka_recordings.csv"), &recordings)?;
    write_csv(&folder.join("diagnose_esso_osaka_left.csv"), &left)?;
    write_csv(&folder.join("diagnose_esso_osaka_steps.csv"), &steps)?;
    write_png(&folder.join("diagnose_esso_osaka.png"), &found.figure())
}
