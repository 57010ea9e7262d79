use std::f32::consts::{FRAC_1_PI, PI};

use etendue_core::{Spectrum, Vec2, Vec3A, math, vector};

use super::{Meaning, Principled};
use crate::albedo::{Albedo, AlbedoRow, schlick_weight};
use crate::{Ggx, Lobes, Masking};

/// Reflectance of one kind of facet at normal and at grazing incidence.
#[derive(Clone, Copy)]
struct Facets {
    f0: Spectrum,
    f90: f32,
}

impl Facets {
    #[inline]
    fn at(self, weight: f32) -> Spectrum {
        self.f0 * (1.0 - weight) + Spectrum::gray(self.f90 * weight)
    }

    #[inline]
    fn albedo(self, a: Albedo) -> Spectrum {
        self.f0 * a.normal + Spectrum::gray(self.f90 * a.grazing)
    }

    /// The share that facets absorb, averaged over all directions.
    #[inline]
    fn absorbed(self) -> Spectrum {
        (Spectrum::ONE - self.f0) * (20.0 / 21.0) + Spectrum::gray((1.0 - self.f90) / 21.0)
    }

    /// Reflectance of light that bounces between facets more than once, if `e` is what they keep at a bounce: the
    /// geometric series `F² E / (1 − F (1 − E))` of the mean Fresnel term (Kulla & Conty 2017; the square is that of
    /// Hill 2018, "A multi-faceted exploration").
    #[inline]
    fn repeated(self, e: f32) -> Spectrum {
        self.absorbed().map(|lost| {
            let f = 1.0 - lost;
            f * f * e / (1.0 - f * (1.0 - e))
        })
    }
}

/// Mean of the channels, or 0 where it is no positive number.
#[inline]
pub(super) fn amount(s: Spectrum) -> f32 {
    let m = s.mean();
    if m > 0.0 { m } else { 0.0 }
}

/// What reflects of a [`Principled`] surface, the same for all directions.
#[derive(Clone, Copy)]
pub(super) struct Opaque {
    pub(super) ggx: Ggx,
    pub(super) masking: Masking,
    row: AlbedoRow,
    mean: Albedo,
    meaning: Meaning,
    /// Metal against dielectric, in `[0, 1]`.
    metal: f32,
    dielectric: Facets,
    /// Both mixed: the Fresnel term is linear in them.
    mixed: Facets,
    /// Reflectance of more than one bounce between facets, over `π (1 − E_mean)`; black for glTF.
    repeated: Spectrum,
    /// `ln(1 + 1/α²)`, where there is such light.
    span: f32,
    /// Reflectance of the layer under the dielectric facets, times its share.
    base: Spectrum,
    /// Of the channel in which the dielectric facets reflect most.
    most: f32,
    most_repeated: f32,
    /// The base's `1 / (π (1 − ρ_mean))`, or 1/π for glTF.
    base_scale: f32,
}

/// What one direction knows.
#[derive(Clone, Copy)]
pub(super) struct Toward {
    albedo: Albedo,
    /// Share of light that the dielectric facets let in, in the channel in which they let in least.
    let_in: f32,
}

impl Opaque {
    /// The share of metal in what is left when the transmitting share is taken out, and the facets.
    #[inline]
    fn metal_and_facets(p: &Principled) -> (f32, Ggx) {
        let metal = p.metallic / (1.0 - p.transmitting());
        let metal = if metal > 0.0 { metal.clamp(0.0, 1.0) } else { 0.0 };
        let floored = p.meaning == Meaning::GltfB && metal < 1.0;
        (metal, if floored { p.ggx.at_least(Principled::LEAST_ALPHA) } else { p.ggx })
    }

    /// The kinds of lobes, without all the rest.
    #[inline]
    pub(super) fn lobes(p: &Principled) -> Lobes {
        let (metal, ggx) = Self::metal_and_facets(p);
        let (f0, f90) = p.dielectric_facets();
        let shines = metal > 0.0 || f90 > 0.0 || !f0.is_black();
        let smooth = ggx.is_smooth();
        let mut lobes = Lobes::empty();
        lobes.set(Lobes::DELTA, shines && smooth);
        lobes.set(Lobes::GLOSSY, shines && !smooth);
        let repeats = shines && !smooth && p.meaning == Meaning::EnergyPreserving;
        lobes.set(Lobes::DIFFUSE, repeats || (metal < 1.0 && !p.base_color.is_black()));
        lobes
    }

    #[inline]
    pub(super) fn new(p: &Principled) -> Self {
        let gltf = p.meaning == Meaning::GltfB;
        let (metal, ggx) = Self::metal_and_facets(p);
        let dielectric = p.dielectric_facets();
        let dielectric = Facets { f0: dielectric.0, f90: dielectric.1 };
        let conductor = Facets { f0: p.base_color, f90: 1.0 };
        let mixed = Facets {
            f0: dielectric.f0.lerp(conductor.f0, metal),
            f90: dielectric.f90 * (1.0 - metal) + metal,
        };
        let row = AlbedoRow::new(ggx);
        let mean = row.mean();
        let most = dielectric.f0.max_channel();
        let mut out = Self {
            ggx,
            masking: if gltf { Masking::Separable } else { Masking::HeightCorrelated },
            row,
            mean,
            meaning: p.meaning,
            metal,
            dielectric,
            mixed,
            repeated: Spectrum::BLACK,
            span: 0.0,
            base: p.base_color * (1.0 - metal),
            most,
            most_repeated: 0.0,
            base_scale: FRAC_1_PI,
        };
        if !gltf {
            let e = 1.0 - mean.missing;
            if mean.missing > 0.0 {
                let scale = FRAC_1_PI / mean.missing;
                out.repeated = dielectric.repeated(e).lerp(conductor.repeated(e), metal) * scale;
                let a = ggx.alpha_x();
                out.span = math::ln(1.0 + 1.0 / (a * a));
            }
            out.most_repeated = Facets { f0: Spectrum::gray(most), ..dielectric }.repeated(e).r();
            let let_in = out.let_in(mean);
            out.base_scale = if let_in > 0.0 { FRAC_1_PI / let_in } else { 0.0 };
        }
        out
    }

    /// `1 − ρ` of the dielectric facets with all their bounces, as a sum of what is lost rather than a difference.
    #[inline]
    fn let_in(&self, a: Albedo) -> f32 {
        a.missing * (1.0 - self.most_repeated)
            + a.normal * (1.0 - self.most)
            + a.grazing * (1.0 - self.dielectric.f90)
    }

    #[inline]
    pub(super) fn toward(&self, mu: f32) -> Toward {
        let albedo = self.row.toward(mu);
        Toward { albedo, let_in: self.let_in(albedo) }
    }

    #[inline]
    fn has_specular(&self) -> bool {
        self.mixed.f90 > 0.0 || !self.mixed.f0.is_black()
    }

    /// Albedo of the narrow lobe toward `wo`; for glTF's separable masking an estimate that is a little high.
    #[inline]
    pub(super) fn specular_albedo(&self, wo: &Toward) -> Spectrum {
        self.mixed.albedo(wo.albedo)
    }

    /// Albedo of light that bounces between facets more than once.
    #[inline]
    pub(super) fn repeated_albedo(&self, wo: &Toward) -> Spectrum {
        self.repeated * (PI * self.mean.missing * wo.albedo.missing)
    }

    /// Albedo of the base; for glTF an estimate, by the mean Fresnel term.
    #[inline]
    pub(super) fn base_albedo(&self, wo: &Toward) -> Spectrum {
        match self.meaning {
            Meaning::GltfB => self.base * self.mixed.absorbed(),
            Meaning::EnergyPreserving => self.base * wo.let_in,
        }
    }

    /// Draws a direction for light that bounces more than once: most of it leaves at the cosines around alpha and
    /// above where facets hide each other, in proportion to about `μ / (μ² + α²)`.
    #[inline]
    pub(super) fn sample_repeated(&self, u: Vec2) -> Vec3A {
        let a2 = self.ggx.alpha_x() * self.ggx.alpha_x();
        let mu2 = (a2 * math::exp_m1(u.x * self.span)).clamp(0.0, 1.0);
        let (sin, cos) = math::sin_cos_turns(u.y);
        let radius = (1.0 - mu2).sqrt();
        Vec3A::new(radius * cos, radius * sin, mu2.sqrt())
    }

    /// Density of [`Opaque::sample_repeated`], sr⁻¹.
    #[inline]
    pub(super) fn repeated_pdf(&self, mu: f32) -> f32 {
        let a2 = self.ggx.alpha_x() * self.ggx.alpha_x();
        if self.span > 0.0 { mu / ((mu * mu + a2) * PI * self.span) } else { 0.0 }
    }

    /// Reflectance of a smooth surface.
    #[inline]
    pub(super) fn mirror(&self, cos: f32) -> Spectrum {
        self.mixed.at(schlick_weight(cos))
    }

    /// The facet between two directions above the surface.
    #[inline]
    fn facet(wo: Vec3A, wi: Vec3A) -> Option<Vec3A> {
        vector::try_normalize(wo + wi)
    }

    /// `f cos θi` of facets and base, and the narrow lobe's density, for directions above the surface.
    #[inline]
    pub(super) fn eval(&self, wo: Vec3A, wi: Vec3A, to: &Toward) -> Option<Reflected> {
        let m = Self::facet(wo, wi)?;
        let w = schlick_weight(wo.dot(m));
        let (mut specular, mut pdf) = (Spectrum::BLACK, 0.0);
        if !self.ggx.is_smooth() && self.has_specular() {
            let d = self.ggx.d(m);
            specular = self.mixed.at(w) * (d * self.ggx.reflection_term(self.masking, wo, wi));
            pdf = d * self.ggx.reflecting_term(wo);
        }
        let cos = wi.z.clamp(0.0, 1.0);
        let base = match self.meaning {
            Meaning::GltfB => {
                let metal = self.base_under_metal(w);
                self.base * metal * (self.base_scale * cos)
            }
            Meaning::EnergyPreserving => {
                let ti = self.toward(wi.z);
                specular += self.repeated * (to.albedo.missing * ti.albedo.missing * cos);
                self.base * (to.let_in * ti.let_in * self.base_scale * cos)
            }
        };
        Some(Reflected { specular, base, pdf })
    }

    /// `1 − F` of appendix B, the dielectric's part of F in its largest channel (KHR_materials_specular).
    #[inline]
    fn base_under_metal(&self, w: f32) -> Spectrum {
        let dielectric = self.most * (1.0 - w) + self.dielectric.f90 * w;
        // mixed = dielectric (1 − metal) + conductor metal
        let conductor = self.mixed.at(w) - self.dielectric.at(w) * (1.0 - self.metal);
        (Spectrum::gray(1.0 - dielectric * (1.0 - self.metal)) - conductor).map(|c| c.clamp(0.0, 1.0))
    }
}

/// Reflected light by what reflects it.
#[derive(Clone, Copy)]
pub(super) struct Reflected {
    /// By facets, once or more often.
    pub(super) specular: Spectrum,
    /// By what is under them.
    pub(super) base: Spectrum,
    /// Density of the narrow lobe.
    pub(super) pdf: f32,
}
