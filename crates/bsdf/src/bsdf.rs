use etendue_core::{Spectrum, Vec3A};

use crate::BsdfAt;

/// What is carried backward along the path: the non-symmetry of refraction and of shading normals depends on it
/// (Veach 1997, chapter 5).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Paths from the camera: transmission is scaled by 1/eta².
    Radiance,
    /// Paths from the lights.
    Importance,
}

bitflags::bitflags! {
    /// What kinds of scattering a BSDF holds, or which of them a sample took.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Lobes: u32 {
        /// Light stays on its side.
        const REFLECTION = 1 << 0;
        /// Light changes sides.
        const TRANSMISSION = 1 << 1;
        /// Spread over the whole hemisphere.
        const DIFFUSE = 1 << 2;
        /// Spread over a lobe.
        const GLOSSY = 1 << 3;
        /// A single direction: `eval` and `pdf` are zero there.
        const DELTA = 1 << 4;
        /// `f(wo, wi) = f(wi, wo)` up to eta².
        const RECIPROCAL = 1 << 5;
    }
}

/// A direction drawn from a BSDF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Unit direction the light comes from, local frame.
    pub wi: Vec3A,
    /// `f·|cos θi| / pdf`, finished: the throughput is multiplied by this and nothing else.
    pub weight: Spectrum,
    /// Density per solid angle, sr⁻¹; for a delta lobe the probability of having chosen it.
    pub pdf: f32,
    /// The lobe taken: one of REFLECTION/TRANSMISSION with one of DIFFUSE/GLOSSY/DELTA.
    pub lobe: Lobes,
    /// Relative index ηt/ηi that a transmitted ray crossed; 1 otherwise.
    pub eta: f32,
}

/// What a BSDF says at one vertex: its value toward a light and a sample of its own, in one call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// `f·|cos θi|` toward the light asked for; black without one.
    pub eval: Spectrum,
    /// Density of having sampled that direction, sr⁻¹.
    pub pdf: f32,
    /// A direction drawn.
    pub sample: Option<BsdfSample>,
}

/// A bidirectional scattering distribution function at one point.
///
/// Local frame: `z` is the shading normal; `wo` points to where light leaves, `wi` to where it comes from, both away
/// from the surface and unit. Any value of the directions is legal input and yields a finite result.
/// `check_bsdf` of `etendue-testkit` tests any implementation.
pub trait Bsdf: Send + Sync {
    /// All lobes held.
    fn lobes(&self) -> Lobes;

    /// `f·|cos θi|`, sr⁻¹; zero for delta lobes.
    fn eval(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> Spectrum;

    /// Density with which [`Bsdf::sample`] draws `wi`, sr⁻¹; zero for delta lobes. It may integrate to less than 1
    /// where samples fail.
    fn pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> f32;

    /// Draws `wi`; `None` where the attempt carries nothing. `u_lobe` chooses among lobes, `u` the direction; both
    /// in `[0, 1)`.
    fn sample(&self, wo: Vec3A, u_lobe: f32, u: etendue_core::Vec2, mode: Mode) -> Option<BsdfSample>;

    /// [`Bsdf::eval`] and [`Bsdf::pdf`] at once.
    fn eval_pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> (Spectrum, f32) {
        (self.eval(wo, wi, mode), self.pdf(wo, wi, mode))
    }

    /// One call a vertex: the value toward a light and a sample.
    fn scatter(
        &self,
        wo: Vec3A,
        toward_light: Option<Vec3A>,
        u_lobe: f32,
        u: etendue_core::Vec2,
        mode: Mode,
    ) -> Scatter {
        let (eval, pdf) = toward_light.map_or((Spectrum::BLACK, 0.0), |wi| self.eval_pdf(wo, wi, mode));
        Scatter { eval, pdf, sample: self.sample(wo, u_lobe, u, mode) }
    }

    /// Directional-hemispherical reflectance plus transmittance toward `wo`; an estimate that only auxiliary images,
    /// roulette and radiosity use. The default is the mean weight of a fixed 4 × 4 grid of samples.
    fn albedo(&self, wo: Vec3A) -> Spectrum {
        let mut sum = Spectrum::BLACK;
        for i in 0..16u32 {
            let u = etendue_core::Vec2::new((i % 4) as f32 * 0.25 + 0.125, (i / 4) as f32 * 0.25 + 0.125);
            let u_lobe = ((i * 7 + 3) % 16) as f32 / 16.0 + 1.0 / 32.0;
            if let Some(s) = self.sample(wo, u_lobe, u, Mode::Importance) {
                sum += s.weight;
            }
        }
        sum / 16.0
    }

    /// The single directions into which light is scattered: at most one reflected and one transmitted. Each weight is
    /// that of the whole lobe, `pdf` is 1: nothing has been drawn.
    ///
    /// For tracing all of them (Whitted 1980). The default asks [`Bsdf::sample`] with 66 numbers for the lobe, so it finds
    /// what is drawn with a probability of 1/64 or more, or at either end; a BSDF with rarer ones says them itself.
    fn delta_lobes(&self, wo: Vec3A, mode: Mode) -> [Option<BsdfSample>; 2] {
        if !self.lobes().contains(Lobes::DELTA) {
            return [None; 2];
        }
        let among = (0..64).map(|i| (i as f32 + 0.5) / 64.0);
        delta_lobes_among(self, wo, mode, among.chain(ENDS))
    }

    /// `f·|cos θi|` split into diffuse reflected, glossy reflected, diffuse transmitted and glossy transmitted, for
    /// path expressions. The default puts all of it into the class that [`Bsdf::lobes`] and the sides imply.
    fn eval_classes(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> [Spectrum; 4] {
        let mut out = [Spectrum::BLACK; 4];
        let transmitted = wo.z * wi.z < 0.0;
        let glossy = !self.lobes().contains(Lobes::DIFFUSE);
        out[usize::from(transmitted) * 2 + usize::from(glossy)] = self.eval(wo, wi, mode);
        out
    }

    /// The form in which the integrator holds it: a built-in returns itself by value, a user's type the one line
    /// `BsdfAt::Ref(self)`.
    fn at(&self) -> BsdfAt<'_>;
}

/// The least and the greatest number that chooses a lobe.
pub(crate) const ENDS: [f32; 2] = [0.0, 1.0 - f32::EPSILON / 2.0];

/// [`Bsdf::delta_lobes`] by what a BSDF draws for these choices of a lobe.
pub(crate) fn delta_lobes_among<B: Bsdf + ?Sized>(
    bsdf: &B,
    wo: Vec3A,
    mode: Mode,
    choices: impl IntoIterator<Item = f32>,
) -> [Option<BsdfSample>; 2] {
    let mut out = [None; 2];
    for u_lobe in choices {
        let drawn = bsdf.sample(wo, u_lobe, etendue_core::Vec2::splat(0.5), mode);
        if let Some(s) = drawn.filter(|s| s.lobe.contains(Lobes::DELTA)) {
            let at = usize::from(s.lobe.contains(Lobes::TRANSMISSION));
            out[at] = Some(BsdfSample { weight: s.weight * s.pdf, pdf: 1.0, ..s });
        }
    }
    out
}
