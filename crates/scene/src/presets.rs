//! Scenes built in code, for examples, tests and benchmarks. Each comes with the view it was made for.

use etendue_core::{Spectrum, Transform, Vec3A, vector};
use etendue_geometry::{Parallelogram, Sphere, presets as meshes};
use etendue_material::{Absorber, Diffuse, Glass, Metal};

use crate::{Emission, SceneBuilder};

/// A scene under construction and where to look at it from. Positions in metres.
pub struct Preset {
    /// The scene; more can be added before it is built.
    pub builder: SceneBuilder,
    /// Where the camera stands.
    pub eye: Vec3A,
    /// What it looks at.
    pub target: Vec3A,
    /// Vertical field of view, degrees.
    pub vertical_fov_deg: f32,
}

/// Radiance of the box's lamp, W·m⁻²·sr⁻¹.
const LAMP: Spectrum = Spectrum::rgb(3.4, 2.9, 2.2);

/// The walls of a box one metre wide with a lamp in its ceiling, open toward the camera (after Goral et al. 1984).
pub fn empty_cornell_box() -> Preset {
    let mut b = SceneBuilder::new();
    let white = b.material(Diffuse::new(Spectrum::rgb(0.73, 0.73, 0.73)));
    let red = b.material(Diffuse::new(Spectrum::rgb(0.63, 0.06, 0.05)));
    let green = b.material(Diffuse::new(Spectrum::rgb(0.14, 0.45, 0.09)));
    let lamp = b.material(Diffuse::new(Spectrum::gray(0.78)));
    let (x, y, z) = (Vec3A::X, Vec3A::Y, Vec3A::Z);
    let corner = Vec3A::new(-0.5, 0.0, -0.5);
    let mut wall = |o: Vec3A, u: Vec3A, v: Vec3A, m| {
        // The edges are constants with an area.
        if let Ok(p) = Parallelogram::new(o, u, v) {
            return Some(b.add(p, m));
        }
        None
    };
    wall(corner, z, x, white);
    wall(corner + y, x, z, white);
    wall(corner, x, y, white);
    wall(corner, y, z, red);
    wall(corner + x, z, y, green);
    let opening = wall(Vec3A::new(-0.3, 0.999, -0.3), x * 0.6, z * 0.6, lamp);
    if let Some(opening) = opening {
        b.emit(opening, Emission::new(LAMP));
    }
    Preset {
        builder: b,
        eye: Vec3A::new(0.0, 0.5, 1.9),
        target: Vec3A::new(0.0, 0.5, 0.0),
        vertical_fov_deg: 39.0,
    }
}

/// The built-in scene: the box with a glass sphere, a rough gold sphere and a ring of triangles.
pub fn cornell_box() -> Preset {
    let mut p = empty_cornell_box();
    let b = &mut p.builder;
    let glass = b.material(Glass::new(1.5));
    let gold = b.material(Metal::gold(0.5));
    let blue = b.material(Diffuse::new(Spectrum::rgb(0.2, 0.3, 0.65)));
    let spheres = [(Vec3A::new(-0.24, 0.17, 0.18), 0.17, glass), (Vec3A::new(0.22, 0.2, -0.2), 0.2, gold)];
    for (center, radius, material) in spheres {
        if let Ok(s) = Sphere::new(center, radius) {
            b.add(s, material);
        }
    }
    let ring = b.add_grouped(meshes::torus(0.13, 0.05, 48, 24), blue);
    let ring = b.group(&[ring]);
    let tilt = Transform::translation(Vec3A::new(0.22, 0.14, 0.24))
        .after(&Transform::rotation(Vec3A::new(1.0, 0.0, -0.4), 1.1));
    if let Ok(placed) = tilt {
        b.instance(ring, placed);
    }
    p
}

/// Radiance of the largest lamp over the plates, W·m⁻²·sr⁻¹, and its radius, metres.
const LARGEST_LAMP: (f32, f32) = (1.6, 0.27);

/// Four glossy plates under four lamps of equal power (after Veach & Guibas 1995, Fig. 2; own dimensions). From the far
/// plate to the near one they get rougher; from left to right the lamps get wider, each by a factor of three. Every
/// plate is turned so that it mirrors the lamps to the eye. A dim wall and floor stand behind.
///
/// Where a smooth plate mirrors a large lamp, light sampling alone is noisy; where a rough plate mirrors a small one,
/// BSDF sampling alone is. Made for pictures of 4 : 3.
pub fn veach_mis() -> Preset {
    let mut b = SceneBuilder::new();
    let eye = Vec3A::new(0.0, 1.9, 4.4);
    let lamps = Vec3A::new(0.0, 1.5, 0.0);
    let dim = b.material(Diffuse::new(Spectrum::gray(0.25)));
    let black = b.material(Absorber);
    let sheet = |b: &mut SceneBuilder, o: Vec3A, u: Vec3A, v: Vec3A, m| {
        // The edges are at right angles and have a length.
        if let Ok(p) = Parallelogram::new(o, u, v) {
            b.add(p, m);
        }
    };
    let corner = Vec3A::new(-4.0, 0.0, -0.6);
    sheet(&mut b, corner, Vec3A::Z * 6.0, Vec3A::X * 8.0, dim);
    sheet(&mut b, corner, Vec3A::X * 8.0, Vec3A::Y * 4.0, dim);

    // Height and depth of the centre, and roughness.
    let plates = [(0.70, -0.05, 0.07), (0.47, 0.30, 0.14), (0.31, 0.70, 0.22), (0.20, 1.12, 0.34)];
    for (y, z, roughness) in plates {
        let center = Vec3A::new(0.0, y, z);
        let metal = b.material(Metal::aluminium(roughness));
        // Halfway between eye and lamps. The plate is flat along x, so this holds along its whole middle line.
        let up = vector::normalize(vector::normalize(eye - center) + vector::normalize(lamps - center));
        let (u, v) = (Vec3A::X * 2.6, vector::cross(Vec3A::X, up) * -0.34);
        sheet(&mut b, center - (u + v) * 0.5, u, v, metal);
    }

    let (radiance, largest) = LARGEST_LAMP;
    // Of mean 1, so that the powers are equal; they tell the reflections apart.
    let row = [
        (-1.05, 27.0, Spectrum::rgb(1.2, 0.9, 0.9)),
        (-0.35, 9.0, Spectrum::rgb(1.1, 1.1, 0.8)),
        (0.35, 3.0, Spectrum::rgb(0.85, 1.15, 1.0)),
        (1.05, 1.0, Spectrum::rgb(0.85, 0.95, 1.2)),
    ];
    for (x, smaller, tint) in row {
        if let Ok(s) = Sphere::new(lamps + Vec3A::X * x, largest / smaller) {
            let lamp = b.add(s, black);
            b.emit(lamp, Emission::new(tint * (radiance * smaller * smaller)));
        }
    }
    Preset { builder: b, eye, target: Vec3A::new(0.0, 0.69, 0.5), vertical_fov_deg: 36.0 }
}
