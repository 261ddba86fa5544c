//! The concealed case of `trimtab demo`: forty trials of ship A under an effect that no file of the study names, with sensor noise.
//! The effect and its size are fixed here, before any diagnosis; the library embeds the recordings and, apart from them, the answer.

use crate::conceal::effects::catalogue::find;
use crate::conceal::effects::effect::Entry;
use crate::conceal::family::Family;
use crate::conceal::sailing::craft::Craft;
use crate::conceal::sailing::design::{Design, Plan, plans};
use crate::conceal::sailing::noise::{Noise, Rows};
use crate::conceal::sailing::recorded::activate;
use crate::conceal::sailing::sail::{Active, Method, World, sail};
use crate::conceal::sailing::track::{PERIOD, Track};
use crate::conceal::spec::Spec;
use crate::truth::dataset::SEED;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::fmt::Write;

/// Runs recorded, on four days.
pub const RUNS: usize = 40;
/// Runs of a day.
const A_DAY: usize = 10;
/// Manoeuvres sailed: what a trial programme has, without stops and slow runs.
const SAILED: [&str; 3] = ["turn", "zigzag", "steps"];
/// The equations that made the recordings.
const FAMILY: Family = Family::Mmg;
/// What is concealed, by its name in the catalogue of effects.
const EFFECT: &str = "current";
/// Its size \[m/s\]: half a knot.
const SIZE: f64 = 0.26;
/// Standard deviations of light gusts: X, Y \[N\], N \[N m\].
const GUSTS: [f64; 3] = [800.0, 800.0, 24_000.0];

/// Random streams, a purpose each.
fn stream(number: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    rng.set_stream(number);
    rng
}

/// The plans: those of as many concealed cases as it takes, the manoeuvres that are sailed, every fourth run to test on.
fn programme(craft: &Craft) -> Vec<Plan> {
    let drawn = (0..).flat_map(|case| plans(Design::Standard, craft, FAMILY.pace(), &mut stream(10 + case)));
    let sailed = drawn.filter(|plan| SAILED.contains(&plan.manoeuvre)).take(RUNS).enumerate();
    let placed = |(i, plan): (usize, Plan)| Plan {
        name: format!("trial_{:02}", i + 1),
        session: i / A_DAY,
        test: i % 4 == 3,
        clock: 0.0,
        ..plan
    };
    sailed.map(placed).collect()
}

/// The files: name within the library's `src/study/demo`, and content. Nothing where the catalogue has no such effect.
pub fn files() -> Option<[(&'static str, String); 3]> {
    let entry: &'static Entry = find(EFFECT)?;
    let spec = Spec::null(FAMILY, SEED);
    let effect: Active = activate(&spec, entry, 0, SIZE);
    let truth: Vec<f64> = effect.physics.truth().iter().map(|(_, value, _)| *value).collect();
    let world = World {
        craft: Craft::draw(FAMILY, 0.0, &mut stream(0)),
        effects: vec![effect],
        gusts: GUSTS,
        method: Method::RungeKutta,
    };
    let noise = Noise { dropouts: 0.0, ..Noise::ordinary(&mut stream(1)) };
    let mut runs = String::from("file,name,session,manoeuvre,split\n");
    let mut rows = String::from("run,t [s],x [m],y [m],psi [deg],u [m/s],v [m/s],r [deg/min],n [rpm],delta [deg]\n");
    for (i, plan) in programme(&world.craft).iter().enumerate() {
        let track = sail(&world, plan, i, stream(1_000 + i as u64));
        let reported = noise.apply(&track.reported, &mut stream(2_000 + i as u64));
        let split = if plan.test { "test" } else { "train" };
        // Writing to a string cannot fail.
        let _ =
            writeln!(runs, "recordings/{0}.csv,{0},day {1},{2},{split}", plan.name, plan.session + 1, plan.manoeuvre);
        write_rows(&mut rows, &plan.name, &track, &reported);
    }
    let [north, east] = truth[..] else { return None };
    let towards = east.atan2(north).to_degrees().rem_euclid(360.0);
    let answer = format!(
        "# What the recordings of the demo conceal. `trimtab demo` reads it when the diagnosis is done, and never writes it.\n\
         effect = \"{EFFECT}\"\naccepted = {:?}\nwords = \"a steady current of {SIZE} m/s towards {towards:.0} deg\"\n\
         [sizes]\n\"{EFFECT}.north\" = {north:.4}\n\"{EFFECT}.east\" = {east:.4}\n",
        entry.accepted,
    );
    Some([("trials/runs.csv", runs), ("trials/recordings.csv", rows), ("trials/concealed.toml", answer)])
}

/// The rows of a run, in the units and with the digits of ordinary loggers.
fn write_rows(text: &mut String, name: &str, track: &Track, reported: &Rows) {
    for (i, (row, order)) in reported.iter().zip(&track.orders).enumerate() {
        let Some([x, y, psi, u, v, r]) = row else { continue };
        let heading = psi.to_degrees().rem_euclid(360.0);
        let (rate, helm, shaft) = (r.to_degrees() * 60.0, order.delta.to_degrees(), order.n * 60.0);
        let _ = writeln!(
            text,
            "{name},{},{x:.2},{y:.2},{heading:.2},{u:.3},{v:.3},{rate:.2},{shaft:.1},{helm:.1}",
            i as f64 * PERIOD
        );
    }
}

#[cfg(test)]
mod tests {
    use super::files;
    use std::path::Path;

    #[test]
    fn the_embedded_trials_are_those_that_are_generated() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src/study/demo");
        for (name, text) in files().expect("the effect is in the catalogue") {
            let embedded = std::fs::read_to_string(folder.join(name)).expect("the file is committed");
            assert!(
                embedded == text,
                "{name} differs; run `cargo run --release -p trimtab-experiments --bin demo_data`"
            );
        }
    }
}
