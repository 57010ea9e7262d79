//! Textures: images decoded on first use, once for each way of reading them.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use etendue_core::{Spectrum, Vec2};
use etendue_texture::{Encoding, Filter, ImageTexture, ImageUse, UvTransform, Wrap};
use gltf::json::texture::{self, MagFilter, MinFilter, WrappingMode};
use gltf::json::validation::Checked;
use serde_json::{Map, Value};

use super::GltfError;
use super::document::Document;
use super::extensions::{self, TextureTransform};
use super::uri;
use crate::picture::{ImageBudget, decode_texture};

/// One use of a texture by a material: which, by which coordinates.
pub(super) struct TextureRef<'a> {
    pub(super) texture: usize,
    pub(super) tex_coord: u32,
    pub(super) others: Option<&'a Map<String, Value>>,
}

impl<'a> From<&'a texture::Info> for TextureRef<'a> {
    fn from(info: &'a texture::Info) -> Self {
        Self {
            texture: info.index.value(),
            tex_coord: info.tex_coord,
            others: info.extensions.as_ref().map(|e| &e.others),
        }
    }
}

impl TextureRef<'_> {
    fn transform(&self) -> Option<TextureTransform> {
        extensions::get(self.others, "KHR_texture_transform")
    }

    /// The set of texture coordinates, by its number in the file.
    pub(super) fn set(&self) -> u32 {
        self.transform().and_then(|t| t.tex_coord).unwrap_or(self.tex_coord)
    }
}

/// How an image is read: image, encoding, borders, filter.
type Key = (usize, Encoding, [Wrap; 2], Filter);

/// The images of one document.
pub(super) struct Images<'a> {
    doc: &'a Document<'a>,
    made: HashMap<Key, Option<Arc<ImageTexture>>>,
    budget: ImageBudget,
}

impl<'a> Images<'a> {
    pub(super) fn new(doc: &'a Document<'a>) -> Self {
        Self { doc, made: HashMap::new(), budget: ImageBudget::new(&doc.options.limits) }
    }

    pub(super) fn count(&self) -> u64 {
        self.made.values().flatten().count() as u64
    }

    /// A texture as a material uses it, its coordinates in `slot`; `None` with a warning where there is none.
    pub(super) fn get(
        &mut self,
        r: &TextureRef<'_>,
        slot: u8,
        encoding: Encoding,
        warnings: &mut Vec<String>,
    ) -> Result<Option<ImageUse>, GltfError> {
        let root = &self.doc.root;
        let Some(t) = root.textures.get(r.texture) else {
            return Err(self
                .doc
                .unusable(format!("/textures/{}", r.texture), "there is no such texture".into()));
        };
        let source = t.source.value();
        if source >= root.images.len() {
            warnings.push(format!(
                "{}, at '/textures/{}': it has no PNG or JPEG image; left out",
                self.doc.name, r.texture
            ));
            return Ok(None);
        }
        let (wrap, filter) = self.sampler(t);
        let key = (source, encoding, wrap, filter);
        let image = match self.made.get(&key) {
            Some(known) => known.clone(),
            None => {
                self.doc.go_on()?;
                let made = match self.decode(source, encoding) {
                    Ok(image) => Some(Arc::new(image.with_wrap(wrap[0], wrap[1]).with_filter(filter))),
                    Err(e) if self.doc.options.lenient => {
                        warnings.push(format!("{e}; left out"));
                        None
                    }
                    Err(e) => return Err(e),
                };
                self.made.insert(key, made.clone());
                made
            }
        };
        let transform = r
            .transform()
            .map(|t| UvTransform::new(Vec2::from_array(t.offset), t.rotation, Vec2::from_array(t.scale)));
        Ok(image.map(|image| ImageUse {
            image,
            uv_set: slot,
            transform: transform.filter(|t| *t != UvTransform::IDENTITY),
            scale: Spectrum::ONE,
        }))
    }

    fn bytes(doc: &'a Document<'a>, index: usize) -> Result<Cow<'a, [u8]>, GltfError> {
        let pointer = format!("/images/{index}");
        let missing = || doc.unusable(pointer.clone(), "it names neither a file nor a buffer view".into());
        let image = doc.root.images.get(index).ok_or_else(missing)?;
        if let Some(view) = image.buffer_view {
            return doc.view(view.value()).map(Into::into).ok_or_else(missing);
        }
        let name = image.uri.as_deref().ok_or_else(missing)?;
        uri::read(name, doc.resolver, doc.limits().file_bytes)
            .map(Into::into)
            .map_err(|source| GltfError::Resource { file: doc.name.into(), pointer: pointer.clone(), source })
    }

    fn decode(&mut self, index: usize, encoding: Encoding) -> Result<ImageTexture, GltfError> {
        let bytes = Self::bytes(self.doc, index)?;
        decode_texture(&bytes, encoding, &mut self.budget)
            .map_err(|e| self.doc.unusable(format!("/images/{index}"), e.to_string()))
    }

    fn sampler(&self, t: &texture::Texture) -> ([Wrap; 2], Filter) {
        let sampler = t.sampler.and_then(|s| self.doc.root.samplers.get(s.value()));
        let Some(s) = sampler else { return ([Wrap::Repeat; 2], Filter::Bilinear) };
        let wrap = |w: Checked<WrappingMode>| match w {
            Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
            Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
            _ => Wrap::Repeat,
        };
        let nearest = match (s.mag_filter, s.min_filter) {
            (Some(Checked::Valid(mag)), _) => mag == MagFilter::Nearest,
            // Only what is smaller than its texels was said: the same for what is larger.
            (_, Some(Checked::Valid(min))) => min == MinFilter::Nearest,
            _ => false,
        };
        ([wrap(s.wrap_s), wrap(s.wrap_t)], if nearest { Filter::Nearest } else { Filter::Bilinear })
    }
}
