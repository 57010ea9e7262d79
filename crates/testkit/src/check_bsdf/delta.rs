use etendue_bsdf::{Bsdf, BsdfSample, Lobes, Mode};
use etendue_core::{Spectrum, Vec2, Vec3A, vector};

use crate::budget::{Failure, Judge};

/// Choices of a lobe that are tried.
const GRID: u32 = 4096;

/// The single directions that a BSDF names are those that it draws, with the light that draws of them bring: the mean
/// over evenly spaced choices of a lobe, which is off by a step at most at each border between lobes.
pub(super) fn delta_lobes(bsdf: &dyn Bsdf, wo: Vec3A, mode: Mode, judge: &mut Judge) -> Result<(), Failure> {
    let named = bsdf.delta_lobes(wo, mode);
    let mut drawn = [(Spectrum::BLACK, None::<BsdfSample>); 2];
    let mut largest = 0.0f32;
    for i in 0..GRID {
        let u_lobe = (i as f32 + 0.5) / GRID as f32;
        let sample = bsdf.sample(wo, u_lobe, Vec2::new(0.3, 0.7), mode);
        if let Some(s) = sample.filter(|s| s.lobe.contains(Lobes::DELTA)) {
            let (sum, seen) = &mut drawn[usize::from(s.lobe.contains(Lobes::TRANSMISSION))];
            *sum += s.weight / GRID as f32;
            *seen = Some(s);
            largest = if s.weight.max_channel() > largest { s.weight.max_channel() } else { largest };
        }
    }
    for (named, (light, seen)) in named.into_iter().zip(drawn) {
        let said = named.map_or(Spectrum::BLACK, |s| s.weight);
        let off = (said - light).map(f32::abs).max_channel();
        judge.require(off <= 3.0 * largest / GRID as f32 + 1e-5, "delta lobes", || {
            format!("{named:?} is named, draws bring {light:?} by {seen:?}")
        })?;
        if let (Some(n), Some(s)) = (named, seen) {
            let same =
                n.lobe == s.lobe && n.eta == s.eta && vector::length(n.wi - s.wi) < 1e-5 && n.pdf == 1.0;
            judge.require(same, "delta lobes", || format!("{n:?} is named, {s:?} drawn"))?;
        }
    }
    Ok(())
}
