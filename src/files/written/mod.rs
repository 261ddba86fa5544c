//! Files written by hand: their text, and what is wrong with it, every mistake at once and in plain words.
//! What the keys mean is with the types that are read: study, ship, model, column map.

mod kind;
mod mistake;
mod place;
mod syntax;
mod table;
mod text;
mod words;

pub use kind::Kind;
pub use mistake::{Mistake, joined, line_at};
pub use table::{read_tables, read_toml, section};
pub use text::{bytes_of, near_file, read_text};
pub use words::in_words;
