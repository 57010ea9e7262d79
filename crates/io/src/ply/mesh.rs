//! Elements to a mesh.

use std::sync::Arc;

use etendue_core::Spectrum;
use etendue_geometry::{Geometry, TriangleMesh};
use etendue_material::{Cutout, Diffuse};
use etendue_scene::SceneBuilder;

use super::error::PlyError;
use super::header::{self, Element, Kind};
use super::source::Source;
use super::vertices::{SLOTS, Vertices};
use crate::{Limits, LoadReport, Loaded};

/// What polygons are called.
const INDICES: [&str; 2] = ["vertex_indices", "vertex_index"];

struct Reader<'a> {
    file: &'a str,
    source: Source<'a>,
    limits: &'a Limits,
    /// Vertices that the header promises.
    promised: u64,
    vertices: Option<Vertices>,
    triangles: Vec<[u32; 3]>,
    report: LoadReport,
}

pub(super) fn read(
    file: &str,
    bytes: &[u8],
    limits: &Limits,
    builder: &mut SceneBuilder,
) -> Result<Loaded, PlyError> {
    let header = header::read(file, bytes, limits)?;
    let promised = header.elements.iter().find(|e| e.name == "vertex").map_or(0, |e| e.count);
    let source = Source::new(bytes, header.end, header.lines, header.format);
    let mut reader = Reader {
        file,
        source,
        limits,
        promised,
        vertices: None,
        triangles: Vec::new(),
        report: LoadReport::default(),
    };
    for element in &header.elements {
        reader.element(element)?;
    }
    reader.finish(header.format, builder)
}

impl Reader<'_> {
    fn fail(&self, element: &Element, index: u64, what: String) -> PlyError {
        PlyError::Data {
            file: self.file.into(),
            place: self.source.place(),
            element: element.name.clone(),
            index,
            what,
        }
    }

    fn too_many(&self, what: &'static str, count: u64, limit: u64) -> PlyError {
        PlyError::TooMany { file: self.file.into(), what, count, limit }
    }

    fn element(&mut self, element: &Element) -> Result<(), PlyError> {
        // Elements without properties take no bytes, so that any number of them may be there.
        if element.properties.is_empty() && element.name != "vertex" {
            return Ok(());
        }
        let room = self.source.room(element.least_bytes(), element.properties.len() as u64);
        if element.count > room {
            let what = format!(
                "the header promises {}, but there are bytes for {room} at most; the file is cut off",
                element.count
            );
            return Err(self.fail(element, room, what));
        }
        match element.name.as_str() {
            "vertex" => self.read_vertices(element),
            "face" => self.read_lists(element, false),
            "tristrips" => self.read_lists(element, true),
            _ => {
                self.report.skipped.push(format!("element '{}'", element.name));
                for i in 0..element.count {
                    for property in &element.properties {
                        self.skip(property.kind).map_err(|what| self.fail(element, i, what))?;
                    }
                }
                Ok(())
            }
        }
    }

    fn skip(&mut self, kind: Kind) -> Result<(), String> {
        match kind {
            Kind::Scalar(ty) => self.source.skip(ty, 1),
            Kind::List(count, item) => {
                let n = self.source.length(count, item)?;
                self.source.skip(item, n)
            }
        }
    }

    fn read_vertices(&mut self, element: &Element) -> Result<(), PlyError> {
        if element.count > self.limits.vertices {
            return Err(self.too_many("vertices", element.count, self.limits.vertices));
        }
        let mut vertices = Vertices::new(element, &mut self.report.skipped).map_err(|missing| {
            self.fail(element, 0, format!("vertices have no '{missing}'; they must have x, y and z"))
        })?;
        let count = usize::try_from(element.count).unwrap_or(usize::MAX);
        if !vertices.reserve(count) {
            return Err(self.fail(element, 0, format!("there is no memory for {count} vertices")));
        }
        let slots = std::mem::take(&mut vertices.slots);
        for i in 0..element.count {
            let mut values = [0.0; SLOTS];
            for (property, slot) in element.properties.iter().zip(&slots) {
                let read = match (property.kind, slot.and_then(|s| values.get_mut(s))) {
                    (Kind::Scalar(ty), Some(value)) => self.source.scalar(ty).map(|x| *value = x),
                    (kind, _) => self.skip(kind),
                };
                read.map_err(|what| self.fail(element, i, what))?;
            }
            vertices.push(&values);
        }
        self.vertices = Some(vertices);
        Ok(())
    }

    fn read_lists(&mut self, element: &Element, strips: bool) -> Result<(), PlyError> {
        let is_list = |k: Kind| matches!(k, Kind::List(..));
        let used =
            element.properties.iter().position(|p| INDICES.contains(&p.name.as_str()) && is_list(p.kind));
        if used.is_none() && element.count > 0 {
            let what = "it has no list 'vertex_indices' or 'vertex_index', so it has no corners".into();
            return Err(self.fail(element, 0, what));
        }
        for (k, property) in element.properties.iter().enumerate() {
            if Some(k) != used {
                self.report.skipped.push(format!("{} property '{}'", element.name, property.name));
            }
        }
        let mut corners = Vec::new();
        let mut short = 0u64;
        for i in 0..element.count {
            for (k, property) in element.properties.iter().enumerate() {
                let read = if Some(k) == used {
                    self.corners(property.kind, strips, &mut corners)
                } else {
                    self.skip(property.kind)
                };
                read.map_err(|what| self.fail(element, i, what))?;
            }
            if corners.len() < 3 {
                short = short.saturating_add(1);
            }
            // A polygon of n corners has n - 2 triangles, a strip at most as many.
            if self.triangles.try_reserve(corners.len()).is_err() {
                return Err(self.fail(element, i, "there is no memory for its triangles".into()));
            }
            if strips {
                strip(&corners, &mut self.triangles);
            } else {
                fan(&corners, &mut self.triangles);
            }
            let limit = self.limits.vertices / 3;
            if self.triangles.len() as u64 > limit {
                return Err(self.too_many("triangles", self.triangles.len() as u64, limit));
            }
        }
        if short > 0 {
            let what = format!(
                "{}: {short} of {} elements '{}' have fewer than three corners; left out",
                self.file, element.count, element.name
            );
            self.report.warnings.push(what);
        }
        Ok(())
    }

    /// The corners of a polygon, or those of strips with `u32::MAX` between them.
    fn corners(&mut self, kind: Kind, strips: bool, out: &mut Vec<u32>) -> Result<(), String> {
        out.clear();
        let Kind::List(count, item) = kind else { return Ok(()) };
        let n = self.source.length(count, item)?;
        let room = usize::try_from(n).unwrap_or(usize::MAX);
        out.try_reserve(room).map_err(|_| format!("there is no memory for its {n} corners"))?;
        for _ in 0..n {
            let x = self.source.scalar(item)?;
            if strips && x == -1.0 {
                out.push(u32::MAX);
            } else if x.fract() == 0.0 && (0.0..self.promised as f64).contains(&x) && x < f64::from(u32::MAX)
            {
                out.push(x as u32);
            } else {
                return Err(format!("it names vertex {x}, but there are {}, counted from 0", self.promised));
            }
        }
        Ok(())
    }

    fn finish(mut self, format: header::Format, builder: &mut SceneBuilder) -> Result<Loaded, PlyError> {
        let file = self.file;
        if self.triangles.is_empty() {
            return Err(PlyError::NoFaces { file: file.into(), vertices: self.promised });
        }
        let left = self.source.left();
        if left > 0 && format != header::Format::Text {
            self.report.warnings.push(format!("{file}: {left} bytes after the last element; not read"));
        }
        // Corners name vertices that were promised, and those were read.
        let Some(vertices) = self.vertices else {
            return Err(PlyError::NoFaces { file: file.into(), vertices: 0 });
        };
        if vertices.not_finite > 0 {
            let what = format!(
                "{file}: {} vertices are not finite; their triangles are not seen",
                vertices.not_finite
            );
            self.report.warnings.push(what);
        }
        let fail = |source| PlyError::Mesh { file: file.into(), source };
        let mut mesh = TriangleMesh::new(vertices.positions, self.triangles).map_err(fail)?;
        if !vertices.normals.is_empty() {
            mesh = mesh.with_normals(vertices.normals).map_err(fail)?;
        }
        if !vertices.uv.is_empty() {
            mesh = mesh.with_uv(0, vertices.uv).map_err(fail)?;
        }
        let colored = !vertices.colors_and_alpha.is_empty();
        if colored {
            mesh = mesh.with_colors(vertices.colors_and_alpha).map_err(fail)?;
        }
        let material = if !colored {
            builder.material(Diffuse::new(Spectrum::gray(0.6)))
        } else {
            let base = Diffuse { vertex_color: true, ..Diffuse::new(Spectrum::ONE) };
            if vertices.transparent {
                builder.material(Cutout { vertex_alpha: true, ..Cutout::new(base, 1.0) })
            } else {
                builder.material(base)
            }
        };
        self.report.meshes = 1;
        self.report.instances = 1;
        self.report.materials = 1;
        self.report.triangles = mesh.triangle_count() as u64;
        builder.add(Geometry::Mesh(Arc::new(mesh)), material);
        Ok(Loaded { cameras: Vec::new(), report: self.report })
    }
}

fn fan(corners: &[u32], out: &mut Vec<[u32; 3]>) {
    if let Some((first, rest)) = corners.split_first() {
        out.extend(rest.iter().zip(rest.iter().skip(1)).map(|(a, b)| [*first, *a, *b]));
    }
}

/// Every other triangle of a strip runs the other way round; those with two equal corners only join parts.
fn strip(corners: &[u32], out: &mut Vec<[u32; 3]>) {
    for strip in corners.split(|c| *c == u32::MAX) {
        let triangles = strip.windows(3).zip([false, true].into_iter().cycle());
        out.extend(triangles.filter_map(|(t, turned)| match *t {
            [a, b, c] if a == b || b == c || a == c => None,
            [a, b, c] if turned => Some([b, a, c]),
            [a, b, c] => Some([a, b, c]),
            _ => None,
        }));
    }
}
