//! Irradiance at points with closed forms. Each z-test has the power to see 0.5 % (see `Mean::check`).

mod support;

use std::sync::Arc;

use etendue_core::{Spectrum, Transform, Vec3A};
use etendue_geometry::{Cylinder, Disc, Parallelogram, Sphere, presets};
use etendue_light::{
    DirectionalLight, DiscLight, GoniometricLight, IntensityTable, Light, MeshLight, ParallelogramLight,
    PointLight, ShapeLight, SphereLight, SpotLight,
};
use etendue_texture::Tex;
use support::{Mean, Rng, irradiance, irradiance_of, polygon_irradiance, receiver};

const ONE: Tex = Tex::Constant(Spectrum::ONE);

/// A unit square at height `h` that faces down, centred over (x, z) = (0, 0).
fn ceiling(h: f32) -> Parallelogram {
    Parallelogram::new(Vec3A::new(-0.5, h, -0.5), Vec3A::X, Vec3A::Z).expect("a square")
}

fn ceiling_mesh(h: f32) -> MeshLight {
    let s = ceiling(h);
    assert_eq!(s.normal(), -Vec3A::Y);
    MeshLight::new(Arc::new(presets::quad(s.origin(), s.edge_u(), s.edge_v())), None, ONE, false)
}

#[test]
fn point_light_is_exact() {
    let lamp = PointLight::new(Vec3A::new(1.0, 3.0, -2.0), Spectrum::rgb(9.0, 18.0, 0.0));
    let at = receiver(Vec3A::new(-1.0, 1.0, -1.0), Vec3A::Y);
    let s = lamp.sample(&at, 0, etendue_core::Vec2::ZERO).expect("in front");
    assert_eq!((s.li, s.pdf, s.is_delta), (Spectrum::rgb(1.0, 2.0, 0.0), 1.0, true));
    assert!((s.wi - Vec3A::new(2.0, 2.0, -1.0) / 3.0).abs().max_element() < 1e-7);
    assert!(lamp.sample(&receiver(at.p, -Vec3A::Y), 0, etendue_core::Vec2::ZERO).is_none());
    assert!((lamp.power(0, 1.0).r() - 9.0 * 4.0 * std::f32::consts::PI).abs() < 1e-4);
}

/// E = I f(θ) cos θ / d² with f = ((cos θ − cos o) / (cos i − cos o))² between the cones, and
/// Φ = 2π I (1 − cos i + (cos i − cos o) / 3).
#[test]
fn spot_light_is_exact() {
    let (inner, outer, intensity) = (0.3f64, 0.9f64, 7.0);
    let spot = SpotLight::new(Vec3A::ZERO, Vec3A::NEG_Y, Spectrum::gray(7.0), inner as f32, outer as f32);
    let (ci, co) = (inner.cos(), outer.cos());
    for (distance, theta) in
        [(0.5f64, 0.0f64), (2.0, 0.25), (2.0, 0.4), (30.0, 0.6), (1e4, 0.85), (1.0, 0.95)]
    {
        let p = Vec3A::new((distance * theta.sin()) as f32, (-distance * theta.cos()) as f32, 0.0);
        let x = ((theta.cos() - co) / (ci - co)).clamp(0.0, 1.0);
        let truth = intensity * x * x * theta.cos() / (distance * distance);
        let e = irradiance_of(spot.sample(&receiver(p, Vec3A::Y), 0, etendue_core::Vec2::ZERO), Vec3A::Y);
        // Near the outer cone a rounded cosine leaves few digits of the difference.
        let relative = if x > 0.5 { 2e-6 } else { 1e-5 };
        assert!((e - truth).abs() <= relative * truth, "distance {distance} θ {theta}: {e} for {truth}");
    }
    assert!(spot.sample(&receiver(Vec3A::NEG_Y, Vec3A::NEG_Y), 0, etendue_core::Vec2::ZERO).is_none());
    let power = std::f64::consts::TAU * intensity * (1.0 - ci + (ci - co) / 3.0);
    assert!(
        (f64::from(spot.power(0, 1.0).r()) / power - 1.0).abs() < 1e-6,
        "{:?} for {power}",
        spot.power(0, 1.0)
    );
    // Mutant: a fall-off that is not squared has ½ for the third.
    assert!((0.5 * (ci - co) + 1.0 - ci) / (1.0 - ci + (ci - co) / 3.0) > 1.2);
}

/// E = E₀ cos θ, whatever the distance, and Φ = π R² E₀ into a scene of radius R.
#[test]
fn directional_light_is_exact() {
    for theta in [0.0f64, 0.5, 1.2, 1.55] {
        let along = Vec3A::new(theta.sin() as f32, -theta.cos() as f32, 0.0) * 4.0;
        let sun = DirectionalLight::new(along, Spectrum::rgb(3.0, 1.0, 0.5));
        for p in [Vec3A::ZERO, Vec3A::new(1e6, -2e5, 3.0)] {
            let s = sun.sample(&receiver(p, Vec3A::Y), 0, etendue_core::Vec2::ZERO).expect("above");
            assert_eq!((s.end, s.pdf, s.is_delta), (None, 1.0, true));
            let truth = 3.0 * theta.cos();
            let e = irradiance_of(Some(s), Vec3A::Y);
            assert!((e - truth).abs() < 1e-6, "θ {theta}: {e} for {truth}");
        }
        assert!(sun.sample(&receiver(Vec3A::ZERO, Vec3A::NEG_Y), 0, etendue_core::Vec2::ZERO).is_none());
        let power = std::f64::consts::PI * 25.0;
        assert!((f64::from(sun.power(0, 5.0).g()) / power - 1.0).abs() < 1e-6);
    }
}

/// Powers stay numbers that single precision holds.
#[test]
fn powers_are_finite() {
    let most = Spectrum::gray(f32::MAX);
    let table = IntensityTable::new(vec![0.0, 180.0], vec![0.0], vec![f32::MAX; 2]).expect("a table");
    let lights: [&dyn Light; 3] = [
        &PointLight::new(Vec3A::ZERO, most),
        &SpotLight::new(Vec3A::ZERO, Vec3A::X, most, 1.0, 3.0),
        &GoniometricLight::new(&Transform::IDENTITY, Arc::new(table), most),
    ];
    for light in lights {
        assert_eq!(light.power(0, 1.0), most);
    }
}

/// A unit square parallel to the receiver at height h, under its centre or 1 m aside.
#[test]
fn unit_square_has_the_tabulated_irradiance() {
    let table = [
        (0.0f32, 0.10f32, 3.042_128_438),
        (0.0, 0.25, 2.610_753_031),
        (0.0, 0.50, 1.740_839_503),
        (0.0, 1.00, 0.752_274_688),
        (1.0, 0.25, 0.093_855_431),
        (1.0, 1.00, 0.265_004_852),
    ];
    for (i, (x, h, e)) in table.into_iter().enumerate() {
        let at = receiver(Vec3A::new(x, 0.0, 0.0), Vec3A::Y);
        let what = format!("offset {x} height {h}");
        irradiance(&ceiling_mesh(h), &at, 300_000, i as u64).check(e, &format!("mesh, {what}"));
        let rectangle = ParallelogramLight::new(ceiling(h), ONE);
        irradiance(&rectangle, &at, 300_000, 100 + i as u64).check(e, &format!("rectangle, {what}"));
        // By area the nearest square would take 10 million samples.
        if h > 0.2 {
            let shape = ShapeLight::new(Arc::new(ceiling(h)), None, ONE, false);
            irradiance(&shape, &at, 2_000_000, 200 + i as u64).check(e, &format!("by area, {what}"));
        }
    }
}

/// Below 3e-4 sr triangles and rectangles are sampled by area; the answer is the same closed form.
#[test]
fn far_away_lights_are_sampled_by_area() {
    for h in [40.0f32, 80.0, 1000.0] {
        let p = Vec3A::new(3.0, 0.0, -5.0);
        let s = ceiling(h);
        let corners = [
            s.origin(),
            s.origin() + s.edge_u(),
            s.origin() + s.edge_u() + s.edge_v(),
            s.origin() + s.edge_v(),
        ];
        let e = polygon_irradiance(&corners, p, Vec3A::Y);
        let at = receiver(p, Vec3A::Y);
        irradiance(&ceiling_mesh(h), &at, 20_000, 1).check(e, "mesh");
        irradiance(&ParallelogramLight::new(s, ONE), &at, 20_000, 2).check(e, "rectangle");
    }
}

/// A skew parallelogram, placed by a transform with uneven scale and a mirror.
#[test]
fn placed_and_skew_lights() {
    let m = Transform::from_columns(
        Vec3A::new(2.0, 0.3, 0.0),
        Vec3A::new(0.0, 0.5, 0.4),
        Vec3A::new(0.1, 0.0, -1.5),
        Vec3A::new(0.2, 2.0, 0.4),
    )
    .expect("regular");
    assert!(m.mirrors());
    let shape =
        Parallelogram::new(Vec3A::new(-0.5, 0.0, -0.5), Vec3A::new(1.0, 0.0, 0.2), Vec3A::new(0.3, 0.0, 0.9))
            .expect("an area");
    let [a, b, c] = [shape.origin(), shape.edge_u(), shape.edge_v()];
    let corners = [m.point(a), m.point(a + b), m.point(a + b + c), m.point(a + c)];
    let at = receiver(Vec3A::new(0.1, -1.0, 0.3), Vec3A::new(0.36, 0.8, 0.48));
    let e = polygon_irradiance(&corners, at.p, at.ns);
    let mesh = Arc::new(presets::quad(a, b, c));
    irradiance(&MeshLight::new(mesh.clone(), Some(m), ONE, false), &at, 300_000, 5).check(e, "mesh");
    irradiance(&ShapeLight::new(Arc::new(shape), Some(m), ONE, false), &at, 2_000_000, 6).check(e, "shape");
    let world =
        Parallelogram::new(corners[0], corners[1] - corners[0], corners[3] - corners[0]).expect("an area");
    let two_sided = ParallelogramLight::new(world, ONE).with_two_sided(true);
    irradiance(&two_sided, &at, 2_000_000, 7).check(e, "parallelogram");
    // From behind a one-sided light is dark, a two-sided one is not.
    let behind = receiver(Vec3A::new(0.1, 5.0, 0.3), -at.ns);
    let one_sided = MeshLight::new(mesh.clone(), Some(m), ONE, false);
    assert_eq!(irradiance(&one_sided, &behind, 1000, 8).error(), 0.0);
    let e = polygon_irradiance(&corners, behind.p, behind.ns);
    irradiance(&MeshLight::new(mesh, Some(m), ONE, true), &behind, 300_000, 9).check(e, "from behind");
}

/// E = π (R/d)² cos θ for a sphere above the horizon, from almost touching to very far.
#[test]
fn sphere_on_a_plane() {
    for (i, (distance, cos)) in
        [(1.01f32, 1.0f32), (1.5, 0.8), (3.0, 0.5), (100.0, 0.3), (1e4, 0.9), (3e6, 1.0)]
            .into_iter()
            .enumerate()
    {
        let radius = 0.7f32;
        let center = Vec3A::new((1.0 - cos * cos).sqrt(), cos, 0.0) * (distance * radius);
        let light = SphereLight::new(Sphere::new(center, radius).expect("a sphere"), Spectrum::ONE);
        let at = receiver(Vec3A::ZERO, Vec3A::Y);
        let d2 = f64::from(center.dot(center));
        let e = std::f64::consts::PI * f64::from(radius * radius) / d2 * f64::from(center.y) / d2.sqrt();
        irradiance(&light, &at, 300_000, i as u64).check(e, &format!("distance {distance} cos {cos}"));
    }
}

/// E = π L r² / (r² + h²) under the middle of a disc, from nearby to far away; nothing from its back.
#[test]
fn disc_on_its_axis() {
    let (axis, foot) = (Vec3A::new(0.36, 0.8, 0.48), Vec3A::new(3.0, -1.0, 2.0));
    for (i, (h, n)) in
        [(0.5f32, 4_000_000), (1.0, 1_000_000), (3.0, 300_000), (30.0, 300_000), (3e4, 300_000)]
            .into_iter()
            .enumerate()
    {
        let r = 0.7f32;
        let disc = Disc::new(foot + axis * (h * r), -axis, r).expect("a disc");
        let light = ShapeLight::new(Arc::new(disc), None, ONE, false);
        // Where rounding has put the centre.
        let d = disc.center() - foot;
        let (r2, d2) = (f64::from(r) * f64::from(r), f64::from(d.dot(d)));
        let e = std::f64::consts::PI * r2 / (r2 + d2);
        irradiance(&light, &receiver(foot, axis), n, i as u64).check(e, &format!("height {h} r"));
        irradiance(&DiscLight::new(disc, ONE), &receiver(foot, axis), 300_000, 50 + i as u64)
            .check(e, &format!("height {h} r, by solid angle"));
        let away = Disc::new(disc.center(), axis, r).expect("a disc");
        let away = ShapeLight::new(Arc::new(away), None, ONE, false);
        assert_eq!(irradiance(&away, &receiver(foot, axis), 1000, 9).error(), 0.0);
        let pi = std::f64::consts::PI;
        assert!((f64::from(light.power(0, 1.0).r()) / (pi * pi * r2) - 1.0).abs() < 1e-6);
    }
}

/// In the middle of a tube's end, facing in: all that the other end's disc leaves of π, E = π h² / (r² + h²).
#[test]
fn inside_a_tube() {
    for (i, (r, h)) in [(1.0f32, 1.0f32), (0.5, 2.0), (2.0, 0.5)].into_iter().enumerate() {
        let tube = Cylinder::new(Vec3A::ZERO, Vec3A::Y * h, r).expect("a tube");
        let light = ShapeLight::new(Arc::new(tube), None, ONE, true);
        let (r2, h2) = (f64::from(r * r), f64::from(h * h));
        let e = std::f64::consts::PI * h2 / (r2 + h2);
        irradiance(&light, &receiver(Vec3A::ZERO, Vec3A::Y), 1_000_000, i as u64)
            .check(e, &format!("r {r} h {h}"));
        let outside = ShapeLight::new(Arc::new(tube), None, ONE, false);
        assert_eq!(
            irradiance(&outside, &receiver(Vec3A::ZERO, Vec3A::Y), 1000, 9).error(),
            0.0,
            "shines outward"
        );
    }
}

/// Inside a two-sided sphere of radiance 1 every point sees radiance 1 everywhere: E = π.
#[test]
fn inside_a_sphere() {
    let sphere = Sphere::new(Vec3A::new(0.2, 0.0, 0.1), 2.0).expect("a sphere");
    let light = SphereLight { two_sided: true, ..SphereLight::new(sphere, Spectrum::ONE) };
    let at = receiver(Vec3A::new(1.0, 0.3, -0.4), Vec3A::Y);
    irradiance(&light, &at, 4_000_000, 1).check(std::f64::consts::PI, "inside");
    assert!(SphereLight::new(sphere, Spectrum::ONE).sample(&at, 0, etendue_core::Vec2::ZERO).is_none());
}

/// The form factor of two parallel unit squares 1 m apart, and of two that share an edge at a right angle: receiver
/// points uniform over one, the other a light.
#[test]
fn form_factors_of_squares() {
    let sideways = Parallelogram::new(Vec3A::new(-0.5, 0.0, -0.5), Vec3A::Z, Vec3A::Y).expect("a square");
    assert_eq!(sideways.normal(), -Vec3A::X);
    let flipped = Parallelogram::new(sideways.origin(), Vec3A::Y, Vec3A::Z).expect("a square");
    for (square, factor, name) in [
        (ceiling(1.0), 0.199_824_895_698_387_4, "parallel"),
        (flipped, 0.200_043_776_075_403_2, "perpendicular"),
    ] {
        let mesh = presets::quad(square.origin(), square.edge_u(), square.edge_v());
        let mesh = MeshLight::new(Arc::new(mesh), None, ONE, false);
        let rectangle = ParallelogramLight::new(square, ONE);
        let mut rng = Rng(3);
        let (mut by_triangles, mut by_rectangle) = (Mean::default(), Mean::default());
        for _ in 0..3_000_000 {
            let xz = rng.pair();
            let at = receiver(Vec3A::new(xz.x - 0.5, 0.0, xz.y - 0.5), Vec3A::Y);
            let part = u32::from(rng.next() < 0.5);
            by_triangles.add(
                2.0 * irradiance_of(mesh.sample(&at, part, rng.pair()), Vec3A::Y) / std::f64::consts::PI,
            );
            by_rectangle
                .add(irradiance_of(rectangle.sample(&at, 0, rng.pair()), Vec3A::Y) / std::f64::consts::PI);
        }
        by_triangles.check(factor, &format!("{name}, triangles"));
        by_rectangle.check(factor, &format!("{name}, rectangle"));
    }
}
