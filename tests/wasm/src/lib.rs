//! One scene with every kind of BSDF, light and texture and a cut-out, rendered wherever this runs: the digest of
//! the film must be the same on x86-64 and in wasm.

use std::sync::Arc;

use etendue::camera::Filter;
use etendue::geometry::presets as meshes;
use etendue::material::{Absorber, Cutout, MirrorMaterial, RoughGlass};
use etendue::prelude::*;
use etendue::texture::{Channel, Encoding, ImageUse, ScalarTex};

type Any = Box<dyn std::error::Error>;

fn checker(side: u32, channels: u32) -> Result<Arc<ImageTexture>, Any> {
    let data = (0..side * side)
        .flat_map(|i| {
            let on = (i % side + i / side).is_multiple_of(2);
            (0..channels).map(move |c| if on { 230 - 40 * c as u8 } else { 30 + 20 * c as u8 })
        })
        .collect();
    Ok(Arc::new(ImageTexture::from_u8(side, side, channels, data, Encoding::Srgb)?))
}

fn scene() -> Result<Scene, Any> {
    let mut b = SceneBuilder::new();
    let textured = b.material(Diffuse::new(Tex::image(checker(8, 3)?)));
    let glass = b.material(etendue::material::Glass::new(1.5));
    let rough_glass = b.material(RoughGlass::new(1.4, 0.3));
    let gold = b.material(Metal::gold(0.2));
    let schlick = b.material(Metal::schlick(Spectrum::rgb(0.9, 0.6, 0.3), 0.5));
    let mirror = b.material(MirrorMaterial::new(Spectrum::gray(0.9)));
    let black = b.material(Absorber);
    let holes = ScalarTex::image(ImageUse::new(checker(4, 1)?), Channel::R);
    let cutout = b.material(Cutout::new(Diffuse::new(Spectrum::rgb(0.2, 0.6, 0.3)), holes));

    b.add(Plane::new(Vec3A::new(0.0, -1.0, 0.0), Vec3A::Y)?, textured);
    for (i, m) in [glass, rough_glass, gold, schlick, mirror, black].into_iter().enumerate() {
        let x = i as f32 * 0.9 - 2.25;
        b.add(Sphere::new(Vec3A::new(x, -0.6 + 0.1 * i as f32, -0.3 * i as f32), 0.4)?, m);
    }
    let ring = b.add_grouped(meshes::torus(0.5, 0.2, 24, 12), textured);
    let ring = b.group(&[ring]);
    let turned = Transform::translation(Vec3A::new(0.0, 0.8, -1.0)).after(&Transform::rotation(Vec3A::X, 1.2))?;
    b.instance(ring, turned);
    b.instance(ring, Transform::translation(Vec3A::new(1.5, 0.9, -1.5)).after(&Transform::scale(Vec3A::new(-0.7, 1.1, 0.6))?)?);
    let sail = meshes::quad(Vec3A::new(-2.0, 0.0, -1.5), Vec3A::X * 1.5, Vec3A::Y * 1.2);
    b.add(Geometry::mesh(sail), cutout);

    let lamp = b.add(Geometry::mesh(meshes::icosphere(1, 0.3)), black);
    b.emit(lamp, Emission::new(Tex::image(checker(4, 3)?)));
    let ball = b.add(Sphere::new(Vec3A::new(2.5, 2.0, 0.5), 0.25)?, black);
    b.emit(ball, Emission::new(Spectrum::rgb(8.0, 7.0, 5.0)));
    let panel = b.add(Parallelogram::new(Vec3A::new(-2.0, 2.5, 0.0), Vec3A::Z * 0.8, Vec3A::X * 0.9)?, black);
    b.emit(panel, Emission::new(Spectrum::rgb(3.0, 4.0, 6.0)).two_sided());
    b.light(PointLight::new(Vec3A::new(0.0, 3.0, 2.0), Spectrum::gray(12.0)));
    let sky: Vec<f32> = (0..16 * 8 * 3).map(|i| 0.05 + 0.4 * ((i * 37 % 101) as f32 / 101.0)).collect();
    b.light(ImageEnvironment::new(ImageTexture::from_f32(16, 8, 3, sky)?, 1.0, 0.0)?);
    b.light(ConstantEnvironment::new(Spectrum::gray(0.1)));
    Ok(b.build()?)
}

fn film() -> Result<Film, Any> {
    let scene = scene()?;
    let size = UVec2::new(48, 32);
    let camera = Perspective::look_at(Vec3A::new(0.3, 1.0, 5.5), Vec3A::new(0.0, 0.2, 0.0), Vec3A::Y, 42.0, size)?
        .with_lens(0.03, 5.0)?;
    let mut film = Film::with_planes(size, 1, Planes::ALL)?;
    for filter in [Filter::default(), Filter::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 }, Filter::Tent { radius: 1.0 }] {
        let options = RenderOptions { filter, ..RenderOptions::default() };
        render(&scene, &camera, &PathTracer::default(), Sobol::new(3, 8), &mut film, &options)?;
        render(&scene, &camera, &PathTracer::default(), Stratified::new(3, 4), &mut film, &options)?;
        render(&scene, &camera, &PathTracer::default(), Independent::new(3, 4), &mut film, &options)?;
    }
    Ok(film)
}

/// The digest of the film; 0 where the scene could not be built.
pub fn digest() -> u128 {
    film().map_or(0, |f| f.digest())
}

/// The lower half of the digest.
#[unsafe(no_mangle)]
pub extern "C" fn digest_low() -> u64 {
    digest() as u64
}

/// The upper half of the digest.
#[unsafe(no_mangle)]
pub extern "C" fn digest_high() -> u64 {
    (digest() >> 64) as u64
}
