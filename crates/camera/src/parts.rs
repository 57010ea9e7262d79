use etendue_core::UVec2;

use crate::planes::PlaneSums;
use crate::tile::{Tile, TileRect};
use crate::{Film, FilmError, Ids, Planes};

/// The integers that a film is, for a file format to keep. Vectors go pixel by pixel, row by row from the top;
/// planes that are not kept are empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FilmParts {
    /// Sums of radiance in units of 2⁻⁶⁴: red, green, blue of each replicate of each pixel.
    pub sums: Vec<[i128; 3]>,
    /// Samples drawn, for each replicate of each pixel.
    pub counts: Vec<u64>,
    /// Sums of albedo in units of 2⁻⁶⁴.
    pub albedo: Vec<[i128; 3]>,
    /// Sums of shading normals in units of 2⁻⁶⁴.
    pub normal: Vec<[i128; 3]>,
    /// Sums of distances in units of 2⁻⁶⁴ m.
    pub depth: Vec<i128>,
    /// Samples behind each sum of distances.
    pub hits: Vec<u64>,
    /// Sums of alpha in units of 2⁻⁶⁴.
    pub alpha: Vec<i128>,
    /// The surface that the pixel's lowest sample index met, with that index.
    pub ids: Vec<Option<(u64, Ids)>>,
}

/// [`FilmParts`] of a film that keeps them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilmView<'a> {
    /// As [`FilmParts::sums`].
    pub sums: &'a [[i128; 3]],
    /// As [`FilmParts::counts`].
    pub counts: &'a [u64],
    /// As [`FilmParts::albedo`].
    pub albedo: &'a [[i128; 3]],
    /// As [`FilmParts::normal`].
    pub normal: &'a [[i128; 3]],
    /// As [`FilmParts::depth`].
    pub depth: &'a [i128],
    /// As [`FilmParts::hits`].
    pub hits: &'a [u64],
    /// As [`FilmParts::alpha`].
    pub alpha: &'a [i128],
    /// As [`FilmParts::ids`].
    pub ids: &'a [Option<(u64, Ids)>],
}

impl Film {
    /// All integers of the film, to be kept outside; [`Film::from_parts`] takes them back.
    pub fn view(&self) -> FilmView<'_> {
        let p = &self.all.planes;
        FilmView {
            sums: &self.all.sums,
            counts: &self.all.counts,
            albedo: &p.albedo,
            normal: &p.normal,
            depth: &p.depth,
            hits: &p.hits,
            alpha: &p.alpha,
            ids: &p.ids,
        }
    }

    /// The film whose integers these are: equal, with an equal digest, to the one that they were taken from.
    ///
    /// # Errors
    /// No pixels or replicates; a vector of another length than size, replicates and planes say; more samples than
    /// 64 bits count.
    pub fn from_parts(
        size: UVec2,
        replicates: u32,
        planes: Planes,
        parts: FilmParts,
    ) -> Result<Self, FilmError> {
        if size.x == 0 || size.y == 0 || replicates == 0 {
            return Err(FilmError::Empty(size.x, size.y, replicates));
        }
        let rect = TileRect { lo: UVec2::ZERO, hi: size };
        let pixels = rect.pixels();
        let cells =
            pixels.checked_mul(replicates as usize).ok_or(FilmError::TooLarge(size.x, size.y, replicates))?;
        let FilmParts { sums, counts, albedo, normal, depth, hits, alpha, ids } = parts;
        let n = |kept: bool| if kept { pixels } else { 0 };
        let lengths = [
            ("sums", sums.len(), cells),
            ("counts", counts.len(), cells),
            ("albedo", albedo.len(), n(planes.albedo)),
            ("normal", normal.len(), n(planes.normal)),
            ("depth", depth.len(), n(planes.depth)),
            ("hits", hits.len(), n(planes.depth)),
            ("alpha", alpha.len(), n(planes.alpha)),
            ("ids", ids.len(), n(planes.ids)),
        ];
        for (part, found, expected) in lengths {
            if found != expected {
                return Err(FilmError::Length { part, found, expected });
            }
        }
        if !countable(&counts) || !countable(&hits) {
            return Err(FilmError::Samples);
        }
        let planes_kept = PlaneSums { albedo, normal, depth, hits, alpha, ids };
        Ok(Self { size, planes, all: Tile { rect, replicates, sums, counts, planes: planes_kept } })
    }
}

fn countable(counts: &[u64]) -> bool {
    counts.iter().try_fold(0u64, |sum, &n| sum.checked_add(n)).is_some()
}
