//! Import and split: logs of a simulated ship, written as ships and loggers do, come back as they were, with the manoeuvres that
//! were sailed; from a file to a fit without editing. Logs that other programs wrote are in `tests/fixtures`.

use crate::support::study::{self, Study, at, contains_all};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use trimtab::model::Model;
use trimtab::recording::Channel;
use trimtab::recording::import::{Choices, ImportSettings, Imported, import};
use trimtab::ship::Ship;
use trimtab::ship::state::Inputs;
use trimtab::simulate::{Integration, Scenario, simulate};

/// Midday of 1 May 2024 in UTC [s since 1970].
const START: f64 = 1_714_564_800.0;
const LATITUDE: f64 = 54.0;
const LONGITUDE: f64 = 10.0;
const KNOT: f64 = 1852.0 / 3600.0;

/// A sample of the truth, at whole seconds.
#[derive(Clone, Copy, Debug)]
struct Sample {
    t: f64,
    state: [f64; 6],
    n: f64,
    delta: f64,
}

/// What is sailed: seconds, rudder [deg] and propeller rate [1/s].
const PROGRAMME: [(usize, f64, f64); 19] = [
    (240, 0.0, 3.2),
    (300, 35.0, 3.2),
    (240, 0.0, 3.2),
    (45, 20.0, 3.2),
    (60, -20.0, 3.2),
    (60, 20.0, 3.2),
    (60, -20.0, 3.2),
    (45, 20.0, 3.2),
    (240, 0.0, 3.2),
    (150, 0.0, -1.5),
    (420, 0.0, 3.2),
    (300, -35.0, 3.2),
    (240, 0.0, 3.2),
    (45, -10.0, 3.2),
    (60, 10.0, 3.2),
    (60, -10.0, 3.2),
    (45, 10.0, 3.2),
    (300, 0.0, 2.6),
    (300, 20.0, 2.6),
];

fn demo(name: &str) -> String {
    trimtab::study::demo::files().into_iter().find(|(n, _)| n == name).unwrap().1
}

/// The demo's ship with the published parameters, sailed through the programme.
static SAILED: LazyLock<Vec<Sample>> = LazyLock::new(|| {
    let ship = Ship::parse(&demo("ship.toml"), Path::new("ship.toml")).unwrap();
    let model = Model::parse(&demo("baseline.toml"), Path::new("baseline.toml"), ship).unwrap();
    let (mut inputs, mut delta, mut n) = (Vec::new(), 0.0_f64, 3.2_f64);
    for (seconds, rudder, rate) in PROGRAMME {
        for _ in 0..seconds {
            let step = |now: f64, then: f64, most: f64| now + (then - now).clamp(-most, most);
            delta = step(delta, rudder.to_radians(), 3f64.to_radians());
            n = step(n, rate, 0.3);
            inputs.push(Inputs::actuators(inputs.len() as f64, n, delta));
        }
    }
    let scenario = Scenario { dt: 1.0, inputs: inputs.clone(), initial: [0.0, 0.0, 0.4, 6.0, 0.0, 0.0] };
    let trajectory = simulate(&model, &model.values(), Integration::default(), &scenario);
    assert_eq!(trajectory.states.len(), inputs.len(), "the simulation diverged");
    let sample = |(i, state): (&Inputs<f64>, &[f64; 6])| Sample { t: i.t, state: *state, n: i.n, delta: i.delta };
    inputs.iter().zip(&trajectory.states).map(sample).collect()
});

impl Sample {
    /// Latitude and longitude [deg], by the radii of curvature of WGS84.
    fn place(&self) -> [f64; 2] {
        let (a, e2) = (6_378_137.0, 6.694_379_990_14e-3);
        let w = |phi: f64| (1.0 - e2 * phi.sin().powi(2)).sqrt();
        let (x, y) = (self.state[0], self.state[1]);
        let half = LATITUDE.to_radians() + 0.5 * x / 6.37e6;
        let latitude = LATITUDE + (x * w(half).powi(3) / (a * (1.0 - e2))).to_degrees();
        let phi = latitude.to_radians();
        [latitude, LONGITUDE + (y * w(phi) / (a * phi.cos())).to_degrees()]
    }

    /// Speed [kn] and course [deg] over ground.
    fn over_ground(&self) -> [f64; 2] {
        let [_, _, psi, u, v, _] = self.state;
        let (north, east) = (u * psi.cos() - v * psi.sin(), u * psi.sin() + v * psi.cos());
        [north.hypot(east) / KNOT, east.atan2(north).to_degrees().rem_euclid(360.0)]
    }

    fn heading(&self) -> f64 {
        self.state[2].to_degrees().rem_euclid(360.0)
    }

    /// Degrees a minute.
    fn rot(&self) -> f64 {
        self.state[5].to_degrees() * 60.0
    }

    fn iso(&self) -> String {
        let s = self.t as usize + 12 * 3600;
        format!("2024-05-01T{:02}:{:02}:{:02}Z", s / 3600, s / 60 % 60, s % 60)
    }
}

/// Random numbers of about normal distribution, the same every time.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        let mut sum = -6.0;
        for _ in 0..12 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            sum += (self.0 >> 11) as f64 / (1u64 << 53) as f64;
        }
        sum
    }
}

/// ISO times, semicolons, decimal commas, usual units, rudder positive to port; without the rows for which `keep` says no, and
/// without positions for which `fix` says no.
fn csv(noise: f64, keep: impl Fn(f64) -> bool, fix: impl Fn(f64) -> bool) -> String {
    let mut text = String::from("Time;Latitude;Longitude;SOG (kn);COG;HDG;ROT;Rudder angle;Shaft RPM\n");
    let mut random = Noise(7);
    for s in SAILED.iter().filter(|s| keep(s.t)) {
        let mut e = |size: f64| noise * size * random.next();
        let ([latitude, longitude], [sog, cog]) = (s.place(), s.over_ground());
        let place = format!("{:.8};{:.8}", latitude + e(4e-6), longitude + e(6e-6));
        let place = if fix(s.t) { place } else { ";".to_owned() };
        let cells = format!(
            "{};{place};{:.4};{:.4};{:.4};{:.4};{:.4};{:.4}\n",
            s.iso(),
            sog + e(0.05),
            cog + e(0.3),
            (s.heading() + e(0.1)).rem_euclid(360.0),
            s.rot() + e(0.6),
            -s.delta.to_degrees() + e(0.1),
            60.0 * s.n + e(0.2)
        );
        text += &cells.replace('.', ",");
    }
    text
}

fn imported(name: &str, bytes: &[u8], settings: &ImportSettings) -> Result<Imported, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    import(&[path], settings).map_err(|e| e.to_string())
}

fn channel(imported: &Imported, recording: usize, channel: Channel) -> &[f64] {
    let channels = &imported.recordings[recording].rows.channels;
    &channels.iter().find(|(c, _)| *c == channel).unwrap_or_else(|| panic!("no {channel}")).1
}

/// Every channel is what was sailed, within a tolerance: position, heading, velocity, yaw rate, controls.
fn assert_as_sailed(imported: &Imported, tolerances: [f64; 6]) {
    let [position, heading, velocity, rate, rudder, propeller] = tolerances;
    let rows = &imported.recordings[0].rows;
    let [x, y, psi, u, v, r] =
        [Channel::X, Channel::Y, Channel::Psi, Channel::U, Channel::V, Channel::R].map(|c| channel(imported, 0, c));
    let [n, delta] = [Channel::N, Channel::Delta].map(|c| channel(imported, 0, c));
    let origin = [x[0] - SAILED[0].state[0], y[0] - SAILED[0].state[1]];
    let close = |found: f64, truth: f64, tolerance: f64, what: &str, t: f64| {
        assert!(!found.is_finite() || (found - truth).abs() <= tolerance, "{what} at {t} s: {found}, sailed {truth}");
    };
    for (i, t) in rows.t.iter().enumerate() {
        let s = SAILED[t.round() as usize];
        close(x[i] - origin[0], s.state[0], position, "x", *t);
        close(y[i] - origin[1], s.state[1], position, "y", *t);
        let turn = (psi[i] - s.state[2]).rem_euclid(std::f64::consts::TAU);
        close(turn.min(std::f64::consts::TAU - turn), 0.0, heading, "psi", *t);
        close(u[i], s.state[3], velocity, "u", *t);
        close(v[i], s.state[4], velocity, "v", *t);
        close(r[i], s.state[5], rate, "r", *t);
        close(delta[i], s.delta, rudder, "delta", *t);
        close(n[i], s.n, propeller, "n", *t);
    }
}

/// Tolerances of files written with four decimals. The truth counts the way east on the parallel of each sample, the import on the
/// parallels of the track: over the track that makes metres.
const ROUNDED: [f64; 6] = [4.0, 2e-6, 1e-4, 1e-6, 2e-6, 1e-5];

#[test]
fn a_log_with_semicolons_and_decimal_commas_comes_back_as_sailed() {
    let gone = |t: f64| (900.0..912.0).contains(&t);
    let imported = imported(
        "log.csv",
        csv(0.0, |t| !gone(t), |t| !(100.0..107.0).contains(&t)).as_bytes(),
        &ImportSettings::default(),
    )
    .unwrap();
    assert_as_sailed(&imported, ROUNDED);
    let rows = &imported.recordings[0].rows;
    // What was not recorded is missing: twelve rows, and seven positions.
    assert_eq!(rows.t.len(), SAILED.len() - 12);
    assert!(rows.t.iter().all(|t| !gone(*t)));
    let missing: Vec<f64> =
        rows.t.iter().zip(channel(&imported, 0, Channel::X)).filter(|(_, x)| x.is_nan()).map(|(t, _)| *t).collect();
    assert_eq!(missing, [100.0, 101.0, 102.0, 103.0, 104.0, 105.0, 106.0]);
    assert!(channel(&imported, 0, Channel::Psi).iter().all(|psi| psi.is_finite()));
    let evidence = |quantity: &str| {
        let taken = imported.taken.iter().find(|t| t.quantity == quantity).unwrap();
        format!("{}: {}", taken.unit, taken.evidence)
    };
    contains_all(&evidence("psi"), &["deg: ", "clockwise from north"]);
    contains_all(&evidence("r"), &["deg/min: ", "heading turns as ROT says", "clockwise positive"]);
    contains_all(&evidence("sog"), &["kn: ", "0.514"]);
    assert!(imported.velocity.by_heading, "{}", imported.velocity.words);
    contains_all(&evidence("delta"), &["deg: ", "positive to port, turned"]);
    assert_eq!(imported.recordings[0].start.as_deref(), Some("2024-05-01 12:00:00"));
}

/// A log whose units and senses are all found from the data alone.
#[test]
fn units_and_senses_are_found_from_the_data() {
    let text = |angle: f64, anticlockwise: bool, speed: f64, rate: f64, rudder: f64| {
        let mut text = String::from("t,x,y,heading,u,v,r,rudder,rps\n");
        for s in SAILED.iter() {
            let psi = if anticlockwise { std::f64::consts::FRAC_PI_2 - s.state[2] } else { s.state[2] };
            let psi = psi.rem_euclid(std::f64::consts::TAU) * angle;
            let [x, y, _, u, v, r] = s.state;
            let _ = writeln!(
                text,
                "{},{x},{y},{psi},{},{},{},{},{}",
                s.t,
                u * speed,
                v * speed,
                r * rate,
                s.delta * rudder,
                s.n
            );
        }
        text
    };
    let degree = 180.0 / std::f64::consts::PI;
    for (angle, anticlockwise, speed, rate, rudder) in [
        (degree, false, 1.0, 1.0, degree),
        (1.0, false, 1.0 / KNOT, degree, 1.0),
        (degree, true, 3.6, -degree * 60.0, -1.0),
        (1.0, true, 1.0 / KNOT, degree * 60.0, -degree),
    ] {
        let text = text(angle, anticlockwise, speed, rate, rudder);
        let imported = imported("log.csv", text.as_bytes(), &ImportSettings::default()).unwrap();
        assert_as_sailed(&imported, [1e-3, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6]);
        assert!(!imported.velocity.by_heading, "{}", imported.velocity.words);
    }
}

/// A log with these names of columns, its fields as `row` writes them.
fn log(names: &str, separator: &str, row: impl Fn(&Sample) -> Vec<String>) -> String {
    let mut text = names.split('|').collect::<Vec<_>>().join(separator) + "\n";
    SAILED.iter().for_each(|s| text += &(row(s).join(separator) + "\n"));
    text
}

const NAMES: &str = "Time|Latitude|Longitude|SOG [kn]|COG [deg]|Heading [deg]|ROT [deg/min]|Rudder [deg]|Shaft [rpm]";

/// The fields that these names stand for.
fn fields(s: &Sample) -> Vec<String> {
    let ([latitude, longitude], [sog, cog]) = (s.place(), s.over_ground());
    let values = [sog, cog, s.heading(), s.rot(), s.delta.to_degrees(), 60.0 * s.n];
    let place = [latitude, longitude].map(|v| format!("{v:.8}"));
    [s.iso()].into_iter().chain(place).chain(values.map(|v| format!("{v:.4}"))).collect()
}

/// The same with some of the fields written otherwise.
fn with(s: &Sample, others: &[(usize, String)]) -> Vec<String> {
    let mut fields = fields(s);
    others.iter().for_each(|(i, text)| fields[*i].clone_from(text));
    fields
}

fn assert_read(what: &str, bytes: &[u8]) -> Imported {
    let imported = imported("log.csv", bytes, &ImportSettings::default()).unwrap_or_else(|e| panic!("{what}: {e}"));
    assert_eq!(imported.recordings[0].rows.t.len(), SAILED.len(), "{what}");
    assert_as_sailed(&imported, ROUNDED);
    imported
}

#[test]
fn a_log_is_read_in_any_layout() {
    let text = log(NAMES, ",", fields);
    let lines =
        |f: &dyn Fn(usize, &str) -> String| text.lines().enumerate().map(|(i, l)| f(i, l) + "\n").collect::<String>();
    assert_read("upright strokes", log(NAMES, " | ", fields).as_bytes());
    assert_read(
        "a delimiter at the end of rows",
        lines(&|i, l| if i == 0 { l.into() } else { format!("{l},") }).as_bytes(),
    );
    assert_read("names in a comment", format!("% logger 7\n% {text}").as_bytes());
    assert_read("lines of old machines", text.replace('\n', "\r").as_bytes());
    assert_read("UTF-16 without a mark", &text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>());
    let quoted = lines(&|_, l| format!("\"{}\"", l.replace('.', ";").replace(',', "\",\"").replace(';', ",")));
    assert_read("quoted decimal commas", quoted.as_bytes());
    assert_read("single quotes", lines(&|_, l| format!("'{}'", l.replace(',', "','"))).as_bytes());
    let header = text.lines().next().unwrap();
    let again = assert_read(
        "names again",
        lines(&|i, l| if i == 500 { format!("{l}\n{header}") } else { l.into() }).as_bytes(),
    );
    assert!(again.notes.iter().any(|n| n.contains("comes 1 times more")), "{:?}", again.notes);
    let german =
        "Zeit|Breite|Länge|Fahrt über Grund [kn]|Kurs über Grund|Steuerkurs|Drehrate|Ruderlage|Drehzahl [1/min]";
    assert_read("German", log(german, ";", fields).replace('.', ",").as_bytes());
    let twice =
        assert_read("each row twice", lines(&|i, l| if i == 0 { l.into() } else { format!("{l}\n{l}") }).as_bytes());
    assert!(twice.notes.iter().any(|n| n.contains("have the time of another")), "{:?}", twice.notes);
}

#[test]
fn times_are_read_as_people_write_them() {
    let clock = |s: &Sample| {
        let t = s.t as usize + 12 * 3600;
        [t / 3600, t / 60 % 60, t % 60]
    };
    let cases: [(&str, &str, &dyn Fn(&Sample) -> String); 9] = [
        ("twelve hours", "Time", &|s| {
            let [h, m, s] = clock(s);
            format!("1/5/2024 {}:{m:02}:{s:02} PM", (h + 11) % 12 + 1)
        }),
        ("name of the month", "Time", &|s| format!("01-May-2024 {}", &s.iso()[11..19])),
        ("fourteen digits", "Time", &|s| s.iso().replace(['-', 'T', ':', 'Z'], "")),
        ("digits of the day", "UTC", &|s| s.iso()[11..19].replace(':', "")),
        ("days of MATLAB", "Time", &|s| format!("{:.9}", (START + s.t) / 86_400.0 + 719_529.0)),
        ("a start of its own", "Elapsed", &|s| {
            format!("0 days {:02}:{:02}:{:02}", s.t as usize / 3600, s.t as usize / 60 % 60, s.t as usize % 60)
        }),
        ("microseconds", "Time [us]", &|s| format!("{}", s.t as usize * 1_000_000)),
        ("date and time", "Date|Time", &|s| s.iso()[..19].replace('T', ",")),
        ("Datum und Zeit", "Datum|Zeit", &|s| format!("01.05.2024,{}", &s.iso()[11..19])),
    ];
    for (what, name, write) in cases {
        let names = NAMES.replace("Time", name);
        let read = assert_read(what, log(&names, ",", |s| with(s, &[(0, write(s))])).as_bytes());
        let dated = !["digits of the day", "microseconds", "a start of its own"].contains(&what);
        let start = Some("2024-05-01 12:00:00").filter(|_| dated);
        assert_eq!(read.recordings[0].start.as_deref(), start, "{what}");
    }
}

#[test]
fn places_and_sides_are_read_as_people_write_them() {
    let minutes = |v: f64| (v.floor() as i32, 60.0 * v.fract());
    let signs = |s: &Sample, letters: [char; 2]| {
        let place = s.place().map(minutes);
        std::array::from_fn::<String, 2, _>(|i| format!("{}°{:09.6}'{}", place[i].0, place[i].1, letters[i]))
    };
    let arcs = |s: &Sample, letters| {
        let [latitude, longitude] = signs(s, letters);
        with(s, &[(1, latitude), (2, longitude)])
    };
    assert_read("degrees and minutes", log(NAMES, ",", |s| arcs(s, ['N', 'E'])).as_bytes());
    // With both axes turned, so are the directions.
    let astern = |s: &Sample| {
        let f = fields(s);
        [4, 5].map(|i| format!("{:.4}", (f[i].parse::<f64>().unwrap() + 180.0).rem_euclid(360.0)))
    };
    let turned = |s: &Sample, place: [String; 2]| {
        let [north, east] = place;
        let [course, heading] = astern(s);
        with(s, &[(1, north), (2, east), (4, course), (5, heading)])
    };
    let south = log(NAMES, ",", |s| turned(s, signs(s, ['S', 'W'])));
    let south = imported("log.csv", south.as_bytes(), &ImportSettings::default());
    let beside = NAMES.replace("Latitude", "Latitude|N/S").replace("Longitude", "Longitude|E/W");
    let lettered = log(&beside, ",", |s| {
        let f = fields(s);
        turned(s, [format!("{},S", f[1]), format!("{},W", f[2])])
    });
    let letters = imported("log.csv", lettered.as_bytes(), &ImportSettings::default());
    for read in [south, letters] {
        let origin = read.unwrap().origin.unwrap();
        assert!(origin[0] < -53.0 && origin[1] < -9.0, "{origin:?}");
    }
    let degrees = |s: &Sample| s.delta.to_degrees();
    let side = |s: &Sample| if s.delta < 0.0 { "P" } else { "S" };
    let letter = |s: &Sample| format!("{} {:.4}", side(s), degrees(s).abs());
    assert_read("letters of the side", log(NAMES, ",", |s| with(s, &[(7, letter(s))])).as_bytes());
    let names = NAMES.replace("Rudder [deg]", "Rudder [deg]|Side");
    let apart = |s: &Sample| format!("{:.4},{}", degrees(s).abs(), side(s));
    assert_read("a column of sides", log(&names, ",", |s| with(s, &[(7, apart(s))])).as_bytes());
    let units = log(&NAMES.replace(" [deg]", ""), ",", |s| {
        let f = fields(s);
        with(s, &[(5, format!("{}° T", f[5])), (7, format!("{} deg", f[7])), (8, format!("{} rpm", f[8]))])
    });
    assert_read("units beside numbers", units.as_bytes());
    let astern = log(NAMES, ",", |s| with(s, &[(8, format!("{:.4}", -60.0 * s.n))]));
    let read = imported("log.csv", astern.as_bytes(), &ImportSettings::default()).unwrap();
    assert!((channel(&read, 0, Channel::N)[5] - SAILED[5].n).abs() < 1e-5);
}

#[test]
fn what_is_beside_is_not_taken_for_it_and_fill_values_are_missing() {
    let names = NAMES
        .replace("Rudder [deg]", "Rudder rate|Rudder set|Rudder [deg]")
        .replace("Shaft [rpm]", "Engine RPM|Shaft RPM");
    let row = |s: &Sample| {
        let f = fields(s);
        let odd = |i: usize, fill: &str| if s.t % 97.0 == 5.0 { fill.to_owned() } else { f[i].clone() };
        let (rudder, shaft) = (format!("2.3,35,{}", odd(7, "-999")), format!("{:.4},{}", 600.0 * s.n, f[8]));
        with(s, &[(3, odd(3, "102.3")), (5, odd(5, "511")), (7, rudder), (8, shaft)])
    };
    let read = assert_read("columns beside", log(&names, ",", row).as_bytes());
    assert!(channel(&read, 0, Channel::Psi)[5].is_nan() && channel(&read, 0, Channel::Delta)[5].is_nan());
    contains_all(&read.notes.join("; "), &["`Heading` contains 511", "`SOG` contains 102.3", "`Rudder` contains -999"]);
    // Runs one below the other, each from its own start.
    let names = NAMES.replace("Time", "t [s]");
    let run = |s: &Sample| with(s, &[(0, s.t.to_string())]);
    let text = log(&names, ",", run);
    let twice = text.clone() + text.split_once('\n').unwrap().1;
    let read = assert_read("two runs", twice.as_bytes());
    assert_eq!(read.recordings.len(), 2);
    assert_eq!(read.recordings[1].rows.t.len(), SAILED.len());
}

#[test]
fn what_can_be_read_in_two_ways_is_asked() {
    let degrees = |s: &Sample| format!("{:.4}", s.delta.to_degrees().abs());
    let xy = "t|x|y|heading [deg]|r [rad/s]|rudder [deg]|rpm";
    let exchanged = |s: &Sample| {
        let [x, y, _, _, _, r] = s.state;
        [s.t, y, x, s.heading(), r, s.delta.to_degrees(), 60.0 * s.n].map(|v| v.to_string()).to_vec()
    };
    let cases: [(String, &[&str]); 8] = [
        (log(NAMES, ",", |s| with(s, &[(7, degrees(s))])), &["the side of column `Rudder`", "letters P and S"]),
        (log(NAMES, ",", |s| with(s, &[(0, (1000.0 * s.t).to_string())])), &["the track is sailed", "`--unit t=ms`"]),
        (log(xy, ",", exchanged), &["x is east and y north", "--column x=NAME --column y=NAME", "--unit psi=deg"]),
        ("t,x\n0,\"1,234\"\n1,\"1,235\"\n".to_owned(), &[":2:2: `1,234` may be a fraction or thousands"]),
        ("t,x\n1,2\n".to_owned(), &["there is one line of data"]),
        ("t,x\n".to_owned(), &["there is no line of data"]),
        ("PK\u{3}\u{4}xl/workbook.xml".to_owned(), &["a workbook (Excel)", "save the sheet as CSV"]),
        ("\u{1}\u{2}\u{3}\u{4}\u{5}\u{6}\u{7}".to_owned(), &["bytes that are no text"]),
    ];
    for (text, expected) in cases {
        let said = imported("log.csv", text.as_bytes(), &ImportSettings::default()).unwrap_err();
        contains_all(&said, expected);
    }
    let choices = Choices { units: [("t".to_owned(), "ms".to_owned())].into(), ..Choices::default() };
    let text = log(NAMES, ",", |s| with(s, &[(0, (1000.0 * s.t).to_string())]));
    let read = imported("log.csv", text.as_bytes(), &ImportSettings { choices, session_gap: None }).unwrap();
    assert_as_sailed(&read, ROUNDED);
    let folder = tempfile::tempdir().unwrap();
    let said = import(&[folder.path().to_owned()], &ImportSettings::default()).unwrap_err();
    contains_all(&said.to_string(), &["is a folder"]);
}

#[test]
fn a_column_of_text_is_named_where_it_may_be_why_something_is_asked() {
    let row = |s: &Sample| {
        let [x, y, _, _, v, r] = s.state;
        let [before, after] = [vec![s.t, x, y, s.heading()], vec![v, r, s.delta.to_degrees(), 60.0 * s.n]];
        let numbers = |values: Vec<f64>| values.into_iter().map(|v| v.to_string());
        numbers(before).chain(["fast".to_owned()]).chain(numbers(after)).collect::<Vec<_>>()
    };
    let names = "t|x|y|heading [deg]|u|v|r [rad/s]|rudder [deg]|rpm";
    let text = "column `u` contains what is no number, such as `fast` in line 2";
    let text_of = |names: &str| log(names, ",", row);
    let said = imported("log.csv", text_of(names).as_bytes(), &ImportSettings::default()).unwrap_err();
    contains_all(
        &said,
        &["needed: column `u` contains", text, "and is not used; the unit of column `v`", "`--unit v="],
    );
    // A sway velocity is not compared with the speed of the track.
    let read = imported("log.csv", text_of(&names.replace("|v|", "|v [m/s]|")).as_bytes(), &ImportSettings::default());
    contains_all(&read.unwrap().notes.join("; "), &[text]);
    let choices = Choices { columns: [("u".to_owned(), "u".to_owned())].into(), ..Choices::default() };
    let settings = ImportSettings { choices, session_gap: None };
    let said = imported("log.csv", text_of(names).as_bytes(), &settings).unwrap_err();
    contains_all(&said, &["--column u=u: ", text, "; write numbers there"]);
    // What is asked of a column that is there, and the input that is not, in one message.
    let once = log(&names.replace("|rpm", "|gear"), ",", row);
    let said = imported("log.csv", once.as_bytes(), &ImportSettings::default()).unwrap_err();
    contains_all(&said, &["`--unit v=", "no column is the propeller rate", "columns with numbers are: gear,"]);
    // A rudder of text is missing.
    let rudder = log(NAMES, ",", |s| with(s, &[(7, "hard over".to_owned())]));
    let said = imported("log.csv", rudder.as_bytes(), &ImportSettings::default()).unwrap_err();
    contains_all(&said, &["column `Rudder` contains what is no number", "no column is the rudder angle"]);
}

fn sentence(body: &str) -> String {
    format!("${body}*{:02X}\r\n", body.bytes().fold(0_u8, |sum, b| sum ^ b))
}

fn minutes(degrees: f64, width: usize) -> String {
    let whole = degrees.floor();
    format!("{whole:0width$}{:08.5}", (degrees - whole) * 60.0)
}

fn nmea() -> String {
    let mut text = String::new();
    for s in SAILED.iter() {
        let ([latitude, longitude], [sog, cog]) = (s.place(), s.over_ground());
        let clock = s.iso()[11..19].replace(':', "");
        let (lat, lon) = (minutes(latitude, 2), minutes(longitude, 3));
        text += &sentence(&format!("GPRMC,{clock}.00,A,{lat},N,{lon},E,{sog:.3},{cog:.3},010524,,,A"));
        text += &sentence(&format!("HEHDT,{:.3},T", s.heading()));
        text += &sentence(&format!("TIROT,{:.3},A", s.rot()));
        // Propeller and rudder come at half the rate.
        if s.t % 2.0 == 0.0 {
            text += &sentence(&format!("AGRSA,{:.3},A,,V", s.delta.to_degrees()));
            text += &sentence(&format!("IIRPM,S,1,{:.3},,A", 60.0 * s.n));
        }
    }
    text
}

#[test]
fn sentences_of_nmea_come_back_as_sailed() {
    let text = nmea().replacen("$HEHDT", "$HEHDX", 1);
    let imported = imported("log.txt", text.as_bytes(), &ImportSettings::default()).unwrap();
    // Rudder and propeller move between their samples.
    assert_as_sailed(&imported, [4.0, 2e-5, 2e-3, 1e-6, 0.027, 0.16]);
    assert!(
        imported.notes.iter().any(|n| n.contains("1 lines fail their checksum") && n.ends_with("line 2")),
        "{:?}",
        imported.notes
    );
    assert!(channel(&imported, 0, Channel::Psi)[0].is_nan());
}

#[cfg(feature = "parquet")]
fn parquet(path: &Path) {
    use parquet::data_type::{DoubleType, Int64Type};
    use parquet::file::writer::SerializedFileWriter;
    let schema = "message log { required int64 time (TIMESTAMP(MICROS,true)); optional double lat; required double lon;
        required double sog_kn; required double cog; required double heading; required double rot; required double rudder_deg;
        required double shaft_rpm; }";
    let schema = std::sync::Arc::new(parquet::schema::parser::parse_message_type(schema).unwrap());
    let mut file = SerializedFileWriter::new(std::fs::File::create(path).unwrap(), schema, Default::default()).unwrap();
    let mut group = file.next_row_group().unwrap();
    let columns: [&dyn Fn(&Sample) -> f64; 8] = [
        &|s| s.place()[0],
        &|s| s.place()[1],
        &|s| s.over_ground()[0],
        &|s| s.over_ground()[1],
        &|s| s.heading(),
        &|s| s.rot(),
        &|s| s.delta.to_degrees(),
        &|s| 60.0 * s.n,
    ];
    let mut time = group.next_column().unwrap().unwrap();
    let times: Vec<i64> = SAILED.iter().map(|s| ((START + s.t) * 1e6) as i64).collect();
    time.typed::<Int64Type>().write_batch(&times, None, None).unwrap();
    time.close().unwrap();
    for (i, column) in columns.iter().enumerate() {
        let mut writer = group.next_column().unwrap().unwrap();
        // The fourth latitude is null.
        let null = |s: &Sample| i == 0 && s.t == 3.0;
        let values: Vec<f64> = SAILED.iter().filter(|s| !null(s)).map(column).collect();
        let levels: Vec<i16> = SAILED.iter().map(|s| i16::from(!null(s))).collect();
        writer
            .typed::<DoubleType>()
            .write_batch(&values, Some(&levels).filter(|_| i == 0).map(Vec::as_slice), None)
            .unwrap();
        writer.close().unwrap();
    }
    group.close().unwrap();
    file.close().unwrap();
}

#[cfg(feature = "parquet")]
#[test]
fn a_parquet_file_comes_back_as_sailed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.parquet");
    parquet(&path);
    let imported = import(&[path], &ImportSettings::default()).unwrap();
    assert_as_sailed(&imported, [4.0, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9]);
    assert!(channel(&imported, 0, Channel::X)[3].is_nan() && channel(&imported, 0, Channel::U)[3].is_finite());
}

#[cfg(feature = "parquet")]
#[test]
fn a_damaged_parquet_file_is_refused() {
    let study = Study::new();
    study.write("log.parquet", "PAR1abc");
    contains_all(
        &study.refuses(&["import", "log.parquet", "--out", "own"]),
        &["log.parquet: cannot be read as Parquet"],
    );
}

#[cfg(not(feature = "parquet"))]
#[test]
fn a_parquet_file_is_refused_with_the_line_that_adds_its_reader() {
    let study = Study::new();
    std::fs::copy(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/polars.parquet"),
        study.path("log.parquet"),
    )
    .unwrap();
    let said = study.refuses(&["import", "log.parquet", "--out", "own"]);
    contains_all(&said, &["log.parquet: is a Parquet file", "cargo build --release --features parquet", "log.csv"]);
}

/// Written by `tests/fixtures/make_logs.py` with pynmea2, pyarrow and polars: a turn to starboard at 1 deg/s and 10 kn.
#[test]
fn logs_of_other_programs_are_read() {
    let names = ["logger.nmea", "pyarrow.parquet", "polars.parquet"];
    for name in names.into_iter().filter(|name| cfg!(feature = "parquet") || !name.ends_with("parquet")) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(name);
        let imported = import(&[path], &ImportSettings::default()).unwrap();
        assert_eq!(imported.recordings.len(), 1, "{name}");
        assert_eq!(imported.recordings[0].start.as_deref(), Some("2024-05-01 10:00:00"), "{name}");
        let get = |c| channel(&imported, 0, c);
        assert_eq!(imported.recordings[0].rows.t.len(), 60, "{name}");
        let radius = 10.0 * KNOT / 1f64.to_radians();
        let (x, y) = (get(Channel::X), get(Channel::Y));
        for (i, t) in imported.recordings[0].rows.t.iter().enumerate() {
            let psi = t.to_radians();
            let place = (radius * psi.sin(), radius * (1.0 - psi.cos()));
            let off = (x[i] - x[0] - place.0).hypot(y[i] - y[0] - place.1);
            assert!(off < 0.2, "{name}: {off} m at {t} s");
            for (c, value) in [
                (Channel::U, 10.0 * KNOT),
                (Channel::V, 0.0),
                (Channel::R, 1f64.to_radians()),
                (Channel::N, 2.0),
                (Channel::Delta, 20f64.to_radians()),
            ] {
                let found = get(c)[i];
                assert!(found.is_nan() || (found - value).abs() < 1e-6, "{name}: {c} {found} at {t} s");
            }
        }
        // The damaged heading, and the null speed.
        let missing = if name.ends_with("nmea") { (Channel::Psi, 30) } else { (Channel::U, 20) };
        assert!(get(missing.0)[missing.1].is_nan(), "{name}");
        assert_eq!(get(missing.0).iter().filter(|v| v.is_nan()).count(), 1, "{name}");
    }
}

/// Files with a rate of their own each, and empty fields where a column is slower.
#[test]
fn channels_of_different_rates_are_joined_and_their_drop_outs_kept() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let (mut position, mut steering) =
        (String::from("epoch_ms,lat,lon\n"), String::from("epoch_ms\theading\trudder\trpm\n"));
    for s in SAILED.iter() {
        let [latitude, longitude] = s.place();
        let ms = (START + s.t) * 1e3;
        let _ = writeln!(position, "{ms},{latitude:.8},{longitude:.8}");
        if !(500.0..520.0).contains(&s.t) {
            // Headings twice a second, the rate of the propeller every two seconds.
            let rpm = if s.t % 2.0 == 0.0 { format!("{:.3}", 60.0 * s.n) } else { String::new() };
            let _ = writeln!(steering, "{}\t{:.4}\t{:.4}\t", ms - 250.0, s.heading(), s.delta.to_degrees());
            let _ = writeln!(steering, "{}\t{:.4}\t{:.4}\t{rpm}", ms + 250.0, s.heading(), s.delta.to_degrees());
        }
    }
    let paths = [file("position.csv", &position), file("steering.tsv", &steering)];
    let imported = import(&paths, &ImportSettings::default()).unwrap();
    let rows = &imported.recordings[0].rows;
    assert_eq!((rows.step, rows.t.len()), (1.0, SAILED.len()));
    for c in [Channel::Psi, Channel::Delta] {
        let missing: Vec<f64> =
            rows.t.iter().zip(channel(&imported, 0, c)).filter(|(_, v)| v.is_nan()).map(|(t, _)| *t).collect();
        assert!(missing.len() >= 20 && missing.iter().all(|t| (499.0..=520.5).contains(t)), "{c}: {missing:?}");
    }
    let n = channel(&imported, 0, Channel::N);
    assert!(n[100].is_finite() && n[101].is_finite() && n[510].is_nan());
    assert_eq!(imported.derive, ["u", "v", "r"]);
}

/// Runs of their own, each with a time from 0, are recordings of their own.
#[test]
fn files_with_a_clock_of_their_own_are_a_recording_each() {
    let folder = tempfile::tempdir().unwrap();
    let paths: Vec<PathBuf> = [(0, 900), (900, 1800)]
        .iter()
        .map(|(from, to)| {
            let mut text = "t [s] x [m] y [m] psi [rad] r [rad/s] n [rps] delta [rad]\n".replace("] ", "],");
            for s in &SAILED[*from..*to] {
                let [x, y, psi, _, _, r] = s.state;
                let _ = writeln!(text, "{},{x},{y},{psi},{r},{},{}", s.t - *from as f64, s.n, s.delta);
            }
            let path = folder.path().join(format!("run {from}.csv"));
            std::fs::write(&path, text).unwrap();
            path
        })
        .collect();
    let imported = import(&paths, &ImportSettings::default()).unwrap();
    let names: Vec<&str> = imported.recordings.iter().map(|r| r.name.as_str()).collect();
    assert_eq!(names, ["run_0", "run_900"]);
    assert!(imported.recordings.iter().all(|r| r.rows.t[0] == 0.0 && r.rows.t.len() == 900 && r.start.is_none()));
}

/// What the runs of a study are, one letter a stretch: pieces of one count once.
fn manoeuvres(runs: &str) -> Vec<String> {
    let mut found: Vec<(String, String)> = Vec::new();
    for line in runs.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let name = cells[1].split(" piece").next().unwrap().to_owned();
        if found.last().is_none_or(|(last, _)| *last != name) {
            found.push((name, cells[3].to_owned()));
        }
    }
    found.into_iter().map(|(_, kind)| kind).collect()
}

#[test]
fn from_a_noisy_log_to_a_fit_without_editing() {
    let study = Study::new();
    study.write("log.csv", &csv(1.0, |t| !(650.0..680.0).contains(&t), |_| true));
    let said = study.run(&["import", "log.csv", "--ship", "ship.toml", "--model", "model.toml", "--out", "own"]);
    let (out, err) = (study::text(&said.stdout), study::text(&said.stderr));
    assert_eq!((said.status.code(), err.as_str()), (Some(0), ""), "{out}");
    contains_all(
        &out,
        &["speed of the track / SOG", "clockwise from north", "trimtab check own/study.toml", "`--antenna X,Y`"],
    );

    let runs = std::fs::read_to_string(study.path("own/runs.csv")).unwrap();
    let kinds = manoeuvres(&runs);
    let steered: Vec<&str> =
        kinds.iter().map(String::as_str).filter(|k| !["straight", "approach"].contains(k)).collect();
    assert_eq!(steered, ["turn", "zigzag", "stop", "turn", "zigzag", "turn"], "{runs}");
    assert!(runs.contains(",test,") && runs.contains(",train,") && runs.contains(",2024-05-01,"));

    let written = std::fs::read_to_string(study.path("own/study.toml")).unwrap();
    contains_all(&written, &["integration = { method = \"rk4\" }"]);
    // The compass is in velocities that were made of SOG, COG and heading.
    let columns = std::fs::read_to_string(study.path("own/columns.toml")).unwrap();
    contains_all(&columns, &["u = SOG cos(COG - heading)", "\nvelocity_by_heading = true\n"]);
    study.does(&["check", "own/study.toml"]);
    let fit = study.json(&["fit", "own/study.toml"]);
    assert_eq!(at(&fit, "result.converged"), true);
    let estimates = at(&fit, "result.estimates").as_array().unwrap();
    let value = |name: &str| estimates.iter().find(|e| e["name"] == name).unwrap()["value"].as_f64().unwrap();
    // What a single log determines of the rudder is in its interval.
    let lift = estimates.iter().find(|e| e["name"] == "rudder.lift1").unwrap();
    let ends = [0, 1].map(|end| lift["interval"][end].as_f64().unwrap());
    assert!(ends[0] < 0.864 && 0.864 < ends[1] && ends[1] - ends[0] < 6.0, "{lift}");
    // The parameters of the resistance are not determined one by one; the resistance at the speed that was sailed is [N].
    let resistance = |p: [f64; 3], u: f64| p[0] * u + p[1] * u * u + p[2] * u.powi(3);
    let fitted = ["linear", "quadratic", "cubic"].map(|p| value(&format!("resistance.{p}")));
    let ratio = resistance(fitted, 6.0) / resistance([10_500.0, -1900.0, 346.0], 6.0);
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
}

#[test]
fn a_second_import_keeps_the_ship_file_that_was_edited() {
    let study = Study::new();
    study.write("log.csv", &csv(0.0, |t| t < 1500.0, |_| true));
    let out = study.run(&["import", "log.csv", "--out", "own"]);
    assert!(study::text(&out.stdout).contains("fill in own/ship.toml"));
    let said = study.refuses(&["check", "own/study.toml"]);
    contains_all(&said, &["ship.toml", "lpp"]);
    study.append("own/ship.toml", "# edited\n");
    let out = study.run(&["import", "log.csv", "--out", "own", "--antenna=-10,0.5"]);
    assert_eq!(out.status.code(), Some(0));
    assert!(study::text(&out.stdout).contains("ship.toml was there and is kept"));
    assert!(std::fs::read_to_string(study.path("own/ship.toml")).unwrap().ends_with("# edited\n"));
    assert!(
        std::fs::read_to_string(study.path("own/columns.toml")).unwrap().contains("reference_point = [-10.0, 0.5]")
    );
}

#[test]
fn a_study_and_a_recording_are_split_anew() {
    let study = Study::new();
    study.write("log.csv", &csv(0.0, |_| true, |_| true));
    study.run(&["import", "log.csv", "--ship", "ship.toml", "--no-split", "--out", "own"]);
    let runs = std::fs::read_to_string(study.path("own/runs.csv")).unwrap();
    assert_eq!(runs, "file,session\nrecordings/2024-05-01_120000.csv,2024-05-01\n");
    let json = study.json(&["split", "own/study.toml", "--test", "0.01", "--sessions", "dates", "--out", "split"]);
    let runs = at(&json, "result.runs").as_array().unwrap();
    assert!(runs.iter().any(|r| r["split"] == "test") && runs.iter().all(|r| r["session"] == "2024-05-01"));
    let written = std::fs::read_to_string(study.path("split/runs.csv")).unwrap();
    assert_eq!(written.lines().count(), runs.len() + 1);
    study.edit("own/study.toml", "runs = \"runs.csv\"", "runs = \"../split/runs.csv\"");
    study.does(&["check", "own/study.toml"]);
    let recording = study.json(&["split", "own/recordings/2024-05-01_120000.csv", "--longest", "100"]);
    let runs = at(&recording, "result.runs").as_array().unwrap();
    let longest = runs.iter().map(|r| r["to"].as_f64().unwrap() - r["from"].as_f64().unwrap()).fold(0.0, f64::max);
    assert!(longest <= 150.0, "{longest}");
    contains_all(&study.refuses(&["split", "own/study.toml", "--by", "session"]), &["only one session", "--by block"]);
    contains_all(&study.refuses(&["split", "own/study.toml", "--sessions", "weeks"]), &["gaps, gaps=SECONDS, dates"]);
}

#[test]
fn a_gap_gives_the_same_sessions_however_it_is_said() {
    let study = Study::new();
    let log = csv(0.0, |t| t < 900.0, |_| true);
    // Three files of one week, a day apart, and one of the next.
    let files = [("a.csv", "01"), ("b.csv", "02"), ("c.csv", "03"), ("d.csv", "10")];
    for (name, day) in files {
        study.write(name, &log.replace("2024-05-01", &format!("2024-05-{day}")));
    }
    let sessions = |json: &serde_json::Value| {
        let runs = at(json, "result.runs").as_array().unwrap();
        runs.iter().map(|r| r["session"].as_str().unwrap().to_owned()).collect::<std::collections::BTreeSet<_>>().len()
    };
    let all = |more: &[&str]| {
        let command = ["import", "a.csv", "b.csv", "c.csv", "d.csv", "--ship", "ship.toml"];
        let more: Vec<&str> = command.iter().chain(more).copied().collect();
        more.into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    for (more, expected) in [
        (&["--session-gap", "260000"][..], 2),
        (&["--sessions", "gaps=260000"], 2),
        (&["--sessions", "gaps=260000", "--session-gap", "260000"], 2),
        (&["--sessions", "gaps"], 4),
    ] {
        let command = [all(more), vec!["--out".to_owned(), "own".to_owned()]].concat();
        let command: Vec<&str> = command.iter().map(String::as_str).collect();
        assert_eq!(sessions(&study.json(&command)), expected, "{more:?}");
        for (gap, expected) in [("gaps=260000", 2), ("gaps=36000", 4)] {
            assert_eq!(sessions(&study.json(&["split", "own/study.toml", "--sessions", gap])), expected, "{gap}");
        }
    }
    let both = all(&["--sessions", "gaps=600", "--session-gap", "900", "--out", "own"]);
    let both: Vec<&str> = both.iter().map(String::as_str).collect();
    contains_all(&study.refuses(&both), &["two gaps between sessions", "give one of them"]);
}

#[test]
fn mistakes_are_mended_from_the_message() {
    let log = csv(0.0, |t| t < 900.0, |_| true);
    let cases: [(&str, &[&str], &[&str]); 8] = [
        (
            &log.replace("Rudder angle", "fb1").replace("Shaft RPM", "fb2"),
            &[],
            &[
                "rudder angle: name it with `--column delta=NAME`",
                "propeller rate: name it with `--column n=NAME`",
                "fb1, fb2",
            ],
        ),
        (&log, &["--column", "psy=HDG"], &["there is no `psy`", "did you mean `psi`?"]),
        (&log, &["--column", "psi=HDX"], &["no file has a column `HDX`", "did you mean `HDG`?"]),
        (&log, &["--unit", "n=rpn"], &["`rpn` is none of", "rpm"]),
        (&log, &["--column", "psi"], &["QUANTITY=..."]),
        (&log, &["--antenna", "3"], &["metres forward and to starboard"]),
        ("a,b\n1,2\n3,4\n", &[], &["no column is a time", "--column t=NAME"]),
        ("", &[], &["is empty"]),
    ];
    for (text, flags, expected) in cases {
        let study = Study::new();
        study.write("log.csv", text);
        let said = study.refuses(&[&["import", "log.csv", "--out", "own"], flags].concat());
        contains_all(&said, expected);
    }
    let study = Study::new();
    contains_all(&study.refuses(&["import", "none.csv", "--out", "own"]), &["none.csv: cannot read the file"]);
    // A unit that nothing shows: a propeller that turns at fifteen of something.
    let renamed = log.replace("Shaft RPM", "propeller");
    let odd = renamed
        .lines()
        .enumerate()
        .map(|(i, l)| if i == 0 { format!("{l}\n") } else { format!("{};15,0\n", l.rsplit_once(';').unwrap().0) });
    study.write("odd.csv", &odd.collect::<String>());
    let said = study.refuses(&["import", "odd.csv", "--out", "own", "--column", "n=propeller"]);
    contains_all(&said, &["`propeller` (propeller rate)", "--unit n=rpm or rps"]);
    let choices = Choices {
        units: [("n".to_owned(), "rps".to_owned())].into(),
        columns: [("n".to_owned(), "propeller".to_owned())].into(),
        ..Choices::default()
    };
    let settings = ImportSettings { choices, session_gap: None };
    let imported = import(&[study.path("odd.csv")], &settings).unwrap();
    assert_eq!(channel(&imported, 0, Channel::N)[5], 15.0);
}
