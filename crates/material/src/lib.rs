//! How surfaces scatter over their whole extent: textures and constants that become a BSDF at a point.
//!
//! A scene holds each as `Arc<dyn Material>`; a user's own is one more implementation of [`Material`].
//!
//! ```
//! use etendue_bsdf::{Bsdf, BsdfAt};
//! use etendue_core::{Needs, Spectrum, Vec3A};
//! use etendue_geometry::Surface;
//! use etendue_material::{Cutout, Diffuse, Material};
//!
//! let leaf = Cutout::new(Diffuse::new(Spectrum::rgb(0.2, 0.6, 0.1)), 0.5);
//! assert_eq!(leaf.needs(), Needs::CUTOUTS);
//! let at = Surface::new(Vec3A::ZERO, Vec3A::ZERO, Vec3A::Y);
//! assert!(matches!(leaf.bsdf(&at), BsdfAt::Lambert(_)));
//! ```
//!
//! Matte: [`Diffuse`], [`OrenNayar`]; metal: [`Metal`], [`MirrorMaterial`]; clear: [`Glass`], [`RoughGlass`]; glTF's
//! [`Principled`]; the lobes of older pictures: [`Phong`], [`BlinnPhong`]; black: [`Absorber`]. Around any of them:
//! [`Cutout`], [`NormalMapped`], [`BumpMapped`].
//!
//! Limits: one model a material, no layers; bodies absorb, but do not scatter.
//!
//! Place in the workspace: above `core`, `geometry`, `bsdf` and `texture`; scenes hold materials, integrators ask them.

mod absorber;
mod blinn_phong;
mod bump_map;
mod cutout;
mod diffuse;
mod glass;
mod material;
mod metal;
mod mirror;
mod normal_map;
mod oren_nayar;
mod parameter;
mod phong;
mod principled;

pub use absorber::Absorber;
pub use blinn_phong::BlinnPhong;
pub use bump_map::BumpMapped;
pub use cutout::Cutout;
pub use diffuse::Diffuse;
pub use glass::{Glass, RoughGlass};
pub use material::{AlphaPoint, Material, MediumId};
pub use metal::{Metal, MetalColor};
pub use mirror::MirrorMaterial;
pub use normal_map::NormalMapped;
pub use oren_nayar::OrenNayar;
pub use phong::Phong;
pub use principled::Principled;
