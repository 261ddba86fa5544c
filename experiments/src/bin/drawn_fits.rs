//! Makes fits of studies drawn at random, a row a fit, and counts those that did not end by themselves.
//! A fit that has a row is not made again, so that a campaign that was killed continues.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use trimtab::report::Table;
use trimtab_experiments::conceal::error::ConcealError;
use trimtab_experiments::drawn_fits::{Row, Source, drawn, own};
use trimtab_experiments::folders::exit;
use trimtab_experiments::rows::Rows;

/// Makes fits of studies drawn at random and counts those that do not end within a minute.
#[derive(Parser)]
struct Arguments {
    /// Folder for the results (`fits.csv`).
    #[arg(long)]
    out: PathBuf,
    /// Study files to draw from beside the two of the program itself.
    #[arg(long, num_args = 0..)]
    study: Vec<PathBuf>,
    /// Fits.
    #[arg(long, default_value_t = 500)]
    fits: usize,
    /// Seed.
    #[arg(long, default_value_t = 20_261_126)]
    seed: u64,
}

fn main() -> ExitCode {
    exit("drawn_fits", run(&Arguments::parse()))
}

fn run(a: &Arguments) -> Result<(), ConcealError> {
    let folder = a.out.join("studies");
    let paths = own(&folder)?;
    let sources = paths.iter().chain(&a.study).map(|path| Source::read(path)).collect::<Result<Vec<_>, _>>()?;
    let results: Rows<Row> = Rows::open(&a.out.join("fits.csv"))?;
    eprintln!("seed {}: {} fits of {} studies, {} done", a.seed, a.fits, sources.len(), results.rows.len());
    for case in results.rows.len()..a.fits {
        results.append(&drawn(&sources, a.seed, case)?)?;
    }
    println!("{}", table(&Rows::read(results.path())?));
    // Studies that cannot be removed do no harm.
    let _ = std::fs::remove_dir_all(&folder);
    Ok(())
}

/// Counts by objective.
fn table(rows: &[Row]) -> Table {
    let mut table = Table::new(["objective", "fits", "converged", "not ended", "median s", "longest s"]);
    for objective in ["trajectory", "likelihood", "all"] {
        let some: Vec<&Row> = rows.iter().filter(|r| objective == "all" || r.objective == objective).collect();
        let mut seconds: Vec<f64> = some.iter().map(|r| r.seconds).collect();
        seconds.sort_by(f64::total_cmp);
        let at = |i: usize| seconds.get(i).map_or_else(String::new, |s| format!("{s:.2}"));
        table.row([
            objective.to_owned(),
            some.len().to_string(),
            some.iter().filter(|r| r.converged).count().to_string(),
            some.iter().filter(|r| !r.ended).count().to_string(),
            at(seconds.len() / 2),
            at(seconds.len().saturating_sub(1)),
        ]);
    }
    table
}
