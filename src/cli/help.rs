//! `trimtab help`: a chapter of the guide, the help of a command, or the JSON schema of a file.
//! The guide's text is the library's; this file brings it to the width of a terminal.

use super::shared::answer::Answer;
use super::shared::error::CliError;
use super::shared::lines::filled;
use super::shared::output::{print, print_json};
use clap::Command;
use trimtab::files::suggestion;
use trimtab::guide::reference::tables;
use trimtab::guide::schema::{WITH_SCHEMA, schema};
use trimtab::guide::{CHAPTERS, Chapter, chapter};

const AFTER: &str = "\
Examples:
  trimtab help                          commands and topics
  trimtab help study                    every key of a study file
  trimtab help study --schema           its JSON schema, for editors
  trimtab help fit                      as `trimtab fit --help`";

/// Shows a topic of the guide, or the help of a command
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER)]
pub struct Args {
    /// A topic, or a command; both are listed without it.
    #[arg(value_name = "TOPIC")]
    topic: Vec<String>,
    /// Print the JSON schema of the file that the topic is about: study, ship, model or columns.
    #[arg(long)]
    schema: bool,
}

/// Runs the command; `program` defines the command line.
pub fn run(args: &Args, program: &Command) -> Result<Answer, CliError> {
    let topic = args.topic.join(" ");
    if args.schema {
        let Some(schema) = schema(&topic) else {
            let known = WITH_SCHEMA.join(", ");
            let text = format!("`{topic}` has no schema; topics with one are {known}: `trimtab help study --schema`");
            return Err(CliError::Argument(text));
        };
        print_json(&schema)?;
    } else if topic.is_empty() {
        print(&format!("{}\n{}", command_help(program, &[]).unwrap_or_default(), topics()))?;
    } else if let Some(chapter) = chapter(&topic) {
        print(&shown(chapter.text))?;
    } else if let Some(help) = command_help(program, &args.topic) {
        print(&help)?;
    } else if let Some(chapter) = describing(&topic) {
        print(&shown(chapter.text))?;
    } else {
        let commands: Vec<String> = program.get_subcommands().map(|c| c.get_name().to_owned()).collect();
        let known = CHAPTERS.iter().map(|c| c.name).chain(commands.iter().map(String::as_str));
        let near = suggestion(&topic, known);
        return Err(CliError::Argument(format!(
            "there is no topic or command `{topic}`{near}; `trimtab help` lists them"
        )));
    }
    Ok(Answer::Yes)
}

/// The chapter that has a table of this name, such as `runs` of a study.
fn describing(table: &str) -> Option<&'static Chapter> {
    let describes = |chapter: &&Chapter| tables(chapter.name).iter().any(|t| t.paths.iter().any(|path| path == table));
    CHAPTERS.iter().find(describes)
}

/// What `--help` of a command prints; nothing for one that there is not.
fn command_help(program: &Command, names: &[String]) -> Option<String> {
    let mut command = program;
    for name in names {
        command = command.find_subcommand(name)?;
    }
    let line = ["trimtab"].into_iter().chain(names.iter().map(String::as_str)).chain(["--help"]);
    program.clone().try_get_matches_from(line).err().map(|help| help.render().to_string())
}

fn topics() -> String {
    let mut text = String::from("Topics (`trimtab help TOPIC`)\n");
    for chapter in CHAPTERS {
        text += &format!("  {:12} {}\n", chapter.name, chapter.about);
    }
    text
}

/// Markdown as plain text for a terminal.
fn shown(markdown: &str) -> String {
    let mut text = String::new();
    let (mut paragraph, mut code): (String, Option<bool>) = (String::new(), None);
    for line in markdown.lines() {
        if let Some(language) = line.strip_prefix("```") {
            flush(&mut text, &mut paragraph);
            // Rust has lines that only its compiler is to see.
            code = if code.is_some() { None } else { Some(language.is_empty() || language == "no_run") };
        } else if let Some(rust) = code {
            if !(rust && (line == "#" || line.starts_with("# "))) {
                text += format!("    {line}").trim_end();
                text.push('\n');
            }
        } else if let Some(title) = line.strip_prefix('#') {
            flush(&mut text, &mut paragraph);
            let title = unmarked(title.trim_start_matches('#').trim());
            let underline = if line.starts_with("# ") { "=" } else { "-" };
            text += &format!("{title}\n{}\n", underline.repeat(title.chars().count()));
        } else if line.is_empty() || line.starts_with("<!--") {
            flush(&mut text, &mut paragraph);
            if !text.is_empty() && !text.ends_with("\n\n") {
                text.push('\n');
            }
        } else {
            if is_item(line) {
                flush(&mut text, &mut paragraph);
            }
            paragraph += if paragraph.is_empty() { "" } else { " " };
            paragraph += line.trim();
        }
    }
    flush(&mut text, &mut paragraph);
    text
}

/// Whether a line begins an entry of a list.
fn is_item(line: &str) -> bool {
    let rest = line.trim_start_matches(|c: char| c.is_ascii_digit());
    line.starts_with("- ") || (rest.len() < line.len() && rest.starts_with(". "))
}

/// A text without marks of emphasis and escapes.
fn unmarked(text: &str) -> String {
    text.replace("**", "").replace("\\[", "[").replace("\\]", "]").replace("\\<", "<")
}

/// Adds a paragraph in lines, those of an entry of a list behind its mark.
fn flush(text: &mut String, paragraph: &mut String) {
    let words = unmarked(paragraph);
    let indent = if is_item(&words) { words.find(' ').map_or(0, |i| i + 1) } else { 0 };
    *text += &filled(&words, indent);
    paragraph.clear();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::shared::lines::WIDTH;

    #[test]
    fn markdown_becomes_lines_of_80_characters() {
        let text =
            shown("# Title\n\nA **word** and\nmore.\n\n- one\n  two\n- `a` \\[m\\]\n\n```\n# hidden\nlet a;\n```\n");
        assert_eq!(text, "Title\n=====\n\nA word and more.\n\n- one two\n- `a` [m]\n\n    let a;\n");
        for chapter in CHAPTERS {
            let prose = |l: &&str| !l.starts_with("    ") && !l.starts_with('|');
            let long: Vec<&str> = shown(chapter.text)
                .lines()
                .filter(prose)
                .filter(|l| l.chars().count() > WIDTH)
                .map(|_| "long")
                .collect();
            assert!(long.is_empty(), "{}", chapter.name);
        }
    }
}
