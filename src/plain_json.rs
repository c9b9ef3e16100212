//! Parameters and wishes from JSON text.
//!
//! The text is read into a [`Value`] first, and types are filled from that. Filled from the text directly, every field of every
//! struct would get a reader of text of its own, and every struct a second one for arrays: 60 kB of wasm more.
//! What is wrong is named by the way to it (`sweep.window_px`).

use std::fmt;

use serde::de::value::{SeqDeserializer, StrDeserializer};
use serde::de::{DeserializeOwned, DeserializeSeed, Error, MapAccess, Unexpected, Visitor};
use serde::{Deserializer, de, forward_to_deserialize_any};
use serde_json::{Map, Value};

/// What is wrong with the text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Problem {
    /// The line, from 1, where it is no JSON.
    pub line: Option<usize>,
    /// Keys that lead to what is wrong, outermost first, with points between them.
    at: String,
    what: String,
}

/// Reads a value; missing fields, unknown ones and defaults are its own affair.
pub fn read<T: DeserializeOwned>(text: &str) -> Result<T, Problem> {
    let value: Value = serde_json::from_str(text).map_err(|e| Problem {
        line: Some(e.line().max(1)),
        what: e.to_string(),
        ..Problem::default()
    })?;
    T::deserialize(Plain(&value))
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let between = if self.at.is_empty() { "" } else { ": " };
        write!(f, "{}{between}{}", self.at, self.what)
    }
}

impl std::error::Error for Problem {}

impl Error for Problem {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self {
            what: message.to_string(),
            ..Self::default()
        }
    }
}

/// Below this key.
#[inline(never)]
fn below(key: &str, mut problem: Problem) -> Problem {
    let between = if problem.at.is_empty() { "" } else { "." };
    problem.at = format!("{key}{between}{}", problem.at);
    problem
}

/// A value to be read.
#[derive(Clone, Copy)]
struct Plain<'de>(&'de Value);

impl Plain<'_> {
    #[inline(never)]
    fn unexpected(self, expected: &dyn de::Expected) -> Problem {
        let found = match self.0 {
            Value::Null => Unexpected::Other("null"),
            Value::Bool(b) => Unexpected::Bool(*b),
            Value::Number(n) => Unexpected::Float(n.as_f64().unwrap_or(f64::NAN)),
            Value::String(s) => Unexpected::Str(s),
            Value::Array(_) => Unexpected::Seq,
            Value::Object(_) => Unexpected::Map,
        };
        Problem::invalid_type(found, expected)
    }
}

impl<'de> Deserializer<'de> for Plain<'de> {
    type Error = Problem;

    #[inline(never)]
    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Problem> {
        match self.0 {
            Value::Bool(b) => visitor.visit_bool(*b),
            Value::Number(n) => match (n.as_u64(), n.as_i64(), n.as_f64()) {
                (Some(n), _, _) => visitor.visit_u64(n),
                (_, Some(n), _) => visitor.visit_i64(n),
                (_, _, n) => visitor.visit_f64(n.unwrap_or(f64::NAN)),
            },
            Value::String(s) => visitor.visit_str(s),
            Value::Null | Value::Array(_) | Value::Object(_) => Err(self.unexpected(&visitor)),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Problem> {
        match self.0 {
            Value::Null => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Problem> {
        match self.0 {
            Value::Array(items) => visitor.visit_seq(SeqDeserializer::new(items.iter().map(Plain))),
            _ => Err(self.unexpected(&visitor)),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(
        self,
        len: usize,
        visitor: V,
    ) -> Result<V::Value, Problem> {
        match self.0 {
            Value::Array(items) if items.len() > len => {
                Err(Problem::invalid_length(items.len(), &visitor))
            }
            _ => self.deserialize_seq(visitor),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Problem> {
        match self.0 {
            Value::Object(fields) => visitor.visit_map(Fields::of(fields)),
            _ => Err(self.unexpected(&visitor)),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Problem> {
        match self.0 {
            Value::String(name) => visitor.visit_enum(StrDeserializer::new(name)),
            _ => Err(self.unexpected(&visitor)),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct newtype_struct
        tuple_struct map identifier ignored_any
    }
}

impl<'de> de::IntoDeserializer<'de, Problem> for Plain<'de> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

/// The fields of an object, one after the other.
struct Fields<'de> {
    rest: serde_json::map::Iter<'de>,
    key: &'de str,
    value: &'de Value,
}

impl<'de> Fields<'de> {
    fn of(fields: &'de Map<String, Value>) -> Self {
        Self {
            rest: fields.iter(),
            key: "",
            value: &Value::Null,
        }
    }
}

impl<'de> MapAccess<'de> for Fields<'de> {
    type Error = Problem;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Problem> {
        let Some((key, value)) = self.rest.next() else {
            return Ok(None);
        };
        (self.key, self.value) = (key, value);
        seed.deserialize(StrDeserializer::new(key)).map(Some)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Problem> {
        seed.deserialize(Plain(self.value))
            .map_err(|problem| below(self.key, problem))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::{Acceptance, Params};
    use crate::scene_loader::LoadOptions;

    fn problem(text: &str) -> String {
        read::<Params>(text).unwrap_err().to_string()
    }

    #[test]
    fn what_was_written_is_read_again() {
        let mut params = Params::default();
        params.sweep.min_similarity = 0.125;
        params.sweep.window_px = 11;
        params.sweep.acceptance = Acceptance::Posterior;
        let text = serde_json::to_string(&params).unwrap();
        assert_eq!(read::<Params>(&text), Ok(params.clone()));
        assert_eq!(serde_json::from_str::<Params>(&text).unwrap(), params);
        let options = LoadOptions {
            roi: Some([1.0, 2.5, -3.0, 4e6]),
            views: Some(vec!["a.jpg".into()]),
            memory_mb: Some(7),
            ..LoadOptions::default()
        };
        let text = serde_json::to_string(&options).unwrap();
        assert_eq!(read::<LoadOptions>(&text), Ok(options));
    }

    #[test]
    fn what_is_missing_takes_its_default() {
        let params = read::<Params>(r#"{"sweep": {"depth_px": 12}}"#).unwrap();
        let mut expected = Params::default();
        expected.sweep.depth_px = 12.0;
        assert_eq!(params, expected);
    }

    #[test]
    fn problems_are_named_by_the_way_to_them() {
        let text = problem(r#"{"sweep": {"window_px": "wide"}}"#);
        assert!(
            text.starts_with("sweep.window_px: invalid type: string \"wide\""),
            "{text}"
        );
        let text = problem(r#"{"sweep": {"min_simularity": 0.5}}"#);
        assert!(
            text.contains("min_simularity") && text.contains("min_similarity"),
            "{text}"
        );
        assert!(problem(r#"{"sweep": {"window_px": -1}}"#).starts_with("sweep.window_px: "));
        assert!(problem(r#"{"sweep": {"acceptance": "never"}}"#).contains("posterior"));
        assert!(problem("null").contains("null"));
        assert!(problem("[]").contains("sequence"));
        let region = read::<LoadOptions>(r#"{"roi": [1, 2, 3, 4, 5]}"#).unwrap_err();
        assert!(
            region.to_string().starts_with("roi: invalid length 5"),
            "{region}"
        );
        let broken = read::<Params>("{\n\"sweep\": }").unwrap_err();
        assert_eq!(broken.line, Some(2));
    }
}
