//! The asset, cameras, images and lights: what the tables cannot say.

use std::f64::consts::PI;

use serde_json::Value;

use super::model::{Model, ViewUse};
use super::picture;
use super::report::{At, Report};
use super::storage::use_view;
use super::uri::{self, Uri};
use super::values::{extension, index_of, list, number_of, short, text_of};

/// Checks the version of the format.
pub(super) fn check_asset(root: &Value, report: &mut Report) {
    let Some(asset) = root.get("asset") else { return };
    let at = At::Root.key("asset");
    let mut versions = [None; 2];
    for (name, slot) in ["version", "minVersion"].into_iter().zip(&mut versions) {
        let Some(text) = text_of(asset, name) else { continue };
        *slot = version(text);
        if slot.is_none() {
            report.error("PATTERN_MISMATCH", &at.key(name), || {
                format!("'{}' is no version; it is two numbers with a point, as in '2.0'", short(text))
            });
        }
    }
    let [version, least] = versions;
    match version {
        Some((2, 0)) | None => {}
        Some((2, minor)) => report.warning("UNKNOWN_ASSET_MINOR_VERSION", &at.key("version"), || {
            format!("version 2.{minor} is later than 2.0, as which it is read")
        }),
        Some((major, _)) => report.error("UNKNOWN_ASSET_MAJOR_VERSION", &at.key("version"), || {
            format!("glTF {major} is not glTF 2; export the scene as glTF 2.0")
        }),
    }
    if version.zip(least).is_some_and(|(version, least)| least > version) {
        report.error("ASSET_MIN_VERSION_GREATER_THAN_VERSION", &at.key("minVersion"), || {
            "the least version is later than the version".into()
        });
    }
}

fn version(text: &str) -> Option<(u64, u64)> {
    let (major, minor) = text.split_once('.')?;
    let number = |t: &str| t.bytes().all(|b| b.is_ascii_digit()).then(|| t.parse().ok()).flatten();
    Some((number(major)?, number(minor)?))
}

/// Checks the cameras.
pub(super) fn check_cameras(model: &Model<'_>, report: &mut Report) {
    let array = At::Root.key("cameras");
    for (i, camera) in model.list("cameras").iter().enumerate() {
        let here = array.index(i);
        let both = camera.get("perspective").is_some() && camera.get("orthographic").is_some();
        if both {
            report.error("ONE_OF_MISMATCH", &here, || {
                "it is both perspective and orthographic; leave one of them out".into()
            });
        }
        let wanted = text_of(camera, "type").filter(|t| ["perspective", "orthographic"].contains(t));
        if let Some(wanted) = wanted.filter(|w| camera.get(*w).is_none()) {
            report.error("UNDEFINED_PROPERTY", &here, || format!("'{wanted}' is missing; it must be there"));
        }
        for name in ["perspective", "orthographic"] {
            let Some(lens) = camera.get(name) else { continue };
            check_lens(lens, &here.key(name), report);
        }
    }
}

fn check_lens(lens: &Value, at: &At<'_>, report: &mut Report) {
    let far = number_of(lens, "zfar").zip(number_of(lens, "znear"));
    if let Some((far, near)) = far.filter(|(far, near)| far <= near) {
        report.error("CAMERA_ZFAR_LEQUAL_ZNEAR", at, || {
            format!("zfar {far} is not beyond znear {near}; it must be")
        });
    }
    if let Some(yfov) = number_of(lens, "yfov").filter(|y| *y >= PI) {
        report.warning("CAMERA_YFOV_GEQUAL_PI", at, || {
            format!("a field of view of {yfov} radians is half a turn or more; it is an angle in radians")
        });
    }
    for name in ["xmag", "ymag"] {
        match number_of(lens, name) {
            Some(0.0) => report.error("CAMERA_XMAG_YMAG_ZERO", &at.key(name), || {
                "a picture without extent; it must not be 0".into()
            }),
            Some(x) if x < 0.0 => report.warning("CAMERA_XMAG_YMAG_NEGATIVE", &at.key(name), || {
                format!("{x} mirrors the picture; it should be positive")
            }),
            _ => {}
        }
    }
}

/// Checks the images as far as the document alone tells. Their media types, where they are known.
pub(super) fn check_images(model: &mut Model<'_>, report: &mut Report) -> Vec<Option<String>> {
    let webp = model.uses("EXT_texture_webp");
    let array = At::Root.key("images");
    let mut mimes = Vec::new();
    for (i, image) in model.list("images").iter().enumerate() {
        let here = array.index(i);
        let view = image.get("bufferView");
        if image.is_object() && image.get("uri").is_some() == view.is_some() {
            report.error("ONE_OF_MISMATCH", &here, || "it must have either 'uri' or 'bufferView'".into());
        }
        let declared = text_of(image, "mimeType");
        if let Some(mime) = declared {
            let known = ["image/jpeg", "image/png"].contains(&mime) || webp && mime == "image/webp";
            if !known {
                report.warning("VALUE_NOT_IN_LIST", &here.key("mimeType"), || {
                    format!("'{}' is not image/jpeg or image/png; the image is not read", short(mime))
                });
            }
        }
        if view.is_some() {
            let view = index_of(image, "bufferView");
            use_view(model, view, ViewUse::Image, &here.key("bufferView"), report);
            if view.and_then(|v| model.views.get(v)).is_some_and(|v| v.stride.is_some()) {
                report.error("IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE", &here.key("bufferView"), || {
                    "the view of an image has a byteStride; leave it out".into()
                });
            }
        }
        let within = text_of(image, "uri").and_then(|text| check_uri(text, &here.key("uri"), report));
        mimes.push(declared.map(str::to_owned).or(within));
    }
    mimes
}

/// The media type of an image in a URI, if it is there and what it says.
fn check_uri(text: &str, at: &At<'_>, report: &mut Report) -> Option<String> {
    let Some(Uri::Data(data)) = uri::check(text, at, report) else { return None };
    let found = picture::recognise(&data.beginning());
    if let Some(found) = found.filter(|f| *f != data.mime) {
        report.error("INVALID_URI", at, || {
            format!("it says that it is {} but it is {found}", short(&data.mime))
        });
        return None;
    }
    Some(data.mime)
}

/// Checks the lights and that nodes name them rightly.
pub(super) fn check_lights(model: &Model<'_>, report: &mut Report) {
    const NAME: &str = "KHR_lights_punctual";
    if !model.uses(NAME) {
        return;
    }
    let root = extension(model.root, NAME);
    let at = At::Root.key("extensions");
    let at = at.key(NAME);
    let at = at.key("lights");
    for (i, light) in root.map_or(&[][..], |r| list(r, "lights")).iter().enumerate() {
        let here = at.index(i);
        if text_of(light, "type") == Some("spot") && light.get("spot").is_none() {
            report.error("UNDEFINED_PROPERTY", &here, || "'spot' is missing; it must be there".into());
        }
        let Some(spot) = light.get("spot") else { continue };
        let inner = number_of(spot, "innerConeAngle").unwrap_or(0.0);
        let outer = number_of(spot, "outerConeAngle").unwrap_or(std::f64::consts::FRAC_PI_4);
        if outer <= inner {
            let within = here.key("spot");
            report.error("KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES", &within.key("outerConeAngle"), || {
                format!("the outer angle {outer} is not wider than the inner {inner}; it must be")
            });
        }
    }
    let array = At::Root.key("nodes");
    for (i, node) in model.list("nodes").iter().enumerate() {
        if root.is_none() && extension(node, NAME).is_some() {
            let here = array.index(i);
            let here = here.key("extensions");
            report.error("UNSATISFIED_DEPENDENCY", &here.key(NAME), || {
                "the document has no lights; add KHR_lights_punctual to its extensions".into()
            });
        }
    }
}
