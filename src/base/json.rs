//! Parameters and options from JSON text, by their serde derives.
//!
//! What is missing keeps its default, what is unknown is refused (`deny_unknown_fields`), and what
//! is wrong is named by the keys that lead to it (`sweep.window_px`).

use serde::de::DeserializeOwned;

/// What is wrong with a JSON text.
#[derive(Debug, thiserror::Error)]
pub(crate) enum JsonError {
    /// The text is no JSON.
    #[error(transparent)]
    Syntax(serde_json::Error),
    /// A value is not what is expected in its place; the keys that lead to it come first.
    #[error(transparent)]
    Value(serde_path_to_error::Error<serde_json::Error>),
}

impl JsonError {
    /// The line where the text is no JSON, from 1.
    pub(crate) fn line(&self) -> Option<usize> {
        match self {
            Self::Syntax(error) => Some(error.line().max(1)),
            Self::Value(_) => None,
        }
    }
}

/// Reads a value from text.
pub(crate) fn read<T: DeserializeOwned>(text: &str) -> Result<T, JsonError> {
    // By way of a value, so that a problem is told by its keys and not by a column.
    let value: serde_json::Value = serde_json::from_str(text).map_err(JsonError::Syntax)?;
    serde_path_to_error::deserialize(value).map_err(JsonError::Value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::params::Acceptance;
    use crate::base::params::Params;
    use crate::orienting::scene_loader::LoadOptions;
    use serde_json::Value;

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
        assert_eq!(read::<Params>(&text).unwrap(), params);
        let options = LoadOptions {
            roi: Some([1.0, 2.5, -3.0, 4e6]),
            views: Some(vec!["a.jpg".into()]),
            memory_mb: Some(7),
            ..LoadOptions::default()
        };
        let text = serde_json::to_string(&options).unwrap();
        assert_eq!(read::<LoadOptions>(&text).unwrap(), options);
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
    fn problems_are_named_by_the_keys_that_lead_to_them() {
        let text = problem(r#"{"sweep": {"window_px": "wide"}}"#);
        assert!(text.starts_with("sweep.window_px: "), "{text}");
        assert!(text.contains("\"wide\""), "{text}");
        let text = problem(r#"{"sweep": {"min_simularity": 0.5}}"#);
        assert!(
            text.starts_with("sweep.min_simularity: unknown field"),
            "{text}"
        );
        assert!(text.contains("`min_similarity`"), "{text}");
        assert!(problem(r#"{"sweep": {"window_px": -1}}"#).starts_with("sweep.window_px: "));
        assert!(problem(r#"{"sweep": {"acceptance": "never"}}"#).contains("posterior"));
        assert!(problem("null").contains("null"));
        let region = read::<LoadOptions>(r#"{"roi": [1, 2, 3, 4, 5]}"#).unwrap_err();
        assert!(region.to_string().starts_with("roi: "), "{region}");
        let broken = read::<Params>("{\n\"sweep\": }").unwrap_err();
        assert_eq!(broken.line(), Some(2));
    }
}
