//! Orientations in XML: elements with their place in the file, for messages.

pub(crate) mod blocks;
pub(crate) mod metashape;

use nalgebra::Matrix3;
use roxmltree::{Document, Node};

use super::text::quoted_long;
use crate::base::error::{Error, Result};
use crate::photographs::camera::Distortion;

/// Interior orientation of the images of one sensor.
struct Sensor {
    k: Matrix3<f64>,
    distortion: Option<Distortion>,
    size: (u32, u32),
}

/// Reads elements of one file; refusals name it and the line.
pub(crate) struct XmlReader<'a> {
    pub path: &'a str,
}

impl XmlReader<'_> {
    pub(crate) fn number(&self, parent: Node, name: &str) -> Result<f64> {
        Ok(self.numbers::<1>(self.child(parent, name)?)?[0])
    }

    /// An element that must not be missing.
    pub(crate) fn child<'a, 'b>(&self, parent: Node<'a, 'b>, name: &str) -> Result<Node<'a, 'b>> {
        child(parent, name).ok_or_else(|| self.error(parent, &format!("<{name}> is missing")))
    }

    pub(crate) fn numbers<const N: usize>(&self, node: Node) -> Result<[f64; N]> {
        let text = node.text().unwrap_or_default();
        let numbers: Vec<f64> = text
            .split_whitespace()
            .filter_map(|f| f.parse().ok())
            .filter(|v: &f64| v.is_finite())
            .collect();
        let wrong = |_| self.error(node, &format!("it does not hold {N} finite numbers"));
        numbers.try_into().map_err(wrong)
    }

    fn place(&self, node: Node) -> String {
        format!("{}, line {}", self.path, line_of(node))
    }

    pub(crate) fn error(&self, node: Node, problem: &str) -> Error {
        self.refusal(node, problem, "what the description of the format has here")
    }

    /// An error that says what should stand there.
    pub(crate) fn refusal(&self, node: Node, problem: &str, expected: &str) -> Error {
        let problem = format!("<{}>: {}", node.tag_name().name(), quoted_long(problem));
        Error::line(self.path, line_of(node), problem, expected)
    }

    /// The number of an element that may be missing.
    fn number_or(&self, parent: Node, name: &str, default: f64) -> Result<f64> {
        match child(parent, name) {
            Some(_) => self.number(parent, name),
            None => Ok(default),
        }
    }
}

fn line_of(node: Node) -> usize {
    node.document().text_pos_at(node.range().start).row as usize
}

pub(crate) fn child<'a, 'b>(node: Node<'a, 'b>, name: &str) -> Option<Node<'a, 'b>> {
    node.children().find(|n| n.has_tag_name(name))
}

pub(crate) fn text_of<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    child(node, name).and_then(|n| n.text()).map(str::trim)
}

pub(crate) fn parse<'a>(path: &str, text: &'a str) -> Result<Document<'a>> {
    let expected = "well-formed XML to the end of the file";
    Document::parse(text).map_err(|e| {
        let line = e.pos().row as usize;
        Error::line(path, line, quoted_long(&e.to_string()), expected)
    })
}
