//! Spherical cavities of Lambert walls, closed but for a round opening in the macroscopic plane: from any point of a
//! sphere all its area elements receive alike, so light that has been scattered falls on the wall again with the
//! probability F, the part of the sphere that is wall, wherever it is; and leaves with 1 − F. Of light that enters,
//! however it does, ρ (1 − F) Σ (ρF)ᵏ = ρ (1 − F) / (1 − ρF) leaves: the integrating sphere (Sumpner 1892; Walsh 1958,
//! "Photometry"). All orders of scattering are in it.

use std::f32::consts::FRAC_PI_2;
use std::f64::consts::PI;

use etendue_core::{Aabb, Ray, Spectrum, Vec3A};
use etendue_geometry::{Geometry, Shape, ShapeHit, Sphere, Surface};
use etendue_material::Diffuse;
use etendue_measure::gonio::{Gonioreflectometer, Specimen, Spot, measure_albedo, measure_brdf};

use super::support::{SEEDS, covers, direction, held};

/// The part of a sphere beneath z = 0.
struct Bowl(Sphere);

impl Shape for Bowl {
    fn bounds(&self) -> Aabb {
        self.0.bounds()
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let mut ray = *ray;
        for _ in 0..2 {
            let hit = self.0.intersect(&ray)?;
            if self.0.surface(&ray, &hit).p.z <= 0.0 {
                return Some(hit);
            }
            ray.t_min = hit.t.next_up();
        }
        None
    }

    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        self.0.surface(ray, hit)
    }
}

/// A cavity of a sphere of radius 1, `wall` of whose area is there; the spot is its opening.
fn cavity(rho: f32, wall: f64) -> Specimen<'static> {
    // The area of a cap is in proportion to its depth.
    let center = 1.0 - 2.0 * wall;
    let opening = (1.0 - center * center).sqrt() as f32;
    Specimen::new(Spot::disc(Vec3A::ZERO, Vec3A::Z, opening), move |b| {
        let m = b.material(Diffuse::new(Spectrum::gray(rho)));
        let sphere = Sphere::new(Vec3A::new(0.0, 0.0, center as f32), 1.0).unwrap();
        b.add(Geometry::open(Bowl(sphere)), m);
    })
}

fn by(seed: u64, detector: f32) -> Gonioreflectometer {
    Gonioreflectometer { samples: 128, runs: 8, seed, detector, ..Gonioreflectometer::default() }
}

/// Under a sky, seen from one direction; and under a beam, gathered from all. The mutants: a wall that lights itself
/// once only, a flat sheet, and one that knows nothing of the wall's own light.
#[test]
fn cavities_return_what_an_integrating_sphere_does() {
    for (rho, wall) in [(0.5f32, 0.2), (0.8, 0.5), (0.8, 0.9), (0.98, 0.9)] {
        let specimen = cavity(rho, wall);
        let r = f64::from(rho);
        let truth = r * (1.0 - wall) / (1.0 - r * wall);
        let single = r * (1.0 - wall);
        let truths = [truth, single * (1.0 + r * wall), r, single];
        for theta in [0.0f32, 50.0] {
            let w = direction(theta, 25.0);
            let sky = held(|seed| measure_albedo(&specimen, w, &by(seed, 0.0)).unwrap()[2], &truths);
            let gathered =
                |seed| measure_brdf(&specimen, w, Vec3A::Z, &by(seed, FRAC_PI_2)).unwrap().rgb[2].times(PI);
            let beam = held(gathered, &truths);
            println!("albedo {rho}, wall {wall}, {theta}°: sky {sky:?}, beam {beam:?} of {SEEDS}");
            for hits in [sky, beam] {
                assert!(covers(hits[0]), "albedo {rho}, wall {wall}, {theta}°: {hits:?}");
                for (&hits, mutant) in hits.iter().zip(truths).skip(1) {
                    // Where it is less than 4 % off, these intervals cannot tell.
                    let far = (mutant / truth - 1.0).abs() > 0.04;
                    assert!(!far || !covers(hits), "mutant {mutant} passes for {truth}: {hits} of {SEEDS}");
                }
            }
        }
    }
}

/// The furnace: what enters a white cavity leaves it, after ten bounces in the mean.
#[test]
fn white_cavities_keep_nothing() {
    let specimen = cavity(1.0, 0.9);
    for theta in [0.0f32, 70.0] {
        let read = |seed| measure_albedo(&specimen, direction(theta, 0.0), &by(seed, 0.0)).unwrap()[0];
        let hits = held(read, &[1.0, 0.9]);
        println!("{theta}°: {hits:?} of {SEEDS}, {:?}", read(0));
        assert!(covers(hits[0]) && !covers(hits[1]), "{theta}°: {hits:?}");
    }
}
