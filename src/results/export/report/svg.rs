//! Lines, areas and words of a picture, in millimetres on paper.

use std::fmt::Write;

use crate::base::geometry::Polygon;
use nalgebra::{Point2, Vector2};

/// A picture in the making: x right, y down, millimetres.
pub(super) struct Drawing {
    text: String,
}

impl Drawing {
    /// A picture of this size; `title` is what is read out instead of it.
    pub(super) fn new(size: Vector2<f64>, title: &str) -> Self {
        let (w, h) = (mm(size.x), mm(size.y));
        let mut drawing = Self {
            text: String::new(),
        };
        drawing.push(format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{w}mm\" height=\"{h}mm\" \
             viewBox=\"0 0 {w} {h}\"><title>{}</title>",
            escaped(title)
        ));
        drawing
    }

    /// An area with holes; `attributes` say how it looks.
    pub(super) fn area(&mut self, polygon: &Polygon, attributes: &str) {
        let mut path = String::new();
        for ring in &polygon.rings {
            for (i, p) in ring.iter().enumerate() {
                let command = if i == 0 { 'M' } else { 'L' };
                write!(path, "{command}{} {}", mm(p.x), mm(p.y)).expect(WRITES);
            }
            path.push('Z');
        }
        self.push(format_args!("<path {attributes} d=\"{path}\"/>"));
    }

    /// A line of a class.
    pub(super) fn line(&mut self, a: Point2<f64>, b: Point2<f64>, class: &str) {
        let [x1, y1, x2, y2] = [a.x, a.y, b.x, b.y].map(mm);
        self.push(format_args!(
            "<line class=\"{class}\" x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"/>"
        ));
    }

    /// Words with their middle at a place, turned clockwise.
    pub(super) fn words(&mut self, at: Point2<f64>, turn_deg: f64, class: &str, words: &str) {
        let (x, y, turn) = (mm(at.x), mm(at.y), mm(turn_deg));
        let words = escaped(words);
        self.push(format_args!(
            "<text class=\"{class}\" transform=\"translate({x} {y}) rotate({turn})\">{words}</text>"
        ));
    }

    pub(super) fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }

    fn push(&mut self, content: std::fmt::Arguments) {
        self.text.write_fmt(content).expect(WRITES);
    }
}

const WRITES: &str = "a String takes all that is written";

/// To 0.01 mm.
fn mm(value: f64) -> f64 {
    super::super::format::rounded(value, 2)
}

/// Text inside HTML or SVG.
pub(super) fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            c => escaped.push(c),
        }
    }
    escaped
}

/// A place well inside a polygon, for a word: of a grid the point farthest from all sides.
pub(super) fn place_inside(polygon: &Polygon) -> Point2<f64> {
    // Points of the grid a side. Assumption: a word needs no better place than a fourteenth of the
    // shape.
    const GRID_STEPS: usize = 14;
    let [low, high] = polygon.bounds();
    let at = |i: usize| (i as f64 + 0.5) / GRID_STEPS as f64;
    let grid = (0..GRID_STEPS * GRID_STEPS).map(|i| {
        let share = Vector2::new(at(i % GRID_STEPS), at(i / GRID_STEPS));
        low + (high - low).component_mul(&share)
    });
    let deepest = grid.max_by(|p, q| polygon.depth(p).total_cmp(&polygon.depth(q)));
    deepest.expect("a grid has points")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_cannot_end_an_element() {
        assert_eq!(escaped("<a & \"b\">"), "&lt;a &amp; &quot;b&quot;&gt;");
    }

    #[test]
    fn a_word_stands_inside_an_l() {
        let ring = [
            (0.0, 0.0),
            (9.0, 0.0),
            (9.0, 2.0),
            (3.0, 2.0),
            (3.0, 9.0),
            (0.0, 9.0),
        ];
        let p = place_inside(&ring.map(|(x, y)| Point2::new(x, y)).to_vec().into());
        assert!(p.x < 3.0 && p.y < 3.0, "{p}");
    }
}
