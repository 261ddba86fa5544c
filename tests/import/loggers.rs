//! Import, kind by kind: what loggers write that was once misread, each on a small log of a ship that turns to both sides.
//! That a log comes back as it was sailed is tested in `logs.rs`; here it is what a column, a clock or a gap is taken for.

use crate::support::study::{Study, contains_all};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use trimtab::recording::Channel;
use trimtab::recording::import::{Choices, ImportSettings, Imported, import};

const DEGREE: f64 = std::f64::consts::PI / 180.0;
const KNOT: f64 = 1852.0 / 3600.0;

/// A row of the log: seconds, latitude and longitude [deg], course, heading and rudder [deg], rate of turn [deg/min].
#[derive(Clone, Copy)]
struct Row {
    t: f64,
    place: [f64; 2],
    course: f64,
    heading: f64,
    rudder: f64,
    rate: f64,
}

/// Ten knots on legs to all sides with a zigzag in each, two seconds a row; `current` [m/s] sets to the north.
fn sailed(current: f64) -> Vec<Row> {
    let (mut psi, mut r, mut place) = (0.5_f64, 0.0_f64, [36.5_f64, 14.25_f64]);
    let mut rows = Vec::new();
    for i in 0..600 {
        let rudder = match i % 150 {
            40..50 | 70..80 => 10.0,
            55..65 => -12.0,
            // A quarter of a turn, more or less, to the next leg.
            90..110 => 14.0,
            _ => 0.0,
        };
        r += 2.0 * (0.11 * rudder * DEGREE - r) / 8.0;
        psi += 2.0 * r;
        let (north, east) = (10.0 * KNOT * psi.cos() + current, 10.0 * KNOT * psi.sin());
        place[0] += (2.0 * north / 6.359e6).to_degrees();
        place[1] += (2.0 * east / (6.386e6 * place[0].to_radians().cos())).to_degrees();
        let turned = |angle: f64| angle.to_degrees().rem_euclid(360.0);
        let course = turned(east.atan2(north));
        rows.push(Row { t: 2.0 * f64::from(i), place, course, heading: turned(psi), rudder, rate: r / DEGREE * 60.0 });
    }
    rows
}

fn iso(t: f64) -> String {
    let s = t as usize + 36_000;
    format!("2021-06-03T{:02}:{:02}:{:02}Z", s / 3600, s / 60 % 60, s % 60)
}

const NAMES: &str = "time,lat,lon,sog_kn,cog,heading,rudder,rpm";

fn fields(row: &Row) -> String {
    let [lat, lon] = row.place;
    format!("{},{lat:.7},{lon:.7},10.00,{:.2},{:.2},{:.1},120", iso(row.t), row.course, row.heading, row.rudder)
}

/// The usual log with further columns behind it.
fn log(more: &str, value: impl Fn(&Row) -> String) -> String {
    let mut text = format!("{NAMES}{more}\n");
    sailed(0.0).iter().for_each(|row| text += &format!("{}{}\n", fields(row), value(row)));
    text
}

fn written(text: &str, settings: &ImportSettings) -> Result<Imported, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    std::fs::write(&path, text).unwrap();
    import(&[path], settings).map_err(|e| e.to_string())
}

fn read(text: &str) -> Imported {
    written(text, &ImportSettings::default()).unwrap_or_else(|e| panic!("{e}\n{}", text.lines().next().unwrap()))
}

fn taken<'a>(imported: &'a Imported, quantity: &str) -> &'a str {
    imported.taken.iter().find(|t| t.quantity == quantity).map_or("", |t| t.column.as_str())
}

fn channel(imported: &Imported, recording: usize, channel: Channel) -> &[f64] {
    let channels = &imported.recordings[recording].rows.channels;
    &channels.iter().find(|(c, _)| *c == channel).unwrap_or_else(|| panic!("no {channel}")).1
}

fn notes(imported: &Imported) -> String {
    imported.notes.join("\n")
}

/// The largest difference of the headings that were imported from those that were sailed [deg].
fn off(imported: &Imported) -> f64 {
    off_by(imported, 0.0)
}

/// The same from headings so many degrees more.
fn off_by(imported: &Imported, more: f64) -> f64 {
    let rows = sailed(0.0);
    let psi = channel(imported, 0, Channel::Psi);
    let apart =
        |(psi, row): (&f64, &Row)| ((psi / DEGREE - row.heading - more + 180.0).rem_euclid(360.0) - 180.0).abs();
    psi.iter().zip(&rows).map(apart).fold(0.0, f64::max)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn a_column_is_taken_for_what_it_is_and_not_for_one_word_of_its_name() {
    let others = [
        "delta_t",
        "AW_speed [kn]",
        "tau_surge",
        "tau_sway",
        "last_speed_update",
        "rudder_rate",
        "rudder time",
        "wind speed over ground",
        "gyro_x",
        "speed of sound",
        "COG to waypoint",
        "rudder_t",
        "heading error",
    ];
    for other in others {
        // It comes first, and has numbers of a size that would do.
        let text = log("", |_| String::new());
        let before = |(i, line): (usize, &str)| {
            let cell = if i == 0 { other.to_owned() } else { format!("{:.3}", 2.0 + 0.1 * (i % 7) as f64) };
            let (time, rest) = line.split_once(',').unwrap();
            format!("{time},{cell},{rest}\n")
        };
        let imported = read(&text.lines().enumerate().map(before).collect::<String>());
        let name = other.split(" [").next().unwrap();
        for quantity in ["lat", "lon", "sog", "cog", "psi", "delta", "n"] {
            let column = taken(&imported, quantity);
            assert!(!column.is_empty() && column != name, "{quantity} is `{column}`");
        }
        assert!(["u", "v"].iter().all(|q| taken(&imported, q).is_empty()), "{other}");
        assert!(off(&imported) < 0.01, "{other}");
    }
    let text = log(",yaw_velocity,gyro_z", |row| format!(",{0:.6},{0:.6}", row.rate / 60.0 * DEGREE));
    let imported = read(&text.replace("heading", "yaw"));
    assert_eq!(["psi", "r"].map(|q| taken(&imported, q)), ["yaw", "yaw_velocity"]);
}

#[test]
fn a_column_may_be_called_by_its_header_with_the_unit() {
    let text = log("", |_| String::new()).replace(",heading,", ",bow [deg],");
    for name in ["bow [deg]", "bow"] {
        let choices = Choices { columns: [("psi".to_owned(), name.to_owned())].into(), ..Choices::default() };
        let imported = written(&text, &ImportSettings { choices, ..ImportSettings::default() }).unwrap();
        assert!(off(&imported) < 0.01, "{name}");
    }
}

#[test]
fn of_columns_that_are_named_alike_the_one_that_agrees_with_the_data_is_taken() {
    let text = log(",hdg,Speed A [kn],gyro z,rate of turn [deg/min]", |row| {
        format!(",{:.1},{:.2},{:.4},{:.3}", (40.0 * row.t).rem_euclid(360.0), 19.0, 0.2 * row.t.sin(), row.rate)
    });
    let imported = read(&text.replace("sog_kn", "Speed B [kn]"));
    let found = ["psi", "sog", "r"].map(|q| taken(&imported, q));
    assert_eq!(found, ["heading", "Speed B", "rate of turn"]);
    let why = imported.unused.iter().find(|u| u.column == "Speed A").unwrap();
    contains_all(&why.why, &["`Speed B` is taken", "--column sog=Speed A"]);
}

#[test]
fn of_equals_the_one_that_agrees_more_closely_is_taken() {
    // A log 4 % off the speed over ground, a compass 7 deg off the gyro's, and an autopilot's course.
    let text = log(",Speed 2,Heading gyro", |row| format!(",10.00,{:.2}", row.heading));
    let wrong = |line: &str| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if let Ok(heading) = cells[5].parse::<f64>() {
            cells[3] = "10.40".to_owned();
            cells[5] = format!("{:.2}", (heading + 7.0).rem_euclid(360.0));
        }
        cells.join(",") + "\n"
    };
    for heading in ["Heading 1", "Heading A/P"] {
        let text: String = text.lines().map(wrong).collect();
        let imported = read(&text.replace("sog_kn", "Speed 1").replace(",heading", &format!(",{heading}")));
        assert_eq!(["sog", "psi"].map(|q| taken(&imported, q)), ["Speed 2", "Heading gyro"], "{heading}");
    }
}

#[test]
fn of_two_sensors_the_calm_one_is_taken() {
    // Noise of some degrees that no course shows, and a gyro at rest between them.
    let noise = |row: &Row| 4.0 * (1.7 * row.t * row.t).sin();
    let both = |row: &Row| format!(",{:.2},{:.2}", (row.heading + noise(row)).rem_euclid(360.0), row.heading);
    let text = log(",Heading 1,Heading 2", both).replace(",heading,", ",other,");
    assert_eq!(taken(&read(&text), "psi"), "Heading 2");
}

#[test]
fn an_angle_and_a_rate_with_a_column_for_each_side_are_asked_for() {
    let sides = |v: f64| format!(",{:.1},{:.1}", v.max(0.0), (-v).max(0.0));
    let none = ImportSettings::default();
    let text = log(",Rudder starboard,Rudder port", |row| sides(row.rudder)).replace(",rudder,", ",other,");
    let said = written(&text, &none).unwrap_err();
    contains_all(&said, &["are one rudder angle to two sides", "write their difference to one column"]);
    let text = log(",RPM ahead,RPM astern", |row| sides(120.0 * (0.01 * row.t).cos())).replace(",rpm,", ",other,");
    contains_all(&written(&text, &none).unwrap_err(), &["`RPM ahead` and `RPM astern`", "--column n=NAME"]);
    // Two rudders turn together.
    let two = log(",Rudder starboard,Rudder port", |row| format!(",{0:.1},{0:.1}", row.rudder));
    assert!(written(&two.replace(",rudder,", ",other,"), &none).is_ok());
}

#[test]
fn a_vertical_velocity_is_none_along_the_ship() {
    let along = |row: &Row| row.course.to_radians().sin_cos();
    let axes = |row: &Row| {
        let (sin, cos) = along(row);
        format!(",{:.3},{:.3},0.02", 10.0 * KNOT * sin, 10.0 * KNOT * cos)
    };
    for header in [",E Velocity (m/s),N Velocity (m/s),U Velocity (m/s)", ",V_E [m/s],V_N [m/s],V_U [m/s]"] {
        let imported = read(&log(header, axes).replace("sog_kn,cog", "a,b"));
        let u = channel(&imported, 0, Channel::U);
        assert!((mean(u) - 10.0 * KNOT).abs() < 0.02, "{header}: {}", mean(u));
        assert!(imported.unused.iter().any(|unused| unused.why.contains("vertical velocity")), "{header}");
    }
}

#[test]
fn names_that_say_less_are_told_apart_by_those_that_say_more() {
    let text = log(",Speed OG [kn],Helm,Rudder response", |row| format!(",10.00,{0:.1},{0:.1}", row.rudder));
    let imported = read(&text.replace("sog_kn", "Speed [kn]").replace(",rudder,", ",other,"));
    assert_eq!(["sog", "delta"].map(|q| taken(&imported, q)), ["Speed OG", "Rudder response"]);
    // A wind that is said to go somewhere comes from the other side: it is left out.
    let to = read(&log(",Wind Dir (to),Wind Speed [m/s]", |_| ",80,6.0".to_owned()));
    assert_eq!(taken(&to, "wind_direction"), "");
    assert!(to.unused.iter().any(|unused| unused.column == "Wind Dir to"));
}

/// The usual log with its cells changed, and a header of its own.
fn changed(header: &str, cells: impl Fn(&Row, Vec<String>) -> Vec<String>) -> String {
    let line = |row: &Row| cells(row, fields(row).split(',').map(str::to_owned).collect()).join(",") + "\n";
    format!("{header}\n{}", sailed(0.0).iter().map(line).collect::<String>())
}

#[test]
fn degrees_and_minutes_in_columns_of_their_own_are_one_place() {
    for (header, sides) in [
        ("time,Lat deg,Lat min,N/S,Lon deg,Lon min,E/W,sog_kn,cog,heading,rudder,rpm", true),
        ("time,Lat D,Lat M,Lon D,Lon M,sog_kn,cog,heading,rudder,rpm", false),
    ] {
        let text = changed(header, |row, mut cells| {
            let arc = |v: f64, side: &str| {
                let mut both = vec![format!("{:.0}", v.floor()), format!("{:.5}", 60.0 * v.fract())];
                both.extend(sides.then(|| side.to_owned()));
                both
            };
            cells.splice(1..3, [arc(row.place[0], "N"), arc(row.place[1], "E")].concat());
            cells
        });
        let imported = read(&text);
        let [lat, lon] = imported.origin.unwrap();
        assert!(
            (lat - 36.5).abs() < 0.1 && (lon - 14.25).abs() < 0.1 && off(&imported) < 0.01,
            "{header}: {lat} {lon}"
        );
        let x = channel(&imported, 0, Channel::X);
        let sailed = (sailed(0.0)[200].place[0] - sailed(0.0)[0].place[0]).to_radians() * 6.359e6;
        assert!((x[200] - x[0] - sailed).abs() < 5.0, "{header}");
        contains_all(&notes(&imported), &["degrees and parts of one arc"]);
    }
}

#[test]
fn a_share_of_an_actuator_is_asked_for_with_the_line_that_takes_it() {
    let rudder = |share: f64| {
        move |row: &Row, mut cells: Vec<String>| {
            // Hard over a few times, at 35 deg.
            let angle = if row.rudder == 14.0 { 35.0 } else { row.rudder };
            cells[6] = format!("{:.4}", angle * share / 35.0);
            cells
        }
    };
    let percent = "time,lat,lon,sog_kn,cog,heading,RUDDER,rpm";
    for (name, share, line) in [
        ("Rudder %", 100.0, "--unit delta='0.35 deg'"),
        ("Rudder [%]", 100.0, "--unit delta='0.35 deg'"),
        ("Rudder (pct)", 100.0, "--unit delta='0.35 deg'"),
        ("rudder_pct", 100.0, "--unit delta='0.35 deg'"),
        ("Rudder", 100.0, "--unit delta='0.35 deg'"),
        ("Rudder", 1.0, "--unit delta='35 deg'"),
    ] {
        let text = changed(&percent.replace("RUDDER", name), rudder(share));
        let asked = written(&text, &ImportSettings::default()).unwrap_err();
        contains_all(&asked, &[line]);
        let unit = line.split('\'').nth(1).unwrap().to_owned();
        let choices = Choices { units: [("delta".to_owned(), unit)].into(), ..Choices::default() };
        let imported = written(&text, &ImportSettings { choices, ..ImportSettings::default() }).unwrap();
        let most = channel(&imported, 0, Channel::Delta).iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        assert!((most - 35.0 * DEGREE).abs() < 1e-3, "{name}: {most}");
    }
    let text = log("", |_| String::new()).replace(",rpm", ",RPM %");
    contains_all(&written(&text, &ImportSettings::default()).unwrap_err(), &["--unit n='1.5 rpm'"]);
}

#[test]
fn a_direction_in_parts_of_a_turn_is_asked_for_with_its_unit() {
    for (parts, unit) in [(400.0, "0.9 deg"), (3600.0, "0.1 deg"), (65_536.0, "0.0054931640625 deg")] {
        let text = changed(NAMES, |row, mut cells| {
            cells[5] = format!("{:.2}", (row.heading * parts / 360.0).min(parts));
            cells
        });
        contains_all(&written(&text, &ImportSettings::default()).unwrap_err(), &[&format!("--unit psi='{unit}'")]);
        let choices = Choices { units: [("psi".to_owned(), unit.to_owned())].into(), ..Choices::default() };
        assert!(off(&written(&text, &ImportSettings { choices, ..ImportSettings::default() }).unwrap()) < 0.02);
    }
}

#[test]
fn a_rudder_that_is_not_counted_from_midships_is_told_its_offset() {
    let text = changed(NAMES, |row, mut cells| {
        cells[6] = format!("{:.1}", row.rudder + 35.0);
        cells
    });
    contains_all(&written(&text, &ImportSettings::default()).unwrap_err(), &["35.0 is midships", "--unit delta=deg"]);
    let choices = Choices { units: [("delta".to_owned(), "deg".to_owned())].into(), ..Choices::default() };
    let imported = written(&text, &ImportSettings { choices, ..ImportSettings::default() }).unwrap();
    contains_all(&notes(&imported), &["delta = { offset = -0.6109 }"]);
}

#[test]
fn a_pitch_that_is_set_and_a_telegraph_are_heeded() {
    let pitch = |row: &Row| if row.t < 600.0 { "80" } else { "-40" };
    let imported = read(&log(",CPP pitch %", |row| format!(",{}", pitch(row))));
    contains_all(&imported.notes[0], &["WARNING: column `CPP pitch %` goes from -40.0 to 80.0", "--column n=NAME"]);
    let telegraph = |row: &Row| if row.t < 600.0 { "FULL AHEAD" } else { "HALF ASTERN" };
    let imported = read(&log(",Remark,Telegraph", |row| format!(",-,{}", telegraph(row))));
    let n = channel(&imported, 0, Channel::N);
    assert!(n[10] > 1.9 && n[400] < -1.9, "{} {}", n[10], n[400]);
    // The ship backs without a sign.
    let text = changed(NAMES, |row, mut cells| {
        cells[5] = format!("{:.2}", (row.heading + if row.t < 600.0 { 0.0 } else { 180.0 }).rem_euclid(360.0));
        cells
    });
    contains_all(&notes(&read(&text)), &["never negative while the ship goes astern", "lacks its sign"]);
}

#[test]
fn a_date_with_the_month_first_beside_a_time_is_a_date() {
    let text = changed("Date,Time,lat,lon,sog_kn,cog,heading,rudder,rpm", |_, mut cells| {
        let time = cells[0][11..19].to_owned();
        cells.splice(0..1, ["10/22/2025".to_owned(), time]);
        cells
    });
    let starts: Vec<_> = read(&text).recordings.iter().map(|r| r.start.clone().unwrap_or_default()).collect();
    assert_eq!(starts, ["2025-10-22 10:00:00"]);
    let far = changed(NAMES, |row, mut cells| {
        cells[0] = format!("{}", 1e10 + row.t);
        cells
    });
    contains_all(&notes(&read(&far)), &["WARNING: the times begin at 2286-11-20"]);
}

#[test]
fn sentences_that_are_not_read_are_named_where_a_column_is_missing() {
    let sentences = |row: &Row| format!("{}{}", rmc(row, "N", "E", ","), summed("PSAT,HPR,1,2.0"));
    let asked = written(&sailed(0.0).iter().map(sentences).collect::<String>(), &ImportSettings::default());
    contains_all(&asked.unwrap_err(), &["no column is the heading", "sentences that are not used: PSAT 600", "CSV"]);
}

#[test]
fn of_an_order_and_a_feedback_the_feedback_is_the_angle() {
    // The order leaps; what is recorded as the rudder follows it at two and a half degrees a second.
    let orders: Vec<String> = sailed(0.0).iter().map(|row| format!("{:.1}", row.rudder)).collect();
    let mut angle = 0.0_f64;
    let follow = |order: &String| {
        angle += (order.parse::<f64>().unwrap() - angle).clamp(-2.0, 2.0);
        format!("{angle:.2}")
    };
    let angles: Vec<String> = orders.iter().map(follow).collect();
    let of = |first: &str, second: &str, swapped: bool| {
        let text = log("", |_| String::new());
        let rows = text.lines().enumerate().map(|(i, line)| {
            let mut cells: Vec<&str> = line.split(',').collect();
            let both = [&orders, &angles].map(|column| if i == 0 { "" } else { column[i - 1].as_str() });
            let [a, b] = if i == 0 { [first, second] } else { both };
            cells.splice(6..7, if swapped { [b, a] } else { [a, b] });
            cells.join(",") + "\n"
        });
        read(&rows.collect::<String>())
    };
    for (order, rudder) in [
        ("Rudder SP", "Rudder PV"),
        ("Rudder Dmd", "Rudder Act"),
        ("Consigna timón", "Ángulo de timón"),
        ("Autopilot rudder", "Steering gear position"),
        ("Helm", "Rudder"),
        ("rudder 1", "rudder 2"),
        ("rudder", "rudder angle"),
    ] {
        for swapped in [false, true] {
            let imported = of(order, rudder, swapped);
            let found = ["delta", "delta_order"].map(|q| taken(&imported, q));
            assert_eq!(found, [rudder, order], "{:?}", imported.unused);
        }
    }
    let evidence =
        |imported: &Imported| imported.taken.iter().find(|t| t.quantity == "delta").unwrap().evidence.clone();
    contains_all(&evidence(&of("rudder 1", "rudder 2", false)), &["`rudder 1` leads it and leaps faster"]);
}

#[test]
fn a_column_that_names_no_sensor_is_of_none_other_and_a_letter_is_less_than_a_unit() {
    // A speed through water that is called so by nobody, before that of the receiver.
    let text = log(",GPS speed [kn]", |_| ",10.0".to_owned()).replace("sog_kn", "Speed [kn]");
    assert_eq!(taken(&read(&text), "sog"), "GPS speed");
    // A counter.
    let text =
        log(",n,ME speed [rpm]", |row| format!(",{},{:.1}", row.t, 120.0 + row.rudder)).replacen("rpm", "gear", 1);
    assert_eq!(taken(&read(&text), "n"), "ME speed");
    // Of two receivers of one rank the one that has more.
    let text = log(",Lat 2,Lon 2", |row| format!(",{:.7},{:.7}", row.place[0], row.place[1]));
    let half = |(i, line): (usize, &str)| {
        let (time, rest) = line.split_once(',').unwrap();
        let mut cells: Vec<&str> = rest.split(',').collect();
        if i > 300 {
            cells[..2].fill("");
        }
        format!("{time},{}\n", cells.join(","))
    };
    let text = text.replacen("lat,lon", "Lat 1,Lon 1", 1).lines().enumerate().map(half).collect::<String>();
    assert_eq!(["lat", "lon"].map(|q| taken(&read(&text), q).to_owned()), ["Lat 2", "Lon 2"]);
    // The heading of an autopilot is an order.
    let text = log(",Gyrocompass [deg]", |row| format!(",{:.2}", row.heading)).replace("heading", "AP Heading [deg]");
    assert_eq!(taken(&read(&text), "psi"), "Gyrocompass");
}

#[test]
fn a_unit_that_is_not_known_is_asked_for_or_costs_its_column() {
    let text = log(",Depth (faden)", |_| ",20.1".to_owned());
    let imported = read(&text);
    assert!(taken(&imported, "depth").is_empty());
    let why = &imported.unused.iter().find(|u| u.column == "Depth").unwrap().why;
    contains_all(why, &["the unit `faden` of column `Depth`", "is not known: pass `--unit depth=m or "]);
    let text = text.replacen("rudder", "rudder [increments]", 1);
    let said = written(&text, &ImportSettings::default()).unwrap_err();
    contains_all(&said, &["the unit `increments` of column `rudder`", "`--unit delta=rad or deg"]);
    let choices = Choices { units: [("delta".to_owned(), "deg".to_owned())].into(), ..Choices::default() };
    let imported = written(&text, &ImportSettings { choices, ..ImportSettings::default() }).unwrap();
    assert_eq!(taken(&imported, "delta"), "rudder");
}

#[test]
fn a_pair_is_of_one_sensor() {
    let text = log(",GPS2 lon,GPS2 lat,STW Trans [kn],STW Long [kn]", |row| {
        format!(",{:.6},{:.6},0.1,9.8", row.place[1] + 0.001, row.place[0])
    });
    let imported = read(&text.replace("time,lat,lon", "time,GPS1 lat,GPS1 lon"));
    assert_eq!(["lat", "lon"].map(|q| taken(&imported, q)), ["GPS1 lat", "GPS1 lon"]);
    assert_eq!(["u_water", "v_water"].map(|q| taken(&imported, q)), ["STW Long", "STW Trans"]);
    let second = Choices { columns: [("lat".to_owned(), "GPS2 lat".to_owned())].into(), ..Choices::default() };
    let text = text.replace("time,lat,lon", "time,GPS1 lat,GPS1 lon");
    let imported = written(&text, &ImportSettings { choices: second, ..ImportSettings::default() }).unwrap();
    assert_eq!(taken(&imported, "lon"), "GPS2 lon");
}

#[test]
fn columns_of_one_name_are_columns_of_their_own() {
    let off = |row: &Row| (row.heading + 20.0).rem_euclid(360.0);
    // One that is dead comes first, one that is as sound comes second and is passed for the heading.
    let text = log("", |_| String::new());
    let dead = |(i, line): (usize, &str)| {
        let (time, rest) = line.split_once(',').unwrap();
        format!("{time},{},{rest}\n", if i == 0 { "heading" } else { "123.0" })
    };
    let imported = read(&text.lines().enumerate().map(dead).collect::<String>());
    assert_eq!(taken(&imported, "psi"), "heading (2)");
    assert!(off_by(&imported, 0.0) < 0.01);
    let text = log(",heading", |row| format!(",{:.2}", off(row)));
    assert_eq!(taken(&read(&text), "psi"), "heading");
    let columns = [("psi".to_owned(), "Heading (2)".to_owned())].into();
    let settings = ImportSettings { choices: Choices { columns, ..Choices::default() }, ..ImportSettings::default() };
    let imported = written(&text, &settings).unwrap();
    assert!(off_by(&imported, 20.0) < 0.01);
}

#[test]
fn a_wind_angle_counts_from_the_bow_and_a_direction_from_north() {
    let angle = |row: &Row| format!(",8.0,{:.1}", 260.0 - row.heading);
    let imported = read(&log(",True Wind Speed [m/s],True Wind Angle [deg]", angle));
    let directions = channel(&imported, 0, Channel::WindDirection);
    assert!(directions.iter().all(|d| ((d / DEGREE - 260.0 + 180.0).rem_euclid(360.0) - 180.0).abs() < 0.2));
    let both = |row: &Row| format!(",{:.1},260,8.0", 260.0 - row.heading);
    let imported = read(&log(",Ground Wind Angle °,Ground Wind Direction °,Ground Wind Speed m/s", both));
    assert_eq!(taken(&imported, "wind_direction"), "Ground Wind Direction");
    assert!(channel(&imported, 0, Channel::WindDirection).iter().all(|d| (d / DEGREE + 100.0).abs() < 0.1));
}

#[test]
fn a_magnetic_heading_is_brought_to_true_north_by_the_variation_or_reported() {
    let magnetic = |row: &Row| format!("{:.2}", (row.heading + 12.4).rem_euclid(360.0));
    let with = |name: &str, more: &str| {
        let text = log(more, |_| if more.is_empty() { String::new() } else { ",-12.4".to_owned() });
        let rows = sailed(0.0);
        let turned = text.lines().enumerate().map(|(i, line)| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            cells[5] = if i == 0 { name.to_owned() } else { magnetic(&rows[i - 1]) };
            cells.join(",") + "\n"
        });
        turned.collect::<String>()
    };
    for name in ["Heading [°M]", "Heading magnetic", "HDM", "HDG(M)"] {
        let imported = read(&with(name, ",Variation [deg]"));
        assert!(off(&imported) < 0.05, "{name}: {}", off(&imported));
        let imported = read(&with(name, ""));
        assert!((off(&imported) - 12.4).abs() < 0.05);
        contains_all(&notes(&imported), &["a magnetic heading", "--column variation=NAME"]);
    }
    let lettered = with("HDG(M)", ",Var").replace(",-12.4", ",12.4W");
    assert!(off(&read(&lettered)) < 0.05);
    // NMEA: the variation is that of RMC.
    let text: String = sailed(0.0).iter().map(|row| rmc(row, "N", "E", "12.4,W") + &hdg(row, 12.4)).collect();
    let imported = read(&text);
    assert!(off(&imported) < 0.11, "{}", off(&imported));
}

#[test]
fn a_steady_angle_of_course_and_heading_is_reported_and_that_of_a_current_is_not() {
    let log = |current: f64, angle: f64| {
        let mut text = format!("{NAMES}\n");
        for row in sailed(current) {
            let turned = Row { heading: (row.heading + angle).rem_euclid(360.0), ..row };
            text += &(fields(&turned).replace(",10.00,", ",,") + "\n");
        }
        text
    };
    let imported = read(&log(0.0, 8.0));
    contains_all(&notes(&imported), &["on all headings alike", "psi = { offset = -0.1"]);
    for current in [0.0, 0.6] {
        assert!(!notes(&read(&log(current, 0.0))).contains("on all headings alike"), "{current}");
    }
}

#[test]
fn a_heading_in_radians_that_counts_on_through_full_turns_keeps_the_unit_that_the_file_states() {
    let mut text = NAMES.replace("heading", "heading [rad]") + "\n";
    for row in sailed(0.0) {
        text += &format!("{}\n", fields(&Row { heading: (row.heading + 3600.0) * DEGREE, ..row }));
    }
    let imported = read(&text);
    // The log has hundredths of a radian.
    assert!(off(&imported) < 0.6, "{} {}", off(&imported), notes(&imported));
}

/// The taken column of a quantity: its unit and the evidence.
fn evidence(imported: &Imported, quantity: &str) -> String {
    let found = imported.taken.iter().find(|t| t.quantity == quantity);
    found.map_or_else(String::new, |t| format!("{}: {}", t.unit, t.evidence))
}

#[test]
fn angles_in_hundredths_of_a_degree_are_known_by_their_name_or_their_size() {
    let autopilot = |names: &str, turned: &dyn Fn(&Row) -> Row| {
        let mut text = NAMES.replace("heading,rudder", names) + "\n";
        sailed(0.0).iter().for_each(|row| text += &format!("{}\n", fields(&turned(row))));
        text
    };
    let hundredths = |row: &Row| Row { heading: 100.0 * row.heading, ..*row };
    let both = |row: &Row| Row { rudder: 100.0 * row.rudder, ..hundredths(row) };
    for (names, rows) in [
        ("hdg,rudder_deg", &hundredths as &dyn Fn(&Row) -> Row),
        ("heading [deg],rudder_deg", &hundredths),
        ("hdg_cdeg,rudder_cdeg", &both),
        ("hdg [0.01 deg],rudder centidegrees", &both),
    ] {
        let text = autopilot(names, rows);
        // Without the positions the size and the jumps of the heading show it.
        let still = text.replace("lat,lon,sog_kn,cog", "a,b,sog_kn,cog_deg");
        for text in [text, still] {
            let imported = read(&text);
            let most = channel(&imported, 0, Channel::Delta).iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            assert!(off(&imported) < 0.1 && (most / DEGREE - 14.0).abs() < 0.1, "{names}: {} {most}", off(&imported));
            assert!(names.starts_with("hdg_") || evidence(&imported, "psi").contains("deg"), "{names}");
        }
    }
    let imported = read(&autopilot("hdg,rudder_deg", &hundredths));
    contains_all(&evidence(&imported, "psi"), &["cdeg: ", "values up to 34500", "hundredths of a degree"]);
    // A rudder by 1400 may be in milliradians as well, and one by 3500 not.
    let said = written(&autopilot("hdg,rudder", &both), &ImportSettings::default()).unwrap_err();
    contains_all(&said, &["the unit of column `rudder`", "--unit delta=deg, cdeg or mrad"]);
    let far = read(&autopilot("hdg,rudder", &|row| Row { rudder: 250.0 * row.rudder, ..hundredths(row) }));
    contains_all(&evidence(&far, "delta"), &["cdeg: angles up to 3500"]);
    // A heading in degrees that counts turns stays one; a size that no unit explains is asked for.
    let turns = |row: &Row| Row { heading: row.heading + 3600.0, ..*row };
    assert!(off(&read(&autopilot("heading,rudder", &turns))) < 0.1);
    let odd = autopilot("heading,rudder", &|row| Row { heading: 1e4 * row.heading, ..*row });
    let odd = odd.replace("lat,lon,sog_kn,cog", "a,b,sog_kn,cog_deg");
    let said = written(&odd, &ImportSettings::default()).unwrap_err();
    contains_all(&said, &["the unit of column `heading`", "--unit psi=deg, cdeg or mrad"]);
}

#[test]
fn a_longitude_positive_to_the_west_mirrors_no_ship() {
    let mirrored = |axis: usize| {
        let mut text = format!("{NAMES}\n");
        for mut row in sailed(0.0) {
            row.place[axis] = -row.place[axis];
            text += &(fields(&row) + "\n");
        }
        text
    };
    for (axis, side) in ["south", "west"].into_iter().enumerate() {
        let imported = read(&mirrored(axis));
        contains_all(&imported.notes[0], &["WARNING", side, "turned"]);
        assert!(off(&imported) < 0.01);
        let origin = imported.origin.unwrap();
        assert!(origin[0] > 36.0 && origin[1] > 14.0, "{origin:?}");
        let rudder = channel(&imported, 0, Channel::Delta);
        assert!(rudder[45] > 0.1 && rudder[60] < -0.1);
    }
    assert!(!notes(&read(&log("", |_| String::new()))).contains("WARNING"));
    // Without a course a heading that is counted the other way turns against the track as well: the yaw rate tells the two apart.
    for (axis, heading) in [(1.0, -1.0), (-1.0, 1.0)] {
        let mut text = "time,lat,lon,sog_kn,heading,rudder,rpm,rot [deg/min]\n".to_owned();
        for row in sailed(0.0) {
            let [lat, lon] = row.place;
            let (lon, psi) = (axis * lon, (heading * row.heading).rem_euclid(360.0));
            let rest = format!("10.00,{psi:.2},{:.1},120,{:.2}", row.rudder, row.rate);
            text += &format!("{},{lat:.7},{lon:.7},{rest}\n", iso(row.t));
        }
        let imported = read(&text);
        assert!(off(&imported) < 0.02 && imported.origin.unwrap()[1] > 14.0, "{axis}: {}", notes(&imported));
        let (r, rudder) = (channel(&imported, 0, Channel::R), channel(&imported, 0, Channel::Delta));
        assert!(rudder[45] > 0.1 && rudder[60] < -0.1 && r[45] > 0.0, "{axis}");
    }
}

fn summed(body: &str) -> String {
    format!("${body}*{:02X}\r\n", body.bytes().fold(0_u8, |sum, b| sum ^ b))
}

fn minutes(degrees: f64, width: usize) -> String {
    let whole = degrees.floor();
    format!("{whole:0width$}{:08.5}", (degrees - whole) * 60.0)
}

fn rmc(row: &Row, ns: &str, ew: &str, variation: &str) -> String {
    let clock = iso(row.t)[11..19].replace(':', "");
    let [lat, lon] = row.place;
    let place = format!("{},{ns},{},{ew}", minutes(lat, 2), minutes(lon, 3));
    summed(&format!("GPRMC,{clock}.00,A,{place},10.0,{:.2},030621,{variation},A", row.course))
        + &summed(&format!("IIRSA,{:.1},A,,V", row.rudder))
        + &summed("IIRPM,S,0,120.0,,A")
}

fn hdg(row: &Row, variation: f64) -> String {
    summed(&format!("HCHDG,{:.1},,,,", (row.heading + variation).rem_euclid(360.0)))
}

#[test]
fn two_talkers_of_one_sentence_are_two_columns() {
    let hdt = |talker: &str, heading: f64| summed(&format!("{talker}HDT,{heading:.2},T"));
    let both = |second: &dyn Fn(&Row) -> f64| {
        let each = |row: &Row| rmc(row, "N", "E", ",") + &hdt("GP", second(row)) + &hdt("HE", row.heading);
        sailed(0.0).iter().map(each).collect::<String>()
    };
    // A dead one, and one that goes round and round.
    for second in [&(|_: &Row| 123.0) as &dyn Fn(&Row) -> f64, &|row: &Row| (77.0 * row.t).rem_euclid(360.0)] {
        let imported = read(&both(second));
        assert_eq!(taken(&imported, "psi"), "HDT heading of HE");
        assert!(off(&imported) < 0.01, "{}", off(&imported));
        let other = imported.unused.iter().find(|u| u.column == "HDT heading of GP").unwrap();
        contains_all(&other.why, &["`HDT heading of HE` is taken"]);
    }
    assert!(read(&both(&|_| 123.0)).unused.iter().any(|u| u.why.contains("never changes")));
}

#[test]
fn a_makers_own_sentences_are_not_broken_and_positions_are_read_from_gll() {
    let mut text = String::new();
    for row in sailed(0.0) {
        (0..5).for_each(|_| text += &summed("PSXN,23,0.50,-0.30,29.98,0.10"));
        text += &(rmc(&row, "N", "E", ",") + &summed(&format!("HEHDT,{:.2},T", row.heading)));
        text += &summed("IIMWD,260.0,T,258.0,M,16.0,N,8.2,M");
    }
    let imported = read(&text);
    assert!(!notes(&imported).contains("broken"), "{}", notes(&imported));
    contains_all(&notes(&imported), &["PSXN 3000 (a maker's own)"]);
    assert!((mean(channel(&imported, 0, Channel::WindDirection)) / DEGREE + 100.0).abs() < 0.01);
    let gll = sailed(0.0).iter().fold(String::new(), |text, row| {
        let clock = iso(row.t)[11..19].replace(':', "");
        let [lat, lon] = row.place;
        let gll = format!("GPGLL,{},N,{},E,{clock}.00,A,A", minutes(lat, 2), minutes(lon, 3));
        let vwr = format!("WIVWR,{:.1},L,16.0,N,8.2,M,,", 20.0);
        let hdm = format!("HCHDM,{:.2},M", row.heading);
        text + &summed(&gll)
            + &summed(&vwr)
            + &summed(&hdm)
            + &summed(&format!("IIRSA,{:.1},A,,V", row.rudder))
            + &summed("IIRPM,S,0,120.0,,A")
    });
    let imported = read(&gll);
    assert_eq!(["lat", "psi"].map(|q| taken(&imported, q)), ["GLL latitude", "HDM magnetic heading"]);
    assert!((mean(channel(&imported, 0, Channel::ApparentWindDirection)) / DEGREE + 20.0).abs() < 0.01);
}

#[test]
fn a_clock_that_steps_back_begins_a_recording_and_late_rows_do_not() {
    let rows: Vec<String> = log("", |_| String::new()).lines().map(str::to_owned).collect();
    // The last 200 rows have the clock of 300 rows before.
    let mut text = rows[..401].join("\n") + "\n";
    for (i, row) in rows[401..].iter().enumerate() {
        text += &format!("{},{}\n", iso(2.0 * (100 + i) as f64), row.split_once(',').unwrap().1);
    }
    let imported = read(&text);
    let lengths: Vec<usize> = imported.recordings.iter().map(|r| r.rows.t.len()).collect();
    assert_eq!(lengths, [400, 200]);
    assert_eq!(imported.recordings[1].start.as_deref(), Some("2021-06-03 10:03:20"));
    contains_all(&notes(&imported), &["its clock steps back once, first at line 402"]);
    // Three rows that come late, and the newest first.
    let mut late = rows.clone();
    let three: Vec<String> = late.drain(100..103).collect();
    drop(late.splice(110..110, three));
    let newest = [&rows[..1], &rows[1..].iter().rev().cloned().collect::<Vec<_>>()[..]].concat();
    for text in [late, newest] {
        let imported = read(&(text.join("\n") + "\n"));
        assert_eq!((imported.recordings.len(), imported.recordings[0].rows.t.len()), (1, 600));
    }
}

#[test]
fn a_short_piece_of_a_clock_that_starts_again_costs_no_more_than_itself() {
    let of = |time: &dyn Fn(usize) -> f64| {
        let text = log("", |_| String::new());
        let rows = text.lines().enumerate().map(|(i, line)| {
            let stamp = if i == 0 { "t [s]".to_owned() } else { format!("{:.1}", time(i - 1)) };
            format!("{stamp},{}\n", line.split_once(',').unwrap().1)
        });
        read(&rows.collect::<String>())
    };
    // Two runs, and three rows of a third.
    let starts = |i: usize| {
        2.0 * [i, i.wrapping_sub(300), i.wrapping_sub(597)][usize::from(i >= 300) + usize::from(i >= 597)] as f64
    };
    let imported = of(&starts);
    let lengths: Vec<usize> = imported.recordings.iter().map(|r| r.rows.t.len()).collect();
    assert_eq!(lengths, [300, 297]);
    let said = notes(&imported);
    contains_all(&said, &["3 lines where its time starts again are too few for a run", "the first is line 599"]);
    assert_eq!(said.matches("left out").count(), 1, "{said}");
}

#[test]
fn times_are_read_in_several_columns_and_in_forms_of_their_own() {
    let of = |names: &str, stamp: &dyn Fn(usize) -> String| {
        let text = log("", |_| String::new());
        let rows = text.lines().enumerate().map(|(i, line)| {
            let s = 36_000 + 2 * i.saturating_sub(1);
            format!("{},{}\n", if i == 0 { names.to_owned() } else { stamp(s) }, line.split_once(',').unwrap().1)
        });
        let imported = read(&rows.collect::<String>());
        assert!(imported.recordings.len() == 1 && off(&imported) < 0.02, "{names}: {}", notes(&imported));
        let rows = &imported.recordings[0].rows;
        assert!((rows.step - 2.0).abs() < 0.01 && rows.t.len() >= 599, "{names}: {} of {} s", rows.t.len(), rows.step);
    };
    let [hours, minutes, seconds] = [|s: usize| s / 3600, |s: usize| s / 60 % 60, |s: usize| s % 60];
    let six = |s| format!("2021,6,3,{},{},{}", hours(s), minutes(s), seconds(s));
    of("YYYY,MM,DD,hh,mm,ss", &six);
    of("Year,Month,Day,Hour,Minute,Second", &six);
    of("Data,Ora", &|s| format!("03/06/2021,{:02}.{:02}.{:02}", hours(s), minutes(s), seconds(s)));
    of("Time", &|s| format!("{:02}h{:02}m{:02}s", hours(s), minutes(s), seconds(s)));
    of("Time", &|s| format!("135/{:02}:{:02}:{:02}", hours(s), minutes(s), seconds(s)));
    of("DOY", &|s| format!("{:.8}", 135.0 + s as f64 / 86_400.0));
    of("Hour of day", &|s| format!("{:.7}", s as f64 / 3600.0));
    of("Time", &|s| format!("{} sec", s - 36_000));
    of("Date,Time", &|s| format!("2021-06-03,{:.8}", s as f64 / 86_400.0));
    of("Time", &|s| format!("2021-06-03-{:02}:{:02}:{:02}", hours(s), minutes(s), seconds(s)));
    of("Time", &|s| format!("20210603-{:02}{:02}{:02}", hours(s), minutes(s), seconds(s)));
}

/// The first rows of the usual log, with its heading in other columns.
fn headed(count: usize, names: &str, value: impl Fn(f64) -> String) -> String {
    let rows = sailed(0.0);
    let mut text = NAMES.replace("heading", names).replace("rudder", "rudder [deg]") + "\n";
    for row in &rows[..count] {
        let all = fields(row);
        let mut parts: Vec<&str> = all.split(',').collect();
        let heading = value(row.heading * DEGREE);
        parts[5] = &heading;
        text += &(parts.join(",") + "\n");
    }
    text
}

#[test]
fn a_heading_that_counts_from_east_is_turned_whether_the_ship_turns_much_or_not() {
    let from_east = |psi: f64| std::f64::consts::FRAC_PI_2 - psi;
    let wrapped = |angle: f64| angle.sin().atan2(angle.cos());
    // A leg, a zigzag and a turn; and all of it.
    for count in [40, 90, 600] {
        let as_degrees = headed(count, "yaw [deg]", |psi| format!("{:.2}", wrapped(from_east(psi)) / DEGREE));
        let as_radians = headed(count, "yaw [rad]", |psi| format!("{:.5}", wrapped(from_east(psi))));
        let quaternion = headed(count, "qw,qx,qy,qz", |psi| {
            let half = 0.5 * wrapped(from_east(psi));
            format!("{:.7},0,0,{:.7}", half.cos(), half.sin())
        });
        for text in [as_degrees, as_radians, quaternion] {
            let imported = read(&text);
            assert!(off(&imported) < 0.02, "{count}: {}: {}", text.lines().next().unwrap(), off(&imported));
            let rudder = channel(&imported, 0, Channel::Delta);
            assert!(count < 90 || (rudder[45] > 0.1 && rudder[60] < -0.1), "{count}");
        }
        assert!(off(&read(&headed(count, "heading", |psi| format!("{:.2}", psi / DEGREE)))) < 0.02, "{count}");
    }
}

#[test]
fn positions_in_degrees_under_the_names_of_axes_are_asked_for_with_the_columns_to_pass() {
    let text = log("", |_| String::new()).replacen("lat,lon", "Y,X", 1);
    let said = written(&text, &ImportSettings::default()).unwrap_err();
    contains_all(&said, &["longitude and latitude", "--column lon=X --column lat=Y"]);
    assert!(!said.contains("exchange the axes"), "{said}");
    let columns = [("lon", "X"), ("lat", "Y")].map(|(quantity, name)| (quantity.to_owned(), name.to_owned()));
    let choices = Choices { columns: columns.into_iter().collect(), ..Choices::default() };
    let imported = written(&text, &ImportSettings { choices, ..ImportSettings::default() }).unwrap();
    assert!(off(&imported) < 0.02, "{}", off(&imported));
}

#[test]
fn a_pose_of_ros_has_x_to_the_east_and_what_turns_anticlockwise_is_turned() {
    let text = |pose: &str, from_east: bool| {
        let names = ["x", "y", "z", "w"].map(|axis| format!("/imu/data.orientation.{axis}")).join(",");
        let others = "/imu/data.angular_velocity.z,/rudder/angle.data,rpm";
        let mut text = format!("time,{pose}.position.x,{pose}.position.y,{names},{others}\n");
        let rows = sailed(0.0);
        let [lat, lon] = rows[0].place;
        for row in &rows {
            let north = (row.place[0] - lat).to_radians() * 6.359e6;
            let east = (row.place[1] - lon).to_radians() * 6.386e6 * lat.to_radians().cos();
            let psi = row.heading * DEGREE;
            let (side, [x, y], yaw) = if from_east {
                (-1.0, [east, north], std::f64::consts::FRAC_PI_2 - psi)
            } else {
                (1.0, [north, east], psi)
            };
            let attitude = format!("0,0,{:.7},{:.7}", (0.5 * yaw).sin(), (0.5 * yaw).cos());
            let (rate, rudder) = (side * row.rate * DEGREE / 60.0, side * row.rudder * DEGREE);
            writeln!(text, "{},{x:.3},{y:.3},{attitude},{rate:.6},{rudder:.5},120", iso(row.t)).unwrap();
        }
        text
    };
    let imported = read(&text("/odom.pose.pose", true));
    assert!(off(&imported) < 0.5, "{}", off(&imported));
    let (r, delta) = (channel(&imported, 0, Channel::R), channel(&imported, 0, Channel::Delta));
    assert!(delta[45] > 0.1 && r[49] > 0.0, "{} {}", delta[45], r[49]);
    assert!(notes(&imported).contains("x to the east and y to the north, as ROS has it"), "{}", notes(&imported));
    assert!(!imported.unused.iter().any(|u| u.column.contains("orientation")), "{:?}", imported.unused);
    // A frame that counts x to the north by its name.
    let imported = read(&text("/odom_ned.pose.pose", false));
    assert!(off(&imported) < 0.5 && !notes(&imported).contains("ROS"), "{} {}", off(&imported), notes(&imported));
}

#[test]
fn a_table_with_a_row_for_each_value_is_told_with_what_makes_columns_of_it() {
    let text = log("", |_| String::new());
    let names: Vec<&str> = NAMES.split(',').collect();
    let mut long = "_time,_field,_value\n".to_owned();
    for line in text.lines().skip(1) {
        let parts: Vec<&str> = line.split(',').collect();
        for (name, value) in names.iter().zip(&parts).skip(1) {
            long += &format!("{},{name},{value}\n", parts[0]);
        }
    }
    let said = written(&long, &ImportSettings::default()).unwrap_err();
    let pivot = "pivot_table(index=\"_time\", columns=\"_field\", values=\"_value\")";
    contains_all(&said, &["a row for each value", "`_field`", pivot]);
}

#[test]
fn a_clock_in_any_unit_is_told_with_the_flag_that_mends_it() {
    let text = log("", |_| String::new());
    let with = |scale: f64, name: &str| -> String {
        let rows = text.lines().enumerate().map(|(i, line)| {
            let stamp = if i == 0 { name.to_owned() } else { (scale * (70.0 + 2.0 * (i - 1) as f64)).to_string() };
            format!("{stamp},{}\n", line.split_once(',').unwrap().1)
        });
        rows.collect()
    };
    for (scale, unit) in [(1e6, "us"), (1e3, "ms"), (1.0 / 3600.0, "h")] {
        let text = with(scale, "t");
        let said = written(&text, &ImportSettings::default()).unwrap_err();
        contains_all(&said, &["the track is sailed", &format!("pass `--unit t={unit}`")]);
        let choices = Choices { units: [("t".to_owned(), unit.to_owned())].into(), ..Choices::default() };
        let imported = written(&text, &ImportSettings { choices, ..ImportSettings::default() }).unwrap();
        assert!(off(&imported) < 0.01, "{unit}");
    }
    // Nor does it take a recorded speed; numbers as large as those of an epoch are none in such steps.
    let still = |text: &str| text.replacen("sog_kn,cog", "a,b", 1);
    for (scale, more, unit) in [(1e6, 0.0, "us"), (1e6, 123_456_789.0, "us"), (1e9, 5e9, "ns"), (1e3, 0.0, "ms")] {
        let text = still(&with(scale, "timestamp"));
        let moved = text.lines().map(|line| match line.split_once(',') {
            Some((t, rest)) => t.parse::<f64>().map_or(format!("{line}\n"), |t| format!("{},{rest}\n", t + more)),
            None => String::new(),
        });
        let said = written(&moved.collect::<String>(), &ImportSettings::default()).unwrap_err();
        contains_all(&said, &["too far to show a manoeuvre", "2.00 s apart", &format!("pass `--unit t={unit}`")]);
    }
    // A time in words that nobody reads.
    let odd: String = with(1.0, "Time").lines().map(|line| format!("after {line}\n")).collect();
    let said = written(&odd.replacen("after ", "", 1), &ImportSettings::default()).unwrap_err();
    contains_all(&said, &["is no time that is read here", "135/08:00:00"]);
}

#[test]
fn files_whose_clocks_differ_by_a_zone_are_told_with_it() {
    let rows = sailed(0.0);
    let fixes = |row: &Row| format!("{},{:.7},{:.7}", iso(row.t), row.place[0], row.place[1]);
    let bridge = |row: &Row| {
        let local = iso(row.t + 7200.0);
        format!("{},{:.2},{:.1},120", local.trim_end_matches('Z'), row.heading, row.rudder)
    };
    let text = |names: &str, row: &dyn Fn(&Row) -> String| {
        rows.iter().fold(format!("{names}\n"), |text, r| format!("{text}{}\n", row(r)))
    };
    let folder = tempfile::tempdir().unwrap();
    let paths = ["gps.csv", "bridge.csv"].map(|name| folder.path().join(name));
    let both = |time: &str| {
        std::fs::write(&paths[0], text("time_utc,lat,lon", &fixes)).unwrap();
        std::fs::write(&paths[1], text(&format!("{time},heading,rudder deg,rpm"), &bridge)).unwrap();
        import(&paths, &ImportSettings::default()).map_err(|e| e.to_string())
    };
    let said = both("local time").unwrap_err();
    contains_all(
        &said,
        &["gps.csv (2021-06-03 10:00:00 to", "bridge.csv (2021-06-03 12:00:00 to", "begins 7200 s after"],
    );
    contains_all(&said, &["have no time in common", "as in `Time (UTC+2)`"]);
    assert!(off(&both("local time (UTC+2)").unwrap()) < 0.1);
}

#[test]
fn a_yaw_rate_in_a_unit_that_nothing_shows_blocks_nothing() {
    // As AIS sends it: the root of the rate.
    let coded = |row: &Row| format!(",{:.0}", 4.733 * row.rate.abs().sqrt() * row.rate.signum());
    let imported = read(&log(",ROT", coded));
    assert!(imported.derive.contains(&"r") && taken(&imported, "r").is_empty());
    contains_all(&notes(&imported), &["ROT: its unit is not known", "the yaw rate is that of the heading"]);
}

#[test]
fn a_header_of_another_width_and_a_line_that_may_be_cut_are_told() {
    let text = log("", |_| String::new());
    let none = ImportSettings::default();
    let said = written(&text.replacen(NAMES, &NAMES.replace("rudder", "rudder [deg, + port]"), 1), &none).unwrap_err();
    contains_all(&said, &[":1:1: this line names columns", "where the lines of data have 8", "in quotes"]);
    // A line break inside of quotes, as spreadsheets write them.
    let broken = NAMES.replace("heading", "\"heading\n[deg]\"").replace("rudder", "\"rudder\n[deg]\"");
    let imported = read(&text.replacen(NAMES, &broken, 1));
    assert_eq!(["psi", "delta"].map(|q| taken(&imported, q)), ["heading", "rudder"]);
    assert!(off(&imported) < 0.01);
    let groups = text.replacen(NAMES, "time,GPS,,,,Steering,,Engine\n,lat,lon,sog_kn,cog,heading,rudder,rpm", 1);
    assert_eq!(taken(&read(&groups), "delta"), "rudder");
    // The last number is 1 of 120: the file was cut.
    let cut = read(text.trim_end().strip_suffix("20").unwrap());
    assert_eq!(cut.recordings[0].rows.t.len(), 599);
    contains_all(&notes(&cut), &["line 601, the last, has no end"]);
    assert_eq!(read(text.trim_end()).recordings[0].rows.t.len(), 600);
}

#[test]
fn stamps_of_minutes_and_seconds_are_counted_on_past_the_hour() {
    let text = log("", |_| String::new());
    let rows = text.lines().enumerate().map(|(i, line)| {
        let s = 3000 + 2 * i.saturating_sub(1);
        let stamp = if i == 0 { "time".to_owned() } else { format!("{:02}:{:02}.0", s / 60 % 60, s % 60) };
        format!("{stamp},{}\n", line.split_once(',').unwrap().1)
    });
    let imported = read(&rows.collect::<String>());
    assert_eq!((imported.recordings.len(), imported.recordings[0].rows.t.len()), (1, 600));
    assert!(imported.files[0].1.contains("start again 1 times at the full hour"), "{}", imported.files[0].1);
}

#[test]
fn a_clock_that_is_changed_while_the_ship_sails_on_is_mended_and_one_with_a_zone_is_brought_to_utc() {
    let of = |name: &str, stamp: &dyn Fn(usize) -> String| {
        let text = log("", |_| String::new());
        let rows = text.lines().enumerate().map(|(i, line)| {
            format!("{},{}\n", if i == 0 { name.to_owned() } else { stamp(i - 1) }, line.split_once(',').unwrap().1)
        });
        read(&rows.collect::<String>())
    };
    let clock = |s: usize| format!("2021-06-03 {:02}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
    let one = |imported: &Imported, start: &str| {
        assert_eq!((imported.recordings.len(), imported.recordings[0].rows.t.len()), (1, 600), "{}", notes(imported));
        assert_eq!(imported.recordings[0].start.as_deref(), Some(start));
        assert!(off(imported) < 0.01);
    };
    let summer = of("time", &|i| clock(36_000 + 2 * i + if i < 300 { 0 } else { 3600 }));
    one(&summer, "2021-06-03 10:00:00");
    contains_all(&notes(&summer), &["its clock goes 1 h forward at line 302 while the ship sails 10 m: summer time"]);
    // Back, the hour before is recorded twice.
    let winter = of("time", &|i| clock(36_000 + 2 * i - if i < 300 { 0 } else { 3600 }));
    assert_eq!(winter.recordings.iter().map(|r| r.rows.t.len()).collect::<Vec<_>>(), [300, 300]);
    // From 12:50 to 1:10, without AM and PM.
    let twelve = of("time", &|i| clock(46_200 + 2 * i - if i < 300 { 0 } else { 43_200 }));
    one(&twelve, "2021-06-03 12:50:00");
    contains_all(&notes(&twelve), &["12 h back", "a clock of 12 hours without AM and PM"]);
    let zone = of("Time (UTC+2)", &|i| clock(36_000 + 2 * i));
    one(&zone, "2021-06-03 08:00:00");
}

#[test]
fn files_over_one_time_are_recordings_of_their_own_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let text = log("", |_| String::new());
    let other: String = sailed(0.5).iter().map(|row| fields(row) + "\n").collect();
    let (a, b) = (file("a.csv", &text), file("b.csv", &format!("{NAMES}\n{other}")));
    let imported = import(&[a.clone(), b], &ImportSettings::default()).unwrap();
    assert_eq!(imported.recordings.len(), 2);
    assert!(imported.recordings.iter().all(|r| r.rows.t.len() == 600 && r.rows.t[0] == 0.0));
    assert_eq!(imported.recordings[0].start, imported.recordings[1].start);
    // Both start at nought, and one has a column more.
    let own = |more: &str| {
        let mut text = format!("t [s],{}{more}\n", NAMES.split_once(',').unwrap().1);
        for row in sailed(0.0) {
            let tail = if more.is_empty() { "" } else { ",3" };
            let _ = writeln!(text, "{},{}{tail}", row.t, fields(&row).split_once(',').unwrap().1);
        }
        text
    };
    let both = [file("c.csv", &own("")), file("d.csv", &own(",note"))];
    assert_eq!(import(&both, &ImportSettings::default()).unwrap().recordings.len(), 2);
    // A file of headings that are not those of the log.
    let headings: String = sailed(0.0).iter().map(|row| format!("{},{:.1}\n", iso(row.t), row.heading + 1.0)).collect();
    let said = import(&[a.clone(), file("e.csv", &format!("time,heading\n{headings}"))], &ImportSettings::default());
    contains_all(&said.unwrap_err().to_string(), &["a.csv", "e.csv", "both have `heading`", "2021-06-03 10:00:00"]);
    // A copy is one.
    let imported = import(&[a, file("f.csv", &text)], &ImportSettings::default()).unwrap();
    assert_eq!((imported.recordings.len(), imported.recordings[0].rows.t.len()), (1, 600));
}

#[test]
fn two_ships_in_one_file_are_refused() {
    let mut text = format!("{NAMES},MMSI\n");
    for row in sailed(0.0) {
        text += &format!("{},219000001\n{},219000002\n", fields(&row), fields(&row));
    }
    let said = written(&text, &ImportSettings::default()).unwrap_err();
    contains_all(&said, &["column `MMSI` names 2 ships", "219000001 (600 lines)", "one ship at a time"]);
    assert_eq!(read(&log(",MMSI,Ship speed", |_| ",219000001,9".to_owned())).recordings.len(), 1);
}

#[test]
fn rows_of_one_time_that_fill_other_fields_were_not_rounded() {
    let mut text = format!("{NAMES},counter\n");
    for (i, row) in sailed(0.0).iter().enumerate() {
        let all = fields(row);
        let cells: Vec<&str> = all.split(',').collect();
        text += &format!("{},{},{},{},{},,,,{i}\n", cells[0], cells[1], cells[2], cells[3], cells[4]);
        text += &format!("{},,,,,{},{},{},{i}\n", cells[0], cells[5], cells[6], cells[7]);
    }
    let repeated = log(",counter", |row| format!(",{}", row.t));
    let twice: String = repeated
        .lines()
        .enumerate()
        .map(|(i, line)| if i == 0 { format!("{line}\n") } else { format!("{line}1\n{line}2\n") })
        .collect();
    for text in [text, twice] {
        let imported = read(&text);
        assert_eq!(imported.recordings[0].rows.t.len(), 600);
        assert!(!imported.files[0].1.contains("rounded"), "{}", imported.files[0].1);
        assert!(off(&imported) < 0.01, "{}", off(&imported));
    }
}

#[test]
fn times_that_are_off_by_half_a_step_are_no_gaps_and_a_missing_row_is_one() {
    let mut state = 7_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut text = format!("t [s],{}\n", NAMES.split_once(',').unwrap().1);
    for row in sailed(0.0) {
        let t = row.t + 0.98 * 2.0 * (random() - 0.5);
        let _ = writeln!(text, "{t:.3},{}", fields(&row).split_once(',').unwrap().1);
    }
    let imported = read(&text);
    let rows = &imported.recordings[0].rows;
    assert!(rows.t.windows(2).all(|t| t[1] - t[0] < 1.5 * rows.step), "{}", notes(&imported));
    contains_all(&notes(&imported), &["uneven times"]);
    let lines: Vec<String> = log("", |_| String::new()).lines().map(str::to_owned).collect();
    let without = [&lines[..300], &lines[301..]].concat().join("\n");
    let rows = &read(&without).recordings[0].rows;
    assert_eq!(rows.t.windows(2).filter(|t| t[1] - t[0] > 1.5 * rows.step).count(), 1);
}

#[test]
fn a_blank_rate_of_turn_that_the_heading_gives_ends_no_run() {
    let text = log(",ROT", |row| if row.t % 20.0 == 8.0 { ",".to_owned() } else { format!(",{:.1}", row.rate) });
    let imported = read(&text);
    let rates = channel(&imported, 0, Channel::R);
    let worst = sailed(0.0).iter().zip(rates).map(|(row, r)| (r / DEGREE * 60.0 - row.rate).abs()).fold(0.0, f64::max);
    assert!(rates.iter().all(|r| r.is_finite()) && worst < 60.0, "{worst}");
    contains_all(&notes(&imported), &["r: 60 of 600 values are blank and follow from the heading"]);
}

#[test]
fn what_blanks_cost_is_reported_with_the_bridge_that_keeps_it() {
    let rows = sailed(0.0);
    let mut text = format!("{NAMES}\n");
    for (i, row) in rows.iter().enumerate() {
        let line = fields(row);
        let mut cells: Vec<&str> = line.split(',').collect();
        if i % 9 < 2 {
            cells[5] = "511";
        }
        text += &(cells.join(",") + "\n");
    }
    let study = Study::new();
    study.write("log.csv", &text);
    let said = study.refuses(&["import", "log.csv", "--ship", "ship.toml", "--out", "own"]);
    contains_all(
        &said,
        &["recorded minutes", "psi 134, u 134, v 134 of 600 rows", "`--bridge 6`", "`bridge = 6.0` in columns.toml"],
    );
    study.does(&["import", "log.csv", "--ship", "ship.toml", "--out", "own", "--bridge", "6"]);
    contains_all(&std::fs::read_to_string(study.path("own/columns.toml")).unwrap(), &["bridge = 6.0"]);
    let runs = std::fs::read_to_string(study.path("own/runs.csv")).unwrap();
    let lasts = |line: &str| {
        let cells: Vec<f64> = line.split(',').filter_map(|c| c.parse().ok()).collect();
        cells[1] - cells[0]
    };
    assert!(runs.lines().skip(1).map(lasts).sum::<f64>() > 1000.0, "{runs}");
    contains_all(
        &study.refuses(&["import", "log.csv", "--out", "own", "--bridge=-1"]),
        &["positive number of seconds"],
    );
}

#[test]
fn names_are_read_in_german_french_italian_and_spanish() {
    let languages = [
        "Zeit,Breite,Länge,Fahrt über Grund [kn],Kurs über Grund,Steuerkurs,Ruderlage,Wellendrehzahl [1/min]",
        "Zeit,Breite,Länge,FüG [kn],KüG,Kurs rw.,Ruderlage,Wellendrehzahl [1/min]",
        "Heure,Latitude,Longitude,Vitesse fond (kn),Route fond,Cap vrai,Angle de barre,Régime hélice [rpm]",
        "Ora,Latitudine,Longitudine,Velocità al suolo [kn],Rotta,Prua,Angolo timone,Giri elica [rpm]",
        "Hora,Latitud,Longitud,Velocidad sobre el fondo [kn],Rumbo sobre el fondo,Rumbo,Ángulo de timón,Revoluciones [rpm]",
    ];
    let text = log("", |_| String::new());
    for names in languages {
        let imported = read(&text.replace(NAMES, names));
        let found: Vec<&str> = ["lat", "lon", "sog", "cog", "psi", "delta", "n"].map(|q| taken(&imported, q)).to_vec();
        assert!(found.iter().all(|column| !column.is_empty()), "{names}: {found:?}");
        assert!(off(&imported) < 0.01, "{names}");
    }
}

#[test]
fn what_is_no_file_or_no_log_is_reported_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let say = |path: &Path| import(&[path.to_owned()], &ImportSettings::default()).unwrap_err().to_string();
    let wide = folder.path().join("wide.csv");
    std::fs::write(&wide, format!("t{}\n0{}\n", ",x".repeat(1_000_000), ",1".repeat(1_000_000))).unwrap();
    contains_all(&say(&wide), &["a line has 1000001 fields", "rows and columns exchanged"]);
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStrExt;
        contains_all(&say(Path::new("/dev/zero")), &["/dev/zero", "a pipe or a device"]);
        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        contains_all(&say(&pipe), &["a pipe or a device"]);
        let odd = folder.path().join(std::ffi::OsStr::from_bytes(b"log\xff.csv"));
        std::fs::write(&odd, log("", |_| String::new())).unwrap();
        assert_eq!(import(&[odd], &ImportSettings::default()).unwrap().recordings.len(), 1);
    }
}

/// Inputs that once failed, which are not part of the project: each folder has a log and says what is right.
#[test]
fn inputs_that_once_failed_are_right() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/cases");
    let find = |number: &str| -> Option<PathBuf> {
        let entries = std::fs::read_dir(&cases).ok()?;
        entries
            .flatten()
            .map(|e| e.path())
            .find(|p| p.file_name().is_some_and(|n| n.to_string_lossy().starts_with(number)))
    };
    let mut seen = 0;
    let mut each = |number: &str, file: &str, check: &dyn Fn(&Imported)| match find(number) {
        Some(folder) => {
            seen += 1;
            check(&import(&[folder.join(file)], &ImportSettings::default()).unwrap());
        }
        None => crate::support::skipped(&format!("no folder {number}* in {}", cases.display())),
    };
    each("02", "sail.csv", &|i| assert_eq!(taken(i, "sog"), "Ext_SOG"));
    each("04", "dt.csv", &|i| assert_eq!(taken(i, "delta"), "rudder"));
    each("04", "yaw.csv", &|i| assert_eq!(taken(i, "psi"), "yaw"));
    each("04", "tau.csv", &|i| assert_eq!([taken(i, "u"), taken(i, "v")], ["", ""]));
    for file in ["few.nmea", "seapath.nmea"] {
        each("06", file, &|i| assert!(i.files[0].1.contains("NMEA") && !notes(i).contains("broken")));
    }
    each("08", "hdg.nmea", &|i| assert!(mean(channel(i, 0, Channel::V)).abs() < 0.1));
    each("10", "local.csv", &|i| {
        let rows: Vec<usize> = i.recordings.iter().map(|r| r.rows.t.len()).collect();
        assert_eq!(rows, [600, 601]);
    });
    each("16", "ais.csv", &|i| contains_all(&i.lost(59.0).unwrap(), &["`--bridge", "recorded minutes"]));
    each("22", "dma.csv", &|i| assert!(channel(i, 0, Channel::R).iter().all(|r| r.is_finite())));
    let from = |i: &Imported| mean(channel(i, 0, Channel::WindDirection)) / DEGREE;
    each("23", "wind.csv", &|i| assert!((from(i) + 100.0).abs() < 1.0, "{}", from(i)));
    each("23", "both.csv", &|i| assert!((from(i) + 100.0).abs() < 1.0, "{}", from(i)));
    if seen == 0 {
        crate::support::skipped(&format!("{} is not there", cases.display()));
    }
}

#[test]
fn a_word_for_course_and_heading_is_the_heading_beside_a_course_over_ground() {
    let german = ["Zeit", "Breite", "Länge", "FüG [kn]", "Kurs über Grund", "Kurs", "Ruderlage", "Drehzahl [rpm]"];
    let text = log("", |_| String::new()).replacen(NAMES, &german.join(","), 1);
    let imported = read(&text);
    assert_eq!(["psi", "cog"].map(|quantity| taken(&imported, quantity)), ["Kurs", "Kurs über Grund"]);
    assert!(off(&imported) < 0.1);
}

/// Two logs of a catamaran that each begin at 0, with positions named by one letter and a thruster in each hull, and its ship file.
fn catamaran_logs(study: &Study) {
    let thruster = |name: &str, y: f64| {
        format!("[[actuator]]\nname = \"{name}\"\nx = -0.4\ny = {y:?}\nangle = 0\nlaw = \"thruster\"\n")
    };
    let hull = "name = \"cat\"\n[hull]\nlpp = 1.2\nbreadth = 0.9\nmass = 17.0\n";
    study.write("cat.toml", &(hull.to_owned() + &thruster("left", -0.3) + &thruster("right", 0.3)));
    for (day, side) in [("day1_run1", 1.0), ("day2_run1", -1.0)] {
        let mut text =
            String::from("t [s],N [m],E [m],psi [deg],u [m/s],v [m/s],r [deg/s],n_left [rps],n_right [rps]\n");
        let (mut psi, mut r, mut place) = (0.3_f64, 0.0_f64, [0.0_f64; 2]);
        for i in 0..1200 {
            // A turn, then straight ahead, then weaving, faster and faster.
            let at = f64::from(i);
            let goal = match i {
                0..300 => 0.20 * side,
                300..600 => 0.0,
                _ => 0.15 * side * (0.01 * at + 1e-5 * at * at).sin(),
            };
            r += 0.1 * (goal - r);
            let turn = 3.0 * r / 0.2;
            let cells = [at * 0.2, place[0], place[1], psi.to_degrees(), 0.8, 0.0, r.to_degrees()];
            cells.iter().for_each(|cell| write!(text, "{cell:.4},").unwrap());
            writeln!(text, "{:.3},{:.3}", 12.0 + turn, 12.0 - turn).unwrap();
            psi += 0.2 * r;
            place[0] += 0.16 * psi.cos();
            place[1] += 0.16 * psi.sin();
        }
        study.write(&format!("{day}.csv"), &text);
    }
}

#[test]
fn a_craft_without_rudder_and_propeller_is_split_by_how_it_turns_and_its_positions_are_no_propeller_rate() {
    let study = Study::new();
    catamaran_logs(&study);
    let files = ["import", "day1_run1.csv", "day2_run1.csv", "--ship", "cat.toml", "--sessions", "day{}_*", "--out"];
    let said = study.does(&[&files[..], &["split"]].concat());
    assert!(!said.contains("`E` is not used"), "{said}");
    let runs = std::fs::read_to_string(study.path("split/runs.csv")).unwrap();
    for word in ["day1_run1", "day2_run1", "turn", "straight"] {
        assert!(runs.contains(word), "no {word}: {runs}");
    }
    let map = std::fs::read_to_string(study.path("split/recordings/day1_run1.csv")).unwrap();
    let header = map.lines().find(|line| line.contains("psi")).unwrap();
    contains_all(header, &["x", "y", "left.rate", "right.rate"]);
    study.does(&["check", "split/study.toml"]);
    // Whole recordings have their sessions too.
    study.does(&[&files[..], &["whole", "--no-split"]].concat());
    let runs = std::fs::read_to_string(study.path("whole/runs.csv")).unwrap();
    let sessions: Vec<&str> = runs.lines().skip(1).filter_map(|line| line.rsplit(',').next()).collect();
    assert_eq!(sessions, ["1", "2"], "{runs}");
}
