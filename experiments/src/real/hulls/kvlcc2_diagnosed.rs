//! KVLCC2, diagnosed: tests in a calm basin without wind, current or waves, of a ship with one screw and so of unlike sides.
//! The zigzags are diagnosed; the turning circles are for the proof only.

use crate::real::agreement::Agreement;
use crate::real::case::Case;
use crate::real::error::RealError;
use crate::real::frame::{Answer, Frame, Step};
use crate::real::hull::Hull;
use crate::real::mend::Mend;
use crate::real::runs::{runs, without_term};
use trimtab::diagnose::Settings;
use trimtab::model::Model;
use trimtab::numbers::numerals::{fixed, sig};
use trimtab::numbers::statistics::median;
use trimtab::recording::{Run, Split};
use trimtab::report::plot::{Axis, BASELINE, FITTED, Figure, GREEN, Layer, Panel, RECORDED};

/// Span over which changes of position and heading are compared with integrals of velocity and yaw rate \[s\].
pub const SPAN: f64 = 40.0;

/// Parameters of the base model in which port and starboard differ: a mirror-symmetric ship has none of them.
pub const ONE_SIDED: [&str; 5] =
    ["propeller.side_force", "rudder.lift0", "rudder.lift2", "rudder.drag1", "flow.asymmetry"];

/// Mechanisms that a calm basin does not have.
pub const NOT_IN_A_BASIN: [&str; 8] =
    ["wind", "mean_wind", "current", "tide", "waves", "wave_drift", "earth_force", "push"];

/// Terms of the best model with its sensors that are left out, one at a time; the diagnosis should name each.
pub const PUT_BACK: [&str; 2] = ["time_skew", "yaw_rate_bias"];

/// The results of the experiment.
pub struct Diagnosed {
    /// Kinematics of each recording.
    pub kinematics: Vec<Agreement>,
    /// Diagnoses.
    pub cases: Vec<Case>,
    /// Questions asked one by one.
    pub steps: Vec<Step>,
    /// Asymmetry of the flow at the rudder with its standard error, starting from a mirror-symmetric ship, from the zigzags.
    pub asymmetry: (f64, f64),
}

/// The diagnosis of the zigzags as recorded, and the kinematics of every recording.
///
/// # Errors
/// [`RealError`].
pub fn as_recorded() -> Result<(Case, Vec<Agreement>), RealError> {
    let hull = Hull::open("kvlcc2")?;
    let (train, test) = (runs(&hull, Split::Train)?, runs(&hull, Split::Test)?);
    let case = Case::new("as recorded", &hull.model("model.toml")?, &train, &test, &Settings::default())?;
    Ok((case, Agreement::of_study(&hull, SPAN)?))
}

/// The recordings for the diagnosis and those for the proof, with the gyro mended by the kinematics of the former.
fn gyro_mended(hull: &Hull, kinematics: &[Agreement]) -> Result<(Vec<Run>, Vec<Run>), RealError> {
    let (train, test) = (runs(hull, Split::Train)?, runs(hull, Split::Test)?);
    let seen = || kinematics.iter().filter(|a| train.iter().any(|r| r.name.starts_with(&a.run)));
    let mend = Mend {
        rate_delay: median(seen().map(|a| a.rate_delay)).unwrap_or(f64::NAN),
        rate_bias: median(seen().map(|a| a.rate_bias)).unwrap_or(f64::NAN),
        ..Mend::default()
    };
    let mended = |runs: &[Run]| runs.iter().filter_map(|r| mend.applied(r)).collect::<Vec<_>>();
    Ok((mended(&train), mended(&test)))
}

/// The diagnosis with all six recordings as training runs and no proof: port and starboard differ most in the turning circles.
fn all_recordings(hull: &Hull, kinematics: &[Agreement]) -> Result<Case, RealError> {
    let (train, test) = gyro_mended(hull, kinematics)?;
    let whole = [train, test].concat();
    Case::new("all recordings, gyro mended", &hull.model("model.toml")?, &whole, &[], &Settings::default())
}

/// The best model: hull coefficients freed, fitted to the zigzags.
///
/// # Errors
/// [`RealError`].
pub fn freed(hull: &Hull) -> Result<Model, RealError> {
    Ok(hull.fitted(&hull.model("freed.toml")?, &hull.windows(Split::Train)?)?.model)
}

/// Diagnoses of the unmended recordings: with the best model, then with the improved model of that diagnosis less one of its added
/// terms, which the diagnosis should name and no other. In the order of [`PUT_BACK`].
///
/// # Errors
/// [`RealError`].
pub fn left_out(hull: &Hull, best: &Model) -> Result<Vec<Case>, RealError> {
    let (train, test) = (runs(hull, Split::Train)?, runs(hull, Split::Test)?);
    let of = |name: &str, model: &Model| Case::new(name, model, &train, &test, &Settings::default());
    let mut cases = vec![of("best model, as recorded", best)?];
    let improved = cases[0].diagnosis.model.clone();
    for term in PUT_BACK {
        cases.push(of(&format!("best model with its sensors, without {term}"), &without_term(&improved, term)?)?);
    }
    Ok(cases)
}

/// The diagnosis of the best model with its one-sided parameters set to zero and free: it should report that the sides differ. The
/// gyro is mended.
///
/// # Errors
/// [`RealError`].
pub fn sides_made_alike(hull: &Hull, best: &Model, kinematics: &[Agreement]) -> Result<Case, RealError> {
    let (train, test) = gyro_mended(hull, kinematics)?;
    Case::new("best model, its sides made alike", &alike(best)?, &train, &test, &Settings::default())
}

/// Makes every diagnosis and asks every question.
///
/// # Errors
/// [`RealError`].
pub fn run() -> Result<Diagnosed, RealError> {
    let hull = Hull::open("kvlcc2")?;
    let (first, kinematics) = as_recorded()?;
    let settings = Settings::default();
    let eleven = hull.model("model.toml")?;
    let mut cases = vec![first];

    let (train, test) = gyro_mended(&hull, &kinematics)?;
    cases.push(Case::new("gyro mended", &eleven, &train, &test, &settings)?);
    cases.push(Case::new("gyro mended, mirror-symmetric ship", &symmetric(&eleven)?, &train, &test, &settings)?);
    let best = freed(&hull)?;
    cases.push(Case::new("best model without its asymmetry", &symmetric(&best)?, &train, &test, &settings)?);
    cases.push(sides_made_alike(&hull, &best, &kinematics)?);

    cases.push(all_recordings(&hull, &kinematics)?);

    cases.extend(left_out(&hull, &best)?);

    // One question at a time on a mirror-symmetric ship, with the other parameters profiled out.
    let (steps, asymmetry) = asked(&cases[2], &train, &test)?;
    Ok(Diagnosed { kinematics, asymmetry, cases, steps })
}

/// One question at a time of the mirror-symmetric ship of a diagnosis, and the asymmetry of the flow at the rudder with its
/// standard error.
fn asked(case: &Case, train: &[Run], test: &[Run]) -> Result<(Vec<Step>, (f64, f64)), RealError> {
    let mut frame = Frame::new(&case.diagnosis)?;
    let asymmetry = frame.model.find("flow.asymmetry")?;
    frame.model.parameters[asymmetry].value = 0.0;
    frame.free.retain(|f| f.column.parameter != asymmetry);
    let train = frame.followed(train);
    let ask = |names: &[&str]| Ok::<_, RealError>(frame.ask(&train, &frame.parameters(names, None)?));
    let flow = ask(&["flow.asymmetry"])?;
    let step = |name: &str, answer: &Answer| frame.step(name, &frame.model, answer, test);
    let steps = vec![
        step("asymmetry of the flow at the rudder", &flow),
        step("all one-sided parameters", &ask(&ONE_SIDED)?),
        step("propeller walk ahead", &ask(&["propeller_walk.ahead"])?),
        step("steady current", &ask(&["current.north", "current.east"])?),
        step("a force fixed on the earth", &ask(&["earth_force.north", "earth_force.east"])?),
    ];
    Ok((steps, flow.first()))
}

/// The model with its one-sided parameters set to zero, still free.
fn alike(model: &Model) -> Result<Model, RealError> {
    let mut out = model.clone();
    for name in ONE_SIDED {
        let i = out.find(name)?;
        out.parameters[i].value = 0.0;
    }
    Ok(out)
}

/// The model with its one-sided parameters set to zero and fixed.
fn symmetric(model: &Model) -> Result<Model, RealError> {
    let mut out = alike(model)?;
    for name in ONE_SIDED {
        let i = out.find(name)?;
        let p = &mut out.parameters[i];
        (p.free, p.prior) = (false, None);
    }
    Ok(out)
}

impl Diagnosed {
    /// Mechanisms named in any case that a calm basin does not have.
    pub fn impossible(&self) -> Vec<String> {
        let named = |c: &Case| {
            let of = c.diagnosis.findings.iter().filter(|f| NOT_IN_A_BASIN.contains(&f.mechanism.as_str()));
            of.map(|f| format!("{} ({})", f.mechanism, c.name)).collect::<Vec<_>>()
        };
        self.cases.iter().flat_map(named).collect()
    }

    /// The asymmetry of the flow at the rudder, in words.
    pub fn screw(&self) -> String {
        let (value, error) = self.asymmetry;
        format!(
            "Asymmetry of the flow at the rudder, from a mirror-symmetric ship: {} +- {} (95 %); the captive tests have -0.1225.",
            sig(value, 2),
            sig(1.96 * error, 2),
        )
    }

    /// Sensor errors as diagnosed and by kinematics, the statistic of each question, and its value on the turning circles.
    pub fn figure(&self) -> Figure {
        // What is measured and too small to be named is shown too.
        let first = &self.cases[0].diagnosis;
        let found = first.findings.iter().chain(&first.withdrawn);
        let amplitude = |name: &str| found.clone().flat_map(|f| &f.parameters).find(|p| p.name == name);
        let count = self.kinematics.len() as f64;
        let places = |values: &dyn Fn(&Agreement) -> f64| {
            self.kinematics.iter().enumerate().map(|(i, a)| (i as f64 + 1.0, values(a))).collect::<Vec<_>>()
        };
        let sensor = |title: &str, axis: &str, name: &str, sign: f64, unit: f64, values: &dyn Fn(&Agreement) -> f64| {
            let mut panel = Panel::new(
                title,
                Axis::new("recording (4 zigzags, 2 turning circles)").range(0.0, count + 1.0).every(1.0),
                Axis::new(axis).including(0.0),
            );
            if let Some(p) = amplitude(name) {
                let mut ends = [sign * unit * p.ci95[0], sign * unit * p.ci95[1]];
                ends.sort_by(f64::total_cmp);
                panel = panel
                    .with(Layer::h_span("diagnosed from the zigzags, 95 %", FITTED, ends[0], ends[1]))
                    .with(Layer::h_line("diagnosed from the zigzags", FITTED, sign * unit * p.value));
            }
            panel.with(Layer::scatter("kinematics of each recording", RECORDED, places(values)))
        };
        let bars: Vec<f64> = self.steps.iter().map(|s| s.gain.0.max(0.0)).collect();
        let names = ["flow at rudder", "all one-sided", "walk ahead", "current", "earth force"];
        let gains = Panel::new(
            "what a mirror-symmetric ship lacks",
            Axis::categories("", names),
            Axis::new("twice the gain in log-likelihood").including(0.0),
        )
        .with(Layer::bars("statistic on the zigzags", FITTED, bars));
        let errors = |f: &dyn Fn(&Step) -> f64| self.steps.iter().map(f).collect::<Vec<_>>();
        let proof = Panel::new(
            "turning circles, held out",
            Axis::categories("", names),
            Axis::new("mean cVDM [%]").including(0.0),
        )
        .with(Layer::bars("mirror-symmetric", BASELINE, errors(&|s| s.held_out.before.unwrap_or(f64::NAN))))
        .with(Layer::bars(
            "with what the label names",
            GREEN,
            errors(&|s| s.held_out.after.unwrap_or(f64::NAN)),
        ));
        Figure::new("KVLCC2: what the diagnosis finds in a calm basin")
            .columns(2)
            .panel_size(900, 600)
            .with(sensor("heading reported before the yaw rate", "lead [s]", "time_skew.heading", -1.0, 1.0, &|a| {
                a.rate_delay
            }))
            .with(sensor(
                "bias of the rate gyro",
                "bias [deg/s]",
                "yaw_rate_bias.bias",
                1.0,
                1.0_f64.to_degrees(),
                &|a| a.rate_bias.to_degrees(),
            ))
            .with(gains)
            .with(proof)
    }

    /// Mechanisms named that a calm basin does not have, in words.
    pub fn basin(&self) -> String {
        let found = self.impossible();
        if found.is_empty() {
            format!("No wind, current, wave or push was named in {} diagnoses.", fixed(self.cases.len() as f64, 0))
        } else {
            format!("Named although a calm basin has none: {}.", found.join(", "))
        }
    }
}
