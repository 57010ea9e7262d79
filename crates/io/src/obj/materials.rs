use std::collections::HashMap;
use std::sync::Arc;

use etendue_core::Spectrum;
use etendue_geometry::Geometry;
use etendue_material::{Cutout, Diffuse, Glass, Metal, MirrorMaterial};
use etendue_scene::{Emission, GeomId, MaterialId, SceneBuilder};
use etendue_texture::{Channel, Encoding, ImageTexture, ImageUse, ScalarTex, Tex};

use crate::{ImageBudget, Limits, ResolveError, Resolver, decode_texture};

/// Materials and where each name is among them, as the parser hands them over.
type Library = (Vec<tobj::Material>, HashMap<String, usize>);

/// Reads what one `mtllib` line names. Whatever is wrong with it becomes a warning: geometry without its colours is
/// better than none.
pub(crate) fn parse(
    name: &str,
    resolver: &dyn Resolver,
    limits: &Limits,
    warnings: &mut Vec<String>,
) -> Library {
    let complain = |e: ResolveError, warnings: &mut Vec<String>| {
        warnings.push(format!("material file: {e}; its materials are gray"));
    };
    match resolver.read(name, limits.file_bytes) {
        Ok(bytes) => parse_bytes(name, &bytes, limits, warnings),
        // One file whose name has spaces, or several files.
        Err(_) if name.split_whitespace().nth(1).is_some() => {
            let mut all = Library::default();
            for part in name.split_whitespace() {
                match resolver.read(part, limits.file_bytes) {
                    Ok(bytes) => {
                        let (mut materials, places) = parse_bytes(part, &bytes, limits, warnings);
                        let before = all.0.len();
                        all.0.append(&mut materials);
                        all.1.extend(
                            places.into_iter().map(|(name, place)| (name, before.saturating_add(place))),
                        );
                    }
                    Err(e) => complain(e, warnings),
                }
            }
            all
        }
        Err(e) => {
            complain(e, warnings);
            Library::default()
        }
    }
}

fn parse_bytes(name: &str, bytes: &[u8], limits: &Limits, warnings: &mut Vec<String>) -> Library {
    let text = String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes));
    let mut safe = String::with_capacity(text.len());
    for (number, line) in (1..).zip(text.lines()) {
        if line.len() > limits.line_bytes {
            warnings.push(format!("{name}, line {number}: too long; skipped"));
        } else if let Err(why) = push_safe(line, &mut safe) {
            warnings.push(format!("{name}, line {number}: {why}; skipped: '{}'", line.trim()));
        }
        safe.push('\n');
    }
    match tobj::load_mtl_buf(&mut safe.as_bytes()) {
        Ok(parsed) => parsed,
        Err(e) => {
            warnings.push(format!("material file '{name}': {e}; its materials are gray"));
            Default::default()
        }
    }
}

/// Appends a line if the parser can take it. The parser gives up on a whole file over one bad number, and expects
/// three numbers where the format allows one.
fn push_safe(line: &str, out: &mut String) -> Result<(), &'static str> {
    let mut words = line.split_whitespace();
    let Some(key) = words.next() else { return Ok(()) };
    let numbers = || line.split_whitespace().skip(1).map_while(|w| w.parse::<f32>().ok()).collect::<Vec<_>>();
    match key {
        "Ka" | "Kd" | "Ks" | "Ke" => match numbers()[..] {
            [r, g, b, ..] => out.push_str(&format!("{key} {r} {g} {b}")),
            [v] => out.push_str(&format!("{key} {v} {v} {v}")),
            _ => return Err("a colour needs one or three numbers (spectral files are not read)"),
        },
        "Ns" | "Ni" | "d" | "Tr" | "Pr" | "Pm" => match numbers().first() {
            Some(v) => out.push_str(&format!("{key} {v}")),
            None => return Err("a number is missing"),
        },
        "illum" => match words.next().and_then(|w| w.parse::<u8>().ok()) {
            Some(v) => out.push_str(&format!("illum {v}")),
            None => return Err("an illumination model is a small whole number"),
        },
        // `newmtl` without a name would be refused; a nameless material can still be used by a nameless `usemtl`.
        "newmtl" if words.next().is_none() => out.push_str("newmtl unnamed"),
        _ if (key.starts_with("map_") || key == "bump") && words.next().is_none() => {
            return Err("a texture needs a file name");
        }
        _ => out.push_str(line.trim()),
    }
    Ok(())
}

/// Materials of a file as they come into use: what no face names is never made, what names a texture decodes it once.
pub(crate) struct Made<'a> {
    mtl: &'a [tobj::Material],
    resolver: &'a dyn Resolver,
    limits: &'a Limits,
    /// By number in the file, and whether the vertices bring colours.
    ids: HashMap<(Option<usize>, bool), MaterialId>,
    images: HashMap<(String, Encoding), Option<Arc<ImageTexture>>>,
    budget: ImageBudget,
    pub(crate) warnings: Vec<String>,
}

impl<'a> Made<'a> {
    pub(crate) fn new(mtl: &'a [tobj::Material], resolver: &'a dyn Resolver, limits: &'a Limits) -> Self {
        let (ids, images) = Default::default();
        Self { mtl, resolver, limits, ids, images, budget: ImageBudget::new(limits), warnings: Vec::new() }
    }

    pub(crate) fn count(&self) -> usize {
        self.ids.len()
    }

    /// Pictures decoded.
    pub(crate) fn images(&self) -> usize {
        self.images.values().flatten().count()
    }

    /// The material of a model, made on first use. Index `None` or out of range is a plain gray; `colored` vertices
    /// multiply a diffuse colour, and stand alone where there is no material.
    pub(crate) fn material(
        &mut self,
        index: Option<usize>,
        colored: bool,
        builder: &mut SceneBuilder,
    ) -> MaterialId {
        let index = index.filter(|&i| i < self.mtl.len());
        if let Some(&id) = self.ids.get(&(index, colored)) {
            return id;
        }
        let id = match index.and_then(|i| self.mtl.get(i)) {
            Some(m) => self.make(m, colored, builder),
            None => {
                let gray = Spectrum::gray(if colored { 1.0 } else { 0.6 });
                builder.material(Diffuse { vertex_color: colored, ..Diffuse::new(gray) })
            }
        };
        self.ids.insert((index, colored), id);
        id
    }

    /// Makes the model's geometry emit if its material does. True if it does.
    pub(crate) fn emit(&self, index: Option<usize>, geom: GeomId, builder: &mut SceneBuilder) -> bool {
        let Some(ke) = index.and_then(|i| self.mtl.get(i)).and_then(emissive) else { return false };
        builder.emit(geom, Emission::new(Tex::from(ke)));
        true
    }

    fn make(&mut self, m: &tobj::Material, colored: bool, builder: &mut SceneBuilder) -> MaterialId {
        let name = &m.name;
        let unread = unread_textures(m);
        if !unread.is_empty() {
            self.warnings
                .push(format!("material '{name}': textures that are not used: {}", unread.join(", ")));
        }
        let kd = m.diffuse.map_or(Spectrum::gray(0.6), clamped);
        let ks = m.specular.map_or(Spectrum::BLACK, clamped);
        let number = |key: &str| m.unknown_param.get(key).and_then(|v| v.trim().parse::<f32>().ok());
        let roughness = number("Pr").map(|r| r.clamp(0.0, 1.0));
        let metallic = number("Pm").unwrap_or(0.0);
        let dissolve = m.dissolve.or(number("Tr").map(|t| 1.0 - t)).filter(|d| d.is_finite()).unwrap_or(1.0);
        let illum = m.illumination_model.unwrap_or(2);
        // The format's models 4, 6, 7 and 9 are glass, 3, 5 and 8 mirrors; a mirror needs something to reflect with.
        if matches!(illum, 4 | 6 | 7 | 9) {
            let eta = m.optical_density.filter(|n| *n > 1.0 && n.is_finite()).unwrap_or(1.5);
            return builder.material(Glass::new(eta));
        }
        if metallic >= 0.5 {
            return builder.material(Metal::schlick(kd, roughness.unwrap_or(0.3)));
        }
        if matches!(illum, 3 | 5 | 8) && kd.is_black() && !ks.is_black() {
            return builder.material(MirrorMaterial::new(ks));
        }
        if !ks.is_black() {
            self.warnings
                .push(format!("material '{name}': its highlight (Ks, Ns) has no physical meaning; dropped"));
        }
        let albedo = match m.diffuse_texture.as_deref().and_then(|t| self.image(t, Encoding::Srgb)) {
            Some(image) => Tex::image(image),
            None => Tex::from(kd),
        };
        let base = Diffuse { vertex_color: colored, ..Diffuse::new(albedo) };
        if emissive(m).is_some() {
            if dissolve < 1.0 || m.dissolve_texture.is_some() {
                self.warnings
                    .push(format!("material '{name}' emits light: its opacity (d, Tr, map_d) is dropped"));
            }
            return builder.material(base);
        }
        if let Some(image) = m.dissolve_texture.as_deref().and_then(|t| self.image(t, Encoding::Linear)) {
            return builder.material(Cutout::new(base, ScalarTex::image(ImageUse::new(image), Channel::R)));
        }
        if dissolve < 1.0 {
            return builder.material(Cutout::new(base, dissolve.clamp(0.0, 1.0)));
        }
        builder.material(base)
    }

    /// A texture by the name in the file, decoded once; `None` with a warning where it cannot be had.
    fn image(&mut self, entry: &str, encoding: Encoding) -> Option<Arc<ImageTexture>> {
        // Options such as `-s 1 1 1` come first; the name is what follows the last of them.
        let name = texture_name(entry);
        let key = (name.to_owned(), encoding);
        if let Some(known) = self.images.get(&key) {
            return known.clone();
        }
        let image = match self.decode(name, encoding) {
            Ok(image) => Some(Arc::new(image)),
            Err(why) => {
                self.warnings.push(format!("texture '{name}': {why}; its colour is used instead"));
                None
            }
        };
        self.images.insert(key, image.clone());
        image
    }

    fn decode(&mut self, name: &str, encoding: Encoding) -> Result<ImageTexture, String> {
        let bytes = self.resolver.read(name, self.limits.file_bytes).map_err(|e| e.to_string())?;
        decode_texture(&bytes, encoding, &mut self.budget).map_err(|e| e.to_string())
    }
}

/// The texture entries of a material that mean nothing here, in the order of their names.
fn unread_textures(m: &tobj::Material) -> Vec<&str> {
    let is_texture = |k: &&str| k.starts_with("map_") || matches!(*k, "norm" | "disp" | "decal" | "refl");
    let mut unread: Vec<&str> = m.unknown_param.keys().map(String::as_str).filter(is_texture).collect();
    let known = [
        ("map_Ka", &m.ambient_texture),
        ("map_Ks", &m.specular_texture),
        ("map_Ns", &m.shininess_texture),
        ("map_Bump", &m.normal_texture),
    ];
    unread.extend(known.into_iter().filter(|(_, t)| t.is_some()).map(|(key, _)| key));
    unread.sort_unstable();
    unread
}

/// Radiance a material emits, if any.
fn emissive(m: &tobj::Material) -> Option<Spectrum> {
    let text = m.emissive.or_else(|| {
        let v: Vec<f32> =
            m.unknown_param.get("Ke")?.split_whitespace().filter_map(|w| w.parse().ok()).collect();
        <[f32; 3]>::try_from(v).ok()
    })?;
    let ke = Spectrum::from(text.map(|c| if c.is_finite() && c > 0.0 { c } else { 0.0 }));
    (!ke.is_black()).then_some(ke)
}

fn clamped(c: [f32; 3]) -> Spectrum {
    Spectrum::from(c.map(|v| if v.is_finite() { v.clamp(0.0, 1.0) } else { 0.0 }))
}

/// The file name at the end of a texture entry, behind options and their numbers.
fn texture_name(entry: &str) -> &str {
    let mut rest = entry.trim();
    while let Some(option) = rest.strip_prefix('-') {
        let Some((_, mut tail)) = option.split_once(char::is_whitespace) else { return "" };
        tail = tail.trim_start();
        // Numbers and on/off belong to the option.
        while let Some((word, after)) = tail.split_once(char::is_whitespace) {
            if word.parse::<f32>().is_ok() || matches!(word, "on" | "off") || word.len() == 1 {
                tail = after.trim_start();
            } else {
                break;
            }
        }
        rest = tail;
    }
    rest
}

/// Kept here so that the two halves of a mesh's look stay together.
pub(crate) fn add_geometry(
    geometry: Geometry,
    index: Option<usize>,
    made: &mut Made<'_>,
    builder: &mut SceneBuilder,
) -> bool {
    let colored = matches!(&geometry, Geometry::Mesh(mesh) if !mesh.colors().is_empty());
    let material = made.material(index, colored, builder);
    let geom = builder.add(geometry, material);
    made.emit(index, geom, builder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_behind_options() {
        assert_eq!(texture_name("wood.png"), "wood.png");
        assert_eq!(texture_name("-s 1 2 1 -clamp on my wood.png"), "my wood.png");
        assert_eq!(texture_name("-bm 0.2 bump.png"), "bump.png");
        assert_eq!(texture_name("-s"), "");
    }

    #[test]
    fn colours_of_one_number_are_gray_and_bad_lines_are_named() {
        let mut out = String::new();
        assert!(push_safe("Kd 0.5", &mut out).is_ok());
        assert_eq!(out, "Kd 0.5 0.5 0.5");
        assert!(push_safe("Kd spectral a.rfl", &mut out).is_err());
        assert!(push_safe("illum many", &mut out).is_err());
        assert!(push_safe("Ns", &mut out).is_err());
    }
}
