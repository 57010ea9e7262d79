//! What is in the accessors.

mod bounds;
mod elements;
mod primitives;
mod skinning;

use std::collections::HashSet;

use serde_json::Value;

use self::elements::Elements;
use super::model::Model;
use super::nodes::QUATERNION_TOLERANCE;
use super::report::{At, Report};
use super::values::{index_of, list, text_of};

/// The bytes of a document's buffers.
pub(crate) trait Bytes {
    /// Those of a buffer view; none if they are missing or do not reach so far.
    fn view(&self, index: usize) -> Option<&[u8]>;

    /// How many there are in all buffers together: the work of the check stays in proportion to them.
    fn total(&self) -> u64;
}

/// Checks the contents of the accessors. Those whose bytes are missing are passed over.
pub(crate) fn data(root: &Value, bytes: &dyn Bytes) -> Vec<super::Issue> {
    let mut report = Report::default();
    let model = Model::new(root);
    let elements = Elements::new(&model, bytes);
    bounds::check(&elements, &mut report);
    primitives::check(&elements, &mut report);
    check_matrices(&elements, &mut report);
    check_animations(&elements, &mut report);
    if elements.stopped() {
        report.warning("DATA_NOT_CHECKED", &At::Root, || {
            "accessors overlap so much that not all of them were checked; store each thing once".into()
        });
    }
    report.finish()
}

/// The last row of each inverse bind matrix.
fn check_matrices(elements: &Elements<'_>, report: &mut Report) {
    let mut seen = HashSet::new();
    let array = At::Root.key("skins");
    for (i, skin) in elements.model.list("skins").iter().enumerate() {
        let Some(accessor) = index_of(skin, "inverseBindMatrices").filter(|a| seen.insert(*a)) else {
            continue;
        };
        let mut bad = None;
        elements.each(accessor, &mut |n, m| {
            let row = m.iter().skip(3).step_by(4).zip([0.0, 0.0, 0.0, 1.0]);
            if m.len() == 16 && row.into_iter().any(|(a, b)| *a != b) {
                bad.get_or_insert(n);
            }
        });
        if let Some(n) = bad {
            let here = array.index(i);
            report.error("ACCESSOR_INVALID_IBM", &here.key("inverseBindMatrices"), || {
                format!("the last row of matrix {n} is not 0 0 0 1")
            });
        }
    }
}

fn check_animations(elements: &Elements<'_>, report: &mut Report) {
    let mut seen = HashSet::new();
    let array = At::Root.key("animations");
    for (i, animation) in elements.model.list("animations").iter().enumerate() {
        let here = array.index(i);
        let samplers = list(animation, "samplers");
        let within = here.key("samplers");
        for (k, sampler) in samplers.iter().enumerate() {
            let Some(input) = index_of(sampler, "input").filter(|a| seen.insert((*a, false))) else {
                continue;
            };
            let here = within.index(k);
            check_times(elements, input, &here.key("input"), report);
        }
        let within = here.key("channels");
        for (k, channel) in list(animation, "channels").iter().enumerate() {
            let path = channel.get("target").and_then(|t| text_of(t, "path"));
            let sampler = index_of(channel, "sampler").and_then(|s| samplers.get(s));
            let Some(sampler) = sampler.filter(|_| path == Some("rotation")) else { continue };
            let Some(output) = index_of(sampler, "output").filter(|a| seen.insert((*a, true))) else {
                continue;
            };
            let spline = text_of(sampler, "interpolation") == Some("CUBICSPLINE");
            let here = within.index(k);
            check_quaternions(elements, output, spline, &here.key("sampler"), report);
        }
    }
}

fn check_times(elements: &Elements<'_>, accessor: usize, at: &At<'_>, report: &mut Report) {
    let (mut negative, mut back, mut last) = (None, None, f64::NEG_INFINITY);
    elements.each(accessor, &mut |n, time| {
        let time = time.first().copied().unwrap_or(0.0);
        if time < 0.0 {
            negative.get_or_insert((n, time));
        }
        if time <= last {
            back.get_or_insert((n, time, last));
        }
        last = time;
    });
    if let Some((n, time)) = negative {
        report.error("ACCESSOR_ANIMATION_INPUT_NEGATIVE", at, || format!("time {n} is {time}, before 0"));
    }
    if let Some((n, time, last)) = back {
        report.error("ACCESSOR_ANIMATION_INPUT_NON_INCREASING", at, || {
            format!("time {n} is {time}, not after the one before it, {last}")
        });
    }
}

fn check_quaternions(
    elements: &Elements<'_>,
    accessor: usize,
    spline: bool,
    at: &At<'_>,
    report: &mut Report,
) {
    let mut bad = None;
    elements.each_normalized(accessor, &mut |n, q| {
        // Of a spline's three only the middle one is a rotation; the others are slopes.
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        if (!spline || n % 3 == 1) && (length - 1.0).abs() > QUATERNION_TOLERANCE {
            bad.get_or_insert((n, length));
        }
    });
    if let Some((n, length)) = bad {
        report.error("ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION", at, || {
            format!("the length of quaternion {n} is {length}; it must be 1")
        });
    }
}
