//! Plots as inline SVG. Colours are the page's, by class.

use super::frame::{Frame, pixel};
use super::markup::Html;
use super::plot::{Line, Plot, Point, Series};
use super::scale::{Extent, Scale, place};

/// A plot as it came out.
pub(super) struct Drawing {
    pub(super) svg: String,
    /// What the picture does not show.
    pub(super) notes: Vec<String>,
    /// Whether the guide was drawn.
    pub(super) guide: bool,
}

/// The legend's sign for the guide.
pub(super) const GUIDE_KEY: &str = "<svg class=\"key\" width=\"36\" height=\"16\" viewBox=\"0 0 36 16\" \
     aria-hidden=\"true\"><path class=\"guide\" d=\"M0 8H36\"/></svg>";

/// The markers, about equally large, around the origin.
const MARKERS: [&str; 8] = [
    "M-4 0A4 4 0 1 1 4 0A4 4 0 1 1 -4 0Z",
    "M-3.6 -3.6H3.6V3.6H-3.6Z",
    "M0 -5L4.7 3.4H-4.7Z",
    "M0 -5.2L5.2 0L0 5.2L-5.2 0Z",
    "M0 5L4.7 -3.4H-4.7Z",
    "M-1.6 -5H1.6V-1.6H5V1.6H1.6V5H-1.6V1.6H-5V-1.6H-1.6Z",
    "M-2.4 -4.7L0 -2.3L2.4 -4.7L4.7 -2.4L2.3 0L4.7 2.4L2.4 4.7L0 2.3L-2.4 4.7L-4.7 2.4L-2.3 0L-4.7 -2.4Z",
    "M-4.6 0L-2.3 -4H2.3L4.6 0L2.3 4H-2.3Z",
];

/// Colour and marker of a curve.
#[derive(Clone, Copy)]
struct Look {
    colour: usize,
    marker: &'static str,
    dashed: &'static str,
}

impl Look {
    fn of(series: &Series, index: usize) -> Self {
        let look = series.look.unwrap_or(index);
        let colour = look % MARKERS.len();
        // The ninth curve has the first's colour with another marker.
        let marker = (look % MARKERS.len() + look / MARKERS.len() % MARKERS.len()) % MARKERS.len();
        Self {
            colour,
            marker: MARKERS.get(marker).copied().unwrap_or_default(),
            dashed: if series.line == Line::Dashed { " dashed" } else { "" },
        }
    }
}

/// The legend's sign for a curve.
pub(super) fn key(series: &Series, index: usize) -> String {
    let Look { colour, marker, dashed } = Look::of(series, index);
    format!(
        "<svg class=\"key s{colour}\" width=\"36\" height=\"16\" viewBox=\"0 0 36 16\" aria-hidden=\"true\">\
         <path class=\"line{dashed}\" d=\"M0 8H36\"/><path class=\"mark\" transform=\"translate(18 8)\" \
         d=\"{marker}\"/></svg>"
    )
}

/// A point that has its place in the plot.
struct Spot<'a> {
    point: &'a Point,
    x: f64,
    y: f64,
    /// Pixels of the interval's ends.
    band: Option<[f64; 2]>,
}

/// Draws a plot, whatever is in it.
pub(super) fn draw(plot: &Plot) -> Drawing {
    let (mut xs, mut ys, mut bands) = (Extent::new(), Extent::new(), Extent::new());
    let mut left_out = 0usize;
    for point in plot.series.iter().flat_map(|s| &s.points) {
        let Some([x, y]) = placed(plot, point) else {
            left_out += 1;
            continue;
        };
        xs.add(x);
        ys.add(y);
        point
            .interval()
            .into_iter()
            .flatten()
            .filter_map(|v| place(plot.y.log, v))
            .for_each(|v| bands.add(v));
    }
    let (x, y) = (Scale::fit(plot.x.log, xs, Extent::new()), Scale::fit(plot.y.log, ys, bands));
    let frame = Frame::new(x, y);

    let mut h = Html::default();
    frame.open(&mut h, plot);
    let guide = guide(&mut h, plot, &frame);
    let mut cut = false;
    let curves: Vec<Vec<Vec<Spot<'_>>>> =
        plot.series.iter().map(|s| runs(plot, s, &frame, &mut cut)).collect();
    // Every band beneath every line, and every line beneath every marker.
    for (i, (series, runs)) in plot.series.iter().zip(&curves).enumerate() {
        runs.iter().for_each(|run| draw_bands(&mut h, run, Look::of(series, i)));
    }
    for (i, (series, runs)) in plot.series.iter().zip(&curves).enumerate() {
        runs.iter().for_each(|run| draw_line(&mut h, run, Look::of(series, i)));
    }
    for (i, (series, runs)) in plot.series.iter().zip(&curves).enumerate() {
        let look = Look::of(series, i);
        for spot in runs.iter().flatten() {
            draw_marker(&mut h, spot, look, &spot.point.spoken(plot, series));
        }
    }
    if curves.iter().all(Vec::is_empty) {
        let (x, y) = (pixel(frame.right(0.5)), pixel(Frame::down(0.5)));
        h.raw(&format!("<text class=\"empty\" x=\"{x}\" y=\"{y}\">no points to draw</text>\n"));
    }
    h.raw("</svg>");
    Drawing { svg: h.finish(), notes: notes(plot, left_out, cut), guide }
}

fn placed(plot: &Plot, p: &Point) -> Option<[f64; 2]> {
    Some([place(plot.x.log, p.x)?, place(plot.y.log, p.y)?])
}

fn notes(plot: &Plot, left_out: usize, cut: bool) -> Vec<String> {
    let mut out = Vec::new();
    if left_out > 0 {
        let log = if plot.x.log || plot.y.log { " and, on a logarithmic axis, positive" } else { "" };
        out.push(match left_out {
            1 => format!("1 point is left out: only what is finite{log} has a place."),
            n => format!("{n} points are left out: only what is finite{log} has a place."),
        });
    }
    if cut {
        let zero = if plot.y.log { ", as to 0," } else { "" };
        out.push(format!("Intervals that reach beyond the plot{zero} end at its edge."));
    }
    out
}

/// The curve in pixels, broken where points are left out.
fn runs<'a>(plot: &Plot, series: &'a Series, f: &Frame, cut: &mut bool) -> Vec<Vec<Spot<'a>>> {
    let spot = |point: &'a Point, cut: &mut bool| {
        let [x, y] = placed(plot, point)?;
        let band = point.interval().map(|ends| {
            ends.map(|end| match place(plot.y.log, end) {
                Some(v) => {
                    *cut |= !f.y.holds(v);
                    Frame::down(f.y.unit(v))
                }
                None => {
                    *cut = true;
                    Frame::down(if end > 0.0 { 1.0 } else { 0.0 })
                }
            })
        });
        Some(Spot { point, x: f.right(f.x.unit(x)), y: Frame::down(f.y.unit(y)), band })
    };
    let spots: Vec<Option<Spot<'a>>> = series.points.iter().map(|p| spot(p, cut)).collect();
    split(spots, |s| s)
}

/// The stretches in which `keep` gives something.
fn split<T, U>(items: impl IntoIterator<Item = T>, keep: impl Fn(T) -> Option<U>) -> Vec<Vec<U>> {
    let mut out = vec![Vec::new()];
    for item in items {
        match (keep(item), out.last_mut()) {
            (Some(kept), Some(run)) => run.push(kept),
            _ => out.push(Vec::new()),
        }
    }
    out.retain(|run| !run.is_empty());
    out
}

/// Draws the guide; whether it could.
fn guide(h: &mut Html, plot: &Plot, f: &Frame) -> bool {
    let points: Vec<[f64; 2]> =
        plot.series.iter().flat_map(|s| &s.points).filter_map(|p| placed(plot, p)).collect();
    let Some(slope) = plot.guide.as_ref().map(|g| g.slope).filter(|s| s.is_finite()) else { return false };
    if points.is_empty() || !plot.x.log || !plot.y.log {
        return false;
    }
    let n = points.len() as f64;
    let (mx, my) =
        (points.iter().map(|p| p[0]).sum::<f64>() / n, points.iter().map(|p| p[1]).sum::<f64>() / n);
    let (mut from, mut to) = (f.x.low, f.x.high);
    if slope != 0.0 {
        let (a, b) = (mx + (f.y.low - my) / slope, mx + (f.y.high - my) / slope);
        (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
    }
    let [start, end] = [from, to].map(|x| {
        format!("{} {}", pixel(f.right(f.x.unit(x))), pixel(Frame::down(f.y.unit(my + slope * (x - mx)))))
    });
    h.raw(&format!("<path class=\"guide\" d=\"M{start}L{end}\"/>\n"));
    true
}

fn draw_bands(h: &mut Html, run: &[Spot<'_>], look: Look) {
    for ends in split(run, |s| s.band.map(|[low, high]| (s.x, [low, high]))) {
        let corner = |(x, y): (f64, f64)| format!("{} {}", pixel(x), pixel(y));
        let upper = ends.iter().map(|(x, [_, high])| corner((*x, *high)));
        let lower = ends.iter().rev().map(|(x, [low, _])| corner((*x, *low)));
        let path = upper.chain(lower).collect::<Vec<_>>().join("L");
        // One interval alone has no area.
        let class = if ends.len() > 1 { "band" } else { "bar" };
        h.raw(&format!("<path class=\"s{} {class}\" d=\"M{path}Z\"/>\n", look.colour));
    }
}

fn draw_line(h: &mut Html, run: &[Spot<'_>], look: Look) {
    if run.len() > 1 {
        let corners: Vec<String> = run.iter().map(|s| format!("{} {}", pixel(s.x), pixel(s.y))).collect();
        let path = corners.join("L");
        h.raw(&format!("<path class=\"s{} line{}\" d=\"M{path}\"/>\n", look.colour, look.dashed));
    }
}

fn draw_marker(h: &mut Html, spot: &Spot<'_>, look: Look, spoken: &str) {
    let (x, y) = (pixel(spot.x), pixel(spot.y));
    h.raw(&format!("<g class=\"s{}\" transform=\"translate({x} {y})\"><title>", look.colour)).text(spoken);
    // A marker is a small thing to point at.
    h.raw(&format!(
        "</title><circle class=\"hit\" r=\"9\"/><path class=\"mark\" d=\"{}\"/></g>\n",
        look.marker
    ));
}
