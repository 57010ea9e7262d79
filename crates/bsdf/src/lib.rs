//! How light scatters at one point of a surface: the [`Bsdf`] trait, one file per model, and [`BsdfAt`], the closed
//! set in which an integrator holds a BSDF by value.
//!
//! Directions are in the local frame of the shading normal (`z`), unit, and point away from the surface. `eval` holds
//! the cosine, `sample` returns a finished weight, so that no caller ever divides by a density.
//!
//! ```
//! use etendue_bsdf::{Bsdf, Conductor, Mode};
//! use etendue_core::{Vec2, Vec3A};
//!
//! let gold = Conductor::gold(0.3);
//! let wo = Vec3A::new(0.6, 0.0, 0.8);
//! let s = gold.sample(wo, 0.5, Vec2::new(0.2, 0.7), Mode::Radiance).expect("most attempts stay above the surface");
//! let (f_cos, pdf) = gold.eval_pdf(wo, s.wi, Mode::Radiance);
//! assert!((f_cos.r() / pdf - s.weight.r()).abs() < 1e-4, "the weight is f·cos / pdf");
//! assert!(s.weight.max_channel() <= 1.0, "a metal returns no more than it gets");
//! ```
//!
//! Diffuse: [`Lambert`], [`OrenNayar`]; metal: [`Conductor`], [`Mirror`]; glass: [`SmoothDielectric`],
//! [`RoughDielectric`], [`ThinDielectric`]; glTF's [`Principled`]; the lobes of older pictures: [`Phong`],
//! [`BlinnPhong`].
//!
//! Limits: microfacet models but [`Principled`] are single scattering, so rough ones lose energy; three channels, so no
//! dispersion.
//!
//! Place in the workspace: above `core` and `sampling`; `material` turns textures into these, integrators call them.

#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "a NaN has to take the refusing branch")]

mod albedo;
mod black;
mod blinn_phong;
mod bsdf;
mod bsdf_at;
mod conductor;
mod dielectric_rough;
mod dielectric_smooth;
mod dielectric_thin;
pub mod fresnel;
mod ggx;
mod lambert;
mod metals;
mod mirror;
mod oren_nayar;
mod phong;
mod power_lobe;
mod principled;

pub use black::Black;
pub use blinn_phong::BlinnPhong;
pub use bsdf::{Bsdf, BsdfSample, Lobes, Mode, Scatter};
pub use bsdf_at::BsdfAt;
pub use conductor::Conductor;
pub use dielectric_rough::RoughDielectric;
pub use dielectric_smooth::SmoothDielectric;
pub use dielectric_thin::ThinDielectric;
pub use fresnel::MetalFresnel;
pub use ggx::{Ggx, Masking};
pub use lambert::Lambert;
pub use mirror::Mirror;
pub use oren_nayar::OrenNayar;
pub use phong::Phong;
pub use principled::{Meaning, Principled};
