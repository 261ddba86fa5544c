//! A term of another crate: a Flettner rotor, written here, found by the diagnosis and fitted: `cargo run --release --example own_term`
//! The recordings are made by the model itself with noise, so that the answer is known; trimtab's catalogue has no rotor.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::error::Error;
use trimtab::physics::{Flow, Group, Instant, Kind, Mechanism, Physics, Probe, Reach, Term, TermInfo, Validity};
use trimtab::ship::parameter::ParameterInfo;
use trimtab::{
    Channel, Diagnosis, FitSettings, Force, Form, Inputs, Integration, Labels, Method, Model, Recording, Run, Scenario,
    Settings, Split, WindowSettings, diagnose, fit, report, simulate, study::demo, terms,
};
use trimtab_ad::Scalar;

/// A Flettner rotor that is always turned so that it pulls ahead. Its drag is left out.
struct Rotor;

static INFO: TermInfo = TermInfo {
    name: "rotor",
    title: "Flettner rotor",
    group: Group::External,
    equation: "(w_x, w_y) = wind less ship, in body axes; X = 1/2 rho_a S V |w_y|, Y = -1/2 rho_a S V w_x sgn(w_y), N = x Y; x = 0.3 L",
    source: "lift across the apparent wind, lift coefficient times area S constant",
    needs: &["wind"],
    validity: Validity::any("a constant lift coefficient: one spin ratio, whatever the wind"),
    mechanisms: &[Mechanism {
        name: "rotor",
        title: "the pull of a Flettner rotor",
        kind: Kind::Ship,
        parameters: &["lift_area"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["wind"],
        trial: "the same courses with the rotor stopped",
    }],
    parameters: &[ParameterInfo::new("lift_area", "S", "m2", "lift coefficient times area")
        .scale(|_| 300.0)
        .spread(|_| 500.0)
        .bounds(0.0, 5000.0)],
};

impl Term for Rotor {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

impl<S: Scalar> Physics<S> for Rotor {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, _flow: &Flow<S>) -> Force<S> {
        let [along, across] = at.to_body(at.inputs.wind);
        let (x, y) = (along - at.state.u, across - at.state.v);
        // Rounded at small speeds, so that derivatives exist when the wind crosses the bow.
        let size = |s: S| (s + at.small * at.small).sqrt();
        let (speed, side) = (size(x * x + y * y), size(y * y));
        let pull = speed * p[0] * (0.5 * 1.225);
        let lateral = -(pull * x * y / side);
        Force { x: pull * side, y: lateral, n: lateral * (0.3 * at.ship.hull.lpp) }
    }
}

const DT: f64 = 2.0;

/// Lift coefficient times area of the rotor in the recordings \[m2\].
const TRUE_LIFT_AREA: f64 = 300.0;

fn main() -> Result<(), Box<dyn Error>> {
    let mut believed = Model::with_catalogue(
        terms::standard().with(&Rotor),
        demo::example()?.model.ship,
        "without rotor",
        Form::Regular,
        &["wind"],
    )?;
    believed.set(&[("wind.drag", 0.7), ("wind.side", 0.8), ("wind.yaw", 0.1)])?;
    believed.set_eleven(&[-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370]);
    let mut truth = believed.clone();
    truth.add_term("rotor")?;
    truth.set(&[("rotor.lift_area", TRUE_LIFT_AREA)])?;

    let (test, train): (Vec<Run>, Vec<Run>) = runs_of(&truth)?.into_iter().partition(|run| run.split == Split::Test);
    let diagnosis = diagnose(&believed, &train, &test, &Settings::default(), &|_| ())?;
    println!("{}", report::diagnosis::summary(&diagnosis, "a ship with a rotor"));
    println!("WHAT WAS LEFT OUT, in short");
    println!("{}", found(&diagnosis)?);

    let mut model = believed;
    model.add_term("rotor")?;
    let rotor = model.find("rotor.lift_area")?;
    model.parameters[rotor].free = true;
    let fitted = fit(&model, &train, &FitSettings::default(), &mut |_| true)?;
    println!("\nTHE SAME TERM IN A FIT\n{}", fitted.brief());
    let estimate = fitted.estimates.iter().find(|e| e.name == "rotor.lift_area").ok_or("the rotor was not fitted")?;
    println!("rotor.lift_area = {:.0} m2{}, true {TRUE_LIFT_AREA}", estimate.value, interval(estimate.interval));
    Ok(())
}

/// The rotor as the diagnosis found it, with its size and what it gains on the runs kept aside; an error if it was not found.
fn found(diagnosis: &Diagnosis) -> Result<String, Box<dyn Error>> {
    let named = diagnosis.findings.iter().find(|f| f.mechanism == "rotor");
    let finding = named.ok_or_else(|| format!("the diagnosis does not name the rotor: {}", diagnosis.headline))?;
    let amplitude = finding.parameters.first().ok_or("the finding has no parameter")?;
    let gain = finding.held_out.as_ref().ok_or("the finding was not tested on other runs")?;
    let size = format!("{} = {:.0} m2{}", amplitude.name, amplitude.value, interval(Some(amplitude.ci95)));
    let (Some(before), Some(after), Some(share)) = (gain.before, gain.after, gain.improvement) else {
        return Err("a simulation of the runs kept aside diverged".into());
    };
    let reach = interval(gain.improvement_ci95.map(|ends| ends.map(|share| 100.0 * share)));
    Ok(format!(
        "{}\n{size}, true {TRUE_LIFT_AREA}\n{} runs kept aside: cVDM {before:.1} % before, {after:.1} % after, improvement {:.0} %{reach}",
        finding.title,
        gain.runs,
        100.0 * share,
    ))
}

/// A 95 % interval in words; nothing where there is none.
fn interval(interval: Option<[f64; 2]>) -> String {
    interval.map_or(String::new(), |[low, high]| format!(" (95 % {low:.0} to {high:.0})"))
}

/// Twenty-four runs of four minutes on all headings in 10 m/s of wind, measured with noise; every sixth is kept aside.
fn runs_of(truth: &Model) -> Result<Vec<Run>, Box<dyn Error>> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let fine = Integration { method: Method::Rk4, substeps: 4 };
    let mut runs = Vec::new();
    for run in 0..24 {
        let inputs = orders(run);
        let heading = f64::from(run) * 2.4;
        let initial = [0.0, 0.0, heading, 5.0, 0.0, 0.0];
        let track = simulate(truth, &truth.values(), fine, &Scenario { dt: DT, inputs: inputs.clone(), initial });
        let name = format!("run {run}");
        let recording = measured(&name, &inputs, &track.states, &mut random)?;
        let split = if run % 6 == 5 { Split::Test } else { Split::Train };
        let labels = Labels { run: name.clone(), session: "day 1".into(), manoeuvre: String::new(), split };
        runs.extend(recording.windows(&labels, &WindowSettings::whole(truth.ship.hull.draught))?.windows);
    }
    Ok(runs)
}

/// Turns, zigzags and steps of the propeller.
fn orders(run: i32) -> Vec<Inputs<f64>> {
    let side = if run % 2 == 0 { 1.0 } else { -1.0 };
    (0..121)
        .map(|k| {
            let t = f64::from(k) * DT;
            let delta = match run % 3 {
                0 => 0.4 * side * (t / 10.0).tanh(),
                1 => 0.3 * side * (t / 20.0).sin(),
                _ => 0.1 * side,
            };
            let n = 2.0 + 0.5 * (t / 70.0 + f64::from(run)).sin();
            // From the west, in gusts.
            let east = 10.0 + 2.0 * (t / 23.0 + f64::from(run)).sin();
            Inputs { wind: [0.0, east], ..Inputs::actuators(t, n, delta) }
        })
        .collect()
}

/// What the sensors of the ship record.
fn measured(
    name: &str,
    inputs: &[Inputs<f64>],
    states: &[[f64; 6]],
    random: &mut ChaCha8Rng,
) -> Result<Recording, Box<dyn Error>> {
    let mut noisy = |column: usize, sd: f64| -> Vec<f64> {
        let mut noise = || -> f64 { StandardNormal.sample(random) };
        states.iter().map(|s| s[column] + sd * noise()).collect()
    };
    let of = |f: fn(&Inputs<f64>) -> f64| inputs.iter().map(f).collect::<Vec<f64>>();
    Ok(Recording::from_channels(
        name,
        vec![
            (Channel::T, of(|i| i.t)),
            (Channel::X, noisy(0, 0.5)),
            (Channel::Y, noisy(1, 0.5)),
            (Channel::Psi, noisy(2, 0.002)),
            (Channel::U, noisy(3, 0.04)),
            (Channel::V, noisy(4, 0.04)),
            (Channel::R, noisy(5, 0.0003)),
            (Channel::N, of(|i| i.n)),
            (Channel::Delta, of(|i| i.delta)),
            (Channel::WindSpeed, of(|i| i.wind[0].hypot(i.wind[1]))),
            (Channel::WindDirection, of(|i| (-i.wind[1]).atan2(-i.wind[0]))),
        ],
    )?)
}
