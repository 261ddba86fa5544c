//! What value an option wants that was given without one: its meaning and an example.
//! Nothing is parsed here.

use super::lines::filled;
use clap::Command;
use clap::error::{ContextKind, ContextValue, ErrorKind};

/// An example of a value by the name that the help gives values of its kind.
const EXAMPLES: [(&str, &str); 25] = [
    ("A,B", "resistance.quadratic,rudder.lift1"),
    ("COLUMNS", "one"),
    ("C_B", "0.7"),
    ("DEG", "20"),
    ("DIR", "results"),
    ("FAULT", "sign_error"),
    ("FILE", "results/fitted.toml"),
    ("KG", "3.4e6"),
    ("LIST", "turn,zigzag"),
    ("M", "50"),
    ("M/S", "6"),
    ("M2", "8.5"),
    ("MODEL", "results/fitted.toml"),
    ("N", "5"),
    ("NAME", "flow.asymmetry"),
    ("QUANTITY=NAME", "psi=Heading"),
    ("QUANTITY=UNIT", "u=kn"),
    ("RPM", "120"),
    ("S", "60"),
    ("SHARE", "0.25"),
    ("STUDY", "study.toml"),
    ("TABLE.KEY=VALUE", "hull.mass=3.4e6"),
    ("TEXT", "my-ship"),
    ("TYPE", "coaster"),
    ("X,Y", "-2.5,0.4"),
];

/// The option's own help and an example, where an error says that an option lacks its value; `arguments` are those of the program.
pub fn wanted(error: &clap::Error, program: &Command, arguments: &[String]) -> Option<String> {
    let lacks = error.kind() == ErrorKind::InvalidValue
        && matches!(error.get(ContextKind::InvalidValue), Some(ContextValue::String(value)) if value.is_empty());
    let Some(ContextValue::String(named)) = error.get(ContextKind::InvalidArg).filter(|_| lacks) else { return None };
    let long = named.split_whitespace().next()?.strip_prefix("--")?;
    // The command is the innermost one that the arguments name.
    let mut command = program;
    while let Some(inner) = arguments.iter().find_map(|a| command.find_subcommand(a)) {
        command = inner;
    }
    let mut options = command.get_arguments().chain(program.get_arguments());
    let option = options.find(|a| a.get_long() == Some(long))?;
    let help = option.get_help().map(ToString::to_string).unwrap_or_default();
    let kind = option.get_value_names().and_then(|names| names.first()).map(ToString::to_string).unwrap_or_default();
    let choice = option.get_possible_values().first().map(|v| v.get_name().to_owned());
    let example = EXAMPLES.iter().find(|(name, _)| *name == kind).map(|(_, example)| (*example).to_owned());
    let example = choice.or(example).map_or(String::new(), |value| format!("\n  Example: --{long} {value}"));
    let words = filled(&format!("--{long} wants a value: {help}"), 4);
    Some(format!("  {}{example}", words.trim_end()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Arg;

    #[test]
    fn an_option_without_its_value_is_reported_with_its_meaning_and_an_example() {
        let program = Command::new("t").subcommand(
            Command::new("sail").arg(Arg::new("speed").long("speed").value_name("M/S").help("Approach speed [m/s].")),
        );
        let arguments = ["t", "sail", "--speed"].map(str::to_owned);
        let error = program.clone().try_get_matches_from(&arguments).unwrap_err();
        let message = wanted(&error, &program, &arguments[1..]).unwrap();
        assert_eq!(message, "  --speed wants a value: Approach speed [m/s].\n  Example: --speed 6");
        let other = program.clone().try_get_matches_from(["t", "sail", "--sped"]).unwrap_err();
        assert_eq!(wanted(&other, &program, &arguments[1..]), None);
    }
}
