//! Which properties of a vertex mean what.

use etendue_core::{Vec2, Vec3, Vec4, math};

use super::header::{Element, Kind, Scalar};

/// What properties are called; the place in the list is their slot.
const NAMES: [&[&str]; SLOTS] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["u", "s", "texture_u", "texture_s"],
    &["v", "t", "texture_v", "texture_t"],
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a", "diffuse_alpha"],
];

pub(super) const SLOTS: usize = 12;

/// The vertices of a mesh.
#[derive(Debug)]
pub(super) struct Vertices {
    /// The slot of each property of the element.
    pub slots: Vec<Option<usize>>,
    /// The types of the colours.
    colors: [Option<Scalar>; 4],
    has: [bool; SLOTS],
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub uv: Vec<Vec2>,
    /// Linear.
    pub colors_and_alpha: Vec<Vec4>,
    /// Whether some alpha is less than 1.
    pub transparent: bool,
    /// Vertices that are nowhere.
    pub not_finite: u64,
}

impl Vertices {
    /// Of the properties of an element; those that mean nothing here are named in `skipped`.
    ///
    /// # Errors
    /// The name of a coordinate that is missing.
    pub(super) fn new(element: &Element, skipped: &mut Vec<String>) -> Result<Self, &'static str> {
        let mut has = [false; SLOTS];
        let mut colors = [None; 4];
        let mut slots = Vec::new();
        for property in &element.properties {
            let known = NAMES.iter().position(|names| names.contains(&property.name.as_str()));
            let slot = match (known, property.kind) {
                (Some(slot), Kind::Scalar(ty)) if has.get(slot) == Some(&false) => {
                    if let Some(has) = has.get_mut(slot) {
                        *has = true;
                    }
                    if let Some(color) = slot.checked_sub(8).and_then(|c| colors.get_mut(c)) {
                        *color = Some(ty);
                    }
                    Some(slot)
                }
                _ => {
                    skipped.push(format!("vertex property '{}'", property.name));
                    None
                }
            };
            slots.push(slot);
        }
        for (name, has) in ["x", "y", "z"].into_iter().zip(has) {
            if !has {
                return Err(name);
            }
        }
        Ok(Self {
            slots,
            colors,
            has,
            positions: Vec::new(),
            normals: Vec::new(),
            uv: Vec::new(),
            colors_and_alpha: Vec::new(),
            transparent: false,
            not_finite: 0,
        })
    }

    /// Makes room for so many. False if there is no memory for them.
    pub(super) fn reserve(&mut self, count: usize) -> bool {
        let [_, _, _, nx, ny, nz, u, v, r, g, b, _] = self.has;
        self.positions.try_reserve_exact(count).is_ok()
            && (!(nx && ny && nz) || self.normals.try_reserve_exact(count).is_ok())
            && (!(u && v) || self.uv.try_reserve_exact(count).is_ok())
            && (!(r && g && b) || self.colors_and_alpha.try_reserve_exact(count).is_ok())
    }

    /// Adds a vertex by its slots.
    pub(super) fn push(&mut self, values: &[f64; SLOTS]) {
        let [x, y, z, nx, ny, nz, u, v, r, g, b, a] = *values;
        let [_, _, _, has_x, has_y, has_z, has_u, has_v, has_r, has_g, has_b, has_a] = self.has;
        let vec3 = |x: f64, y: f64, z: f64| Vec3::new(x as f32, y as f32, z as f32);
        let position = vec3(x, y, z);
        self.not_finite = self.not_finite.saturating_add(u64::from(!position.is_finite()));
        self.positions.push(position);
        if has_x && has_y && has_z {
            self.normals.push(vec3(nx, ny, nz));
        }
        if has_u && has_v {
            // PLY counts v upward, pictures are stored from the top.
            self.uv.push(Vec2::new(u as f32, (1.0 - v) as f32));
        }
        if has_r && has_g && has_b {
            let [tr, tg, tb, ta] = self.colors;
            let alpha = if has_a { fraction(a, ta) as f32 } else { 1.0 };
            self.transparent |= alpha < 1.0;
            self.colors_and_alpha.push(Vec4::new(linear(r, tr), linear(g, tg), linear(b, tb), alpha));
        }
    }
}

/// A colour of whole numbers as a fraction; one that is no number is black.
fn fraction(x: f64, ty: Option<Scalar>) -> f64 {
    let most = ty.and_then(Scalar::most).unwrap_or(1.0);
    if x.is_finite() { (x / most).max(0.0) } else { 0.0 }
}

/// A colour without the curve of sRGB (IEC 61966-2-1), which those of whole numbers have.
fn linear(x: f64, ty: Option<Scalar>) -> f32 {
    let c = fraction(x, ty) as f32;
    match ty.and_then(Scalar::most) {
        None => c,
        Some(_) if c <= 0.040_45 => c / 12.92,
        Some(_) => math::pow((c + 0.055) / 1.055, 2.4),
    }
}
