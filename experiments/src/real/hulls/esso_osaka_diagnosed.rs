//! Esso Osaka, diagnosed with a calm-water model and without its wind; the findings are compared with the withheld anemometer.
//! Sensors are mended by the recordings' own kinematics before any model is used; no setting was chosen by its outcome.

use crate::real::agreement::Agreement;
use crate::real::case::Case;
use crate::real::error::RealError;
use crate::real::frame::{Frame, Step};
use crate::real::hull::Hull;
use crate::real::mend::{Mend, held, jumps};
use crate::real::pull::{Pull, pulls};
use crate::real::runs::{by_recording, runs, sessions, without_term, without_wind};
use trimtab::diagnose::Settings;
use trimtab::model::Model;
use trimtab::numbers::numerals::{fixed, sig};
use trimtab::numbers::statistics::median;
use trimtab::recording::{Run, Split};
use trimtab::report::plot::{Axis, BASELINE, FITTED, Figure, GREEN, Layer, ORANGE, PURPLE, Panel, RECORDED};

/// Span over which changes of position and heading are compared with integrals of velocity and yaw rate \[s\].
const SPAN: f64 = 20.0;
/// Above the fastest motion and turn of a 3 m ship that sails at 0.4 m/s \[m/s, rad/s\].
const FASTEST: [f64; 2] = [1.5, 0.5];
/// Mean wind above which its direction is compared \[m/s\].
const WINDY: f64 = 1.0;
/// Largest deviation from the anemometer that counts as near \[rad\].
const NEAR: f64 = 20.0 * std::f64::consts::PI / 180.0;

/// The results of the experiment.
pub struct Diagnosed {
    /// Kinematics of each recording.
    pub kinematics: Vec<Agreement>,
    /// Diagnoses.
    pub cases: Vec<Case>,
    /// Questions asked one by one.
    pub steps: Vec<Step>,
    /// Force in each session of the training runs, wind withheld.
    pub by_session: Vec<Pull>,
    /// Force in each recording, wind withheld.
    pub pulls: Vec<Pull>,
    /// Force in each session with the measured wind in the model.
    pub left: Vec<Pull>,
    /// Load coefficients of the measured wind (drag, side, yaw) with their standard errors.
    pub load: Vec<(f64, f64)>,
    /// Propeller walk astern with its standard error, without and with the measured wind and a force in each session.
    pub walks: [(f64, f64); 2],
}

/// Makes every diagnosis and asks every question.
///
/// # Errors
/// [`RealError`].
pub fn run() -> Result<Diagnosed, RealError> {
    let hull = Hull::open("esso_osaka")?;
    let kinematics = Agreement::of_study(&hull, SPAN)?;
    // The repetitions that show whether an answer is stable would take seven times as long; `trimtab diagnose` makes them.
    let settings = Settings::default();
    let (train, test) = (runs(&hull, Split::Train)?, runs(&hull, Split::Test)?);
    let calm = hull.model("model.toml")?;
    let mut cases =
        vec![Case::new("as recorded, wind withheld", &calm, &without_wind(&train), &without_wind(&test), &settings)?];

    let mends = mends(&hull, &kinematics)?;
    let (train, test) = (mended(&train, &mends), mended(&test, &mends));
    let (blind, blind_test) = (without_wind(&train), without_wind(&test));
    cases.push(Case::new("mended, wind withheld", &calm, &blind, &blind_test, &settings)?);
    // The recorded rudder jumps from side to side in a tenth of a second: it is the order. A limit that is named is added to the
    // model, as a user would do, and the diagnosis is repeated.
    if let Some(limited) = with_rudder_limit(&calm, &cases[1])? {
        cases.push(Case::new("rudder's limit in, wind withheld", &limited, &blind, &blind_test, &settings)?);
    }
    let frame = Frame::new(&cases[cases.len() - 1].diagnosis)?;

    let fitted = hull.fitted(&hull.model("freed_wind.toml")?, &hull.windows(Split::Train)?)?;
    let windless = without_term(&fitted.model, "wind")?;
    cases.push(Case::new("best model without its wind, wind given", &windless, &train, &test, &settings)?);

    // One question at a time, with the other parameters profiled out.
    let train = frame.followed(&train);
    let blind = without_wind(&train);
    let names = sessions(&train);
    let force = || frame.parameters(&["earth_force.north", "earth_force.east"], Some(&names));
    let wind = || frame.parameters(&["wind.drag", "wind.side", "wind.yaw"], None);
    let walk = || frame.parameters(&["propeller_walk.astern"], None);
    let still = &frame.model;
    let forced = frame.ask(&blind, &force()?);
    let windy = frame.ask(&train, &wind()?);
    let left = frame.ask_on(&windy.model, &train, &force()?);
    let walked = frame.ask(&blind, &walk()?);
    let all = frame.ask_on(&left.model, &train, &walk()?);
    let steps = vec![
        frame.step("calm, then a force in each session (blind)", still, &forced, &blind_test),
        frame.step("calm, then the measured wind", still, &windy, &test),
        frame.step("measured wind, then a force in each session", &windy.model, &left, &test),
        frame.step("calm, then propeller walk astern", still, &walked, &blind_test),
        frame.step("wind and forces, then propeller walk astern", &left.model, &all, &test),
    ];
    let whole: Vec<Run> = by_recording(&[train.clone(), frame.followed(&test)].concat());
    let alone = frame.parameters(&["earth_force.north", "earth_force.east"], Some(&sessions(&whole)))?;
    let each = frame.ask(&without_wind(&whole), &alone);
    let load = (0..3).map(|i| (windy.test.amplitude[i], windy.test.covariance[(i, i)].max(0.0).sqrt()));
    Ok(Diagnosed {
        kinematics,
        by_session: pulls(&forced, &train),
        pulls: pulls(&each, &whole),
        left: pulls(&left, &train),
        load: load.collect(),
        walks: [walked.first(), all.first()],
        cases,
        steps,
    })
}

/// The model with the limit of the rudder's rate that a diagnosis named, free to move; `None` when it named none.
fn with_rudder_limit(model: &Model, case: &Case) -> Result<Option<Model>, RealError> {
    const NAME: &str = "rudder_rate.inverse";
    let named = case.diagnosis.findings.iter().flat_map(|f| &f.parameters).find(|p| p.name == NAME);
    let Some(value) = named.map(|p| p.value) else { return Ok(None) };
    let mut out = model.clone();
    out.add_term("rudder_rate")?;
    let i = out.find(NAME)?;
    let p = &mut out.parameters[i];
    (p.value, p.free) = (value, true);
    Ok(Some(out))
}

/// The corrections of each recording: velocities, which lag the positions by a second, repeated positions and windows over jumps of
/// the receiver are left out, and delay and bias of the gyro are removed.
fn mends(hull: &Hull, kinematics: &[Agreement]) -> Result<Vec<(String, Mend)>, RealError> {
    let mut out = Vec::new();
    for run in &hull.study.runs {
        let recording = hull.study.recording(run)?;
        let labels = |name: &str| hull.study.runs.iter().find(|r| r.labels.run == name).map(|r| &r.labels);
        let same = |a: &&Agreement| labels(&a.run).is_some_and(|l| l.session == run.labels.session);
        let own = kinematics.iter().find(|a| a.run == run.labels.run);
        let mend = Mend {
            no_velocity: true,
            held: held(&recording, 2),
            rate_delay: median(kinematics.iter().filter(same).map(|a| a.rate_delay)).unwrap_or(f64::NAN),
            rate_bias: own.map_or(0.0, |a| a.rate_bias),
            jumps: jumps(&recording, FASTEST[0], FASTEST[1]),
        };
        out.push((run.labels.run.clone(), mend));
    }
    Ok(out)
}

fn mended(runs: &[Run], mends: &[(String, Mend)]) -> Vec<Run> {
    let of = |r: &Run| mends.iter().find(|(name, _)| r.name.starts_with(name.as_str()))?.1.applied(r);
    runs.iter().filter_map(of).collect()
}

impl Diagnosed {
    fn windy(&self) -> impl Iterator<Item = &Pull> {
        self.pulls.iter().filter(|p| p.wind_direction().1 > WINDY)
    }

    /// How many recordings with wind agree with the anemometer, in words.
    pub fn agreement(&self) -> String {
        let of = |list: Vec<&Pull>| {
            let near = list.iter().filter(|p| p.turned().abs() <= NEAR).count();
            let covered = list.iter().filter(|p| p.turned().abs() <= p.direction().1).count();
            let off = median(list.iter().map(|p| p.turned().abs().to_degrees())).unwrap_or(f64::NAN);
            format!(
                "{near} of {} within 20 deg of the anemometer, median {} deg off, {covered} inside their own 95 % interval",
                list.len(),
                fixed(off, 0)
            )
        };
        let zigzag = |p: &&Pull| p.manoeuvre == "zigzag";
        format!(
            "Recordings with more than 1 m/s of mean wind: {}. Without the zigzags, which keep to one heading: {}. Sessions: {}.",
            of(self.windy().collect()),
            of(self.windy().filter(|p| !zigzag(p)).collect()),
            of(self.by_session.iter().filter(|p| p.wind_direction().1 > WINDY).collect())
        )
    }

    /// Load coefficients of the measured wind, in words.
    pub fn load(&self) -> String {
        let of = |(name, (v, e)): (&str, &(f64, f64))| format!("{name} {} +- {}", sig(*v, 2), sig(1.96 * e, 2));
        let list: Vec<String> = ["drag", "side", "yaw"].into_iter().zip(&self.load).map(of).collect();
        format!("Load coefficients of the measured wind (95 %): {}.", list.join(", "))
    }

    /// Propeller walk astern, in words.
    pub fn walk(&self) -> String {
        let [calm, wind] = self.walks.map(|(v, e)| format!("{} +- {}", sig(v, 2), sig(1.96 * e, 2)));
        format!("Propeller walk astern (95 %): {calm} in calm air, {wind} beside wind and forces.")
    }

    /// Directions and sizes of the forces, and errors of held-out runs.
    pub fn figure(&self) -> Figure {
        let point = |p: &Pull| {
            let (blows, half) = (p.wind_direction().0.to_degrees(), p.direction().1.to_degrees());
            let to = blows + p.turned().to_degrees();
            (blows, to, to - half, to + half)
        };
        let group = |name: &str, color, keep: &dyn Fn(&Pull) -> bool| {
            let points: Vec<_> = self.pulls.iter().filter(|p| keep(p)).map(point).collect();
            Layer::errors(name, color, points)
        };
        let ends = [-180.0, 180.0];
        let line = |off: f64| ends.map(|a| (a, a + off));
        let strong = |p: &Pull| p.wind_direction().1 > WINDY;
        let directions = Panel::new(
            "direction of the force, one point a recording",
            Axis::new("wind blew to [deg]").range(-180.0, 180.0).every(60.0),
            Axis::new("force acts to [deg]").range(-240.0, 240.0).every(60.0),
        )
        .with(Layer::line("the same", RECORDED, line(0.0)))
        .with(Layer::line("20 deg off", RECORDED, line(20.0)).dashed())
        .with(Layer::line("20 deg off", RECORDED, line(-20.0)).dashed().unlisted())
        .with(group("wind under 1 m/s", PURPLE, &|p| !strong(p)))
        .with(group("zigzags, one heading", ORANGE, &|p| strong(p) && p.manoeuvre == "zigzag"))
        .with(group("turning, random, berthing", FITTED, &|p| strong(p) && p.manoeuvre != "zigzag"));
        let size = |keep: &dyn Fn(&Pull) -> bool| {
            let of = |p: &Pull| {
                let ((size, error), speed) = (p.size(), p.wind_direction().1);
                (speed, size, (size - 1.96 * error).max(0.0), size + 1.96 * error)
            };
            self.pulls.iter().filter(|p| keep(p)).map(of).collect::<Vec<_>>()
        };
        let sizes = Panel::new(
            "size of the force",
            Axis::new("mean wind [m/s]").including(0.0),
            Axis::new("force [N]").including(0.0),
        )
        .with(Layer::errors("zigzags, one heading", ORANGE, size(&|p| strong(p) && p.manoeuvre == "zigzag")).unlisted())
        .with(Layer::errors("wind under 1 m/s", PURPLE, size(&|p| !strong(p))).unlisted())
        .with(
            Layer::errors("turning, random, berthing", FITTED, size(&|p| strong(p) && p.manoeuvre != "zigzag"))
                .unlisted(),
        );
        let shown = &self.steps[..3];
        let names = ["force a session, blind", "measured wind", "wind, then force"];
        let bar = |f: &dyn Fn(&Step) -> f64| shown.iter().map(f).collect::<Vec<_>>();
        let proof = Panel::new("held-out runs", Axis::categories("", names), Axis::new("mean cVDM [%]").including(0.0))
            .with(Layer::bars("before", BASELINE, bar(&|s| s.held_out.before.unwrap_or(f64::NAN))))
            .with(Layer::bars("after", GREEN, bar(&|s| s.held_out.after.unwrap_or(f64::NAN))));
        Figure::new("Esso Osaka, 3 m: the force found without the anemometer, and the wind it recorded")
            .columns(3)
            .panel_size(800, 720)
            .with(directions)
            .with(sizes)
            .with(proof)
    }
}
