use std::sync::Arc;

use etendue_bsdf::{Bsdf, Mode};
use etendue_core::{Frame, Spectrum, Vec2, Vec3A, vector};
use etendue_geometry::{Disc, Plane, Surface};
use etendue_light::PointLight;
use etendue_material::{
    Absorber, BlinnPhong, Cutout, Diffuse, Material, Metal, MirrorMaterial, OrenNayar, Phong, Principled,
};
use etendue_measure::Measured;
use etendue_measure::gonio::{
    GonioError, Gonioreflectometer, Specimen, Spot, measure_albedo, measure_brdf, measure_lobe,
};

use super::support::{covers, direction, held};

const FEW: Gonioreflectometer =
    Gonioreflectometer { samples: 4, runs: 3, seed: 7, source: 0.0, detector: 0.0, max_depth: None };

fn materials() -> Vec<(&'static str, Arc<dyn Material>)> {
    let (red, gray) = (Spectrum::rgb(0.8, 0.4, 0.1), Spectrum::gray(0.3));
    let brushed = Metal { roughness_across: Some(0.7.into()), ..Metal::copper(0.3) };
    vec![
        ("Lambert", Arc::new(Diffuse::new(red))),
        ("EON", Arc::new(OrenNayar::new(red, 0.7))),
        ("Phong", Arc::new(Phong::new(gray, gray, 30.0))),
        ("Blinn-Phong", Arc::new(BlinnPhong::new(gray, gray, 60.0))),
        ("rough metal", Arc::new(Metal::gold(0.4))),
        ("brushed metal", Arc::new(brushed)),
        ("glTF", Arc::new(Principled::new(red, 0.3, 0.4))),
    ]
}

/// What the material itself says, per channel.
fn value(material: &dyn Material, wi: Vec3A, wo: Vec3A) -> [f64; 3] {
    let mut at = Surface::new(Vec3A::ZERO, Vec3A::ZERO, Vec3A::Z);
    at.shading = Frame { x: Vec3A::X, y: Vec3A::Y, z: Vec3A::Z };
    let f = material.bsdf(&at).eval(wo, wi, Mode::Radiance);
    [f.r(), f.g(), f.b()].map(|f| f64::from(f) / f64::from(wi.z))
}

fn pairs() -> Vec<(Vec3A, Vec3A)> {
    let mut out = Vec::new();
    for (ti, pi) in [(10.0, 0.0), (40.0, 70.0), (75.0, 200.0), (88.0, 30.0)] {
        for (to, po) in [(0.0, 0.0), (35.0, 250.0), (40.0, -110.0), (80.0, 20.0)] {
            out.push((direction(ti, pi), direction(to, po)));
        }
    }
    out
}

/// Directions are turned and normalized on their way, which a lobe of exponent 60 multiplies.
fn same(read: [Measured; 3], truth: [f64; 3]) -> bool {
    read.iter().zip(truth).all(|(m, t)| (m.value - t).abs() <= 2e-5 * t + 1e-7)
}

#[test]
fn flat_sheets_read_what_their_bsdf_says() {
    for (name, material) in materials() {
        let sheet = Specimen::flat(material.clone());
        for (wi, wo) in pairs() {
            let r = measure_brdf(&sheet, wi, wo, &FEW).unwrap();
            let truth = value(&*material, wi, wo);
            assert!(same(r.rgb, truth), "{name} from {wi} to {wo}: {:?}, not {truth:?}", r.rgb);
            assert_eq!(r.missed, 0.0);
            // Nothing is left to chance.
            let width = |m: &Measured| m.bounds()[1] - m.bounds()[0];
            assert!(r.rgb.iter().all(|m| width(m) <= 1e-12 * m.value), "{name}: {:?}", r.rgb);
            // The mutant that divides by the irradiance across the beam.
            let mutant = r.rgb.map(|m| m.times(f64::from(wi.z)));
            assert!(truth == [0.0; 3] || !same(mutant, truth), "{name}: a forgotten cosine passes");
        }
    }
}

#[test]
fn a_specimen_may_stand_anywhere_and_turned() {
    let n = vector::normalize(Vec3A::new(0.3, -0.5, -0.7));
    let (center, frame) = (Vec3A::new(10.0, -3.0, 7.0), Frame::from_normal_tangent(n, Vec3A::X));
    for (name, material) in materials() {
        // Of a disc the tangent is not the frame's.
        if name == "brushed metal" {
            continue;
        }
        let place = |b: &mut etendue_scene::SceneBuilder| {
            let m = b.material_arc(material.clone());
            b.add(Disc::new(center, n, 2.0).unwrap(), m);
        };
        for spot in [Spot::disc(center, n * 5.0, 0.5), Spot::rectangle(center, frame, Vec2::new(0.3, 0.1))] {
            for (wi, wo) in pairs() {
                let r = measure_brdf(&Specimen::new(spot, place), wi, wo, &FEW).unwrap();
                for (m, t) in r.rgb.iter().zip(value(&*material, wi, wo)) {
                    // Turned directions are rounded; at 88° that shows in the fourth digit.
                    assert!((m.value - t).abs() <= 4e-4 * t + 1e-7, "{name} {wi} {wo}: {m:?}, not {t}");
                }
            }
        }
    }
}

#[test]
fn a_lobe_is_its_readings_and_a_seed_is_a_reading() {
    let sheet = Specimen::flat(Arc::new(Cutout::new(Diffuse::new(Spectrum::ONE), 0.5)));
    let wi = direction(30.0, 0.0);
    let wo: Vec<Vec3A> = pairs().into_iter().map(|(_, wo)| wo).collect();
    let lobe = measure_lobe(&sheet, wi, &wo, &FEW).unwrap();
    assert_eq!(lobe.len(), wo.len());
    for (r, &wo) in lobe.iter().zip(&wo) {
        assert_eq!(*r, measure_brdf(&sheet, wi, wo, &FEW).unwrap());
    }
    let other = Gonioreflectometer { seed: 8, ..FEW };
    assert_ne!(lobe, measure_lobe(&sheet, wi, &wo, &other).unwrap());
    assert!(lobe.iter().any(|r| r.missed > 0.0), "half of the sheet is not there");
}

/// A sheet with holes in half of it reflects half as much.
#[test]
fn holes_are_black() {
    let sheet = Specimen::flat(Arc::new(Cutout::new(Diffuse::new(Spectrum::ONE), 0.5)));
    let read = |seed| {
        let by = Gonioreflectometer { seed, samples: 64, runs: 8, ..Gonioreflectometer::default() };
        measure_brdf(&sheet, direction(50.0, 0.0), direction(20.0, 90.0), &by).unwrap().rgb[0]
    };
    let whole = std::f64::consts::FRAC_1_PI;
    let hits = held(read, &[0.5 * whole, whole]);
    assert!(covers(hits[0]) && hits[1] == 0, "{hits:?}");
}

/// A mirror under a source of half angle a is as bright as the source where it shows it: R / (π sin² a cos θ). A larger
/// detector sees it in part of its cone.
#[test]
fn a_mirror_is_read_with_cones() {
    let mirror = Specimen::flat(Arc::new(MirrorMaterial::new(Spectrum::rgb(0.9, 0.5, 0.25))));
    let (wi, wo) = (direction(40.0, 20.0), direction(40.0, 200.0));
    let cone = |half: f32| {
        let sin = f64::from(half).sin();
        1.0 / (std::f64::consts::PI * sin * sin * f64::from(wi.z))
    };
    assert_eq!(measure_brdf(&mirror, wi, wo, &FEW).unwrap().rgb[0].value, 0.0, "no cone sees it");
    let narrow = Gonioreflectometer { source: 0.05, detector: 0.02, ..FEW };
    let r = measure_brdf(&mirror, wi, wo, &narrow).unwrap();
    for (m, albedo) in r.rgb.iter().zip([0.9, 0.5, 0.25]) {
        assert!((m.value / (albedo * cone(0.05)) - 1.0).abs() < 1e-5, "{m:?}");
    }
    let beside = measure_brdf(&mirror, wi, direction(45.0, 200.0), &narrow).unwrap();
    assert_eq!(beside.rgb[0].value, 0.0, "5° beside it is dark");

    let read = |seed| {
        let by =
            Gonioreflectometer { source: 0.05, detector: 0.1, samples: 512, runs: 8, seed, max_depth: None };
        measure_brdf(&mirror, wi, wo, &by).unwrap().rgb[0]
    };
    // The mutants: a detector's cone that does not count, and a source's whose projection is forgotten.
    let truth = 0.9 * cone(0.1);
    let hits = held(read, &[truth, 0.9 * cone(0.05), truth * f64::from(wi.z)]);
    assert!(covers(hits[0]) && hits[1] == 0 && hits[2] == 0, "{hits:?}");
}

/// The albedo against that of the model, delta lobes and all; and the same by a detector that sees everything.
#[test]
fn albedos_are_the_models() {
    let by = Gonioreflectometer { samples: 256, runs: 8, ..FEW };
    let all = Gonioreflectometer { detector: std::f32::consts::FRAC_PI_2, ..by };
    let mirror: Arc<dyn Material> = Arc::new(MirrorMaterial::new(Spectrum::rgb(0.9, 0.5, 0.25)));
    for (name, material, delta) in [
        ("Lambert", materials()[0].1.clone(), false),
        ("EON", materials()[1].1.clone(), false),
        ("mirror", mirror, true),
    ] {
        let sheet = Specimen::flat(material.clone());
        for theta in [0.0, 45.0, 80.0] {
            let w = direction(theta, 0.0);
            let at = Surface::new(Vec3A::ZERO, Vec3A::ZERO, Vec3A::Z);
            let truth = material.bsdf(&at).albedo(w);
            let read = measure_albedo(&sheet, w, &by).unwrap();
            let gathered = measure_brdf(&sheet, w, Vec3A::Z, &all).unwrap().rgb;
            for (k, t) in [truth.r(), truth.g(), truth.b()].into_iter().enumerate() {
                let t = f64::from(t);
                assert!((read[k].value - t).abs() < 0.03 * t, "{name} at {theta}°: {:?}, not {t}", read[k]);
                if !delta {
                    let m = gathered[k].times(std::f64::consts::PI);
                    assert!((m.value - t).abs() < 0.03 * t, "{name} at {theta}°: {m:?}, not {t}");
                }
            }
        }
    }
}

#[test]
fn what_cannot_be_measured_is_said() {
    let sheet = Specimen::flat(Arc::new(Absorber));
    let up = Vec3A::Z;
    let read = |wi, wo, by: Gonioreflectometer| measure_brdf(&sheet, wi, wo, &by);
    assert_eq!(read(up, up, FEW).unwrap().rgb[0].value, 0.0);
    for bad in [Vec3A::ZERO, Vec3A::splat(f32::NAN), Vec3A::splat(f32::INFINITY)] {
        let said = read(bad, up, FEW).unwrap_err();
        assert!(matches!(said, GonioError::Direction { which: "incident", .. }), "{said}");
        let said = read(up, bad, FEW).unwrap_err();
        assert!(matches!(said, GonioError::Direction { which: "exitant", .. }), "{said}");
    }
    for bad in [-Vec3A::Z, Vec3A::X, Vec3A::new(1.0, 0.0, -1e-6)] {
        assert!(matches!(read(bad, up, FEW), Err(GonioError::Horizon { which: "incident", .. })));
        assert!(matches!(read(up, bad, FEW), Err(GonioError::Horizon { which: "exitant", .. })));
    }
    let wide = Gonioreflectometer { source: 0.5, detector: 0.2, ..FEW };
    assert!(matches!(read(direction(62.0, 0.0), up, wide), Err(GonioError::Horizon { .. })));
    assert!(read(direction(61.0, 0.0), up, wide).is_ok());
    for half in [-0.1, 1e-4, 1.6, f32::NAN, f32::INFINITY] {
        let by = Gonioreflectometer { source: half, ..FEW };
        assert!(matches!(read(up, up, by), Err(GonioError::HalfAngle { which: "incident", .. })), "{half}");
        let by = Gonioreflectometer { detector: half, ..FEW };
        assert!(matches!(read(up, up, by), Err(GonioError::HalfAngle { which: "exitant", .. })), "{half}");
    }
    for (samples, runs) in [(0, 4), (4, 0)] {
        let by = Gonioreflectometer { samples, runs, ..FEW };
        assert!(matches!(read(up, up, by), Err(GonioError::NoSamples { .. })));
    }
    let alone = read(up, up, Gonioreflectometer { runs: 1, ..FEW }).unwrap();
    assert_eq!(alone.rgb[0].interval, None);

    let frame = Frame::from_normal(Vec3A::Z);
    let askew = Frame { x: Vec3A::new(1.0, 0.0, 0.2), ..frame };
    for spot in [
        Spot::disc(Vec3A::ZERO, Vec3A::Z, 0.0),
        Spot::disc(Vec3A::ZERO, Vec3A::Z, f32::NAN),
        Spot::disc(Vec3A::splat(f32::NAN), Vec3A::Z, 1.0),
        Spot::disc(Vec3A::ZERO, Vec3A::ZERO, 1.0),
        Spot::rectangle(Vec3A::ZERO, frame, Vec2::new(1.0, -1.0)),
        Spot::rectangle(Vec3A::ZERO, askew, Vec2::ONE),
    ] {
        let said = measure_brdf(&Specimen::new(spot, |_| ()), up, up, &FEW).unwrap_err();
        assert!(matches!(said, GonioError::Spot { .. }), "{said}");
    }
    let spot = Spot::disc(Vec3A::ZERO, Vec3A::Z, 1.0);
    let nothing = measure_brdf(&Specimen::new(spot, |_| ()), up, up, &FEW).unwrap();
    assert_eq!((nothing.rgb[0].value, nothing.missed), (0.0, 1.0));
    // Nor does the sky shine through.
    assert_eq!(measure_albedo(&Specimen::new(spot, |_| ()), up, &FEW).unwrap()[0].value, 0.0);
    let lit = Specimen::new(spot, |b| b.light(PointLight::new(Vec3A::Z, Spectrum::ONE)));
    assert!(matches!(measure_brdf(&lit, up, up, &FEW), Err(GonioError::Lit)));
    let broken = Specimen::new(spot, |b| {
        let other = etendue_scene::SceneBuilder::new().material(Absorber);
        b.add(Plane::new(Vec3A::ZERO, Vec3A::Z).unwrap(), other);
    });
    assert!(matches!(measure_brdf(&broken, up, up, &FEW), Err(GonioError::Scene(_))));
}

/// A material that is not finite is named, not averaged.
#[test]
fn radiance_that_is_no_number_is_refused() {
    struct Broken;
    impl Material for Broken {
        fn bsdf<'a>(&'a self, _at: &Surface) -> etendue_bsdf::BsdfAt<'a> {
            etendue_bsdf::BsdfAt::Ref(&Broken)
        }
    }
    impl Bsdf for Broken {
        fn lobes(&self) -> etendue_bsdf::Lobes {
            etendue_bsdf::Lobes::REFLECTION | etendue_bsdf::Lobes::DIFFUSE
        }
        fn eval(&self, _wo: Vec3A, _wi: Vec3A, _mode: Mode) -> Spectrum {
            Spectrum::gray(f32::INFINITY)
        }
        fn pdf(&self, _wo: Vec3A, _wi: Vec3A, _mode: Mode) -> f32 {
            1.0
        }
        fn sample(&self, _: Vec3A, _: f32, _: Vec2, _: Mode) -> Option<etendue_bsdf::BsdfSample> {
            None
        }
        fn at(&self) -> etendue_bsdf::BsdfAt<'_> {
            etendue_bsdf::BsdfAt::Ref(self)
        }
    }
    let said = measure_brdf(&Specimen::flat(Arc::new(Broken)), Vec3A::Z, Vec3A::Z, &FEW).unwrap_err();
    assert!(matches!(said, GonioError::NotFinite { run: 0, sample: 0, .. }), "{said}");
}
