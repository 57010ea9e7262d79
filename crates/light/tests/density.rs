//! Every light reports for a direction the density with which it draws it; the density holds the mass that is drawn;
//! scaling by powers of two scales everything exactly.

mod support;

use std::sync::Arc;

use etendue_core::{Origin, Ray, Spectrum, Transform, Vec2, Vec3, Vec3A};
use etendue_geometry::{Disc, Parallelogram, Shape, Sphere, Surface, TriangleMesh, presets};
use etendue_light::{
    ConstantEnvironment, DiscLight, Light, LightSample, LitPoint, MeshLight, ParallelogramLight, PointLight,
    ShapeLight, Sides, SphereLight,
};
use etendue_sampling::warp;
use etendue_texture::{Encoding, Filter, ImageTexture, Tex};
use proptest::prelude::*;
use support::{Rng, free, integrate_cap, receiver};

const ONE: Tex = Tex::Constant(Spectrum::ONE);

/// The surface at the end of a sample, as a ray would find it.
fn seen(end: Option<Origin>, part: u32) -> Option<Surface> {
    end.map(|end| {
        let mut s = Surface::new(end.p, end.p_err, end.ng);
        s.prim = part;
        s
    })
}

fn triangle(corners: [Vec3A; 3]) -> Arc<TriangleMesh> {
    let positions = corners.map(Vec3::from).to_vec();
    Arc::new(TriangleMesh::new(positions, vec![[0, 1, 2]]).expect("one triangle"))
}

fn agrees(light: &dyn Light, at: &LitPoint, part: u32, u: Vec2) -> Option<LightSample> {
    let s = light.sample(at, part, u)?;
    assert!(s.pdf > 0.0 && s.pdf.is_finite() && s.li.is_finite() && !s.li.is_black());
    assert!((s.wi.dot(s.wi) - 1.0).abs() < 1e-5, "{}", s.wi);
    let surface = seen(s.end, part);
    let pdf = light.pdf(at, part, s.wi, surface.as_ref());
    if s.is_delta {
        assert_eq!((s.pdf, pdf), (1.0, 0.0));
        return Some(s);
    }
    // Exactly the same where it is a solid angle; a cosine over a squared distance keeps fewer digits edge-on.
    let tolerance = surface.as_ref().map_or(1e-6, |x| 1e-6 / x.ng.dot(s.wi).abs().max(1e-3));
    assert!((pdf / s.pdf - 1.0).abs() <= tolerance, "pdf {pdf}, sampled {}", s.pdf);
    if let (Some(end), Some(surface)) = (s.end, surface) {
        let d = end.p - at.p;
        let off = (d / d.dot(d).sqrt() - s.wi).abs().max_element();
        let rounding = end.p.abs().max_element() / d.dot(d).sqrt() * 2e-7;
        assert!(off < 2e-6 + rounding, "the end lies along the direction: {off}");
        // On the silhouette of a far sphere the rounded direction decides which side is seen.
        if surface.ng.dot(s.wi).abs() > 0.02 {
            assert_eq!(light.emitted(part, &surface, -s.wi), s.li, "and shines as it says");
        }
    }
    Some(s)
}

fn any_point(range: f32) -> impl Strategy<Value = Vec3A> {
    (-range..range, -range..range, -range..range).prop_map(|(x, y, z)| Vec3A::new(x, y, z))
}

fn any_number() -> impl Strategy<Value = f32> {
    prop_oneof![Just(0.0f32), Just(1.0 / 16_777_216.0), Just(1.0 - 1.0 / 16_777_216.0), 0.0f32..1.0]
}

fn any_receiver() -> impl Strategy<Value = LitPoint> {
    let n = any_point(1.0).prop_filter("a direction", |v| v.dot(*v) > 0.01);
    let sides = prop_oneof![Just(Sides::Same), Just(Sides::Both), Just(Sides::Free)];
    (any_point(3.0), n, sides, -3..8i32).prop_map(|(p, n, sides, far)| {
        let ng = if sides == Sides::Free { Vec3A::ZERO } else { etendue_core::vector::normalize(n) };
        let p = p * 2f32.powi(far);
        LitPoint { p, p_err: Vec3A::ZERO, ng, ns: ng, sides, time: 0.0 }
    })
}

/// All lights of the crate that stand somewhere, around the origin.
fn any_light() -> impl Strategy<Value = Shown> {
    (0..7, any_point(1.0), any_point(1.0), any_point(1.0), any::<bool>()).prop_filter_map(
        "an area",
        |(kind, a, b, c, two_sided)| {
            let shape = Parallelogram::new(a, b, c).ok()?;
            let square = Parallelogram::new(a, Vec3A::X * 0.7, Vec3A::Z * 0.3).ok()?;
            let sphere = Sphere::new(a, b.x.abs() + 1e-3).ok()?;
            let disc = Disc::new(a, b, c.x.abs() + 1e-3).ok()?;
            let stretched = Transform::scale(Vec3A::new(1.0, -2.0, 0.25)).ok()?;
            let mesh = Arc::new(presets::quad(a, b, c));
            Some(Shown(match kind {
                0 => Arc::new(PointLight::new(a, Spectrum::ONE)) as Arc<dyn Light>,
                1 => Arc::new(MeshLight::new(mesh, None, ONE, two_sided)),
                2 => Arc::new(MeshLight::new(mesh, Some(stretched), ONE, two_sided)),
                3 => Arc::new(ParallelogramLight::new(square, ONE).with_two_sided(two_sided)),
                4 => Arc::new(SphereLight { two_sided, ..SphereLight::new(sphere, ONE) }),
                5 => Arc::new(DiscLight { two_sided, ..DiscLight::new(disc, ONE) }),
                _ => Arc::new(ShapeLight::new(Arc::new(shape), Some(stretched), ONE, two_sided)),
            }))
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 40_000,
        rng_seed: prop::test_runner::RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn sample_and_pdf_agree(
        light in any_light(),
        at in any_receiver(),
        (a, b) in (any_number(), any_number()),
    ) {
        for part in 0..light.0.parts() {
            let s = agrees(&*light.0, &at, part, Vec2::new(a, b));
            prop_assert!(at.sides != Sides::Same || s.is_none_or(|s| s.wi.dot(at.ng) > 0.0));
        }
    }
}

/// proptest wants to print its inputs.
struct Shown(Arc<dyn Light>);
impl std::fmt::Debug for Shown {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "power {:?} bounds {:?}", self.0.power(0, 1.0), self.0.bounds(0))
    }
}

/// ∫ pdf over the directions that meet the light is 1, by solid angle and by area.
#[test]
fn density_integrates_to_one() {
    let hit_by = |shape: &dyn Shape, at: &LitPoint, w: Vec3A| {
        let ray = Ray::new(at.p, w);
        shape.intersect(&ray).map(|h| shape.surface(&ray, &h))
    };
    let square = Parallelogram::new(Vec3A::new(-0.5, 0.0, -0.5), Vec3A::X, Vec3A::Z).expect("a square");
    let skew = Parallelogram::new(Vec3A::ZERO, Vec3A::X, Vec3A::new(0.4, 0.1, 0.8)).expect("an area");
    let ball = Sphere::new(Vec3A::ZERO, 0.5).expect("a sphere");
    for distance in [0.6f32, 2.0, 30.0, 200.0] {
        let axis = Vec3A::new(0.48, -0.6, 0.64);
        let at = free(-axis * distance);
        // A cap that just holds every light: they lie within 1.4 of the origin.
        let sin = (1.4 / f64::from(distance)).min(1.0);
        let cos_min = if sin < 1.0 { (1.0 - sin * sin).sqrt() } else { -1.0 };
        let integral = |light: &dyn Light, shape: &dyn Shape| {
            integrate_cap(axis, cos_min, [1500, 1500], |w| {
                let surface = hit_by(shape, &at, w);
                surface.map_or(0.0, |s| f64::from(light.pdf(&at, 0, w, Some(&s))))
            })
        };
        let rectangle = ParallelogramLight::new(square, ONE).with_two_sided(true);
        let parallelogram = ParallelogramLight::new(skew, ONE).with_two_sided(true);
        let by_area = ShapeLight::new(Arc::new(skew), None, ONE, true);
        for (name, light, shape) in [
            ("rectangle", &rectangle as &dyn Light, &square as &dyn Shape),
            ("parallelogram", &parallelogram, &skew),
            ("shape", &by_area, &skew),
            ("sphere", &SphereLight { two_sided: true, ..SphereLight::new(ball, ONE) }, &ball),
        ] {
            let mass = integral(light, shape);
            assert!((mass - 1.0).abs() < 5e-3, "{name} from {distance}: {mass}");
        }
        // A triangle: half of the skew parallelogram.
        let corners = [skew.origin(), skew.origin() + skew.edge_u(), skew.origin() + skew.edge_v()];
        let mesh = MeshLight::new(triangle(corners), None, ONE, true);
        let mass = integrate_cap(axis, cos_min, [1500, 1500], |w| {
            let ray = Ray::new(at.p, w);
            let hit = skew.intersect(&ray).filter(|h| h.uv.x + h.uv.y <= 1.0);
            hit.map_or(0.0, |h| f64::from(mesh.pdf(&at, 0, w, Some(&skew.surface(&ray, &h)))))
        });
        assert!((mass - 1.0).abs() < 5e-3, "triangle from {distance}: {mass}");
    }
}

/// The switch between solid angle and area is where it is said to be, and both say nearly the same density there.
#[test]
fn the_switch_is_seamless() {
    let mesh = MeshLight::new(triangle([Vec3A::ZERO, Vec3A::X, Vec3A::Z]), None, ONE, true);
    let omega = |h: f32| 0.5 / (h * h);
    let h = (0.5 / warp::MIN_SOLID_ANGLE as f32).sqrt();
    for (h, name) in [(h * 0.99, "solid angle"), (h * 1.01, "area")] {
        let at = free(Vec3A::new(1.0 / 3.0, -h, 1.0 / 3.0));
        let s = agrees(&mesh, &at, 0, Vec2::new(0.3, 0.4)).expect("in sight");
        assert!((s.pdf * omega(h) - 1.0).abs() < 2e-3, "{name}: {}", s.pdf * omega(h));
    }
}

#[test]
fn degenerate_triangles_are_dark() {
    let flat = [Vec3A::ZERO, Vec3A::X, Vec3A::X * 2.0];
    let nan = [Vec3A::ZERO, Vec3A::X, Vec3A::splat(f32::NAN)];
    for corners in [flat, nan] {
        let light = MeshLight::new(triangle(corners), None, ONE, true);
        assert_eq!(light.power(0, 1.0), Spectrum::BLACK);
        assert!(light.sample(&free(Vec3A::Y), 0, Vec2::splat(0.5)).is_none());
    }
    let light = MeshLight::new(triangle(flat), None, ONE, true);
    assert!(light.sample(&free(Vec3A::Y), 7, Vec2::splat(0.5)).is_none(), "no such part");
    assert_eq!(light.pdf(&free(Vec3A::Y), 7, Vec3A::Y, None), 0.0);
}

/// π A L from a constant, the grid's mean from an image, and never zero where a texel may shine.
#[test]
fn powers() {
    let pi = std::f32::consts::PI;
    let lit = MeshLight::new(triangle([Vec3A::ZERO, Vec3A::X * 2.0, Vec3A::Z]), None, ONE, false);
    assert!((lit.power(0, 1.0).g() / pi - 1.0).abs() < 1e-6);
    let both =
        SphereLight { two_sided: true, ..SphereLight::new(Sphere::new(Vec3A::ZERO, 0.5).expect("ok"), ONE) };
    assert!((both.power(0, 1.0).b() / (2.0 * pi * pi) - 1.0).abs() < 1e-6);
    // One bright texel of 256, which an 8 × 8 grid may miss.
    let mut data = vec![0.0f32; 256 * 3];
    data[3 * 77] = 100.0;
    let image = ImageTexture::from_f32(16, 16, 3, data).expect("sizes agree").with_filter(Filter::Nearest);
    let quad = presets::quad(Vec3A::ZERO, Vec3A::X, Vec3A::Z);
    let light = MeshLight::new(Arc::new(quad), None, Tex::image(Arc::new(image)), false);
    for part in 0..2 {
        let power = light.power(part, 1.0);
        assert!(power.r() > 0.0 && power.g() == 0.0, "{power:?}");
    }
    let halves = ImageTexture::from_u8(2, 1, 1, vec![0, 255], Encoding::Linear).expect("sizes agree");
    let shared = Tex::image(Arc::new(halves.with_filter(Filter::Nearest)));
    let quad = MeshLight::new(Arc::new(presets::quad(Vec3A::ZERO, Vec3A::X, Vec3A::Z)), None, shared, false);
    let total = quad.power(0, 1.0) + quad.power(1, 1.0);
    assert!((total.r() / (0.5 * pi) - 1.0).abs() < 0.05, "{total:?}");
}

/// Positions × 2^k, intensity × 4^k: the same directions, radiances and densities to the bit.
#[test]
fn scaling_by_powers_of_two_is_exact() {
    let mut rng = Rng(17);
    for round in 0..400 {
        let points: Vec<Vec3A> = (0..6).map(|_| rng.point()).collect();
        let (u, normal) = (rng.pair(), etendue_core::vector::normalize(rng.point()));
        let far = 2f32.powi(round % 12 - 3);
        let sample = |scale: f32| {
            let p: Vec<Vec3A> = points.iter().map(|&p| p * scale).collect();
            let at = receiver(points[5] * (far * scale), normal);
            let m = Transform::from_columns(Vec3A::X * 0.5, Vec3A::Y * 1.5, Vec3A::Z, p[4]).expect("regular");
            let mesh = Arc::new(presets::quad(p[0], p[1], p[2]));
            let shape = Parallelogram::new(p[0], p[1], p[2]).expect("an area");
            let flat = Parallelogram::new(p[0], Vec3A::X * scale, Vec3A::Y * scale).expect("an area");
            let sphere = Sphere::new(p[0], 0.3 * scale).expect("a sphere");
            let disc = Disc::new(p[0], p[1], 0.3 * scale).expect("a disc");
            let lights: [Arc<dyn Light>; 8] = [
                Arc::new(DiscLight { two_sided: true, ..DiscLight::new(disc, ONE) }),
                Arc::new(PointLight::new(p[3], Spectrum::gray(scale * scale))),
                Arc::new(MeshLight::new(mesh.clone(), None, ONE, true)),
                Arc::new(MeshLight::new(mesh, Some(m), ONE, true)),
                Arc::new(ParallelogramLight::new(flat, ONE).with_two_sided(true)),
                Arc::new(SphereLight { two_sided: true, ..SphereLight::new(sphere, ONE) }),
                Arc::new(ShapeLight::new(Arc::new(shape), Some(m), ONE, true)),
                Arc::new(ConstantEnvironment::new(Spectrum::ONE)),
            ];
            lights.map(|l| {
                let mut s = l.sample(&at, 0, u)?;
                let surface = seen(s.end, 0);
                let pdf = l.pdf(&at, 0, s.wi, surface.as_ref());
                if let Some(end) = &mut s.end {
                    end.p /= scale;
                    end.p_err /= scale;
                }
                Some((s, pdf, l.power(0, scale) / (scale * scale)))
            })
        };
        let plain = sample(1.0);
        for k in [-20, -7, -1, 1, 3, 20] {
            assert_eq!(sample(2f32.powi(k)), plain, "round {round}, 2^{k}");
        }
    }
}
