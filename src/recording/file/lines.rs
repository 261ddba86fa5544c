//! The line of each row of a file, kept as stretches of successive lines: nearly every file is one stretch.
//! It numbers rows and reads none.

/// Line numbers by row, rising.
#[derive(Clone, Debug, Default)]
pub(in crate::recording) struct LineNumbers {
    /// First row of each stretch of successive lines, and its line.
    stretches: Vec<(usize, usize)>,
    rows: usize,
}

impl LineNumbers {
    /// So many rows on successive lines from `first` on.
    pub fn from(first: usize, rows: usize) -> Self {
        Self { stretches: vec![(0, first)], rows }
    }

    /// Adds a row.
    pub fn push(&mut self, line: usize) {
        let follows = self.stretches.last().is_some_and(|(row, first)| first + (self.rows - row) == line);
        if !follows {
            self.stretches.push((self.rows, line));
        }
        self.rows += 1;
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows
    }

    /// The line of a row.
    pub fn get(&self, row: usize) -> Option<usize> {
        let stretch = self.stretches.partition_point(|(first, _)| *first <= row).checked_sub(1)?;
        let (first, line) = self.stretches[stretch];
        (row < self.rows).then_some(line + (row - first))
    }

    /// The lines of all rows.
    pub fn iter(&self) -> impl Iterator<Item = usize> {
        (0..self.rows).filter_map(|row| self.get(row))
    }

    /// The lines of the rows for which `keep` says so, and those of the others.
    pub fn parted(&self, keep: impl Fn(usize) -> bool) -> (Self, Vec<usize>) {
        let (mut kept, mut dropped) = (Self::default(), Vec::new());
        for (row, line) in self.iter().enumerate() {
            if keep(row) {
                kept.push(line);
            } else {
                dropped.push(line);
            }
        }
        (kept, dropped)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_keep_their_lines_across_lines_that_are_left_out() {
        let lines = [2, 3, 4, 7, 8, 20];
        let mut numbers = LineNumbers::default();
        lines.iter().for_each(|line| numbers.push(*line));
        assert_eq!((numbers.len(), numbers.stretches.len()), (6, 3));
        assert_eq!(numbers.iter().collect::<Vec<_>>(), lines);
        assert_eq!((numbers.get(3), numbers.get(6), LineNumbers::default().get(0)), (Some(7), None, None));
        let (kept, dropped) = numbers.parted(|row| row != 1 && row < 4);
        assert_eq!((kept.iter().collect::<Vec<_>>(), dropped), (vec![2, 4, 7], vec![3, 8, 20]));
        assert_eq!(LineNumbers::from(2, 3).iter().collect::<Vec<_>>(), [2, 3, 4]);
    }
}
