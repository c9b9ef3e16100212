//! Parameters and wishes from JSON text.
//!
//! What is missing keeps its default, what is unknown is refused, and what is wrong is named by the
//! way to it (`sweep.window_px`). A struct lists its fields ([`readable!`]), and
//! one function fills them. Derived with serde, every field of every struct has a reader of its
//! own: 90 kB of wasm for the parameters.

use std::fmt;

use serde::de::{DeserializeOwned, value};
use serde_json::Value;

/// What can be read in place.
pub(crate) trait Readable {
    /// Takes over what the value says.
    fn read_from(&mut self, value: &Value) -> Result<(), Problem>;
}

/// What is wrong with the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Problem {
    /// The line, from 1, where it is no JSON.
    pub line: Option<usize>,
    /// Keys that lead to what is wrong, outermost first, with points between them.
    at: String,
    what: String,
}

/// Declares structs of which every field can be read, and is not written down again.
macro_rules! readable {
    ($($(#[$meta:meta])* pub struct $name:ident { $($(#[$of_field:meta])* pub $field:ident: $type:ty,)* })*) => {$(
        $(#[$meta])*
        pub struct $name { $($(#[$of_field])* pub $field: $type,)* }

        impl $crate::plain_json::Readable for $name {
            fn read_from(&mut self, value: &serde_json::Value) -> std::result::Result<(), $crate::plain_json::Problem> {
                $crate::plain_json::read_fields(value, &mut [$((stringify!($field), &mut self.$field)),*])
            }
        }
    )*};
}
pub(crate) use readable;

/// Reads a value from text.
pub(crate) fn read<T: Readable + Default>(text: &str) -> Result<T, Problem> {
    let value: Value = serde_json::from_str(text).map_err(|e| Problem {
        line: Some(e.line().max(1)),
        at: String::new(),
        what: e.to_string(),
    })?;
    fresh(&value)
}

/// Reads the fields of an object.
pub(crate) fn read_fields(
    value: &Value,
    fields: &mut [(&str, &mut dyn Readable)],
) -> Result<(), Problem> {
    let Value::Object(object) = value else {
        return Err(expected("an object", value));
    };
    for (key, value) in object {
        let Some((_, field)) = fields.iter_mut().find(|(name, _)| name == key) else {
            let known: Vec<String> = fields.iter().map(|(name, _)| format!("`{name}`")).collect();
            let known = known.join(", ");
            return Err(problem(format!(
                "unknown field `{key}`, expected one of {known}"
            )));
        };
        field.read_from(value).map_err(|p| below(key, p))?;
    }
    Ok(())
}

/// Reads one of the names of an enum.
pub(crate) fn read_name<T: DeserializeOwned>(value: &Value) -> Result<T, Problem> {
    let Value::String(name) = value else {
        return Err(expected("a name", value));
    };
    T::deserialize(value::StrDeserializer::<value::Error>::new(name))
        .map_err(|e| problem(e.to_string()))
}

impl Readable for f64 {
    fn read_from(&mut self, value: &Value) -> Result<(), Problem> {
        *self = value.as_f64().ok_or_else(|| expected("a number", value))?;
        Ok(())
    }
}

impl Readable for bool {
    fn read_from(&mut self, value: &Value) -> Result<(), Problem> {
        *self = (value.as_bool()).ok_or_else(|| expected("true or false", value))?;
        Ok(())
    }
}

impl Readable for String {
    fn read_from(&mut self, value: &Value) -> Result<(), Problem> {
        let text = value.as_str().ok_or_else(|| expected("text", value))?;
        text.clone_into(self);
        Ok(())
    }
}

macro_rules! whole_numbers {
    ($($type:ty),*) => {$(
        impl Readable for $type {
            fn read_from(&mut self, value: &Value) -> Result<(), Problem> {
                let number = value.as_u64().and_then(|n| n.try_into().ok());
                *self = number.ok_or_else(|| expected("a whole number from 0 on", value))?;
                Ok(())
            }
        }
    )*};
}

whole_numbers!(u8, u32, usize);

impl<T: Readable + Default> Readable for Option<T> {
    fn read_from(&mut self, value: &Value) -> Result<(), Problem> {
        *self = if value.is_null() {
            None
        } else {
            Some(fresh(value)?)
        };
        Ok(())
    }
}

impl<T: Readable + Default> Readable for Vec<T> {
    fn read_from(&mut self, value: &Value) -> Result<(), Problem> {
        let items = value.as_array().ok_or_else(|| expected("a list", value))?;
        *self = items.iter().map(fresh).collect::<Result<_, _>>()?;
        Ok(())
    }
}

impl<T: Readable, const N: usize> Readable for [T; N] {
    fn read_from(&mut self, value: &Value) -> Result<(), Problem> {
        let items = value.as_array().filter(|items| items.len() == N);
        let items = items.ok_or_else(|| expected(&format!("a list of {N}"), value))?;
        (self.iter_mut().zip(items)).try_for_each(|(to, item)| to.read_from(item))
    }
}

fn fresh<T: Readable + Default>(value: &Value) -> Result<T, Problem> {
    let mut read = T::default();
    read.read_from(value)?;
    Ok(read)
}

fn problem(what: String) -> Problem {
    Problem {
        line: None,
        at: String::new(),
        what,
    }
}

fn expected(what: &str, found: &Value) -> Problem {
    const MOST_LETTERS: usize = 40;
    let found: String = found.to_string().chars().take(MOST_LETTERS).collect();
    problem(format!("expected {what}, not {found}"))
}

/// Below this key.
fn below(key: &str, mut problem: Problem) -> Problem {
    let between = if problem.at.is_empty() { "" } else { "." };
    problem.at = format!("{key}{between}{}", problem.at);
    problem
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let between = if self.at.is_empty() { "" } else { ": " };
        write!(f, "{}{between}{}", self.at, self.what)
    }
}

impl std::error::Error for Problem {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Acceptance;
    use crate::params::Params;
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
        assert_eq!(read(&text), Ok(params));
        let options = LoadOptions {
            roi: Some([1.0, 2.5, -3.0, 4e6]),
            views: Some(vec!["a.jpg".into()]),
            memory_mb: Some(7),
            ..LoadOptions::default()
        };
        let text = serde_json::to_string(&options).unwrap();
        assert_eq!(read(&text), Ok(options));
    }

    #[test]
    fn every_parameter_is_read() {
        let defaults = serde_json::to_value(Params::default()).unwrap();
        let changed = changed(&defaults);
        let read: Params = read(&changed.to_string()).unwrap();
        assert_eq!(serde_json::to_value(read).unwrap(), changed);
    }

    /// The same with another number, or the other truth, in every place.
    fn changed(value: &Value) -> Value {
        match value {
            Value::Object(fields) => fields
                .iter()
                .map(|(k, v)| (k.clone(), changed(v)))
                .collect(),
            Value::Array(items) => items.iter().map(changed).collect(),
            Value::Bool(b) => Value::Bool(!b),
            Value::Number(n) if n.is_u64() => (n.as_u64().unwrap() + 1).into(),
            Value::Number(n) => (n.as_f64().unwrap() + 0.5).into(),
            other => other.clone(),
        }
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
        assert_eq!(
            text,
            "sweep.window_px: expected a whole number from 0 on, not \"wide\""
        );
        let text = problem(r#"{"sweep": {"min_simularity": 0.5}}"#);
        assert!(
            text.starts_with("sweep: unknown field `min_simularity`"),
            "{text}"
        );
        assert!(text.contains("`min_similarity`"), "{text}");
        assert!(problem(r#"{"sweep": {"window_px": -1}}"#).starts_with("sweep.window_px: "));
        assert!(problem(r#"{"sweep": {"acceptance": "never"}}"#).contains("posterior"));
        assert_eq!(problem("null"), "expected an object, not null");
        let region = read::<LoadOptions>(r#"{"roi": [1, 2, 3, 4, 5]}"#).unwrap_err();
        assert_eq!(
            region.to_string(),
            "roi: expected a list of 4, not [1,2,3,4,5]"
        );
        let broken = read::<Params>("{\n\"sweep\": }").unwrap_err();
        assert_eq!(broken.line, Some(2));
    }
}
