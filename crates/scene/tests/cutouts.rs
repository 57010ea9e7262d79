//! Surfaces with holes: how many rays pass, and that it is a function of the ray alone.

mod common;

use common::{gray, radiance, square};
use etendue_bsdf::{Black, BsdfAt};
use etendue_camera::{Camera, Film, Perspective};
use etendue_core::{Needs, Origin, Ray, Segment, Spectrum, Transform, UVec2, Vec3A, Vec4};
use etendue_geometry::Surface;
use etendue_geometry::{Parallelogram, Sphere, presets};
use etendue_integrator::{DirectLight, PathTracer, RenderOptions, render};
use etendue_light::{ConstantEnvironment, PointLight};
use etendue_material::{AlphaPoint, Cutout, Diffuse, Material};
use etendue_sampling::{Dim, Independent, Sampler, Slot, Sobol};
use etendue_scene::{Scene, SceneBuilder};
use etendue_testkit::stats::{binomial_test, chi2_test, mean_test};
use etendue_texture::{Channel, Filter, ImageTexture, ImageUse, ScalarTex};
use std::sync::Arc;

const N: u64 = 200_000;

/// Random bits as an integrator draws them.
fn bits() -> impl Iterator<Item = u32> {
    let sampler = Independent::new(5, 1);
    (0..N).map(move |i| sampler.start(i, 0).bits_1d(Dim::bounce(0, Slot::Cutout)))
}

/// An opacity that comes out of a picture of one texel.
fn textured(opacity: f32) -> ScalarTex {
    let image = ImageTexture::from_f32(1, 1, 1, vec![opacity]).unwrap();
    ScalarTex::image(ImageUse::new(Arc::new(image)), Channel::R)
}

fn leaf(opacity: impl Into<ScalarTex>) -> Cutout<Diffuse> {
    Cutout::new(Diffuse::new(Spectrum::gray(0.5)), opacity)
}

fn toward() -> Ray {
    Ray::new(Vec3A::new(0.1, 0.2, 5.0), Vec3A::NEG_Z)
}

fn segment() -> Segment {
    Segment {
        from: Origin::free(toward().o),
        d: Vec3A::NEG_Z,
        to: Some(Origin::free(Vec3A::new(0.1, 0.2, -5.0))),
        time: 0.0,
    }
}

/// 0.3 stops 30 %; a share wrong by 1.8 % (0.0051) is five standard errors. Rays and shadow rays alike.
#[test]
fn rays_are_stopped_by_their_share() {
    for opacity in [0.01, 0.3, 0.5, 0.99] {
        let mut b = SceneBuilder::new();
        let m = b.material(leaf(textured(opacity)));
        b.add(square(0.0), m);
        let scene = b.build().unwrap();
        assert!(scene.needs().contains(Needs::CUTOUTS | Needs::TEXTURES));
        let stopped = bits().filter(|&u| scene.intersect(&toward(), u).is_some()).count() as u64;
        let test = binomial_test(stopped, N, f64::from(opacity));
        assert!(!test.rejects(1e-6), "{opacity}: {test:?}");
        assert!(5.0 * test.standard_error < 0.0056);
        for u in bits().take(5000) {
            let light = scene.transmittance(&segment(), u);
            assert_eq!(light.is_black(), scene.intersect(&toward(), u).is_some(), "one ray, one answer");
            assert!(light.is_black() || light == Spectrum::ONE);
        }
    }
    // The mutant that decides by the square of the opacity.
    let mutant = (0.3f64 * 0.3 * N as f64) as u64;
    assert!(binomial_test(mutant, N, 0.3).rejects(1e-6));
}

/// Layers, triangles and instances decide for themselves: what passes two of them is the product.
#[test]
fn layers_are_independent() {
    let mut b = SceneBuilder::new();
    let m = b.material(leaf(0.3));
    b.add(square(0.0), m);
    b.add(square(1.0), m);
    let mesh = presets::quad(Vec3A::new(-1.0, -1.0, 2.0), Vec3A::X * 2.0, Vec3A::Y * 2.0);
    let grouped = b.add_grouped(mesh, m);
    let group = b.group(&[grouped]);
    b.instance(group, Transform::IDENTITY);
    b.instance(group, Transform::translation(Vec3A::Z * 0.5));
    let scene = b.build().unwrap();
    // Which of the four layers stops the ray first, from above; 4 is none.
    let mut counts = [0u64; 5];
    for u in bits() {
        let layer = scene.intersect(&toward(), u).map_or(4, |h| match (h.inst, h.geom) {
            (1, _) => 0,
            (0, _) => 1,
            (_, 1) => 2,
            _ => 3,
        });
        counts[layer] += 1;
    }
    let pass = 0.7f64;
    let expected =
        [0.3, 0.3 * pass, 0.3 * pass.powi(2), 0.3 * pass.powi(3), pass.powi(4)].map(|p| p * N as f64);
    let test = chi2_test(&counts, &expected);
    assert!(test.p > 1e-6, "{counts:?} for {expected:?}");
    // If the layers decided alike, 70 % would pass: far off.
    assert!(chi2_test(&[60_000, 0, 0, 0, 140_000], &expected).p < 1e-6);
}

#[test]
fn bounds_of_opacity_are_exact() {
    for (opacity, stops) in [(0.0, false), (-1.0, false), (f32::NAN, false), (1.0, true), (7.0, true)] {
        let mut b = SceneBuilder::new();
        let m = b.material(leaf(textured_or(opacity)));
        b.add(square(0.0), m);
        let scene = b.build().unwrap();
        assert!(bits().take(20_000).all(|u| scene.intersect(&toward(), u).is_some() == stops), "{opacity}");
        let extremes = [0, 1, u32::MAX, u32::MAX - 1, 1 << 31];
        assert!(extremes.iter().all(|&u| scene.intersect(&toward(), u).is_some() == stops), "{opacity}");
    }
}

/// Pictures hold finite numbers only.
fn textured_or(opacity: f32) -> ScalarTex {
    if opacity.is_finite() { textured(opacity) } else { opacity.into() }
}

#[test]
fn opacity_follows_the_texture_and_the_vertices() {
    // Left half a hole, right half solid.
    let image = ImageTexture::from_f32(2, 1, 1, vec![0.0, 1.0]).unwrap().with_filter(Filter::Nearest);
    let opacity = ScalarTex::image(ImageUse::new(Arc::new(image)), Channel::R);
    for mesh in [false, true] {
        let mut b = SceneBuilder::new();
        let m = b.material(leaf(opacity.clone()));
        let (o, u, v) = (Vec3A::new(-1.0, -1.0, 0.0), Vec3A::X * 2.0, Vec3A::Y * 2.0);
        if mesh {
            b.add(presets::quad(o, u, v), m);
        } else {
            b.add(Parallelogram::new(o, u, v).unwrap(), m);
        }
        let scene = b.build().unwrap();
        for (x, solid) in [(-0.9, false), (-0.1, false), (0.1, true), (0.9, true)] {
            let ray = Ray::new(Vec3A::new(x, 0.3, 1.0), Vec3A::NEG_Z);
            assert!(
                bits().take(200).all(|u| scene.intersect(&ray, u).is_some() == solid),
                "{x}, mesh {mesh}"
            );
        }
    }
    // Vertex alpha from 0 on the left to 1 on the right, cut at a half.
    let quad = presets::quad(Vec3A::new(-1.0, -1.0, 0.0), Vec3A::X * 2.0, Vec3A::Y * 2.0);
    let alpha = |a: f32| Vec4::new(1.0, 1.0, 1.0, a);
    let quad = quad.with_colors([0.0, 1.0, 1.0, 0.0].map(alpha).to_vec()).unwrap();
    let mut b = SceneBuilder::new();
    let m = b.material(Cutout { vertex_alpha: true, ..leaf(1.0).with_threshold(0.5) });
    b.add(quad, m);
    let scene = b.build().unwrap();
    for (x, solid) in [(-0.5, false), (-0.01, false), (0.01, true), (0.5, true)] {
        let ray = Ray::new(Vec3A::new(x, 0.3, 1.0), Vec3A::NEG_Z);
        assert!(bits().take(200).all(|u| scene.intersect(&ray, u).is_some() == solid), "{x}");
    }
}

#[test]
fn what_is_solid_everywhere_needs_no_filter() {
    let mut b = SceneBuilder::new();
    let m = b.material(leaf(1.0));
    b.add(square(0.0), m);
    assert!(!b.build().unwrap().needs().contains(Needs::CUTOUTS));
}

/// A leaf of opacity 0.3 between a floor and the light: 70 % of the light arrives, however it is found.
#[test]
fn light_through_a_leaf() {
    let build = |point: bool| {
        let mut b = SceneBuilder::new();
        let floor = gray(&mut b);
        let m = b.material(Cutout::new(Diffuse::new(Spectrum::BLACK), textured(0.3)));
        b.add(square(0.0), floor);
        b.add(Sphere::new(Vec3A::ZERO, 3.0).unwrap(), m);
        if point {
            b.light(PointLight::new(Vec3A::Z * 10.0, Spectrum::gray(100.0)));
        } else {
            b.light(ConstantEnvironment::new(Spectrum::ONE));
        }
        b.build().unwrap()
    };
    let down = Ray::new(Vec3A::new(0.0, 0.0, 1.0), Vec3A::NEG_Z);
    // E = 100 / 10² = 1 and E = π.
    for (point, unblocked) in [(true, 0.5 / std::f64::consts::PI), (false, 0.5)] {
        let scene = build(point);
        for direct in [DirectLight::Light, DirectLight::Bsdf, DirectLight::MisPower] {
            let xs = radiance(&scene, &PathTracer { direct, ..PathTracer::default() }, down, 8, 60_000);
            let test = mean_test(&xs, 0.7 * unblocked);
            assert!(!test.rejects(1e-6), "point {point}, {direct:?}: {test:?}");
            // 2 % off would be five standard errors.
            assert!(5.0 * test.standard_error < 0.02 * 0.7 * unblocked, "{test:?}");
        }
    }
}

fn leaves() -> (Scene, Perspective) {
    let mut b = SceneBuilder::new();
    let floor = gray(&mut b);
    let m = b.material(leaf(textured(0.4)));
    b.add(presets::cuboid(Vec3A::new(-3.0, -3.0, -1.0), Vec3A::new(3.0, 3.0, -0.9)), floor);
    for i in 0..6 {
        b.add(square(i as f32 * 0.2), m);
    }
    let grouped = b.add_grouped(presets::icosphere(1, 0.7), m);
    let group = b.group(&[grouped]);
    b.instance(group, Transform::translation(Vec3A::new(0.5, 0.0, 1.5)));
    b.light(ConstantEnvironment::new(Spectrum::ONE));
    let camera =
        Perspective::look_at(Vec3A::new(0.5, 1.0, 6.0), Vec3A::ZERO, Vec3A::Y, 40.0, UVec2::splat(24));
    (b.build().unwrap(), camera.unwrap())
}

#[test]
fn a_picture_with_holes_is_a_function_of_its_inputs() {
    let (scene, camera) = leaves();
    let film = |tile: u32| {
        let mut film = Film::new(camera.resolution(), 1).unwrap();
        let options = RenderOptions { tile, ..RenderOptions::default() };
        let report =
            render(&scene, &camera, &PathTracer::default(), Sobol::new(3, 8), &mut film, &options).unwrap();
        assert!(report.counts.draws_cutout > 0 && report.rejected == 0);
        film
    };
    let first = film(16);
    for tile in [5, 16, 64] {
        assert!(film(tile) == first, "{tile}");
    }
    // Built again, with the layers in another order of numbers but the same place: another choice of holes, so other
    // bits; the same scene built twice has the same bits.
    let (again, camera) = leaves();
    let mut other = Film::new(camera.resolution(), 1).unwrap();
    let options = RenderOptions::default();
    render(&again, &camera, &PathTracer::default(), Sobol::new(3, 8), &mut other, &options).unwrap();
    assert!(other == first);
}

/// A user's material with an opacity of its own.
struct Odd(f32);

impl Material for Odd {
    fn bsdf<'a>(&'a self, _: &Surface) -> BsdfAt<'a> {
        BsdfAt::Black(Black)
    }
    fn opacity(&self, _: &AlphaPoint<'_>) -> f32 {
        self.0
    }
    fn needs(&self) -> Needs {
        Needs::CUTOUTS
    }
}

/// What is said of a surface is what rays do there, whatever its material says.
#[test]
fn opacities_are_shares() {
    for (says, is) in [(0.25, 0.25), (1.5, 1.0), (-0.5, 0.0), (f32::NAN, 0.0), (f32::INFINITY, 1.0)] {
        let mut b = SceneBuilder::new();
        let m = b.material(Odd(says));
        b.add(square(0.0), m);
        let scene = b.build().unwrap();
        let stopped = bits().take(4000).filter(|&bits| scene.intersect(&toward(), bits).is_some()).count();
        let share = stopped as f32 / 4000.0;
        assert!((share - is).abs() < 0.05, "{says}: {share}");
        let mut whole = SceneBuilder::new();
        let m = whole.material(Odd(1.0));
        whole.add(square(0.0), m);
        let hit = whole.build().unwrap().intersect(&toward(), 0).unwrap();
        let surface = scene.surface(&toward(), &hit, 0.0);
        assert_eq!(scene.opacity(&surface), is, "{says}");
    }
}
