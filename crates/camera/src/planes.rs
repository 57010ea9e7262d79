use std::collections::TryReserveError;

use etendue_core::{Spectrum, Vec3A};

/// Which auxiliary planes (AOVs) a film keeps beside radiance. None by default: what is not asked for is neither
/// stored nor computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Planes {
    /// Albedo of the first surface, unitless.
    pub albedo: bool,
    /// Shading normal of the first surface, world space.
    pub normal: bool,
    /// Distance to the first surface, metres, averaged over the samples that hit one.
    pub depth: bool,
    /// Instance, geometry and triangle of the first surface, taken from the pixel's lowest sample index.
    pub ids: bool,
    /// Mean of the samples' alpha: the fraction that hit a surface.
    pub alpha: bool,
}

impl Planes {
    /// All of them.
    pub const ALL: Self = Self { albedo: true, normal: true, depth: true, ids: true, alpha: true };

    /// Whether any is asked for.
    pub fn any(self) -> bool {
        self.albedo || self.normal || self.depth || self.ids || self.alpha
    }
}

/// Which surface a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Ids {
    /// Instance, or `u32::MAX` for geometry that stands in the world itself.
    pub inst: u32,
    /// Geometry.
    pub geom: u32,
    /// Triangle.
    pub prim: u32,
}

/// What the auxiliary planes take from one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit {
    /// Albedo of the surface toward the camera.
    pub albedo: Spectrum,
    /// Unit shading normal, world space.
    pub normal: Vec3A,
    /// Distance along the ray, metres.
    pub depth: f32,
    /// Which surface.
    pub ids: Ids,
}

/// The sums behind the planes. Empty vectors for planes nobody asked for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct PlaneSums {
    pub(crate) albedo: Vec<[i128; 3]>,
    pub(crate) normal: Vec<[i128; 3]>,
    pub(crate) depth: Vec<i128>,
    /// Samples that hit a surface, beside their depths.
    pub(crate) hits: Vec<u64>,
    pub(crate) alpha: Vec<i128>,
    /// The lowest sample index seen so far and its ids.
    pub(crate) ids: Vec<Option<(u64, Ids)>>,
}

impl PlaneSums {
    pub(crate) fn try_new(planes: Planes, pixels: usize) -> Result<Self, TryReserveError> {
        let n = |wanted: bool| if wanted { pixels } else { 0 };
        Ok(Self {
            albedo: filled([0; 3], n(planes.albedo))?,
            normal: filled([0; 3], n(planes.normal))?,
            depth: filled(0, n(planes.depth))?,
            hits: filled(0, n(planes.depth))?,
            alpha: filled(0, n(planes.alpha))?,
            ids: filled(None, n(planes.ids))?,
        })
    }

    pub(crate) fn clear(&mut self) {
        self.albedo.fill([0; 3]);
        self.normal.fill([0; 3]);
        self.depth.fill(0);
        self.hits.fill(0);
        self.alpha.fill(0);
        self.ids.fill(None);
    }

    pub(crate) fn add_alpha(&mut self, pixel: usize, alpha: f32) {
        if let Some(a) = self.alpha.get_mut(pixel) {
            *a = a.wrapping_add(crate::fixed::to_fixed(alpha).unwrap_or(0));
        }
    }

    pub(crate) fn add(&mut self, pixel: usize, index: u64, hit: &FirstHit) {
        use crate::fixed::to_fixed;
        let add3 = |to: &mut [i128; 3], v: [f32; 3]| {
            for (t, x) in to.iter_mut().zip(v) {
                *t = t.wrapping_add(to_fixed(x).unwrap_or(0));
            }
        };
        if let Some(a) = self.albedo.get_mut(pixel) {
            add3(a, hit.albedo.to_array());
        }
        if let Some(n) = self.normal.get_mut(pixel) {
            add3(n, hit.normal.to_array());
        }
        if let Some(d) = self.depth.get_mut(pixel) {
            *d = d.wrapping_add(to_fixed(hit.depth).unwrap_or(0));
        }
        if let Some(h) = self.hits.get_mut(pixel) {
            *h += 1;
        }
        if let Some(slot) = self.ids.get_mut(pixel) {
            keep_lowest(slot, Some((index, hit.ids)));
        }
    }

    /// Adds `other`'s pixel `from` to this one's pixel `to`.
    pub(crate) fn absorb(&mut self, to: usize, other: &Self, from: usize) {
        let add3 = |a: Option<&mut [i128; 3]>, b: Option<&[i128; 3]>| {
            if let (Some(a), Some(b)) = (a, b) {
                for (a, b) in a.iter_mut().zip(b) {
                    *a = a.wrapping_add(*b);
                }
            }
        };
        add3(self.albedo.get_mut(to), other.albedo.get(from));
        add3(self.normal.get_mut(to), other.normal.get(from));
        if let (Some(a), Some(b)) = (self.depth.get_mut(to), other.depth.get(from)) {
            *a = a.wrapping_add(*b);
        }
        if let (Some(a), Some(b)) = (self.hits.get_mut(to), other.hits.get(from)) {
            *a += b;
        }
        if let (Some(a), Some(b)) = (self.alpha.get_mut(to), other.alpha.get(from)) {
            *a = a.wrapping_add(*b);
        }
        if let (Some(a), Some(b)) = (self.ids.get_mut(to), other.ids.get(from)) {
            keep_lowest(a, *b);
        }
    }
}

/// `n` times `value`, or an error instead of an abort where the memory cannot be had.
pub(crate) fn filled<T: Clone>(value: T, n: usize) -> Result<Vec<T>, TryReserveError> {
    let mut out = Vec::new();
    out.try_reserve_exact(n)?;
    out.resize(n, value);
    Ok(out)
}

/// Of two observations the one with the lower sample index: a choice that does not depend on the order.
fn keep_lowest(slot: &mut Option<(u64, Ids)>, seen: Option<(u64, Ids)>) {
    if let Some((index, _)) = seen
        && slot.is_none_or(|(kept, _)| index < kept)
    {
        *slot = seen;
    }
}
