//! Bodies that absorb, and normals that textures turn, against closed forms.

mod support;

use std::f64::consts::PI;
use std::sync::Arc;

use etendue::geometry::presets as meshes;
use etendue::material::RoughGlass;
use etendue::prelude::*;
use etendue::texture::ImageUse;
use etendue_testkit::stats::mean_test;
use support::{WAYS, assert_mean, film_of, lamp, path, radiance};

/// A slab of thickness `d` across the view, a lamp of radiance 1 behind it.
fn slab(material: impl Material + 'static, d: f32) -> Scene {
    let mut b = SceneBuilder::new();
    let m = b.material(material);
    let (x, y) = (Vec3A::X * 20.0, Vec3A::Y * 20.0);
    let corner = Vec3A::new(-10.0, -10.0, 0.0);
    b.add(Parallelogram::new(corner, x, y).unwrap(), m);
    b.add(Parallelogram::new(corner - Vec3A::Z * d, y, x).unwrap(), m);
    lamp(&mut b, Parallelogram::new(corner - Vec3A::Z * 3.0, x, y).unwrap());
    b.build().unwrap()
}

/// Straight through, T = (1 − F)² e^(−σd) / (1 − F² e^(−2σd)) with all inner reflections; without an interface
/// e^(−σd). Both in every way of finding light, and for the material of glTF.
#[test]
fn a_slab_absorbs_by_its_thickness() {
    let view = |_: &Independent| Ray::new(Vec3A::new(0.1, 0.2, 2.0), Vec3A::NEG_Z);
    for (eta, sigma, d) in [(1.5f64, 0.7f64, 0.8f64), (1.0, 1.3, 0.5), (2.4, 0.2, 2.0)] {
        let f = ((eta - 1.0) / (eta + 1.0)).powi(2);
        let t =
            |sigma: f64| (1.0 - f).powi(2) * (-sigma * d).exp() / (1.0 - f * f * (-2.0 * sigma * d).exp());
        let absorption = Spectrum::gray(sigma as f32);
        for direct in WAYS {
            let glass = slab(Glass { absorption, ..Glass::new(eta as f32) }, d as f32);
            assert!(glass.needs().contains(Needs::ABSORPTION));
            let xs = radiance(&glass, &path(direct), 5, 20_000, &view);
            assert_mean(&xs, t(sigma), 0.05, &format!("eta {eta}, {direct:?}"));
            // Mutants: nothing absorbed, and twice as much.
            assert!(mean_test(&xs, t(0.0)).rejects(1e-6) && mean_test(&xs, t(2.0 * sigma)).rejects(1e-6));
        }
        let clear = |transmission: f32, thin: bool| Principled {
            transmission: transmission.into(),
            ior: eta as f32,
            absorption,
            thin,
            ..Principled::new(Spectrum::ONE, 0.0, 0.0)
        };
        let xs = radiance(&slab(clear(1.0, false), d as f32), &PathTracer::default(), 6, 20_000, &view);
        assert_mean(&xs, t(sigma), 0.05, &format!("principled, eta {eta}"));
        // A thin wall has no inside: two of them reflect like the slab and absorb nothing.
        let walls = slab(clear(1.0, true), d as f32);
        assert!(!walls.needs().contains(Needs::ABSORPTION));
        let xs = radiance(&walls, &PathTracer::default(), 7, 20_000, &view);
        assert_mean(&xs, t(0.0), 0.05, &format!("thin walls, eta {eta}"));
    }
}

/// A lamp and a floor inside of a ball of ink without an interface: the light is absorbed on its way to the floor and
/// from there to the rim, I/h² · ρ/π · e^(−σ (h + r)), whether the lamp is drawn or met.
#[test]
fn shadow_rays_are_absorbed_where_they_are() {
    let (sigma, h, r, radius) = (0.9f64, 0.5f64, 2.0f64, 0.02f64);
    let mut b = SceneBuilder::new();
    let ink = b.material(Glass { absorption: Spectrum::gray(sigma as f32), ..Glass::new(1.0) });
    let floor = b.material(Diffuse::new(Spectrum::gray(0.8)));
    b.add(Sphere::new(Vec3A::ZERO, r as f32).unwrap(), ink);
    b.add(Parallelogram::new(Vec3A::new(-0.5, 0.0, 0.5), Vec3A::X, Vec3A::NEG_Z).unwrap(), floor);
    // Beside the view, so that it hides nothing.
    let lamp_at = Vec3A::new(h as f32, h as f32, 0.0);
    lamp(&mut b, Sphere::new(lamp_at, radius as f32).unwrap());
    let scene = b.build().unwrap();
    let view = |_: &Independent| Ray::new(Vec3A::new(0.0, 5.0, 0.0), Vec3A::NEG_Y);
    let distance = h * 2f64.sqrt();
    // A sphere's irradiance is exactly that of a point: π sin² of its cone, times the cosine.
    let irradiance = PI * (radius / distance).powi(2) * (h / distance);
    let clear = 0.8 / PI * irradiance;
    let xs = radiance(&scene, &PathTracer::default(), 8, 20_000, &view);
    // From the lamp's surface on, averaged over the sine squared from its middle, which is what irradiance weighs by.
    let way: f64 = (0..1000)
        .map(|i| (f64::from(i) + 0.5) / 1000.0 * (radius / distance).powi(2))
        .map(|sin2| distance * (1.0 - sin2).sqrt() - (radius * radius - distance * distance * sin2).sqrt())
        .map(|l| (-sigma * l).exp() / 1000.0)
        .sum();
    let truth = clear * way * (-sigma * r).exp();
    for direct in [DirectLight::Light, DirectLight::MisPower] {
        let xs = radiance(&scene, &path(direct), 9, 20_000, &view);
        assert_mean(&xs, truth, 0.06, &format!("ink, {direct:?}"));
    }
    let met = radiance(&scene, &path(DirectLight::Bsdf), 10, 2_000_000, &view);
    assert_mean(&met, truth, 0.2, "ink, met");
    // Mutant: the shadow ray not absorbed.
    assert!(mean_test(&xs, clear * (-sigma * r).exp()).rejects(1e-6));
}

/// Where nothing absorbs on the way, the machinery for it changes no bit.
#[test]
fn clear_bodies_keep_their_bits() {
    let picture = |sigma: f32| {
        let mut p = etendue::scene::presets::cornell_box();
        // Under the floor, where no light comes.
        let ink =
            p.builder.material(RoughGlass { absorption: Spectrum::gray(sigma), ..RoughGlass::new(1.5, 0.3) });
        p.builder.add(Sphere::new(Vec3A::new(0.0, -0.3, 0.0), 0.1).unwrap(), ink);
        let camera = Perspective::look_at(p.eye, p.target, Vec3A::Y, p.vertical_fov_deg, UVec2::splat(32));
        let scene = p.builder.build().unwrap();
        assert_eq!(scene.needs().contains(Needs::ABSORPTION), sigma > 0.0);
        film_of(&scene, &camera.unwrap(), Sobol::new(3, 16), &RenderOptions::default()).digest()
    };
    assert_eq!(picture(0.0), picture(2.0));
}

fn map(width: u32, texels: &[[f32; 3]]) -> ImageUse {
    let data = texels.iter().flatten().copied().collect();
    let image = etendue::texture::ImageTexture::from_f32(width, texels.len() as u32 / width, 3, data);
    ImageUse::new(Arc::new(image.unwrap()))
}

/// A map of exactly (0.5, 0.5, 1) leaves the picture bit for bit; one that leans does not.
#[test]
fn a_flat_map_changes_nothing() {
    let picture = |texel: Option<[f32; 3]>| {
        let mut p = etendue::scene::presets::empty_cornell_box();
        let white = Diffuse::new(Spectrum::gray(0.7));
        let m = match texel {
            Some(t) => p.builder.material(NormalMapped::new(white, map(1, &[t]))),
            None => p.builder.material(white),
        };
        p.builder.add(Sphere::new(Vec3A::new(0.0, 0.3, 0.0), 0.25).unwrap(), m);
        p.builder.add(Geometry::mesh(meshes::icosphere(2, 0.2)), m);
        let camera = Perspective::look_at(p.eye, p.target, Vec3A::Y, p.vertical_fov_deg, UVec2::splat(32));
        let scene = p.builder.build().unwrap();
        assert_eq!(scene.needs().contains(Needs::NORMAL_MAPS), texel.is_some());
        film_of(&scene, &camera.unwrap(), Sobol::new(3, 16), &RenderOptions::default()).digest()
    };
    let plain = picture(None);
    assert_eq!(plain, picture(Some([0.5, 0.5, 1.0])));
    assert_ne!(plain, picture(Some([0.6, 0.5, 1.0])));
}

/// Under a light from straight above, a horizontal mirror of matte white that is mapped to lean by θ is as bright as cos θ,
/// and the film's normal is the mapped one.
#[test]
fn a_leaning_map_leans() {
    let (sin, cos) = (0.6f32, 0.8f32);
    let mut b = SceneBuilder::new();
    let leaning =
        NormalMapped::new(Diffuse::new(Spectrum::ONE), map(1, &[[0.5 + 0.5 * sin, 0.5, 0.5 + 0.5 * cos]]));
    let m = b.material(leaning);
    b.add(Parallelogram::new(Vec3A::new(-1.0, 0.0, 1.0), Vec3A::X * 2.0, Vec3A::Z * -2.0).unwrap(), m);
    b.light(PointLight::new(Vec3A::Y * 10.0, Spectrum::gray(100.0)));
    let scene = b.build().unwrap();
    let camera =
        Perspective::look_at(Vec3A::Y * 8.0, Vec3A::ZERO, Vec3A::NEG_Z, 0.5, UVec2::splat(2)).unwrap();
    let mut film = Film::with_planes(UVec2::splat(2), 1, Planes::ALL).unwrap();
    let options = RenderOptions::default();
    render(&scene, &camera, &PathTracer::default(), Sobol::new(1, 16), &mut film, &options).unwrap();
    let n = film.normal(UVec2::ZERO).unwrap();
    assert!((n - Vec3A::new(sin, cos, 0.0)).length() < 1e-4, "{n}");
    let (l, truth) = (f64::from(film.mean(UVec2::ZERO).g()), f64::from(cos) / PI);
    assert!((l / truth - 1.0).abs() < 2e-3, "{l} for {truth}");
}

/// A mirrored instance of a normal-mapped mesh looks like its mirror image, with tangents from the file or from texture
/// coordinates that run either way; the green channel points up in the image.
#[test]
fn mirrored_instances_look_mirrored() {
    let texels: Vec<[f32; 3]> =
        (0..16).map(|i| [0.3 + 0.05 * (i % 7) as f32, 0.7 - 0.04 * (i % 5) as f32, 0.9]).collect();
    let material = NormalMapped::new(Diffuse::new(Spectrum::ONE), map(4, &texels));
    let quad = || meshes::quad(Vec3A::new(-0.5, -0.5, 0.0), Vec3A::X, Vec3A::Y);
    let tangents = |w: f32| quad().with_tangents(vec![Vec4::new(1.0, 0.2, 0.0, w); 4]).unwrap();
    let flipped = || {
        let uv = quad().uv(0).iter().map(|t| Vec2::new(t.x, 1.0 - t.y)).collect();
        quad().with_uv(0, uv).unwrap()
    };
    for (name, mesh, up) in [
        ("tangents", tangents(1.0), 1.0),
        ("tangents, mirrored texture", tangents(-1.0), -1.0),
        // In the quad v grows along y, so the image's upper edge is at the bottom.
        ("coordinates", quad(), -1.0),
        ("coordinates turned over", flipped(), 1.0),
    ] {
        let mut b = SceneBuilder::new();
        let m = b.material(material.clone());
        let g = b.add_grouped(Geometry::mesh(mesh), m);
        let group = b.group(&[g]);
        let place =
            Transform::translation(Vec3A::X).after(&Transform::rotation(Vec3A::new(1.0, 0.2, 0.1), 0.3));
        let place = place.unwrap();
        b.instance(group, place);
        let mirror = Transform::scale(Vec3A::new(-1.0, 1.0, 1.0)).unwrap();
        b.instance(group, mirror.after(&place).unwrap());
        let scene = b.build().unwrap();
        let normal = |o: Vec3A, d: Vec3A| {
            let ray = Ray::new(o, d);
            let s = scene.surface(&ray, &scene.intersect(&ray, 0).expect("a hit"), 0.0);
            (scene.material(&s).unwrap().shading_frame(&s).z, s)
        };
        for i in 0..40 {
            let at = Vec3A::new((i % 7) as f32 * 0.1 + 0.7, (i % 5) as f32 * 0.12 - 0.25, 3.0);
            let flip = |v: Vec3A| Vec3A::new(-v.x, v.y, v.z);
            let d = Vec3A::NEG_Z;
            let ((n, s), (m, t)) = (normal(at, d), normal(flip(at), d));
            assert!((flip(n) - m).length() < 1e-5, "{name}: {n} and {m}");
            assert!(n.dot(s.shading.z) < 0.9999, "{name}: the map leans");
            // Mutant: the bitangent always to the left of the tangent.
            let wrong = t.shading.y;
            assert!(s.up_in_texture().dot(s.shading.y) * up > 0.9, "{name}");
            assert!(t.up_in_texture().dot(wrong) * up < -0.9, "{name}: the mirror turns the sense");
        }
    }
}
