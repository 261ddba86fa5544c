//! Diagnoses KVLCC2 from its zigzags in a calm basin and proves the findings on its turning circles.
//! The recordings are not part of the project: the study file says where they are looked for.

use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use trimtab_experiments::folders::{Folder, exit};
use trimtab_experiments::real::agreement::table;
use trimtab_experiments::real::case::{findings_table, sides_table};
use trimtab_experiments::real::error::RealError;
use trimtab_experiments::real::frame::steps_table;
use trimtab_experiments::real::hulls::kvlcc2_diagnosed;
use trimtab_experiments::real::output::{write_csv, write_png};

/// Diagnoses KVLCC2 from its zigzags and proves the findings on its turning circles.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    folder: Folder,
}

fn main() -> ExitCode {
    exit("diagnose_kvlcc2", run(&Arguments::parse().folder.path()))
}

fn run(folder: &Path) -> Result<(), RealError> {
    let found = kvlcc2_diagnosed::run()?;
    let kinematics = table(&found.kinematics);
    let (findings, steps, sides) = (findings_table(&found.cases), steps_table(&found.steps), sides_table(&found.cases));
    println!("Kinematics of the recordings, without a model:\n{kinematics}");
    for case in &found.cases {
        println!("{}: {}", case.name, case.diagnosis.headline);
    }
    println!("{findings}\nPort and starboard of the ship:\n{sides}");
    println!("Added to a mirror-symmetric ship, one by one:\n{steps}");
    println!("{}\n{}", found.basin(), found.screw());
    write_csv(&folder.join("diagnose_kvlcc2.csv"), &findings)?;
    write_csv(&folder.join("diagnose_kvlcc2_kinematics.csv"), &kinematics)?;
    write_csv(&folder.join("diagnose_kvlcc2_steps.csv"), &steps)?;
    write_csv(&folder.join("diagnose_kvlcc2_sides.csv"), &sides)?;
    write_png(&folder.join("diagnose_kvlcc2.png"), &found.figure())
}
