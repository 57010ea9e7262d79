//! Colours and numbers that vary over a surface: the [`Texture`] trait, [`ImageTexture`], [`Checker`] and [`Noise`], and
//! [`Tex`] and [`ScalarTex`], the by-value forms in which materials and lights hold a parameter.
//!
//! ```
//! use std::cell::Cell;
//! use std::sync::Arc;
//! use etendue_core::{Spectrum, Vec2, Vec3A};
//! use etendue_texture::{Encoding, ImageTexture, Tex, TexPoint, Texture};
//!
//! // One white and one black texel, sRGB, side by side.
//! let image = ImageTexture::from_u8(2, 1, 3, vec![255, 255, 255, 0, 0, 0], Encoding::Srgb)?;
//! let tex = Tex::image(Arc::new(image)).scaled(Spectrum::gray(0.5));
//! let fetches = Cell::new(0);
//! let at = TexPoint { uv: [Vec2::new(0.5, 0.5); 2], p: Vec3A::ZERO, fetches: &fetches };
//! assert_eq!(tex.eval(&at), Spectrum::gray(0.25), "decoded before filtering, then scaled");
//! assert_eq!((tex.mean(), fetches.get()), (Spectrum::gray(0.25), 1));
//! # Ok::<(), etendue_texture::TextureError>(())
//! ```
//!
//! Limits: bilinear or nearest filtering without mip levels, procedural patterns not filtered at all; images at most 65,536 texels a side.
//!
//! Place in the workspace: above `core` and `geometry`; `material` and `light` read parameters through it.

mod checker;
mod error;
mod gradient;
mod image;
mod lookup;
mod noise;
mod scalar;
mod space;
mod tex;
mod texels;
mod texture;
mod uv_transform;

pub use checker::Checker;
pub use error::TextureError;
pub use image::{Channel, ImageTexture};
pub use lookup::{Filter, Wrap};
pub use noise::{Noise, NoiseKind};
pub use scalar::ScalarTex;
pub use space::TexSpace;
pub use tex::{ImageUse, Tex};
pub use texels::Encoding;
pub use texture::{TexPoint, Texture};
pub use uv_transform::UvTransform;
