//! Pictures as far as their headers tell.

use serde_json::Value;

use super::report::Issue;
use super::values::{list, text_of};

/// The media type of a picture from its first bytes.
pub(super) fn recognise(bytes: &[u8]) -> Option<&'static str> {
    if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        Some("image/png")
    } else if bytes.starts_with(&[0xFF, 0xD8, 0xFF]) {
        Some("image/jpeg")
    } else if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP") {
        Some("image/webp")
    } else {
        None
    }
}

/// Checks the bytes of image `index` of the document.
pub(crate) fn image(root: &Value, index: usize, bytes: &[u8]) -> Vec<Issue> {
    let place = format!("/images/{index}");
    let mut issues = Vec::new();
    let Some(mime) = recognise(bytes) else {
        issues.push(Issue::warning(
            "IMAGE_UNRECOGNIZED_FORMAT",
            place,
            "neither PNG nor JPEG nor WebP".into(),
        ));
        return issues;
    };
    let declared = || list(root, "extensionsUsed").iter().any(|e| e.as_str() == Some("EXT_texture_webp"));
    if mime == "image/webp" && !declared() {
        issues.push(Issue::error(
            "IMAGE_NON_ENABLED_MIME_TYPE",
            &place,
            "a WebP picture needs EXT_texture_webp; store it as PNG or JPEG".into(),
        ));
    }
    let image = list(root, "images").get(index);
    if let Some(declared) = image.and_then(|i| text_of(i, "mimeType")).filter(|d| *d != mime) {
        let of = if image.is_some_and(|i| i.get("uri").is_some()) { "uri" } else { "bufferView" };
        let message = format!("the picture is {mime} but 'mimeType' says {}", super::values::short(declared));
        issues.push(Issue::error("IMAGE_MIME_TYPE_INVALID", format!("{place}/{of}"), message));
    }
    let header = match mime {
        "image/png" => png(bytes),
        "image/jpeg" => jpeg(bytes),
        _ => webp(bytes),
    };
    match header {
        Ok(()) => {}
        Err(Fault::Ends) => issues.push(Issue::error(
            "IMAGE_UNEXPECTED_EOS",
            place,
            format!("the picture ends after {} bytes, in its header", bytes.len()),
        )),
        Err(Fault::Damaged(what)) => issues.push(Issue::error("IMAGE_DATA_INVALID", place, what.into())),
    }
    issues
}

enum Fault {
    Ends,
    Damaged(&'static str),
}

/// Takes `n` bytes from the front.
fn take<'a>(rest: &mut &'a [u8], n: usize) -> Result<&'a [u8], Fault> {
    let (front, back) = rest.split_at_checked(n).ok_or(Fault::Ends)?;
    *rest = back;
    Ok(front)
}

fn number(bytes: &[u8]) -> usize {
    bytes.iter().fold(0, |n, b| (n << 8) | usize::from(*b))
}

/// The chunks before the pixels.
fn png(bytes: &[u8]) -> Result<(), Fault> {
    let mut rest = bytes;
    take(&mut rest, 8)?;
    let mut first = true;
    loop {
        let length = number(take(&mut rest, 4)?);
        let name = take(&mut rest, 4)?;
        if first && (name != b"IHDR" || length != 13) {
            return Err(Fault::Damaged("its PNG header is not the first chunk"));
        }
        if name == b"IDAT" {
            return Ok(());
        }
        if name == b"IEND" {
            return Err(Fault::Damaged("the PNG picture has no pixels"));
        }
        let body = take(&mut rest, length)?;
        let (width, height) = (body.get(..4).map_or(0, number), body.get(4..8).map_or(0, number));
        if first && (width == 0 || height == 0) {
            return Err(Fault::Damaged("its PNG header says that it has no pixels"));
        }
        take(&mut rest, 4)?;
        first = false;
    }
}

/// The segments up to the frame header.
fn jpeg(bytes: &[u8]) -> Result<(), Fault> {
    let mut rest = bytes;
    take(&mut rest, 2)?;
    loop {
        if take(&mut rest, 1)? != [0xFF] {
            return Err(Fault::Damaged("a JPEG marker is missing"));
        }
        let mut marker = number(take(&mut rest, 1)?);
        while marker == 0xFF {
            marker = number(take(&mut rest, 1)?);
        }
        match marker {
            0x01 | 0xD0..=0xD7 => continue,
            0x00 | 0xD8 | 0xD9 | 0xDA => return Err(Fault::Damaged("the JPEG frame header is missing")),
            _ => {}
        }
        let length = number(take(&mut rest, 2)?);
        let Some(body) = length.checked_sub(2) else {
            return Err(Fault::Damaged("a JPEG segment has an impossible length"));
        };
        // Frame headers; the other three of the row are tables.
        if matches!(marker, 0xC0..=0xCF) && !matches!(marker, 0xC4 | 0xC8 | 0xCC) {
            let frame = take(&mut rest, body)?;
            let side = |range| frame.get(range).map_or(0, number);
            return if side(3..5) == 0 {
                Err(Fault::Damaged("its JPEG header says that it has no pixels"))
            } else {
                Ok(())
            };
        }
        take(&mut rest, body)?;
    }
}

/// The first chunk.
fn webp(bytes: &[u8]) -> Result<(), Fault> {
    let mut rest = bytes;
    take(&mut rest, 12)?;
    let name = take(&mut rest, 4)?;
    if [b"VP8 ", b"VP8L", b"VP8X"].iter().all(|n| name != *n) {
        return Err(Fault::Damaged("the first WebP chunk is not one of a picture"));
    }
    let needed = if name == b"VP8L" { 5 } else { 10 };
    take(&mut rest, 4)?;
    take(&mut rest, needed)?;
    Ok(())
}
