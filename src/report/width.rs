//! How wide text may be: tables and paragraphs that are made on a thread fit the width that is set there.
//! How wide a terminal is, is asked where text is printed.

use std::cell::Cell;

/// Width where nobody has set one: that of files, which do not depend on a terminal.
pub const USUAL: usize = 100;
/// Least width that is laid out for.
const LEAST: usize = 40;

thread_local! {
    static WIDTH: Cell<usize> = const { Cell::new(USUAL) };
}

/// The width of text made on this thread, in characters.
#[must_use]
pub fn width() -> usize {
    WIDTH.get()
}

/// Sets the width of text made on this thread, in characters; at least 40.
pub fn set_width(columns: usize) {
    WIDTH.set(columns.max(LEAST));
}

/// Makes a text of a width, whatever is set.
pub fn at_width<T>(columns: usize, make: impl FnOnce() -> T) -> T {
    let before = WIDTH.replace(columns.max(LEAST));
    let made = make();
    WIDTH.set(before);
    made
}
