//! Where the tables come from, and that they are what integration gives.

use std::fmt::Write;

use super::tables::{MISSING, SCHLICK};
use super::{AlbedoRow, FIRST_ROOT, MEANS, NODES};
use crate::Ggx;

/// `1 − E` and `B` by the midpoint rule over the numbers that draw visible normals (Dupuy & Benyoub 2023). What is
/// missing is summed itself, not found as a difference from 1.
fn integrate(mu: f64, alpha: f64, n: u32) -> (f64, f64) {
    let sin = (1.0 - mu * mu).max(0.0).sqrt();
    let to = (sin * sin * alpha * alpha + mu * mu).sqrt();
    let (wx, wz) = (sin * alpha / to, mu / to);
    let (mut missing, mut grazing) = (0.0, 0.0);
    for j in 0..n {
        // Half of the turn mirrors the other.
        let phi = std::f64::consts::PI * (f64::from(j) + 0.5) / f64::from(n);
        for i in 0..n {
            // u = 1 − v⁴: of nearly smooth surfaces a sliver at the end, about alpha² wide, is all that gets lost.
            let v = (f64::from(i) + 0.5) / f64::from(n);
            let (from_top, weight) = ((1.0 - v.powi(4)) * (1.0 + wz), 4.0 * v.powi(3));
            let radius = (from_top * (2.0 - from_top)).max(0.0).sqrt();
            let m = [(radius * phi.cos() + wx) * alpha, radius * phi.sin() * alpha, 1.0 - from_top + wz];
            let length = (m[0] * m[0] + m[1] * m[1] + m[2] * m[2]).sqrt();
            let [mx, my, mz] = m.map(|c| c / length);
            let c = sin * mx + mu * mz;
            let [x, y, z] = [2.0 * c * mx - sin, 2.0 * c * my, 2.0 * c * mz - mu];
            // A NaN, of a normal without length, is as good as below the horizon.
            if !(z > 0.0 && c > 0.0) {
                missing += weight;
                continue;
            }
            let flat = (x * x + y * y) * alpha * alpha;
            let ti = (flat + z * z).sqrt();
            // 1 − G2/G1 without cancellation.
            let lost = mu * flat / ((ti + z) * (to * z + ti * mu));
            missing += lost * weight;
            grazing += (1.0 - lost) * (1.0 - c).powi(5) * weight;
        }
    }
    let n2 = f64::from(n) * f64::from(n);
    (missing / n2, grazing / n2)
}

fn alpha_of(row: usize, rows: usize) -> f64 {
    let root = f64::from(FIRST_ROOT) + (1.0 - f64::from(FIRST_ROOT)) * row as f64 / (rows - 1) as f64;
    root.powi(4)
}

/// Both tables' entries at a row and column.
fn entry(row: usize, column: usize, n: u32) -> (f64, f64) {
    let (alpha, s) = (alpha_of(row, NODES), column as f64 / (NODES - 1) as f64);
    let mu = (s * s * alpha / (1.0 + alpha - s * s)).min(1.0);
    let missing = integrate(mu, alpha, n).0.sqrt();
    let (lost, grazing) = integrate(s.powi(4), alpha, n);
    (if column == 0 { 0.0 } else { missing }, 1.0 - (grazing / (1.0 - lost)).powf(0.2))
}

/// Means of the tables as they are interpolated, so that what a direction loses and what all lose fit together.
fn means(ggx: Ggx) -> (f64, f64) {
    let row = AlbedoRow::new(ggx);
    let n = 20_000;
    let (mut missing, mut grazing) = (0.0, 0.0);
    for i in 0..n {
        // The weight 2μ dμ, with the places crowded near grazing: μ = t⁴.
        let t = (f64::from(i) + 0.5) / f64::from(n);
        let (mu, weight) = (t.powi(4), 8.0 * t.powi(7) / f64::from(n));
        let a = row.toward(mu as f32);
        missing += f64::from(a.missing) * weight;
        grazing += f64::from(a.grazing) * weight;
    }
    (missing, grazing)
}

fn ggx(alpha: f64) -> Ggx {
    Ggx::anisotropic(alpha as f32, alpha as f32)
}

/// A quarter of the entries, recomputed: equal to a thousandth (the printed digits, and a coarser integration).
#[test]
fn tables_are_what_integration_gives() {
    for row in 0..NODES {
        for column in (row % 4..NODES).step_by(4) {
            let (missing, schlick) = entry(row, column, 192);
            // Near the normal the cosine is the root of a vanishing number: compared is the weight.
            let weight = |cos: f64| (1.0 - cos).powi(5);
            let off = [
                f64::from(MISSING[row][column]) - missing,
                weight(f64::from(SCHLICK[row][column])) - weight(schlick),
            ];
            assert!(off.iter().all(|o| o.abs() < 1e-3), "row {row}, column {column}: {off:?}");
        }
    }
}

/// Between the rows too: the mean is that of what the tables say of directions, relative to what is missing.
#[test]
fn means_are_those_of_the_tables() {
    for i in 0..=100 {
        let alpha = (0.1 + 0.9 * f64::from(i) / 100.0).powi(4);
        let (row, (missing, grazing)) = (AlbedoRow::new(ggx(alpha)).mean(), means(ggx(alpha)));
        assert!((f64::from(row.missing) / missing - 1.0).abs() < 3e-3, "alpha {alpha}: {row:?} {missing}");
        assert!((f64::from(row.grazing) - grazing).abs() < 2e-4, "alpha {alpha}: {row:?} {grazing}");
    }
}

/// Between the nodes, down to a thousandth of a radian above the horizon: within 0.25 % of all light.
#[test]
fn between_the_nodes_tables_are_near() {
    let mut worst = [0.0f64; 2];
    for i in 0..20 {
        let alpha = (0.1 + 0.9 * (f64::from(i) + 0.5) / 20.0).powi(4);
        for l in 0..24 {
            let mu = 10f64.powf(-3.0 + 3.0 * (f64::from(l) + 0.5) / 24.0);
            let (row, (missing, grazing)) =
                (AlbedoRow::new(ggx(alpha)).toward(mu as f32), integrate(mu, alpha, 256));
            worst[0] = worst[0].max((f64::from(row.missing) - missing).abs());
            worst[1] = worst[1].max((f64::from(row.grazing) - grazing).abs());
        }
    }
    assert!(worst.iter().all(|w| *w < 2.5e-3), "{worst:?}");
}

/// `cargo test --release -p etendue-bsdf print_tables -- --ignored --nocapture > crates/bsdf/src/albedo/tables.rs` with
/// the test runner's own lines taken out; twice, since the means are those of the tables compiled in.
#[test]
#[ignore = "writes the source"]
fn print_tables() {
    let mut out = String::from(
        "//! Made by `print_tables` in `generate.rs`, which says how; not written by hand.\n\nuse super::{MEANS, NODES};\n",
    );
    let mut both = [vec![], vec![]];
    for row in 0..NODES {
        for column in 0..NODES {
            let (missing, schlick) = entry(row, column, 512);
            both[0].push(missing);
            both[1].push(schlick);
        }
    }
    let names = ["MISSING", "SCHLICK"];
    let what = ["Root of what single scattering loses", "Cosine of Schlick's mean weight"];
    for ((table, name), what) in both.iter().zip(names).zip(what) {
        let _ = write!(out, "\n/// {what}: rows of alpha, columns of the cosine.\n#[rustfmt::skip]\n");
        let _ = writeln!(out, "pub(super) const {name}: [[f32; NODES]; NODES] = [");
        for row in table.chunks(NODES) {
            out.push_str("    [\n");
            for half in row.chunks(NODES / 2) {
                let line: Vec<String> = half.iter().map(|v| format!("{v:.7},")).collect();
                let _ = writeln!(out, "        {}", line.join(" "));
            }
            out.push_str("    ],\n");
        }
        out.push_str("];\n");
    }
    let alphas = (0..MEANS).map(|row| alpha_of(row, MEANS));
    let rows: Vec<_> = alphas.map(|alpha| (alpha, means(ggx(alpha)))).collect();
    let columns: [Vec<f64>; 2] = [
        rows.iter().map(|(alpha, (missing, _))| missing.sqrt() / alpha).collect(),
        rows.iter().map(|(_, (_, grazing))| *grazing).collect(),
    ];
    let what = ["Root of the mean loss, over alpha", "Mean factor of F90"];
    for ((column, name), what) in columns.iter().zip(["MISSING_MEAN", "SCHLICK_MEAN"]).zip(what) {
        let _ = write!(
            out,
            "\n/// {what}: by row.\n#[rustfmt::skip]\npub(super) const {name}: [f32; MEANS] = [\n"
        );
        for part in column.chunks(NODES / 2) {
            let line: Vec<String> = part.iter().map(|v| format!("{v:.7},")).collect();
            let _ = writeln!(out, "    {}", line.join(" "));
        }
        out.push_str("];\n");
    }
    println!("{out}");
}
