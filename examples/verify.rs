//! "Test my BRDF": a part of yours through the check suites, a right one and a wrong one.
//!
//! `cargo run --release --example verify`. In a project of your own the calls stand in `#[test]` functions, with
//! `etendue-testkit` as a dev-dependency.

use std::f32::consts::PI;

use etendue::prelude::*;
use etendue::sampling::warp;
use etendue_testkit::{Budget, check_bsdf, check_sampler};

/// Lambert, with the factor that is so easily forgotten.
struct Mine {
    albedo: f32,
    /// The density of cosine sampling is cos θ / π. Without the π …
    divide_by_pi: bool,
}

impl Mine {
    fn density(&self, cos: f32) -> f32 {
        if self.divide_by_pi { cos / PI } else { cos }
    }
}

impl Bsdf for Mine {
    fn lobes(&self) -> Lobes {
        Lobes::REFLECTION | Lobes::DIFFUSE | Lobes::RECIPROCAL
    }

    fn eval(&self, wo: Vec3A, wi: Vec3A, _mode: Mode) -> Spectrum {
        if wo.z * wi.z > 0.0 { Spectrum::gray(self.albedo / PI * wi.z.abs()) } else { Spectrum::BLACK }
    }

    fn pdf(&self, wo: Vec3A, wi: Vec3A, _mode: Mode) -> f32 {
        if wo.z * wi.z > 0.0 { self.density(wi.z.abs()) } else { 0.0 }
    }

    fn sample(&self, wo: Vec3A, _u_lobe: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        let mut wi = warp::cosine(u);
        wi.z = wi.z.copysign(wo.z);
        let pdf = self.pdf(wo, wi, mode);
        let lobe = Lobes::REFLECTION | Lobes::DIFFUSE;
        (pdf > 0.0).then(|| BsdfSample { wi, weight: self.eval(wo, wi, mode) / pdf, pdf, lobe, eta: 1.0 })
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Ref(self)
    }
}

fn main() {
    let budget = Budget::default();
    for divide_by_pi in [true, false] {
        println!("my BRDF, dividing by pi: {divide_by_pi}");
        match check_bsdf(&Mine { albedo: 0.8, divide_by_pi }, &budget) {
            Ok(passed) => {
                println!("  passed {} tests, smallest p-value {:.3}", passed.tests, passed.smallest_p)
            }
            Err(failure) => println!("  failed: {failure}"),
        }
    }
    println!("the Sobol sampler");
    match check_sampler(&|seed| Sobol::new(seed, 64), &budget) {
        Ok(passed) => println!("  passed {} tests, smallest p-value {:.3}", passed.tests, passed.smallest_p),
        Err(failure) => println!("  failed: {failure}"),
    }
}
