//! Meshes and their primitives.

use std::collections::HashSet;

use serde_json::Value;

use super::attributes::{self, Semantic};
use super::materials::Material;
use super::model::{Accessor, AccessorUse, Component, Model, SCALAR, ViewUse};
use super::report::{At, Report};
use super::storage::{use_accessor, use_view};
use super::values::{index_of, list, members, whole_of};

/// What other checks need to know of a mesh.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MeshFacts {
    /// Morph targets of its first primitive.
    pub targets: usize,
    /// Whether it has joints.
    pub joints: bool,
}

/// Checks all meshes.
pub(super) fn check(model: &mut Model<'_>, materials: &[Material], report: &mut Report) -> Vec<MeshFacts> {
    let array = At::Root.key("meshes");
    let meshes = model.list("meshes");
    let mut facts = Vec::with_capacity(meshes.len());
    let quantized = model.uses("KHR_mesh_quantization");
    for (i, mesh) in meshes.iter().enumerate() {
        let here = array.index(i);
        let primitives = list(mesh, "primitives");
        let targets = primitives.first().map_or(0, targets_of);
        let mut joints = false;
        let within = here.key("primitives");
        for (k, primitive) in primitives.iter().enumerate() {
            let here = within.index(k);
            let own = targets_of(primitive);
            if own != targets {
                let place = here.key("targets");
                let place = if own > 0 { &place } else { &here };
                report.error("MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT", place, || {
                    format!("{own} morph targets where the mesh's first primitive has {targets}")
                });
            }
            joints |= members(primitive, "attributes").any(|(name, _)| name.starts_with("JOINTS_"));
            let mut check = Primitive { model, quantized, count: None, report };
            check.run(primitive, materials, &here);
        }
        if let Some(weights) = mesh.get("weights").and_then(Value::as_array).filter(|w| w.len() != targets) {
            report.error("MESH_INVALID_WEIGHTS_COUNT", &here.key("weights"), || {
                format!("{} weights for {targets} morph targets; there must be one for each", weights.len())
            });
        }
        facts.push(MeshFacts { targets, joints });
    }
    facts
}

/// Morph targets that hold something.
fn targets_of(primitive: &Value) -> usize {
    list(primitive, "targets").iter().filter(|t| t.as_object().is_some_and(|t| !t.is_empty())).count()
}

struct Primitive<'m, 'v, 'r> {
    model: &'m mut Model<'v>,
    quantized: bool,
    /// Vertices, once known.
    count: Option<u64>,
    report: &'r mut Report,
}

impl Primitive<'_, '_, '_> {
    fn run(&mut self, primitive: &Value, materials: &[Material], at: &At<'_>) {
        let here = at.key("attributes");
        let mut found: Vec<(Semantic<'_>, &str, &Value)> = members(primitive, "attributes")
            .map(|(name, accessor)| (Semantic::new(name), name.as_str(), accessor))
            .collect();
        // Positions first: the others are measured by them.
        found.sort_by_key(|(semantic, ..)| semantic.rank());
        for (semantic, name, accessor) in &found {
            self.attribute(semantic, accessor, &here.key(name));
        }
        let texcoords = self.sets(&found, &here);
        let has = |wanted: Semantic<'_>| found.iter().any(|(s, ..)| *s == wanted);
        if !found.is_empty() && !has(Semantic::Position) {
            self.report.warning("MESH_PRIMITIVE_NO_POSITION", &here, || {
                "there is no POSITION, so there is nothing to show".into()
            });
        }
        if has(Semantic::Tangent) && !has(Semantic::Normal) {
            self.report.warning("MESH_PRIMITIVE_TANGENT_WITHOUT_NORMAL", &here.key("TANGENT"), || {
                "tangents without normals are not used".into()
            });
        }
        self.targets(primitive, at);
        let drawn = self.indices(primitive, at).or(self.count);
        let mode = whole_of(primitive, "mode").unwrap_or(4);
        self.mode(mode, drawn, at);
        if let Some(material) = index_of(primitive, "material").and_then(|m| materials.get(m)) {
            let tangents = has(Semantic::Tangent) && has(Semantic::Normal);
            material.check(texcoords, mode, tangents, &at.key("material"), self.report);
        }
    }

    fn attribute(&mut self, semantic: &Semantic<'_>, value: &Value, at: &At<'_>) {
        if matches!(semantic, Semantic::Unknown(_)) {
            self.invalid(at);
        }
        let Some((index, accessor)) = self.accessor(value) else { return };
        self.vertices(index, &accessor, at);
        match accessor.format {
            Some(format) if !attributes::allows(semantic, &format, self.quantized) => {
                self.report.error("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", at, || {
                    format!("{format} is not allowed for this attribute")
                });
            }
            Some(format) if format.component == Component::U32 => {
                self.report.error("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT", at, || {
                    "attributes of vertices cannot be UNSIGNED_INT; use UNSIGNED_SHORT or FLOAT".into()
                });
            }
            Some(_) => {}
            None => self.report.error("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", at, || {
                "the accessor's type is not known, so it cannot be used for an attribute".into()
            }),
        }
        self.bounded(semantic, &accessor, at);
        match self.count {
            Some(count) if count != accessor.count => {
                self.report.error("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", at, || {
                    format!("{} elements for {count} vertices; there must be one for each", accessor.count)
                });
            }
            _ => self.count = Some(accessor.count),
        }
    }

    fn invalid(&mut self, at: &At<'_>) {
        self.report.error("MESH_PRIMITIVE_INVALID_ATTRIBUTE", at, || {
            "no such attribute; the names of attributes of one's own begin with '_'".into()
        });
    }

    fn accessor(&self, value: &Value) -> Option<(usize, Accessor)> {
        let index = super::values::index(value)?;
        Some((index, *self.model.accessors.get(index)?))
    }

    fn bounded(&mut self, semantic: &Semantic<'_>, accessor: &Accessor, at: &At<'_>) {
        if *semantic == Semantic::Position && !accessor.bounded {
            self.report.error("MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS", at, || {
                "the accessor of positions must have 'min' and 'max'; add them".into()
            });
        }
    }

    /// What holds for all data of vertices.
    fn vertices(&mut self, index: usize, accessor: &Accessor, at: &At<'_>) {
        use_accessor(self.model, index, AccessorUse::Attribute, at, self.report);
        use_view(self.model, accessor.view, ViewUse::Vertices, at, self.report);
        let Some(view) = accessor.view.and_then(|v| self.model.views.get_mut(v)) else { return };
        let first = *view.first.get_or_insert(index);
        let stride = view.stride;
        if first != index && stride.is_none() {
            self.report.error("MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE", at, || {
                format!("its buffer view also holds accessor {first}; such a view must have a 'byteStride'")
            });
        }
        let size = accessor.format.map_or(4, |f| f.size());
        if !accessor.offset.is_multiple_of(4) || stride.is_none() && !size.is_multiple_of(4) {
            self.report.error("MESH_PRIMITIVE_ACCESSOR_UNALIGNED", at, || {
                format!(
                    "at offset {} with a stride of {}; both must be multiples of 4",
                    accessor.offset,
                    stride.unwrap_or(size)
                )
            });
        }
    }

    /// Numbered attributes count from 0 without gaps. The number of texture coordinates.
    fn sets(&mut self, found: &[(Semantic<'_>, &str, &Value)], at: &At<'_>) -> u64 {
        let mut counts = [0u64; 4];
        for (name, count) in attributes::NUMBERED.iter().zip(&mut counts) {
            let of = |(s, ..): &(Semantic<'_>, &str, &Value)| match s {
                Semantic::Numbered(n, k) if n == name => Some(*k),
                _ => None,
            };
            *count = found.iter().filter_map(of).count() as u64;
            let highest = found.iter().filter_map(of).max().map_or(0, |k| k.saturating_add(1));
            if highest != *count {
                self.report.error("MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY", at, || {
                    format!(
                        "{count} attributes {name}_n, but numbers up to {}; they count from 0",
                        highest.saturating_sub(1)
                    )
                });
            }
        }
        let [texcoords, _, joints, weights] = counts;
        if joints != weights {
            self.report.error("MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH", at, || {
                format!("{joints} attributes JOINTS_n but {weights} WEIGHTS_n; they go together")
            });
        }
        texcoords
    }

    fn targets(&mut self, primitive: &Value, at: &At<'_>) {
        let base: HashSet<&str> = members(primitive, "attributes").map(|(name, _)| name.as_str()).collect();
        let within = at.key("targets");
        for (i, target) in list(primitive, "targets").iter().enumerate() {
            let here = within.index(i);
            for (name, value) in target.as_object().into_iter().flatten() {
                let here = here.key(name);
                let semantic = Semantic::new(name);
                if !semantic.morphs() {
                    self.invalid(&here);
                }
                if !base.contains(name.as_str()) {
                    self.report.error("MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR", &here, || {
                        "the primitive itself has no such attribute".into()
                    });
                }
                let Some((index, accessor)) = self.accessor(value) else { continue };
                self.vertices(index, &accessor, &here);
                self.bounded(&semantic, &accessor, &here);
                if accessor.format.is_none_or(|f| !attributes::allows_morph(&semantic, &f, self.quantized)) {
                    self.report.error("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", &here, || {
                        "this type of accessor is not allowed for this attribute of a morph target".into()
                    });
                }
                if base.contains(name.as_str()) && self.count.is_some_and(|c| c != accessor.count) {
                    self.report.error("MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT", &here, || {
                        format!("{} elements for {} vertices", accessor.count, self.count.unwrap_or(0))
                    });
                }
            }
        }
    }

    /// The number of indices, if there are any.
    fn indices(&mut self, primitive: &Value, at: &At<'_>) -> Option<u64> {
        let (index, accessor) = self.accessor(primitive.get("indices")?)?;
        let here = at.key("indices");
        use_accessor(self.model, index, AccessorUse::Indices, &here, self.report);
        use_view(self.model, accessor.view, ViewUse::Indices, &here, self.report);
        if self.model.view_of(&accessor).is_some_and(|v| v.stride.is_some()) {
            self.report.error("MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE", &here, || {
                "the view of indices has a byteStride; leave it out".into()
            });
        }
        let valid = accessor.format.is_some_and(|f| {
            let unsigned = matches!(f.component, Component::U8 | Component::U16 | Component::U32);
            f.shape == SCALAR && unsigned && !f.normalized
        });
        if !valid {
            self.report.error("MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT", &here, || {
                let format = accessor.format.map_or("an unknown type".into(), |f| f.to_string());
                format!(
                    "{format} where indices must be SCALAR of UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT"
                )
            });
        }
        Some(accessor.count)
    }

    fn mode(&mut self, mode: u64, drawn: Option<u64>, at: &At<'_>) {
        let Some(n) = drawn else { return };
        let fits = match mode {
            1 => n % 2 == 0 && n >= 2,
            2 | 3 => n >= 2,
            4 => n % 3 == 0 && n >= 3,
            5 | 6 => n >= 3,
            _ => true,
        };
        if !fits {
            self.report.warning("MESH_PRIMITIVE_INCOMPATIBLE_MODE", at, || {
                format!("{n} vertices do not make up whole parts of mode {mode}; the rest is left out")
            });
        }
    }
}
