use etendue_core::{Spectrum, Vec3A};

/// Steps of a few units in the last place of a unit vector's components.
const STEP: f32 = 1.0 / 4_194_304.0;

/// Moves of a direction by a few units in its last place.
pub(crate) fn steps() -> impl Iterator<Item = Vec3A> {
    [Vec3A::X, Vec3A::Y, Vec3A::Z].into_iter().flat_map(|a| [a * STEP, a * -STEP])
}

/// Whether `claimed` is `f(wo, wi)` within a relative tolerance, or within what rounding the directions changes `f` by.
///
/// A narrow lobe, or one seen edge-on, magnifies the last digits of a direction; how much is measured, by moving the
/// directions a few units in their last place.
pub(crate) fn agree(
    claimed: Spectrum,
    wo: Vec3A,
    wi: Vec3A,
    relative: f32,
    f: &dyn Fn(Vec3A, Vec3A) -> Spectrum,
) -> bool {
    let value = f(wo, wi);
    let scale = claimed.max_channel().max(value.max_channel());
    // Against the largest channel: a black channel of a coloured product is only rounding.
    let off = (claimed - value).map(f32::abs);
    if off.max_channel() <= relative * scale {
        return true;
    }
    let mut moved = Spectrum::BLACK;
    for step in steps() {
        for other in [f(wo + step, wi), f(wo, wi + step)] {
            let d = (other - value).map(f32::abs);
            moved = Spectrum::rgb(moved.r().max(d.r()), moved.g().max(d.g()), moved.b().max(d.b()));
        }
    }
    (0..3).all(|c| off[c] <= relative * scale + 2.0 * moved[c])
}
