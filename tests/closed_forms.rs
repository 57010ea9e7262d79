//! Irradiance and form factors that are known in closed form, or by quadrature in double precision.

mod support;

use std::f64::consts::{FRAC_1_PI, PI};

use etendue::core::glam::DVec3;
use etendue::core::radiometry::{Intensity, projected_solid_angle};
use etendue::geometry::presets as meshes;
use etendue::prelude::*;
use support::{WAYS, assert_mean, lamp, path, radiance, wide};

const ALBEDO: f32 = 0.6;

/// A small diffuse patch around the origin that faces +z, and what is added to it.
fn patch(add: impl FnOnce(&mut SceneBuilder)) -> Scene {
    let mut b = SceneBuilder::new();
    let m = b.material(Diffuse::new(Spectrum::gray(ALBEDO)));
    b.add(Parallelogram::new(Vec3A::new(-0.05, -0.05, 0.0), Vec3A::X * 0.1, Vec3A::Y * 0.1).unwrap(), m);
    add(&mut b);
    b.build().unwrap()
}

/// Looks at the middle of the patch from close by.
fn at_the_patch(_: &Independent) -> Ray {
    Ray::new(Vec3A::new(0.0, -0.006, 0.008), Vec3A::new(0.0, 0.6, -0.8))
}

/// The patch shows albedo · E / π. Light samples alone and MIS see a bias of 1 % as five standard errors, 2.5 % where
/// much of the light lies below the horizon; BSDF samples (which hit it with a probability of E / πL) one of 5 %.
fn assert_irradiance(scene: &Scene, e: f64, cut: bool, what: &str) {
    for direct in WAYS {
        let truth = f64::from(ALBEDO) * FRAC_1_PI * e;
        let (n, power) = match (direct, cut) {
            (DirectLight::Bsdf, _) => (300_000, 0.05),
            (_, false) => (60_000, 0.01),
            (_, true) => (300_000, 0.025),
        };
        let xs = radiance(scene, &path(direct), 31, n, &at_the_patch);
        assert_mean(&xs, truth, power, &format!("{what}, {direct:?}"));
    }
}

/// E = I cos θ / d²; every sample is the answer.
#[test]
fn point_lights_obey_the_inverse_square() {
    for p in [Vec3A::new(0.0, 0.0, 2.0), Vec3A::new(3.0, -1.0, 0.5), Vec3A::new(-20.0, 5.0, 30.0)] {
        let scene = patch(|b| b.light(PointLight::new(p, Spectrum::gray(7.0))));
        let d = wide(p).length();
        let e = Intensity(7.0).irradiance_at(d, wide(p).z / d).0;
        for direct in WAYS {
            let xs = radiance(&scene, &path(direct), 1, 100, &at_the_patch);
            assert_mean(&xs, f64::from(ALBEDO) * FRAC_1_PI * e, 0.001, &format!("{p}, {direct:?}"));
        }
    }
    // From below nothing arrives.
    let scene = patch(|b| b.light(PointLight::new(Vec3A::new(0.0, 1.0, -1.0), Spectrum::gray(7.0))));
    for direct in WAYS {
        assert!(radiance(&scene, &path(direct), 1, 100, &at_the_patch).iter().all(|&x| x == 0.0));
    }
}

/// Lambert's formula for quads (as exact shapes and as two triangles) and triangles, over the horizon and cut by it.
#[test]
fn polygon_lights_obey_lamberts_formula() {
    let quads = [
        ("overhead", Vec3A::new(-1.0, 1.0, 1.5), Vec3A::X * 2.0, Vec3A::NEG_Y * 2.0),
        ("slanted", Vec3A::new(0.3, 1.6, 0.4), Vec3A::new(1.5, -0.4, 0.2), Vec3A::new(0.3, -0.7, 1.6)),
        ("cut by the horizon", Vec3A::new(1.0, -1.5, -1.2), Vec3A::Y * 3.0, Vec3A::new(-0.3, 0.0, 3.0)),
        ("mostly below", Vec3A::new(1.2, -1.5, -4.0), Vec3A::Y * 3.0, Vec3A::new(0.0, 0.0, 5.0)),
    ];
    for (name, o, u, v) in quads {
        let cut = o.z < 0.0;
        // The front has to face the patch.
        let (u, v) = if u.cross(v).dot(-(o + (u + v) * 0.5)) > 0.0 { (u, v) } else { (v, u) };
        let corners = [o, o + u, o + u + v, o + v].map(wide);
        let e = projected_solid_angle(&corners, DVec3::Z).0;
        let quad = patch(|b| lamp(b, Parallelogram::new(o, u, v).unwrap()));
        assert_irradiance(&quad, e, cut, &format!("quad {name}"));
        let mesh = patch(|b| lamp(b, meshes::quad(o, u, v)));
        assert_irradiance(&mesh, e, cut, &format!("mesh {name}"));
        let e = projected_solid_angle(&corners[1..], DVec3::Z).0;
        let triangle = [o + u, o + u + v, o + v].map(Vec3::from).to_vec();
        let triangle = TriangleMesh::new(triangle, vec![[0, 1, 2]]).unwrap();
        assert_irradiance(&patch(|b| lamp(b, triangle)), e, cut, &format!("triangle {name}"));
        // What faces away is dark.
        let away = patch(|b| lamp(b, Parallelogram::new(o, v, u).unwrap()));
        for direct in WAYS {
            assert!(
                radiance(&away, &path(direct), 2, 500, &at_the_patch).iter().all(|&x| x == 0.0),
                "{name}"
            );
        }
    }
}

/// E = π (R/d)² cos θ for a sphere of radiance 1 above the horizon.
#[test]
fn sphere_lights_obey_the_closed_form() {
    for (center, radius) in [(Vec3A::new(0.0, 0.0, 2.0), 1.0), (Vec3A::new(1.0, 0.5, 1.5), 0.8)] {
        let scene = patch(|b| lamp(b, Sphere::new(center, radius).unwrap()));
        let (d, r) = (wide(center).length(), f64::from(radius));
        assert!(wide(center).z > r, "above the horizon");
        assert_irradiance(
            &scene,
            PI * (r / d).powi(2) * wide(center).z / d,
            false,
            &format!("sphere at {center}"),
        );
    }
}

/// E = π r² / (r² + h²) under a disc of radius 1, and E = π h² / (r² + h²) in the middle of a tube's end.
#[test]
fn discs_and_tubes_obey_the_closed_forms() {
    for (r, h) in [(1.0f32, 1.0f32), (0.5, 2.0)] {
        let (r2, h2) = (f64::from(r * r), f64::from(h * h));
        let disc = patch(|b| lamp(b, Disc::new(Vec3A::Z * h, Vec3A::NEG_Z, r).unwrap()));
        assert_irradiance(&disc, PI * r2 / (r2 + h2), false, &format!("disc {r} at {h}"));
        let tube = patch(|b| {
            let m = b.material(Diffuse::new(Spectrum::BLACK));
            let g = b.add(Cylinder::new(Vec3A::ZERO, Vec3A::Z * h, r).unwrap(), m);
            b.emit(g, Emission { two_sided: true, ..Emission::new(Spectrum::ONE) });
        });
        assert_irradiance(&tube, PI * h2 / (r2 + h2), true, &format!("tube {r} of {h}"));
    }
    let mut b = SceneBuilder::new();
    lamp(&mut b, Cylinder::endless(Vec3A::ZERO, Vec3A::Z, 1.0).unwrap());
    assert!(b.build().is_err_and(|e| e.to_string().contains("ends")));
}

/// ∫ max(0, n·ω) over the cone that a sphere fills, by the midpoint rule in the cosine from the axis and around it.
fn irradiance_of_sphere(center: DVec3, radius: f64) -> f64 {
    const STEPS: u32 = 2000;
    let d = center.length();
    let axis = center / d;
    let across = axis.any_orthonormal_vector();
    let (sin_max, step) = (radius / d, 1.0 / f64::from(STEPS));
    let cos_max = (1.0 - sin_max * sin_max).sqrt();
    let mut sum = 0.0;
    for i in 0..STEPS {
        let cos = cos_max + (1.0 - cos_max) * (f64::from(i) + 0.5) * step;
        let sin = (1.0 - cos * cos).sqrt();
        for j in 0..STEPS {
            let phi = 2.0 * PI * (f64::from(j) + 0.5) * step;
            let w = axis * cos + (across * phi.cos() + axis.cross(across) * phi.sin()) * sin;
            sum += w.z.max(0.0);
        }
    }
    sum * step * step * 2.0 * PI * (1.0 - cos_max)
}

#[test]
fn spheres_across_the_horizon_agree_with_quadrature() {
    let above = irradiance_of_sphere(DVec3::new(1.0, 0.5, 1.5), 0.8);
    let d = DVec3::new(1.0, 0.5, 1.5).length();
    assert!(
        (above / (PI * (0.8 / d).powi(2) * 1.5 / d) - 1.0).abs() < 1e-5,
        "the quadrature knows the closed form"
    );
    for (center, radius) in [(Vec3A::new(1.2, 0.0, 0.3), 1.0), (Vec3A::new(0.0, -1.3, -0.2), 1.1)] {
        let scene = patch(|b| lamp(b, Sphere::new(center, radius).unwrap()));
        assert_irradiance(
            &scene,
            irradiance_of_sphere(wide(center), f64::from(radius)),
            true,
            &format!("sphere at {center}"),
        );
    }
}

/// Unit squares: the mean radiance of one lit by the other is albedo times the form factor. (Parallel at distance 1 and
/// with a common edge at a right angle; both in closed form, e.g. Howell's catalogue, C-11 and C-14.)
#[test]
fn squares_exchange_their_form_factors() {
    let unit = |o: Vec3A, u: Vec3A, v: Vec3A| (Parallelogram::new(o, u, v).unwrap(), meshes::quad(o, u, v));
    let cases = [
        ("parallel", 0.199_824_895_698_387, unit(Vec3A::Z, Vec3A::Y, Vec3A::X)),
        ("perpendicular", 0.200_043_776_075_403_2, unit(Vec3A::ZERO, Vec3A::Y, Vec3A::Z)),
    ];
    let anywhere = |u: &Independent| {
        let p = u.get_2d(Dim::LENS);
        Ray::new(Vec3A::new(p.x, p.y, 1e-3), Vec3A::NEG_Z)
    };
    for (name, form_factor, (quad, mesh)) in cases {
        for (kind, shape) in [("quad", Geometry::from(quad)), ("mesh", Geometry::from(mesh))] {
            let mut b = SceneBuilder::new();
            let m = b.material(Diffuse::new(Spectrum::gray(ALBEDO)));
            b.add(Parallelogram::new(Vec3A::ZERO, Vec3A::X, Vec3A::Y).unwrap(), m);
            lamp(&mut b, shape);
            let scene = b.build().unwrap();
            for direct in WAYS {
                let power = if direct == DirectLight::Bsdf { 0.025 } else { 0.015 };
                let xs = radiance(&scene, &path(direct), 41, 250_000, &anywhere);
                let what = format!("{name} {kind}, {direct:?}");
                assert_mean(&xs, f64::from(ALBEDO) * form_factor, power, &what);
            }
        }
    }
}
