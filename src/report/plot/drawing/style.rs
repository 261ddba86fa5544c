//! How text looks in a figure: its sizes and colours, and how it is broken into lines that fit.
//! It places nothing on the sheet.

use crate::report::plot::palette::Color;
use crate::report::plot::sheet::canvas::Type;
use crate::report::plot::sheet::font::text_width;

/// Title of the figure, px.
pub(in crate::report::plot) const TITLE: f32 = 30.0;
/// Title of a panel, px.
pub(in crate::report::plot) const HEADING: f32 = 25.0;
/// Labels of axes and entries of the legend, px.
pub(in crate::report::plot) const LABEL: f32 = 24.0;
/// Labels of ticks, px.
pub(in crate::report::plot) const TICK: f32 = 22.0;
/// Remarks in a plot, px.
pub(in crate::report::plot) const NOTE: f32 = 20.0;
/// Around the figure, px.
pub(in crate::report::plot) const EDGE: f32 = 24.0;
/// From one line of text to the next, over the font size.
pub(in crate::report::plot) const LEADING: f32 = 1.3;
/// Colour of text.
pub(in crate::report::plot) const INK: Color = Color::rgb(30, 30, 30);
/// Colour of frames and ticks.
pub(in crate::report::plot) const FRAME: Color = Color::rgb(110, 110, 110);

/// Plain text of a size.
pub(in crate::report::plot) const fn ink(size: f32) -> Type {
    Type { size, bold: false, color: INK }
}

/// Bold text of a size.
pub(in crate::report::plot) const fn bold(size: f32) -> Type {
    Type { size, bold: true, color: INK }
}

/// Breaks a text at its spaces into at most `most` lines of `width` px; returns whether it did so without cutting anything.
pub(in crate::report::plot) fn fit_lines(
    text: &str,
    size: f32,
    bold: bool,
    width: f32,
    most: usize,
) -> (Vec<String>, bool) {
    let mut lines: Vec<String> = vec![];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size, bold) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    let mut whole = lines.len() <= most;
    if !whole {
        let rest = lines.split_off(most.max(1) - 1).join(" ");
        lines.push(rest);
    }
    for line in &mut lines {
        let short = cut(line, size, bold, width);
        whole &= short == *line;
        *line = short;
    }
    (lines, whole)
}

/// A text, ended by an ellipsis where it would be wider than `width` px.
pub(in crate::report::plot) fn cut(text: &str, size: f32, bold: bool, width: f32) -> String {
    if text_width(text, size, bold) <= width {
        return text.to_owned();
    }
    let mut short: String = text.to_owned();
    while short.pop().is_some() {
        let candidate = format!("{}…", short.trim_end());
        if text_width(&candidate, size, bold) <= width {
            return candidate;
        }
    }
    "…".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_are_wrapped_and_at_last_cut() {
        let (lines, whole) = fit_lines("propeller race on the rudder", TICK, false, 200.0, 3);
        assert!(whole && lines.len() > 1, "{lines:?}");
        assert!(lines.iter().all(|l| text_width(l, TICK, false) <= 200.0));
        let (lines, whole) = fit_lines("Donaudampfschifffahrtsgesellschaft", TICK, false, 200.0, 3);
        assert!(!whole && lines[0].ends_with('…'));
        assert_eq!(fit_lines("", TICK, false, 200.0, 3), (vec![], true));
    }
}
