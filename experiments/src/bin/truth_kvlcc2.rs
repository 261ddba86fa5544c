//! Prints the trials of KVLCC2 under the standard MMG simulator beside a reference simulation and beside the model tests.
//! It checks nothing: the tests of the simulator do.

// An advance of 3.142 ship lengths is not pi.
#![allow(clippy::approx_constant)]

use comfy_table::{Table, presets};
use trimtab_experiments::truth::mmg::Mmg;
use trimtab_experiments::truth::ships::{kvlcc2, kvlcc2_model};
use trimtab_experiments::truth::trial::{Approach, Turning, turning, zigzag};
use trimtab_experiments::truth::trimmed_rate;

/// Zigzags: rudder and heading \[deg\], sign of the first execute.
const ZIGZAGS: [f64; 4] = [10.0, -10.0, 20.0, -20.0];
/// Free-running model tests of MARIN for SIMMAN 2008, in the order of [`ZIGZAGS`] \[deg\].
const TESTED_OVERSHOOTS: [[f64; 2]; 4] = [[8.2, 21.9], [9.5, 15.0], [13.7, 14.9], [15.1, 13.3]];
/// The same: advance and tactical diameter \[L\] of the 35 deg turn, starboard then port.
const TESTED_TURNS: [[f64; 2]; 2] = [[3.10, 3.33], [3.02, 3.07]];

/// A scale of the ship, with a reference simulation: the same equations by RK4 at 0.5 s full scale.
struct Case {
    title: &'static str,
    ship: Mmg,
    speed: f64,
    reference_rate: f64,
    reference_starboard: [f64; 7],
    reference_port: [f64; 2],
    reference_overshoots: [[f64; 2]; 4],
}

/// One line of the table: ours at a fine step and at the step of the reference, reference, model test.
struct Line {
    what: String,
    fine: Option<f64>,
    same: Option<f64>,
    reference: f64,
    is_angle: bool,
    tested: Option<f64>,
}

fn main() {
    let cases = [
        Case {
            title: "7 m model",
            ship: kvlcc2_model(),
            speed: 1.179,
            reference_rate: 11.834,
            reference_starboard: [3.132, 1.327, 3.113, 2.315, 0.381, 19.1, 0.864],
            reference_port: [3.142, 3.099],
            reference_overshoots: [[5.5, 15.0], [7.8, 9.7], [12.1, 17.5], [15.8, 13.1]],
        },
        Case {
            title: "full scale, 320 m",
            ship: kvlcc2(),
            speed: 7.97,
            reference_rate: 1.7785,
            reference_starboard: [3.029, 1.272, 3.006, 2.247, 0.377, 19.4, 0.890],
            reference_port: [3.053, 3.015],
            reference_overshoots: [[5.5, 14.2], [7.6, 9.3], [12.0, 16.9], [15.6, 12.9]],
        },
    ];
    for case in &cases {
        println!("{}\n", table(case));
    }
    println!(
        "Reference: the same equations stepped by 0.5 s (full scale). Its rudder reverses at whole steps, up to 0.5 s late, so \
         \"0.5 s\" is the column to compare, and \"0.05 s\" the answer of the equations.\n\
         Model tests: MARIN for SIMMAN 2008, advance from the moment the rudder moves. The distance to them is that of the \
         published parameters, not of this code."
    );
}

fn table(case: &Case) -> Table {
    let mut table = Table::new();
    table.load_style(presets::UTF8_FULL_CONDENSED);
    let title = format!("KVLCC2, {}", case.title);
    table.set_header([title.as_str(), "0.05 s", "0.5 s", "reference", "off reference", "model test", "off model test"]);
    let text = |x: Option<f64>| x.map_or("not reached".to_owned(), |x| format!("{x:.3}"));
    let off = |line: &Line, x: Option<f64>, from: Option<f64>| match (x, from) {
        (Some(x), Some(from)) if line.is_angle => format!("{:+.2} deg", x - from),
        (Some(x), Some(from)) => format!("{:+.2} %", 100.0 * (x / from - 1.0)),
        _ => "-".to_owned(),
    };
    for line in lines(case) {
        table.add_row([
            line.what.clone(),
            text(line.fine),
            text(line.same),
            line.reference.to_string(),
            off(&line, line.same, Some(line.reference)),
            line.tested.map_or("-".to_owned(), |x| x.to_string()),
            off(&line, line.fine, line.tested),
        ]);
    }
    table
}

fn lines(case: &Case) -> Vec<Line> {
    let scale = (case.ship.particulars.length / 320.0).sqrt();
    let n = trimmed_rate(&case.ship, case.speed, 20.0);
    let approach =
        |step: f64| Approach { speed: case.speed, n, rudder_rate: 1.76_f64.to_radians() / scale, step: step * scale };
    let mut lines = vec![Line {
        what: "propeller rate [rps]".to_owned(),
        fine: Some(n),
        same: Some(n),
        reference: case.reference_rate,
        is_angle: false,
        tested: None,
    }];

    let circle = |side: f64, step: f64| turning(&case.ship, &approach(step), side * 35.0_f64.to_radians());
    type Measure = fn(&Turning) -> f64;
    let [starboard, port] = TESTED_TURNS;
    let measures: [(&str, Measure, Option<f64>); 7] = [
        ("advance [L]", |t| t.advance, Some(starboard[0])),
        ("transfer [L]", |t| t.transfer, None),
        ("tactical diameter [L]", |t| t.tactical_diameter, Some(starboard[1])),
        ("steady diameter [L]", |t| t.steady_diameter, None),
        ("steady U/U0", |t| t.speed_ratio, Some(0.375)),
        ("steady drift [deg]", |t| t.drift.to_degrees(), Some(19.0)),
        ("steady r L/U", |t| t.yaw_rate, None),
    ];
    let (fine, same) = (circle(1.0, 0.05), circle(1.0, 0.5));
    for ((what, measure, tested), reference) in measures.into_iter().zip(case.reference_starboard) {
        lines.push(Line {
            what: format!("turn +35 deg: {what}"),
            fine: fine.as_ref().map(measure),
            same: same.as_ref().map(measure),
            reference,
            is_angle: what.contains("deg"),
            tested,
        });
    }
    let (fine, same) = (circle(-1.0, 0.05), circle(-1.0, 0.5));
    for ((what, measure, _), (reference, tested)) in
        [measures[0], measures[2]].into_iter().zip(case.reference_port.into_iter().zip(port))
    {
        lines.push(Line {
            what: format!("turn -35 deg: {what}"),
            fine: fine.as_ref().map(measure),
            same: same.as_ref().map(measure),
            reference,
            is_angle: false,
            tested: Some(tested),
        });
    }

    for (i, order) in ZIGZAGS.into_iter().enumerate() {
        let run = |step: f64| zigzag(&case.ship, &approach(step), order.to_radians());
        let (fine, same) = (run(0.05), run(0.5));
        let side = if order > 0.0 { "starboard" } else { "port" };
        for k in 0..2 {
            let degrees = |run: &Option<[f64; 2]>| run.map(|overshoots| overshoots[k].to_degrees());
            lines.push(Line {
                what: format!("zigzag {0:.0}/{0:.0}, {side} first: overshoot {1} [deg]", order.abs(), k + 1),
                fine: degrees(&fine),
                same: degrees(&same),
                reference: case.reference_overshoots[i][k],
                is_angle: true,
                tested: Some(TESTED_OVERSHOOTS[i][k]),
            });
        }
    }
    lines
}
