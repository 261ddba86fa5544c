//! Damage to what was recorded, in one run or in all: units, signs, clocks, sensors that freeze, jump or fill, rows that are lost or
//! doubled, files that are cut. Each may change the answer, and must then be reported.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::edit::pick;
use super::files::{Files, Table, recordings};

/// The kinds of damage.
pub const DAMAGES: [&str; 22] = [
    "wrong unit, all runs",
    "wrong unit, one run",
    "wrong sign, all runs",
    "wrong sign, one run",
    "late channel, all runs",
    "late channel, one run",
    "two channels exchanged, all runs",
    "two channels exchanged, one run",
    "channel frozen for a third of a run",
    "single values times ten",
    "single values lost to zero",
    "fill values",
    "rows lost",
    "rows doubled",
    "rows exchanged",
    "clock set back",
    "time in milliseconds",
    "heading averaged through north",
    "position jumps and stays",
    "one recording under two names",
    "file cut at a byte",
    "one byte changed",
];

const CHANNELS: [&str; 8] = ["x", "y", "psi", "u", "v", "r", "n", "delta"];

/// Wrong units of a channel: factors by which values are off.
fn factors(channel: &str) -> &'static [f64] {
    match channel {
        "x" | "y" => &[0.001, 0.3048, 1852.0],
        "u" | "v" => &[1.943_844, 0.514_444, 3.6, 1.0 / 3.6],
        "n" => &[60.0, 1.0 / 60.0, std::f64::consts::TAU],
        _ => &[57.295_779_5, 1.0 / 57.295_779_5],
    }
}

/// Damages some files; gives what was done, or `None` where it has no place in the study.
pub fn damage(files: &mut Files, damage: &str, rng: &mut ChaCha8Rng) -> Option<String> {
    let all = recordings(files);
    let one = pick(rng, &all).clone();
    let everywhere = damage.ends_with("all runs") || damage == "time in milliseconds";
    let chosen: Vec<String> = if everywhere { all.clone() } else { vec![one.clone()] };
    let channel = *pick(rng, &CHANNELS);
    let what = match damage {
        "one recording under two names" => {
            let from = all.iter().find(|name| **name != one)?.clone();
            let bytes = files[&from].clone();
            files.insert(one.clone(), bytes);
            return Some(format!("{one} is {from}"));
        }
        "file cut at a byte" => {
            let bytes = files.get_mut(&one)?;
            bytes.truncate(rng.random_range(1..bytes.len()));
            return Some(format!("{one} at {}", files[&one].len()));
        }
        "one byte changed" => {
            let bytes = files.get_mut(&one)?;
            let at = rng.random_range(0..bytes.len());
            bytes[at] = *pick(rng, b"0123456789.,-e \n;x");
            return Some(format!("{one}, byte {at}"));
        }
        "wrong unit, all runs" | "wrong unit, one run" => {
            let factor = *pick(rng, factors(channel));
            each(files, &chosen, channel, |_, v| v * factor)?;
            format!("{channel} times {factor:.4}")
        }
        "wrong sign, all runs" | "wrong sign, one run" => {
            each(files, &chosen, channel, |_, v| -v)?;
            channel.to_owned()
        }
        "late channel, all runs" | "late channel, one run" => {
            let rows = rng.random_range(2..=6);
            for name in &chosen {
                late(files, name, channel, rows)?;
            }
            format!("{channel} by {rows} rows")
        }
        "two channels exchanged, all runs" | "two channels exchanged, one run" => {
            let other = *pick(rng, &CHANNELS);
            if other == channel {
                return None;
            }
            for name in &chosen {
                exchange(files, name, channel, other)?;
            }
            format!("{channel} and {other}")
        }
        "time in milliseconds" => {
            each(files, &chosen, "t", |_, t| 1000.0 * t)?;
            "t".to_owned()
        }
        _ => rows(files, &one, channel, damage, rng)?,
    };
    Some(if everywhere { what } else { format!("{what}, {one}") })
}

fn each(files: &mut Files, names: &[String], channel: &str, change: impl Fn(usize, f64) -> f64) -> Option<()> {
    for name in names {
        let mut table = Table::read(&files[name]);
        table.each(table.at(channel)?, &change);
        files.insert(name.clone(), table.text());
    }
    Some(())
}

fn late(files: &mut Files, name: &str, channel: &str, rows: usize) -> Option<()> {
    let mut table = Table::read(&files[name]);
    let column = table.at(channel)?;
    let values = table.values(column);
    table.each(column, |row, _| values[row.saturating_sub(rows)]);
    files.insert(name.to_owned(), table.text());
    Some(())
}

fn exchange(files: &mut Files, name: &str, one: &str, other: &str) -> Option<()> {
    let mut table = Table::read(&files[name]);
    let (a, b) = (table.at(one)?, table.at(other)?);
    table.rows.iter_mut().for_each(|row| row.swap(a, b));
    files.insert(name.to_owned(), table.text());
    Some(())
}

/// Damage to some rows of one recording.
fn rows(files: &mut Files, name: &str, channel: &str, damage: &str, rng: &mut ChaCha8Rng) -> Option<String> {
    let mut table = Table::read(&files[name]);
    let (count, column) = (table.rows.len(), table.at(channel)?);
    let values = table.values(column);
    let at = rng.random_range(0..count / 2);
    let some: Vec<usize> = (0..rng.random_range(1..=4)).map(|_| rng.random_range(0..count)).collect();
    let what = match damage {
        "channel frozen for a third of a run" => {
            (at..at + count / 3).for_each(|row| table.set(row, column, values[at]));
            format!("{channel} from row {at}")
        }
        "single values times ten" => {
            some.iter().for_each(|row| table.set(*row, column, 10.0 * values[*row]));
            format!("{channel} in {} rows", some.len())
        }
        "single values lost to zero" => {
            some.iter().for_each(|row| table.set(*row, column, 0.0));
            format!("{channel} in {} rows", some.len())
        }
        "fill values" => {
            let fill = *pick(rng, &[9.97e36, -999.0, -9999.0, 1e20, 99999.0]);
            some.iter().for_each(|row| table.set(*row, column, fill));
            format!("{channel}: {fill} in {} rows", some.len())
        }
        "rows lost" => {
            let lost = count / 5;
            table.rows.drain(at..at + lost);
            format!("{lost} from row {at}")
        }
        "rows doubled" => {
            let doubled: Vec<Vec<String>> = table.rows[at..at + 10].to_vec();
            table.rows.splice(at + 10..at + 10, doubled);
            format!("10 from row {at}")
        }
        "rows exchanged" => {
            table.rows[at..at + count / 4].reverse();
            format!("{} from row {at}", count / 4)
        }
        "clock set back" => {
            let time = table.at("t")?;
            let back = rng.random_range(3.0..3000.0_f64).round();
            table.each(time, |row, t| if row > at { t - back } else { t });
            format!("by {back} s at row {at}")
        }
        "heading averaged through north" => {
            let heading = table.at("psi")?;
            let degrees = table.header[heading].contains("deg");
            let turn = if degrees { 360.0 } else { std::f64::consts::TAU };
            // Headings from 0 to a turn, set to pass north in the middle, and every second row the mean of its neighbours.
            let psi = table.values(heading);
            let wrapped: Vec<f64> = psi.iter().map(|p| (p - psi[count / 2]).rem_euclid(turn)).collect();
            let mean = |row: usize| 0.5 * (wrapped[row - 1] + wrapped[(row + 1).min(count - 1)]);
            table.each(heading, |row, _| if row % 2 == 1 { mean(row) } else { wrapped[row] });
            "every second row".to_owned()
        }
        _ => {
            let (x, jump) = (table.at("x")?, rng.random_range(20.0..300.0_f64).round());
            table.each(x, |row, v| if row > at { v + jump } else { v });
            format!("{jump} m at row {at}")
        }
    };
    files.insert(name.to_owned(), table.text());
    Some(what)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn every_kind_of_damage_changes_a_recording() {
        let folder = tempfile::tempdir().unwrap();
        let sound = super::super::files::sound(3, folder.path()).unwrap();
        for kind in DAMAGES {
            let changed = (0..40_u64).filter(|seed| {
                let mut files = sound.clone();
                damage(&mut files, kind, &mut ChaCha8Rng::seed_from_u64(*seed)).is_some() && files != sound
            });
            assert!(changed.count() > 20, "{kind}");
        }
    }
}
