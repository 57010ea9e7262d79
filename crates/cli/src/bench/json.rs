use etendue::measure::{Axis, Curve, Known, Measured, Metric, Point, Residual};
use serde_json::{Value, json};

use super::summary::{Row, SceneResult};

const METRICS: [(&str, Metric); 3] =
    [("relmse", Metric::Relative), ("relmse_trimmed", Metric::Trimmed), ("mse", Metric::Absolute)];

/// All numbers of a scene.
pub(super) fn value(result: &SceneResult) -> Value {
    let rows = result.rows();
    let contenders: Vec<Value> = result
        .curves
        .iter()
        .zip(&result.bias)
        .map(|(curve, bias)| contender(curve, bias, rows.iter().find(|r| r.name == curve.name)))
        .collect();
    json!({
        "scene": result.name,
        "size": result.size,
        "runs": result.runs,
        "threads": result.threads,
        "efficiency_cost": if result.axis() == Axis::CpuSeconds { "cpu_seconds" } else { "seconds" },
        "reference": result.reference.as_ref().map(|(name, r)| {
            let Residual { relative, trimmed, absolute } = r.residual;
            json!({ "name": name, "relmse": relative, "relmse_trimmed": trimmed, "mse": absolute })
        }),
        "target_relmse": result.target(),
        "contenders": contenders,
        "warnings": result.warnings,
    })
}

fn measured(m: Option<Measured>) -> Value {
    m.map_or(Value::Null, |m| json!({ "value": m.value, "interval": m.interval }))
}

fn contender(curve: &Curve, bias: &[String], row: Option<&Row<'_>>) -> Value {
    let mut out = json!({
        "name": curve.name,
        "bias": bias,
        "points": curve.points.iter().map(point).collect::<Vec<_>>(),
    });
    if let (Some(r), Value::Object(map)) = (row, &mut out) {
        map.insert("slope".into(), measured(r.slope));
        map.insert("efficiency_over_first".into(), measured(r.ratio));
        map.insert("trimmed_efficiency_over_first".into(), measured(r.trimmed_ratio));
        map.insert("speed_over_first".into(), measured(r.speed));
        let known = r.to_target.map(|t| match t.known {
            Known::Measured => "measured",
            Known::AtMost => "at most",
            Known::Extrapolated => "extrapolated",
        });
        map.insert("cost_to_target".into(), measured(r.to_target.map(|t| t.cost)));
        map.insert("cost_to_target_is".into(), json!(known));
    }
    out
}

fn point(p: &Point) -> Value {
    let runs: Vec<Value> = p
        .costs
        .iter()
        .map(|c| {
            json!({
                "samples": c.samples,
                "rays": c.rays,
                "rejected": c.rejected,
                "seconds": c.seconds,
                "cpu_seconds": c.cpu_seconds,
            })
        })
        .collect();
    let mut out = json!({
        "spp": p.spp,
        "runs": runs,
        "not_finite": p.not_finite,
        "median_seconds": p.median_cost(Axis::Seconds),
        "median_cpu_seconds": p.median_cost(Axis::CpuSeconds),
    });
    if let Value::Object(map) = &mut out {
        for (name, metric) in METRICS {
            let numbers = json!({
                "measured": measured(p.error(metric)),
                "of_each_run": p.errors_of_runs(metric),
                "corrected": measured(p.corrected(metric)),
                "variance": measured(p.variance(metric)),
                "bias_squared": measured(p.bias_squared(metric)),
                "limited_by_reference": p.is_limited_by_reference(metric),
                "efficiency_seconds": measured(p.efficiency(metric, Axis::Seconds)),
                "efficiency_cpu_seconds": measured(p.efficiency(metric, Axis::CpuSeconds)),
            });
            map.insert(name.into(), numbers);
        }
    }
    out
}
