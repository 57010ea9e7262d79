//! What a plot contains.

use super::markup::Html;
use super::number::number;
use super::svg;

/// Curves over two axes, with a legend beneath.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    /// Heading.
    pub title: String,
    /// The axis to the right.
    pub x: Axis,
    /// The axis upward.
    pub y: Axis,
    /// The curves, drawn in this order.
    pub series: Vec<Series>,
    /// A faint line to compare slopes with; drawn on two logarithmic axes only.
    pub guide: Option<Guide>,
    /// Paragraphs beneath. What could not be drawn is noted without being asked for.
    pub notes: Vec<String>,
}

/// One axis. Its ends are round numbers around the points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// The quantity and its unit.
    pub label: String,
    /// Logarithmic: only positive numbers have a place.
    pub log: bool,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), log: false }
    }

    /// A logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), log: true }
    }
}

/// One curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Its name in the legend and at its points.
    pub name: String,
    /// Joined in this order. A point without a place on the axes leaves a gap and is counted in a note.
    pub points: Vec<Point>,
    /// How the points are joined.
    pub line: Line,
    /// Colour and marker, counted modulo 64; by place in the list if `None`. For curves that belong together, and
    /// for contenders that keep their colour from plot to plot.
    pub look: Option<usize>,
}

/// How the points of a curve are joined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Line {
    /// A line.
    #[default]
    Solid,
    /// A dashed line.
    Dashed,
}

/// One measured point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// To the right.
    pub x: f64,
    /// Upward.
    pub y: f64,
    /// Lower end of the interval of y; y itself if only the other end is known. What is beyond the plot, as 0 on a
    /// logarithmic axis, ends at its edge.
    pub low: Option<f64>,
    /// Upper end of the interval of y.
    pub high: Option<f64>,
    /// What the point is (`64 spp`), said when it is pointed at; may be empty.
    pub label: String,
}

impl Point {
    /// Without interval and label.
    pub fn new(x: f64, y: f64) -> Self {
        Self { x, y, ..Self::default() }
    }

    /// The interval; `None` without one or if an end is not a number.
    pub(super) fn interval(&self) -> Option<[f64; 2]> {
        let (low, high) = match (self.low, self.high) {
            (None, None) => return None,
            (low, high) => (low.unwrap_or(self.y), high.unwrap_or(self.y)),
        };
        (!low.is_nan() && !high.is_nan()).then(|| [low.min(high), low.max(high)])
    }

    /// What is said when the point is pointed at.
    pub(super) fn spoken(&self, plot: &Plot, series: &Series) -> String {
        let mut out = series.name.clone();
        if !self.label.is_empty() {
            out.push_str(", ");
            out.push_str(&self.label);
        }
        for (axis, v) in [(&plot.x, self.x), (&plot.y, self.y)] {
            out.push_str(&format!("\n{}: {}", axis.label, number(v)));
        }
        if let Some([low, high]) = self.interval() {
            out.push_str(&format!(" ({} to {})", number(low), number(high)));
        }
        out
    }
}

/// A straight line on logarithmic axes, through the middle of the points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Guide {
    /// Power of x that it falls or rises with.
    pub slope: f64,
    /// Its name in the legend.
    pub label: String,
}

impl Guide {
    /// Falling like 1/x, as the variance of a mean of x independent samples does.
    pub fn inverse() -> Self {
        Self { slope: -1.0, label: "slope −1".into() }
    }
}

impl Plot {
    pub(super) fn write(&self, h: &mut Html) {
        let drawing = svg::draw(self);
        h.raw("<figure class=\"plot\">\n<figcaption>").text(&self.title).raw("</figcaption>\n");
        h.raw(&drawing.svg).raw("\n");
        let guide = self.guide.as_ref().filter(|_| drawing.guide);
        if !self.series.is_empty() || guide.is_some() {
            h.raw("<ul class=\"legend\">\n");
            for (i, series) in self.series.iter().enumerate() {
                h.raw("<li>").raw(&svg::key(series, i)).text(&series.name).raw("</li>\n");
            }
            if let Some(guide) = guide {
                h.raw("<li>").raw(svg::GUIDE_KEY).text(&guide.label).raw("</li>\n");
            }
            h.raw("</ul>\n");
        }
        h.notes(&drawing.notes).notes(&self.notes).raw("</figure>\n");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_of_one_end_begin_at_the_point() {
        let p = Point::new(1.0, 2.0);
        assert_eq!(p.interval(), None);
        assert_eq!(Point { high: Some(3.0), ..p.clone() }.interval(), Some([2.0, 3.0]));
        assert_eq!(Point { low: Some(5.0), high: Some(3.0), ..p.clone() }.interval(), Some([3.0, 5.0]));
        assert_eq!(Point { low: Some(f64::NAN), ..p.clone() }.interval(), None);
    }

    #[test]
    fn a_point_says_what_it_is() {
        let plot = Plot { x: Axis::log("seconds"), y: Axis::log("MSE"), ..Plot::default() };
        let series = Series { name: "path".into(), ..Series::default() };
        let p = Point { low: Some(0.0), high: Some(2e-4), label: "64 spp".into(), ..Point::new(1.5, 1e-4) };
        assert_eq!(p.spoken(&plot, &series), "path, 64 spp\nseconds: 1.50\nMSE: 1.00×10⁻⁴ (0 to 2.00×10⁻⁴)");
        assert_eq!(Point::new(1.5, 2.5).spoken(&plot, &series), "path\nseconds: 1.50\nMSE: 2.50");
    }
}
