//! The header: what elements there are, and of what.

use super::error::PlyError;
use crate::Limits;

/// A type of number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn new(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The greatest whole number; none for fractions.
    pub(super) fn most(self) -> Option<f64> {
        Some(match self {
            Self::I8 => f64::from(i8::MAX),
            Self::U8 => f64::from(u8::MAX),
            Self::I16 => f64::from(i16::MAX),
            Self::U16 => f64::from(u16::MAX),
            Self::I32 => f64::from(i32::MAX),
            Self::U32 => f64::from(u32::MAX),
            Self::F32 | Self::F64 => return None,
        })
    }
}

/// What a property is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar(Scalar),
    /// A number of items, and the items.
    List(Scalar, Scalar),
}

/// A property of an element.
#[derive(Clone, Debug)]
pub(super) struct Property {
    pub name: String,
    pub kind: Kind,
}

/// A kind of element.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

impl Element {
    /// Bytes of the numbers that each has, if all its lists are empty.
    pub(super) fn least_bytes(&self) -> u64 {
        let size = |p: &Property| match p.kind {
            Kind::Scalar(s) | Kind::List(s, _) => s.size() as u64,
        };
        self.properties.iter().map(size).fold(0, u64::saturating_add)
    }
}

/// How the values are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Text,
    Little,
    Big,
}

/// A header, and where the values begin.
#[derive(Clone, Debug)]
pub(super) struct Header {
    pub format: Format,
    pub elements: Vec<Element>,
    /// Byte after the header.
    pub end: usize,
    /// Lines of the header.
    pub lines: usize,
}

struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    end: u8,
}

impl<'a> Lines<'a> {
    /// The next line without its end; none if the file ends before the line does.
    fn next(&mut self, limits: &Limits) -> Option<&'a [u8]> {
        let rest = self.bytes.get(self.at..)?;
        let window = rest.get(..limits.line_bytes).unwrap_or(rest);
        let length = window.iter().position(|b| *b == self.end)?;
        self.at = self.at.saturating_add(length).saturating_add(1);
        self.line = self.line.saturating_add(1);
        let line = rest.get(..length)?;
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }
}

/// Reads the header.
pub(super) fn read(file: &str, bytes: &[u8], limits: &Limits) -> Result<Header, PlyError> {
    // Old Macintosh files end lines with a carriage return alone.
    let end = match bytes.strip_prefix(b"ply") {
        Some([b'\r', next, ..]) if *next != b'\n' => b'\r',
        _ => b'\n',
    };
    let mut lines = Lines { bytes, at: 0, line: 0, end };
    let mut header = Header { format: Format::Text, elements: Vec::new(), end: 0, lines: 0 };
    let mut format = None;
    loop {
        let fail = |line: usize, what: String| PlyError::Header { file: file.into(), line, what };
        let Some(line) = lines.next(limits) else {
            let what = "the header has no 'end_header'; the file is cut off or no PLY file".into();
            return Err(fail(lines.line.saturating_add(1), what));
        };
        let here = lines.line;
        let fail = |what: String| fail(here, what);
        let text = String::from_utf8_lossy(line);
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        match words.as_slice() {
            ["ply"] if here == 1 => {}
            _ if here == 1 => {
                return Err(fail("the file does not begin with 'ply'; it is no PLY file".into()));
            }
            ["end_header"] => break,
            [] | ["comment" | "obj_info", ..] => {}
            ["format", name, version] => {
                format = Some(match *name {
                    "ascii" => Format::Text,
                    "binary_little_endian" => Format::Little,
                    "binary_big_endian" => Format::Big,
                    _ => return Err(fail(format!("the format '{}' is not known", short(name)))),
                });
                if *version != "1.0" {
                    return Err(fail(format!("version '{}'; only 1.0 is known", short(version))));
                }
            }
            ["element", name, count] => {
                let count = count
                    .parse()
                    .map_err(|_| fail(format!("'{}' is no number of elements", short(count))))?;
                if header.elements.iter().any(|e| e.name == *name) {
                    return Err(fail(format!("a second element '{}'", short(name))));
                }
                let name = (*name).to_owned();
                header.elements.push(Element { name, count, properties: Vec::new() });
            }
            ["property", rest @ ..] => {
                let property = property(rest).map_err(fail)?;
                let Some(element) = header.elements.last_mut() else {
                    return Err(fail("a property before the first element; it belongs behind one".into()));
                };
                element.properties.push(property);
            }
            _ => return Err(fail(format!("'{}' is no line of a header", short(&text)))),
        }
    }
    header.format = format.ok_or_else(|| PlyError::Header {
        file: file.into(),
        line: lines.line,
        what: "the header has no 'format'; add one, as in 'format ascii 1.0'".into(),
    })?;
    header.end = lines.at;
    header.lines = lines.line;
    Ok(header)
}

fn property(words: &[&str]) -> Result<Property, String> {
    let scalar =
        |name: &str| Scalar::new(name).ok_or_else(|| format!("the type '{}' is not known", short(name)));
    match words {
        ["list", count, item, name] => {
            let count = scalar(count)?;
            if count.most().is_none() {
                return Err("a list is counted in whole numbers, not in fractions".into());
            }
            Ok(Property { name: (*name).into(), kind: Kind::List(count, scalar(item)?) })
        }
        [ty, name] => Ok(Property { name: (*name).into(), kind: Kind::Scalar(scalar(ty)?) }),
        _ => Err("a property is 'property TYPE NAME' or 'property list TYPE TYPE NAME'".into()),
    }
}

/// The beginning of a text, for a message.
pub(super) fn short(text: &str) -> String {
    text.trim().chars().take(40).collect()
}
