//! What the parser gets wrong or takes badly is put right, dropped with a warning or refused here, line by line, while
//! the number of the line is still known.

use std::collections::BTreeMap;

use crate::obj::ObjError;

/// The text as the parser gets it; as many lines as before.
pub(crate) struct Clean {
    pub(crate) text: String,
    /// Material names that faces use, and the line of the first use.
    pub(crate) used_materials: BTreeMap<String, usize>,
}

/// How many positions, texture coordinates and normals there are.
type Counts = [u64; 3];

const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// Counts a line's word, if it is one of the three.
fn count(key: &str, counts: &mut Counts) {
    for (kind, n) in ["v", "vt", "vn"].into_iter().zip(counts) {
        if kind == key {
            *n = n.saturating_add(1);
        }
    }
}

/// The part of a line before a comment. Only where no name can hold the character.
fn data(line: &str) -> &str {
    line.split_once('#').map_or(line, |(before, _)| before)
}

fn key_of(line: &str) -> &str {
    line.split_whitespace().next().unwrap_or("")
}

/// Vertices with a colour: `v x y z r g b`.
fn is_coloured(line: &str) -> bool {
    data(line).split_whitespace().count() == 7
}

/// Things of one kind that were dropped: told once, with the first place.
#[derive(Default)]
pub(crate) struct Dropped {
    first: Option<(usize, String)>,
    count: usize,
}

impl Dropped {
    pub(crate) fn add(&mut self, line: usize, word: &str) {
        self.count = self.count.saturating_add(1);
        if self.first.is_none() {
            self.first = Some((line, word.chars().take(20).collect()));
        }
    }

    pub(crate) fn tell(&self, file: &str, what: &str, warnings: &mut Vec<String>) {
        if let Some((line, word)) = &self.first {
            let more = match self.count.saturating_sub(1) {
                0 => String::new(),
                more => format!(" (and {more} more)"),
            };
            warnings.push(format!("{file}, line {line}{more}: {what}: '{word}'"));
        }
    }
}

/// Cleans a whole file.
pub(crate) fn clean(file: &str, text: &str, warnings: &mut Vec<String>) -> Result<Clean, ObjError> {
    let (mut total, mut coloured) = (Counts::default(), 0u64);
    for line in text.lines() {
        let key = key_of(line);
        count(key, &mut total);
        if key == "v" && is_coloured(line) {
            coloured = coloured.saturating_add(1);
        }
    }
    let [vertices, ..] = total;
    // The parser keeps colours in a list of their own: unless every vertex has one, they slip to other vertices.
    let strip_colors = coloured > 0 && coloured < vertices;
    if strip_colors {
        warnings.push(format!(
            "{file}: {coloured} of {vertices} vertices have a colour; the colours are dropped"
        ));
    }
    let mut out = Clean { text: String::with_capacity(text.len()), used_materials: BTreeMap::new() };
    let (mut lines_and_points, mut short, mut unknown) = <(Dropped, Dropped, Dropped)>::default();
    let mut so_far = Counts::default();
    for (number, line) in (1..).zip(text.lines()) {
        let refuse = |what: String| ObjError::syntax(file, number, what, line);
        let key = key_of(line);
        match key {
            "v" | "vt" | "vn" => {
                count(key, &mut so_far);
                if key == "v" && is_coloured(line) {
                    let is_number = |w: &str| w.parse::<f32>().is_ok();
                    if !data(line).split_whitespace().skip(1).all(is_number) {
                        return Err(refuse("a vertex with a colour needs six numbers".into()));
                    }
                    let words = if strip_colors { 4 } else { 7 };
                    let kept: Vec<&str> = data(line).split_whitespace().take(words).collect();
                    out.text.push_str(&kept.join(" "));
                } else {
                    out.text.push_str(data(line));
                }
            }
            "f" => {
                let corners = data(line).split_whitespace().skip(1);
                for corner in corners.clone() {
                    check_corner(corner, &so_far, &total).map_err(refuse)?;
                }
                if corners.count() < 3 {
                    short.add(number, line.trim());
                } else {
                    out.text.push_str(data(line));
                }
            }
            // The parser would make a triangle of a line through three points.
            "l" | "p" => lines_and_points.add(number, key),
            "usemtl" | "mtllib" | "o" | "g" => {
                let rest = line.trim_start().get(key.len()..).unwrap_or("").trim();
                let name = if rest.is_empty() && key == "usemtl" { "unnamed" } else { rest };
                if key == "usemtl" {
                    out.used_materials.entry(name.into()).or_insert(number);
                }
                out.text.push_str(key);
                out.text.push(' ');
                // Some exporters escape the spaces of a file's name.
                out.text.push_str(&if key == "mtllib" { name.replace("\\ ", " ") } else { name.into() });
            }
            "s" | "" => {}
            _ if key.starts_with('#') => {}
            _ => unknown.add(number, key),
        }
        out.text.push('\n');
    }
    lines_and_points.tell(file, "lines and points are not rendered; dropped", warnings);
    short.tell(file, "a face needs three corners; dropped", warnings);
    unknown.tell(file, "not read by this loader; dropped", warnings);
    Ok(out)
}

/// Whether one `v/vt/vn` of a face names things that exist. Positive numbers count from 1 through the whole file,
/// negative ones back from the line itself. The parser does this arithmetic without checks.
fn check_corner(corner: &str, so_far: &Counts, total: &Counts) -> Result<(), String> {
    let form = || format!("'{corner}' is not of the form v, v/vt, v//vn or v/vt/vn in whole numbers");
    for (k, part) in corner.split('/').enumerate() {
        let (Some(&before), Some(&all), Some(kind)) = (so_far.get(k), total.get(k), KINDS.get(k)) else {
            return Err(form());
        };
        if part.is_empty() {
            if k == 0 {
                return Err(form());
            }
            continue;
        }
        let index: i64 = part.parse().map_err(|_| form())?;
        // A file without any is read as if the numbers were not there.
        if k > 0 && all == 0 {
            continue;
        }
        if index == 0 {
            return Err(format!("'{corner}' names {kind} 0; they count from 1"));
        }
        let exists = if index > 0 { index.unsigned_abs() <= all } else { index.unsigned_abs() <= before };
        if !exists {
            let there = if index > 0 { all } else { before };
            let place = if index > 0 { "in the file" } else { "before this line" };
            return Err(format!(
                "'{corner}' names {kind} {index}, but there are {there} {place}; check that the file is whole"
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cleaned(text: &str) -> (Clean, Vec<String>) {
        let mut warnings = Vec::new();
        let clean = clean("a.obj", text, &mut warnings);
        (clean.unwrap(), warnings)
    }

    #[test]
    fn lines_keep_their_numbers_and_comments_go() {
        let (c, w) = cleaned("v 0 0 0 # here\n\nl 1 2 3\nusemtl\ta b\nf 1 1 1#x\ncurv 1\nusemtl");
        assert_eq!(c.text, "v 0 0 0 \n\n\nusemtl a b\nf 1 1 1\n\nusemtl unnamed\n");
        assert_eq!(w.len(), 2, "{w:?}");
        assert!(w[0].starts_with("a.obj, line 3: lines and points") && w[1].contains("line 6"), "{w:?}");
        assert_eq!(c.used_materials.get("a b"), Some(&4));
    }

    #[test]
    fn colours_are_for_all_vertices_or_none() {
        let (c, w) = cleaned("v 0 0 0 1 0 0\nv 1 0 0\n");
        assert_eq!(c.text, "v 0 0 0\nv 1 0 0\n");
        assert!(w[0].contains("1 of 2 vertices"), "{w:?}");
        let (c, w) = cleaned("v 0 0 0 1 0 0\n");
        assert_eq!((c.text.as_str(), w.len()), ("v 0 0 0 1 0 0\n", 0));
    }

    #[test]
    fn corners_must_exist() {
        let (so_far, total) = ([3, 2, 0], [4, 2, 0]);
        for good in ["1", "4", "-3", "1/2", "1/-2", "1//7", "2/1/", "1/1/-9223372036854775808"] {
            assert_eq!(check_corner(good, &so_far, &total), Ok(()), "{good}");
        }
        for bad in ["0", "5", "-4", "1/3", "1/-3", "/1", "", "1/1/1/1", "x", "1.0", "99999999999999999999"] {
            assert!(check_corner(bad, &so_far, &total).is_err(), "{bad}");
        }
    }
}
