//! The syntax of URIs (RFC 3986) and of data in them (RFC 2397).

use super::report::{At, Report};
use super::values::short;

/// What a URI is.
#[derive(Debug)]
pub(super) enum Uri<'a> {
    /// Data in the text itself.
    Data(Data<'a>),
    /// A file.
    File,
}

/// Data in a URI.
#[derive(Debug)]
pub(super) struct Data<'a> {
    /// Media type, in small letters.
    pub mime: String,
    /// Bytes after decoding.
    pub length: u64,
    /// Base64, of which the beginning can be decoded.
    base64: Option<&'a str>,
}

impl Data<'_> {
    /// The first bytes, as many as tell a picture's format.
    pub(super) fn beginning(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(24);
        let digits: Vec<u32> =
            self.base64.unwrap_or("").bytes().take(32).map_while(digit).map(u32::from).collect();
        for four in digits.chunks_exact(4) {
            let bits = four.iter().fold(0u32, |bits, d| (bits << 6) | d);
            out.extend(bits.to_be_bytes().into_iter().skip(1));
        }
        out
    }
}

/// Checks a URI. None if it is no URI.
pub(super) fn check<'a>(text: &'a str, at: &At<'_>, report: &mut Report) -> Option<Uri<'a>> {
    match parse(text) {
        Ok(uri) => {
            if matches!(uri, Uri::File) && scheme(text).is_some() {
                report.warning("NON_RELATIVE_URI", at, || {
                    format!("'{}' is not relative; put the file beside the scene", short(text))
                });
            }
            Some(uri)
        }
        Err(why) => {
            report.error("INVALID_URI", at, || format!("'{}' is no URI: {why}", short(text)));
            None
        }
    }
}

fn scheme(text: &str) -> Option<&str> {
    let (scheme, _) = text.split_once(':')?;
    let letters = |c: char| c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.');
    (scheme.starts_with(|c: char| c.is_ascii_alphabetic()) && scheme.chars().all(letters)).then_some(scheme)
}

fn parse(text: &str) -> Result<Uri<'_>, &'static str> {
    if text.starts_with(':') {
        return Err("there is no scheme before the ':'");
    }
    match scheme(text) {
        Some(s) if s.eq_ignore_ascii_case("data") => {
            let rest = text.get(s.len()..).and_then(|r| r.strip_prefix(':')).unwrap_or("");
            data(rest).map(Uri::Data)
        }
        _ => Ok(Uri::File),
    }
}

fn data(rest: &str) -> Result<Data<'_>, &'static str> {
    let (head, body) = rest.split_once(',').ok_or("there is no ',' before the data")?;
    let mut parts = head.split(';');
    let mime = parts.next().unwrap_or("").to_ascii_lowercase();
    if !mime.is_empty() && mime.split_once('/').is_none_or(|(a, b)| a.is_empty() || b.is_empty()) {
        return Err("the media type is not like type/subtype");
    }
    let mut is_base64 = false;
    for part in parts {
        if is_base64 {
            return Err("'base64' must be the last before the ','");
        }
        is_base64 = part.eq_ignore_ascii_case("base64");
        if !is_base64 && part.split_once('=').is_none_or(|(name, _)| name.is_empty()) {
            return Err("a parameter of the media type is not like name=value");
        }
    }
    let mime = if mime.is_empty() { "text/plain".into() } else { mime };
    if is_base64 {
        let length = base64_length(body).ok_or("its base64 data are damaged")?;
        Ok(Data { mime, length, base64: Some(body) })
    } else {
        Ok(Data { mime, length: percent_length(body), base64: None })
    }
}

/// Bytes that percent-encoded text stands for.
fn percent_length(body: &str) -> u64 {
    let escapes = body.bytes().filter(|b| *b == b'%').count() as u64;
    (body.len() as u64).saturating_sub(escapes.saturating_mul(2))
}

/// Bytes that base64 text stands for; padding may be missing. None if it is none.
fn base64_length(body: &str) -> Option<u64> {
    let digits = body.trim_end_matches('=');
    let padding = body.len().checked_sub(digits.len())?;
    if padding > 2 || (padding > 0 && !body.len().is_multiple_of(4)) || digits.len() % 4 == 1 {
        return None;
    }
    digits.bytes().all(|b| digit(b).is_some()).then_some(())?;
    (digits.len() as u64).checked_mul(3)?.checked_div(4)
}

/// The value of a base64 digit, in the usual or the URL-safe alphabet.
fn digit(b: u8) -> Option<u8> {
    Some(match b {
        b'A'..=b'Z' => b.wrapping_sub(b'A'),
        b'a'..=b'z' => b.wrapping_sub(b'a').wrapping_add(26),
        b'0'..=b'9' => b.wrapping_sub(b'0').wrapping_add(52),
        b'+' | b'-' => 62,
        b'/' | b'_' => 63,
        _ => return None,
    })
}
