//! Radiance RGBE (Ward 1991), plain and in both run-length encodings.

use super::budget::{ImageBudget, room};
use super::decode::{Decoded, Numbers};
use crate::PictureError;

pub(super) fn read(bytes: &[u8], budget: &ImageBudget) -> Result<Decoded, PictureError> {
    let mut source = Source { bytes, at: 0 };
    let head = source.head()?;
    let pixels_at = source.at;
    budget.check(head.width, head.height, 12, bytes.len().saturating_sub(pixels_at) as u64)?;
    let (width, height) = (head.width as u32, head.height as u32);
    let row_length = width as usize;
    let mut rows: Vec<[u8; 4]> = room(row_length.saturating_mul(height as usize))?;
    for row in 0..height {
        source.row(row_length, &mut rows).map_err(|what| source.bad(format!("row {row}"), what))?;
    }
    let mut floats = room(rows.len().saturating_mul(3))?;
    let ordered =
        |y: usize| if head.bottom_up { (height as usize).saturating_sub(y.saturating_add(1)) } else { y };
    for y in (0..height as usize).map(ordered) {
        let start = y.saturating_mul(row_length);
        let row = rows.get(start..start.saturating_add(row_length)).unwrap_or(&[]);
        let mut push = |p: &[u8; 4]| floats.extend(radiance(*p).map(|v| v / head.exposure));
        if head.right_left { row.iter().rev().for_each(&mut push) } else { row.iter().for_each(&mut push) }
    }
    Ok(Decoded {
        width,
        height,
        channels: 3,
        numbers: Numbers::Floats(floats),
        layers: ["R", "G", "B"].map(String::from).into(),
        metadata: head.metadata,
    })
}

/// Mantissas and a shared exponent as numbers: exact.
fn radiance([r, g, b, e]: [u8; 4]) -> [f32; 3] {
    if e == 0 {
        return [0.0; 3];
    }
    // 2^(e − 136) by its exponent field.
    let scale = f64::from_bits((u64::from(e).saturating_add(1023 - 136)) << 52);
    [r, g, b].map(|m| (f64::from(m) * scale) as f32)
}

struct Head {
    width: i64,
    height: i64,
    bottom_up: bool,
    right_left: bool,
    /// What the numbers have been multiplied by.
    exposure: f32,
    metadata: Vec<(String, String)>,
}

struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Source<'_> {
    fn bad(&self, place: String, reason: impl Into<String>) -> PictureError {
        let place = format!("{place}, byte {}", self.at);
        PictureError::Decode { format: "Radiance HDR", place, reason: reason.into() }
    }

    fn line(&mut self) -> Option<String> {
        let rest = self.bytes.get(self.at..)?;
        let end = rest.iter().position(|&b| b == b'\n')?;
        self.at = self.at.saturating_add(end).saturating_add(1);
        Some(String::from_utf8_lossy(rest.get(..end)?).trim_end().to_owned())
    }

    fn head(&mut self) -> Result<Head, PictureError> {
        let header = || "header".to_owned();
        let mut head = Head {
            width: 0,
            height: 0,
            bottom_up: false,
            right_left: false,
            exposure: 1.0,
            metadata: vec![("format".into(), "Radiance HDR".into())],
        };
        loop {
            let Some(line) = self.line() else { return Err(self.bad(header(), "it does not end")) };
            if line.is_empty() {
                break;
            }
            if line.starts_with('#') {
                continue;
            }
            let Some((key, value)) = line.split_once('=') else { continue };
            let (key, value) = (key.trim(), value.trim());
            match key {
                "FORMAT" if value != "32-bit_rle_rgbe" => {
                    let reason = format!("the format '{value}' is not read; write 32-bit_rle_rgbe");
                    return Err(self.bad(header(), reason));
                }
                "EXPOSURE" => match value.parse::<f32>() {
                    Ok(e) if e.is_finite() && e > 0.0 => head.exposure *= e,
                    _ => return Err(self.bad(header(), format!("EXPOSURE='{value}' is no positive number"))),
                },
                _ => {}
            }
            if head.metadata.len() < 256 && key.len().max(value.len()) <= 4096 {
                head.metadata.push((key.into(), value.into()));
            }
        }
        let Some(line) = self.line() else {
            return Err(self.bad(header(), "the line of its size is missing"));
        };
        let words: Vec<&str> = line.split_whitespace().take(5).collect();
        let [y @ ("-Y" | "+Y"), height, x @ ("+X" | "-X"), width] = words[..] else {
            let line: String = line.chars().take(80).collect();
            let reason = format!("the size '{line}' is not read; write '-Y height +X width'");
            return Err(self.bad(header(), reason));
        };
        let side = |text: &str| text.parse::<i64>().map_err(|_| format!("'{text}' is no number of pixels"));
        head.width = side(width).map_err(|why| self.bad(header(), why))?;
        head.height = side(height).map_err(|why| self.bad(header(), why))?;
        (head.bottom_up, head.right_left) = (y == "+Y", x == "-X");
        Ok(head)
    }

    fn byte(&mut self) -> Result<u8, &'static str> {
        let b = self.bytes.get(self.at).copied().ok_or("the file ends here")?;
        self.at = self.at.saturating_add(1);
        Ok(b)
    }

    fn pixel(&mut self) -> Result<[u8; 4], &'static str> {
        Ok([self.byte()?, self.byte()?, self.byte()?, self.byte()?])
    }

    /// Appends one row.
    fn row(&mut self, width: usize, out: &mut Vec<[u8; 4]>) -> Result<(), &'static str> {
        let first = self.pixel()?;
        let [a, b, high, low] = first;
        if (a, b) == (2, 2) && high < 128 && (8..1 << 15).contains(&width) {
            if usize::from(u16::from_be_bytes([high, low])) != width {
                return Err("the row's own width is not the picture's");
            }
            return self.planes(width, out);
        }
        if first.starts_with(&[1, 1, 1]) {
            return Err("it begins with a repetition of nothing");
        }
        out.push(first);
        let mut filled: usize = 1;
        let mut shift: u32 = 0;
        let mut last = first;
        while filled < width {
            let p = self.pixel()?;
            let [1, 1, 1, count] = p else {
                out.push(p);
                (filled, shift, last) = (filled.saturating_add(1), 0, p);
                continue;
            };
            // Counts of repetitions that follow one another are digits to the base 256.
            let count = usize::from(count).checked_shl(shift).unwrap_or(usize::MAX);
            if count > width.saturating_sub(filled) {
                return Err("a repetition reaches past its end");
            }
            out.extend(std::iter::repeat_n(last, count));
            filled = filled.saturating_add(count);
            shift = shift.saturating_add(8).min(usize::BITS.saturating_sub(8));
        }
        Ok(())
    }

    /// Appends one row whose four components stand one after the other.
    fn planes(&mut self, width: usize, out: &mut Vec<[u8; 4]>) -> Result<(), &'static str> {
        let start = out.len();
        out.resize(start.saturating_add(width), [0; 4]);
        for component in 0..4 {
            let mut x: usize = 0;
            while x < width {
                let code = self.byte()?;
                let repeated = code > 128;
                let count = usize::from(if repeated { code.wrapping_sub(128) } else { code });
                if count == 0 || count > width.saturating_sub(x) {
                    return Err("a run is empty or reaches past its end");
                }
                let mut value = if repeated { self.byte()? } else { 0 };
                for _ in 0..count {
                    if !repeated {
                        value = self.byte()?;
                    }
                    let place = out.get_mut(start.saturating_add(x)).and_then(|p| p.get_mut(component));
                    if let Some(place) = place {
                        *place = value;
                    }
                    x = x.saturating_add(1);
                }
            }
        }
        Ok(())
    }
}
