//! Edits of text: harmless ones, which change no answer, and mistakes that every reader must refuse.
//! Damage to what sensors recorded is in `damage`.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::files::{Files, Table, recordings};

/// One of several at random.
pub fn pick<'a, T>(rng: &mut ChaCha8Rng, all: &'a [T]) -> &'a T {
    &all[rng.random_range(0..all.len())]
}

/// Edits that change no answer.
pub const HARMLESS: [&str; 10] = [
    "lines end with CR LF",
    "no line end at the end of the file",
    "blank lines at the end of the file",
    "columns in another order",
    "spaces around cells",
    "zeros at the end of numbers",
    "numbers with an exponent",
    "byte order mark",
    "comments in a TOML file",
    "a column that nobody asked for",
];

/// Makes a harmless edit of one file; gives its name.
pub fn harmless(files: &mut Files, edit: &str, rng: &mut ChaCha8Rng) -> String {
    let tables = recordings(files);
    let any: Vec<String> = files.keys().cloned().collect();
    let toml: Vec<String> = any.iter().filter(|name| name.ends_with(".toml")).cloned().collect();
    let all = match edit {
        "comments in a TOML file" => &toml,
        "lines end with CR LF" | "no line end at the end of the file" | "blank lines at the end of the file" => &any,
        _ => &tables,
    };
    let name = pick(rng, all).clone();
    let text = String::from_utf8_lossy(&files[&name]).into_owned();
    let cells = |change: &dyn Fn(&str) -> String| {
        let mut table = Table::read(text.as_bytes());
        let numbers = table.rows.iter_mut().flatten().filter(|c| c.trim().parse::<f64>().is_ok());
        numbers.for_each(|c| *c = change(c));
        table.text()
    };
    let changed = match edit {
        "lines end with CR LF" => text.replace('\n', "\r\n").into_bytes(),
        "no line end at the end of the file" => text.trim_end().as_bytes().to_vec(),
        "blank lines at the end of the file" => (text.clone() + "\n\n").into_bytes(),
        "columns in another order" => {
            let mut table = Table::read(text.as_bytes());
            let shift = rng.random_range(1..table.header.len());
            table.header.rotate_left(shift);
            table.rows.iter_mut().for_each(|row| row.rotate_left(shift));
            table.text()
        }
        "spaces around cells" => cells(&|c| format!(" {c} ")),
        "zeros at the end of numbers" => cells(&|c| if c.contains('.') { format!("{c}00") } else { format!("{c}.0") }),
        "numbers with an exponent" => cells(&|c| format!("{c}e0")),
        "byte order mark" => [&b"\xef\xbb\xbf"[..], text.as_bytes()].concat(),
        "comments in a TOML file" => format!("# a remark\n{text}\n# another\n").into_bytes(),
        _ => {
            let mut table = Table::read(text.as_bytes());
            table.header.push("watch".to_owned());
            table.rows.iter_mut().enumerate().for_each(|(i, row)| row.push(((i / 40) % 3).to_string()));
            table.text()
        }
    };
    files.insert(name.clone(), changed);
    name
}

/// Mistakes that must be refused.
pub const MISTAKES: [&str; 14] = [
    "a misspelt key",
    "a key twice",
    "nan as a value",
    "infinity as a value",
    "text as a value",
    "a negative length, mass or area",
    "a setting out of its range",
    "an unknown table",
    "a missing file",
    "an empty file",
    "bytes that are no text",
    "a missing column",
    "an unknown unit",
    "a cell that is no number",
];

/// Settings out of their ranges, by the table of the study.
const OUT_OF_RANGE: [(&str, &str); 16] = [
    ("fit", "max_iterations = -1"),
    ("fit", "max_yaw_rate = nan"),
    ("fit", "max_yaw_rate = 0.0"),
    ("fit", "threads = 3"),
    ("diagnose", "alpha = nan"),
    ("diagnose", "alpha = 2.0"),
    ("diagnose", "integration = { method = \"rk4\", substeps = 1000000000 }"),
    ("diagnose", "integration = { method = \"rk5\" }"),
    ("evaluate", "resamples = 1000000000000"),
    ("evaluate", "resamples = -3"),
    ("", "step = 1e-300"),
    ("", "step = 1e-9"),
    ("", "window = -5.0"),
    ("", "window = nan"),
    ("", "gaps = \"ignore\""),
    ("", "initial_state = \"guessed\""),
];

/// Makes a mistake in one file; gives its name, or `None` where the mistake has no place in the study.
pub fn mistake(files: &mut Files, mistake: &str, rng: &mut ChaCha8Rng) -> Option<String> {
    let tables = recordings(files);
    let toml = ["study.toml", "ship.toml", "model.toml", "columns.toml"].map(str::to_owned);
    match mistake {
        "a missing file" | "an empty file" | "bytes that are no text" => {
            let name = pick(rng, &[&tables[..], &toml[1..3]].concat()).clone();
            match mistake {
                "a missing file" => drop(files.remove(&name)),
                "an empty file" => drop(files.insert(name.clone(), Vec::new())),
                _ => drop(files.insert(name.clone(), (0..400).map(|_| rng.random_range(128..=255_u8)).collect())),
            }
            Some(name)
        }
        "a missing column" | "an unknown unit" | "a cell that is no number" => {
            let name = pick(rng, &tables).clone();
            let mut table = Table::read(&files[&name]);
            let channel = *pick(rng, &["t", "n", "delta", "psi", "x", "y"]);
            let column = table.at(channel)?;
            match mistake {
                "a missing column" => {
                    table.header.remove(column);
                    table.rows.iter_mut().for_each(|row| drop(row.remove(column)));
                }
                "an unknown unit" => {
                    let channel = table.header[column].split_whitespace().next()?.to_owned();
                    table.header[column] = format!("{channel} [{}]", pick(rng, &["furlong", "grad/h", "?", "m^7"]));
                }
                _ => {
                    let row = rng.random_range(0..table.rows.len());
                    let text = *pick(rng, &["abc", "1.2.3", "12;5", "0x1f", "--1", "1,5,"]);
                    table.rows[row][column] = text.to_owned();
                }
            }
            files.insert(name.clone(), table.text());
            Some(name)
        }
        "a setting out of its range" => {
            let (section, line) = *pick(rng, &OUT_OF_RANGE);
            let text = String::from_utf8_lossy(&files["study.toml"]).into_owned();
            let heading = format!("[{section}]\n");
            let text = if section.is_empty() {
                format!("{line}\n{text}")
            } else if text.contains(&heading) {
                text.replacen(&heading, &format!("{heading}{line}\n"), 1)
            } else {
                format!("{text}\n{heading}{line}\n")
            };
            files.insert("study.toml".to_owned(), text.into_bytes());
            Some(format!("study.toml: {line}"))
        }
        _ => {
            let name = pick(rng, &toml[..3]).clone();
            let text = String::from_utf8_lossy(&files[&name]).into_owned();
            let (changed, line) = mistaken_line(&text, mistake, rng)?;
            files.insert(name.clone(), changed.into_bytes());
            Some(format!("{name}: {line}"))
        }
    }
}

/// A TOML text with one line mistaken, and the line.
fn mistaken_line(text: &str, mistake: &str, rng: &mut ChaCha8Rng) -> Option<(String, String)> {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    if mistake == "an unknown table" {
        let line = pick(rng, &["[fitt]", "[hul]", "[parameter]", "[diagnosis]"]).to_string();
        lines.extend([line.clone(), "value = 1.0".to_owned()]);
        return Some((lines.join("\n") + "\n", line));
    }
    let is_number = |line: &&String| line.split_once(" = ").is_some_and(|(_, v)| v.trim().parse::<f64>().is_ok());
    let is_size = |line: &&String| {
        let sized = ["lpp", "breadth", "draught", "mass", "diameter", "area", "span", "gyration"];
        sized.iter().any(|key| line.starts_with(&format!("{key} ")))
    };
    let is_pair = |line: &&String| line.contains(" = ") && !line.starts_with('#');
    let fits = |line: &&String| match mistake {
        "a misspelt key" | "a key twice" => is_pair(line),
        "a negative length, mass or area" => is_size(line),
        _ => is_number(line),
    };
    let places: Vec<usize> = lines.iter().enumerate().filter(|(_, line)| fits(line)).map(|(i, _)| i).collect();
    let at = *places.get(rng.random_range(0..places.len().max(1)))?;
    let (key, value) = lines[at].split_once(" = ").map(|(k, v)| (k.to_owned(), v.to_owned()))?;
    lines[at] = match mistake {
        "a misspelt key" => {
            let mut letters: Vec<char> = key.chars().collect();
            let inner = letters.iter().rposition(|c| c.is_ascii_alphabetic())?;
            letters[inner] = if letters[inner] == 'q' { 'z' } else { 'q' };
            format!("{} = {value}", letters.into_iter().collect::<String>())
        }
        "a key twice" => format!("{key} = {value}\n{key} = {value}"),
        "nan as a value" => format!("{key} = nan"),
        "infinity as a value" => format!("{key} = {}inf", pick(rng, &["", "-"])),
        "text as a value" => format!("{key} = \"{}\"", value.trim_matches('"')),
        _ => format!("{key} = -{value}"),
    };
    let line = lines[at].clone();
    Some((lines.join("\n") + "\n", line))
}
