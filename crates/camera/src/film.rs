use etendue_core::{Fingerprint, Spectrum, UVec2, Vec3A};

use crate::fixed;
use crate::planes::{FirstHit, Ids, PlaneSums, Planes};
use crate::tile::{Tile, TileRect};

/// Why a film cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// A picture without pixels, or sums without replicates.
    #[error("a film of {0} x {1} pixels with {2} replicates holds nothing; all three must be at least 1")]
    Empty(u32, u32, u32),
    /// More memory than can be had.
    #[error("a film of {0} x {1} pixels with {2} replicates does not fit in memory")]
    TooLarge(u32, u32, u32),
    /// A vector that does not belong to a film of this size.
    #[error(
        "a film's '{part}' have {found} entries where its size asks for {expected}; they belong to another film"
    )]
    Length {
        /// Which vector.
        part: &'static str,
        /// Its length.
        found: usize,
        /// The length that size, replicates and planes ask for.
        expected: usize,
    },
    /// More samples than can be counted.
    #[error("the film's counts add up to 2^64 samples or more; they are damaged")]
    Samples,
}

/// Why two films cannot be added.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MergeError {
    /// Different picture sizes.
    #[error("the films differ in size: {}x{} and {}x{}", .0.x, .0.y, .1.x, .1.y)]
    Size(UVec2, UVec2),
    /// Different numbers of replicates.
    #[error("the films differ in replicates: {0} and {1}")]
    Replicates(u32, u32),
    /// Different auxiliary planes.
    #[error("the films keep different auxiliary planes: {0:?} and {1:?}")]
    Planes(Planes, Planes),
    /// More samples than can be counted.
    #[error("the films together hold 2^64 samples or more; one of them is damaged")]
    Samples,
}

/// The exact film: per pixel and replicate the integer sum of all samples and their number.
///
/// Adding, merging and splitting commute: any number of threads, any tile order and any division into shards gives
/// the same bits. The scatter of replicates gives an error estimate that holds for QMC samples too.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Film {
    pub(crate) size: UVec2,
    pub(crate) planes: Planes,
    pub(crate) all: Tile,
}

impl Film {
    /// A black film. `replicates` is that of the sampler; memory is 56 bytes per pixel and replicate.
    ///
    /// # Errors
    /// No pixels, no replicates, or too many for memory.
    pub fn new(size: UVec2, replicates: u32) -> Result<Self, FilmError> {
        Self::with_planes(size, replicates, Planes::default())
    }

    /// A black film that also keeps auxiliary planes.
    ///
    /// # Errors
    /// As [`Film::new`].
    pub fn with_planes(size: UVec2, replicates: u32, planes: Planes) -> Result<Self, FilmError> {
        if size.x == 0 || size.y == 0 || replicates == 0 {
            return Err(FilmError::Empty(size.x, size.y, replicates));
        }
        let rect = TileRect { lo: UVec2::ZERO, hi: size };
        let all = Tile::try_new(rect, replicates, planes)
            .map_err(|_| FilmError::TooLarge(size.x, size.y, replicates))?;
        Ok(Self { size, planes, all })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Replicates kept apart.
    pub fn replicates(&self) -> u32 {
        self.all.replicates
    }

    /// Auxiliary planes kept.
    pub fn planes(&self) -> Planes {
        self.planes
    }

    /// Adds one sample to a pixel; false where it was refused (see [`Tile::add`]) or the pixel does not exist.
    pub fn add(&mut self, pixel: UVec2, replicate: u32, l: Spectrum) -> bool {
        pixel.x < self.size.x && pixel.y < self.size.y && self.all.add(pixel, replicate, l)
    }

    /// Adds the alpha of one sample, if the plane is kept.
    pub fn add_alpha(&mut self, pixel: UVec2, alpha: f32) {
        if pixel.x < self.size.x && pixel.y < self.size.y {
            self.all.add_alpha(pixel, alpha);
        }
    }

    /// Adds what the auxiliary planes want of one sample.
    pub fn add_first_hit(&mut self, pixel: UVec2, index: u64, hit: &FirstHit) {
        if pixel.x < self.size.x && pixel.y < self.size.y {
            self.all.add_first_hit(pixel, index, hit);
        }
    }

    /// Forgets all samples and keeps the memory.
    pub fn clear(&mut self) {
        self.all.sums.fill([0; 3]);
        self.all.counts.fill(0);
        self.all.planes.clear();
    }

    /// Adds a tile's sums. Pixels outside the film are ignored.
    pub fn absorb(&mut self, tile: &Tile) {
        let r = self.all.replicates as usize;
        for (from, pixel) in tile.rect.iter().enumerate() {
            if pixel.x >= self.size.x || pixel.y >= self.size.y {
                continue;
            }
            let to = pixel.y as usize * self.size.x as usize + pixel.x as usize;
            for k in 0..(tile.replicates as usize).min(r) {
                let (a, b) = (to * r + k, from * tile.replicates as usize + k);
                for (s, t) in self.all.sums[a].iter_mut().zip(tile.sums[b]) {
                    *s = s.wrapping_add(t);
                }
                self.all.counts[a] += tile.counts[b];
            }
            self.all.planes.absorb(to, &tile.planes, from);
        }
    }

    /// Adds another film's samples. Exact: merging shards gives the bits of the whole.
    ///
    /// # Errors
    /// Different size, replicates or planes, or too many samples to count; this film is then unchanged.
    pub fn merge(&mut self, other: &Self) -> Result<(), MergeError> {
        if self.size != other.size {
            return Err(MergeError::Size(self.size, other.size));
        }
        if self.replicates() != other.replicates() {
            return Err(MergeError::Replicates(self.replicates(), other.replicates()));
        }
        if self.planes != other.planes {
            return Err(MergeError::Planes(self.planes, other.planes));
        }
        let hits = |film: &Self| film.plane().hits.iter().sum::<u64>();
        if self.total_samples().checked_add(other.total_samples()).is_none()
            || hits(self).checked_add(hits(other)).is_none()
        {
            return Err(MergeError::Samples);
        }
        self.absorb(&other.all);
        Ok(())
    }

    fn cells(&self, pixel: UVec2) -> std::ops::Range<usize> {
        if pixel.x >= self.size.x || pixel.y >= self.size.y {
            return 0..0;
        }
        let r = self.all.replicates as usize;
        let i = (pixel.y as usize * self.size.x as usize + pixel.x as usize) * r;
        i..i + r
    }

    /// Samples drawn for a pixel, rejected ones included.
    pub fn samples(&self, pixel: UVec2) -> u64 {
        self.all.counts[self.cells(pixel)].iter().sum()
    }

    /// Samples drawn for all pixels.
    pub fn total_samples(&self) -> u64 {
        self.all.counts.iter().sum()
    }

    /// The pixel's mean radiance, W·m⁻²·sr⁻¹; black before the first sample.
    pub fn mean(&self, pixel: UVec2) -> Spectrum {
        let cells = self.cells(pixel);
        let count = self.all.counts[cells.clone()].iter().sum();
        let sum = self.all.sums[cells].iter().fold([0i128; 3], |acc, s| {
            [acc[0].wrapping_add(s[0]), acc[1].wrapping_add(s[1]), acc[2].wrapping_add(s[2])]
        });
        to_spectrum(sum, count)
    }

    /// The mean of one replicate, as f64 per channel; `None` before its first sample.
    pub fn replicate_mean(&self, pixel: UVec2, replicate: u32) -> Option<[f64; 3]> {
        let cell = self.cells(pixel).nth(replicate as usize)?;
        let count = self.all.counts[cell];
        (count > 0).then(|| self.all.sums[cell].map(|s| fixed::mean(s, count)))
    }

    /// Standard error of the pixel's mean per channel from the scatter of the replicates' means; `None` with fewer
    /// than two replicates that have samples. True for any sampler whose replicates are independent.
    pub fn standard_error(&self, pixel: UVec2) -> Option<[f64; 3]> {
        let means: Vec<[f64; 3]> =
            (0..self.replicates()).filter_map(|r| self.replicate_mean(pixel, r)).collect();
        let n = means.len() as f64;
        if means.len() < 2 {
            return None;
        }
        let mut out = [0.0; 3];
        for (c, o) in out.iter_mut().enumerate() {
            let mean = means.iter().map(|m| m[c]).sum::<f64>() / n;
            let ss = means.iter().map(|m| (m[c] - mean) * (m[c] - mean)).sum::<f64>();
            *o = (ss / (n - 1.0) / n).sqrt();
        }
        Some(out)
    }

    /// All means, row by row from the top.
    pub fn to_rgb(&self) -> Vec<[f32; 3]> {
        self.pixels().map(|p| self.mean(p).to_array()).collect()
    }

    fn pixels(&self) -> impl Iterator<Item = UVec2> + use<> {
        TileRect { lo: UVec2::ZERO, hi: self.size }.iter()
    }

    fn plane(&self) -> &PlaneSums {
        &self.all.planes
    }

    fn index(&self, pixel: UVec2) -> usize {
        if pixel.x < self.size.x && pixel.y < self.size.y {
            pixel.y as usize * self.size.x as usize + pixel.x as usize
        } else {
            usize::MAX
        }
    }

    /// Mean albedo of the first surface; `None` if the plane is not kept.
    pub fn albedo(&self, pixel: UVec2) -> Option<Spectrum> {
        let s = self.plane().albedo.get(self.index(pixel))?;
        Some(to_spectrum(*s, self.samples(pixel)))
    }

    /// Mean shading normal, not renormalised; `None` if the plane is not kept.
    pub fn normal(&self, pixel: UVec2) -> Option<Vec3A> {
        let s = self.plane().normal.get(self.index(pixel))?;
        Some(Vec3A::from(to_spectrum(*s, self.samples(pixel)).to_array()))
    }

    /// Mean distance of the samples that hit a surface, metres (infinite where none did); `None` if not kept.
    pub fn depth(&self, pixel: UVec2) -> Option<f32> {
        let i = self.index(pixel);
        let s = self.plane().depth.get(i)?;
        let hits = *self.plane().hits.get(i)?;
        Some(if hits == 0 { f32::INFINITY } else { fixed::mean(*s, hits) as f32 })
    }

    /// Mean alpha of the samples: the fraction that hit a surface; `None` if the plane is not kept.
    pub fn alpha(&self, pixel: UVec2) -> Option<f32> {
        let sum = *self.plane().alpha.get(self.index(pixel))?;
        Some(fixed::mean(sum, self.samples(pixel)) as f32)
    }

    /// The surface that the pixel's first sample met; `None` if not kept or none was met.
    pub fn ids(&self, pixel: UVec2) -> Option<Ids> {
        self.plane().ids.get(self.index(pixel)).copied().flatten().map(|(_, ids)| ids)
    }

    /// A digest of every sum and count: equal films have equal digests.
    pub fn digest(&self) -> u128 {
        let mut f = Fingerprint::default();
        f.u64(u64::from(self.size.x) << 32 | u64::from(self.size.y));
        f.u64(u64::from(self.replicates()));
        f.tag(&format!("{:?}", self.planes));
        for (s, n) in self.all.sums.iter().zip(&self.all.counts) {
            for c in s {
                f.bytes(&c.to_le_bytes());
            }
            f.u64(*n);
        }
        let p = self.plane();
        for c in p.albedo.iter().chain(&p.normal).flatten().chain(&p.depth).chain(&p.alpha) {
            f.bytes(&c.to_le_bytes());
        }
        for hits in &p.hits {
            f.u64(*hits);
        }
        for (pixel, seen) in p.ids.iter().enumerate() {
            if let Some((index, ids)) = seen {
                f.u64(pixel as u64);
                f.u64(*index);
                f.u64(u64::from(ids.inst) << 32 | u64::from(ids.geom));
                f.u64(u64::from(ids.prim));
            }
        }
        f.value()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let t = &self.all;
        size_of_val(t.sums.as_slice())
            + size_of_val(t.counts.as_slice())
            + size_of_val(t.planes.albedo.as_slice())
            + size_of_val(t.planes.normal.as_slice())
            + size_of_val(t.planes.depth.as_slice())
            + size_of_val(t.planes.hits.as_slice())
            + size_of_val(t.planes.alpha.as_slice())
            + size_of_val(t.planes.ids.as_slice())
    }
}

fn to_spectrum(sum: [i128; 3], count: u64) -> Spectrum {
    let [r, g, b] = sum.map(|s| fixed::mean(s, count) as f32);
    Spectrum::rgb(r, g, b)
}
