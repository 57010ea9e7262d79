use etendue_core::{Vec2, math};

/// Density of [`disc`] per area: 1/π.
pub const DISC_PDF: f32 = std::f32::consts::FRAC_1_PI;

/// A uniform point of the unit disc, by squares onto rings (Shirley & Chiu 1997): neighbours stay neighbours, so
/// stratification survives. Strictly inside: the radius is at most 1 − 2⁻²⁴.
#[inline]
pub fn disc(u: Vec2) -> Vec2 {
    let (p, _) = disc_and_radius(u);
    p
}

/// The point, and its radius exactly.
#[inline]
pub(super) fn disc_and_radius(u: Vec2) -> (Vec2, f32) {
    // To [-1, 1] by the middles of the 2⁻²⁴ cells: exact in f32, symmetric, and never on the rim.
    const HALF_CELL: f32 = 1.0 / 16_777_216.0;
    let a = (2.0 * u.x - 1.0) + HALF_CELL;
    let b = (2.0 * u.y - 1.0) + HALF_CELL;
    // The longer coordinate is the radius.
    let across = a.abs() > b.abs();
    let (r, other) = if across { (a, b) } else { (b, a) };
    if r == 0.0 {
        return (Vec2::ZERO, 0.0);
    }
    // An eighth of a turn to either side of the axis that r runs along.
    let (s, c) = math::sin_cos_turns(0.125 * (other / r));
    let (along, aside) = (r * c, r * s);
    (if across { Vec2::new(along, aside) } else { Vec2::new(aside, along) }, r.abs())
}

/// Uniform barycentric weights of a triangle's second and third corner (the first has what is left), by folding the
/// square along its diagonal with little distortion (Heitz 2019).
#[inline]
pub fn triangle(u: Vec2) -> Vec2 {
    if u.y > u.x {
        let x = 0.5 * u.x;
        Vec2::new(x, u.y - x)
    } else {
        let y = 0.5 * u.y;
        Vec2::new(u.x - y, y)
    }
}

/// As [`triangle`], by the classic √u map (Turk 1990): the first coordinate chooses the distance from the first
/// corner.
#[inline]
pub fn triangle_sqrt(u: Vec2) -> Vec2 {
    let s = u.x.sqrt();
    Vec2::new(s * (1.0 - u.y), s * u.y)
}
