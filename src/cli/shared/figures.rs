//! Arguments of every command that draws: the formats of its figures and their width on a page, and the captions beside them.
//! The figures themselves are drawn by the library.

use clap::ValueEnum;
use std::collections::BTreeMap;
use trimtab::report::plot::{Figure, Format, Width};

/// Arguments that every command with figures has.
#[derive(Clone, Debug, clap::Args)]
pub struct FigureArgs {
    /// Formats of the figures; several with commas between: png,svg,pdf. PDF has its letters embedded.
    #[arg(long, value_name = "LIST", value_enum, value_delimiter = ',', default_value = "png")]
    format: Vec<Named>,
    /// Lay the figures out for one column of a printed page (89 mm) or two (183 mm); as wide as they need to be if not given.
    #[arg(long, value_name = "COLUMNS", value_enum)]
    width: Option<Columns>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Named {
    Png,
    Svg,
    Pdf,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Columns {
    One,
    Two,
}

/// How figures are to be drawn.
#[derive(Clone, Debug)]
pub struct Drawing {
    pub formats: Vec<Format>,
    width: Option<Width>,
}

impl Default for Drawing {
    fn default() -> Self {
        Self { formats: vec![Format::Png], width: None }
    }
}

impl From<&FigureArgs> for Drawing {
    fn from(args: &FigureArgs) -> Self {
        let mut formats: Vec<Format> = Vec::new();
        for named in &args.format {
            let format = match named {
                Named::Png => Format::Png,
                Named::Svg => Format::Svg,
                Named::Pdf => Format::Pdf,
            };
            if !formats.contains(&format) {
                formats.push(format);
            }
        }
        let width = args.width.map(|columns| match columns {
            Columns::One => Width::One,
            Columns::Two => Width::Two,
        });
        Self { formats, width }
    }
}

impl Drawing {
    /// A figure at the width that was asked for.
    pub fn laid_out(&self, figure: Figure) -> Figure {
        match self.width {
            Some(width) => figure.to_width(width),
            None => figure,
        }
    }
}

/// The captions of the figures of a command, by folder.
#[derive(Debug, Default)]
pub struct Captions(BTreeMap<String, String>);

impl Captions {
    /// Notes a figure that is written as `stem` with these endings.
    pub fn add(&mut self, stem: &str, figure: &Figure, formats: &[Format]) {
        let (folder, name) = stem.rsplit_once('/').unwrap_or(("", stem));
        let files: Vec<String> = formats.iter().map(|f| format!("`{name}.{}`", f.extension())).collect();
        let mut text = format!("## {name}: {}\n\n", figure.title);
        if let Some(shown) = formats.iter().find(|f| **f != Format::Pdf) {
            text += &format!("![{}]({name}.{})\n\n", figure.title, shown.extension());
        }
        if !figure.caption.is_empty() {
            text += &format!("{}\n\n", figure.caption);
        }
        text += &format!("Files: {}; its numbers are in `{name}.csv`.\n\n", files.join(", "));
        *self.0.entry(folder.to_owned()).or_default() += &text;
    }

    /// The files of captions, with their texts: `figures.md` in a folder of figures, `COMMAND_figures.md` beside other results, which other
    /// commands write there too.
    pub fn files(&self, command: &str) -> Vec<(String, String)> {
        let one = |(folder, text): (&String, &String)| {
            let name = match folder.as_str() {
                "" => format!("{}_figures.md", command.replace(' ', "_")),
                folder => format!("{folder}/figures.md"),
            };
            (name, format!("# Figures of `trimtab {command}`\n\n{}\n", text.trim_end()))
        };
        self.0.iter().map(one).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn captions_are_beside_their_figures_and_name_every_file() {
        let mut captions = Captions::default();
        let figure = Figure::new("Tracks").caption("3 of 8 test runs.");
        captions.add("tracks", &figure, &[Format::Pdf, Format::Svg]);
        captions.add("figures/forces", &figure, &[Format::Png]);
        let files = captions.files("maneuver turning");
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["maneuver_turning_figures.md", "figures/figures.md"]);
        let text = &files[0].1;
        for part in [
            "## tracks: Tracks",
            "![Tracks](tracks.svg)",
            "3 of 8 test runs.",
            "`tracks.pdf`, `tracks.svg`",
            "`tracks.csv`",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
}
