use etendue::measure::{Axis, Known, Metric};

use super::summary::{Row, SceneResult, bias_share, short, with_bounds, with_percent};

/// Lines for people.
pub(super) fn lines(result: &SceneResult) -> Vec<String> {
    let mut out = Vec::new();
    let [w, h] = result.size;
    let (runs, threads) = (result.runs, result.threads);
    out.push(format!("{}: {w}x{h} pixels, {runs} runs each, {threads} threads", result.name));
    out.push(match &result.reference {
        Some((name, r)) => format!("reference {name}: its own relMSE is {:.3e}", r.residual.relative),
        None => "no reference: errors are the variance between runs, and bias is not seen".into(),
    });
    let rows = result.rows();
    let cost = if result.axis() == Axis::CpuSeconds { "CPU s" } else { "s" };
    let mut columns: Vec<[String; 9]> = vec![
        [
            "contender",
            "spp",
            "relMSE",
            "bias² / relMSE",
            "s",
            "CPU s",
            "slope",
            "efficiency",
            "over the first",
        ]
        .map(str::to_owned),
    ];
    columns.extend(rows.iter().map(cells));
    let widths: Vec<usize> =
        (0..9).map(|i| columns.iter().map(|r| r[i].chars().count()).max().unwrap_or(0)).collect();
    for row in &columns {
        let padded: Vec<String> = row
            .iter()
            .zip(&widths)
            .map(|(cell, width)| format!("{cell}{}", " ".repeat(width - cell.chars().count())))
            .collect();
        out.push(padded.join("  ").trim_end().to_owned());
    }
    out.push(format!("efficiency is 1 / (relMSE x {cost}); the last column compares it at equal samples"));
    out.extend(target_line(result, &rows, cost));
    out.extend(noise_line(result));
    out.extend(result.notes().iter().map(|note| format!("note: {note}")));
    out
}

fn cells(r: &Row<'_>) -> [String; 9] {
    let p = r.last;
    let error = p.error(Metric::Relative).or_else(|| p.variance(Metric::Relative));
    let median = |axis| p.median_cost(axis).map_or_else(|| "-".to_owned(), short);
    [
        r.name.to_owned(),
        p.spp.to_string(),
        with_percent(error),
        with_bounds(bias_share(p)),
        median(Axis::Seconds),
        median(Axis::CpuSeconds),
        with_bounds(r.slope),
        with_bounds(r.efficiency),
        with_bounds(r.ratio),
    ]
}

/// How long each needs to the error that all reach.
fn target_line(result: &SceneResult, rows: &[Row<'_>], cost: &str) -> Option<String> {
    let target = result.target()?;
    let part = |r: &Row<'_>| {
        let t = r.to_target?;
        let mark = match t.known {
            Known::Measured => "",
            Known::AtMost => "at most ",
            Known::Extrapolated => "by its slope ",
        };
        let speed = r.speed.map(|s| format!(" ({} times as fast)", with_bounds(Some(s)))).unwrap_or_default();
        Some(format!("'{}' {mark}{}{speed}", r.name, short(t.cost.value)))
    };
    let parts: Vec<String> = rows.iter().filter_map(part).collect();
    Some(format!("{cost} to a relMSE of {target:.3e}: {}", parts.join(", ")))
}

/// What the first contender differs from itself by.
fn noise_line(result: &SceneResult) -> Option<String> {
    let (again, first) = result.curves.get(1)?.last_common(result.curves.first()?)?;
    let cost = |axis| with_bounds(again.cost_over(first, axis));
    Some(format!(
        "noise: the first contender again takes {} times the seconds, {} times the CPU seconds",
        cost(Axis::Seconds),
        cost(Axis::CpuSeconds)
    ))
}
