use std::path::Path;

use etendue_camera::Film;

use crate::{WriteError, write_atomically};

/// Widths whose rows can be run-length encoded.
const ENCODED: std::ops::Range<usize> = 8..1 << 15;
/// Shortest repetition that is worth its two bytes.
const RUN: usize = 4;
/// Longest repetition and longest stretch of different bytes.
const LONGEST_RUN: usize = 127;
const LONGEST_STRETCH: usize = 128;

/// Writes a film's means as Radiance HDR: eight bits a channel with a shared exponent, so that the largest channel of
/// a pixel is within 0.2 % (negative numbers and what is no number become 0). `notes` are (name, value) lines of the
/// header.
///
/// # Errors
/// [`WriteError`]; the target is then as it was.
pub fn write_hdr(path: &Path, film: &Film, notes: &[(String, String)]) -> Result<(), WriteError> {
    let size = film.size();
    let mut out = b"#?RADIANCE\n# etendue\nFORMAT=32-bit_rle_rgbe\n".to_vec();
    for (name, value) in notes {
        // A line of its own, whatever is in it.
        let clean = |text: &str| text.chars().filter(|c| !c.is_control() && *c != '=').collect::<String>();
        out.extend_from_slice(format!("etendue.{}={}\n", clean(name), clean(value)).as_bytes());
    }
    out.extend_from_slice(format!("\n-Y {} +X {}\n", size.y, size.x).as_bytes());
    let pixels = film.to_rgb();
    let width = size.x as usize;
    for row in pixels.chunks_exact(width.max(1)) {
        let row: Vec<[u8; 4]> = row.iter().map(|&c| rgbe(c)).collect();
        if ENCODED.contains(&width) {
            let [high, low] = (width as u16).to_be_bytes();
            out.extend_from_slice(&[2, 2, high, low]);
            for component in 0..4 {
                let plane: Vec<u8> = row.iter().filter_map(|p| p.get(component).copied()).collect();
                encode(&plane, &mut out);
            }
        } else {
            row.iter().for_each(|p| out.extend_from_slice(p));
        }
    }
    write_atomically(path, &out)
}

/// The nearest colour with a shared exponent.
fn rgbe(c: [f32; 3]) -> [u8; 4] {
    /// The largest number of the format: 255 · 2¹¹⁹.
    const MOST: f32 = 1.694_740_2e38;
    let c = c.map(|v| if v > 0.0 { v.min(MOST) } else { 0.0 });
    let [r, g, b] = c;
    let largest = r.max(g).max(b);
    // The exponent field: largest = m · 2^(field − 126), m in [0.5, 1).
    let mut e = ((largest.to_bits() >> 23) & 0xff).saturating_add(2);
    loop {
        if !(4..=255).contains(&e) {
            return [0; 4];
        }
        // 2^(136 − e).
        let scale = f64::from_bits(u64::from(1023u32.saturating_add(136).saturating_sub(e)) << 52);
        let [r, g, b] = c.map(|v| (f64::from(v) * scale + 0.5) as u32);
        if r.max(g).max(b) > 255 {
            // Rounded up to the next power of two.
            e = e.saturating_add(1);
            continue;
        }
        return [r as u8, g as u8, b as u8, e as u8];
    }
}

/// Appends one component of one row: repetitions as 128 + count and value, everything else as count and bytes.
fn encode(plane: &[u8], out: &mut Vec<u8>) {
    let run_at = |rest: &[u8]| rest.iter().take(LONGEST_RUN).take_while(|b| Some(*b) == rest.first()).count();
    let mut rest = plane;
    while let Some(&value) = rest.first() {
        let run = run_at(rest);
        if run >= RUN {
            out.extend_from_slice(&[128u8.saturating_add(run as u8), value]);
            rest = rest.get(run..).unwrap_or(&[]);
            continue;
        }
        let until_run = (1..rest.len().min(LONGEST_STRETCH))
            .find(|&i| run_at(rest.get(i..).unwrap_or(&[])) >= RUN)
            .unwrap_or(rest.len().min(LONGEST_STRETCH));
        let (stretch, after) = rest.split_at_checked(until_run).unwrap_or((rest, &[]));
        out.push(stretch.len() as u8);
        out.extend_from_slice(stretch);
        rest = after;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_pixels() {
        assert_eq!(rgbe([0.0, -1.0, f32::NAN]), [0; 4]);
        assert_eq!(rgbe([1.0, 0.5, 0.25]), [128, 64, 32, 129]);
        // 0.999 is nearer to 1 than to 255/256.
        assert_eq!(rgbe([0.999, 0.0, 0.0]), [128, 0, 0, 129]);
        assert_eq!(rgbe([f32::INFINITY, 1.0, 0.0]), [255, 0, 0, 255]);
        assert_eq!(rgbe([1e-40; 3]), [0; 4]);
    }

    #[test]
    fn runs_are_short() {
        let mut out = Vec::new();
        encode(&[7; 300], &mut out);
        assert_eq!(out, [255, 7, 255, 7, 174, 7]);
        out.clear();
        encode(&[1, 2, 3, 3, 3, 3, 9], &mut out);
        assert_eq!(out, [2, 1, 2, 132, 3, 1, 9]);
    }
}
