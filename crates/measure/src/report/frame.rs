//! The rectangle of a plot, its grid and its axes.

use super::markup::{Html, shortened};
use super::plot::Plot;
use super::scale::Scale;

const WIDTH: f64 = 480.0;
const HEIGHT: f64 = 340.0;
const TOP: f64 = 30.0;
const RIGHT: f64 = 24.0;
const BOTTOM: f64 = 56.0;
/// Widest digit in the larger letters of narrow screens.
const DIGIT: f64 = 8.4;
/// What fits along an axis in those letters.
const AXIS_LABEL: usize = 48;

/// The axes and the rectangle between them.
pub(super) struct Frame {
    pub(super) x: Scale,
    pub(super) y: Scale,
    left: f64,
}

impl Frame {
    /// Leaves the labels of the y axis their room.
    pub(super) fn new(x: Scale, y: Scale) -> Self {
        let widest =
            y.ticks().iter().filter_map(|t| t.label.as_ref()).map(|l| l.chars().count()).max().unwrap_or(0);
        Self { x, y, left: (16.0 + DIGIT * widest as f64).min(WIDTH / 3.0) }
    }

    /// Begins the picture, with grid and axes; the curves go on top.
    pub(super) fn open(&self, h: &mut Html, plot: &Plot) {
        h.raw(&format!(
            "<svg class=\"chart\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" "
        ));
        h.raw("role=\"img\" aria-label=\"").text(&plot.title).raw("\">\n");
        grid(h, self);
        axis_labels(h, plot, self);
    }

    /// Pixels from the left for 0…1 along the x axis.
    pub(super) fn right(&self, unit: f64) -> f64 {
        self.left + unit * (WIDTH - RIGHT - self.left)
    }

    /// Pixels from the top for 0…1 along the y axis.
    pub(super) fn down(unit: f64) -> f64 {
        TOP + (1.0 - unit) * (HEIGHT - BOTTOM - TOP)
    }
}

fn grid(h: &mut Html, f: &Frame) {
    let (left, right) = (pixel(f.left), pixel(WIDTH - RIGHT));
    let (top, bottom) = (pixel(TOP), pixel(HEIGHT - BOTTOM));
    let (mut minor, mut major) = (String::new(), String::new());
    for t in f.x.ticks() {
        let path = if t.label.is_some() { &mut major } else { &mut minor };
        path.push_str(&format!("M{} {top}V{bottom}", pixel(f.right(t.at))));
    }
    for t in f.y.ticks() {
        let path = if t.label.is_some() { &mut major } else { &mut minor };
        path.push_str(&format!("M{left} {}H{right}", pixel(Frame::down(t.at))));
    }
    for (class, path) in [("minor", minor), ("major", major)] {
        if !path.is_empty() {
            h.raw(&format!("<path class=\"{class}\" d=\"{path}\"/>\n"));
        }
    }
    h.raw(&format!("<path class=\"axis\" d=\"M{left} {top}V{bottom}H{right}\"/>\n"));
    for t in f.x.ticks() {
        if let Some(label) = &t.label {
            let (x, y) = (pixel(f.right(t.at)), pixel(HEIGHT - BOTTOM + 20.0));
            h.raw(&format!("<text class=\"xt\" x=\"{x}\" y=\"{y}\">")).text(label).raw("</text>\n");
        }
    }
    for t in f.y.ticks() {
        if let Some(label) = &t.label {
            let (x, y) = (pixel(f.left - 8.0), pixel(Frame::down(t.at)));
            h.raw(&format!("<text class=\"yt\" x=\"{x}\" y=\"{y}\" dy=\".35em\">"))
                .text(label)
                .raw("</text>\n");
        }
    }
}

fn axis_labels(h: &mut Html, plot: &Plot, f: &Frame) {
    let (x, y) = (pixel(f.right(0.5)), pixel(HEIGHT - 14.0));
    for (place, label) in [
        (format!("class=\"xl\" x=\"{x}\" y=\"{y}\""), &plot.x.label),
        // Level rather than turned, so that it can be read.
        ("class=\"yl\" x=\"4\" y=\"16\"".to_owned(), &plot.y.label),
    ] {
        h.raw(&format!("<text {place}>")).text(&shortened(label, AXIS_LABEL));
        if label.chars().count() > AXIS_LABEL {
            h.raw("<title>").text(label).raw("</title>");
        }
        h.raw("</text>\n");
    }
}

/// Tenths of a pixel, without an idle `.0`.
pub(super) fn pixel(v: f64) -> String {
    let text = format!("{v:.1}");
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}
