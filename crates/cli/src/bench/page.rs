//! The measurements of all scenes as one page.

use etendue::measure::report::{
    Axis as PlotAxis, Cell, Guide, Item, Line, Page, Plot, Point as Mark, Row as TableRow, Section, Series,
    Table, number,
};
use etendue::measure::{Axis, Curve, Known, Measured, Metric, Point};

use super::maps;
use super::summary::{Row, SceneResult, bias_share, short, with_bounds};
use crate::error::CliError;

/// Writes the page.
pub(super) fn html(results: &[SceneResult], command: &str) -> Result<String, CliError> {
    let sections = results.iter().map(section).collect::<Result<Vec<_>, _>>()?;
    let facts = [
        ("program", format!("etendue {}", env!("CARGO_PKG_VERSION"))),
        ("machine", format!("{} {}", std::env::consts::OS, std::env::consts::ARCH)),
        ("threads", results.first().map_or(0, |r| r.threads).to_string()),
    ];
    let lead = [
        "Every contender renders each picture several times with different random numbers. An error against the \
         reference is the variance of a render, plus the square of its bias, plus the reference's own error; the \
         variance is known from pairs of renders alone, so that what is left is bias.",
        "Bands and brackets hold the truth with 95 % probability. They come from the scatter between runs. Contenders \
         draw in turns, run by run and point by point; the first is there twice, and the difference between the two is \
         noise.",
    ];
    let page = Page {
        title: "Run time against error".into(),
        lead: lead.map(str::to_owned).into(),
        sections,
        command: command.to_owned(),
        facts: facts.map(|(k, v)| (k.to_owned(), v)).into(),
    };
    Ok(page.html())
}

fn section(result: &SceneResult) -> Result<Section, CliError> {
    let [w, h] = result.size;
    let about =
        format!("{w} × {h} pixels, {} runs of each contender, {} threads. ", result.runs, result.threads);
    let reference = match &result.reference {
        Some((name, r)) => format!(
            "Measured against {name}, whose own relMSE is {}; it is taken out of efficiencies and times.",
            number(r.residual.relative)
        ),
        None => "Without a reference: errors are the variance between runs, and bias is not seen.".into(),
    };
    let mut items = vec![Item::Text(about + &reference)];
    items.extend(result.warnings.iter().map(|w| Item::Text(format!("Warning: {w}."))));
    items.push(Item::Table(judged(result)));
    items.push(Item::Plots(plots(result)));
    items.push(Item::Table(measures(result)));
    items.extend(maps::galleries(result)?.into_iter().map(Item::Figures));
    Ok(Section::new(result.name.clone(), items))
}

/// The numbers that contenders are judged by.
fn judged(result: &SceneResult) -> Table {
    let cost = cost_word(result.axis());
    let target = result.target();
    let mut head = [
        "contender",
        "spp",
        "relMSE",
        "bias² / relMSE",
        "CPU seconds",
        "slope",
        "efficiency",
        "over the first",
    ]
    .map(str::to_owned)
    .to_vec();
    head.extend(target.map(|t| format!("{cost} to {}", number(t))));
    let rows = result.rows();
    let best = rows.iter().filter_map(|r| r.efficiency).map(|e| e.value).fold(0.0, f64::max);
    let cells = |r: &Row<'_>| {
        let p = r.last;
        let error = p.error(Metric::Relative).or_else(|| p.variance(Metric::Relative));
        let mut cells = vec![Cell::text(r.name), Cell::number(p.spp.to_string())];
        let numbers = [
            percent(error),
            bias_share(p).map_or_else(|| "–".to_owned(), |b| plus_minus(b, 100.0, 1, " %")),
            median(p, Axis::CpuSeconds),
            r.slope.map_or_else(|| "–".to_owned(), |s| plus_minus(s, 1.0, 2, "")),
            percent(r.efficiency),
            with_bounds(r.ratio),
        ];
        cells.extend(numbers.into_iter().map(Cell::number));
        if target.is_some() {
            cells.push(Cell::number(r.to_target.map_or_else(
                || "–".to_owned(),
                |t| {
                    let mark = match t.known {
                        Known::Measured => "",
                        Known::AtMost => "≤ ",
                        Known::Extrapolated => "≈ ",
                    };
                    format!("{mark}{}", number(t.cost.value))
                },
            )));
        }
        let row = TableRow::new(cells);
        if r.efficiency.is_some_and(|e| e.value == best) { row.highlighted() } else { row }
    };
    let mut notes = vec![
        format!("Efficiency is 1 / (relMSE × {cost}), the reference's own error taken out; times are medians over runs."),
        "“Over the first” compares efficiencies at the last number of samples that both have. In the last column “≈” \
         goes on along the slope beyond the last point, and “≤” lies before the first."
            .into(),
    ];
    notes.extend(result.notes().iter().map(|note| format!("{note}.")));
    Table {
        caption: "The last point of every contender".into(),
        head,
        rows: rows.iter().map(cells).collect(),
        notes,
    }
}

/// The same points in other measures.
fn measures(result: &SceneResult) -> Table {
    let head = [
        "contender",
        "variance",
        "relMSE trimmed",
        "trimmed efficiency over the first",
        "RMSE",
        "seconds",
        "samples",
        "rays",
        "rays per CPU second",
    ];
    let cells = |r: &Row<'_>| {
        let p = r.last;
        let rmse = p.error(Metric::Absolute).map(|m| Measured {
            value: m.value.sqrt(),
            interval: m.interval.map(|i| i.map(|x| x.max(0.0).sqrt())),
        });
        let rate = p.median_cost(Axis::Rays).zip(p.median_cost(Axis::CpuSeconds)).map(|(r, s)| r / s);
        let numbers = [
            percent(p.variance(Metric::Relative)),
            percent(p.error(Metric::Trimmed)),
            with_bounds(r.trimmed_ratio),
            percent(rmse),
            median(p, Axis::Seconds),
            median(p, Axis::Samples),
            median(p, Axis::Rays),
            rate.map_or_else(|| "–".to_owned(), number),
        ];
        TableRow::new(
            std::iter::once(Cell::text(r.name))
                .chain(numbers.into_iter().map(Cell::number))
                .collect::<Vec<_>>(),
        )
    };
    Table {
        caption: "The same points in other measures".into(),
        head: head.map(str::to_owned).to_vec(),
        rows: result.rows().iter().map(cells).collect(),
        notes: Vec::new(),
    }
}

fn median(p: &Point, axis: Axis) -> String {
    p.median_cost(axis).map_or_else(|| "–".to_owned(), number)
}

/// A number around zero and the larger side of its interval, both times a factor.
fn plus_minus(m: Measured, factor: f64, digits: usize, unit: &str) -> String {
    let value = format!("{:.digits$}", m.value * factor).replace('-', "−");
    match m.interval {
        Some([low, high]) => {
            let half = (high - m.value).max(m.value - low) * factor;
            format!("{value} ±{half:.digits$}{unit}")
        }
        None => value + unit,
    }
}

/// A number and the larger side of its interval in percent.
fn percent(m: Option<Measured>) -> String {
    let Some(m) = m else { return "–".into() };
    match m.relative_half_width() {
        Some(h) => format!("{} ±{} %", number(m.value), short(100.0 * h)),
        None => number(m.value),
    }
}

fn cost_word(axis: Axis) -> &'static str {
    if axis == Axis::CpuSeconds { "CPU seconds" } else { "seconds" }
}

fn plots(result: &SceneResult) -> Vec<Plot> {
    let axis = result.axis();
    let (title, of) = if result.reference.is_some() {
        ("relMSE", (|p: &Point| p.error(Metric::Relative)) as fn(&Point) -> Option<Measured>)
    } else {
        ("variance", (|p: &Point| p.variance(Metric::Relative)) as fn(&Point) -> Option<Measured>)
    };
    let plot = |title: String, x: &str, y: &str, series| Plot {
        title,
        x: PlotAxis::log(x),
        y: PlotAxis::log(y),
        series,
        guide: Some(Guide::inverse()),
        notes: Vec::new(),
    };
    let against = |cost: Axis| -> Vec<Series> {
        result.curves.iter().enumerate().map(|(i, c)| series(c, i, cost, of, Line::Solid)).collect()
    };
    let cost = cost_word(axis);
    let mut out = vec![
        plot(format!("{title} against {cost}"), &format!("{cost} of one run"), title, against(axis)),
        plot(format!("{title} against samples"), "camera samples of one run", title, against(Axis::Samples)),
    ];
    if result.reference.is_some() {
        let split = result.curves.iter().enumerate().flat_map(|(i, c)| {
            // What the bias is at most can be drawn; the estimate scatters around zero and has no place half of the time.
            let at_most = |p: &Point| {
                if p.is_limited_by_reference(Metric::Relative) {
                    return None;
                }
                let [_, high] = p.bias_squared(Metric::Relative)?.interval?;
                Some(Measured::without_interval(high))
            };
            let mut variance = series(c, i, Axis::Samples, |p| p.variance(Metric::Relative), Line::Solid);
            let mut bias = series(c, i, Axis::Samples, at_most, Line::Dashed);
            variance.name += ", variance";
            bias.name += ", bias² at most";
            [variance, bias]
        });
        let split = split.filter(|s| !s.points.is_empty()).collect();
        let mut plot = plot(
            "Variance, and what bias² is at most".into(),
            "camera samples of one run",
            "part of relMSE",
            split,
        );
        plot.notes.push(
            "“At most” is the upper end of the interval. Without bias it falls with the variance; a bias makes it level out.".into(),
        );
        out.push(plot);
    }
    out
}

fn series(
    curve: &Curve,
    look: usize,
    axis: Axis,
    of: impl Fn(&Point) -> Option<Measured>,
    line: Line,
) -> Series {
    let mark = |p: &Point| {
        let m = of(p)?;
        Some(Mark {
            x: p.cost(axis)?.value,
            y: m.value,
            low: m.interval.map(|i| i[0]),
            high: m.interval.map(|i| i[1]),
            label: format!("{} spp", p.spp),
        })
    };
    Series {
        name: curve.name.clone(),
        points: curve.points.iter().filter_map(mark).collect(),
        line,
        look: Some(look),
    }
}
