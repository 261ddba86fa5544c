//! The files of a study made from what was imported: recordings, column map, ship, model and the study itself.
//! The table of runs is made by `split`; nothing is written here.

use super::rows::Rows;
use super::whole::{Imported, ImportedRecording};
use crate::numerals::sig;
use crate::recording::{Channel, Quantity};
use crate::statistics::quantile;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use trimtab_ad::smooth::wrap_angle;

/// Where the parts of a study come from that no log contains.
#[derive(Clone, Debug)]
pub struct Origins<'a> {
    /// Name of the study.
    pub name: &'a str,
    /// Text of the ship file; a form to fill in when not given.
    pub ship: Option<&'a str>,
    /// Text of the model file; the base terms when not given.
    pub model: Option<&'a str>,
    /// Position of the antenna, metres forward and to starboard of midship.
    pub antenna: [f64; 2],
    /// Whether the antenna's place was given.
    pub antenna_given: bool,
    /// Whether the craft has one propeller and one rudder, of which the base terms are.
    pub ship_like: bool,
}

/// A recording as CSV in SI units: times to a microsecond, positions to a tenth of a millimetre, the rest to eight digits.
pub fn recording_csv(recording: &ImportedRecording) -> String {
    let rows = &recording.rows;
    let mut text = String::from("t [s]");
    for (channel, _) in &rows.channels {
        let _ = write!(text, ",{} [{}]", channel.name(), channel.info().quantity.si());
    }
    text.push('\n');
    for (i, t) in rows.t.iter().enumerate() {
        let _ = write!(text, "{t}");
        for (channel, values) in &rows.channels {
            text.push(',');
            if values[i].is_finite() {
                let _ = write!(text, "{}", rounded(*channel, values[i]));
            }
        }
        text.push('\n');
    }
    text
}

fn rounded(channel: Channel, value: f64) -> f64 {
    // A heading counts turns no further than the reader does.
    let value = if channel == Channel::Psi { (value + PI).rem_euclid(TAU) - PI } else { value };
    match channel.info().quantity {
        Quantity::Length => (value * 1e4).round() / 1e4,
        _ => format!("{value:.7e}").parse().unwrap_or(value),
    }
}

/// The files of the study other than recordings and runs: name and text.
pub fn study_files(imported: &Imported, origins: &Origins<'_>) -> Vec<(&'static str, String)> {
    vec![
        ("columns.toml", columns(imported, origins)),
        ("ship.toml", origins.ship.map_or_else(|| ship_form(origins.name), str::to_owned)),
        ("model.toml", origins.model.map_or_else(|| model(origins), str::to_owned)),
        ("study.toml", study(imported, origins)),
    ]
}

/// One line for a comment.
fn line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

fn columns(imported: &Imported, origins: &Origins<'_>) -> String {
    let mut text =
        String::from("# How the recordings are read. They are in SI units; this is what each column was taken for:\n");
    for taken in &imported.taken {
        let sentence = format!("{} is column `{}` in {}: {}", taken.quantity, taken.column, taken.unit, taken.evidence);
        let _ = writeln!(text, "#   {}", line(&sentence));
    }
    let _ = writeln!(text, "# {}.", imported.velocity.words);
    if imported.velocity.by_heading {
        text.push_str("# An error of the heading is in them.\nvelocity_by_heading = true\n");
    }
    if let Some([latitude, longitude]) = imported.origin {
        let _ = writeln!(text, "# x = 0, y = 0 is at latitude {latitude}, longitude {longitude} (deg, WGS84).");
    }
    for recording in &imported.recordings {
        if let Some(start) = &recording.start {
            let _ = writeln!(text, "# t = 0 of {} is {start} UTC.", recording.name);
        }
    }
    let [forward, starboard] = origins.antenna;
    let given = if origins.antenna_given { "" } else { " Midship is assumed." };
    let _ = writeln!(
        text,
        "\n# The point whose position and velocity are recorded, the antenna: metres [forward, starboard] of midship.{given}\n\
         reference_point = [{forward:?}, {starboard:?}]"
    );
    if !imported.derive.is_empty() {
        let _ = writeln!(
            text,
            "# Channels that were not recorded and follow from position and heading.\nderive = {:?}",
            imported.derive
        );
    }
    if let Some(bridge) = imported.bridge {
        let _ = writeln!(
            text,
            "# Longest drop-out of a channel that is bridged by a straight line [s].\nbridge = {bridge:?}"
        );
    }
    if !imported.leave_out.is_empty() {
        let names: Vec<&str> = imported.leave_out.iter().map(|c| c.name()).collect();
        let _ = writeln!(
            text,
            "# Channels that are in the recordings and not used; `trimtab import` said why.\nleave_out = {names:?}"
        );
    }
    text
}

/// A ship file to be filled in: what has to be given is there as a comment, so that the next command says what is missing.
fn ship_form(name: &str) -> String {
    format!(
        "# The ship, in SI units. Lines that begin with `# ?` have to be filled in: take away the `# ?` and add the value.\n\
         # `trimtab new` writes such a file from length, breadth and draught alone, every other value estimated.\n\
         name = {name:?}\n\
         source = \"\"\n\
         \n\
         [hull]\n\
         # ? lpp =                   # length between perpendiculars L [m]\n\
         # ? breadth =               # breadth B [m]\n\
         # ? draught =               # mean draught d [m]\n\
         # ? mass =                  # mass m [kg], about 1025 L B d C_b in the sea\n\
         # ? block_coefficient =     # C_b, a share of L B d\n\
         x_g = 0.0                 # centre of gravity forward of midship [m]\n\
         gyration = 0.25           # yaw radius of gyration over L\n\
         water_density = 1025.0    # [kg/m3]\n\
         \n\
         [propeller]\n\
         # ? diameter =              # D [m]\n\
         # ? wake =                  # effective wake fraction w, 0.2 to 0.4\n\
         # ? thrust_deduction =      # t, 0.1 to 0.25\n\
         # ? thrust_coefficients =   # [k0, k1, k2] of K_T = k0 + k1 J + k2 J^2, such as [0.3425, -0.2424, -0.1897]\n\
         \n\
         [rudder]\n\
         # ? area =                  # A_R [m2], about L d / 50\n\
         # ? span =                  # H_R [m]\n"
    )
}

fn model(origins: &Origins<'_>) -> String {
    let name = origins.name;
    if !origins.ship_like {
        return format!(
            "# The model to be fitted: a hull of which only mass, length and breadth are known, and the actuators of the ship file.\n\
             # `trimtab terms` lists the terms that can be added.\n\
             name = {name:?}\n\
             form = \"general\"\n\
             hull = \"free\"                # damping, added masses and centre of gravity, with wide priors\n"
        );
    }
    format!(
        "# The model to be fitted: the base terms (hull, resistance, propeller, rudder), their parameters at the values of the\n\
         # ship file or of the terms. `trimtab terms` lists the terms that can be added.\n\
         name = {name:?}\n\
         form = \"regular\"\n"
    )
}

/// Length of the motion fitted to the start of each window \[s\]: ten steps.
fn initial_span(imported: &Imported) -> f64 {
    let step = imported.recordings.iter().map(|r| r.rows.step).fold(0.0, f64::max);
    (10.0 * step * 1e3).round() / 1e3
}

/// Rows over which the heading is differenced where no yaw rate was recorded.
const TURN_ROWS: usize = 10;

/// Yaw rate that all but a few samples keep below \[rad/s\], of the recorded rate or else of the heading: r_max of the craft, so that cVDM is
/// the same number for geometrically similar craft at equal Froude number.
fn fastest_turn(recordings: &[ImportedRecording]) -> Option<f64> {
    let of = |rows: &Rows| {
        let channel = |wanted| rows.channels.iter().find(|(c, _)| *c == wanted).map(|(_, values)| values);
        let turned = |psi: &Vec<f64>| {
            let pairs = (TURN_ROWS..psi.len()).map(|i| (i - TURN_ROWS, i));
            pairs.map(|(a, b)| wrap_angle(psi[b] - psi[a]) / (rows.t[b] - rows.t[a])).collect()
        };
        channel(Channel::R).cloned().or_else(|| channel(Channel::Psi).map(turned)).unwrap_or_default()
    };
    let rates = recordings.iter().flat_map(|r| of(&r.rows)).map(f64::abs).filter(|r| r.is_finite());
    let mut rates: Vec<f64> = rates.collect();
    rates.sort_by(f64::total_cmp);
    quantile(&rates, 0.995).filter(|r| (1e-6..=10.0).contains(r))
}

fn study(imported: &Imported, origins: &Origins<'_>) -> String {
    let span = initial_span(imported);
    let r_max = fastest_turn(&imported.recordings).map_or_else(String::new, |r| {
        format!("max_yaw_rate = {}           # [rad/s] about the fastest turn recorded: r_max of cVDM\n", sig(r, 2))
    });
    format!(
        "# Made by `trimtab import`. Paths are relative to this file.\n\
         name = {:?}\n\
         ship = \"ship.toml\"              # particulars, in SI units\n\
         model = \"model.toml\"            # terms and parameters; the values are the start of a fit\n\
         column_map = \"columns.toml\"     # antenna, derived channels; says what each column was taken for\n\
         runs = \"runs.csv\"               # file, session, manoeuvre, split and times of each run, by `trimtab split`\n\
         gaps = \"split\"                  # no run reaches across a gap or a missing value\n\
         initial_state = \"smoothed\"      # measured states are noisy: each start is fitted over\n\
         initial_span = {span:?}            # [s]\n\
         \n\
         [fit]\n\
         objective = \"likelihood\"        # of recordings with sensor noise; \"trajectory\": least squares, as in the paper\n\
         # A real ship takes no Euler steps: with these the step is no part of the answer.\n\
         integration = {{ method = \"rk4\" }}\n\
         {r_max}",
        origins.name
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recording(channel: Channel, values: Vec<f64>, step: f64) -> ImportedRecording {
        let rows =
            Rows { t: (0..values.len()).map(|i| i as f64 * step).collect(), channels: vec![(channel, values)], step };
        ImportedRecording { name: "a".into(), start: None, clock_start: 0.0, rows }
    }

    #[test]
    fn the_fastest_turn_is_that_of_the_craft_and_scales_with_time() {
        let rate = |i: usize| 0.02 * (0.05 * i as f64).sin();
        let of = |step: f64| {
            // The same turns a scale faster: rates go with 1 / t, headings are the same.
            let rates = (0..2000).map(|i| if i == 7 { 3.0 } else { rate(i) / step }).collect();
            let headings = (0..2000).scan(3.0, |psi, i| {
                *psi = wrap_angle(*psi + rate(i));
                Some(*psi)
            });
            [
                fastest_turn(&[recording(Channel::R, rates, step)]).unwrap_or(0.0),
                fastest_turn(&[recording(Channel::Psi, headings.collect(), step)]).unwrap_or(0.0),
            ]
        };
        let (slow, fast) = (of(2.0), of(0.5));
        assert!((slow[0] - 0.01).abs() < 1e-4 && (slow[1] - 0.01).abs() < 2e-4, "{slow:?}");
        assert!((fast[0] - 4.0 * slow[0]).abs() < 1e-9 && (fast[1] - 4.0 * slow[1]).abs() < 1e-9, "{fast:?}");
        assert_eq!(fastest_turn(&[recording(Channel::U, vec![1.0; 9], 1.0)]), None);
    }
}
