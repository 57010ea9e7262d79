//! What is where in a plot.

use std::collections::BTreeSet;

use etendue_measure::report::{Guide, Line, Plot, Point, Series};
use proptest::num::f64::ANY;
use proptest::prelude::*;

use crate::checker::well_formed;
use crate::{html_of, plot_of};

/// Where the markers are, in the order drawn.
fn markers(html: &str) -> Vec<[f64; 2]> {
    let moved = well_formed(html).into_iter().filter(|t| t.name == "g");
    moved
        .map(|t| {
            let inside =
                t.get("transform").strip_prefix("translate(").unwrap().strip_suffix(')').unwrap().to_owned();
            let (x, y) = inside.split_once(' ').unwrap();
            [x.parse().unwrap(), y.parse().unwrap()]
        })
        .collect()
}

/// Every number in the paths of this class.
fn coordinates(html: &str, class: &str) -> Vec<f64> {
    let tags = well_formed(html);
    let paths = tags.iter().filter(|t| t.name == "path" && t.get("class").split(' ').any(|c| c == class));
    let numbers = paths.flat_map(|t| t.get("d").split(|c: char| !"0123456789.-".contains(c)));
    numbers.filter(|n| !n.is_empty()).map(|n| n.parse().unwrap()).collect()
}

/// Left, top, right, bottom of the plot.
fn frame(html: &str) -> [f64; 4] {
    let c = coordinates(html, "axis");
    [c[0], c[1], c[3], c[2]]
}

/// Everything that is drawn lies in the frame, and the frame and the labels in the picture.
fn check_inside(plot: &Plot) {
    let html = html_of(plot);
    let [left, top, right, bottom] = frame(&html);
    let picture = well_formed(&html).into_iter().find(|t| t.get("class") == "chart").unwrap();
    let (width, height) = (picture.number("width"), picture.number("height"));
    assert_eq!(picture.get("viewBox"), format!("0 0 {width} {height}"));
    assert!(0.0 < left && left < right && right < width && 0.0 < top && top < bottom && bottom < height);
    for [x, y] in markers(&html) {
        assert!((left..=right).contains(&x) && (top..=bottom).contains(&y), "{x} {y}");
    }
    for class in ["line", "band", "bar", "guide"] {
        // The signs of the legend are pictures of their own.
        let chart =
            &html[html.find("<svg").unwrap()..html.find("<ul class=\"legend\"").unwrap_or(html.len())];
        let chart = format!("<!DOCTYPE html>\n{}\n", &chart[..chart.rfind("</svg>").unwrap() + 6]);
        for pair in coordinates(&chart, class).chunks(2) {
            assert!(
                (left..=right).contains(&pair[0]) && (top..=bottom).contains(&pair[1]),
                "{class} {pair:?}"
            );
        }
    }
    let tags = well_formed(&html);
    for t in tags.iter().filter(|t| t.name == "text") {
        let (x, y) = (t.number("x"), t.number("y"));
        match t.get("class") {
            "xt" => assert!((left..=right).contains(&x) && bottom < y && y < height, "{x} {y}"),
            "yt" => assert!(x < left && (top..=bottom).contains(&y), "{x} {y}"),
            _ => assert!((0.0..width).contains(&x) && (0.0..height).contains(&y), "{x} {y}"),
        }
    }
    assert!(html.len() < 60_000, "{} bytes", html.len());
}

proptest! {
    /// Curves of any numbers at all end up inside the picture.
    #[test]
    fn any_numbers_are_drawn_inside(
        numbers in prop::collection::vec([ANY; 4], 0..12), ends in any::<[bool; 2]>(), log in any::<[bool; 2]>(),
        slope in ANY,
    ) {
        let points = numbers.iter().map(|[x, y, low, high]| {
            Point { low: ends[0].then_some(*low), high: ends[1].then_some(*high), ..Point::new(*x, *y) }
        });
        let mut plot = plot_of(points.collect());
        ([plot.x.log, plot.y.log], plot.guide) = (log, Some(Guide { slope, label: "guide".into() }));
        check_inside(&plot);
    }
}

#[test]
fn known_values_are_at_known_pixels() {
    // Room makes 0.5…2000 and 5e-5…0.2 of these.
    let html =
        html_of(&plot_of(vec![Point::new(1.0, 0.1), Point::new(1000.0, 1e-4), Point::new(10.0, 1e-2)]));
    let [left, top, right, bottom] = frame(&html);
    let (decade_x, decade_y) = ((right - left) / 4000f64.log10(), (bottom - top) / 4000f64.log10());
    let x = |v: f64| left + (v / 0.5).log10() * decade_x;
    let y = |v: f64| bottom - (v / 5e-5).log10() * decade_y;
    for ([px, py], (vx, vy)) in markers(&html).into_iter().zip([(1.0, 0.1), (1000.0, 1e-4), (10.0, 1e-2)]) {
        assert!((px - x(vx)).abs() <= 0.11 && (py - y(vy)).abs() <= 0.11, "{px} {py} for {vx} {vy}");
    }
    for (class, name, labels) in
        [("xt", "x", ["1", "10", "100", "1000"]), ("yt", "y", ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹"])]
    {
        let found: Vec<&str> = html.split(&format!("<text class=\"{class}\"")).skip(1).collect();
        assert_eq!(found.len(), labels.len());
        for (i, (tag, label)) in found.iter().zip(labels).enumerate() {
            assert!(tag.contains(&format!(">{label}</text>")), "{label} in {tag:.80}");
            let at: f64 =
                tag.split(&format!(" {name}=\"")).nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
            let exact = if class == "xt" { x(10f64.powi(i as i32)) } else { y(10f64.powi(i as i32 - 4)) };
            assert!((at - exact).abs() <= 0.11, "{label}: {at}, not {exact}");
        }
    }
}

#[test]
fn degenerate_plots_are_plots() {
    let huge = [f64::MIN_POSITIVE, 5e-324, 1.0, f64::MAX];
    let cases: Vec<Vec<[f64; 2]>> = vec![
        vec![],
        vec![[1.0, 1.0]],
        vec![[0.0, 0.0]],
        vec![[-1.0, -1.0]; 3],
        vec![[3.0, 7e-9]; 5],
        huge.map(|v| [v, v]).to_vec(),
        huge.map(|v| [-v, v]).to_vec(),
        vec![[f64::NAN, 1.0], [f64::INFINITY, 2.0], [1.0, f64::NEG_INFINITY]],
        vec![[1.0, 1.0], [1.0 + 1e-15, 1.0 - 1e-15]],
    ];
    for points in cases {
        for (log_x, log_y) in [(false, false), (false, true), (true, false), (true, true)] {
            let mut plot = plot_of(points.iter().map(|[x, y]| Point::new(*x, *y)).collect());
            (plot.x.log, plot.y.log, plot.guide) = (log_x, log_y, Some(Guide::inverse()));
            check_inside(&plot);
            let drawn = points.iter().flatten().all(|v| v.is_finite()) && !log_x && !log_y;
            assert!(!drawn || markers(&html_of(&plot)).len() == points.len());
        }
    }
    let html = html_of(&Plot { series: vec![], ..plot_of(vec![]) });
    assert!(html.contains("no points to draw") && !html.contains("<ul class=\"legend\""));
}

#[test]
fn what_has_no_place_is_counted_and_leaves_a_gap() {
    let y = [1.0, 0.5, 0.0, 0.2, f64::NAN, 0.1, 0.05];
    let points: Vec<Point> = y.iter().enumerate().map(|(i, y)| Point::new((i + 1) as f64, *y)).collect();
    let mut plot = plot_of(points);
    let html = html_of(&plot);
    assert!(html.contains(
        "2 points are left out: only what is finite and, on a logarithmic axis, positive has a place."
    ));
    assert_eq!(markers(&html).len(), 5);
    assert_eq!(html.matches("<path class=\"s0 line\"").count(), 2, "one point alone has no line");
    (plot.x.log, plot.y.log) = (false, false);
    let html = html_of(&plot);
    assert!(html.contains("1 point is left out: only what is finite has a place."));
    assert_eq!(html.matches("<path class=\"s0 line\"").count(), 2);
    plot.series[0].points.remove(4);
    let html = html_of(&plot);
    assert!(!html.contains("left out"));
    assert_eq!(html.matches("<path class=\"s0 line\"").count(), 1);
}

#[test]
fn intervals_to_zero_go_to_the_floor() {
    let point = |x: f64, low: f64| Point { low: Some(low), high: Some(2.0 / x), ..Point::new(x, 1.0 / x) };
    let plot = plot_of(vec![point(1.0, 0.5), point(10.0, -0.2), point(100.0, 0.0)]);
    let html = html_of(&plot);
    let [_, top, _, bottom] = frame(&html);
    let band = coordinates(&html, "band");
    // The upper edge from the left, then the lower edge from the right.
    assert_eq!(band.len(), 12);
    assert_eq!([band[7], band[9]], [bottom; 2]);
    assert!(band[11] < bottom && band[1] > top, "the first one is inside: {band:?}");
    assert!(html.contains("Intervals that reach beyond the plot, as to 0, end at its edge."));

    let inside = html_of(&plot_of(vec![point(1.0, 0.5), point(10.0, 0.05)]));
    assert!(coordinates(&inside, "band").iter().skip(1).step_by(2).all(|y| *y < bottom));
    assert!(!inside.contains("beyond the plot"));

    let alone = html_of(&plot_of(vec![point(1.0, 0.5)]));
    assert_eq!((coordinates(&alone, "bar").len(), coordinates(&alone, "band").len()), (4, 0));
}

#[test]
fn curves_differ_by_shape_and_colour() {
    let series =
        |i: usize| Series { name: format!("c{i}"), points: vec![Point::new(1.0, 1.0)], ..Series::default() };
    let mut plot = Plot { series: (0..64).map(series).collect(), ..plot_of(vec![]) };
    let looks = |html: &str| -> Vec<String> {
        let points = html.split("<g class=\"").skip(1);
        points
            .map(|p| format!("{} {}", &p[..2], p.split(" d=\"").nth(1).unwrap().split('"').next().unwrap()))
            .collect()
    };
    let all = looks(&html_of(&plot));
    assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), 64);
    let shapes: BTreeSet<&str> = all.iter().take(8).map(|l| &l[3..]).collect();
    assert_eq!(shapes.len(), 8, "told apart without their colours");
    plot.series.truncate(2);
    plot.series[1].look = Some(usize::MAX);
    plot.series[1].line = Line::Dashed;
    plot.series[1].points.push(Point::new(2.0, 2.0));
    let html = html_of(&plot);
    assert_eq!(looks(&html)[1], all[63]);
    assert_eq!(html.matches("line dashed\"").count(), 2, "the curve and its sign in the legend");
}

#[test]
fn the_guide_has_its_slope() {
    let mut plot = plot_of((0..5).map(|i| Point::new(10f64.powi(i), 10f64.powi(-i))).collect());
    plot.guide = Some(Guide::inverse());
    let html = html_of(&plot);
    assert!(html.contains("slope −1</li>"));
    let line = coordinates(&html, "guide");
    let points = markers(&html);
    let slope = |a: &[f64], b: &[f64]| (b[1] - a[1]) / (b[0] - a[0]);
    let falls = slope(&points[0], &points[4]);
    assert!((slope(&line[..2], &line[2..4]) - falls).abs() < 0.01, "along points that fall like 1/x");
    plot.y.log = false;
    assert!(!html_of(&plot).contains("slope −1"), "a straight line means nothing there");
}
