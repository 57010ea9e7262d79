use std::path::Path;

use etendue::camera::Film;
use etendue::io::write_atomically;
use etendue::measure::{Comparison, Reference, compare};

use crate::error::CliError;
use crate::report::Totals;
use crate::session::Spent;

/// Error against cost of a render under way, one row at every power of two samples per pixel and one at the end.
pub(super) struct CurveLog<'a> {
    reference: &'a Reference,
    rows: Vec<Row>,
}

struct Row {
    spp: u64,
    samples: u64,
    rays: u64,
    spent: Spent,
    error: Comparison,
}

impl<'a> CurveLog<'a> {
    pub(super) fn new(reference: &'a Reference) -> Self {
        Self { reference, rows: Vec::new() }
    }

    /// Looks at the film if it is time to.
    pub(super) fn look(
        &mut self,
        film: &Film,
        spp: u64,
        totals: &Totals,
        spent: Spent,
        at_end: bool,
    ) -> Result<(), CliError> {
        let last = self.rows.last().map_or(0, |r| r.spp);
        if spp == last || !(at_end || spp.is_power_of_two()) {
            return Ok(());
        }
        let error = compare(&film.to_rgb(), &self.reference.rgb)?;
        self.rows.push(Row { spp, samples: totals.samples, rays: totals.rays, spent, error });
        Ok(())
    }

    /// Writes the table. The seconds are those of rendering alone; `relmse_corrected` is without the reference's own
    /// error.
    pub(super) fn write(&self, path: &Path) -> Result<(), CliError> {
        let mut text =
            "spp,samples,rays,seconds,cpu_seconds,relmse,relmse_corrected,relmse_trimmed,rmse\n".to_owned();
        for r in &self.rows {
            let Row { spp, samples, rays, spent, error } = r;
            let cpu = spent.cpu.map_or_else(String::new, |c| format!("{c:.6}"));
            text += &format!(
                "{spp},{samples},{rays},{:.6},{cpu},{:e},{:e},{:e},{:e}\n",
                spent.wall,
                error.relative_mse,
                error.relative_mse - self.reference.residual.relative,
                error.relative_mse_trimmed,
                error.rmse,
            );
        }
        Ok(write_atomically(path, text.as_bytes())?)
    }
}

/// Where to stop and look: `range` cut at powers of two.
pub(super) fn at_powers_of_two(range: std::ops::Range<u64>) -> impl Iterator<Item = std::ops::Range<u64>> {
    let mut at = range.start;
    std::iter::from_fn(move || {
        if at >= range.end {
            return None;
        }
        let end = (at + 1).next_power_of_two().min(range.end);
        let piece = at..end;
        at = end;
        Some(piece)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_end_at_powers_of_two() {
        let pieces = |r| at_powers_of_two(r).map(|p| p.end).collect::<Vec<_>>();
        assert_eq!(pieces(0..10), [1, 2, 4, 8, 10]);
        assert_eq!(pieces(3..9), [4, 8, 9]);
        assert_eq!(pieces(5..5), [0u64; 0]);
    }
}
