//! Pictures of a scene: what was rendered, where it is wrong, and how it looks.

use etendue::core::Spectrum;
use etendue::io::{ToneMap, png_bytes};
use etendue::measure::colour_map::{magma, signed};
use etendue::measure::flip::{FlipOptions, flip};
use etendue::measure::report::{ColourScale, Figure, Gallery, number};

use super::summary::SceneResult;
use crate::error::CliError;

/// Pixels across at most; larger pictures are averaged down.
const WIDEST: u32 = 480;

/// The galleries of a scene: pictures, and against a reference also signed errors and FLIP.
pub(super) fn galleries(result: &SceneResult) -> Result<Vec<Gallery>, CliError> {
    // The first contender's second set of runs differs in noise alone.
    let shown: Vec<usize> = (0..result.pictures.len()).filter(|&i| i != 1).collect();
    if shown.is_empty() {
        return Ok(Vec::new());
    }
    let spp = |i: usize| result.curves[i].points.last().map_or(0, |p| p.spp);
    let caption = |i: usize| format!("{}, {} spp", result.curves[i].name, spp(i));
    let tone = ToneMap::default();
    let mut pictures = Vec::new();
    if let Some((name, r)) = &result.reference {
        pictures.push(figure(name.clone(), &shrink(&r.rgb, result.size), |p| tone.bytes(Spectrum::from(p)))?);
    }
    for &i in &shown {
        let small = shrink(&result.pictures[i], result.size);
        pictures.push(figure(caption(i), &small, |p| tone.bytes(Spectrum::from(p)))?);
    }
    let mut out = vec![Gallery { figures: pictures, scale: None }];
    let Some((_, reference)) = &result.reference else { return Ok(out) };

    let errors: Vec<Vec<[f32; 1]>> =
        shown.iter().map(|&i| relative_errors(&result.pictures[i], &reference.rgb)).collect();
    let range = common_range(&errors);
    let mut figures = Vec::new();
    for (&i, error) in shown.iter().zip(&errors) {
        figures.push(figure(caption(i), &shrink(error, result.size), |[e]| signed(e / range))?);
    }
    let stops = (0..=16).map(|i| signed(i as f32 / 8.0 - 1.0)).collect();
    let end = |sign: &str, word: &str| format!("{sign}{} {word}", number(f64::from(range)));
    out.push(Gallery {
        figures,
        scale: Some(ColourScale {
            stops,
            low_label: end("−", "too dark, relative luminance"),
            high_label: end("+", "too bright"),
        }),
    });

    let mut figures = Vec::new();
    for &i in &shown {
        let map = flip(&result.pictures[i], &reference.rgb, result.size, FlipOptions::default())?;
        let values: Vec<[f32; 1]> = map.values.iter().map(|v| [*v]).collect();
        let caption = format!("{}: FLIP {}", caption(i), number(map.mean()));
        figures.push(figure(caption, &shrink(&values, result.size), |[v]| magma(v))?);
    }
    let stops = (0..=16).map(|i| magma(i as f32 / 16.0)).collect();
    out.push(Gallery {
        figures,
        scale: Some(ColourScale {
            stops,
            low_label: "0, looks the same".into(),
            high_label: "1, as different as can be".into(),
        }),
    });
    Ok(out)
}

/// Error of the luminance over that of the reference, which is floored as in relMSE.
fn relative_errors(picture: &[[f32; 3]], reference: &[[f32; 3]]) -> Vec<[f32; 1]> {
    let luminance = |p: &[f32; 3]| Spectrum::from(*p).luminance();
    let error = |(p, r): (&[f32; 3], &[f32; 3])| {
        let r = luminance(r);
        [(luminance(p) - r) / (r * r + 0.01).sqrt()]
    };
    picture.iter().zip(reference).map(error).collect()
}

/// What 99 % of all errors stay below, rounded up to 1, 2 or 5 times a power of ten.
fn common_range(errors: &[Vec<[f32; 1]>]) -> f32 {
    let mut sizes: Vec<f32> =
        errors.iter().flatten().map(|[e]| e.abs()).filter(|e| e.is_finite() && *e > 0.0).collect();
    let at = sizes.len() * 99 / 100;
    if at >= sizes.len() {
        return 1.0;
    }
    let (_, most, _) = sizes.select_nth_unstable_by(at, f32::total_cmp);
    let most = f64::from(*most);
    let power = 10f64.powf(most.log10().floor());
    let round = [1.0, 2.0, 5.0, 10.0].into_iter().find(|m| m * power >= most).unwrap_or(10.0);
    (round * power) as f32
}

/// Pixels of a picture that is no wider than a page wants.
struct Small<const N: usize> {
    size: [u32; 2],
    values: Vec<[f32; N]>,
}

/// Averages blocks of pixels; values that are no numbers are left out of their block.
fn shrink<const N: usize>(values: &[[f32; N]], [w, h]: [u32; 2]) -> Small<N> {
    let step = w.div_ceil(WIDEST).max(1);
    let size = [w.div_ceil(step), h.div_ceil(step)];
    let mut out = Vec::with_capacity(size[0] as usize * size[1] as usize);
    for y in 0..size[1] {
        for x in 0..size[0] {
            let (mut sum, mut count) = ([0.0f64; N], 0.0);
            for v in y * step..((y + 1) * step).min(h) {
                for u in x * step..((x + 1) * step).min(w) {
                    let pixel = values.get(v as usize * w as usize + u as usize);
                    if let Some(p) = pixel.filter(|p| p.iter().all(|c| c.is_finite())) {
                        sum.iter_mut().zip(p).for_each(|(s, c)| *s += f64::from(*c));
                        count += 1.0;
                    }
                }
            }
            out.push(sum.map(|s| (s / f64::max(count, 1.0)) as f32));
        }
    }
    Small { size, values: out }
}

fn figure<const N: usize>(
    caption: String,
    small: &Small<N>,
    colour: impl Fn([f32; N]) -> [u8; 3],
) -> Result<Figure, CliError> {
    let rgb: Vec<[u8; 3]> = small.values.iter().map(|v| colour(*v)).collect();
    let [width, height] = small.size;
    let png = png_bytes(small.size, &rgb)?;
    Ok(Figure { caption, png, width, height, pixelated: width < WIDEST / 2 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_pictures_are_averaged_down() {
        let values: Vec<[f32; 1]> = (0..1000 * 3).map(|i| [(i % 1000) as f32]).collect();
        let small = shrink(&values, [1000, 3]);
        assert_eq!((small.size, small.values.len()), ([334, 1], 334));
        assert_eq!((small.values[0], small.values[333]), ([1.0], [999.0]));
        let holes = shrink(&[[f32::NAN], [2.0]], [2, 1]);
        assert_eq!(holes.values, [[0.0], [2.0]]);
    }

    #[test]
    fn ranges_are_round_and_hold_most() {
        let errors = vec![(1..=1000).map(|i| [i as f32 * 0.0003]).collect::<Vec<_>>()];
        assert!((common_range(&errors) - 0.5).abs() < 1e-6);
        assert_eq!(common_range(&[]), 1.0);
        assert_eq!(common_range(&[vec![[0.0]]]), 1.0);
    }
}
