//! The command line: one file a command, and what the commands share (arguments, loading, output, exit codes).
//! The library computes; a command only reads arguments, calls it, and prints.

mod compare;
mod demo;
pub mod diagnose;
mod dossier;
pub mod evaluate;
mod export;
pub mod fit;
mod help;
mod maneuver;
mod plan;
pub mod shared;
mod shell;
mod simulate;
pub mod study;
mod sweep;
mod terms;

use clap::error::ContextKind;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use shared::answer::Answer;
use shared::error::CliError;
use shared::processor::Build;
use shared::progress::tell_progress;
use shared::terminal::{plain, tell};
use shared::wanted::wanted;
use shared::{arguments, processor, style};
use std::ffi::OsString;
use study::{check, import, new, split};
use trimtab::files::ranks::{Ranks, Traffic};
use trimtab::report::{USUAL, set_width};

const AFTER_HELP: &str = "\
Begin with
  trimtab demo                       the whole job on built-in trials; leaves a study to copy
  trimtab help tutorial              from your own log to an answer
  trimtab new --lpp L --breadth B --draught D --type TYPE
                                     a ship file; what is not known is estimated
  trimtab import LOG... --out STUDY  make a study of logs: CSV, NMEA 0183, Parquet
  trimtab check STUDY                are the recordings fit to be used?
  trimtab fit STUDY --out results    fit the model; writes results/fitted.toml
  trimtab evaluate STUDY --model results/fitted.toml
                                     judge it on the test runs
  trimtab diagnose STUDY --out results
                                     what physics does the model lack?
  trimtab plan STUDY                 before going to sea: what would these trials show?

A STUDY is a TOML file that names ship, model and recordings; `trimtab demo` writes one with comments.
Topics of `trimtab help`: tutorial, study, columns, channels, ship, model, parameters, diagnosis, answer, theory, faq, glossary.

Exit codes
  0  done
  1  it ran, but the answer is no: did not converge, a check failed
  2  it could not run: one message on standard error says why and what to do";

const TOO_NEW: &str = "this program was built for processors with AVX2 and FMA, which this one lacks. Build it for this one: \
                       RUSTFLAGS=\"-C target-cpu=native\" cargo build --release";
const TOO_OLD: &str = "this program was built without AVX2, which this processor has: results are the same, but a fit takes several \
                       times as long. Build it in its own folder, where `.cargo/config.toml` asks for AVX2.";

/// Fits an interpretable manoeuvring model to recordings of a ship, and finds the physics it lacks.
#[derive(Debug, Parser)]
#[command(name = "trimtab", version, after_help = AFTER_HELP, max_term_width = 100, disable_help_subcommand = true)]
struct Cli {
    /// Number of threads; the number of processors if not given. Results do not depend on it.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    New(new::Args),
    Import(import::Args),
    Split(split::Args),
    Check(check::Args),
    Simulate(simulate::Args),
    Fit(fit::Args),
    Evaluate(evaluate::Args),
    Diagnose(diagnose::Args),
    Dossier(dossier::Args),
    #[command(alias = "manoeuvre")]
    Maneuver(maneuver::Args),
    Plan(plan::Args),
    Sweep(sweep::Args),
    Compare(compare::Args),
    Export(export::Args),
    Terms(terms::Args),
    Demo(demo::Args),
    Help(help::Args),
    Completions(shell::CompletionsArgs),
    Man(shell::ManArgs),
}

/// The command line, in which every option takes a negative number: that it must be positive is for the option to say.
fn program() -> clap::Command {
    fn signed(command: clap::Command) -> clap::Command {
        command.mut_subcommands(signed).mut_args(|argument| {
            let option = argument.get_long().is_some() && argument.get_action().takes_values();
            if option { argument.allow_negative_numbers(true) } else { argument }
        })
    }
    signed(Cli::command())
}

/// Begin of the last line of a message about an argument.
const MORE: &str = "For more information";

/// A message about an argument with what a number must be said as to a user, not as the reader of numbers says it.
fn in_words(message: &str) -> String {
    message
        .replace("invalid float literal", "it must be a number, without a unit and with a decimal point")
        .replace("invalid digit found in string", "it must be a whole number of 0 or more")
}

/// Runs a command from its arguments, the name of the program first, and gives the exit code.
pub fn run(given: impl IntoIterator<Item = OsString>) -> u8 {
    let given: Vec<OsString> = given.into_iter().skip(1).collect();
    arguments::keep(&given);
    tell_progress();
    match processor::build() {
        Build::Suits => {}
        Build::TooNew => {
            tell(&format!("trimtab: {TOO_NEW}"));
            return 2;
        }
        Build::TooOld => tell(&format!("warning: {TOO_OLD}")),
    }
    let parsed = program()
        .try_get_matches_from(std::iter::once("trimtab".into()).chain(given))
        .and_then(|given| Cli::from_arg_matches(&given));
    let cli = match parsed {
        Ok(cli) => cli,
        Err(mut wrong) if wrong.use_stderr() => {
            // How to pass what looks like an option as a file is no help to who misspelt an option.
            wrong.remove(ContextKind::Suggested);
            let mut message = in_words(&wrong.render().to_string());
            if let Some(words) = wanted(&wrong, &program(), &arguments::given()) {
                message = message.replace(MORE, &format!("{words}\n\n{MORE}"));
            }
            tell(message.trim_end());
            return 2;
        }
        // Help, or the version.
        Err(asked) => {
            // Nobody reads it: there is nothing to do about that.
            let _ = asked.print();
            return 0;
        }
    };
    set_width(style::columns().unwrap_or(USUAL));
    let ranks = Ranks::join();
    let outcome = execute(&cli, &ranks);
    if let (Err(error), true) = (&outcome, ranks.size() > 1) {
        ranks.fail(&plain(&error.to_string()));
    }
    if ranks.is_first() && ranks.size() > 1 {
        let Traffic { exchanges, bytes } = ranks.traffic();
        tell(&format!("trimtab: {} ranks; each sent {bytes} bytes in {exchanges} exchanges", ranks.size()));
    }
    match outcome {
        Ok(Answer::Yes) => 0,
        Ok(Answer::No) => 1,
        Err(error) => {
            tell(&format!("trimtab: {error}"));
            2
        }
    }
}

fn execute(cli: &Cli, ranks: &Ranks) -> Result<Answer, CliError> {
    if let Some(threads) = cli.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global()?;
    }
    match &cli.command {
        Command::Fit(args) => fit::run(args, ranks),
        Command::Evaluate(args) => evaluate::run(args, ranks),
        // The work of the others is not divided: one rank does it.
        _ if !ranks.is_first() => Ok(Answer::Yes),
        Command::New(args) => new::run(args),
        Command::Import(args) => import::run(args),
        Command::Split(args) => split::run(args),
        Command::Check(args) => check::run(args),
        Command::Simulate(args) => simulate::run(args),
        Command::Diagnose(args) => diagnose::run(args),
        Command::Dossier(args) => dossier::run(args),
        Command::Maneuver(args) => maneuver::run(args),
        Command::Plan(args) => plan::run(args),
        Command::Sweep(args) => sweep::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Export(args) => export::run(args),
        Command::Terms(args) => terms::run(args),
        Command::Demo(args) => demo::run(args),
        Command::Help(args) => help::run(args, &Cli::command()),
        Command::Completions(args) => shell::completions(args, Cli::command()),
        Command::Man(args) => shell::man(args, Cli::command()),
    }
}

#[cfg(test)]
mod tests {
    use super::Cli;
    use clap::{CommandFactory, Parser};
    use trimtab::guide::CHAPTERS;

    #[test]
    fn the_command_line_is_well_formed() {
        Cli::command().debug_assert();
    }

    #[test]
    fn every_command_in_the_guide_is_one_that_this_program_takes() {
        for chapter in CHAPTERS {
            let mut inside = false;
            for line in chapter.text.lines() {
                if let Some(language) = line.strip_prefix("```") {
                    inside = language == "sh";
                } else if inside && line.starts_with("trimtab ") {
                    let parsed = Cli::try_parse_from(line.split_whitespace());
                    assert!(
                        parsed.is_ok(),
                        "{}.md: {line}\n{}",
                        chapter.name,
                        parsed.err().map_or(String::new(), |e| e.to_string())
                    );
                }
            }
        }
    }

    #[test]
    fn no_topic_has_the_name_of_a_command() {
        let command = Cli::command();
        assert!(CHAPTERS.iter().all(|c| command.find_subcommand(c.name).is_none()));
    }
}
