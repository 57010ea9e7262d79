//! The values behind the header, from text or bytes.

use super::header::{Format, Scalar, short};

/// Reads one value after the other.
pub(super) struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    format: Format,
}

impl<'a> Source<'a> {
    /// The values of a file from a byte on, which is at the start of a line.
    pub(super) fn new(bytes: &'a [u8], at: usize, line: usize, format: Format) -> Self {
        Self { bytes, at, line: line.saturating_add(1), format }
    }

    /// Where it is, for a message.
    pub(super) fn place(&self) -> String {
        match self.format {
            Format::Text => format!("line {}", self.line),
            _ => format!("byte {}", self.at),
        }
    }

    /// How many more bytes there are.
    pub(super) fn left(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }

    /// How many values of so many bytes each there is room for at most.
    pub(super) fn room(&self, bytes: u64, values: u64) -> u64 {
        let (each, left) = match self.format {
            // A digit and what parts it from the next.
            Format::Text => (values.saturating_mul(2), self.left().saturating_add(1)),
            _ => (bytes, self.left()),
        };
        (left as u64).checked_div(each).unwrap_or(u64::MAX)
    }

    /// The next value.
    pub(super) fn scalar(&mut self, ty: Scalar) -> Result<f64, String> {
        if self.format == Format::Text {
            return self.word(ty);
        }
        let bytes = self.take(ty.size()).ok_or_else(cut_off)?;
        decode(bytes, ty, self.format == Format::Big).ok_or_else(cut_off)
    }

    /// Passes over so many values.
    pub(super) fn skip(&mut self, ty: Scalar, count: u64) -> Result<(), String> {
        if self.format == Format::Text {
            for _ in 0..count {
                self.token().ok_or_else(cut_off)?;
            }
            return Ok(());
        }
        let bytes = usize::try_from(count).ok().and_then(|n| n.checked_mul(ty.size()));
        bytes.and_then(|n| self.take(n)).map(drop).ok_or_else(cut_off)
    }

    /// The length of a list of items.
    pub(super) fn length(&mut self, count: Scalar, item: Scalar) -> Result<u64, String> {
        let n = self.scalar(count)?;
        if n < 0.0 {
            return Err(format!("a list of {n} items; lengths are not negative"));
        }
        let room = self.room(item.size() as u64, 1);
        if n > room as f64 {
            return Err(format!(
                "a list of {n} items, but there are bytes for {room} only; the file is cut off"
            ));
        }
        Ok(n as u64)
    }

    fn take(&mut self, n: usize) -> Option<&'a [u8]> {
        let end = self.at.checked_add(n)?;
        let bytes = self.bytes.get(self.at..end)?;
        self.at = end;
        Some(bytes)
    }

    fn token(&mut self) -> Option<&'a [u8]> {
        let rest = self.bytes.get(self.at..)?;
        let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
        let (blank, word) = rest.split_at_checked(start)?;
        self.line = self.line.saturating_add(blank.iter().filter(|b| **b == b'\n').count());
        let length = word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len());
        self.at = self.at.saturating_add(start).saturating_add(length);
        word.get(..length)
    }

    fn word(&mut self, ty: Scalar) -> Result<f64, String> {
        let token = self.token().ok_or_else(cut_off)?;
        let text = std::str::from_utf8(token).unwrap_or("?");
        let x: f64 = text.parse().map_err(|_| format!("'{}' is no number", short(text)))?;
        match ty.most() {
            Some(_) if x.fract() != 0.0 => Err(format!("'{}' is no whole number", short(text))),
            Some(most) if x > most || x < least(ty) => {
                Err(format!("{x} is out of the type's range of {} to {most}", least(ty)))
            }
            _ => Ok(x),
        }
    }
}

fn cut_off() -> String {
    "the file ends here; it is cut off".into()
}

fn least(ty: Scalar) -> f64 {
    match ty {
        Scalar::I8 => f64::from(i8::MIN),
        Scalar::I16 => f64::from(i16::MIN),
        Scalar::I32 => f64::from(i32::MIN),
        Scalar::U8 | Scalar::U16 | Scalar::U32 => 0.0,
        Scalar::F32 | Scalar::F64 => f64::NEG_INFINITY,
    }
}

fn ordered<const N: usize>(bytes: &[u8], big: bool) -> Option<[u8; N]> {
    let mut out: [u8; N] = bytes.try_into().ok()?;
    if big {
        out.reverse();
    }
    Some(out)
}

fn decode(bytes: &[u8], ty: Scalar, big: bool) -> Option<f64> {
    Some(match ty {
        Scalar::I8 => f64::from(i8::from_le_bytes(ordered(bytes, big)?)),
        Scalar::U8 => f64::from(u8::from_le_bytes(ordered(bytes, big)?)),
        Scalar::I16 => f64::from(i16::from_le_bytes(ordered(bytes, big)?)),
        Scalar::U16 => f64::from(u16::from_le_bytes(ordered(bytes, big)?)),
        Scalar::I32 => f64::from(i32::from_le_bytes(ordered(bytes, big)?)),
        Scalar::U32 => f64::from(u32::from_le_bytes(ordered(bytes, big)?)),
        Scalar::F32 => f64::from(f32::from_le_bytes(ordered(bytes, big)?)),
        Scalar::F64 => f64::from_le_bytes(ordered(bytes, big)?),
    })
}
