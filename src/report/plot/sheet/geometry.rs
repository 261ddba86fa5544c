//! Points and rectangles of a sheet in pixels, y down, and paths and polygons cut at a rectangle or into dashes.
//! Pure arithmetic: nothing here draws.

/// A point of the sheet: px from the left, px from the top.
pub(in crate::report::plot) type Px = (f32, f32);

/// A rectangle of the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::report::plot) struct Rect {
    pub left: f32,
    pub top: f32,
    pub right: f32,
    pub bottom: f32,
}

impl Rect {
    pub fn width(&self) -> f32 {
        self.right - self.left
    }

    pub fn height(&self) -> f32 {
        self.bottom - self.top
    }

    pub fn center(&self) -> Px {
        (0.5 * (self.left + self.right), 0.5 * (self.top + self.bottom))
    }

    pub fn contains(&self, (x, y): Px) -> bool {
        x >= self.left && x <= self.right && y >= self.top && y <= self.bottom
    }

    pub fn corners(&self) -> [Px; 4] {
        [(self.left, self.top), (self.right, self.top), (self.right, self.bottom), (self.left, self.bottom)]
    }
}

/// The rectangle with two opposite corners.
pub(in crate::report::plot) fn between(a: Px, b: Px) -> Rect {
    Rect { left: a.0.min(b.0), top: a.1.min(b.1), right: a.0.max(b.0), bottom: a.1.max(b.1) }
}

/// The drawn parts of a dashed path; the whole path when `dash` is empty.
pub(in crate::report::plot) fn cut_dashes(path: &[Px], dash: &[f32]) -> Vec<Vec<Px>> {
    if dash.is_empty() || dash.iter().any(|&d| d <= 0.0) {
        return vec![path.to_vec()];
    }
    let mut parts = Vec::new();
    let mut part = path.first().map_or(vec![], |&p| vec![p]);
    let (mut i, mut left) = (0, dash[0]);
    for pair in path.windows(2) {
        let (mut a, b) = (pair[0], pair[1]);
        loop {
            let length = (b.0 - a.0).hypot(b.1 - a.1);
            if length <= left || length.is_nan() {
                left -= length;
                if i % 2 == 0 {
                    part.push(b);
                }
                break;
            }
            let t = left / length;
            a = (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
            if i % 2 == 0 {
                part.push(a);
                parts.push(std::mem::take(&mut part));
            } else {
                part = vec![a];
            }
            i += 1;
            left = dash[i % dash.len()];
        }
    }
    if part.len() > 1 {
        parts.push(part);
    }
    parts
}

/// The parts of a path inside a rectangle (Liang and Barsky 1984, segment by segment).
pub(in crate::report::plot) fn clip_path(path: &[Px], clip: Rect) -> Vec<Vec<Px>> {
    let mut pieces: Vec<Vec<Px>> = Vec::new();
    let mut open = false;
    for pair in path.windows(2) {
        let Some((a, b, ends_inside)) = clip_segment(pair[0], pair[1], clip) else {
            open = false;
            continue;
        };
        match pieces.last_mut().filter(|_| open) {
            Some(piece) => piece.push(b),
            None => pieces.push(vec![a, b]),
        }
        open = ends_inside;
    }
    pieces
}

fn clip_segment(a: Px, b: Px, clip: Rect) -> Option<(Px, Px, bool)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut t0, mut t1) = (0.0f32, 1.0f32);
    for (p, q) in [(-dx, a.0 - clip.left), (dx, clip.right - a.0), (-dy, a.1 - clip.top), (dy, clip.bottom - a.1)] {
        if p == 0.0 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            t0 = t0.max(q / p);
        } else {
            t1 = t1.min(q / p);
        }
    }
    let at = |t: f32| (a.0 + t * dx, a.1 + t * dy);
    (t0 <= t1).then(|| (if t0 > 0.0 { at(t0) } else { a }, if t1 < 1.0 { at(t1) } else { b }, t1 >= 1.0))
}

/// The part of a polygon inside a rectangle (Sutherland and Hodgman 1974).
pub(in crate::report::plot) fn clip_polygon(polygon: &[Px], clip: Rect) -> Vec<Px> {
    type Side = (fn(Px, Rect) -> f32, fn(Px, Rect) -> Px);
    // Signed distance inside each side, and the projection onto it that undoes rounding.
    let sides: [Side; 4] = [
        (|p, c| p.0 - c.left, |p, c| (c.left, p.1)),
        (|p, c| c.right - p.0, |p, c| (c.right, p.1)),
        (|p, c| p.1 - c.top, |p, c| (p.0, c.top)),
        (|p, c| c.bottom - p.1, |p, c| (p.0, c.bottom)),
    ];
    let mut points = polygon.to_vec();
    for (inside, onto) in sides {
        let mut kept = Vec::with_capacity(points.len() + 4);
        for i in 0..points.len() {
            let (a, b) = (points[i], points[(i + 1) % points.len()]);
            let (da, db) = (inside(a, clip), inside(b, clip));
            if da >= 0.0 {
                kept.push(a);
            }
            if (da >= 0.0) != (db >= 0.0) {
                let t = da / (da - db);
                kept.push(onto((a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1)), clip));
            }
        }
        points = kept;
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: Rect = Rect { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };

    #[test]
    fn a_path_that_leaves_and_returns_is_cut_in_two() {
        let pieces = clip_path(&[(2.0, 5.0), (20.0, 5.0), (20.0, 8.0), (2.0, 8.0)], BOX);
        assert_eq!(pieces, vec![vec![(2.0, 5.0), (10.0, 5.0)], vec![(10.0, 8.0), (2.0, 8.0)]]);
    }

    #[test]
    fn dashes_keep_their_share_of_the_path() {
        let parts = cut_dashes(&[(0.0, 0.0), (30.0, 0.0), (30.0, 30.0)], &[6.0, 4.0]);
        let drawn: f32 =
            parts.iter().flat_map(|p| p.windows(2)).map(|s| (s[1].0 - s[0].0).hypot(s[1].1 - s[0].1)).sum();
        assert!((drawn - 36.0).abs() < 1e-3);
    }
}
