//! `trimtab completions` and `trimtab man`: what a shell and a manual know of the command line, written from its definition.
//! It installs nothing; the help says where the files belong.

use super::shared::answer::Answer;
use super::shared::error::CliError;
use super::shared::output::{Output, OutputArgs, print, print_file};
use clap::Command;
use clap_complete::Shell;
use clap_mangen::Man;
use std::path::PathBuf;

const COMPLETIONS: &str = "\
Where the script belongs:
  trimtab completions bash > ~/.local/share/bash-completion/completions/trimtab
  trimtab completions zsh > ~/.zfunc/_trimtab          with `fpath+=~/.zfunc` before `compinit` in ~/.zshrc
  trimtab completions fish > ~/.config/fish/completions/trimtab.fish
  trimtab completions powershell >> $PROFILE";

const MAN: &str = "\
Example:
  trimtab man --out ~/.local/share/man/man1
  man trimtab-fit";

/// Prints a script that completes commands and options in a shell
#[derive(Debug, clap::Args)]
#[command(after_help = COMPLETIONS)]
pub struct CompletionsArgs {
    /// The shell.
    shell: Shell,
}

/// Writes a manual page of every command
#[derive(Debug, clap::Args)]
#[command(after_help = MAN)]
pub struct ManArgs {
    /// Folder for the pages; created if absent.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Prints the script of a shell; `program` defines the command line.
pub fn completions(args: &CompletionsArgs, mut program: Command) -> Result<Answer, CliError> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut program, "trimtab", &mut script);
    print_file(&String::from_utf8_lossy(&script))?;
    Ok(Answer::Yes)
}

/// Writes the manual pages of `program`.
pub fn man(args: &ManArgs, mut program: Command) -> Result<Answer, CliError> {
    let mut output = Output::new("man", &OutputArgs { out: Some(args.out.clone()), json: false, tables: Vec::new() })?;
    program.build();
    pages(&mut output, program, "trimtab")?;
    let written = output.close();
    let printed = print(written.line().trim_start());
    written.ended(printed)?;
    Ok(Answer::Yes)
}

/// The page of a command and those of its own commands, each under its whole name.
fn pages(output: &mut Output, command: Command, name: &str) -> Result<(), CliError> {
    for inner in command.get_subcommands().filter(|c| c.get_name() != "help" || name == "trimtab") {
        pages(output, inner.clone(), &format!("{name}-{}", inner.get_name()))?;
    }
    let mut page = Vec::new();
    // The manual has one name for a page, where the help has words.
    let rendered = Man::new(command.display_name(name.to_owned()))
        .title(name.to_uppercase())
        .source(concat!("trimtab ", env!("CARGO_PKG_VERSION")))
        .render(&mut page);
    rendered.map_err(|e| CliError::Format { format: "a manual page", message: e.to_string() })?;
    output.file(format!("{name}.1"), &page);
    Ok(())
}
