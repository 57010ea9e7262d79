//! GLB framing, JSON text and the headers of pictures.

use serde_json::json;

use super::super::*;

fn framed(length: u32, chunks: &[(u32, &[u8], &[u8; 4])]) -> Vec<u8> {
    let mut out = b"glTF".to_vec();
    out.extend(2u32.to_le_bytes());
    out.extend(length.to_le_bytes());
    for (size, body, kind) in chunks {
        out.extend(size.to_le_bytes());
        out.extend(*kind);
        out.extend(*body);
    }
    out
}

#[test]
fn a_valid_container_is_taken_apart() {
    let bytes = framed(36, &[(4, b"{}  ", b"JSON"), (4, b"abcd", b"BIN\0")]);
    let parts = glb(&bytes).expect("valid");
    assert_eq!((parts.json, parts.bin, parts.warnings.len()), (&b"{}  "[..], Some(&b"abcd"[..]), 0));
    let mut longer = bytes.clone();
    longer.extend(b"more");
    assert_eq!(glb(&longer).expect("valid").warnings[0].code, "GLB_EXTRA_DATA");
    for end in 0..bytes.len() {
        assert!(glb(&bytes[..end]).is_err(), "{end} bytes");
    }
}

#[test]
fn each_fault_of_the_framing_has_its_code() {
    let json: (u32, &[u8], &[u8; 4]) = (4, b"{}  ", b"JSON");
    let bin: (u32, &[u8], &[u8; 4]) = (4, b"abcd", b"BIN\0");
    for (bytes, code, place) in [
        (vec![], "GLB_UNEXPECTED_END_OF_HEADER", "@0"),
        (b"glTG00000000".to_vec(), "GLB_INVALID_MAGIC", "@0"),
        (b"glTF\x01\0\0\0\x0c\0\0\0".to_vec(), "GLB_INVALID_VERSION", "@4"),
        (framed(12, &[]), "GLB_LENGTH_TOO_SMALL", "@8"),
        (framed(24, &[(8, b"{}  ", b"JSON")]), "GLB_CHUNK_TOO_BIG", "@12"),
        (framed(u32::MAX, &[(u32::MAX - 23, b"{}  ", b"JSON")]), "GLB_UNEXPECTED_END_OF_CHUNK_DATA", "@24"),
        (framed(24, &[(3, b"{}  ", b"JSON")]), "GLB_CHUNK_LENGTH_UNALIGNED", "@12"),
        (framed(24, &[bin]), "GLB_UNEXPECTED_FIRST_CHUNK", "@12"),
        (framed(20, &[(0, b"", b"JSON")]), "GLB_EMPTY_CHUNK", "@12"),
        (framed(36, &[json, json]), "GLB_DUPLICATE_CHUNK", "@24"),
        (framed(48, &[json, (4, b"abcd", b"ODD\0"), bin]), "GLB_UNEXPECTED_BIN_CHUNK", "@36"),
        (framed(48, &[json]), "GLB_LENGTH_MISMATCH", "@24"),
    ] {
        let issue = glb(&bytes).expect_err(code);
        assert_eq!((issue.code, issue.pointer.as_str(), issue.harmless), (code, place, false), "{issue}");
    }
    let odd = framed(36, &[json, (4, b"abcd", b"ODD\0")]);
    assert_eq!(glb(&odd).expect("valid").warnings[0].code, "GLB_UNKNOWN_CHUNK_TYPE");
}

#[test]
fn json_is_read_within_a_budget() {
    let read = |json: &str, budget| text(json.as_bytes(), budget).map(|t| t.root);
    assert_eq!(
        read(r#"{"a":[1,-2,3.5,"x",null,true]}"#, 100),
        Ok(json!({"a": [1, -2, 3.5, "x", null, true]}))
    );
    for bad in ["", "{", "[1,]", "{} x", "[1e999]", "\u{feff}{}", "nul"] {
        assert_eq!(read(bad, 100).expect_err(bad).code, "INVALID_JSON", "{bad}");
    }
    assert_eq!(text(b"{\"\xff\":1}", 100).expect_err("no UTF-8").code, "INVALID_JSON");
    let deep = "[".repeat(100_000);
    assert_eq!(read(&deep, 1 << 20).expect_err("deep").code, "INVALID_JSON");
    let many = format!("[{}[]]", "[],".repeat(1000));
    assert_eq!(read(&many, 1002).map(|v| v.as_array().map(Vec::len)), Ok(Some(1001)));
    assert_eq!(read(&many, 1001).expect_err("too many").code, "LIMIT_JSON_VALUES");
    let objects = format!("[{}0]", r#"{"":0},"#.repeat(100));
    assert_eq!(read(&objects, 900).expect_err("objects cost more").code, "LIMIT_JSON_VALUES");
}

#[test]
fn doubled_keys_are_noted() {
    let read = text(br#"{"a": {"b": 1, "b": 2}}"#, 100).expect("JSON");
    assert_eq!(read.root, json!({"a": {"b": 2}}));
    assert_eq!((read.warnings[0].code, read.warnings[0].pointer.as_str()), ("DUPLICATE_KEY", "/a/b"));
}

#[test]
fn headers_of_pictures() {
    let root = json!({
        "images": [{"uri": "a"}, {"uri": "a", "mimeType": "image/jpeg"}, {"bufferView": 0, "mimeType": "image/jpeg"}],
    });
    let png =
        [&b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\x02\0\0\0crc!"[..], b"\0\0\0\x01IDAT"]
            .concat();
    let jpeg = b"\xff\xd8\xff\xe0\0\x04ab\xff\xc0\0\x08\x08\0\x01\0\x01\x03";
    let codes = |index: usize, bytes: &[u8]| -> Vec<(&str, String)> {
        image(&root, index, bytes).into_iter().map(|i| (i.code, i.pointer)).collect()
    };
    assert_eq!(codes(0, &png), []);
    assert_eq!(codes(1, jpeg), []);
    assert_eq!(codes(0, b"nothing"), [("IMAGE_UNRECOGNIZED_FORMAT", "/images/0".into())]);
    assert_eq!(codes(1, &png), [("IMAGE_MIME_TYPE_INVALID", "/images/1/uri".into())]);
    assert_eq!(codes(2, &png), [("IMAGE_MIME_TYPE_INVALID", "/images/2/bufferView".into())]);
    assert_eq!(codes(0, &png[..30]), [("IMAGE_UNEXPECTED_EOS", "/images/0".into())]);
    assert_eq!(codes(0, b"\xff\xd8\xff\xe0\0\x01"), [("IMAGE_DATA_INVALID", "/images/0".into())]);
    assert_eq!(
        codes(0, b"RIFF\x1c\0\0\0WEBPVP8L\x05\0\0\0abcde"),
        [("IMAGE_NON_ENABLED_MIME_TYPE", "/images/0".into())]
    );
    for bytes in [&png[..], jpeg] {
        for end in 0..bytes.len() {
            let _ = codes(0, &bytes[..end]);
        }
    }
}

#[test]
fn buffers_have_the_bytes_that_they_promise() {
    let root = json!({"buffers": [{"byteLength": 8}]});
    let code = |bytes: Option<&[u8]>, bin| buffer(&root, 0, bytes, bin).map(|i| i.code);
    assert_eq!(code(Some(&[0; 8]), false), None);
    assert_eq!(code(Some(&[0; 11]), true), None);
    assert_eq!(code(Some(&[0; 12]), true), Some("BUFFER_GLB_CHUNK_TOO_BIG"));
    assert_eq!(code(Some(&[0; 7]), false), Some("BUFFER_BYTE_LENGTH_MISMATCH"));
    assert_eq!(code(None, true), Some("BUFFER_MISSING_GLB_DATA"));
}
