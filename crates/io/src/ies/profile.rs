use std::sync::Arc;

use etendue_light::{IntensityTable, IntensityTableError};

use super::IesError;
use super::numbers::Numbers;
use crate::Limits;

/// Most angles of a kind: a hundredth of a degree.
const ANGLES: u32 = 36_001;
/// Most pairs of a tilt table.
const TILTS: u32 = 10_000;

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
}

pub(super) fn read(name: &str, bytes: &[u8], limits: &Limits) -> Result<IesProfile, IesError> {
    let text = String::from_utf8_lossy(bytes);
    let mut line = 1;
    parse(&text, limits, &mut line).map_err(|what| IesError::Line { file: name.into(), line, what })
}

/// `at` is the line that is read, for the error.
fn parse(text: &str, limits: &Limits, at: &mut usize) -> Result<IesProfile, String> {
    let mut lines = (1usize..).zip(text.lines());
    let (_, first) = lines.next().unwrap_or((1, ""));
    let first = first.trim_start_matches('\u{feff}').trim();
    if !["IESNA:LM-63-1995", "IESNA:LM-63-2002", "IES:LM-63-2019", "IESNA91"].contains(&first) {
        return Err(
            "the first line must be IESNA:LM-63-1995, IESNA:LM-63-2002, IES:LM-63-2019 or IESNA91".into()
        );
    }
    let mut keywords = Vec::new();
    let tilt = loop {
        let Some((number, line)) = lines.next() else {
            return Err("the file ends before its TILT= line".into());
        };
        *at = number;
        if line.len() > limits.line_bytes {
            return Err(format!("the line is longer than {} bytes", limits.line_bytes));
        }
        if let Some(tilt) = line.trim().strip_prefix("TILT=") {
            break tilt.trim();
        }
        if let Some((key, value)) = line.trim().strip_prefix('[').and_then(|l| l.split_once(']')) {
            keywords.push((key.trim().to_owned(), value.trim().to_owned()));
        }
    };
    let most = limits.line_bytes;
    let mut numbers = Numbers::new(lines);
    let read = (|| {
        match tilt {
            "NONE" => {}
            "INCLUDE" => skip_tilt(&mut numbers)?,
            _ => {
                return Err(
                    "TILT must be NONE or INCLUDE; a tilt table in a file of its own is not read".into()
                );
            }
        }
        body(&mut numbers, keywords)
    })();
    *at = numbers.line().max(*at);
    // Long lines are no danger to what has been read of them: the limit is a promise all the same.
    if let Some((number, _)) = (1usize..).zip(text.lines()).find(|(_, l)| l.len() > most) {
        *at = number;
        return Err(format!("the line is longer than {most} bytes"));
    }
    read
}

/// Geometry, and angles with a factor for each.
fn skip_tilt(numbers: &mut Numbers<'_>) -> Result<(), String> {
    numbers.next("the lamp's geometry")?;
    let pairs = numbers.count("the number of tilt angles", TILTS)?;
    numbers.list(pairs, "a tilt angle")?;
    numbers.list(pairs, "a tilt factor").map(drop)
}

fn body(numbers: &mut Numbers<'_>, keywords: Vec<(String, String)>) -> Result<IesProfile, String> {
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
    let ballast_lamp = factor(numbers, "the ballast-lamp factor")?;
    let watts = numbers.next("the input watts")?;
    let vertical_angles = angles(numbers, vertical, "a vertical angle")?;
    let horizontal_angles = angles(numbers, horizontal, "a horizontal angle")?;
    let mut values = Vec::new();
    for _ in 0..vertical.saturating_mul(horizontal) {
        let candela = numbers.next("an intensity")?;
        let v = f64::from(candela) * f64::from(multiplier) * f64::from(ballast) * f64::from(ballast_lamp);
        if !(v >= 0.0 && v <= f64::from(f32::MAX)) {
            return Err(format!("an intensity of {v} candela is negative or too large"));
        }
        values.push(v as f32);
    }
    let table = IntensityTable::new(vertical_angles, horizontal_angles, values)
        .map_err(|e: IntensityTableError| format!("the angles or intensities that end here: {e}"))?;
    Ok(IesProfile { table: Arc::new(table), keywords, lamps, lumens_per_lamp, watts, size })
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
