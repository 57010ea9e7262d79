use std::f32::consts::{FRAC_1_PI, TAU};
use std::f64::consts::PI;

use etendue_core::math::{self, wide};
use etendue_core::{Fingerprint, Needs, Ray, Spectrum, Vec2, Vec3A};
use etendue_geometry::Surface;
use etendue_sampling::{Distribution2d, DistributionError};
use etendue_texture::{Filter, ImageTexture, Texture, Wrap};

use crate::emitter::{infinite_power, is_behind, positive};
use crate::{EnvironmentError, Light, LightBounds, LightSample, LitPoint};

/// An equirectangular image of the surrounding world.
///
/// Direction `d` looks at `u = atan2(d.x, −d.z) / 2π` (wrapped) and `v = acos(d.y) / π`: the middle of the left edge is
/// −Z, the top row +Y. Bilinear, wrapping in `u`, clamped in `v`; negative radiance counts as 0.
///
/// Directions are drawn cell by cell in proportion to the average radiance there (as interpolated, so that no cell into
/// which a bright neighbour leaks is left out), and within a cell uniformly in solid angle, which needs no special care
/// at the poles.
#[derive(Debug)]
pub struct ImageEnvironment {
    image: ImageTexture,
    scale: f32,
    rotation: f32,
    /// What the rotation adds to `u`.
    turns: f32,
    /// `None` for an image without light.
    table: Option<Distribution2d>,
    /// Cosine at the upper edge of each row, and at the lower one of the last.
    edges: Vec<f64>,
    /// ∫ L dω, W·m⁻².
    integral: Spectrum,
}

impl ImageEnvironment {
    /// The world of an image (radiance in W·m⁻²·sr⁻¹, times `scale`), turned by `rotation` radians around +Y,
    /// counter-clockwise as seen from above. The image's own wrap and filter are not used.
    ///
    /// # Errors
    /// [`EnvironmentError`] where a parameter is not usable.
    pub fn new(image: ImageTexture, scale: f32, rotation: f32) -> Result<Self, EnvironmentError> {
        if !(scale >= 0.0 && scale.is_finite()) {
            return Err(EnvironmentError::Scale { scale });
        }
        if !rotation.is_finite() {
            return Err(EnvironmentError::Rotation { rotation });
        }
        let image = image.with_wrap(Wrap::Repeat, Wrap::Clamp).with_filter(Filter::Bilinear);
        let (width, height) = (image.width() as usize, image.height() as usize);
        let edges: Vec<f64> = (0..=height).map(|j| wide::sin_cos(PI * j as f64 / height as f64).1).collect();
        let cells = Cells::new(&image, &edges);
        let table = match Distribution2d::new(&cells.weights, width, height) {
            Ok(table) => Some(table),
            Err(DistributionError::AllZero) => None,
            Err(e) => return Err(e.into()),
        };
        let turns = (f64::from(rotation) / (2.0 * PI)) as f32;
        Ok(Self { image, scale, rotation, turns, table, edges, integral: cells.integral * scale })
    }

    /// The image.
    pub fn image(&self) -> &ImageTexture {
        &self.image
    }

    /// Radiance arriving from the unit direction `d`, W·m⁻²·sr⁻¹.
    #[inline]
    pub fn radiance(&self, d: Vec3A) -> Spectrum {
        self.radiance_at(self.uv(d))
    }

    #[inline]
    fn radiance_at(&self, uv: Vec2) -> Spectrum {
        let v = self.image.eval4(uv);
        positive(Spectrum::rgb(v.x, v.y, v.z)) * self.scale
    }

    /// Where in the image a direction looks. The polar angle comes from an arc tangent: near the poles the cosine alone
    /// has no digits left.
    #[inline]
    fn uv(&self, d: Vec3A) -> Vec2 {
        let u = math::atan2(d.x, -d.z) * (1.0 / TAU) + self.turns;
        let v = math::atan2((d.x * d.x + d.z * d.z).sqrt(), d.y) * FRAC_1_PI;
        Vec2::new(fraction(u), v)
    }

    /// Density per solid angle of the direction that looks at `uv`: that of the table over the cell's solid angle
    /// times the number of cells.
    #[inline]
    fn density_at(&self, uv: Vec2) -> f32 {
        let Some(table) = self.table.as_ref().filter(|_| self.scale > 0.0) else {
            return 0.0;
        };
        let rows = table.height();
        let row = ((f64::from(uv.y) * rows as f64) as usize).min(rows - 1);
        let (Some(upper), Some(lower)) = (self.edges.get(row), self.edges.get(row + 1)) else {
            return 0.0;
        };
        (f64::from(table.pdf(uv)) / (2.0 * PI * rows as f64 * (upper - lower))) as f32
    }
}

/// `x − ⌊x⌋`, in `[0, 1)`.
#[inline]
fn fraction(x: f32) -> f32 {
    let f = x - (x as i32) as f32;
    let f = if f < 0.0 { f + 1.0 } else { f };
    if f < 1.0 { f } else { 0.0 }
}

/// The average radiance of every cell as the bilinear filter sees it.
struct Cells {
    /// Mean of the channels times the cell's share of its column's solid angle.
    weights: Vec<f32>,
    /// ∫ L dω.
    integral: Spectrum,
}

impl Cells {
    fn new(image: &ImageTexture, edges: &[f64]) -> Self {
        let (w, h) = (image.width(), image.height());
        let texel = |x: u32, y: u32| {
            let t = image.texel(x, y);
            positive(Spectrum::rgb(t.x, t.y, t.z))
        };
        // The bilinear interpolant averages over a cell with weights 1/8, 3/4, 1/8 along either axis.
        let blend = |a: Spectrum, b: Spectrum, c: Spectrum| (a + c) * 0.125 + b * 0.75;
        let mut weights = Vec::with_capacity(w as usize * h as usize);
        let mut sum = [0.0f64; 3];
        for y in 0..h {
            let (above, below) = (y.saturating_sub(1), (y + 1).min(h - 1));
            let column = |x: u32| blend(texel(x, above), texel(x, y), texel(x, below));
            let solid_angle = match (edges.get(y as usize), edges.get(y as usize + 1)) {
                (Some(upper), Some(lower)) => 2.0 * PI / f64::from(w) * (upper - lower),
                _ => 0.0,
            };
            let (mut left, mut here) = (column(w - 1), column(0));
            for x in 0..w {
                let right = column(if x + 1 == w { 0 } else { x + 1 });
                let cell = blend(left, here, right).to_array().map(|c| f64::from(c) * solid_angle);
                for (s, c) in sum.iter_mut().zip(cell) {
                    *s += c;
                }
                let weight = (cell[0] + cell[1] + cell[2]) / 3.0;
                // Whatever shines keeps a weight that single precision can hold.
                let least = f64::from(f32::MIN_POSITIVE);
                weights.push(if weight > 0.0 && weight < least { f32::MIN_POSITIVE } else { weight as f32 });
                (left, here) = (here, right);
            }
        }
        Self { weights, integral: sum.map(|s| s as f32).into() }
    }
}

impl Light for ImageEnvironment {
    #[inline]
    fn sample(&self, at: &LitPoint, _part: u32, u: Vec2) -> Option<LightSample> {
        let s = self.table.as_ref()?.sample(u)?;
        let row = s.cell.y as usize;
        let (upper, lower) = (*self.edges.get(row)?, *self.edges.get(row + 1)?);
        let cos = upper + (lower - upper) * f64::from(s.u.y);
        let sin = ((1.0 - cos) * (1.0 + cos)).sqrt() as f32;
        let (sin_phi, cos_phi) = math::sin_cos_turns(fraction(s.p.x - self.turns));
        let wi = Vec3A::new(sin * sin_phi, cos as f32, -sin * cos_phi);
        if is_behind(at, wi) {
            return None;
        }
        // Density and radiance of the rounded direction, as they are found for any other.
        let uv = self.uv(wi);
        let (pdf, li) = (self.density_at(uv), self.radiance_at(uv));
        let fit = pdf > 0.0 && pdf.is_finite() && !li.is_black() && li.is_finite();
        fit.then_some(LightSample { wi, li, pdf, end: None, is_delta: false })
    }

    #[inline]
    fn pdf(&self, at: &LitPoint, _part: u32, wi: Vec3A, _seen: Option<&Surface>) -> f32 {
        if is_behind(at, wi) { 0.0 } else { self.density_at(self.uv(wi)) }
    }

    /// L over the sphere's cross-section π R², from every direction.
    fn power(&self, _part: u32, scene_radius: f32) -> Spectrum {
        infinite_power(self.integral, scene_radius)
    }

    fn bounds(&self, _part: u32) -> Option<LightBounds> {
        None
    }

    #[inline]
    fn escaped(&self, ray: &Ray) -> Spectrum {
        self.radiance(ray.d)
    }

    fn is_infinite(&self) -> bool {
        true
    }

    fn needs(&self) -> Needs {
        Needs::LIGHTS | Needs::ENVIRONMENT | Needs::AREA_LIGHTS
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("image environment");
        f.f32(self.scale);
        f.f32(self.rotation);
        self.image.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        let cells = self.table.as_ref().map_or(0, |t| (t.width() + 1) * t.height());
        self.image.bytes() + (cells + self.edges.len()) * size_of::<f64>()
    }
}
