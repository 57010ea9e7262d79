//! Attributes of vertices: their names and what their accessors may hold.

use super::model::{Component, Format, SCALAR, VEC2, VEC3, VEC4};

/// Names that come with numbers.
pub(super) const NUMBERED: [&str; 4] = ["TEXCOORD", "COLOR", "JOINTS", "WEIGHTS"];

/// What an attribute means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Semantic<'a> {
    Position,
    Normal,
    Tangent,
    Numbered(&'static str, u64),
    /// A name of an application's own.
    Own(&'a str),
    Unknown(&'a str),
}

impl<'a> Semantic<'a> {
    pub(super) fn new(name: &'a str) -> Self {
        match name {
            "POSITION" => Self::Position,
            "NORMAL" => Self::Normal,
            "TANGENT" => Self::Tangent,
            _ if name.starts_with('_') => Self::Own(name),
            _ => numbered(name).unwrap_or(Self::Unknown(name)),
        }
    }

    /// Its place among the attributes.
    pub(super) fn rank(&self) -> (u8, u64) {
        match self {
            Self::Position => (0, 0),
            Self::Normal => (1, 0),
            Self::Tangent => (2, 0),
            Self::Numbered("TEXCOORD", n) => (3, *n),
            Self::Numbered("COLOR", n) => (4, *n),
            Self::Numbered(_, n) => (5, *n),
            Self::Own(_) | Self::Unknown(_) => (6, 0),
        }
    }

    /// Whether morph targets may have it.
    pub(super) fn morphs(&self) -> bool {
        !matches!(self, Self::Unknown(_) | Self::Numbered("JOINTS" | "WEIGHTS", _))
    }
}

fn numbered<'a>(name: &str) -> Option<Semantic<'a>> {
    let (name, number) = name.split_once('_')?;
    let name = NUMBERED.into_iter().find(|n| *n == name)?;
    let digits = number.bytes().all(|b| b.is_ascii_digit());
    let plain = digits && (number == "0" || !number.starts_with('0'));
    Some(Semantic::Numbered(name, number.parse().ok().filter(|_| plain)?))
}

fn is_float(f: &Format) -> bool {
    f.component == Component::F32
}

fn is_unsigned(f: &Format) -> bool {
    matches!(f.component, Component::U8 | Component::U16)
}

fn is_signed(f: &Format) -> bool {
    matches!(f.component, Component::I8 | Component::I16)
}

/// Whether an attribute may be of a format.
pub(super) fn allows(semantic: &Semantic<'_>, f: &Format, quantized: bool) -> bool {
    let float_or_normalized = is_float(f) || is_unsigned(f) && f.normalized;
    match semantic {
        Semantic::Position => {
            f.shape == VEC3 && (is_float(f) || quantized && (is_signed(f) || is_unsigned(f)))
        }
        Semantic::Normal => f.shape == VEC3 && (is_float(f) || quantized && is_signed(f) && f.normalized),
        Semantic::Tangent => f.shape == VEC4 && (is_float(f) || quantized && is_signed(f) && f.normalized),
        Semantic::Numbered("TEXCOORD", _) => {
            f.shape == VEC2 && (float_or_normalized || quantized && (is_signed(f) || is_unsigned(f)))
        }
        Semantic::Numbered("COLOR", _) => (f.shape == VEC3 || f.shape == VEC4) && float_or_normalized,
        Semantic::Numbered("JOINTS", _) => f.shape == VEC4 && is_unsigned(f) && !f.normalized,
        Semantic::Numbered(..) => f.shape == VEC4 && float_or_normalized,
        Semantic::Own(_) | Semantic::Unknown(_) => true,
    }
}

/// Whether an attribute of a morph target may be of a format.
pub(super) fn allows_morph(semantic: &Semantic<'_>, f: &Format, quantized: bool) -> bool {
    let small = is_signed(f) || is_unsigned(f);
    match semantic {
        Semantic::Position => f.shape == VEC3 && (is_float(f) || quantized && is_signed(f)),
        Semantic::Normal | Semantic::Tangent => {
            f.shape == VEC3 && (is_float(f) || quantized && is_signed(f) && f.normalized)
        }
        Semantic::Numbered("TEXCOORD", _) => {
            f.shape == VEC2 && (is_float(f) || small && (f.normalized || quantized))
        }
        Semantic::Numbered("COLOR", _) => {
            (f.shape == VEC3 || f.shape == VEC4) && (is_float(f) || small && f.normalized)
        }
        _ => true,
    }
}

/// Whether the output of an animation of a property may be of a format.
pub(super) fn allows_animation(path: &str, f: &Format) -> bool {
    let float_or_normalized = is_float(f) || (is_signed(f) || is_unsigned(f)) && f.normalized;
    match path {
        "translation" | "scale" => f.shape == VEC3 && is_float(f),
        "rotation" => f.shape == VEC4 && float_or_normalized,
        "weights" => f.shape == SCALAR && float_or_normalized,
        _ => true,
    }
}
