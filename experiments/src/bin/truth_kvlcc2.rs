//! Prints the trials of KVLCC2 under the standard MMG simulator beside a reference simulation and beside the model tests.
//! It checks nothing: the tests of the simulator do.

use clap::Parser;
use comfy_table::{Table, presets};
use trimtab_experiments::truth::reference::{
    MARIN_OVERSHOOTS, MARIN_PORT, MARIN_STARBOARD, Reference, ZIGZAGS, references,
};
use trimtab_experiments::truth::trial::{Approach, turning, zigzag};

/// One line of the table: ours at a fine step and at the step of the reference, reference, model test.
struct Line {
    what: String,
    ours: [Option<f64>; 2],
    reference: f64,
    tested: Option<f64>,
}

/// Prints the trials of KVLCC2 beside a reference simulation and beside the model tests.
#[derive(Parser)]
struct Arguments {}

fn main() {
    Arguments::parse();
    for reference in references() {
        println!("{}\n", table(&reference));
    }
    println!(
        "Reference: the same equations stepped by 0.5 s (full scale). Its rudder reverses at whole steps, up to 0.5 s late, so \
         \"0.5 s\" is the column to compare, and \"0.05 s\" the answer of the equations.\n\
         Model tests: MARIN for SIMMAN 2008, advance from the moment the rudder moves. The distance to them is that of the \
         published parameters, not of this code."
    );
}

fn table(reference: &Reference) -> Table {
    let mut table = Table::new();
    table.load_style(presets::UTF8_FULL_CONDENSED);
    let title = format!("KVLCC2, {}", reference.title);
    table.set_header([title.as_str(), "0.05 s", "0.5 s", "reference", "off reference", "model test", "off model test"]);
    let text = |x: Option<f64>| x.map_or("not reached".to_owned(), |x| format!("{x:.3}"));
    let off = |what: &str, x: Option<f64>, from: Option<f64>| match (x, from) {
        (Some(x), Some(from)) if what.contains("[deg]") => format!("{:+.2} deg", x - from),
        (Some(x), Some(from)) => format!("{:+.2} %", 100.0 * (x / from - 1.0)),
        _ => "-".to_owned(),
    };
    let steps = [0.05, 0.5].map(|step| reference.approach(step));
    let rate = Line {
        what: "propeller rate [rps]".to_owned(),
        ours: steps.map(|a| Some(a.n)),
        reference: reference.rate,
        tested: None,
    };
    for line in [rate].into_iter().chain(turns(reference, steps)).chain(zigzags(reference, steps)) {
        let [fine, same] = line.ours;
        table.add_row([
            line.what.clone(),
            text(fine),
            text(same),
            line.reference.to_string(),
            off(&line.what, same, Some(line.reference)),
            line.tested.map_or("-".to_owned(), |x| x.to_string()),
            off(&line.what, fine, line.tested),
        ]);
    }
    table
}

fn turns(r: &Reference, steps: [Approach; 2]) -> Vec<Line> {
    let circle = |degrees: f64| steps.map(|a| turning(&r.ship, &a, degrees.to_radians()).map(|t| t.measures()));
    let line = |degrees: f64, i: usize, ours: [Option<[f64; 7]>; 2], reference: f64, tested: Option<f64>| Line {
        what: format!("turn {degrees:+.0} deg: {}", MARIN_STARBOARD[i].0),
        ours: ours.map(|m| m.map(|m| m[i])),
        reference,
        tested,
    };
    let (starboard, port) = (circle(35.0), circle(-35.0));
    let right = (0..7).map(|i| line(35.0, i, starboard, r.starboard[i], MARIN_STARBOARD[i].1));
    let left = MARIN_PORT
        .into_iter()
        .zip(r.port)
        .map(|((i, tested), reference)| line(-35.0, i, port, reference, Some(tested)));
    right.chain(left).collect()
}

fn zigzags(r: &Reference, steps: [Approach; 2]) -> Vec<Line> {
    let mut lines = Vec::new();
    for (i, order) in ZIGZAGS.into_iter().enumerate() {
        let runs = steps.map(|a| zigzag(&r.ship, &a, order.to_radians()));
        let side = if order > 0.0 { "starboard" } else { "port" };
        lines.extend((0..2).map(|k| Line {
            what: format!("zigzag {0:.0}/{0:.0}, {side} first: overshoot {1} [deg]", order.abs(), k + 1),
            ours: runs.map(|run| run.map(|overshoots| overshoots[k].to_degrees())),
            reference: r.overshoots[i][k],
            tested: Some(MARIN_OVERSHOOTS[i][k]),
        }));
    }
    lines
}
