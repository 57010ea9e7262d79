use std::sync::Arc;

use etendue_core::{Spectrum, Transform};
use etendue_light::{GoniometricLight, IntensityTable, IntensityTableError};

use super::IesError;
use super::numbers::Numbers;
use crate::Limits;

/// Most angles of a kind: a hundredth of a degree.
const ANGLES: u32 = 36_001;
/// Most pairs of a tilt table.
const TILTS: u32 = 10_000;
/// The luminous efficacy of green light of 555 nm.
const LUMENS_PER_WATT: f32 = 683.0;

/// A measured lamp.
#[derive(Clone, Debug, PartialEq)]
pub struct IesProfile {
    /// Intensities, candela.
    pub table: Arc<IntensityTable>,
    /// Keywords in the order of the file, without brackets, and what stands behind them.
    pub keywords: Vec<(String, String)>,
    /// Lamps of the luminaire.
    pub lamps: f32,
    /// Lumens per lamp as rated; −1 where the file is of absolute measurement.
    pub lumens_per_lamp: f32,
    /// Electric power, W.
    pub watts: f32,
    /// Width, length and height of the luminous opening, metres; negative ones mean round shapes.
    pub size: [f32; 3],
}

impl IesProfile {
    /// What stands behind a keyword, the first of its name.
    pub fn keyword(&self, name: &str) -> Option<&str> {
        self.keywords.iter().find(|(k, _)| k.eq_ignore_ascii_case(name)).map(|(_, v)| v.as_str())
    }

    /// Luminous flux, lm: the integral of the intensities.
    pub fn lumens(&self) -> f64 {
        self.table.integral()
    }

    /// The lamp as a light, placed as [`GoniometricLight::new`] says. One candela is 1/683 W·sr⁻¹ of each channel, as in
    /// glTF files, times `colour`.
    pub fn light(&self, to_world: &Transform, colour: Spectrum) -> GoniometricLight {
        GoniometricLight::new(to_world, self.table.clone(), colour * (1.0 / LUMENS_PER_WATT))
    }
}

pub(super) fn read(name: &str, bytes: &[u8], limits: &Limits) -> Result<IesProfile, IesError> {
    let text = String::from_utf8_lossy(bytes);
    let mut line = 1;
    parse(&text, limits, &mut line).map_err(|what| IesError::Line { file: name.into(), line, what })
}

/// What the standard's editions differ in.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Edition {
    /// 1986 to 2002: the number after the ballast factor is a factor too (1 from 1995 on).
    Factors,
    /// 2019: that number says how the file came about.
    Generation,
}

/// The edition by the first line, and whether that line said it: in 1986 the file began with its labels.
fn edition(first: &str) -> Result<(Edition, bool), String> {
    match first {
        "IES:LM-63-2019" => Ok((Edition::Generation, true)),
        "IESNA:LM-63-2002" | "IESNA:LM-63-1995" | "IESNA91" => Ok((Edition::Factors, true)),
        other if other.starts_with("IES") => {
            let shown: String = other.chars().take(24).collect();
            Err(format!(
                "the first line is `{shown}`; it must be IES:LM-63-2019, IESNA:LM-63-2002, IESNA:LM-63-1995 or \
                 IESNA91, or a label, as in 1986"
            ))
        }
        _ => Ok((Edition::Factors, false)),
    }
}

/// `at` is the line that is read, for the error.
fn parse(text: &str, limits: &Limits, at: &mut usize) -> Result<IesProfile, String> {
    let most = limits.line_bytes;
    // The limit is a promise, though long lines are no danger to what is read of them.
    if let Some((number, _)) = (1usize..).zip(text.lines()).find(|(_, l)| l.len() > most) {
        *at = number;
        return Err(format!("the line is longer than {most} bytes"));
    }
    let text = text.trim_start_matches('\u{feff}');
    let mut lines = (1usize..).zip(text.lines()).peekable();
    let (edition, said) = edition(lines.peek().map_or("", |(_, first)| first.trim()))?;
    if said {
        lines.next();
    }
    let mut keywords = Vec::new();
    let tilt = loop {
        let Some((number, line)) = lines.next() else {
            return Err("the file ends before its TILT= line".into());
        };
        *at = number;
        if let Some(tilt) = line.trim().strip_prefix("TILT=") {
            break tilt.trim();
        }
        if let Some((key, value)) = line.trim().strip_prefix('[').and_then(|l| l.split_once(']')) {
            keywords.push((key.trim().to_owned(), value.trim().to_owned()));
        }
    };
    if tilt.is_empty() {
        return Err("TILT= must be followed by NONE, INCLUDE or the name of a file".into());
    }
    let mut numbers = Numbers::new(lines);
    let included = if tilt == "INCLUDE" { skip_tilt(&mut numbers) } else { Ok(()) };
    let read = included.and_then(|()| body(&mut numbers, keywords, edition));
    *at = numbers.line().max(*at);
    read
}

/// Geometry, and angles with a factor for each.
fn skip_tilt(numbers: &mut Numbers<'_>) -> Result<(), String> {
    numbers.next("the lamp's geometry")?;
    let pairs = numbers.count("the number of tilt angles", TILTS)?;
    numbers.list(pairs, "a tilt angle")?;
    numbers.list(pairs, "a tilt factor").map(drop)
}

fn body(
    numbers: &mut Numbers<'_>,
    keywords: Vec<(String, String)>,
    edition: Edition,
) -> Result<IesProfile, String> {
    let lamps = numbers.next("the number of lamps")?;
    let lumens_per_lamp = numbers.next("the lumens per lamp")?;
    let multiplier = factor(numbers, "the candela multiplier")?;
    let vertical = numbers.count("the number of vertical angles", ANGLES)?;
    let horizontal = numbers.count("the number of horizontal angles", ANGLES)?;
    let ty = numbers.next("the photometric type")?;
    if ty != 1.0 {
        return Err(format!("the photometric type is {ty}; only type C (1) is read"));
    }
    let unit = match numbers.next("the unit of lengths")? {
        1.0 => 0.3048,
        2.0 => 1.0,
        other => return Err(format!("the unit of lengths is {other}: it must be 1 (feet) or 2 (metres)")),
    };
    let mut size = [0.0; 3];
    for (s, what) in size.iter_mut().zip(["the width", "the length", "the height"]) {
        *s = numbers.next(what)? * unit;
    }
    let ballast = factor(numbers, "the ballast factor")?;
    let ballast_lamp = match edition {
        Edition::Factors => factor(numbers, "the ballast-lamp factor")?,
        Edition::Generation => numbers.next("the file's generation type").map(|_| 1.0)?,
    };
    let watts = numbers.next("the input watts")?;
    let vertical_angles = angles(numbers, vertical, "a vertical angle")?;
    let mut horizontal_angles = angles(numbers, horizontal, "a horizontal angle")?;
    let mut values = Vec::new();
    for _ in 0..vertical.saturating_mul(horizontal) {
        let candela = numbers.next("an intensity")?;
        let v = f64::from(candela) * f64::from(multiplier) * f64::from(ballast) * f64::from(ballast_lamp);
        if !(v >= 0.0 && v <= f64::from(f32::MAX)) {
            return Err(format!("an intensity of {v} candela is negative or too large"));
        }
        values.push(v as f32);
    }
    if is_open_circle(&horizontal_angles) {
        horizontal_angles.push(360.0);
        values.extend_from_within(..vertical_angles.len());
    }
    let table = IntensityTable::new(vertical_angles, horizontal_angles, values)
        .map_err(|e: IntensityTableError| format!("the angles or intensities that end here: {e}"))?;
    Ok(IesProfile { table: Arc::new(table), keywords, lamps, lumens_per_lamp, watts, size })
}

/// Whether the angles go around and leave out 360°, which is 0° again: by the standard of 1995 the last one is below it.
/// A gap larger than the steps is no such thing.
fn is_open_circle(angles: &[f32]) -> bool {
    let steps = angles.iter().zip(angles.iter().skip(1)).map(|(a, b)| b - a);
    let widest = steps.fold(0.0, |m, step| if step > m { step } else { m });
    let (first, last) = (angles.first().copied(), angles.last().copied());
    first == Some(0.0) && last.is_some_and(|l| l > 180.0 && l < 360.0 && 360.0 - l <= 1.001 * widest)
}

fn factor(numbers: &mut Numbers<'_>, what: &str) -> Result<f32, String> {
    let v = numbers.next(what)?;
    if v > 0.0 { Ok(v) } else { Err(format!("{what} is {v}: it must be greater than zero")) }
}

/// Ascending angles, so that the line of the first that is not is known.
fn angles(numbers: &mut Numbers<'_>, count: usize, what: &str) -> Result<Vec<f32>, String> {
    let mut out: Vec<f32> = Vec::new();
    for _ in 0..count {
        let v = numbers.next(what)?;
        if let Some(last) = out.last().filter(|last| v <= **last) {
            return Err(format!("{what} of {v} degrees does not ascend from {last}"));
        }
        out.push(v);
    }
    Ok(out)
}
