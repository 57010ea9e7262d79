//! What every material does with its parameters.

use etendue_core::{Needs, Spectrum};
use etendue_geometry::Surface;
use etendue_texture::{ScalarTex, Tex, TexPoint, Texture};

/// A reflectance at a point, in `[0, 1]` whatever the texture says, times the vertex colour if asked for.
#[inline]
pub(crate) fn reflectance(tex: &Tex, vertex_color: bool, at: &Surface) -> Spectrum {
    let value = tex.eval(&TexPoint::of(at));
    let value = if vertex_color { value * Spectrum::rgb(at.color.x, at.color.y, at.color.z) } else { value };
    // Written so that NaN becomes 0.
    value.map(|c| if c > 0.0 { c.clamp(0.0, 1.0) } else { 0.0 })
}

/// A number at a point.
#[inline]
pub(crate) fn scalar(tex: &ScalarTex, at: &Surface) -> f32 {
    tex.eval(&TexPoint::of(at))
}

pub(crate) fn color_needs(tex: &Tex, vertex_color: bool) -> Needs {
    let mut needs = Needs::empty();
    needs.set(Needs::TEXTURES, !tex.is_constant());
    needs.set(Needs::VERTEX_COLORS, vertex_color);
    needs
}

/// An absorption, m⁻¹: each channel that is no positive number is 0.
pub(crate) fn absorption(s: Spectrum) -> Spectrum {
    s.map(|c| if c > 0.0 { c } else { 0.0 })
}

/// What the inside of a body asks for.
pub(crate) fn absorption_needs(inside: Option<Spectrum>) -> Needs {
    if inside.is_some_and(|s| !s.is_black()) { Needs::ABSORPTION } else { Needs::empty() }
}

pub(crate) fn scalar_needs(tex: &ScalarTex) -> Needs {
    if tex.is_constant() { Needs::empty() } else { Needs::TEXTURES }
}
