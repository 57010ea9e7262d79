use std::sync::Arc;

use etendue_core::{Frame, Vec2, Vec3A, vector};
use etendue_geometry::Parallelogram;
use etendue_material::Material;
use etendue_sampling::warp;
use etendue_scene::SceneBuilder;

use super::GonioError;

/// The part of the macroscopic surface that the detector sees.
///
/// The macroscopic surface is the plane through `center` with the normal `frame.z`; all directions of a reading are in
/// `frame`, both pointing away from the plane. The micro-geometry may lie beneath the plane, above it or on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Its middle, world space.
    pub center: Vec3A,
    /// Tangent, bitangent and normal of the macroscopic surface, world space.
    pub frame: Frame,
    /// Its outline on the plane.
    pub outline: Outline,
}

/// The outline of a [`Spot`], in its plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outline {
    /// A disc.
    Disc {
        /// Metres.
        radius: f32,
    },
    /// A rectangle along the frame's axes. For geometry that repeats itself one of whole periods is exact: the average
    /// over it is that over the endless surface.
    Rectangle {
        /// Half its sides along `frame.x` and `frame.y`, metres.
        half: Vec2,
    },
}

impl Spot {
    /// A disc; the frame around the normal (of any length) is [`Frame::from_normal`]. What is wrong with it is said by
    /// the reading.
    pub fn disc(center: Vec3A, normal: Vec3A, radius: f32) -> Self {
        let frame = Frame::from_normal(vector::try_normalize(normal).unwrap_or(Vec3A::ZERO));
        Self { center, frame, outline: Outline::Disc { radius } }
    }

    /// A rectangle along a frame's axes; `half` its sides.
    pub fn rectangle(center: Vec3A, frame: Frame, half: Vec2) -> Self {
        Self { center, frame, outline: Outline::Rectangle { half } }
    }

    /// A uniform point of it, world space.
    pub(super) fn point(&self, u: Vec2) -> Vec3A {
        let on = match self.outline {
            Outline::Disc { radius } => warp::disc(u) * radius,
            Outline::Rectangle { half } => (u * 2.0 - Vec2::ONE) * half,
        };
        self.center + self.frame.x * on.x + self.frame.y * on.y
    }

    /// Distance from its middle to its farthest point, metres.
    pub(super) fn radius(&self) -> f32 {
        match self.outline {
            Outline::Disc { radius } => radius,
            Outline::Rectangle { half } => vector::length(Vec3A::new(half.x, half.y, 0.0)),
        }
    }

    pub(super) fn check(&self) -> Result<(), GonioError> {
        let fault = |what| Err(GonioError::Spot { what });
        let positive = |x: f32| x > 0.0 && x.is_finite();
        if !match self.outline {
            Outline::Disc { radius } => positive(radius),
            Outline::Rectangle { half } => positive(half.x) && positive(half.y),
        } {
            return fault("without an area: its radius or sides must be finite and greater than 0");
        }
        if !self.center.is_finite() {
            return fault("nowhere: its middle must be finite");
        }
        let Frame { x, y, z } = self.frame;
        let unit = |v: Vec3A| (v.dot(v) - 1.0).abs() < 1e-4;
        let apart = |a: Vec3A, b: Vec3A| a.dot(b).abs() < 1e-4;
        if !(unit(x) && unit(y) && unit(z) && apart(x, y) && apart(y, z) && apart(z, x)) {
            return fault(
                "askew: its frame must be of three unit vectors at right angles (was the normal zero?)",
            );
        }
        Ok(())
    }
}

type Place<'a> = Box<dyn Fn(&mut SceneBuilder) + Send + Sync + 'a>;

/// What is measured: geometry with its materials, and the spot on it that the detector sees.
pub struct Specimen<'a> {
    pub(super) place: Place<'a>,
    pub(super) spot: Spot,
}

impl<'a> Specimen<'a> {
    /// Micro-geometry: `place` puts it into an empty scene, once for every direction of the light. It must bring no
    /// lights.
    ///
    /// The light floods everything, not only the spot; so geometry around the spot shadows and lights it as its
    /// neighbours would. What ends near the spot is measured with its edges.
    pub fn new(spot: Spot, place: impl Fn(&mut SceneBuilder) + Send + Sync + 'a) -> Self {
        Self { place: Box::new(place), spot }
    }

    /// A flat sheet of a material at z = 0, facing +z, its tangent along +x. The sheet is the square [−1, 1]² with the
    /// texture coordinates [0, 1]², the spot the middle quarter of its area.
    pub fn flat(material: Arc<dyn Material>) -> Self {
        let spot =
            Spot::rectangle(Vec3A::ZERO, Frame { x: Vec3A::X, y: Vec3A::Y, z: Vec3A::Z }, Vec2::splat(0.5));
        Self::new(spot, move |b| {
            let material = b.material_arc(material.clone());
            if let Ok(sheet) = Parallelogram::new(Vec3A::new(-1.0, -1.0, 0.0), Vec3A::X * 2.0, Vec3A::Y * 2.0)
            {
                b.add(sheet, material);
            }
        })
    }

    /// The spot.
    pub fn spot(&self) -> Spot {
        self.spot
    }
}

impl std::fmt::Debug for Specimen<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Specimen").field("spot", &self.spot).finish_non_exhaustive()
    }
}
