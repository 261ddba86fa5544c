//! How much of the data lies outside the ranges over which the laws of a model's terms are valid, by term and quantity.
//! It reports and judges nothing: a fit to data outside a range may be as good as any, and need not be valid anywhere else.

use crate::dynamics::Dynamics;
use crate::model::Model;
use crate::physics::{Flow, Form, Quantity, Validity, range_in_words};
use crate::ranks::Ranks;
use crate::recording::{Run, or_nan};
use crate::state::{Inputs, STATES, State};
use crate::units::GRAVITY;
use serde::Serialize;
use std::borrow::Borrow;

/// Samples outside the range of one term in one quantity.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outside {
    /// Name of the term.
    pub term: &'static str,
    /// The quantity.
    pub quantity: Quantity,
    /// Its range, widened by other terms of the model where they model what this one leaves out; absent where open.
    pub range: [Option<f64>; 2],
    /// Samples at which the quantity is known.
    pub samples: usize,
    /// Share of these outside the range.
    pub share: f64,
    /// Smallest and largest value met outside.
    pub met: [f64; 2],
}

/// The range of one term in one quantity, with the values that the data visit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Visit {
    /// Name of the term.
    pub term: &'static str,
    /// The quantity.
    pub quantity: Quantity,
    /// Its range, widened by other terms of the model where they model what this one leaves out; absent where open.
    pub range: [Option<f64>; 2],
    /// Samples at which the quantity is known.
    pub samples: usize,
    /// Smallest and largest value there; absent where none is known or where it is infinite (deep water).
    pub visited: [Option<f64>; 2],
    /// Share of these samples outside the range.
    pub share_outside: f64,
}

/// How much of the data lies outside the ranges of a model's terms.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Coverage {
    /// Samples looked at.
    pub samples: usize,
    /// Share of these outside the range of at least one term.
    pub share_outside: f64,
    /// What is outside, the largest share first; empty where all samples are inside.
    pub outside: Vec<Outside>,
}

/// One range to check, with what was met so far.
struct Limit {
    term: &'static str,
    quantity: Quantity,
    range: [f64; 2],
    known: usize,
    beyond: usize,
    met: [f64; 2],
    /// Smallest and largest value, inside and outside.
    visited: [f64; 2],
}

/// Samples counted against the ranges of a model's terms, some at a time.
pub struct Count<'a> {
    dynamics: Dynamics<'a, f64>,
    scales: Scales,
    limits: Vec<Limit>,
    /// The quantities that the limits are about, each once, and the place of each limit's own among them.
    quantities: Vec<Quantity>,
    places: Vec<usize>,
    samples: usize,
    anywhere: usize,
}

impl<'a> Count<'a> {
    /// Nothing counted yet, with the parameters as the model has them.
    pub fn new(model: &'a Model) -> Self {
        let dynamics = Dynamics::new(model, model.values());
        let limits = limits(model);
        let mut quantities: Vec<Quantity> = limits.iter().map(|l| l.quantity).collect();
        quantities.sort_unstable();
        quantities.dedup();
        let places = limits.iter().map(|l| quantities.partition_point(|q| *q < l.quantity)).collect();
        Self { scales: Scales::of(model), dynamics, limits, quantities, places, samples: 0, anywhere: 0 }
    }

    /// Counts samples; see [`outside`].
    pub fn add<I: Borrow<Inputs<f64>>, Y: Borrow<[f64; STATES]>>(&mut self, samples: impl IntoIterator<Item = (Y, I)>) {
        let mut values = vec![None; self.quantities.len()];
        for (state, inputs) in samples {
            let (state, inputs) = (State::from_array(*state.borrow()), inputs.borrow());
            if ![state.u, state.v, state.r, inputs.n, inputs.delta].iter().all(|x| x.is_finite()) {
                continue;
            }
            // The terms look at the heading only for what turns with the earth.
            let state = State { psi: if state.psi.is_finite() { state.psi } else { 0.0 }, ..state };
            let flow = self.dynamics.flow(&self.dynamics.instant(&state, inputs));
            self.samples += 1;
            let mut out = false;
            for (value, quantity) in values.iter_mut().zip(&self.quantities) {
                *value = self.scales.value(*quantity, inputs, &flow);
            }
            for (limit, place) in self.limits.iter_mut().zip(&self.places) {
                out |= limit.meet(values[*place]);
            }
            self.anywhere += usize::from(out);
        }
    }

    /// Adds what was counted elsewhere for the same model.
    pub fn join(&mut self, other: &Count) {
        self.samples += other.samples;
        self.anywhere += other.anywhere;
        for (limit, more) in self.limits.iter_mut().zip(&other.limits) {
            limit.known += more.known;
            limit.beyond += more.beyond;
            limit.met = [limit.met[0].min(more.met[0]), limit.met[1].max(more.met[1])];
            limit.visited = [limit.visited[0].min(more.visited[0]), limit.visited[1].max(more.visited[1])];
        }
    }

    /// Every range with what was counted here, in the order of the terms; also ranges that contain everything visited.
    pub fn visits(&self) -> Vec<Visit> {
        self.limits.iter().map(Limit::visit).collect()
    }

    /// Adds what the other ranks counted for the same model.
    pub fn gather(&mut self, ranks: &Ranks) {
        [self.samples, self.anywhere] = ranks.counts([self.samples, self.anywhere]);
        for limit in &mut self.limits {
            limit.gather(ranks);
        }
    }

    /// What was counted, as shares.
    pub fn coverage(&self) -> Coverage {
        let mut outside: Vec<Outside> = self.limits.iter().filter(|l| l.beyond > 0).map(Limit::report).collect();
        outside.sort_by(|a, b| b.share.total_cmp(&a.share));
        Coverage { samples: self.samples, share_outside: share(self.anywhere, self.samples), outside }
    }
}

/// How many samples lie outside the ranges of the model's terms, with the parameters as the model has them.
///
/// A sample is the state `[x, y, psi, u, v, r]` \[m, rad, m/s, rad/s\], velocities over ground, and the inputs then. A sample
/// whose velocities are not finite is not counted; a channel that was not recorded is neutral (no wind, deep water) and thus
/// inside.
pub fn outside<I: Borrow<Inputs<f64>>, Y: Borrow<[f64; STATES]>>(
    model: &Model,
    samples: impl IntoIterator<Item = (Y, I)>,
) -> Coverage {
    outside_over(Ranks::one(), model, samples)
}

/// As [`outside`], of the samples of all ranks, of which this one has `samples`.
pub fn outside_over<I: Borrow<Inputs<f64>>, Y: Borrow<[f64; STATES]>>(
    ranks: &Ranks,
    model: &Model,
    samples: impl IntoIterator<Item = (Y, I)>,
) -> Coverage {
    let mut count = Count::new(model);
    count.add(samples);
    count.gather(ranks);
    count.coverage()
}

/// The samples of a run for [`outside`]: states with NaN where a channel has no value, and the inputs.
pub fn samples(run: &Run) -> impl Iterator<Item = ([f64; STATES], &Inputs<f64>)> {
    run.measured.iter().map(or_nan).zip(&run.inputs)
}

fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

fn share(part: usize, whole: usize) -> f64 {
    if whole == 0 { 0.0 } else { part as f64 / whole as f64 }
}

/// The ranges of the model's terms, each widened by the terms that model what it leaves out. The form `regular` of hull and
/// resistance is the term `sternway` in full.
fn limits(model: &Model) -> Vec<Limit> {
    // A term that stands for nothing of this craft has no law to be left: what is not there, and what another term replaces.
    let replaced = |term: &str| model.form == Form::General && ["hull", "resistance"].contains(&term);
    let mut laws: Vec<(&'static str, &'static Validity)> =
        model.terms().filter(|i| !model.lacks(i) && !replaced(i.name)).map(|i| (i.name, &i.validity)).collect();
    let own = laws.len();
    if model.form == Form::Regular
        && let Some(sternway) = model.catalogue().find("sternway")
    {
        laws.push((sternway.info().name, &sternway.info().validity));
    }
    let widened = |term: &str, quantity: Quantity, [low, high]: [f64; 2]| {
        let wider = laws.iter().filter(|(_, v)| v.widens.contains(&term)).filter_map(|(_, v)| v.range(quantity));
        wider.fold([low, high], |[low, high], [a, b]| [low.min(a), high.max(b)])
    };
    laws[..own]
        .iter()
        .flat_map(|(term, law)| law.limits().map(move |(quantity, range)| (*term, quantity, range)))
        .map(|(term, quantity, range)| Limit {
            term,
            quantity,
            range: widened(term, quantity, range),
            known: 0,
            beyond: 0,
            met: [f64::INFINITY, f64::NEG_INFINITY],
            visited: [f64::INFINITY, f64::NEG_INFINITY],
        })
        .collect()
}

/// What the ship's size makes of motions.
struct Scales {
    /// Lpp \[m\].
    length: f64,
    /// sqrt(g Lpp) \[m/s\].
    wave_speed: f64,
    /// Speed below which the direction of motion is noise \[m/s\].
    small_speed: f64,
    /// Propeller diameter \[m\].
    diameter: f64,
}

impl Scales {
    fn of(model: &Model) -> Self {
        let length = model.ship.hull.lpp;
        Self {
            length,
            wave_speed: (GRAVITY * length).sqrt(),
            small_speed: model.ship.small_speed(),
            diameter: model.ship.propeller.diameter,
        }
    }

    /// A quantity at a sample; `None` where it means nothing there.
    fn value(&self, quantity: Quantity, inputs: &Inputs<f64>, flow: &Flow<f64>) -> Option<f64> {
        let tip = inputs.n * self.diameter;
        Some(match quantity {
            Quantity::Froude => flow.u / self.wave_speed,
            Quantity::Drift if (flow.u * flow.u + flow.v * flow.v).sqrt() < self.small_speed => 0.0,
            Quantity::Drift => flow.v.abs().atan2(flow.u.abs()),
            Quantity::Turn => flow.r.abs() * self.length / flow.speed,
            Quantity::Depth => 1.0 / inputs.draught_to_depth.max(0.0),
            Quantity::Rate => inputs.n,
            Quantity::Advance if inputs.n >= 0.0 && tip < flow.advance.abs() * 1e-6 => {
                // A shaft at rest, or nearly.
                if flow.u.abs() < self.small_speed { 0.0 } else { f64::INFINITY.copysign(flow.advance) }
            }
            Quantity::Advance if inputs.n >= 0.0 => flow.advance / tip,
            Quantity::Reversing if inputs.n < 0.0 => flow.u / tip,
            Quantity::Advance | Quantity::Reversing => return None,
            Quantity::Attack => trimtab_ad::smooth::wrap_angle(inputs.delta - flow.rudder_v.atan2(flow.rudder_u)).abs(),
        })
    }
}

impl Limit {
    /// Counts a value; true when it is outside.
    fn meet(&mut self, value: Option<f64>) -> bool {
        let Some(value) = value.filter(|v| !v.is_nan()) else { return false };
        self.known += 1;
        self.visited = [self.visited[0].min(value), self.visited[1].max(value)];
        let out = !(self.range[0]..=self.range[1]).contains(&value);
        if out {
            self.beyond += 1;
            self.met = [self.met[0].min(value), self.met[1].max(value)];
        }
        out
    }

    /// Counts what the other ranks met too.
    fn gather(&mut self, ranks: &Ranks) {
        [self.known, self.beyond] = ranks.counts([self.known, self.beyond]);
        let ends = ranks.largest(&[-self.met[0], self.met[1], -self.visited[0], self.visited[1]]);
        (self.met, self.visited) = ([-ends[0], ends[1]], [-ends[2], ends[3]]);
    }

    fn visit(&self) -> Visit {
        Visit {
            term: self.term,
            quantity: self.quantity,
            range: self.range.map(finite),
            samples: self.known,
            visited: self.visited.map(finite),
            share_outside: share(self.beyond, self.known),
        }
    }

    fn report(&self) -> Outside {
        Outside {
            term: self.term,
            quantity: self.quantity,
            range: self.range.map(finite),
            samples: self.known,
            share: share(self.beyond, self.known),
            met: self.met,
        }
    }
}

impl Outside {
    fn in_words(&self) -> String {
        let [low, high] = self.range;
        let range = [low.unwrap_or(f64::NEG_INFINITY), high.unwrap_or(f64::INFINITY)];
        let valid = range_in_words(self.quantity, range);
        format!("{} in {} ({}, valid {valid})", self.term, self.quantity.words(), percent(self.share))
    }
}

/// A share in percent that is never rounded to nothing.
fn percent(share: f64) -> String {
    if share > 0.0 && share < 0.005 { "below 1 %".into() } else { format!("{:.0} %", 100.0 * share) }
}

/// Ranges named in one line; the others are in the JSON.
const NAMED: usize = 3;

impl Coverage {
    /// One line for a report: `Validity: 12 % of 4800 samples outside a term's range: hull in drift angle (12 %, valid 0 to 20 deg)`.
    pub fn line(&self) -> String {
        if self.samples == 0 {
            return "Validity: no sample to compare with the ranges of the terms".into();
        }
        if self.outside.is_empty() {
            return format!("Validity: all {} samples inside the ranges of the model's terms", self.samples);
        }
        let named: Vec<String> = self.outside.iter().take(NAMED).map(Outside::in_words).collect();
        let more = self.outside.len().saturating_sub(NAMED);
        let rest = if more > 0 { format!("; and {more} more") } else { String::new() };
        format!(
            "Validity: {} of {} samples outside a term's range: {}{rest}",
            percent(self.share_outside),
            self.samples,
            named.join("; ")
        )
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::recording::{Split, measured};
    use crate::ship::Ship;
    use std::path::Path;

    fn model(form: Form, extra: &[&str]) -> Model {
        let ship = Ship::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src/study/demo/ship.toml")).unwrap();
        Model::new(ship, "HD", form, extra).unwrap()
    }

    fn at(u: f64, v: f64, n: f64, delta: f64) -> ([f64; STATES], Inputs<f64>) {
        ([0.0, 0.0, 0.0, u, v, 0.0], Inputs::actuators(0.0, n, delta))
    }

    fn share_of(coverage: &Coverage, term: &str, quantity: Quantity) -> f64 {
        coverage.outside.iter().find(|o| o.term == term && o.quantity == quantity).map_or(0.0, |o| o.share)
    }

    #[test]
    fn a_straight_run_ahead_is_inside_everywhere() {
        let coverage = outside(&model(Form::Paper, &[]), [at(5.0, 0.0, 2.0, 0.0), at(5.0, 0.1, 2.0, 0.1)]);
        assert_eq!((coverage.samples, coverage.share_outside, coverage.outside.len()), (2, 0.0, 0), "{coverage:?}");
        assert!(coverage.line().contains("all 2 samples inside"));
    }

    #[test]
    fn drift_beyond_the_hull_law_is_counted_and_cross_flow_drag_widens_it() {
        let samples = [at(5.0, 0.0, 2.0, 0.0), at(3.0, 3.0, 2.0, 0.0), at(3.0, -3.0, 2.0, 0.0), at(4.0, 0.2, 2.0, 0.0)];
        let base = outside(&model(Form::Paper, &[]), samples);
        let hull = base.outside.iter().find(|o| o.term == "hull" && o.quantity == Quantity::Drift).unwrap();
        assert_eq!((hull.share, hull.samples, hull.range[0]), (0.5, 4, Some(0.0)));
        assert!((hull.met[1] - std::f64::consts::FRAC_PI_4).abs() < 1e-12);
        let line = base.line();
        assert!(line.contains("hull in drift angle (50 %, valid 0 to 20 deg)"), "{line}");
        let wide = outside(&model(Form::Paper, &["crossflow"]), samples);
        assert_eq!(share_of(&wide, "hull", Quantity::Drift), 0.0, "{wide:?}");
    }

    #[test]
    fn sternway_is_outside_the_printed_form_and_inside_the_regular_one() {
        let samples = [at(-2.0, 0.0, -1.5, 0.0)];
        let paper = outside(&model(Form::Paper, &[]), samples);
        assert_eq!(share_of(&paper, "hull", Quantity::Froude), 1.0);
        assert_eq!(share_of(&paper, "resistance", Quantity::Froude), 1.0);
        let regular = outside(&model(Form::Regular, &[]), samples);
        assert_eq!(share_of(&regular, "hull", Quantity::Froude), 0.0, "{regular:?}");
        let with_term = outside(&model(Form::Paper, &["sternway"]), samples);
        assert_eq!(share_of(&with_term, "hull", Quantity::Froude), 0.0);
        // A propeller that turns astern is outside the paper's side force, unless propeller walk is modelled.
        assert_eq!(share_of(&regular, "propeller", Quantity::Rate), 1.0);
        let walk = outside(&model(Form::Regular, &["propeller_walk"]), samples);
        assert_eq!(share_of(&walk, "propeller", Quantity::Rate), 0.0);
    }

    #[test]
    fn a_shaft_at_rest_in_a_moving_ship_is_outside_the_thrust_law() {
        let model = model(Form::Paper, &[]);
        assert_eq!(share_of(&outside(&model, [at(5.0, 0.0, 0.0, 0.0)]), "flow", Quantity::Advance), 1.0);
        assert_eq!(share_of(&outside(&model, [at(0.0, 0.0, 0.0, 0.0)]), "flow", Quantity::Advance), 0.0);
    }

    #[test]
    fn recorded_depth_counts_against_the_deep_water_law_and_shallow_widens_it() {
        let (state, mut inputs) = at(3.0, 0.0, 2.0, 0.0);
        inputs.draught_to_depth = 0.5;
        let deep = outside(&model(Form::Paper, &[]), [(state, inputs)]);
        assert_eq!(share_of(&deep, "hull", Quantity::Depth), 1.0);
        assert_eq!(
            share_of(&outside(&model(Form::Paper, &["shallow"]), [(state, inputs)]), "hull", Quantity::Depth),
            0.0
        );
        inputs.draught_to_depth = 0.8;
        let aground = outside(&model(Form::Paper, &["shallow"]), [(state, inputs)]);
        assert_eq!(share_of(&aground, "shallow", Quantity::Depth), 1.0);
    }

    #[test]
    fn samples_counted_in_parts_give_the_coverage_of_all_of_them() {
        let model = model(Form::Paper, &[]);
        let samples =
            [at(5.0, 0.0, 2.0, 0.0), at(3.0, 3.0, 2.0, 0.0), at(-3.0, 1.0, -2.0, 0.0), at(4.0, 0.2, 0.0, 0.0)];
        let mut joined = Count::new(&model);
        for part in samples.chunks(2) {
            let mut count = Count::new(&model);
            count.add(part.iter().map(|(state, inputs)| (state, inputs)));
            joined.join(&count);
        }
        assert_eq!(joined.coverage(), outside(&model, samples));
    }

    #[test]
    fn samples_without_velocities_are_not_counted() {
        let mut blind = at(5.0, 0.0, 2.0, 0.0);
        blind.0[4] = f64::NAN;
        assert_eq!(outside(&model(Form::Paper, &[]), [blind, at(5.0, 0.0, 2.0, 0.0)]).samples, 1);
        // A channel that was not measured is no state of rest.
        let (state, inputs) = at(5.0, 0.0, 2.0, 0.0);
        let mut run = Run {
            name: "ahead 0 s".into(),
            recording: "ahead".into(),
            session: String::new(),
            manoeuvre: String::new(),
            split: Split::Train,
            dt: 1.0,
            recorded_dt: 1.0,
            inputs: vec![inputs],
            measured: measured(&[state]),
            initial: state,
            disturbed: Vec::new(),
            derived: [false; STATES],
        };
        let count = |run: &Run| outside(&model(Form::Paper, &[]), samples(run)).samples;
        assert_eq!(count(&run), 1);
        run.measured[0][4] = None;
        assert_eq!(count(&run), 0);
    }
}
