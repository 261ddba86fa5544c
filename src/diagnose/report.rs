//! A diagnosis in words: the numbered summary of the terminal, the JSON document with its keys explained, and the HTML page.
//! It computes no statistics; whatever it says is in [`Diagnosis`], turned into units that people use (kN, degrees).

use super::conclude::{Amplitude, Diagnosis, Finding, GENERIC, PUSH, PUSH_TITLE, Verdict};
use super::figures::Picture;
use super::locate::{EquationShare, Window};
use super::sides::Sides;
use crate::physics::{Kind, Mechanism};
use crate::report::{Page, Section, Table, fixed, sig};
use crate::ship::Ship;
use crate::terms::CATALOGUE;
use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};

/// Width of the terminal summary \[characters\].
const WIDTH: usize = 100;
/// Width of its left margin with number and heading.
const MARGIN: usize = 16;
/// Notes of one kind that are said in full.
const NOTES: usize = 2;

/// Every key of the JSON document with its meaning; `[]` stands for any entry of a list.
pub const KEYS: &[(&str, &str)] = &[
    ("schema", "layout of this document, `trimtab-diagnosis/1`; keys are only ever added to it"),
    ("study", "name of the study"),
    ("version", "version of trimtab that wrote it"),
    ("verdict", "nothing_missing, named, one_of, not_in_catalogue, sensor, numerics, random (gusts), or insufficient"),
    ("headline", "the verdict in one sentence"),
    ("findings[]", "what was found, strongest first; empty unless the verdict is named, one_of or sensor"),
    ("findings[].mechanism", "name in the catalogue; `push` for a force of limited duration"),
    ("findings[].title", "the same in plain words"),
    ("findings[].kind", "environment, ship, actuator or sensor"),
    (
        "findings[].confidence_set[]",
        "every mechanism these data allow in its place, itself first; `generic` for one that the catalogue does not hold",
    ),
    ("findings[].why", "why the set is what it is"),
    ("findings[].sessions[]", "sessions in which it acts; empty for all with one amplitude"),
    ("findings[].by_session", "whether each of these sessions has an amplitude of its own, as weather does"),
    ("findings[].statistic", "twice the gain in log-likelihood"),
    ("findings[].p", "p-value, corrected for every mechanism that was tried"),
    ("findings[].equations", "the force it brings, as for location.equations"),
    ("findings[].windows[]", "when it acts, as for location.windows; for a force of limited duration"),
    ("findings[].region", "where in state and inputs the force stood out"),
    ("findings[].signature", "how it behaves, in words"),
    ("findings[].parameters[]", "its parameters"),
    (
        "findings[].parameters[].name",
        "dotted name, as in model files; with the session in brackets where each has its own: `mean_wind.north [day 1]`",
    ),
    ("findings[].parameters[].value", "estimate [unit]"),
    ("findings[].parameters[].unit", "SI unit; `-` for none"),
    ("findings[].parameters[].error", "standard error [unit]"),
    ("findings[].parameters[].ci95", "95 % interval [unit]"),
    ("findings[].held_out", "as held_out; with the first finding, for all of them together"),
    ("held_out", "the proof: base model refitted (before) against improved model (after) on runs not used otherwise"),
    ("held_out.runs", "held-out runs"),
    ("held_out.before", "mean cVDM of the free simulation, before [%], as `trimtab evaluate` has it"),
    ("held_out.after", "after [%]"),
    ("held_out.improvement", "1 - after/before"),
    ("held_out.ci95", "its 95 % bootstrap interval over recordings"),
    ("held_out.better", "runs that got better"),
    ("held_out.worse", "runs that got worse"),
    ("held_out.worst_run", "the run that lost most, or gained least"),
    ("held_out.worst_improvement", "its improvement; negative is worse"),
    ("held_out.generic", "mean cVDM with a generic force law of the same data instead [%]"),
    ("held_out.log_likelihood_gain", "gain in log-likelihood over all held-out runs"),
    ("held_out.whiteness", "mean square of standardised innovations, before and after; 1 is as the noise model says"),
    ("held_out.runs_before[]", "run by run, before"),
    ("held_out.runs_before[].run", "name of the run"),
    ("held_out.runs_before[].cvdm", "cVDM [%]; absent when the simulation diverged"),
    ("held_out.runs_before[].mean_distance", "mean distance in x, y [m], psi [rad], u, v [m/s], r [rad/s]"),
    ("held_out.runs_after[]", "run by run, after, with the same keys"),
    ("admission", "audit of recordings and integration step"),
    ("admission.runs", "training runs"),
    ("admission.samples", "their samples"),
    ("admission.sessions", "their sessions"),
    ("admission.heading_spread", "0 all on one heading, 1 headings all round"),
    ("admission.issues[]", "what is wrong or odd with the recordings"),
    ("admission.issues[].channel", "the channel"),
    (
        "admission.issues[].mechanism",
        "sign_error, unit_error, axes_error, frozen, held (repeated samples), start (a first fix that the next ones contradict), jump (of the \
         position) or lost (measurements in a row that the model cannot follow)",
    ),
    ("admission.issues[].text", "what is seen"),
    ("admission.issues[].next_step", "what to do"),
    ("admission.issues[].blocking", "whether it must be mended before any physics is concluded"),
    ("admission.integration", "method and substeps the diagnosis used"),
    ("admission.integration_error", "largest change of a standardised innovation when the step is refined eight times"),
    (
        "admission.euler_gain",
        "log-likelihood gained by reading the recordings as explicit Euler; large for simulated data",
    ),
    ("noise_before", "noise with the base model"),
    (
        "noise_before.sensors[]",
        "sensor noise of position [m], heading [rad], speed [m/s], yaw rate [rad/s], in this order",
    ),
    ("noise_before.sensors[].white", "standard deviation of the white part"),
    ("noise_before.sensors[].coloured", "standard deviation of the coloured part"),
    ("noise_before.sensors[].time", "its correlation time [s]"),
    ("noise_before.force", "standard deviation of the unknown force X, Y [N], N [N m]"),
    ("noise_before.force_time", "its correlation time [s]"),
    ("noise_after", "noise with the findings, with the same keys"),
    ("location", "the unexplained force under the base model"),
    ("location.equations[]", "X, Y, N in this order"),
    ("location.equations[].share", "share of the unexplained force, 0 to 1"),
    ("location.equations[].rms", "root mean square [N; N m for N]"),
    ("location.equations[].sigma", "standard deviation of the unknown force in the noise model [N; N m]"),
    ("location.windows[]", "windows of time in which a force stands out, most significant first"),
    ("location.windows[].run", "the recording, as the study names it"),
    ("location.windows[].session", "its session"),
    ("location.windows[].start", "first second, on the recording's clock [s]"),
    ("location.windows[].end", "last second [s]"),
    ("location.windows[].force", "mean force X, Y [N], N [N m]"),
    ("location.windows[].error", "standard errors"),
    ("location.windows[].statistic", "twice the gain in log-likelihood"),
    ("location.windows[].p", "p-value, corrected for every window of every run"),
    (
        "location.push",
        "the same force in windows of some runs, as well as any can be fitted; a finding only when it stands out",
    ),
    ("location.push.force", "the force X, Y [N], N [N m]"),
    ("location.push.error", "standard errors"),
    (
        "location.push.mirrored",
        "evidence for its mirror image in windows of its own, as a share of its evidence: what the ship's motion brings comes to both sides",
    ),
    ("location.push.sideways", "share of the evidence that sway force and yaw moment hold by themselves, 0 to 1"),
    (
        "location.push.statistic",
        "twice the gain in log-likelihood, less what choosing the windows would gain by chance",
    ),
    ("location.push.windows[]", "when it would act, as for location.windows"),
    ("location.regions[]", "regions of state and inputs, most significant first"),
    ("location.regions[].region", "the region in words"),
    ("location.regions[].samples", "share of all samples in it"),
    ("location.regions[].force", "mean force there X, Y [N], N [N m]"),
    ("location.regions[].error", "standard errors"),
    ("location.regions[].statistic", "twice the gain in log-likelihood"),
    ("location.regions[].p", "p-value, corrected for the number of regions"),
    (
        "location.place",
        "whether an earth-fixed force is another in each of nine parts of the water; absent when nothing can be said",
    ),
    ("location.place.north", "southern and northern limit of the part where it stands out most [m]"),
    ("location.place.east", "western and eastern limit of it [m]"),
    ("location.place.force", "force to north and east there, less what acts everywhere [N]"),
    ("location.place.error", "standard errors"),
    ("location.place.statistic", "twice the gain in log-likelihood over one force everywhere"),
    ("location.place.degrees", "degrees of freedom"),
    ("location.place.p", "p-value"),
    ("location_after", "the force left with the findings, as location; absent without findings"),
    ("ranking[]", "every mechanism that was tested, under the base model"),
    ("ranking[].mechanism", "name"),
    ("ranking[].title", "plain words"),
    ("ranking[].statistic", "twice the gain in log-likelihood that the scores promise"),
    ("ranking[].degrees", "degrees of freedom"),
    ("ranking[].p", "corrected p-value"),
    ("ranking[].amplitude", "amplitudes, in the units of its parameters"),
    ("ranking[].size", "size over the smallest worth naming"),
    ("ranking[].admissible", "whether its sign is possible"),
    ("ranking[].retained", "share of its information left after parameters and unknown coefficients"),
    (
        "ranking[].second_opinion",
        "p-value with a free mirror-symmetric force as rival; for a sensor, with any generic force",
    ),
    ("ranking[].sessions[]", "sessions in which it acts; empty for all"),
    ("ranking[].by_session", "whether each of these sessions has an amplitude of its own"),
    ("absorbed[]", "mechanisms that these data and this model can never show"),
    ("absorbed[].mechanism", "name"),
    ("absorbed[].retained", "share of information left"),
    ("absorbed[].by", "what hides it"),
    ("detectable[]", "what would have been seen"),
    ("detectable[].mechanism", "name"),
    ("detectable[].size", "smallest size seen in 80 % of such data sets [unit]"),
    ("detectable[].unit", "unit"),
    ("confusable[]", "pairs of mechanisms that look alike on these data"),
    ("confusable[].a", "one"),
    ("confusable[].b", "the other"),
    ("confusable[].cosine", "likeness; 1 when they cannot be told apart"),
    ("adequacy_before", "tests of any smooth force law, under the base model"),
    (
        "adequacy_before.symmetric",
        "p-value of forces with port-starboard symmetry: the ship's own forces have another form",
    ),
    ("adequacy_before.asymmetric", "p-value of forces without it, or fixed on the earth"),
    ("adequacy_after", "the same with the findings"),
    ("surrogate[]", "a sparse force law for what the catalogue does not hold; a stand-in, not physics"),
    ("surrogate[].name", "dotted name of the monomial"),
    ("surrogate[].value", "coefficient"),
    ("surrogate[].error", "standard error"),
    ("moves[]", "how far each free parameter of the model moved: it had been hiding the effect"),
    ("moves[].name", "dotted name"),
    ("moves[].before", "without the findings"),
    ("moves[].after", "with them"),
    ("moves[].error", "standard error after"),
    ("moves[].moved", "difference in standard errors"),
    (
        "sides",
        "whether port and starboard of the ship herself differ, as with a single screw; beside the verdict, never a finding",
    ),
    ("sides.statistic", "squared distance from a ship whose sides are alike, in units of its covariance"),
    ("sides.degrees", "degrees of freedom"),
    ("sides.p", "p-value"),
    (
        "sides.parameters[]",
        "the parameters that break mirror symmetry, most significant first, as for findings[].parameters",
    ),
    ("hull_budget[]", "how much of what was allowed for in the ship's own coefficients was used; never a finding"),
    ("hull_budget[].name", "dotted name"),
    ("hull_budget[].prior", "value expected"),
    ("hull_budget[].sd", "standard deviation allowed"),
    ("hull_budget[].value", "estimate"),
    ("hull_budget[].used", "distance from the expected value in standard deviations allowed"),
    ("next_trial", "which trial to sail next"),
    ("next_trial.trial", "the trial"),
    ("next_trial.why", "what it would decide"),
    ("settings", "settings used, as in table [diagnose] of a study, the seed included"),
];

/// The keys of the JSON document as text, one line each.
#[must_use]
pub fn keys_listing() -> String {
    KEYS.iter().map(|(key, meaning)| format!("  {key}: {meaning}\n")).collect()
}

/// The names of all mechanisms that can be named or withheld.
pub fn mechanism_names() -> impl Iterator<Item = &'static str> {
    mechanisms().map(|m| m.name).chain([PUSH])
}

fn mechanisms() -> impl Iterator<Item = &'static Mechanism> {
    CATALOGUE.iter().flat_map(|t| t.info().mechanisms)
}

/// The plain words for a mechanism; its name when the catalogue does not hold it.
#[must_use]
pub fn title_of(name: &str) -> &str {
    match name {
        PUSH => PUSH_TITLE,
        GENERIC => "something that the catalogue does not hold",
        _ => mechanisms().find(|m| m.name == name).map_or(name, |m| m.title),
    }
}

/// The diagnosis as a JSON document, see [`KEYS`].
///
/// Numbers that are not finite, lists that hold one, and members without a value are left out, so that no `null` is in it.
///
/// # Errors
/// When a member cannot be turned into JSON, which no diagnosis gives cause to.
pub fn document(diagnosis: &Diagnosis, study: &str) -> Result<Value, serde_json::Error> {
    let mut members = Map::new();
    if let Some(Value::Object(all)) = pruned(serde_json::to_value(diagnosis)?) {
        members = all;
    }
    members.insert("study".into(), study.into());
    members.insert("version".into(), env!("CARGO_PKG_VERSION").into());
    Ok(Value::Object(members))
}

/// A value without nulls; nothing at all for a list with a hole, whose other entries would change places.
fn pruned(value: Value) -> Option<Value> {
    match value {
        Value::Null => None,
        Value::Object(members) => {
            Some(Value::Object(members.into_iter().filter_map(|(k, v)| Some((k, pruned(v)?))).collect()))
        }
        Value::Array(entries) => entries.into_iter().map(pruned).collect::<Option<Vec<Value>>>().map(Value::Array),
        other => Some(other),
    }
}

/// The units in which people read: degrees, and kN and t for a ship but N and kg for a model basin's.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    large: bool,
}

impl Units {
    /// The units for a ship.
    pub(super) fn of(ship: &Ship) -> Self {
        Self { large: ship.hull.mass > 2e4 }
    }

    /// Factor from an SI unit, and the unit it leads to.
    pub(super) fn human(self, unit: &str) -> (f64, &str) {
        const DEGREES: f64 = 180.0 / std::f64::consts::PI;
        match unit {
            "N" if self.large => (1e-3, "kN"),
            "N m" if self.large => (1e-3, "kN m"),
            "kg" if self.large => (1e-3, "t"),
            "rad" => (DEGREES, "deg"),
            "rad/s" => (DEGREES, "deg/s"),
            "-" => (1.0, ""),
            other => (1.0, other),
        }
    }

    fn text(self, value: f64, unit: &str) -> String {
        let (factor, unit) = self.human(unit);
        format!("{} {unit}", sig(value * factor, 3)).trim_end().to_owned()
    }
}

fn p_value(p: f64) -> String {
    if p < 1e-12 { "p < 1e-12".to_owned() } else { format!("p = {}", sig(p, 2)) }
}

fn percent(share: f64) -> String {
    format!("{} %", fixed(100.0 * share, 0))
}

/// What the verdict is called.
#[must_use]
pub fn verdict_words(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NothingMissing => "NOTHING MISSING",
        Verdict::Named => "MISSING PHYSICS, NAMED",
        Verdict::OneOf => "MISSING PHYSICS, ONE OF SEVERAL",
        Verdict::NotInCatalogue => "MISSING PHYSICS, NOT IN THE CATALOGUE",
        Verdict::Sensor => "A SENSOR, NOT THE SHIP",
        Verdict::Numerics => "THE INTEGRATION STEP, NOT THE SHIP",
        Verdict::Random => "RANDOM FORCES (GUSTS), NOTHING THAT REPEATS",
        Verdict::Insufficient => "THESE RECORDINGS CANNOT TELL",
    }
}

/// A part of the report: a heading and its statements.
#[derive(Clone, Debug)]
pub struct Part {
    /// Heading.
    pub heading: &'static str,
    /// Statements, each a line of its own.
    pub lines: Vec<String>,
}

/// What was diagnosed with what, in one line.
#[must_use]
pub fn subject(d: &Diagnosis, study: &str) -> String {
    let a = &d.admission;
    let held_out = d.held_out.as_ref().map_or("none".to_owned(), |h| h.runs.to_string());
    format!(
        "{study} · {} runs in {} sessions ({} samples), {held_out} held out · base model {} · {}, {} a sample",
        a.runs,
        a.sessions,
        a.samples,
        d.base.name,
        format!("{:?}", a.integration.method).to_uppercase(),
        if a.integration.substeps == 1 { "one step".to_owned() } else { format!("{} steps", a.integration.substeps) },
    )
}

/// The seven parts of the report.
#[must_use]
pub fn parts(d: &Diagnosis) -> Vec<Part> {
    vec![
        Part { heading: "VERDICT", lines: verdict(d) },
        Part { heading: "WHERE", lines: location(d) },
        Part { heading: "MODEL", lines: model(d) },
        Part { heading: "PROOF", lines: proof(d) },
        Part { heading: "STILL OPEN", lines: still_open(d) },
        Part { heading: "BLIND TO", lines: blind(d) },
        Part { heading: "NEXT TRIAL", lines: next_trial(d) },
    ]
}

/// The diagnosis for a terminal.
#[must_use]
pub fn summary(d: &Diagnosis, study: &str) -> String {
    let mut text = wrapped(&format!("{:<MARGIN$}", "DIAGNOSIS"), &subject(d, study));
    for (i, part) in parts(d).iter().enumerate() {
        for (j, line) in part.lines.iter().enumerate() {
            let lead = if j == 0 { format!(" {} {:<13}", i + 1, part.heading) } else { " ".repeat(MARGIN) };
            text += &wrapped(&lead, line);
        }
    }
    text
}

/// A paragraph with a hanging margin.
fn wrapped(lead: &str, paragraph: &str) -> String {
    let mut text = lead.to_owned();
    let mut column = MARGIN;
    for word in paragraph.split(' ') {
        let length = word.chars().count();
        if column > MARGIN && column + 1 + length > WIDTH {
            text += &format!("\n{}", " ".repeat(MARGIN + 2));
            column = MARGIN + 2;
        } else if column > MARGIN {
            text.push(' ');
            column += 1;
        }
        text += word;
        column += length;
    }
    text.push('\n');
    text
}

fn verdict(d: &Diagnosis) -> Vec<String> {
    let units = Units::of(&d.base.ship);
    let mut lines = vec![verdict_words(d.verdict).to_owned()];
    if d.findings.is_empty() {
        lines.push(d.headline.clone());
    }
    for f in &d.findings {
        let size = match &f.sessions {
            each if f.by_session => {
                let of = |s: &String| Some(format!("{s} {}", size_of(f, Some(s.as_str()), units)?));
                format!(": {}", each.iter().filter_map(of).collect::<Vec<_>>().join("; "))
            }
            _ => size_of(f, None, units).map_or(String::new(), |s| format!(", {s}")),
        };
        let sessions = sessions(d, f);
        lines.push(format!(
            "{}{size}{sessions}: seen, {} after correction for all that was tried",
            f.title,
            p_value(f.p)
        ));
        if f.confidence_set.len() > 1 {
            let all: Vec<&str> = f.confidence_set.iter().map(|m| title_of(m)).collect();
            lines.push(format!("cannot tell which of: {}; {}", all.join(", "), f.why));
        } else {
            lines.push(f.why.clone());
        }
    }
    if let (true, Some(r)) = (d.findings.is_empty(), d.ranking.first()) {
        lines.push(format!("strongest candidate, not named: {}, {} after correction", r.title, p_value(r.p)));
    }
    let mut said: BTreeMap<&str, usize> = BTreeMap::new();
    for i in &d.admission.issues {
        let word = if i.blocking() { "mend first" } else { "note" };
        let before = said.entry(i.fault).or_default();
        *before += 1;
        if i.blocking() || *before <= NOTES {
            lines.push(format!("{word}: {}; {}", i.text, i.next_step));
        }
    }
    let more = said.into_iter().filter(|(_, count)| *count > NOTES);
    lines.extend(more.map(|(what, count)| format!("note: {} more runs with `{what}`", count - NOTES)));
    lines
}

/// In which sessions a finding acts, named by the shorter list.
fn sessions(d: &Diagnosis, f: &Finding) -> String {
    let all: BTreeSet<&str> = d.traces.iter().map(|t| t.session.as_str()).collect();
    let with: BTreeSet<&str> = f.sessions.iter().map(String::as_str).collect();
    let without: Vec<&str> = all.difference(&with).copied().collect();
    if f.by_session || with.is_empty() || without.is_empty() {
        return String::new();
    }
    let few = |list: &[&str]| match list {
        [first, second, third, _, rest @ ..] => format!("{first}, {second}, {third} and {} more", rest.len() + 1),
        _ => list.join(", "),
    };
    if without.len() < with.len() {
        format!(", in all sessions but {}", few(&without))
    } else {
        format!(", only in {}", few(&with.into_iter().collect::<Vec<_>>()))
    }
}

/// Size and direction of a mechanism given by its components towards north and east (in one session, where each has its own),
/// in the words of its kind.
fn size_of(f: &Finding, session: Option<&str>, units: Units) -> Option<String> {
    let tail = session.map_or(String::new(), |s| format!(" [{s}]"));
    let part = |suffix: &str| f.parameters.iter().find(|p| p.name.ends_with(&format!("{suffix}{tail}")));
    let (Some(north), Some(east)) = (part(".north"), part(".east")) else {
        let [only] = f.parameters.as_slice() else { return None };
        return Some(amplitude(only, units));
    };
    let size = north.value.hypot(east.value);
    if size <= 0.0 || !size.is_finite() {
        return None;
    }
    // To first order, and as if the components were uncorrelated.
    let error = (north.value * north.error).hypot(east.value * east.error) / size;
    let swing = ((east.value * north.error).hypot(north.value * east.error) / (size * size)).to_degrees();
    let towards = east.value.atan2(north.value).to_degrees();
    let from = (towards + 180.0).rem_euclid(360.0);
    let towards = towards.rem_euclid(360.0);
    let (magnitude, error, unit, direction) = match f.mechanism.as_str() {
        "current" => (size, error, "m/s", format!("setting towards {towards:03.0} deg")),
        "mean_wind" => (size, error, "m/s", format!("from {from:03.0} deg")),
        "wave_drift" => {
            (size.sqrt(), 0.5 * error / size.sqrt(), "m significant height", format!("from {from:03.0} deg"))
        }
        _ => {
            let (factor, unit) = units.human(&north.unit);
            (size * factor, error * factor, unit, format!("towards {towards:03.0} deg"))
        }
    };
    let direction = if swing < 60.0 {
        format!("{direction} (+-{} deg)", fixed((1.96 * swing).max(1.0), 0))
    } else {
        "direction not determined".to_owned()
    };
    let low = (magnitude - 1.96 * error).max(0.0);
    Some(format!("{} {unit} ({} to {}) {direction}", sig(magnitude, 3), sig(low, 3), sig(magnitude + 1.96 * error, 3)))
}

/// Value and interval.
fn amplitude(a: &Amplitude, units: Units) -> String {
    let (factor, _) = units.human(&a.unit);
    let [low, high] = a.ci95.map(|v| sig(v * factor, 3));
    format!("{} ({low} to {high})", units.text(a.value, &a.unit))
}

/// The plain words for a parameter.
fn about(name: &str) -> Option<&'static str> {
    let (term, parameter) = name.split_once(" [").map_or(name, |(name, _)| name).split_once('.')?;
    let info = CATALOGUE.iter().map(|t| t.info()).find(|i| i.name == term)?;
    info.parameters.iter().find(|p| p.name == parameter).map(|p| p.about)
}

const EQUATIONS: [(&str, &str); 3] = [("X", "N"), ("Y", "N"), ("N", "N m")];

fn equations(shares: [&EquationShare; 3], units: Units) -> String {
    EQUATIONS
        .iter()
        .zip(shares)
        .map(|((e, unit), s)| format!("{e} {} ({})", percent(s.share), units.text(s.rms, unit)))
        .collect::<Vec<_>>()
        .join("   ")
}

fn forces(force: &[f64; 3], error: &[f64; 3], units: Units) -> String {
    EQUATIONS
        .iter()
        .zip(force.iter().zip(error))
        .map(|((e, unit), (f, s))| {
            let (factor, unit) = units.human(unit);
            format!("{e} {} +- {} {unit}", sig(f * factor, 3), sig(1.96 * s * factor, 2))
        })
        .collect::<Vec<_>>()
        .join(", ")
}

fn window(w: &Window, units: Units) -> String {
    format!(
        "{} from {} to {} s: {} ({})",
        w.run,
        fixed(w.start, 0),
        fixed(w.end, 0),
        forces(&w.force, &w.error, units),
        p_value(w.p)
    )
}

fn location(d: &Diagnosis) -> Vec<String> {
    let units = Units::of(&d.base.ship);
    let [x, y, n] = &d.location.equations;
    let mut lines = vec![format!("unexplained force by equation (rms): {}", equations([x, y, n], units))];
    for f in d.findings.iter().filter(|f| f.kind != Kind::Sensor) {
        let e = &f.equations;
        lines.push(format!("{} brings (rms): {}", f.title, equations([&e.x, &e.y, &e.n], units)));
    }
    let pushes: Vec<&Window> = d.findings.iter().flat_map(|f| &f.windows).collect();
    let windows: Vec<&Window> = if pushes.is_empty() { d.location.windows.iter().collect() } else { pushes };
    let sailed: BTreeSet<usize> = windows.iter().map(|w| w.index).collect();
    if windows.is_empty() {
        lines.push("in time: no window stands out".to_owned());
    } else {
        lines.push(format!(
            "in time: {} windows in {} of {} runs stand out",
            windows.len(),
            sailed.len(),
            d.traces.len()
        ));
        lines.extend(windows.iter().take(3).map(|w| window(w, units)));
    }
    let regions: Vec<_> = d.location.regions.iter().filter(|r| r.p < 0.01 && r.samples > 0.005).collect();
    if regions.is_empty() {
        lines.push("in state and inputs: no region stands out".to_owned());
    }
    for r in regions.iter().take(3) {
        lines.push(format!(
            "{} ({} of samples): {} ({})",
            r.region,
            percent(r.samples),
            forces(&r.force, &r.error, units),
            p_value(r.p)
        ));
    }
    lines.extend(d.location.place.as_ref().filter(|p| p.p < 1e-4).map(|p| {
        format!(
            "by place: strongest from {} to {} m north and {} to {} m east, {} to north and {} to east beyond what acts \
             everywhere ({})",
            fixed(p.north[0], 0),
            fixed(p.north[1], 0),
            fixed(p.east[0], 0),
            fixed(p.east[1], 0),
            units.text(p.force[0], "N"),
            units.text(p.force[1], "N"),
            p_value(p.p)
        )
    }));
    let mut said: Vec<&str> = Vec::new();
    for f in &d.findings {
        if !said.contains(&f.signature.as_str()) {
            lines.push(format!("signature: {}", f.signature));
            said.push(&f.signature);
        }
    }
    lines
}

fn model(d: &Diagnosis) -> Vec<String> {
    let units = Units::of(&d.base.ship);
    let mut lines = Vec::new();
    for f in &d.findings {
        lines.extend(f.parameters.iter().map(|a| {
            let about = about(&a.name).map_or(String::new(), |words| format!(", {words}"));
            format!("{} = {}{about}", a.name, amplitude(a, units))
        }));
    }
    for t in &d.surrogate {
        lines.push(format!("surrogate, not physics: {} = {} +- {}", t.name, sig(t.value, 3), sig(1.96 * t.error, 2)));
    }
    let mut moved: Vec<_> = d.moves.iter().filter(|m| m.moved.abs() >= 1.0).collect();
    moved.sort_by(|a, b| b.moved.abs().total_cmp(&a.moved.abs()));
    lines.push(if lines.is_empty() {
        "nothing was added; the improved model is the base model, refitted".to_owned()
    } else if moved.is_empty() {
        "none of the model's own parameters moved by more than its standard error".to_owned()
    } else {
        let list: Vec<String> = moved
            .iter()
            .map(|m| format!("{} {:+.1} s.e. ({} to {})", m.name, m.moved, sig(m.before, 3), sig(m.after, 3)))
            .collect();
        format!("had been hiding it: {}", list.join(", "))
    });
    lines.extend(d.sides.as_ref().map(|s| own_sides(s, units)));
    lines
}

/// Whether the ship's own two sides differ, and by what.
fn own_sides(s: &Sides, units: Units) -> String {
    let differ = adequacy_words(s.p);
    let clear = |a: &&Amplitude| differ != "not seen" && a.value.abs() > 1.96 * a.error;
    let one = |a: &Amplitude| format!("{} = {}", a.name, amplitude(a, units));
    let by: Vec<String> = s.parameters.iter().filter(clear).take(3).map(one).collect();
    let by = if by.is_empty() { String::new() } else { format!(": {}", by.join(", ")) };
    let p = p_value(s.p);
    format!("port and starboard of the ship herself differ, as with a single screw: {differ} ({p}){by}")
}

/// A cVDM in words.
fn percentage(cvdm: Option<f64>) -> String {
    cvdm.map_or("–".to_owned(), |v| sig(v, 3))
}

fn proof(d: &Diagnosis) -> Vec<String> {
    let Some(h) = &d.held_out else {
        return vec!["no runs were kept aside, so nothing is proven; mark some with `split = \"test\"`".to_owned()];
    };
    if d.findings.is_empty() {
        return vec![format!(
            "nothing to prove; base model, refitted, on {} unseen runs: cVDM {} %",
            h.runs,
            percentage(h.before)
        )];
    }
    let gain = h.improvement.map_or("–".to_owned(), percent);
    let interval = h.ci95.map_or("no interval with fewer than three recordings".to_owned(), |[low, high]| {
        format!("95 % {} to {}", percent(low), percent(high))
    });
    let mut lines = vec![format!(
        "{} unseen runs: cVDM {} % before, {} % after (improvement {gain}, {interval}); {} better, {} worse",
        h.runs,
        percentage(h.before),
        percentage(h.after),
        h.better,
        h.worse
    )];
    if h.ci95.is_some_and(|[low, _]| low <= 0.0) {
        lines.push("the interval reaches zero: these unseen runs do not confirm the gain".to_owned());
    }
    if let (Some(run), Some(change)) = (&h.worst_run, h.worst_improvement) {
        let word = if change < 0.0 { "worse" } else { "better" };
        lines.push(format!("worst run: {run}, {} {word}", percent(change.abs())));
    }
    if let Some(g) = h.generic {
        lines.push(format!("a generic force law instead, without any name: cVDM {} %", sig(g, 3)));
    }
    lines.push(format!(
        "log-likelihood gained: {}; innovations (1 is as the noise says): {} before, {} after",
        fixed(h.log_likelihood_gain, 1),
        sig(h.whiteness[0], 3),
        sig(h.whiteness[1], 3)
    ));
    lines
}

fn adequacy_words(p: f64) -> &'static str {
    if p < 1e-4 {
        "seen"
    } else if p < 0.01 {
        "cannot tell"
    } else {
        "not seen"
    }
}

fn still_open(d: &Diagnosis) -> Vec<String> {
    let units = Units::of(&d.base.ship);
    let a = d.adequacy_after;
    let mut lines = vec![
        format!(
            "more of the ship's own forces in another form: {} ({})",
            adequacy_words(a.symmetric),
            p_value(a.symmetric)
        ),
        format!(
            "more that breaks port-starboard symmetry or is fixed on the earth: {} ({})",
            adequacy_words(a.asymmetric),
            p_value(a.asymmetric)
        ),
    ];
    let change: Vec<String> = EQUATIONS
        .iter()
        .enumerate()
        .map(|(e, (name, unit))| {
            let (factor, unit) = units.human(unit);
            let (before, after) = (d.noise_before.force[e] * factor, d.noise_after.force[e] * factor);
            format!("{name} {} before, {} {unit} after", sig(before, 3), sig(after, 3))
        })
        .collect();
    lines.push(format!(
        "unknown force that nothing explains (standard deviation, lasting {} s): {}",
        fixed(d.noise_after.force_time, 0),
        change.join("; ")
    ));
    let mut used: Vec<_> = d.hull_budget.iter().filter(|b| b.used.is_finite()).collect();
    used.sort_by(|a, b| b.used.abs().total_cmp(&a.used.abs()));
    let beyond = used.iter().filter(|b| b.used.abs() > 2.0).count();
    if !used.is_empty() {
        let furthest: Vec<String> = used.iter().take(3).map(|b| format!("{} {:+.1}", b.name, b.used)).collect();
        lines.push(format!(
            "hull error budget: {beyond} of {} coefficients beyond 2 of the standard deviations allowed; furthest {}",
            used.len(),
            furthest.join(", ")
        ));
    }
    lines
}

fn blind(d: &Diagnosis) -> Vec<String> {
    let units = Units::of(&d.base.ship);
    let mut lines = Vec::new();
    let mut reasons: Vec<&str> = d.absorbed.iter().map(|a| a.by.as_str()).collect();
    reasons.sort_unstable();
    reasons.dedup();
    for reason in reasons {
        let names: Vec<&str> = d.absorbed.iter().filter(|a| a.by == reason).map(|a| title_of(&a.mechanism)).collect();
        lines.push(format!("hidden: {} (by {reason})", names.join(", ")));
    }
    let sizes: Vec<String> = d
        .detectable
        .iter()
        .filter(|s| s.size.is_finite())
        .map(|s| format!("{} {}", s.mechanism, units.text(s.size, &s.unit)))
        .collect();
    if !sizes.is_empty() {
        lines.push(format!("would have been seen, 4 times in 5, from: {}", sizes.join("; ")));
    }
    if lines.is_empty() {
        lines.push("nothing of the catalogue".to_owned());
    }
    lines
}

fn next_trial(d: &Diagnosis) -> Vec<String> {
    d.next_trial
        .as_ref()
        .map_or_else(|| vec!["none is needed for this verdict".to_owned()], |t| vec![format!("{}: {}", t.trial, t.why)])
}

/// The diagnosis as one page that carries its figures.
pub fn page(d: &Diagnosis, study: &str, pictures: &[Picture]) -> Page {
    let mut page = Page::new(format!("Diagnosis: {study}")).lede(d.headline.clone()).lede(subject(d, study));
    for part in parts(d) {
        let mut section = Section::new(sentence_case(part.heading)).list(&part.lines);
        for p in pictures.iter().filter(|p| p.part == part.heading) {
            section = section.png(&p.png, &p.title, p.caption);
        }
        if part.heading == "MODEL" && !d.moves.is_empty() {
            section =
                section.table(&moves_table(d), "The model's own parameters without and with the findings (SI units).");
        }
        page = page.section(section);
    }
    let footer = format!(
        "trimtab {} · alpha {} · at most {} mechanisms · seed {}{}",
        env!("CARGO_PKG_VERSION"),
        d.settings.alpha,
        d.settings.most,
        d.settings.seed,
        if d.settings.withhold.is_empty() {
            String::new()
        } else {
            format!(" · withheld: {}", d.settings.withhold.join(", "))
        }
    );
    page.footer(footer)
}

fn sentence_case(heading: &str) -> String {
    let mut letters = heading.chars();
    letters.next().map_or(String::new(), |first| first.to_string() + &letters.as_str().to_lowercase())
}

fn moves_table(d: &Diagnosis) -> Table {
    let mut table = Table::new(["parameter", "before", "after", "standard error", "moved [s.e.]"]);
    for m in &d.moves {
        table.row([m.name.clone(), sig(m.before, 4), sig(m.after, 4), sig(m.error, 2), fixed(m.moved, 1)]);
    }
    table
}
