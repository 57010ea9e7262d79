//! glTF 2.0: scenes as Blender and others export them.
//!
//! The document is checked against the specification first (`check`), then read by the typed layer of the `gltf` crate;
//! buffers, accessors, URIs and images are read by code of our own under one [`Limits`](crate::Limits). What nothing in
//! the scene uses is not decoded: meshes, materials, images, and of a mesh the attributes that its material does not look at.
//!
//! A mesh that stands in one place is worked into world space, so that a scene without instances has no second level.

mod accessor;
mod check;
mod document;
mod error;
mod extensions;
mod images;
mod lights;
mod materials;
mod mesh;
mod nodes;
mod skin;
mod tangents;
mod uri;

use std::collections::HashMap;
use std::path::Path;

use etendue_core::Transform;
use etendue_core::glam::{DMat3, DMat4};
use etendue_scene::{GeomId, SceneBuilder};
use gltf::json::Mesh;

use crate::resolver::read_file;
use crate::{FolderResolver, LoadOptions, LoadReport, Loaded, Resolver};
use accessor::Accessors;
use document::Document;
pub use error::GltfError;
use extensions::{VariantMappings, Variants};
use materials::Materials;
use mesh::Pose;
use nodes::{Placement, Walked};

/// Adds a `.gltf` or `.glb` file to a scene. Buffers and images are looked for beside it and nowhere else.
///
/// # Errors
/// [`GltfError`], naming the file and the place in it.
pub fn load(path: &Path, options: &LoadOptions<'_>, builder: &mut SceneBuilder) -> Result<Loaded, GltfError> {
    let name = path.display().to_string();
    let bytes = read_file(path, &name, options.limits.file_bytes)?;
    read(&name, &bytes, &FolderResolver::beside(path), options, builder)
}

/// Adds a file that is in memory; `name` stands for it in messages.
///
/// # Errors
/// As [`load`].
pub fn read(
    name: &str,
    bytes: &[u8],
    resolver: &dyn Resolver,
    options: &LoadOptions<'_>,
    builder: &mut SceneBuilder,
) -> Result<Loaded, GltfError> {
    let mut report = LoadReport::default();
    let doc = Document::open(name, bytes, resolver, options, &mut report.warnings)?;
    report.warnings.extend(extensions::used(name, &doc.root.extensions_used));
    let accessors = Accessors::new(&doc);
    let walked = nodes::walk(&doc, &accessors)?;
    let mut loader = Loader {
        doc: &doc,
        accessors,
        variant: variant(&doc)?,
        materials: Materials::new(&doc),
        builder,
        report,
        emitters: 0,
    };
    loader.meshes(&walked)?;
    let Loader { materials, mut report, .. } = loader;
    report.materials = materials.count();
    report.images = materials.images.count();
    report.lights = lights::add(&doc, &walked, builder, &mut report.warnings);
    report.has_light |= report.lights > 0;
    let cameras = lights::cameras(&doc, &walked, &mut report.warnings);
    Ok(Loaded { cameras, report })
}

/// The number of the variant asked for.
fn variant(doc: &Document<'_>) -> Result<Option<usize>, GltfError> {
    let Some(asked) = &doc.options.variant else { return Ok(None) };
    let root = doc.root.extensions.as_ref().map(|e| &e.others);
    let all = extensions::get::<Variants>(root, "KHR_materials_variants").map_or(Vec::new(), |v| v.variants);
    if let Some(i) = all.iter().position(|v| v.name == *asked) {
        return Ok(Some(i));
    }
    let names: Vec<&str> = all.iter().map(|v| v.name.as_str()).collect();
    let there_are =
        if names.is_empty() { "it has none".into() } else { format!("it has {}", names.join(", ")) };
    Err(GltfError::Variant { file: doc.name.into(), asked: asked.clone(), there_are })
}

/// A document on its way into a builder.
struct Loader<'a, 'b> {
    doc: &'a Document<'a>,
    accessors: Accessors<'a>,
    variant: Option<usize>,
    materials: Materials<'a>,
    builder: &'b mut SceneBuilder,
    report: LoadReport,
    /// Emitting triangles so far, those of an instance counted again.
    emitters: u64,
}

impl Loader<'_, '_> {
    fn meshes(&mut self, walked: &Walked) -> Result<(), GltfError> {
        // A mesh with a skin or weights of its node's own is not the same mesh in another place.
        let is_plain = |p: &Placement| {
            self.doc.root.nodes.get(p.node).is_none_or(|n| n.skin.is_none() && n.weights.is_none())
        };
        let mut places: HashMap<usize, Vec<&Placement>> = HashMap::new();
        for p in walked.meshes.iter().filter(|p| is_plain(p)) {
            places.entry(p.mesh).or_default().push(p);
        }
        let mut skinned = None;
        for p in &walked.meshes {
            self.doc.go_on()?;
            if !is_plain(p) {
                // A skin takes the mesh into the world whatever its node's placement: copies would coincide.
                if skinned != Some(p.node) {
                    skinned = self.own(p, walked)?.then_some(p.node);
                }
            } else if let Some(all) = places.remove(&p.mesh) {
                match all[..] {
                    [one] => {
                        self.add(one, &Pose::Baked(&one.to_world), None)?;
                    }
                    _ => self.instances(&all)?,
                }
            }
        }
        let unused = self.doc.root.meshes.len().saturating_sub(
            walked.meshes.iter().map(|p| p.mesh).collect::<std::collections::HashSet<_>>().len(),
        );
        if unused > 0 {
            self.report.skipped.push(format!("{unused} meshes that no node of the scene shows"));
        }
        Ok(())
    }

    /// A mesh whose node gives it a skin or weights; whether it was a skin.
    fn own(&mut self, p: &Placement, walked: &Walked) -> Result<bool, GltfError> {
        let skin = self.doc.root.nodes.get(p.node).and_then(|n| n.skin);
        match skin {
            Some(skin) => {
                let joints = skin::joints(self.doc, &self.accessors, skin.value(), &walked.world)?;
                self.add(p, &Pose::Skinned(&joints), None)?;
            }
            None => {
                self.add(p, &Pose::Baked(&p.to_world), None)?;
            }
        }
        Ok(skin.is_some())
    }

    /// One mesh in many places.
    fn instances(&mut self, all: &[&Placement]) -> Result<(), GltfError> {
        let Some(first) = all.first() else { return Ok(()) };
        let geometry = self.add(first, &Pose::Object, Some(all.len() as u64))?;
        if geometry.is_empty() {
            return Ok(());
        }
        let group = self.builder.group(&geometry);
        for p in all {
            match transform(&p.to_world) {
                Ok(to_world) => {
                    self.builder.instance(group, to_world);
                    self.report.instances = self.report.instances.saturating_add(1);
                }
                Err(e) => self.report.warnings.push(format!(
                    "{}, at '/nodes/{}': {e}; this placement is left out",
                    self.doc.name, p.node
                )),
            }
        }
        Ok(())
    }

    /// Adds the primitives of a mesh, standing in the world or to be grouped and placed so many times.
    fn add(&mut self, p: &Placement, pose: &Pose<'_>, copies: Option<u64>) -> Result<Vec<GeomId>, GltfError> {
        let Some(mesh) = self.doc.root.meshes.get(p.mesh) else {
            let message = format!("there is no mesh {}", p.mesh);
            return Err(self.doc.unusable(format!("/nodes/{}/mesh", p.node), message));
        };
        let node = self.doc.root.nodes.get(p.node);
        let weights = node.and_then(|n| n.weights.as_deref()).or(mesh.weights.as_deref()).unwrap_or(&[]);
        let mut out = Vec::new();
        for index in 0..mesh.primitives.len() {
            out.extend(self.primitive(mesh, p, index, weights, pose, copies)?);
        }
        Ok(out)
    }

    fn primitive(
        &mut self,
        mesh: &Mesh,
        placement: &Placement,
        index: usize,
        weights: &[f32],
        pose: &Pose<'_>,
        copies: Option<u64>,
    ) -> Result<Option<GeomId>, GltfError> {
        let Some(p) = mesh.primitives.get(index) else { return Ok(None) };
        let pointer = format!("/meshes/{}/primitives/{index}", placement.mesh);
        if !mesh::is_surface(p) {
            self.report.skipped.push(format!("{pointer}: points and lines are not rendered"));
            return Ok(None);
        }
        let material = self.material_of(p);
        let wanted = self.materials.wanted(material, &mut self.report.warnings);
        let warnings = &mut self.report.warnings;
        // What does not hang on joints stands where its node does.
        let stands = Pose::Baked(&placement.to_world);
        let skinned = matches!(pose, Pose::Skinned(_));
        if skinned && mesh::has_more_joints(p) {
            warnings.push(format!(
                "{}, at '{pointer}': only the first four joints of a vertex count",
                self.doc.name
            ));
        }
        let pose = if skinned && !mesh::is_skinned(p) { &stands } else { pose };
        let built = mesh::build(self.doc, &self.accessors, &pointer, p, weights, &wanted, pose, warnings)?;
        let Some(made) = built else {
            self.report.skipped.push(format!("{pointer}: it has no triangle"));
            return Ok(None);
        };
        let colors = mesh::colors(self.doc, p);
        let material = self.materials.get(material, colors, self.builder, warnings)?;
        let triangles = made.triangle_count() as u64;
        self.report.meshes = self.report.meshes.saturating_add(1);
        self.report.triangles = self.report.triangles.saturating_add(triangles);
        if material.emission.is_some() {
            self.emitters = self.emitters.saturating_add(triangles.saturating_mul(copies.unwrap_or(1)));
            if self.emitters > self.doc.limits().emitters {
                return Err(GltfError::Limit {
                    file: self.doc.name.into(),
                    pointer,
                    what: "emitting triangles, those of instances counted again",
                    asked: self.emitters,
                    limit: self.doc.limits().emitters,
                });
            }
        }
        let geom = match copies {
            None => self.builder.add(made, material.id),
            Some(_) => self.builder.add_grouped(made, material.id),
        };
        if let Some(emission) = material.emission {
            self.builder.emit(geom, emission);
            self.report.has_light = true;
        }
        Ok(Some(geom))
    }

    /// A primitive's material, or that of the variant asked for.
    fn material_of(&self, p: &gltf::json::mesh::Primitive) -> Option<usize> {
        let own = p.material.map(|m| m.value());
        let Some(variant) = self.variant else { return own };
        let others = p.extensions.as_ref().map(|e| &e.others);
        extensions::get::<VariantMappings>(others, "KHR_materials_variants")
            .and_then(|m| m.mappings.into_iter().find(|m| m.variants.contains(&variant)))
            .map_or(own, |m| Some(m.material))
    }
}

fn transform(m: &DMat4) -> Result<Transform, etendue_core::TransformError> {
    Transform::from_f64(DMat3::from_mat4(*m), m.w_axis.truncate())
}
