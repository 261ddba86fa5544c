//! The guide: a chapter a topic, as pages of this documentation and as the text of `trimtab help TOPIC`.
//! Lists of keys in it are written by [`reference`](mod@reference) from the types that read the files; nothing is read here.

pub mod reference;
pub mod schema;

macro_rules! chapters {
    ($($name:ident, $about:literal;)*) => {
        $(
            #[doc = include_str!(concat!(stringify!($name), ".md"))]
            pub mod $name {}
        )*

        /// Every chapter, in the order in which they are best read.
        pub const CHAPTERS: &[Chapter] = &[
            $(Chapter { name: stringify!($name), about: $about, text: include_str!(concat!(stringify!($name), ".md")) },)*
        ];
    };
}

/// A chapter of the guide.
#[derive(Clone, Copy, Debug)]
pub struct Chapter {
    /// The topic, as in `trimtab help TOPIC`.
    pub name: &'static str,
    /// What it is about, in a line.
    pub about: &'static str,
    /// Its text in Markdown.
    pub text: &'static str,
}

chapters! {
    tutorial, "from your own log to an answer";
    study, "every key of a study file and of its table of runs";
    columns, "every key of a column map: foreign layouts, units, signs, clocks";
    channels, "what can be recorded: names, units, ranges, signs";
    ship, "every key of a ship file";
    model, "every key of a model file";
    parameters, "which parameters these data determine";
    diagnosis, "how to read a diagnosis: verdicts, grades, proof";
    answer, "every key of diagnosis.json, and the numbers on which a verdict turns";
    theory, "the equations: model, simulation, fit, measures, diagnosis";
    faq, "questions and answers";
    glossary, "the words of this project";
}

/// The chapter of that name.
pub fn chapter(name: &str) -> Option<&'static Chapter> {
    CHAPTERS.iter().find(|chapter| chapter.name == name)
}
