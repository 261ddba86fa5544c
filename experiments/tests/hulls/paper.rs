//! The paper's tables and figures on a small part of ship A's data set: they repeat, they are complete, and the fit gains.
//! The gains on the whole data set are printed by the binary `paper` and asserted nowhere.

use std::collections::BTreeMap;
use std::path::Path;
use trimtab::fit::solver::constraints;
use trimtab::physics::Form;
use trimtab::report::Table;
use trimtab::report::plot::{Axis, Figure, Format, Panel, Width};
use trimtab::simulate::Integration;
use trimtab_experiments::paper::case::{Case, Setup, initial_model};
use trimtab_experiments::paper::list::ARTEFACTS;
use trimtab_experiments::paper::published::published;
use trimtab_experiments::paper::target::Target;
use trimtab_experiments::truth::dataset::{Run, dataset};
use trimtab_experiments::truth::ships::ShipId;

/// Every fifth run, fitted with one Euler step a sample.
fn small_case(runs: &[Run]) -> Case {
    let mut setup = Setup::default();
    setup.fit.integration = Integration::default();
    Case::from_runs(ShipId::A, runs.iter().step_by(5).cloned().collect(), setup).unwrap()
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    entries.map(|p| (p.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(&p).unwrap())).collect()
}

#[test]
fn tables_and_figures_repeat_bit_by_bit_on_one_and_on_two_threads() {
    let runs = dataset(ShipId::A, Setup::default().seed);
    let make = |threads: usize| {
        let folder = tempfile::tempdir().unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let text: Vec<String> = pool.install(|| {
            let cases = [small_case(&runs)];
            // The last two make many fits and share their code with these.
            ARTEFACTS[..6]
                .iter()
                .map(|artefact| (artefact.make)(&cases, &Target::new(folder.path())).unwrap())
                .collect()
        });
        (text, files(folder.path()))
    };
    let (text, made) = make(1);
    assert_eq!((&text, &made), (&make(2).0, &make(2).1));
    for (name, content) in &made {
        assert!(!content.is_empty(), "{name}");
        if name.ends_with(".png") {
            assert!(made.contains_key(&name.replace(".png", ".csv")), "{name} has no CSV");
        } else {
            let content = String::from_utf8(content.clone()).unwrap();
            assert!(content.lines().count() > 1 && !content.contains("NaN"), "{name}");
        }
    }
    assert!(text.iter().all(|t| !t.contains("NaN")));
}

#[test]
fn a_fit_from_the_infeasible_guess_converges_keeps_the_constraints_and_gains_on_held_out_runs() {
    let case = small_case(&dataset(ShipId::A, Setup::default().seed));
    assert!(case.fit.converged, "{}", case.fit.status);
    let speeds = constraints::speed_range(&case.training());
    let limits = &case.setup.fit.constraints;
    let p = |model: &trimtab::model::Model| -> Vec<f64> {
        model.free().iter().map(|i| model.parameters[*i].value).collect()
    };
    for row in constraints::rows(&case.fit.model, limits, speeds).unwrap() {
        let size = row.lower.abs().min(row.upper.abs()).max(1e-2);
        assert!(row.violation(&p(&case.fit.model)) < 1e-5 * size, "{}", row.sentence(&p(&case.fit.model)));
    }
    let guess = initial_model(ShipId::A, Form::Paper).unwrap();
    let broken = |row: &constraints::Row| row.violation(&p(&guess)) > 1e-3;
    assert!(constraints::rows(&guess, limits, speeds).unwrap().iter().any(broken));
    let evaluation = case.evaluate(&case.published_baseline);
    let gain = evaluation.summary("test").unwrap().cvdm_improvement.unwrap().value;
    assert!(gain > published(ShipId::A).cvdm_improvement, "{gain}");
}

#[test]
fn figures_are_drawn_in_the_formats_that_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let target =
        Target { formats: vec![Format::Pdf, Format::Svg], width: Some(Width::Two), ..Target::new(folder.path()) };
    let figure = Figure::new("R(u)").with(Panel::new("", Axis::new("u [m/s]"), Axis::new("R [kN]")));
    target.figure("figure2", figure).unwrap();
    let mut table = Table::new(["ship", "R [kN]"]);
    table.row(["A", "12"]);
    target.table("table1", &table).unwrap();
    Target { latex: true, ..target }.table("table2", &table).unwrap();
    let made = files(folder.path());
    assert_eq!(made.keys().collect::<Vec<_>>(), ["figure2.csv", "figure2.pdf", "figure2.svg", "table2.tex"]);
    assert!(String::from_utf8_lossy(&made["table2.tex"]).contains("\\toprule"));
    assert!(made["figure2.pdf"].starts_with(b"%PDF") && made["figure2.svg"].starts_with(b"<svg"));
}
