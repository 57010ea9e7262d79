//! Bump maps against tilts known in closed form, and their policy.

use std::sync::Arc;

use etendue_core::{Fingerprint, Frame, Needs, Spectrum, Transform, Vec2, Vec3A, vector};
use etendue_geometry::Surface;
use etendue_material::{BumpMapped, Diffuse, Glass, Material, NormalMapped};
use etendue_texture::{
    Channel, Encoding, ImageTexture, ImageUse, Noise, ScalarTex, TexPoint, TexSpace, Texture, UvTransform,
    Wrap,
};

/// A height that rises evenly.
struct Ramp(Vec2);

impl Texture for Ramp {
    fn eval(&self, at: &TexPoint<'_>) -> Spectrum {
        at.count();
        Spectrum::gray(self.0.dot(at.uv[0]))
    }

    fn mean(&self) -> Spectrum {
        Spectrum::gray(0.5 * (self.0.x + self.0.y))
    }

    fn max(&self) -> Spectrum {
        Spectrum::gray(self.0.x + self.0.y)
    }
}

fn open(tex: impl Texture + 'static) -> ScalarTex {
    ScalarTex::Open { tex: Arc::new(tex), channel: Channel::G, scale: 1.0 }
}

fn white() -> Diffuse {
    Diffuse::new(Spectrum::ONE)
}

/// A point with derivatives that are neither orthogonal nor unit, and a frame as meshes make it.
fn surface(dpdu: Vec3A, dpdv: Vec3A, ns: Vec3A) -> Surface {
    let mut at = Surface::new(Vec3A::new(0.2, -0.3, 0.5), Vec3A::ZERO, vector::normalize(dpdu.cross(dpdv)));
    at.uv = [Vec2::new(0.3, 0.6), Vec2::new(0.1, 0.9)];
    (at.dpdu, at.dpdv) = (dpdu, dpdv);
    at.shading = Frame::from_normal_tangent(vector::normalize(ns), dpdu);
    at
}

fn skewed() -> Surface {
    let (dpdu, dpdv) = (Vec3A::new(2.0, 0.1, 0.3), Vec3A::new(0.5, 0.1, -1.5));
    surface(dpdu, dpdv, dpdu.cross(dpdv))
}

fn far(a: Vec3A, b: Vec3A) -> f32 {
    vector::length(a - b)
}

/// The normal of p + h n with the slopes of h, on the side of n.
fn raised(at: &Surface, slope: Vec2) -> Vec3A {
    let n = at.shading.z;
    // Within the plane of the shading normal, where the surface is taken to lie.
    let flat = |d: Vec3A| d - n * d.dot(n);
    let cross = (flat(at.dpdu) + n * slope.x).cross(flat(at.dpdv) + n * slope.y);
    vector::normalize(if cross.dot(n) < 0.0 { -cross } else { cross })
}

#[test]
fn a_ramp_tilts_by_its_slope() {
    // In the plane z = 0 with u along x: the normal of z = x tan θ.
    let flat = surface(Vec3A::X, Vec3A::Y, Vec3A::Z);
    for slope in [-2.0f32, -0.1, 0.03, 0.5, 3.0] {
        let frame = BumpMapped::new(white(), open(Ramp(Vec2::X)), slope).shading_frame(&flat);
        let exact = Vec3A::new(-slope, 0.0, 1.0) / (1.0 + slope * slope).sqrt();
        assert!(far(frame.z, exact) < 1e-4, "slope {slope}: {} for {exact}", frame.z);
        assert!(frame.x.dot(frame.z).abs() < 1e-6 && frame.x.x > 0.0);
    }
    let mut tilted = skewed();
    for (turn, ns) in [(1.0, Vec3A::ZERO), (1.0, Vec3A::new(0.2, 0.1, -0.15)), (-1.0, Vec3A::ZERO)] {
        // A mirrored image: v runs the other way, and so do its derivative and the side of the normal.
        tilted.dpdv = skewed().dpdv * turn;
        tilted.shading = Frame::from_normal_tangent(vector::normalize(skewed().ng + ns), tilted.dpdu);
        for slope in [Vec2::new(0.4, 0.0), Vec2::new(0.0, -0.7), Vec2::new(-0.2, 0.9)] {
            let bump = BumpMapped::new(white(), open(Ramp(slope)), 0.5);
            let (frame, exact) = (bump.shading_frame(&tilted), raised(&tilted, slope * 0.5));
            assert!(far(frame.z, exact) < 1e-4, "{turn} {ns} {slope}: {} for {exact}", frame.z);
        }
    }
    assert!(tilted.fetches.get() > 0, "look-ups are counted");
}

/// The same tilt by an image of heights, by a map of coordinates, and by a normal map.
#[test]
fn images_bump_as_normal_maps_tilt() {
    let heights: Vec<f32> = (0..64).map(|i| (i % 8) as f32 / 8.0 + (i / 8) as f32 / 16.0).collect();
    let image = ImageTexture::from_f32(8, 8, 1, heights).expect("finite").with_wrap(Wrap::Clamp, Wrap::Clamp);
    let at = skewed();
    let plain = ScalarTex::image(ImageUse::new(Arc::new(image)), Channel::R);
    let bump = BumpMapped::new(white(), plain.clone(), 0.3);
    assert_eq!(bump.step, Vec2::splat(1.0 / 16.0));
    let frame = bump.shading_frame(&at);
    assert!(far(frame.z, raised(&at, Vec2::new(0.3, 0.15))) < 1e-5);

    let ScalarTex::Image { image, .. } = plain else { panic!("an image") };
    let half = UvTransform::new(Vec2::splat(0.25), 0.0, Vec2::splat(0.5));
    let half = ScalarTex::image(ImageUse { transform: Some(half), ..image }, Channel::R);
    let bump = BumpMapped::new(white(), half, 0.3);
    assert_eq!(bump.step, Vec2::splat(1.0 / 8.0));
    assert!(far(bump.shading_frame(&at).z, raised(&at, Vec2::new(0.15, 0.075))) < 1e-5);

    let n = frame.z;
    let local = [n.dot(at.shading.x), n.dot(at.up_in_texture()), n.dot(at.shading.z)];
    let texel = local.map(|c| 0.5 + 0.5 * c).to_vec();
    let map = ImageTexture::from_f32(1, 1, 3, texel).expect("finite");
    let mapped = NormalMapped::new(white(), ImageUse::new(Arc::new(map))).shading_frame(&at);
    assert!(far(mapped.z, frame.z) < 1e-6 && far(mapped.x, frame.x) < 1e-6);
}

/// Noise on the surface and in the world, against central differences of its value.
#[test]
fn patterns_bump_by_their_gradient() {
    let at = skewed();
    let world = Transform::scale(Vec3A::splat(1.3)).expect("invertible");
    for space in [TexSpace::uv(5.0), TexSpace::World(world)] {
        for seed in 0..20 {
            let noise = Noise::fractal(space, 1, Spectrum::BLACK, Spectrum::ONE).with_seed(seed);
            let height = |uv: Vec2, p: Vec3A| match space {
                TexSpace::Uv { .. } => f64::from(noise.value(Vec3A::new(uv.x * 5.0, uv.y * 5.0, 0.0))),
                TexSpace::World(_) => f64::from(noise.value(p * 1.3)),
            };
            let e = 0.002f32;
            let slope = |du: Vec2, dp: Vec3A| {
                let (a, b) =
                    (height(at.uv[0] + du * e, at.p + dp * e), height(at.uv[0] - du * e, at.p - dp * e));
                (0.5 * (a - b) / f64::from(2.0 * e)) as f32 * 0.2
            };
            let exact = raised(&at, Vec2::new(slope(Vec2::X, at.dpdu), slope(Vec2::Y, at.dpdv)));
            let bump = BumpMapped::new(white(), noise, 0.2);
            let found = bump.shading_frame(&at).z;
            // A forward difference is off by half its step times the curvature: an eighth of the step, an eighth of that.
            assert!(far(found, exact) < 1.6e-2, "{space:?} {seed}: {found} for {exact}");
            let finer = BumpMapped { step: bump.step / 8.0, ..bump }.shading_frame(&at).z;
            assert!(far(finer, exact) < 2e-3, "{space:?} {seed}: {finer} for {exact}");
            assert!(far(found, at.shading.z) > 1e-4, "{space:?} {seed}: flat");
        }
    }
}

#[test]
fn no_height_changes_no_bit() {
    let zero = ImageTexture::from_u8(2, 2, 1, vec![77; 4], Encoding::Srgb).expect("sizes agree");
    let even = ScalarTex::image(ImageUse::new(Arc::new(zero)), Channel::R);
    let second = ScalarTex::Image {
        image: ImageUse {
            uv_set: 1,
            ..ImageUse::new(Arc::new(ImageTexture::from_f32(2, 1, 1, vec![0.0, 1.0]).expect("finite")))
        },
        channel: Channel::R,
        scale: 1.0,
    };
    for at in
        [skewed(), surface(Vec3A::new(0.0, 0.7, 0.1), Vec3A::new(0.3, 0.2, 0.9), Vec3A::new(-1.0, 0.2, 0.1))]
    {
        let flat = [
            BumpMapped::new(white(), even.clone(), 4.0),
            BumpMapped::new(white(), 0.7, 4.0),
            BumpMapped::new(white(), open(Ramp(Vec2::X)), 0.0),
            BumpMapped::new(white(), second.clone(), 4.0),
        ];
        for bump in flat {
            assert_eq!(bump.shading_frame(&at), at.shading, "{bump:?}");
        }
    }
    let bare = Surface::new(Vec3A::ZERO, Vec3A::ZERO, Vec3A::Y);
    assert_eq!(BumpMapped::new(white(), open(Ramp(Vec2::X)), 1.0).shading_frame(&bare), bare.shading);
}

/// Steep slopes over a shading normal that leans already: never into the surface, never a broken frame.
#[test]
fn normals_never_point_into_the_surface() {
    let (dpdu, dpdv) = (Vec3A::X, Vec3A::Y);
    let at = surface(dpdu, dpdv, Vec3A::new(0.9, 0.0, 0.3));
    let mut kept = 0;
    for i in 0..400 {
        let slope = Vec2::new((i % 20 - 10) as f32, (i / 20 - 10) as f32) * 2.0;
        let frame = BumpMapped::new(white(), open(Ramp(slope)), 1.0).shading_frame(&at);
        assert!(frame.z.dot(at.ng) > 0.0 && (vector::length(frame.z) - 1.0).abs() < 1e-6);
        kept += u32::from(frame == at.shading);
    }
    assert!(kept > 10 && kept < 390, "{kept}");
    for bad in [f32::NAN, f32::INFINITY] {
        let frame = BumpMapped::new(white(), open(Ramp(Vec2::new(bad, 0.0))), 1.0).shading_frame(&at);
        assert_eq!(frame, at.shading);
    }
}

/// An object that is placed by a transform is bumped as it was: heights stay metres of the world.
#[test]
fn placed_objects_keep_their_bumps() {
    let turn = Transform::rotation(vector::normalize(Vec3A::new(1.0, 2.0, -0.5)), 1.1);
    let at = skewed();
    let bump = BumpMapped::new(white(), open(Ramp(Vec2::new(0.4, -0.3))), 0.8);
    let placed = bump.shading_frame(&at.clone().transformed(&turn));
    assert!(far(placed.z, turn.vector(bump.shading_frame(&at).z)) < 1e-5);
    let mirror = Transform::scale(Vec3A::new(1.0, 1.0, -1.0)).expect("invertible");
    let placed = bump.shading_frame(&at.clone().transformed(&mirror));
    assert!(far(placed.z, mirror.vector(bump.shading_frame(&at).z)) < 1e-5);
}

#[test]
fn needs_and_fingerprints() {
    let map = Needs::TEXTURES | Needs::TANGENTS | Needs::NORMAL_MAPS;
    let noise = Noise::fractal(TexSpace::uv(3.0), 2, Spectrum::BLACK, Spectrum::ONE);
    assert_eq!(BumpMapped::new(white(), noise, 0.1).needs(), map);
    assert_eq!(BumpMapped::new(white(), 0.5, 0.1).needs(), Needs::empty());
    let glass = BumpMapped::new(Glass::new(1.5), noise, 0.1);
    assert_eq!(glass.needs(), map | Needs::DELTA | Needs::TRANSMISSION);
    assert!(glass.is_delta() && glass.absorption().is_some());
    let digest = |m: &dyn Material| {
        let mut f = Fingerprint::default();
        m.fingerprint(&mut f);
        assert!(!f.is_opaque());
        f.value()
    };
    let all = [
        digest(&BumpMapped::new(white(), noise, 0.1)),
        digest(&BumpMapped::new(white(), noise, 0.2)),
        digest(&BumpMapped { step: Vec2::splat(0.1), ..BumpMapped::new(white(), noise, 0.1) }),
        digest(&BumpMapped::new(white(), noise.with_seed(1), 0.1)),
        digest(&white()),
    ];
    let distinct: std::collections::BTreeSet<_> = all.iter().collect();
    assert_eq!(distinct.len(), all.len());
}
