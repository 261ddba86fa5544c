//! The estimates as the text of a ship file and of a model file, each value with its source and its spread.
//! What the files mean is with those who read them, [`crate::ship`] and [`crate::model`].

use super::estimated::Estimated;
use super::sheet::{Entry, Origin, number};
use crate::numerals::sig;
use crate::ship::Ship;
use toml::Value;

/// Longest line of a comment.
const WIDTH: usize = 80;

/// A ship as the text of a ship file, in SI units.
pub(super) fn ship_text(kind: &str, speed: f64, outside: &[String], entries: &[Entry]) -> String {
    let mut text = comment(&format!(
        "A ship file of `trimtab new`, type {kind}. Values without \"given\" are estimates for a service speed of {} m/s: put what you know in \
         their place. Hull coefficients that are not here are estimated whenever the file is read (Clarke 1982, Inoue 1981); a table [coefficients] replaces them.",
        sig(speed, 4)
    ));
    for sentence in outside {
        text += &comment(&format!("Outside the range of the estimates: {sentence}."));
    }
    for entry in entries.iter().filter(|e| !e.key.contains('.')) {
        text += &format!("{} = {}\n", entry.key, entry.value);
    }
    let mut tables: Vec<&str> = Vec::new();
    for (table, _) in entries.iter().filter_map(|e| e.key.split_once('.')) {
        if !tables.contains(&table) {
            tables.push(table);
        }
    }
    for table in tables {
        text += &format!("\n[{table}]\n");
        for entry in entries {
            if let Some((_, key)) = entry.key.split_once('.').filter(|(of, _)| *of == table) {
                let free = ["parameters", "coefficients", "coefficients_prime"].contains(&table);
                text += &line(entry, &if free { format!("\"{key}\"") } else { key.to_owned() });
            }
        }
    }
    text
}

impl Estimated {
    /// The ship as the text of a ship file, in SI units.
    pub fn ship_file(&self) -> &str {
        &self.text
    }

    /// A model of the ship as the text of a model file: the spreads of the estimates as priors.
    ///
    /// The paper's eleven parameters are free, and their priors count; the others have their priors ready and are fixed until `free = true`
    /// is set.
    pub fn model_file(&self) -> String {
        let ship = &self.ship;
        let mut text = comment(&format!(
            "Model of {} by `trimtab new`. The priors are the spreads of the estimates in the ship file. Free are the paper's eleven parameters \
             (p0 to p10); `free = true` frees another with its prior, `hull = \"free\"` all coefficients of the hull.",
            serde_json::Value::from(ship.name.as_str())
        ));
        text += &format!("name = {}\nform = \"regular\"\n\n[parameters]\n", Value::String(ship.name.clone()));
        for prior in self.priors() {
            let value = if prior.free { format!("value = {}, ", float(prior.mean)) } else { String::new() };
            let (mean, sd) = (float(prior.mean), float(prior.sd));
            text += &format!("\"{}\" = {{ {value}prior = {{ mean = {mean}, sd = {sd} }} }}\n", prior.name);
        }
        text
    }

    /// The priors that follow from the spreads.
    fn priors(&self) -> Vec<NamedPrior> {
        let mut priors = Vec::new();
        for entry in &self.entries {
            let Origin::Estimated { spread: Some(sd), .. } = entry.origin else { continue };
            if sd == 0.0 {
                continue;
            }
            let fixed = |name: &str, mean: f64, sd: f64| NamedPrior { name: name.into(), mean, sd, free: false };
            let value = number(&entry.value).unwrap_or(0.0);
            match entry.key.as_str() {
                "hull.mass" | "hull.x_g" => priors.push(fixed(&entry.key, value, sd)),
                "hull.gyration" => {
                    let inertia = self.ship.yaw_inertia();
                    priors.push(fixed("hull.inertia", inertia, 2.0 * sd / value * inertia));
                }
                "propeller.wake" => priors.push(fixed("flow.wake", value, sd)),
                "propeller.thrust_deduction" => priors.push(fixed("flow.thrust_deduction", value, sd)),
                "propeller.astern" => priors.push(fixed("flow.astern", value, sd)),
                "propeller.thrust_coefficients" => {
                    let k = self.ship.propeller.thrust_coefficients;
                    let share = [1.0, 2.0, 2.0];
                    let named = k.iter().zip(share).enumerate();
                    priors.extend(named.map(|(i, (k, share))| fixed(&format!("flow.kt{i}"), *k, share * sd)));
                }
                "rudder.straightening" | "rudder.lever" | "rudder.wake_ratio" | "rudder.race" => {
                    priors.push(fixed(&entry.key.replace("rudder.", "flow."), value, sd));
                }
                "parameters.resistance.quadratic" => priors.extend(self.resistance(value, sd)),
                key => {
                    if let Some(name) = key.strip_prefix("parameters.") {
                        priors.push(NamedPrior { name: name.into(), mean: value, sd, free: true });
                    }
                }
            }
        }
        priors
    }

    /// The spread of the resistance at the service speed, on each of the three powers.
    fn resistance(&self, quadratic: f64, sd: f64) -> [NamedPrior; 3] {
        let prior = |name: &str, mean: f64, sd: f64| NamedPrior { name: name.into(), mean, sd, free: true };
        [
            prior("resistance.linear", 0.0, sd * self.speed),
            prior("resistance.quadratic", quadratic, sd),
            prior("resistance.cubic", 0.0, sd / self.speed),
        ]
    }

    /// What is estimated of a ship, given as another file has it, in units of its spread: dotted key and (value - estimate) / spread.
    pub fn deviations(&self, of: &Ship) -> Vec<(String, f64)> {
        let other = toml::Table::try_from(of).unwrap_or_default();
        let deviation = |entry: &Entry| {
            let Origin::Estimated { spread: Some(sd), .. } = entry.origin else { return None };
            if sd == 0.0 {
                return None;
            }
            let theirs = super::sheet::at(&other, &entry.key)?;
            let first = |v: &Value| number(v).or_else(|| v.as_array().and_then(|a| a.first()).and_then(number));
            Some((entry.key.clone(), (first(theirs)? - first(&entry.value)?) / sd))
        };
        self.entries.iter().filter_map(deviation).collect()
    }
}

/// A prior on a parameter of a model.
struct NamedPrior {
    name: String,
    mean: f64,
    sd: f64,
    /// Whether it is one of the eleven that a fit changes.
    free: bool,
}

/// One entry with its comment.
fn line(entry: &Entry, key: &str) -> String {
    let value = match &entry.value {
        Value::Float(x) => float(*x),
        other => other.to_string(),
    };
    match &entry.origin {
        Origin::Given => format!("{:<31} # given\n", format!("{key} = {value}")),
        Origin::Estimated { source, spread } => {
            let spread = spread.map_or(String::new(), |s| format!("; spread {}", sig(s, 2)));
            format!("{}{key} = {value}\n", comment(&format!("{source}{spread}")))
        }
    }
}

/// A number as TOML reads it back: always with a point or an exponent.
fn float(x: f64) -> String {
    Value::Float(super::sheet::rounded(x, 6)).to_string()
}

/// A comment in lines of at most [`WIDTH`] characters.
fn comment(text: &str) -> String {
    let mut lines = vec![String::from("#")];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        if lines[last].len() + 1 + word.len() > WIDTH {
            lines.push(format!("#   {word}"));
        } else {
            lines[last] += &format!(" {word}");
        }
    }
    lines.join("\n") + "\n"
}
