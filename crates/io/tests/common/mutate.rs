//! Damage to JSON documents that keeps them JSON: wrong numbers, indices, names and lengths, things left out, doubled
//! and put in each other's places. Bytes decide what is done, so that property tests and fuzzers can share it.

use serde_json::{Value, json};

/// Decisions from bytes.
pub(crate) struct Dice<'a>(&'a [u8]);

impl<'a> Dice<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    pub(crate) fn byte(&mut self) -> Option<usize> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(usize::from(*first))
    }

    /// A number below `n`, which is not 0.
    pub(crate) fn below(&mut self, n: usize) -> Option<usize> {
        let mut x = self.byte()?;
        if n > 256 {
            x = x << 8 | self.byte()?;
        }
        Some(x % n)
    }
}

const NUMBERS: [f64; 14] = [
    -1.0,
    0.5,
    1e-40,
    1e30,
    1e300,
    1.5,
    254.0,
    255.0,
    256.0,
    65535.0,
    65536.0,
    4294967295.0,
    -2147483649.0,
    9.1e18,
];

const TEXTS: [&str; 20] = [
    "",
    "SCALAR",
    "VEC2",
    "VEC3",
    "VEC4",
    "MAT3",
    "MAT4",
    "perspective",
    "spot",
    "MASK",
    "CUBICSPLINE",
    "weights",
    "../a.bin",
    "/dev/zero",
    "data:",
    "data:application/octet-stream;base64,AAAA",
    "data:image/png;base64,iVBORw0KGgo=",
    "KHR_texture_transform",
    "1.0",
    "image/webp",
];

const KEYS: [&str; 16] = [
    "extensions",
    "children",
    "mesh",
    "skin",
    "matrix",
    "rotation",
    "sparse",
    "bufferView",
    "byteOffset",
    "byteStride",
    "count",
    "min",
    "normalized",
    "NORMAL",
    "TEXCOORD_1",
    "JOINTS_0",
];

/// Damages a document, once for every few bytes.
pub(crate) fn mutate(root: &mut Value, dice: &mut Dice<'_>) {
    while once(root, dice).is_some() {}
}

fn once(root: &mut Value, dice: &mut Dice<'_>) -> Option<()> {
    let count = size(root);
    let other = dice.below(count)?;
    let copy = nth(root, &mut { other })?.clone();
    let place = dice.below(count)?;
    let value = nth(root, &mut { place })?;
    match dice.below(12)? {
        0 => *value = json!(NUMBERS[dice.below(NUMBERS.len())?]),
        1 => *value = json!([u64::MAX, 1 << 63, 1 << 53, (1 << 32) - 1, 1 << 31, 7, 12, 36][dice.below(8)?]),
        // Indices are small.
        2 => *value = json!(dice.below(9)?),
        3 => *value = json!(value.as_i64().unwrap_or(0).wrapping_add([-4, -1, 1, 4][dice.below(4)?])),
        4 => *value = json!(TEXTS[dice.below(TEXTS.len())?]),
        5 => {
            *value = [json!(null), json!(true), json!([]), json!({}), json!([0]), json!([1, 1, 1])]
                [dice.below(6)?]
            .clone()
        }
        // A copy of the whole would double it each time.
        6 if size(&copy) < 64 => *value = copy,
        7 => match value {
            Value::Array(a) if !a.is_empty() => drop(a.remove(dice.below(a.len())?)),
            Value::Object(o) if !o.is_empty() => {
                let key = o.keys().nth(dice.below(o.len())?)?.clone();
                o.remove(&key);
            }
            _ => *value = Value::Null,
        },
        8 => match value {
            Value::Array(a) if size(&copy) < 64 => a.insert(dice.below(a.len() + 1)?, copy),
            Value::Object(o) if size(&copy) < 64 => {
                drop(o.insert(KEYS[dice.below(KEYS.len())?].into(), copy))
            }
            _ => {}
        },
        9 => match value {
            Value::Array(a) if !a.is_empty() && a.len() < 64 => {
                let again = a[dice.below(a.len())?].clone();
                a.push(again);
            }
            _ => {}
        },
        10 => match value {
            Value::Array(a) if !a.is_empty() => {
                let (i, k) = (dice.below(a.len())?, dice.below(a.len())?);
                a.swap(i, k);
            }
            _ => {}
        },
        _ => match value {
            Value::Array(a) => a.truncate(dice.below(a.len() + 1)?),
            _ => *value = json!(dice.below(4)?),
        },
    }
    Some(())
}

/// Values in a value, itself included.
fn size(value: &Value) -> usize {
    1 + match value {
        Value::Array(a) => a.iter().map(size).sum(),
        Value::Object(o) => o.values().map(size).sum(),
        _ => 0,
    }
}

/// The `n`th of them.
fn nth<'v>(value: &'v mut Value, n: &mut usize) -> Option<&'v mut Value> {
    if *n == 0 {
        return Some(value);
    }
    *n -= 1;
    match value {
        Value::Array(a) => a.iter_mut().find_map(|v| nth(v, n)),
        Value::Object(o) => o.values_mut().find_map(|v| nth(v, n)),
        _ => None,
    }
}
