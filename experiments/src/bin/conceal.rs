//! Makes one concealed case: recordings with an effect that is concealed from the diagnosis, and the sealed manifest beside them.
//! It judges nothing; `judge` opens the seal afterwards, and `campaign` does both for many cases.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use trimtab_experiments::conceal::case::Case;
use trimtab_experiments::conceal::effects::catalogue::catalogue;
use trimtab_experiments::conceal::error::ConcealError;
use trimtab_experiments::conceal::family::Family;
use trimtab_experiments::conceal::meter::DiagnosisMeter;
use trimtab_experiments::conceal::sailing::design::Design;
use trimtab_experiments::conceal::spec::{Background, Spec, Strength};
use trimtab_experiments::folders::exit;

/// Writes recordings with a concealed effect into OUT/study, and its sealed manifest into OUT/sealed.
#[derive(Parser)]
struct Arguments {
    /// Equations of the truth.
    #[arg(long, value_enum, default_value = "hd")]
    family: Family,
    /// Effect to conceal; several for a compound case, none for a null.
    #[arg(long)]
    effect: Vec<String>,
    /// Signal-to-noise ratio to reach, for every effect.
    #[arg(long, conflicts_with = "size")]
    snr: Option<f64>,
    /// Physical size, in the unit of the effect; once for every effect.
    #[arg(long)]
    size: Vec<f64>,
    /// Sea and sensors beside the effect.
    #[arg(long, value_enum, default_value = "ordinary")]
    background: Background,
    /// Which runs are recorded.
    #[arg(long, value_enum, default_value = "standard")]
    design: Design,
    /// Let the effects act in the second half of the sessions only.
    #[arg(long)]
    contrast: bool,
    /// Seed.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Folder for the case.
    #[arg(long, required_unless_present = "list")]
    out: Option<PathBuf>,
    /// List the effects and stop.
    #[arg(long)]
    list: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if arguments.list {
        for e in catalogue() {
            println!("{:14} {:9} {:>8} {:6} {}", e.name, format!("{:?}", e.class), e.size, e.unit, e.law);
        }
        return ExitCode::SUCCESS;
    }
    exit("conceal", run(&arguments).map(|study| println!("{}", study.display())))
}

fn run(a: &Arguments) -> Result<PathBuf, ConcealError> {
    let strength = |i: usize| match (a.snr, a.size.get(i)) {
        (Some(snr), _) => Strength::Snr(snr),
        (None, Some(size)) => Strength::Size(*size),
        (None, None) => Strength::Times(1.0),
    };
    let spec = Spec {
        family: a.family,
        effects: a.effect.iter().enumerate().map(|(i, name)| (name.clone(), strength(i))).collect(),
        background: a.background,
        design: a.design,
        contrast: a.contrast,
        seed: a.seed,
    };
    let out = a.out.clone().unwrap_or_default();
    Case::make(&spec, &DiagnosisMeter::new(spec.family)?)?.write(&out)
}
