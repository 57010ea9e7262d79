//! What a `uri` stands for: bytes inside of it, or a file below the scene's folder.

use base64::Engine;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use crate::{ResolveError, Resolver};

/// Some exporters leave the padding out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The bytes that a URI names, at most `limit`.
pub(super) fn read(uri: &str, resolver: &dyn Resolver, limit: u64) -> Result<Vec<u8>, ResolveError> {
    match uri.strip_prefix("data:") {
        Some(data) => inline(data, limit),
        None => resolver.read(&decoded(uri).ok_or_else(|| ResolveError::Outside(short(uri)))?, limit),
    }
}

/// The beginning of a name, for messages.
fn short(uri: &str) -> String {
    uri.chars().take(60).collect()
}

fn inline(data: &str, limit: u64) -> Result<Vec<u8>, ResolveError> {
    let name = || format!("data:{}", short(data));
    let bad = || ResolveError::Open {
        name: name(),
        source: std::io::Error::new(
            std::io::ErrorKind::InvalidData,
            "it is not valid base64; export the file again",
        ),
    };
    let (head, body) = data.split_once(',').ok_or_else(bad)?;
    // Three bytes for every four letters.
    if (body.len() as u64).saturating_div(4).saturating_mul(3) > limit {
        return Err(ResolveError::TooLarge { name: name(), limit });
    }
    if head.ends_with(";base64") {
        BASE64.decode(body).map_err(|_| bad())
    } else {
        percent(body.as_bytes()).ok_or_else(bad)
    }
}

/// A relative reference with its `%` escapes undone, once.
fn decoded(uri: &str) -> Option<String> {
    String::from_utf8(percent(uri.as_bytes())?).ok()
}

fn percent(text: &[u8]) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(text.len());
    let mut bytes = text.iter();
    while let Some(&b) = bytes.next() {
        if b != b'%' {
            out.push(b);
            continue;
        }
        let mut digit =
            || bytes.next().and_then(|&d| char::from(d).to_digit(16)).and_then(|d| u8::try_from(d).ok());
        out.push(digit()?.checked_mul(16)?.checked_add(digit()?)?);
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NoFiles;

    #[test]
    fn escapes_are_undone_once() {
        assert_eq!(decoded("a%20b%252e.bin").as_deref(), Some("a b%2e.bin"));
        assert_eq!(decoded("a%2"), None);
        assert_eq!(decoded("a%zz"), None);
        assert_eq!(decoded("%ff"), None, "no UTF-8");
    }

    #[test]
    fn data_is_bounded_before_it_is_decoded() {
        let read = |uri: &str, limit| read(uri, &NoFiles, limit);
        assert_eq!(read("data:application/octet-stream;base64,AAEC", 3).ok(), Some(vec![0, 1, 2]));
        assert_eq!(read("data:,a%00", 9).ok(), Some(vec![b'a', 0]));
        assert!(matches!(read("data:;base64,AAEC", 2), Err(ResolveError::TooLarge { .. })));
        assert!(matches!(read("data:;base64,A*", 9), Err(ResolveError::Open { .. })));
        assert!(matches!(read("data:", 9), Err(ResolveError::Open { .. })));
        assert!(matches!(read("..%2fx.bin", 9), Err(ResolveError::Outside(_))));
    }
}
