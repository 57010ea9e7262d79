use etendue_core::{Spectrum, Vec2, Vec3A};

use crate::bsdf::{ENDS, delta_lobes_among};
use crate::fresnel::{Interface, relative_eta};
use crate::mirror::reflect_about_z;
use crate::{Bsdf, BsdfAt, BsdfSample, Lobes, Mode};

/// A smooth boundary between two transparent media: clear glass, a water surface. Both lobes are delta.
///
/// The interior is on the side that the normal points away from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothDielectric {
    /// Refractive index of the interior over that of the exterior. A value that is not positive counts as 1.
    pub eta: f32,
    /// Factor on what gets through, each channel in `[0, 1]`; [`Spectrum::ONE`] for clear glass.
    pub tint: Spectrum,
}

impl SmoothDielectric {
    /// A boundary; 1.5 is window glass, 1.33 water.
    pub fn new(eta: f32) -> Self {
        Self { eta, tint: Spectrum::ONE }
    }
}

impl Bsdf for SmoothDielectric {
    fn lobes(&self) -> Lobes {
        Lobes::REFLECTION | Lobes::TRANSMISSION | Lobes::DELTA | Lobes::RECIPROCAL
    }

    #[inline]
    fn eval(&self, _wo: Vec3A, _wi: Vec3A, _mode: Mode) -> Spectrum {
        Spectrum::BLACK
    }

    #[inline]
    fn pdf(&self, _wo: Vec3A, _wi: Vec3A, _mode: Mode) -> f32 {
        0.0
    }

    #[inline]
    fn sample(&self, wo: Vec3A, u_lobe: f32, _u: Vec2, mode: Mode) -> Option<BsdfSample> {
        let eta = relative_eta(self.eta, wo.z);
        let (x, y, z) = (f64::from(wo.x), f64::from(wo.y), f64::from(wo.z.abs()));
        let length2 = x * x + y * y + z * z;
        if !(z > 0.0 && length2.is_finite()) {
            return None;
        }
        // Sine and cosine each from their own components: exact at grazing incidence and past a not quite unit wo.
        let wide = f64::from(eta);
        let interface = Interface::new(z / length2.sqrt(), (x * x + y * y) / length2, wide);
        let reflectance = interface.reflectance as f32;
        if u_lobe < reflectance {
            return reflect_about_z(wo, Spectrum::ONE, reflectance);
        }
        let shrink = 1.0 / (wide * length2.sqrt());
        let wi =
            Vec3A::new((-x * shrink) as f32, (-y * shrink) as f32, (interface.cos_t as f32).copysign(-wo.z));
        if wi.z == 0.0 {
            return None;
        }
        let weight = match mode {
            Mode::Radiance => self.tint * (1.0 / (eta * eta)),
            Mode::Importance => self.tint,
        };
        let lobe = Lobes::TRANSMISSION | Lobes::DELTA;
        Some(BsdfSample { wi, weight, pdf: 1.0 - reflectance, lobe, eta })
    }

    fn albedo(&self, wo: Vec3A) -> Spectrum {
        if self.tint == Spectrum::ONE {
            return Spectrum::ONE;
        }
        let reflectance = Interface::from_cos(wo.z, relative_eta(self.eta, wo.z)).reflectance as f32;
        self.tint.lerp(Spectrum::ONE, if reflectance >= 0.0 { reflectance } else { 0.0 })
    }

    fn delta_lobes(&self, wo: Vec3A, mode: Mode) -> [Option<BsdfSample>; 2] {
        delta_lobes_among(self, wo, mode, ENDS)
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::SmoothDielectric(*self)
    }
}
