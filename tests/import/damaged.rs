//! Damaged recordings, each fault seen by the audit with its run and channel, and sound ones that raise nothing.
//! The faults are put into the recordings of the demo as files, so that reading, column maps and comparison of runs take part.

use std::collections::BTreeMap;
use std::path::Path;
use trimtab::recording::Channel;
use trimtab::recording::audit::{Issue, Severity, StudyAudit, audit_study};
use trimtab::ship::Ship;
use trimtab::study::Study;
use trimtab::study::demo;

/// Rudder and propeller move in this run, the ship turns to starboard and back, and it trains; as do the next ones.
const RUN: &str = "ship_a_011";

/// A recording as a table of numbers; NaN is written as a blank.
#[derive(Clone)]
struct Table {
    header: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn parse(text: &str) -> Self {
        let mut lines = text.lines();
        let header = lines.next().unwrap().split(',').map(str::to_owned).collect();
        let rows = lines.map(|l| l.split(',').map(|f| f.parse().unwrap()).collect()).collect();
        Self { header, rows }
    }

    fn text(&self) -> String {
        let field = |v: &f64| if v.is_nan() { String::new() } else { v.to_string() };
        let row = |r: &Vec<f64>| r.iter().map(field).collect::<Vec<_>>().join(",");
        let rows: Vec<String> = self.rows.iter().map(row).collect();
        format!("{}\n{}\n", self.header.join(","), rows.join("\n"))
    }

    /// Place of the column of a channel, by its name without the unit.
    fn at(&self, channel: &str) -> usize {
        self.header.iter().position(|h| h.split(' ').next() == Some(channel)).unwrap()
    }

    fn get(&self, channel: &str) -> Vec<f64> {
        let at = self.at(channel);
        self.rows.iter().map(|r| r[at]).collect()
    }

    fn set(&mut self, channel: &str, values: &[f64]) {
        let at = self.at(channel);
        self.rows.iter_mut().zip(values).for_each(|(r, v)| r[at] = *v);
    }

    /// Changes every value of a channel, given its row.
    fn each(&mut self, channel: &str, change: impl Fn(usize, f64) -> f64) {
        let values: Vec<f64> = self.get(channel).into_iter().enumerate().map(|(i, v)| change(i, v)).collect();
        self.set(channel, &values);
    }

    /// A channel that is so many rows late; before, it repeats its first value.
    fn late(&mut self, channel: &str, rows: usize) {
        let values = self.get(channel);
        self.each(channel, |i, _| values[i.saturating_sub(rows)]);
    }

    fn remove(&mut self, channel: &str) {
        let at = self.at(channel);
        self.header.remove(at);
        self.rows.iter_mut().for_each(|r| {
            r.remove(at);
        });
    }

    fn rename(&mut self, channel: &str, header: &str) {
        let at = self.at(channel);
        self.header[at] = header.to_owned();
    }
}

/// The demo's study, to be damaged.
#[derive(Clone)]
struct Files(BTreeMap<String, String>);

impl Files {
    fn sound() -> Self {
        Self(demo::files().into_iter().collect())
    }

    /// Changes one recording.
    fn run(mut self, run: &str, change: impl Fn(&mut Table)) -> Self {
        let text = self.0.get_mut(&format!("recordings/{run}.csv")).unwrap();
        let mut table = Table::parse(text);
        change(&mut table);
        *text = table.text();
        self
    }

    /// Changes every recording.
    fn all(self, change: impl Fn(&mut Table)) -> Self {
        self.runs().iter().fold(self, |files, run| files.run(run, &change))
    }

    fn runs(&self) -> Vec<String> {
        let name = |file: &String| Some(file.strip_prefix("recordings/")?.strip_suffix(".csv")?.to_owned());
        self.0.keys().filter_map(name).collect()
    }

    fn table(&self, run: &str) -> Table {
        Table::parse(&self.0[&format!("recordings/{run}.csv")])
    }

    /// Replaces a text in a file, in which it must be.
    fn replace(mut self, file: &str, from: &str, to: &str) -> Self {
        let text = self.0.get_mut(file).unwrap();
        assert!(text.contains(from), "{from} is not in {file}");
        *text = text.replacen(from, to, 1);
        self
    }

    /// Adds a column map for all runs.
    fn map(mut self, text: &str) -> Self {
        self.0.insert("columns.toml".into(), text.into());
        self.replace("study.toml", "runs = ", "column_map = \"columns.toml\"\nruns = ")
    }

    fn audit(&self) -> StudyAudit {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("recordings")).unwrap();
        for (name, text) in &self.0 {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        let study = Study::read(&folder.path().join("study.toml")).unwrap();
        audit_study(&study, &Ship::read(Path::new(&study.ship)).unwrap())
    }
}

/// Errors and warnings, with their runs; `study` for those about several runs.
fn doubts(audit: &StudyAudit) -> Vec<(String, Issue)> {
    let own = audit.issues.iter().map(|i| ("study".to_owned(), i.clone()));
    let of_runs = audit.recordings.iter().flat_map(|a| a.issues.iter().map(|i| (a.run.clone(), i.clone())));
    own.chain(of_runs).filter(|(_, i)| i.severity != Severity::Note).collect()
}

/// Where a fault is to be reported.
#[derive(Clone, Copy, Debug)]
enum Where {
    /// In one run and no other.
    Run(&'static str),
    /// In so many runs at least.
    Runs(usize),
    /// About the study as a whole.
    Study,
}

/// A damage, and how it is to be reported: the fault, its channel, where, and a part of the next step.
struct Case {
    name: &'static str,
    files: Files,
    fault: &'static str,
    channel: Option<Channel>,
    place: Where,
    next: &'static str,
}

fn case(
    name: &'static str,
    files: Files,
    fault: &'static str,
    channel: impl Into<Option<Channel>>,
    place: Where,
    next: &'static str,
) -> Case {
    Case { name, files, fault, channel: channel.into(), place, next }
}

#[test]
fn the_sound_recordings_raise_nothing() {
    let found = doubts(&Files::sound().audit());
    assert!(found.is_empty(), "{found:#?}");
}

/// A ship of the same run on a course that is nearly straight: rudder and heading swing by tenths of a degree.
fn straight(t: &mut Table) {
    let time = t.get("t");
    let rudder = |t: f64| 0.006 * (0.05 * t).sin() + 0.001 * (0.31 * t).sin();
    // Nomoto's ship, integrated finely, with a yaw of the waves that the rudder does not cause.
    let (mut r, mut psi, mut x, mut y) = (0.0_f64, 0.4_f64, 0.0_f64, 0.0_f64);
    let mut rows = Vec::new();
    for now in &time {
        let waves = 5e-4 * (0.3 * now).sin();
        let yaw = 0.3 * 5e-4 * (0.3 * now).cos();
        rows.push([x, y, psi + waves, 5.0, 0.0, r + yaw, 2.0, rudder(*now)]);
        for k in 0..20 {
            let (at, h) = (now + 0.1 * f64::from(k), 0.1);
            r += h * (0.05 * rudder(at) - r) / 8.0;
            psi += h * r;
            x += h * 5.0 * psi.cos();
            y += h * 5.0 * psi.sin();
        }
    }
    for (i, name) in ["x", "y", "psi", "u", "v", "r", "n", "delta"].iter().enumerate() {
        t.set(name, &rows.iter().map(|r| r[i]).collect::<Vec<_>>());
    }
}

#[test]
fn sound_recordings_of_other_kinds_raise_nothing() {
    let degrees = |t: &mut Table| {
        t.rename("delta", "delta [deg]");
        t.each("delta", |_, d| d.to_degrees());
    };
    let coarse = |t: &mut Table| t.each("psi", |_, p| (p.to_degrees() / 0.04).round().mul_add(0.04, 0.0).to_radians());
    let wrapped = |t: &mut Table| t.each("psi", |_, p| p.rem_euclid(std::f64::consts::TAU));
    let started = |t: &mut Table| t.each("t", |_, v| v + 86_000.0);
    let kinds: [(&str, Files); 6] = [
        ("a straight course", Files::sound().run(RUN, straight)),
        (
            "a straight course, rudder in degrees",
            Files::sound().run(RUN, |t| {
                straight(t);
                degrees(t);
            }),
        ),
        ("a compass of 0.04 deg", Files::sound().all(coarse)),
        ("headings from 0 to 360 deg", Files::sound().all(wrapped)),
        ("another clock", Files::sound().all(started)),
        (
            "80 more columns",
            Files::sound().all(|t| {
                for i in 0..80 {
                    t.header.push(format!("pressure {i}"));
                    t.rows.iter_mut().for_each(|r| r.push(f64::from(i)));
                }
            }),
        ),
    ];
    for (name, files) in kinds {
        let audit = files.audit();
        assert!(doubts(&audit).is_empty(), "{name}: {:#?}", doubts(&audit));
        let most = audit.recordings.iter().map(|a| a.issues.len()).max().unwrap();
        assert!(most <= 1, "{name}: {most} notes on a run");
    }
}

/// A ship of the same length that is steered by its heading, recorded each second over ground in a current, with the noise of sensors:
/// `order` gives the rudder that is asked for from time, heading, yaw rate and rudder, which a gear of 2.5 deg/s follows.
fn steered(t: &mut Table, seed: u64, order: impl Fn(f64, f64, f64, f64) -> f64) {
    let (length, speed, gear) = (85.0, 5.0, 2.5_f64.to_radians());
    let mut random = seed;
    // Noise from -0.5 to 0.5 by a linear congruential generator (Knuth, MMIX).
    let mut noise = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let [mut x, mut y, mut psi, mut v, mut r, mut delta, mut gust] =
        [0.0, 0.0, 0.4 + seed as f64, 0.0, 0.0, 0.0, 0.0_f64];
    let first = psi;
    let mut rows = Vec::new();
    for second in 0..300 {
        let ground = [speed + 0.5 * psi.cos(), v - 0.5 * psi.sin()];
        let place = [x + noise(), y + noise(), psi + 5e-3 * noise()];
        rows.push([
            place[0],
            place[1],
            place[2],
            ground[0] + 0.1 * noise(),
            ground[1] + 0.8 * noise(),
            r + 5e-4 * noise(),
            2.0,
            delta,
        ]);
        gust = 0.95 * gust + 2e-4 * noise();
        for k in 0..20 {
            let (h, now) = (0.05, f64::from(second) + 0.05 * f64::from(k));
            delta += (order(now, psi - first, r, delta) - delta).clamp(-gear * h, gear * h);
            // A hull that is nearly unstable on its course, so that its sway has a long memory; rudder positive to starboard.
            let (vs, rs, step) = (v / speed, r * length / speed, h * speed / length);
            v += step * speed * (-0.5 * vs - 0.3 * rs - 0.18 * delta);
            r += step * speed / length * (-2.75 * vs - 1.73 * rs + 1.45 * delta) + h * gust;
            psi += h * r;
            x += h * (speed * psi.cos() - v * psi.sin() + 0.5);
            y += h * (speed * psi.sin() + v * psi.cos());
        }
    }
    t.rows = (0..rows.len()).map(|_| t.rows[0].clone()).collect();
    t.set("t", &(0..rows.len()).map(|i| i as f64).collect::<Vec<_>>());
    for (i, name) in ["x", "y", "psi", "u", "v", "r", "n", "delta"].iter().enumerate() {
        t.set(name, &rows.iter().map(|r| r[i]).collect::<Vec<_>>());
    }
}

/// Every run steered, by an autopilot that changes course, or in a zigzag of 20 deg; the rudder is recorded so many rows late.
fn closed_loop(zigzag: bool, late: usize) -> Files {
    let mut files = Files::sound();
    for (i, run) in files.runs().into_iter().enumerate() {
        let course = |now: f64| if now < 40.0 { 0.0 } else { 0.3 + 0.1 * (i % 7) as f64 };
        let autopilot = |now: f64, psi: f64, r: f64, _: f64| (1.2 * (course(now) - psi) - 12.0 * r).clamp(-0.35, 0.35);
        let switch = |now: f64, psi: f64, _: f64, delta: f64| {
            let side = if psi > 0.35 {
                -1.0
            } else if psi < -0.35 || delta == 0.0 {
                1.0
            } else {
                delta.signum()
            };
            if now < 10.0 + i as f64 { 0.0 } else { 0.35 * side }
        };
        files = files.run(&run, |t| {
            if zigzag {
                steered(t, i as u64, switch)
            } else {
                steered(t, i as u64, autopilot)
            }
            t.late("delta", late);
        });
    }
    files
}

#[test]
fn a_rudder_that_is_steered_by_the_heading_is_not_late_and_one_that_is_late_is_reported() {
    for zigzag in [false, true] {
        let sound = doubts(&closed_loop(zigzag, 0).audit());
        assert!(sound.is_empty(), "{zigzag}: {sound:#?}");
        for late in [4, 8] {
            let reported = doubts(&closed_loop(zigzag, late).audit());
            let right = |(run, issue): &(String, Issue)| {
                run == "study" && issue.fault == "clock" && issue.channel == Some(Channel::Delta)
            };
            assert!(reported.iter().any(right), "{zigzag} {late}: {reported:#?}");
        }
    }
}

#[test]
fn of_a_run_that_is_cut_the_part_is_audited_and_each_thing_is_reported_once() {
    // The damaged row is in the first part of three of one file; the unused column is reported once a file.
    let files = Files::sound().run(RUN, |t| {
        t.each("u", |i, u| if i == 20 { 3.0 * u } else { u });
        t.header.push("remark".into());
        t.rows.iter_mut().for_each(|r| r.push(1.0));
    });
    let runs: String = (0..3)
        .map(|i| format!("[[runs]]\nfile = \"recordings/{RUN}.csv\"\nname = \"part {i}\"\nsplit = \"{}\"\nfrom = {}.0\nto = {}.0\n",
            if i == 2 { "test" } else { "train" }, 80 * i, 80 * i + 79))
        .collect();
    let mut files = files.replace("study.toml", "runs = \"runs.csv\"", "");
    let text = files.0.get_mut("study.toml").unwrap();
    // Tables of the study come after its runs.
    let (head, tables) = text.split_once("[fit]").unwrap();
    *text = format!("{head}{runs}[fit]{tables}");
    let audit = files.audit();
    let of = |fault: &str| -> Vec<&str> {
        let reported = audit.recordings.iter().filter(|a| a.issues.iter().any(|i| i.fault == fault));
        reported.map(|a| a.run.as_str()).collect()
    };
    assert_eq!(of("outlier"), ["part 0"]);
    assert_eq!(of("unused"), ["part 0"]);
    assert_eq!(doubts(&audit).len(), 1, "{:#?}", doubts(&audit));
}

#[test]
fn what_the_audit_advises_mends_the_recording() {
    let late = Files::sound().all(|t| t.late("delta", 5)).map("[columns]\ndelta = { delay = 10.0 }\n");
    let filled = Files::sound().run(RUN, |t| t.each("x", |i, x| if i % 40 == 17 { -9999.0 } else { x }));
    let filled = filled.map("blank = -9999\nbridge = 5.0\n");
    let turned = Files::sound().all(|t| t.each("v", |_, v| -v)).map("[columns]\nv = { sign = -1 }\n");
    for (name, files) in [("delay", late), ("blank", filled), ("sign", turned)] {
        let found = doubts(&files.audit());
        assert!(found.is_empty(), "{name}: {found:#?}");
    }
}

#[test]
fn a_fault_of_one_channel_is_blamed_on_no_other() {
    let antenna = |t: &mut Table| {
        let psi = t.get("psi");
        t.each("x", |i, x| x + 12.0 * psi[i].cos());
        t.each("y", |i, y| y + 12.0 * psi[i].sin());
    };
    let of_channels: [(Files, &[Channel]); 3] = [
        (Files::sound().run(RUN, |t| t.each("r", |_, r| -r)), &[Channel::R]),
        (Files::sound().run(RUN, |t| t.each("u", |_, _| 0.0)), &[Channel::U]),
        // The lever is told of the sway of the track.
        (Files::sound().all(antenna), &[Channel::V]),
    ];
    for (files, channels) in of_channels {
        let found = doubts(&files.audit());
        let at_fault = |(_, issue): &(String, Issue)| issue.channel.is_some_and(|c| channels.contains(&c));
        assert!(!found.is_empty() && found.iter().all(at_fault), "{channels:?}: {found:#?}");
    }
}

#[test]
fn a_channel_that_one_run_lacks_is_an_error_and_one_that_all_lack_is_none() {
    let lacking = |files: Files| {
        let found = doubts(&files.audit());
        found
            .iter()
            .filter(|(_, i)| i.fault == "not_recorded")
            .map(|(r, i)| (r.clone(), i.severity))
            .collect::<Vec<_>>()
    };
    assert_eq!(lacking(Files::sound().run(RUN, |t| t.remove("psi"))), [(RUN.to_owned(), Severity::Error)]);
    let all = lacking(Files::sound().all(|t| t.remove("psi")));
    assert!(all.len() == 40 && all.iter().all(|(_, severity)| *severity == Severity::Warning), "{all:?}");
}

/// Damaged samples, fill values, missing channels.
fn samples() -> Vec<Case> {
    let one = |channel: &'static str, row: usize, change: fn(f64) -> f64| {
        Files::sound().run(RUN, move |t| t.each(channel, |i, v| if i == row { change(v) } else { v }))
    };
    let fill = |channel: &'static str, value: f64| {
        Files::sound().run(RUN, move |t| t.each(channel, |i, v| if i % 40 == 17 { value } else { v }))
    };
    let here = Where::Run(RUN);
    vec![
        case("first row of u x 3", one("u", 0, |u| 3.0 * u), "outlier", Channel::U, here, "blank"),
        case("a row of u x 3", one("u", 60, |u| 3.0 * u), "outlier", Channel::U, here, "blank"),
        case("last row of u x 3", one("u", 120, |u| 3.0 * u), "outlier", Channel::U, here, "blank"),
        case("one sample of n = 20 rps", one("n", 50, |_| 20.0), "outlier", Channel::N, here, "blank"),
        case("first sample of n = 20 rps", one("n", 0, |_| 20.0), "outlier", Channel::N, here, "blank"),
        case("one heading off by 20 deg", one("psi", 70, |p| p + 0.35), "outlier", Channel::Psi, here, "blank"),
        case(
            "x = 9.97e36 for missing",
            fill("x", 9.969_21e36),
            "fill_value",
            Channel::X,
            here,
            "`blank = 9.969210e36`",
        ),
        case("y = -9999 for missing", fill("y", -9999.0), "fill_value", Channel::Y, here, "`blank = -9999`"),
        case("x = 1e20 for missing", fill("x", 1e20), "fill_value", Channel::X, here, "`blank = 1.000000e20`"),
        case("y = 99999 for missing", fill("y", 99999.0), "fill_value", Channel::Y, here, "`blank = 99999`"),
        case("u = -9999 for missing", fill("u", -9999.0), "unreadable", None, here, "blank"),
        case("psi = 99999 for missing", fill("psi", 99999.0), "unreadable", None, here, "`blank = 99999`"),
        case("v = 12.5 for missing", fill("v", 12.5), "fill_value", Channel::V, here, "`blank = 12.5`"),
        case("no psi", Files::sound().run(RUN, |t| t.remove("psi")), "not_recorded", Channel::Psi, here, "column map"),
        case(
            "no x and y",
            Files::sound().run(RUN, |t| {
                t.remove("x");
                t.remove("y");
            }),
            "not_recorded",
            Channel::X,
            here,
            "column map",
        ),
        case(
            "an empty psi",
            Files::sound().run(RUN, |t| t.each("psi", |_, _| f64::NAN)),
            "unreadable",
            None,
            here,
            "leave out",
        ),
        case(
            "lat and lon instead of x and y",
            Files::sound().all(|t| {
                t.rename("x", "lat [deg]");
                t.rename("y", "lon [deg]");
            }),
            "not_used",
            Channel::X,
            Where::Runs(40),
            "111120",
        ),
    ]
}

/// Units, in all runs and in one.
fn units() -> Vec<Case> {
    let here = Where::Run(RUN);
    let scaled = |channel: &'static str, factor: f64| Files::sound().all(move |t| t.each(channel, |_, v| factor * v));
    vec![
        case("t in ms", scaled("t", 1000.0), "unit_error", Channel::R, Where::Runs(30), "column map"),
        case(
            "n in rad/s read as rps",
            scaled("n", std::f64::consts::TAU),
            "advance_ratio",
            Channel::N,
            Where::Runs(30),
            "unit of n",
        ),
        case(
            "n in rad/s in one run",
            Files::sound().run(RUN, |t| t.each("n", |_, n| std::f64::consts::TAU * n)),
            "advance_ratio",
            Channel::N,
            here,
            "unit of n",
        ),
        case(
            "degrees of latitude and longitude read as metres",
            Files::sound().all(|t| {
                t.each("x", |_, x| 54.0 + x / 111_200.0);
                t.each("y", |_, y| 10.0 + y / 111_200.0);
            }),
            "unit_error",
            Channel::U,
            Where::Runs(30),
            "--column lat=NAME --column lon=NAME",
        ),
        case("r in deg/s read as rad/s", scaled("r", 57.295_78), "unit_error", Channel::R, Where::Runs(30), "`unit`"),
        case(
            "u and v in knots read as m/s",
            Files::sound().all(|t| {
                t.each("u", |_, u| 1.943_844 * u);
                t.each("v", |_, v| 1.943_844 * v);
            }),
            "unit_error",
            Channel::U,
            Where::Runs(30),
            "`unit`",
        ),
        case(
            "the rudder in rad read as deg",
            Files::sound().all(|t| t.rename("delta", "delta [deg]")),
            "unit_error",
            Channel::Delta,
            Where::Runs(20),
            "rad",
        ),
    ]
}

/// Signs and axes, in all runs and in one.
fn sides() -> Vec<Case> {
    let here = Where::Run(RUN);
    let turned_in_all = |channel: &'static str| Files::sound().all(move |t| t.each(channel, |_, v| -v));
    let turned = |channel: &'static str| Files::sound().run(RUN, move |t| t.each(channel, |_, v| -v));
    let exchange = |t: &mut Table| {
        let (x, y) = (t.get("x"), t.get("y"));
        t.set("x", &y);
        t.set("y", &x);
    };
    vec![
        case("rudder sign in one run of 32", turned("delta"), "sign_error", Channel::Delta, here, "`sign = -1`"),
        case(
            "rudder sign in all runs",
            turned_in_all("delta"),
            "sign_error",
            Channel::Delta,
            Where::Runs(10),
            "`sign = -1`",
        ),
        case("v turned in one run", turned("v"), "sign_error", Channel::V, here, "`sign = -1`"),
        case("v turned in all runs", turned_in_all("v"), "sign_error", Channel::V, Where::Runs(30), "`sign = -1`"),
        case("r turned in one run", turned("r"), "sign_error", Channel::R, here, "`sign`"),
        case(
            "x and y exchanged",
            Files::sound().all(exchange),
            "axes_error",
            Channel::Psi,
            Where::Runs(30),
            "column map",
        ),
        case(
            "x and y exchanged in one run",
            Files::sound().run(RUN, exchange),
            "axes_error",
            Channel::Psi,
            here,
            "column map",
        ),
    ]
}

/// Clocks: of rudder and propeller in one run and in all, of a session.
fn clocks() -> Vec<Case> {
    let here = Where::Run(RUN);
    let sessions = |files: Files| {
        let mut files = files;
        let runs = files.0.get_mut("runs.csv").unwrap();
        let sessioned = runs.lines().enumerate().map(|(i, line)| match i {
            0 => format!("{line},session"),
            _ => format!("{line},day {}", 1 + i / 21),
        });
        *runs = sessioned.collect::<Vec<_>>().join("\n");
        files
    };
    let second_day = |channel: &'static str, rows: usize| {
        let sound = Files::sound();
        let runs: Vec<String> = sound.table_of_runs().into_iter().skip(20).collect();
        sessions(runs.iter().fold(sound, |files, run| files.run(run, |t| t.late(channel, rows))))
    };
    vec![
        case(
            "rudder 10 s late in one run",
            Files::sound().run(RUN, |t| t.late("delta", 5)),
            "clock",
            Channel::Delta,
            here,
            "`delay = 1",
        ),
        case(
            "n 10 s late in one run",
            Files::sound().run(RUN, |t| t.late("n", 5)),
            "clock",
            Channel::N,
            here,
            "`delay = 1",
        ),
        case(
            "rudder 10 s late in all runs",
            Files::sound().all(|t| t.late("delta", 5)),
            "clock",
            Channel::Delta,
            Where::Study,
            "`delay = 1",
        ),
        case(
            "n 10 s late in all runs",
            Files::sound().all(|t| t.late("n", 5)),
            "clock",
            Channel::N,
            Where::Study,
            "`delay = 1",
        ),
        case(
            "positions of one session 6 s late",
            sessions_positions(&second_day),
            "clock",
            Channel::X,
            Where::Study,
            "SESSION",
        ),
        case("yaw rate of one session 6 s late", second_day("r", 3), "clock", Channel::R, Where::Study, "SESSION"),
        case(
            "rudder of one session 4 s late",
            second_day("delta", 2),
            "clock",
            Channel::Delta,
            Where::Study,
            "SESSION",
        ),
    ]
}

/// What the runs show together: lags of a few rows, a unit.
fn together() -> Vec<Case> {
    let here = Where::Run(RUN);
    vec![
        case(
            "v in knots read as m/s in one run",
            Files::sound().run(RUN, |t| t.each("v", |_, v| 1.943_844 * v)),
            "unit_error",
            Channel::V,
            here,
            "`unit`",
        ),
        case(
            "n 6 s late in one run",
            Files::sound().run(RUN, |t| t.late("n", 3)),
            "clock",
            Channel::N,
            here,
            "`delay = 6",
        ),
        case(
            "n 8 s late in one run",
            Files::sound().run(RUN, |t| t.late("n", 4)),
            "clock",
            Channel::N,
            here,
            "`delay = 8",
        ),
        case(
            "n 4 s late in all runs",
            Files::sound().all(|t| t.late("n", 2)),
            "clock",
            Channel::N,
            Where::Study,
            "`delay = 4",
        ),
        case(
            "yaw rate 4 s late in all runs",
            Files::sound().all(|t| t.late("r", 2)),
            "clock",
            Channel::R,
            Where::Study,
            "`delay = 4",
        ),
    ]
}

/// Names, units and conventions of a foreign layout.
fn foreign() -> Vec<Case> {
    let all = Where::Runs(30);
    let kilometres = |t: &mut Table| ["x", "y"].iter().for_each(|c| t.rename(c, &format!("{c} [km]")));
    let in_kilometres = |t: &mut Table| ["x", "y"].iter().for_each(|c| t.each(c, |_, v| 1e-3 * v));
    let geographic = |t: &mut Table| {
        t.rename("x", "lat [deg]");
        t.rename("y", "lon [deg]");
    };
    let mathematical = |t: &mut Table| t.each("psi", |_, p| std::f64::consts::FRAC_PI_2 - p);
    let no_velocity = |t: &mut Table| {
        mathematical(t);
        ["u", "v", "r"].iter().for_each(|c| t.remove(c));
    };
    let derived = Files::sound().all(no_velocity).map("derive = [\"u\", \"v\", \"r\"]\n");
    let minutes = |t: &mut Table| t.each("t", |_, v| v / 60.0);
    let heading = Files::sound().run(RUN, |t| t.rename("psi", "heading"));
    let (unit, axes) = ("unit_error", "axes_error");
    let (x, psi, r, u) = (Channel::X, Channel::Psi, Channel::R, Channel::U);
    let east = "anticlockwise from east";
    vec![
        case("x and y in m read as km", Files::sound().all(kilometres), unit, u, all, "of x and y"),
        case("x and y in km read as m", Files::sound().all(in_kilometres), unit, u, all, "of x and y"),
        case("t in min read as s", Files::sound().all(minutes), unit, r, all, "`unit` of t"),
        case("t in min read as s, by the track", Files::sound().all(minutes), unit, u, all, "`unit` of t"),
        case("t in s read as min", Files::sound().all(|t| t.rename("t", "t [min]")), unit, u, all, "`unit` of t"),
        case("psi as `heading`", heading, "not_recorded", psi, Where::Run(RUN), "column `heading` looks like psi"),
        case("lat and lon", Files::sound().all(geographic), "not_recorded", x, Where::Runs(40), "`trimtab import`"),
        case("a mathematical heading", Files::sound().all(mathematical), axes, psi, all, east),
        case("a mathematical heading and no velocity", derived, axes, psi, Where::Runs(20), "anticlockwise, from east"),
    ]
}

/// Headings and fixes.
fn places() -> Vec<Case> {
    let here = Where::Run(RUN);
    let through_north = Files::sound().run(RUN, |t| {
        // The run is turned so that it sails through north, and its compass read every sixth second only.
        let (psi, r) = (t.get("psi"), t.get("r"));
        let fastest = (0..r.len()).max_by(|i, j| r[*i].abs().total_cmp(&r[*j].abs())).unwrap() / 3 * 3 + 1;
        let read = |i: usize| (psi[i] - psi[fastest]).to_degrees().rem_euclid(360.0);
        let between = |i: usize| {
            let (from, share) = (i / 3 * 3, (i % 3) as f64 / 3.0);
            let to = (from + 3).min(psi.len() - 1);
            (read(from) + share * (read(to) - read(from))).to_radians()
        };
        t.each("psi", |i, _| between(i));
    });
    vec![
        case(
            "heading interpolated through 360",
            through_north,
            "heading_wrap",
            Channel::Psi,
            here,
            "`wrap_repair = true`",
        ),
        case(
            "a fix 300 m off",
            Files::sound().run(RUN, |t| t.each("y", |i, y| if i == 80 { y + 300.0 } else { y })),
            "fix_jump",
            Channel::X,
            here,
            "blank",
        ),
        case(
            "the position jumps and stays",
            Files::sound().run(RUN, |t| t.each("x", |i, x| if i >= 60 { x - 200.0 } else { x })),
            "fix_jump",
            Channel::X,
            here,
            "blank",
        ),
        case(
            "a wrong time stamp",
            Files::sound().run(RUN, |t| t.each("t", |i, v| if i == 60 { v + 0.9 } else { v })),
            "fix_jump",
            Channel::X,
            here,
            "time stamp",
        ),
        case(
            "a frozen heading",
            Files::sound().run(RUN, |t| {
                let held = t.get("psi")[40];
                t.each("psi", |i, p| if (40..60).contains(&i) { held } else { p });
            }),
            "frozen",
            Channel::Psi,
            here,
            "blank",
        ),
    ]
}

/// Samples that two runs have in common.
fn shared() -> Vec<Case> {
    vec![
        case(
            "the same recording on both sides",
            copied("ship_a_001", 0, 121),
            "shared_data",
            None,
            Where::Study,
            "one side",
        ),
        case(
            "a recording under two names",
            copied("ship_a_003", 0, 121),
            "shared_data",
            None,
            Where::Study,
            "leave one",
        ),
        case(
            "a part of a recording on both sides",
            copied("ship_a_001", 60, 121),
            "shared_data",
            None,
            Where::Study,
            "one side",
        ),
    ]
}

/// Positions of a session late: x and y together.
fn sessions_positions(second_day: &impl Fn(&'static str, usize) -> Files) -> Files {
    let runs: Vec<String> = Files::sound().table_of_runs().into_iter().skip(20).collect();
    runs.iter().fold(second_day("x", 3), |files, run| files.run(run, |t| t.late("y", 3)))
}

/// Rows of another run, with another clock and another origin, in a run to train on.
fn copied(other: &str, from: usize, to: usize) -> Files {
    let other = Files::sound().table(other);
    Files::sound().run("ship_a_002", |t| {
        let mut rows = other.rows[from..to].to_vec();
        rows.iter_mut().for_each(|r| {
            r[0] += 1000.0;
            r[1] -= 50.0;
        });
        t.rows = rows;
    })
}

impl Files {
    /// The runs in the order listed.
    fn table_of_runs(&self) -> Vec<String> {
        self.0["runs.csv"].lines().skip(1).map(|l| l.split(',').nth(1).unwrap().to_owned()).collect()
    }
}

#[test]
fn the_runs_of_a_session_show_together_a_rudder_that_none_shows_by_itself() {
    const FEW: [&str; 6] = ["ship_a_031", "ship_a_032", "ship_a_036", "ship_a_037", "ship_a_057", "ship_a_058"];
    // Of these zigzags the recordings have the first rudder alone.
    let mut short = closed_loop(true, 0).all(|t| t.rows.truncate(55));
    let listed = short.0.get_mut("runs.csv").unwrap();
    let kept = |(i, line): &(usize, &str)| *i == 0 || FEW.iter().any(|run| line.contains(run));
    *listed = listed.lines().enumerate().filter(kept).map(|(_, line)| format!("{line}\n")).collect();
    let turned = FEW.iter().fold(short.clone(), |files, run| files.run(run, |t| t.each("delta", |_, v| -v)));
    let of_sign = |files: &Files| -> Vec<(String, Issue)> {
        doubts(&files.audit()).into_iter().filter(|(_, i)| i.fault == "sign_error").collect()
    };
    assert!(of_sign(&short).is_empty(), "{:#?}", of_sign(&short));
    let reported = of_sign(&turned);
    let together = |(run, i): &(String, Issue)| {
        FEW.contains(&run.as_str()) && i.channel == Some(Channel::Delta) && i.text.contains("show together")
    };
    assert!(reported.len() == FEW.len() && reported.iter().all(together), "{reported:#?}");
}

#[test]
fn every_fault_is_reported_with_its_run_its_channel_and_what_to_do() {
    let mut missed = Vec::new();
    let cases: Vec<Case> = [samples(), units(), sides(), clocks(), together(), foreign(), places(), shared()]
        .into_iter()
        .flatten()
        .collect();
    assert!(cases.len() >= 30, "{}", cases.len());
    for Case { name, files, fault, channel, place, next } in cases {
        let found = doubts(&files.audit());
        let is = |i: &Issue| i.fault == fault && i.channel == channel && i.next_step.contains(next);
        let runs: Vec<&str> = found.iter().filter(|(_, i)| is(i)).map(|(run, _)| run.as_str()).collect();
        let seen = match place {
            Where::Run(run) => runs == [run] && found.iter().all(|(r, _)| r == run),
            Where::Runs(least) => runs.len() >= least,
            Where::Study => runs.contains(&"study"),
        };
        if !seen {
            missed.push(format!("{name}: {fault} {channel:?} {place:?} {next}\n    {found:?}"));
        }
    }
    assert!(missed.is_empty(), "{} missed\n{}", missed.len(), missed.join("\n"));
}
