//! Materials: the simplest of ours that means what the file says.

use std::collections::HashMap;
use std::sync::Arc;

use etendue_bsdf::{Masking, Meaning};
use etendue_core::{Spectrum, math};
use etendue_material::{Absorber, Cutout, Diffuse, Glass, Material, Metal, NormalMapped, Principled};
use etendue_scene::{Emission, MaterialId, SceneBuilder};
use etendue_texture::{Channel, Encoding, ImageUse, ScalarTex, Tex};
use gltf::json::material::{self, AlphaMode};
use gltf::json::texture;
use gltf::json::validation::Checked;
use serde_json::{Map, Value};

use super::GltfError;
use super::document::Document;
use super::extensions::{self, EmissiveStrength, Ior, Specular, Transmission, Volume};
use super::images::{Images, TextureRef};
use super::mesh::{Colors, Wanted};

/// A material in the scene, and what belongs to the geometry that has it.
#[derive(Clone)]
pub(super) struct Made {
    pub(super) id: MaterialId,
    pub(super) emission: Option<Emission>,
}

/// The materials of one document, made on first use.
pub(super) struct Materials<'a> {
    doc: &'a Document<'a>,
    pub(super) images: Images<'a>,
    /// By index in the file, and the colours at the vertices.
    made: HashMap<(Option<usize>, Colors), Made>,
    wanted: HashMap<Option<usize>, Wanted>,
    default: material::Material,
}

impl<'a> Materials<'a> {
    pub(super) fn new(doc: &'a Document<'a>) -> Self {
        let (made, wanted, default) = Default::default();
        Self { doc, images: Images::new(doc), made, wanted, default }
    }

    pub(super) fn count(&self) -> u64 {
        self.made.len() as u64
    }

    fn of(&self, index: Option<usize>) -> &material::Material {
        index.and_then(|i| self.doc.root.materials.get(i)).unwrap_or(&self.default)
    }

    /// What a material reads of the meshes that have it.
    pub(super) fn wanted(&mut self, index: Option<usize>, warnings: &mut Vec<String>) -> Wanted {
        if let Some(known) = self.wanted.get(&index) {
            return known.clone();
        }
        let m = self.of(index);
        let mut sets = Vec::new();
        each_texture(m, |r| {
            if !sets.contains(&r.set()) {
                sets.push(r.set());
            }
        });
        if sets.len() > 2 {
            warnings.push(format!(
                "{}, at '/materials/{}': it reads {} sets of texture coordinates, two are kept; the others' textures \
                 lie by the first",
                self.doc.name,
                index.unwrap_or(0),
                sets.len()
            ));
            sets.truncate(2);
        }
        let unlit = others(m).is_some_and(|o| o.contains_key("KHR_materials_unlit"));
        let tangents_of = m.normal_texture.as_ref().filter(|_| !unlit).map(|n| normal_ref(n).set());
        let wanted = Wanted { sets, tangents_of };
        self.wanted.insert(index, wanted.clone());
        wanted
    }

    /// The material, made if it was not yet.
    pub(super) fn get(
        &mut self,
        index: Option<usize>,
        colors: Colors,
        builder: &mut SceneBuilder,
        warnings: &mut Vec<String>,
    ) -> Result<Made, GltfError> {
        if let Some(made) = self.made.get(&(index, colors)) {
            return Ok(made.clone());
        }
        let wanted = self.wanted(index, &mut Vec::new());
        let m = self.of(index).clone();
        let place = index.map_or(self.doc.name.into(), |i| format!("{}, at '/materials/{i}'", self.doc.name));
        let (material, emission) =
            Maker { images: &mut self.images, doc: self.doc, m: &m, wanted, colors, place, warnings }
                .make()?;
        let made = Made { id: builder.material_arc(material), emission };
        self.made.insert((index, colors), made.clone());
        Ok(made)
    }
}

fn normal_ref(n: &material::NormalTexture) -> TextureRef<'_> {
    TextureRef {
        texture: n.index.value(),
        tex_coord: n.tex_coord,
        others: n.extensions.as_ref().map(|e| &e.others),
    }
}

fn others(m: &material::Material) -> Option<&Map<String, Value>> {
    m.extensions.as_ref().map(|e| &e.others)
}

/// Every texture that a material reads. The normal map comes first: the geometry's own tangents lie along the set in
/// the first slot.
fn each_texture(m: &material::Material, mut see: impl FnMut(&TextureRef<'_>)) {
    if let Some(n) = &m.normal_texture {
        see(&normal_ref(n));
    }
    let p = &m.pbr_metallic_roughness;
    for info in
        [&p.base_color_texture, &p.metallic_roughness_texture, &m.emissive_texture].into_iter().flatten()
    {
        see(&info.into());
    }
    if let Some(s) = extensions::get::<Specular>(others(m), "KHR_materials_specular") {
        for info in [&s.specular_texture, &s.specular_color_texture].into_iter().flatten() {
            see(&info.into());
        }
    }
    if let Some(info) = extensions::get::<Transmission>(others(m), "KHR_materials_transmission")
        .and_then(|t| t.transmission_texture)
    {
        see(&(&info).into());
    }
}

/// One material in the making.
struct Maker<'a, 'd> {
    images: &'a mut Images<'d>,
    doc: &'a Document<'d>,
    m: &'a material::Material,
    wanted: Wanted,
    colors: Colors,
    place: String,
    warnings: &'a mut Vec<String>,
}

impl Maker<'_, '_> {
    fn colored(&self) -> bool {
        self.colors != Colors::None
    }

    fn image(&mut self, r: &TextureRef<'_>, encoding: Encoding) -> Result<Option<ImageUse>, GltfError> {
        let slot = self.wanted.sets.iter().position(|&s| s == r.set()).unwrap_or(0);
        self.images.get(r, u8::try_from(slot).unwrap_or(0), encoding, self.warnings)
    }

    /// A colour factor times a texture.
    fn color(&mut self, factor: [f32; 3], info: Option<&texture::Info>) -> Result<Tex, GltfError> {
        let factor = Spectrum::from(factor);
        let image = match info {
            // Black stays black: the image need not be decoded.
            Some(info) if !factor.is_black() => self.image(&info.into(), Encoding::Srgb)?,
            _ => None,
        };
        Ok(match image {
            Some(image) => Tex::Image(ImageUse { scale: factor, ..image }),
            None => Tex::Constant(factor),
        })
    }

    /// A number times one channel of a texture.
    fn number(
        &mut self,
        factor: f32,
        info: Option<&texture::Info>,
        channel: Channel,
    ) -> Result<ScalarTex, GltfError> {
        // NaN counts as 0.
        let factor = if factor > 0.0 { factor } else { 0.0 };
        let image = match info {
            Some(info) if factor > 0.0 => self.image(&info.into(), Encoding::Linear)?,
            _ => None,
        };
        Ok(match image {
            Some(image) => ScalarTex::image(image, channel).scaled(factor),
            None => factor.into(),
        })
    }

    fn make(mut self) -> Result<(Arc<dyn Material>, Option<Emission>), GltfError> {
        let m = self.m;
        let pbr = &m.pbr_metallic_roughness;
        let [r, g, b, _] = pbr.base_color_factor.0;
        // Under a lenient load it may lie outside of its range.
        let base = [r, g, b].map(|c| if c > 0.0 { c.min(1.0) } else { 0.0 });
        let base = self.color(base, pbr.base_color_texture.as_ref())?;
        if others(m).is_some_and(|o| o.contains_key("KHR_materials_unlit")) {
            if self.colored() {
                self.warn("vertex colours of unlit surfaces are not built; left out");
            }
            let shown = self.with_opacity(Arc::new(Absorber))?;
            return Ok((shown, Some(Emission::new(base).two_sided())));
        }
        let surface = self.surface(base)?;
        let surface = self.with_normal_map(surface)?;
        let surface = self.with_opacity(surface)?;
        Ok((surface, self.emission()?))
    }

    fn warn(&mut self, what: &str) {
        self.warnings.push(format!("{}: {what}", self.place));
    }

    fn surface(&mut self, base: Tex) -> Result<Arc<dyn Material>, GltfError> {
        let (m, pbr) = (self.m, &self.m.pbr_metallic_roughness);
        let rough_metal = pbr.metallic_roughness_texture.as_ref();
        let metallic = self.number(pbr.metallic_factor.0, rough_metal, Channel::B)?;
        let roughness = self.number(pbr.roughness_factor.0, rough_metal, Channel::G)?;
        let ior = extensions::get::<Ior>(others(m), "KHR_materials_ior").map_or(1.5, |i| i.ior);
        let s = extensions::get::<Specular>(others(m), "KHR_materials_specular");
        let (specular, specular_color) = match &s {
            Some(s) => (
                self.number(s.specular_factor, s.specular_texture.as_ref(), Channel::A)?,
                self.color(s.specular_color_factor, s.specular_color_texture.as_ref())?,
            ),
            None => (1.0.into(), Spectrum::ONE.into()),
        };
        let t = extensions::get::<Transmission>(others(m), "KHR_materials_transmission");
        let transmission = match &t {
            Some(t) => self.number(t.transmission_factor, t.transmission_texture.as_ref(), Channel::R)?,
            None => 0.0.into(),
        };
        let volume = extensions::get::<Volume>(others(m), "KHR_materials_volume");
        // Without a thickness a surface is a wall with nothing inside.
        let thin = volume.as_ref().is_none_or(|v| !(v.thickness_factor > 0.0));
        let absorption = volume.as_ref().filter(|_| !thin).map_or(Spectrum::BLACK, absorption);

        let is = |tex: &ScalarTex, v: f32| matches!(tex, ScalarTex::Constant(c) if *c == v);
        let opaque = is(&transmission, 0.0);
        let white = matches!(base, Tex::Constant(c) if c == Spectrum::ONE) && !self.colored();
        if s.is_some() && !opaque {
            self.warn(
                "KHR_materials_specular does not act on the share of light that KHR_materials_transmission lets \
                 through: it reflects by its ior alone",
            );
        }
        if absorption != Spectrum::BLACK && self.m.alpha_mode != Checked::Valid(AlphaMode::Opaque) {
            self.warn("a body with holes in its surface absorbs nothing");
        }
        let meaning = self.doc.options.materials;
        if opaque && is(&metallic, 0.0) && is(&specular, 0.0) {
            return Ok(Arc::new(Diffuse { vertex_color: self.colored(), ..Diffuse::new(base) }));
        }
        if is(&transmission, 1.0) && is(&metallic, 0.0) && is(&roughness, 0.0) && white && !thin && ior >= 1.0
        {
            return Ok(Arc::new(Glass { absorption, ..Glass::new(ior) }));
        }
        if meaning == Meaning::GltfB && is(&metallic, 1.0) && roughness.is_constant() {
            let metal = Metal {
                masking: Masking::Separable,
                vertex_color: self.colored(),
                ..Metal::schlick(base, roughness)
            };
            return Ok(Arc::new(metal));
        }
        Ok(Arc::new(Principled {
            vertex_color: self.colored(),
            ior,
            specular,
            specular_color,
            transmission,
            thin,
            absorption,
            meaning,
            ..Principled::new(base, metallic, roughness)
        }))
    }

    fn with_normal_map(&mut self, base: Arc<dyn Material>) -> Result<Arc<dyn Material>, GltfError> {
        let Some(n) = &self.m.normal_texture else { return Ok(base) };
        let map = self.image(&normal_ref(n), Encoding::Linear)?;
        Ok(match map {
            Some(map) => Arc::new(NormalMapped { base, map, scale: n.scale }),
            None => base,
        })
    }

    fn with_opacity(&mut self, base: Arc<dyn Material>) -> Result<Arc<dyn Material>, GltfError> {
        let (m, pbr) = (self.m, &self.m.pbr_metallic_roughness);
        let threshold = match m.alpha_mode {
            Checked::Valid(AlphaMode::Mask) => Some(m.alpha_cutoff.map_or(0.5, |c| c.0)),
            Checked::Valid(AlphaMode::Blend) => None,
            _ => return Ok(base),
        };
        let [.., factor] = pbr.base_color_factor.0;
        let factor = if factor > 0.0 { factor } else { 0.0 };
        let image = match &pbr.base_color_texture {
            // The same image as the colour's: it is in memory once.
            Some(info) => self.image(&info.into(), Encoding::Srgb)?,
            None => None,
        };
        let opacity = match image {
            Some(image) if matches!(image.image.channels(), 2 | 4) => {
                ScalarTex::image(image, Channel::A).scaled(factor)
            }
            _ => factor.into(),
        };
        let vertex_alpha = self.colors == Colors::WithAlpha;
        let solid = opacity.is_constant() && opacity.min() >= threshold.unwrap_or(1.0);
        if solid && !vertex_alpha {
            return Ok(base);
        }
        Ok(Arc::new(Cutout { base, opacity, threshold, vertex_alpha }))
    }

    fn emission(&mut self) -> Result<Option<Emission>, GltfError> {
        let strength = extensions::get::<EmissiveStrength>(others(self.m), "KHR_materials_emissive_strength")
            .map_or(1.0, |e| e.emissive_strength);
        let factor = self.m.emissive_factor.0.map(|c| if c > 0.0 { (c * strength).max(0.0) } else { 0.0 });
        if factor.iter().all(|c| *c == 0.0) {
            return Ok(None);
        }
        if !factor.iter().all(|c| c.is_finite()) {
            self.warn("its light is beyond what numbers hold; left out");
            return Ok(None);
        }
        let emission = Emission::new(self.color(factor, self.m.emissive_texture.as_ref())?);
        Ok(Some(if self.m.double_sided { emission.two_sided() } else { emission }))
    }
}

/// Absorption in m⁻¹ from the colour that white light has after a distance (Beer 1852).
fn absorption(v: &Volume) -> Spectrum {
    let Some(distance) = v.attenuation_distance.filter(|d| *d > 0.0 && d.is_finite()) else {
        return Spectrum::BLACK;
    };
    // A channel that nothing is left of would be an infinite absorption; 10⁻⁶ of it may as well be nothing.
    Spectrum::from(v.attenuation_color).map(|c| -math::ln(c.clamp(1e-6, 1.0)) / distance)
}
