//! Reading `serde_json` values whatever they are.

use serde_json::Value;

/// A whole number that is not negative, also when it is written as `1.0`.
pub(super) fn whole(value: &Value) -> Option<u64> {
    value.as_u64().or_else(|| {
        let x = value.as_f64()?;
        // Beyond 2^53 a number with a point is not a whole number that anyone meant.
        (x.fract() == 0.0 && (0.0..=9_007_199_254_740_992.0).contains(&x)).then_some(x as u64)
    })
}

/// Whether it is a whole number, of any sign.
pub(super) fn is_whole(value: &Value) -> bool {
    value.is_i64() || value.is_u64() || value.as_f64().is_some_and(|x| x.fract() == 0.0)
}

/// An index.
pub(super) fn index(value: &Value) -> Option<usize> {
    usize::try_from(whole(value)?).ok()
}

/// The whole number of a property.
pub(super) fn whole_of(object: &Value, key: &str) -> Option<u64> {
    whole(object.get(key)?)
}

/// The index of a property.
pub(super) fn index_of(object: &Value, key: &str) -> Option<usize> {
    index(object.get(key)?)
}

/// The number of a property.
pub(super) fn number_of(object: &Value, key: &str) -> Option<f64> {
    object.get(key)?.as_f64()
}

/// The string of a property.
pub(super) fn text_of<'v>(object: &'v Value, key: &str) -> Option<&'v str> {
    object.get(key)?.as_str()
}

/// The elements of a property; none if it is no array.
pub(super) fn list<'v>(object: &'v Value, key: &str) -> &'v [Value] {
    object.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// The members of a property; none if it is no object.
pub(super) fn members<'v>(object: &'v Value, key: &str) -> impl Iterator<Item = (&'v String, &'v Value)> {
    object.get(key).and_then(Value::as_object).into_iter().flatten()
}

/// An extension's object.
pub(super) fn extension<'v>(object: &'v Value, name: &str) -> Option<&'v Value> {
    object.get("extensions")?.get(name).filter(|e| e.is_object())
}

/// `N` numbers; none if there is anything else.
pub(super) fn numbers<const N: usize>(object: &Value, key: &str) -> Option<[f64; N]> {
    let list = object.get(key)?.as_array()?;
    let mut out = [0.0; N];
    if list.len() != N {
        return None;
    }
    for (out, value) in out.iter_mut().zip(list) {
        *out = value.as_f64()?;
    }
    Some(out)
}

/// A value for a message: short, whatever it is.
pub(super) fn shown(value: &Value) -> String {
    match value {
        Value::Null => "null".into(),
        Value::Bool(b) => b.to_string(),
        Value::Number(n) => n.to_string(),
        Value::String(s) => format!("'{}'", short(s)),
        Value::Array(a) => format!("an array of {}", a.len()),
        Value::Object(o) => format!("an object of {} properties", o.len()),
    }
}

/// The beginning of a text, for a message.
pub(super) fn short(text: &str) -> String {
    let mut out: String = text.chars().take(60).collect();
    if out.len() < text.len() {
        out.push('…');
    }
    out
}
