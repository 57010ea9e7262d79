//! Numbers that are none, bounds that are wrong, sparse elements out of order.

use serde_json::Value;

use super::super::model::{Accessor, Component};
use super::super::report::{At, Report};
use super::super::values::list;
use super::elements::Elements;

#[derive(Clone, Copy)]
struct Side {
    declared: Option<f64>,
    actual: f64,
    /// Elements beyond what is declared.
    beyond: u64,
}

/// Checks all accessors.
pub(super) fn check(elements: &Elements<'_>, report: &mut Report) {
    let array = At::Root.key("accessors");
    let values = elements.model.list("accessors");
    for (i, (accessor, value)) in elements.model.accessors.iter().zip(values).enumerate() {
        check_one(elements, i, accessor, value, &array.index(i), report);
        check_order(elements, accessor, &array.index(i), report);
    }
}

fn check_one(
    elements: &Elements<'_>,
    index: usize,
    accessor: &Accessor,
    value: &Value,
    at: &At<'_>,
    report: &mut Report,
) {
    let float = accessor.format.is_some_and(|f| f.component == Component::F32);
    let declared = |name: &str, start: f64| -> Vec<Side> {
        let side = |v: &Value| {
            // Bounds of floats are compared as floats: the text may have more digits.
            let x = v.as_f64().map(|x| if float { f64::from(x as f32) } else { x });
            Side { declared: x, actual: start, beyond: 0 }
        };
        list(value, name).iter().take(16).map(side).collect()
    };
    let mut least = declared("min", f64::INFINITY);
    let mut most = declared("max", f64::NEG_INFINITY);
    let mut bad: Option<(u64, f64, u64)> = None;
    let mut read = 0u64;
    elements.each(index, &mut |n, element| {
        read = read.saturating_add(1);
        for x in element.iter().filter(|x| !x.is_finite()) {
            let (.., count) = bad.get_or_insert((n, *x, 0));
            *count = count.saturating_add(1);
        }
        for (side, x) in least.iter_mut().zip(element) {
            side.actual = side.actual.min(*x);
            side.beyond = side.beyond.saturating_add(u64::from(side.declared.is_some_and(|d| *x < d)));
        }
        for (side, x) in most.iter_mut().zip(element) {
            side.actual = side.actual.max(*x);
            side.beyond = side.beyond.saturating_add(u64::from(side.declared.is_some_and(|d| *x > d)));
        }
    });
    if let Some((n, x, count)) = bad {
        report.error("ACCESSOR_INVALID_FLOAT", at, || {
            format!(
                "element {n} has the component {x}, and there are {count} such in all; numbers must be finite"
            )
        });
    }
    if read == 0 {
        return;
    }
    for (name, sides, mismatch, beyond) in [
        ("min", least, "ACCESSOR_MIN_MISMATCH", "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND"),
        ("max", most, "ACCESSOR_MAX_MISMATCH", "ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND"),
    ] {
        let here = at.key(name);
        for (k, side) in sides.iter().enumerate() {
            let Some(declared) = side.declared.filter(|d| *d != side.actual && side.actual.is_finite())
            else {
                continue;
            };
            report.error(mismatch, &here.index(k), || {
                format!("it says {declared} but the elements' is {}", side.actual)
            });
            if side.beyond > 0 {
                report.error(beyond, &here.index(k), || {
                    format!("{} elements are beyond the declared {declared}", side.beyond)
                });
            }
        }
    }
}

fn check_order(elements: &Elements<'_>, accessor: &Accessor, at: &At<'_>, report: &mut Report) {
    let Some((sparse, format)) = accessor.sparse.zip(accessor.format) else { return };
    let (mut last, mut back, mut outside) = (None, None, None);
    elements.each_replaced(&sparse, &format, &mut |n| {
        if last.is_some_and(|last| n <= last) {
            back.get_or_insert((n, last.unwrap_or(0)));
        }
        if n >= accessor.count {
            outside.get_or_insert(n);
        }
        last = Some(n);
    });
    let at = at.key("sparse");
    let at = at.key("indices");
    if let Some((n, last)) = back {
        report.error("ACCESSOR_SPARSE_INDICES_NON_INCREASING", &at, || {
            format!("element {n} comes after {last}; the numbers must rise")
        });
    }
    if let Some(n) = outside {
        report.error("ACCESSOR_SPARSE_INDEX_OOB", &at, || {
            format!("it replaces element {n} of {}", accessor.count)
        });
    }
}
