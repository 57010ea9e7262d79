use std::io::{BufRead, Read};

use crate::Limits;
use crate::obj::ObjError;
use crate::obj::clean::{Clean, Dropped, clean};

/// The text of a file, made safe for the parser line by line: valid UTF-8, continuations joined, no line beyond the
/// limit, no index that names nothing. Line numbers stay those of the file.
pub(crate) struct Safe {
    name: String,
    clean: Clean,
}

impl Safe {
    /// An OBJ file.
    pub(crate) fn obj(
        name: &str,
        bytes: &[u8],
        limits: &Limits,
        warnings: &mut Vec<String>,
    ) -> Result<Self, ObjError> {
        Ok(Self { name: name.into(), clean: clean(name, &joined(name, bytes, limits, warnings)?, warnings)? })
    }

    /// Material names that faces use, and the line of the first use.
    pub(crate) fn used_materials(&self) -> impl Iterator<Item = (&str, usize)> {
        self.clean.used_materials.iter().map(|(name, &line)| (name.as_str(), line))
    }

    /// Reads the text and counts lines.
    pub(crate) fn reader(&self) -> Lines<'_> {
        Lines { rest: self.clean.text.as_bytes(), line: 0 }
    }

    /// The parser's complaint, with the place it had reached.
    pub(crate) fn error(&self, line: usize, e: tobj::LoadError) -> ObjError {
        use tobj::LoadError as E;
        let what = match e {
            E::PositionParseError => "a vertex ('v') needs three numbers with a decimal point, not a comma",
            E::ScalingByZeroError => "the vertex's fourth number is 0 and would divide the others",
            E::ColorParseError => "a vertex with a colour needs exactly six numbers",
            E::NormalParseError => "a normal ('vn') needs three numbers",
            E::TexcoordParseError => "a texture coordinate ('vt') needs two numbers",
            E::FaceParseError => {
                "a face ('f') needs vertices of the form v, v/vt, v//vn or v/vt/vn, counted from 1"
            }
            E::FaceVertexOutOfBounds => "a face names a vertex that the file does not have",
            E::FaceTexCoordOutOfBounds => "a face names a texture coordinate that the file does not have",
            E::FaceNormalOutOfBounds => "a face names a normal that the file does not have",
            E::FaceColorOutOfBounds => "a face names a vertex colour that the file does not have",
            E::InvalidPolygon => "a face has too few vertices",
            E::InvalidObjectName => "an object or group has no usable name",
            E::UnrecognizedCharacter => "the line begins with a word the format does not know",
            E::MaterialParseError => "a material cannot be read",
            _ => "the line cannot be read",
        };
        let text = self.clean.text.lines().nth(line.saturating_sub(1)).unwrap_or("");
        ObjError::syntax(&self.name, line, what.into(), text)
    }
}

/// The lines as UTF-8 with continuations joined.
fn joined(name: &str, bytes: &[u8], limits: &Limits, warnings: &mut Vec<String>) -> Result<String, ObjError> {
    // A byte order mark would hide the first line's word, and with it the first vertex.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut text = String::with_capacity(bytes.len());
    // Lines joined to the one before leave empty ones behind it, so that numbers do not shift.
    let (mut owed, mut joining) = (0usize, false);
    let mut unreadable = Dropped::default();
    for (number, raw) in (1..).zip(bytes.split(|&b| b == b'\n')) {
        if raw.len() > limits.line_bytes {
            return Err(ObjError::LineTooLong { file: name.into(), line: number, limit: limits.line_bytes });
        }
        let raw = raw.strip_suffix(b"\r").unwrap_or(raw);
        let line = String::from_utf8_lossy(raw);
        if matches!(line, std::borrow::Cow::Owned(_)) {
            unreadable.add(number, line.trim());
        }
        if number > 1 && !joining {
            text.push('\n');
            text.extend(std::iter::repeat_n('\n', owed));
            owed = 0;
        } else if joining {
            owed = owed.saturating_add(1);
        }
        // A comment that ends in a folder's name is not meant to swallow the next line.
        let is_comment = !joining && line.trim_start().starts_with('#');
        match line.strip_suffix('\\').filter(|_| !is_comment) {
            Some(head) => {
                text.push_str(head);
                text.push(' ');
                joining = true;
            }
            None => {
                text.push_str(&line);
                joining = false;
            }
        }
    }
    unreadable.tell(name, "not UTF-8; unreadable characters were replaced", warnings);
    Ok(text)
}

/// A reader that knows how many lines were taken from it.
pub(crate) struct Lines<'a> {
    rest: &'a [u8],
    line: usize,
}

impl Lines<'_> {
    /// Lines taken so far: the number of the line that the parser is at.
    pub(crate) fn line(&self) -> usize {
        self.line
    }
}

impl Read for Lines<'_> {
    fn read(&mut self, buf: &mut [u8]) -> std::io::Result<usize> {
        let mut rest = self.rest;
        let n = rest.read(buf)?;
        self.consume(n);
        Ok(n)
    }
}

impl BufRead for Lines<'_> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        // One line at a time, so that `consume` sees line ends where the parser does.
        Ok(self.rest.split_inclusive(|&b| b == b'\n').next().unwrap_or(&[]))
    }

    fn consume(&mut self, n: usize) {
        let (taken, rest) = self.rest.split_at(n.min(self.rest.len()));
        let ends = taken.iter().filter(|&&b| b == b'\n').count();
        // The last line may lack its end.
        let last = usize::from(ends == 0 && rest.is_empty() && !taken.is_empty());
        self.line = self.line.saturating_add(ends).saturating_add(last);
        self.rest = rest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn continuations_keep_line_numbers() {
        let s = Safe::obj("a", b"v 1 \\\n2 \\\r\n3\nf 1 1 1", &Limits::default(), &mut Vec::new()).unwrap();
        assert_eq!(s.clean.text, "v 1  2  3\n\n\nf 1 1 1\n");
        let mut r = s.reader();
        let mut line = String::new();
        while r.read_line(&mut line).unwrap() > 0 && !line.contains('f') {
            line.clear();
        }
        assert_eq!(r.line(), 4);
    }

    #[test]
    fn long_lines_are_refused_before_they_are_copied() {
        let limits = Limits { line_bytes: 8, ..Limits::default() };
        let e = Safe::obj("a", b"v 1 2 3\nv 1111111111", &limits, &mut Vec::new()).err();
        assert!(matches!(e, Some(ObjError::LineTooLong { line: 2, .. })), "{e:?}");
    }
}
