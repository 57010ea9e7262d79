use super::kernel::{Kernel, Kernels};
use crate::CompareError;

/// What the filters along the rows make of a picture: luminance, red-green, blue-yellow twice, and the luminance
/// smoothed and differentiated once and twice.
const LINES: usize = 7;
/// What the filters along the columns then make of that.
const OUTPUTS: usize = 7;

/// The rows of a picture that the filters along the columns still need, filtered along the rows. Rows are pushed
/// from the top; beyond its border the picture goes on as at the border.
///
/// A whole picture is never kept: its filtered planes would be many times its size.
pub(super) struct Window<'k> {
    kernels: &'k Kernels,
    size: [usize; 2],
    /// Rows pushed so far.
    pushed: usize,
    /// Rows kept, each in the place of its number modulo their number.
    depth: usize,
    /// `depth` rows of [`LINES`] lines.
    lines: Vec<f32>,
    /// The row being filtered, three channels, each with its border on both sides.
    padded: [Vec<f32>; 3],
    /// The row last filtered along the columns.
    output: Vec<f32>,
}

/// A pixel as the filters see it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    /// Filtered colour, in YCxCz.
    pub(super) ycxcz: [f32; 3],
    /// How much of an edge it is.
    pub(super) edge: f32,
    /// How much of a point it is.
    pub(super) point: f32,
}

impl<'k> Window<'k> {
    /// For pictures of this size in pixels, neither 0.
    pub(super) fn new(kernels: &'k Kernels, size: [usize; 2]) -> Result<Self, CompareError> {
        let [width, height] = size;
        let radius = kernels.radius();
        let depth = height.min(2 * radius + 1);
        let row = radius.checked_mul(2).and_then(|r| r.checked_add(width));
        let padded = || zeros(row);
        Ok(Self {
            kernels,
            size,
            pushed: 0,
            depth,
            lines: zeros(width.checked_mul(LINES).and_then(|n| n.checked_mul(depth)))?,
            padded: [padded()?, padded()?, padded()?],
            output: zeros(width.checked_mul(OUTPUTS))?,
        })
    }

    /// How many rows have to be pushed before this one can be filtered along the columns.
    pub(super) fn needs(&self, y: usize) -> usize {
        (y + self.kernels.radius() + 1).min(self.size[1])
    }

    /// How many rows have been pushed.
    pub(super) fn pushed(&self) -> usize {
        self.pushed
    }

    /// Takes in the next row, in YCxCz.
    pub(super) fn push(&mut self, row: impl Iterator<Item = [f32; 3]>) {
        let (width, radius, k) = (self.size[0], self.kernels.radius(), self.kernels);
        let [luminance, red_green, blue_yellow] = &mut self.padded;
        for (x, [y, cx, cz]) in row.take(width).enumerate() {
            luminance[radius + x] = y;
            red_green[radius + x] = cx;
            blue_yellow[radius + x] = cz;
        }
        for channel in [&mut *luminance, red_green, blue_yellow] {
            let (first, last) = (channel[radius], channel[radius + width - 1]);
            channel[..radius].fill(first);
            channel[radius + width..].fill(last);
        }
        let lines = [
            (&k.luminance, &*luminance),
            (&k.red_green, red_green),
            (&k.blue_yellow[0], blue_yellow),
            (&k.blue_yellow[1], blue_yellow),
            (&k.feature[0], luminance),
            (&k.feature[1], luminance),
            (&k.feature[2], luminance),
        ];
        let start = self.pushed % self.depth * LINES * width;
        let kept = &mut self.lines[start..start + LINES * width];
        for (out, (kernel, padded)) in kept.chunks_exact_mut(width).zip(lines) {
            out.fill(0.0);
            let reach = &padded[radius - kernel.radius()..];
            for (i, weight) in kernel.weights().iter().enumerate() {
                add_scaled(out, *weight, &reach[i..]);
            }
        }
        self.pushed += 1;
    }

    /// Filters row `y` along the columns. [`Self::needs`] that many rows.
    pub(super) fn filter(&mut self, y: usize) {
        let (width, k) = (self.size[0], self.kernels);
        let (lines, depth, last) = (&self.lines, self.depth, self.size[1] - 1);
        let along = |out: &mut [f32], line: usize, kernel: &Kernel, share: f32| {
            for (i, weight) in kernel.weights().iter().enumerate() {
                let row = (y + i).saturating_sub(kernel.radius()).min(last);
                let start = (row % depth * LINES + line) * width;
                add_scaled(out, share * *weight, &lines[start..]);
            }
        };
        self.output.fill(0.0);
        for (i, out) in self.output.chunks_exact_mut(width).enumerate() {
            match i {
                0 => along(out, 0, &k.luminance, 1.0),
                1 => along(out, 1, &k.red_green, 1.0),
                2 => {
                    along(out, 2, &k.blue_yellow[0], k.blue_yellow_shares[0]);
                    along(out, 3, &k.blue_yellow[1], k.blue_yellow_shares[1]);
                }
                // Derivatives along the row, then along the column; each smoothed across.
                3 => along(out, 5, &k.feature[0], 1.0),
                4 => along(out, 4, &k.feature[1], 1.0),
                5 => along(out, 6, &k.feature[0], 1.0),
                _ => along(out, 4, &k.feature[2], 1.0),
            }
        }
    }

    /// A pixel of the row last filtered.
    pub(super) fn seen(&self, x: usize) -> Seen {
        let at = |i: usize| self.output[i * self.size[0] + x];
        let length = |i: usize| (at(i) * at(i) + at(i + 1) * at(i + 1)).sqrt();
        Seen { ycxcz: [at(0), at(1), at(2)], edge: length(3), point: length(5) }
    }
}

fn zeros(count: Option<usize>) -> Result<Vec<f32>, CompareError> {
    let count = count.ok_or(CompareError::Memory)?;
    let mut out = Vec::new();
    out.try_reserve_exact(count).map_err(|_| CompareError::Memory)?;
    out.resize(count, 0.0);
    Ok(out)
}

fn add_scaled(out: &mut [f32], weight: f32, row: &[f32]) {
    for (o, v) in out.iter_mut().zip(row) {
        *o += weight * v;
    }
}
