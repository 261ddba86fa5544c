//! A paragraph for a terminal: words divided into lines with a hanging margin.
//! The caller gives the text and the width of the terminal.

/// A paragraph behind `lead`, which fills the first line up to `margin`; its lines end at `width`, and those after the first begin
/// two characters behind the margin.
pub(super) fn wrapped(lead: &str, margin: usize, width: usize, paragraph: &str) -> String {
    let mut text = lead.to_owned();
    let mut column = margin;
    for word in paragraph.split(' ') {
        let length = word.chars().count();
        if column > margin && column + 1 + length > width {
            text += &format!("\n{}", " ".repeat(margin + 2));
            column = margin + 2;
        } else if column > margin {
            text.push(' ');
            column += 1;
        }
        text += word;
        column += length;
    }
    text.push('\n');
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_at_the_width_and_hang_behind_the_margin() {
        assert_eq!(wrapped("LEAD ", 5, 14, "one two three four"), "LEAD one two\n       three\n       four\n");
        assert_eq!(wrapped("", 0, 7, "one two three"), "one two\n  three\n");
    }
}
