//! Paragraphs as lines that a terminal of 80 characters shows whole.
//! Tables are laid out by the library, and what is in a paragraph is said where it is printed.

/// Width of the lines.
pub const WIDTH: usize = 80;

/// A paragraph in lines of at most [`WIDTH`] characters, those after the first behind so many blanks; an empty one is nothing.
pub fn filled(paragraph: &str, indent: usize) -> String {
    let (mut text, mut column) = (String::new(), 0);
    for word in paragraph.split_whitespace() {
        let length = word.chars().count();
        if column > 0 && column + 1 + length > WIDTH {
            text += &format!("\n{}", " ".repeat(indent));
            column = indent;
        } else if column > 0 {
            text.push(' ');
            column += 1;
        }
        text += word;
        column += length;
    }
    if column > 0 {
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{WIDTH, filled};

    #[test]
    fn lines_end_at_the_width_and_a_long_word_has_its_own() {
        let long = "x".repeat(WIDTH + 5);
        let text = filled(&format!("- {} {long} end", "word ".repeat(20)), 2);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines.iter().all(|l| l.chars().count() <= WIDTH || l.trim() == long), "{text}");
        assert!(lines[1].starts_with("  word") && lines.contains(&format!("  {long}").as_str()), "{text}");
        assert_eq!(filled(" ", 3), "");
    }
}
