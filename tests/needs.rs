//! No cost for what a scene does not have: exact zeros, counted.

mod support;

use etendue::integrator::Counts;
use etendue::prelude::*;

fn counts(build: impl FnOnce(&mut SceneBuilder), lens: f32) -> (Counts, Needs) {
    let mut b = SceneBuilder::new();
    build(&mut b);
    let scene = b.build().unwrap();
    let camera = Perspective::look_at(Vec3A::Z * 4.0, Vec3A::ZERO, Vec3A::Y, 40.0, UVec2::splat(16)).unwrap();
    let camera = camera.with_lens(lens, 4.0).unwrap();
    let mut film = Film::new(UVec2::splat(16), 1).unwrap();
    let o = RenderOptions::default();
    let report = render(&scene, &camera, &PathTracer::default(), Sobol::new(1, 8), &mut film, &o).unwrap();
    assert_eq!(report.rejected, 0);
    (report.counts, report.needs)
}

fn sphere(b: &mut SceneBuilder, m: impl Material + 'static) {
    let m = b.material(m);
    b.add(Sphere::new(Vec3A::ZERO, 1.0).unwrap(), m);
}

const SAMPLES: u64 = 16 * 16 * 8;

#[test]
fn a_scene_without_light_costs_camera_rays_at_most() {
    let (c, needs) = counts(|b| sphere(b, Diffuse::new(Spectrum::gray(0.5))), 0.0);
    let expected = Counts { camera_rays: SAMPLES, draws_film: 2 * SAMPLES, ..Counts::default() };
    assert_eq!(c, expected);
    assert_eq!(needs, Needs::empty());
}

#[test]
fn an_empty_scene_is_valid() {
    let (c, _) = counts(|_| {}, 0.0);
    assert_eq!(c.rays(), SAMPLES);
}

#[test]
fn mirrors_in_a_sky_sample_no_light() {
    let (c, needs) = counts(
        |b| {
            sphere(b, etendue::material::MirrorMaterial::new(Spectrum::ONE));
            b.light(ConstantEnvironment::new(Spectrum::ONE));
        },
        0.0,
    );
    assert!(needs.contains(Needs::ENVIRONMENT | Needs::DELTA) && !needs.contains(Needs::TEXTURES));
    assert!(c.scatter_rays > 0 && c.escapes == SAMPLES);
    assert_eq!((c.shadow_rays, c.light_picks, c.draws_light, c.mis_weights), (0, 0, 0, 0));
    assert_eq!((c.texture_fetches, c.draws_lens, c.draws_time, c.draws_cutout), (0, 0, 0, 0));
}

#[test]
fn a_point_light_has_no_other_side_to_weigh() {
    let (c, needs) = counts(
        |b| {
            sphere(b, Diffuse::new(Spectrum::gray(0.5)));
            b.light(PointLight::new(Vec3A::new(2.0, 2.0, 2.0), Spectrum::gray(10.0)));
        },
        0.0,
    );
    assert!(!needs.intersects(Needs::ENVIRONMENT | Needs::MANY_LIGHTS | Needs::AREA_LIGHTS));
    assert!(c.light_picks > 0 && c.shadow_rays > 0);
    assert_eq!((c.mis_weights, c.escapes, c.texture_fetches), (0, 0, 0));
    // The far half of the sphere faces away from the light: no shadow ray leaves it.
    assert!(c.shadow_rays < c.light_picks);
}

#[test]
fn a_lens_is_drawn_for_only_where_there_is_one() {
    let build = |b: &mut SceneBuilder| sphere(b, Diffuse::new(Spectrum::gray(0.5)));
    assert_eq!(counts(build, 0.0).0.draws_lens, 0);
    assert_eq!(counts(build, 0.1).0.draws_lens, 2 * SAMPLES);
}

#[test]
fn constants_are_not_fetched_and_textures_are() {
    let image = ImageTexture::from_f32(2, 1, 3, vec![0.2, 0.4, 0.6, 0.5, 0.5, 0.5]).unwrap();
    let (c, needs) = counts(
        |b| {
            sphere(b, Diffuse::new(Tex::image(std::sync::Arc::new(image))));
            b.light(ConstantEnvironment::new(Spectrum::ONE));
        },
        0.0,
    );
    assert!(needs.contains(Needs::TEXTURES));
    assert!(c.texture_fetches > 0);
}
