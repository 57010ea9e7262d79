//! JSON text to values, within a budget.

use std::cell::{Cell, RefCell};
use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};

use super::report::{At, Issue};

/// A document that was read.
#[derive(Debug)]
pub(crate) struct Text {
    /// The document.
    pub root: Value,
    /// Keys that are there twice.
    pub warnings: Vec<Issue>,
}

/// Doubled keys that are spoken of.
const WARNINGS: usize = 10;

/// What an object with properties costs: the map reserves room for eleven.
const OBJECT: usize = 8;

/// Reads JSON. Of a key that is there twice the last value counts.
///
/// # Errors
/// `INVALID_JSON` for what is no JSON, deeper than 127, or not UTF-8 without a byte order mark;
/// `LIMIT_JSON_VALUES` for more than `max_values` numbers, strings, keys, arrays and objects, of which
/// those with properties count as 8.
pub(crate) fn text(bytes: &[u8], max_values: usize) -> Result<Text, Issue> {
    let invalid = |message: String| Issue::error("INVALID_JSON", "", message);
    if bytes.starts_with(&[0xEF, 0xBB, 0xBF]) {
        return Err(invalid("the text begins with a byte order mark; store it without".into()));
    }
    let text = std::str::from_utf8(bytes)
        .map_err(|e| invalid(format!("the text is not UTF-8 at byte {}", e.valid_up_to())))?;
    let state = State { left: Cell::new(max_values), warnings: RefCell::default() };
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let seed = Seed { state: &state, at: &At::Root };
    let root = seed.deserialize(&mut deserializer).and_then(|root| deserializer.end().map(|()| root));
    match root {
        Ok(root) => Ok(Text { root, warnings: state.warnings.into_inner() }),
        Err(_) if state.left.get() == 0 => Err(Issue::error(
            "LIMIT_JSON_VALUES",
            "",
            format!(
                "more than the limit of {max_values} values; raise the limit if the file is to be trusted"
            ),
        )),
        Err(e) => Err(invalid(format!("the text is no JSON: {e}"))),
    }
}

struct State {
    left: Cell<usize>,
    warnings: RefCell<Vec<Issue>>,
}

#[derive(Clone, Copy)]
struct Seed<'s> {
    state: &'s State,
    at: &'s At<'s>,
}

impl Seed<'_> {
    fn count<E: serde::de::Error>(&self, values: usize) -> Result<(), E> {
        let left = self.state.left.get().checked_sub(values);
        self.state.left.set(left.unwrap_or(0));
        left.map(drop).ok_or_else(|| E::custom("too many values"))
    }
}

impl<'de> DeserializeSeed<'de> for Seed<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        self.count(1)?;
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Seed<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_bool<E>(self, b: bool) -> Result<Value, E> {
        Ok(Value::Bool(b))
    }

    fn visit_i64<E>(self, n: i64) -> Result<Value, E> {
        Ok(Value::Number(n.into()))
    }

    fn visit_u64<E>(self, n: u64) -> Result<Value, E> {
        Ok(Value::Number(n.into()))
    }

    fn visit_f64<E>(self, x: f64) -> Result<Value, E> {
        Ok(Number::from_f64(x).map_or(Value::Null, Value::Number))
    }

    fn visit_str<E>(self, s: &str) -> Result<Value, E> {
        Ok(Value::String(s.into()))
    }

    fn visit_string<E>(self, s: String) -> Result<Value, E> {
        Ok(Value::String(s))
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Value, A::Error> {
        let mut out = Vec::new();
        loop {
            let at = self.at.index(out.len());
            let Some(value) = seq.next_element_seed(Seed { state: self.state, at: &at })? else { break };
            out.push(value);
        }
        Ok(Value::Array(out))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Value, A::Error> {
        let mut out = Map::new();
        while let Some(key) = map.next_key::<String>()? {
            self.count(if out.is_empty() { OBJECT } else { 1 })?;
            let at = self.at.key(&key);
            let value = map.next_value_seed(Seed { state: self.state, at: &at })?;
            if out.contains_key(&key) && self.state.warnings.borrow().len() < WARNINGS {
                self.state.warnings.borrow_mut().push(Issue::warning(
                    "DUPLICATE_KEY",
                    at,
                    "the key is there twice; the last value counts".into(),
                ));
            }
            out.insert(key, value);
        }
        Ok(Value::Object(out))
    }
}
