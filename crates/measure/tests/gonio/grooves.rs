//! Symmetric V-grooves along y, as of Oren & Nayar (1994): facets of slope α beneath the macroscopic plane, ridges in
//! it. For directions in the plane across the grooves single scattering has a closed form. With `c(θ) = cos(θ − α)`:
//!
//! * Toward the normal all facets are seen alike. Beyond θi = 90° − α those that face away are dark and shadow the
//!   lower part of the others: of the width 2h, cot θi / (cot θi + tan α) is lit, with c(θi) ρ/π. Over cos θi that is
//!   ρ/π cos α at *every* θi, as reciprocity asks: lit along the normal every facet has cos α.
//! * Toward the same side and beyond 90° − α, only facets that face the light are seen. Looking more steeply than the
//!   light falls one sees dark parts too; the lit part of the seen width is the quotient of the two widths above. So
//!   f = ρ/π c(θ) / cos θ with the smaller of θi, θo.
//! * Toward the other side, both beyond it, only what faces away from the light is seen: nothing.

use std::f64::consts::PI;

use etendue_core::{Frame, Spectrum, Vec2, Vec3A};
use etendue_geometry::{Plane, Sphere, presets};
use etendue_material::{Diffuse, Metal};
use etendue_measure::gonio::{Gonioreflectometer, Specimen, Spot, measure_albedo, measure_brdf};
use etendue_scene::SceneBuilder;
use etendue_testkit::stats::welch_test;

use super::support::{SEEDS, covers, direction, held};

const RHO: f64 = 0.6;
const FLAT: Frame = Frame { x: Vec3A::X, y: Vec3A::Y, z: Vec3A::Z };
/// Grooves to either side of the one measured, of width 2.
const AROUND: i32 = 4;
const LONG: f32 = 1000.0;

/// One period of the grooves; long enough that their ends do not matter.
fn grooves<'a>(
    slope_deg: f32,
    facets: impl Fn(&mut SceneBuilder) -> [etendue_scene::MaterialId; 2] + Send + Sync + 'a,
) -> Specimen<'a> {
    let deep = f64::from(slope_deg).to_radians().tan() as f32;
    let spot = Spot::rectangle(Vec3A::ZERO, FLAT, Vec2::ONE);
    Specimen::new(spot, move |b| {
        let [facing, averted] = facets(b);
        let along = Vec3A::Y * (2.0 * LONG);
        for k in -AROUND..=AROUND {
            let bottom = Vec3A::new(2.0 * k as f32, -LONG, -deep);
            // The left wall faces +x, the right one −x.
            b.add(presets::quad(bottom, along, Vec3A::new(-1.0, 0.0, deep)), facing);
            b.add(presets::quad(bottom, Vec3A::new(1.0, 0.0, deep), along), averted);
        }
    })
}

fn matte(slope_deg: f32, rho: f64) -> Specimen<'static> {
    grooves(slope_deg, move |b| [b.material(Diffuse::new(Spectrum::gray(rho as f32))); 2])
}

fn by(seed: u64, samples: u32, max_depth: Option<u32>) -> Gonioreflectometer {
    Gonioreflectometer { samples, runs: 8, seed, max_depth, ..Gonioreflectometer::default() }
}

/// ρ/π cos(θ − α) / cos θ.
fn retro(theta: f64, slope: f64) -> f64 {
    RHO / PI * (theta - slope).to_radians().cos() / theta.to_radians().cos()
}

/// The same if no facet hid or shadowed another.
fn unmasked(ti: f64, to: f64, slope: f64) -> f64 {
    let cos = |theta: f64, side: f64| (theta - side * slope).to_radians().cos().max(0.0);
    let [facing, averted] = [1.0, -1.0].map(|side| cos(ti, side) * cos(to, side));
    // Either side has half of the plane over its own cosine.
    let facets = 0.5 * (facing + averted) / slope.to_radians().cos();
    RHO / PI * facets / (ti.to_radians().cos() * to.to_radians().cos())
}

#[test]
fn where_nothing_is_left_to_chance_grooves_read_the_closed_form() {
    for slope in [20.0f32, 45.0, 60.0] {
        let specimen = matte(slope, RHO);
        let read = |ti: f32, to: f32| {
            let (wi, wo) = (direction(ti, 0.0), direction(to, 0.0));
            measure_brdf(&specimen, wi, wo, &by(1, 64, Some(1))).unwrap().rgb[1]
        };
        let near = |m: etendue_measure::Measured, truth: f64| (m.value - truth).abs() <= 1e-5 * truth;
        let lit = RHO / PI * f64::from(slope).to_radians().cos();
        for to in [0.0, 15.0, 50.0, 80.0, -70.0] {
            assert!(near(read(0.0, to), lit), "slope {slope}, from the normal to {to}: {:?}", read(0.0, to));
        }
        for to in [72.0, 85.0] {
            for ti in [to, to + 2.0] {
                let truth = retro(f64::from(to), f64::from(slope));
                // Seen in shadow in part if the light is lower.
                let m = read(to, ti);
                assert!(near(m, truth), "slope {slope}, from {to} to {ti}: {m:?}, not {truth}");
                // The mutant without masking: both sides seen as they are lit, by their projected areas.
                assert!(!near(m, unmasked(f64::from(to), f64::from(ti), f64::from(slope))));
            }
            assert_eq!(read(to, -to).value, 0.0, "slope {slope}: the averted side is dark");
        }
    }
}

/// The light lower than the view: the edge of the shadow is seen. Intervals hold the closed form as often as they say;
/// those of an instrument that forgets shadows, or the macroscopic cosine, do not.
#[test]
fn shadows_are_covered() {
    let slope = 45.0;
    let specimen = matte(slope as f32, RHO);
    let facet = |theta: f64| RHO / PI * (theta - slope).to_radians().cos() / theta.to_radians().cos();
    for (ti, to, truth) in [
        (60.0, 0.0, RHO / PI * slope.to_radians().cos()),
        (80.0, 0.0, RHO / PI * slope.to_radians().cos()),
        (80.0, 60.0, retro(60.0, slope)),
    ] {
        let read = |seed| {
            let (wi, wo) = (direction(ti as f32, 0.0), direction(to as f32, 0.0));
            measure_brdf(&specimen, wi, wo, &by(seed, 64, Some(1))).unwrap().rgb[1]
        };
        // Without shadows: half of what is seen along the normal faces the light, all of it at 60°.
        let unshadowed = facet(ti) * if to == 0.0 { 0.5 } else { 1.0 };
        let hits = held(read, &[truth, unshadowed, truth * ti.to_radians().cos()]);
        println!("from {ti}° to {to}°: {hits:?} of {SEEDS}");
        assert!(covers(hits[0]), "from {ti}° to {to}°: {hits:?}");
        assert!(hits[1] == 0 && hits[2] == 0, "from {ti}° to {to}°, mutants pass: {hits:?}");
    }
}

/// f(wi, wo) = f(wo, wi) between any directions, with a metal on one side of the grooves, and all orders of scattering.
/// With 40 readings each a difference of 5 % is found: the mutant has one.
#[test]
fn reading_is_reciprocal() {
    let specimen = grooves(50.0, |b| {
        let metal = b.material(Metal::gold(0.6));
        [metal, b.material(Diffuse::new(Spectrum::rgb(0.9, 0.6, 0.2)))]
    });
    let pairs = [
        (direction(30.0, 0.0), direction(60.0, 180.0)),
        (direction(20.0, 90.0), direction(65.0, 10.0)),
        (direction(75.0, 200.0), direction(50.0, 45.0)),
    ];
    for (a, b) in pairs {
        let readings = |wi, wo, from: u64| -> Vec<f64> {
            let read = |k| measure_brdf(&specimen, wi, wo, &by(from + k, 1024, None)).unwrap();
            (0..40).map(|k| read(k).rgb[0].value).collect()
        };
        let (there, back) = (readings(a, b, 0), readings(b, a, 1000));
        let test = welch_test(&there, &back);
        println!("{a} {b}: {} and {}, p {}", test.estimate, test.truth, test.p);
        assert!(!test.rejects(1e-3), "{a} {b}: {test:?}");
        let wrong: Vec<f64> = back.iter().map(|f| 1.05 * f).collect();
        assert!(welch_test(&there, &wrong).rejects(1e-3), "{a} {b}: 5 % are not found");
    }
}

/// What a white surface reflects is all there is, whatever its geometry; of a gray one less comes back than of a flat
/// sheet of it, since light meets it more than once.
#[test]
fn white_geometry_returns_everything() {
    let spheres = |rho: f32| {
        Specimen::new(Spot::disc(Vec3A::ZERO, Vec3A::Z, 3.0), move |b| {
            let m = b.material(Diffuse::new(Spectrum::gray(rho)));
            b.add(Plane::new(Vec3A::ZERO, Vec3A::Z).unwrap(), m);
            for (x, y, r) in [(0.0, 0.0, 1.0), (1.2, 1.0, 0.5), (-1.5, 0.3, 0.7), (0.4, -1.6, 0.9)] {
                b.add(Sphere::new(Vec3A::new(x, y, 0.8 * r), r).unwrap(), m);
            }
        })
    };
    for (name, white, gray) in
        [("grooves", matte(55.0, 1.0), matte(55.0, 0.5)), ("spheres", spheres(1.0), spheres(0.5))]
    {
        for theta in [0.0f32, 60.0] {
            let read =
                |seed| measure_albedo(&white, direction(theta, 30.0), &by(seed, 256, None)).unwrap()[0];
            let width = read(0).relative_half_width().unwrap();
            // A loss of 5 %, as of light that a wrong normal swallows.
            let hits = held(read, &[1.0, 0.95]);
            println!("{name} at {theta}°: {hits:?} of {SEEDS}, ± {width}");
            assert!(covers(hits[0]) && !covers(hits[1]), "{name} at {theta}°: {hits:?}");
            let m = measure_albedo(&gray, direction(theta, 30.0), &by(1, 2048, None)).unwrap()[0];
            assert!(m.bounds()[1] < 0.5, "{name} at {theta}°: {m:?}");
        }
    }
}
