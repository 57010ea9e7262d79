use etendue::io::{Limits, LoadOptions, View, load_scene, read_film, read_picture, scene_endings};
use etendue::measure::Reference;
use etendue::scene::SceneBuilder;
use serde_json::{Value, json};

use crate::args::InfoArgs;
use crate::error::CliError;
use crate::outputs::{check_place, write_json};
use crate::picture::{film_limits, is_film};
use crate::report;
use crate::session::print;

pub(crate) fn run(args: &InfoArgs) -> Result<(), CliError> {
    if let Some(path) = &args.json {
        check_place(path)?;
    }
    let ending = args.file.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let value = match ending.as_str() {
        _ if is_film(&args.file) => film(args)?,
        known if scene_endings().contains(&known) => scene(args)?,
        _ => picture(args)?,
    };
    tell("", &value)?;
    if let Some(path) = &args.json {
        write_json(path, &value)?;
    }
    Ok(())
}

fn scene(args: &InfoArgs) -> Result<Value, CliError> {
    let mut builder = SceneBuilder::new();
    let loaded = load_scene(&args.file, &LoadOptions::default(), &mut builder)?;
    let scene = builder.build().map_err(|source| CliError::Scene { path: args.file.clone(), source })?;
    let (found, built) = (&loaded.report, scene.report());
    let cameras: Vec<Value> = loaded
        .cameras
        .iter()
        .map(|c| {
            let [fov, height] = match c.view {
                View::Perspective { vertical_fov_deg } => [Some(vertical_fov_deg), None],
                View::Orthographic { half_height, .. } => [None, Some(2.0 * half_height)],
                _ => [None, None],
            };
            json!({ "name": c.name, "aspect": c.aspect, "vertical_fov_deg": fov, "height": height })
        })
        .collect();
    let bounds = scene.bounds();
    let bounds = bounds.is_finite().then(|| json!([bounds.lo.to_array(), bounds.hi.to_array()]));
    Ok(json!({
        "kind": "scene",
        "meshes": found.meshes,
        "triangles": built.triangles,
        "instances": built.instances,
        "materials": found.materials,
        "images": found.images,
        "lights": built.lights,
        "light_parts": built.light_parts,
        "cameras": cameras,
        "bounds": bounds,
        "bytes": built.memory.total(),
        "needs": report::needs(built.needs),
        "scene_hash": format!("{:032x}", scene.fingerprint().value()),
        "skipped": found.skipped,
        "warnings": found.warnings,
        "built": built.to_string(),
    }))
}

fn picture(args: &InfoArgs) -> Result<Value, CliError> {
    let p = read_picture(&args.file, &Limits::default())?;
    let bad = p.rgb.iter().filter(|c| c.iter().any(|v| !v.is_finite())).count();
    let metadata: serde_json::Map<String, Value> =
        p.metadata.iter().map(|(k, v)| (k.clone(), Value::from(v.as_str()))).collect();
    Ok(json!({
        "kind": "picture",
        "size": [p.width, p.height],
        "layers": p.layers,
        "not_finite": bad,
        "metadata": metadata,
    }))
}

fn film(args: &InfoArgs) -> Result<Value, CliError> {
    let file = read_film(&args.file, &film_limits())?;
    let (info, film) = (file.info(), file.film());
    let planes = film.planes();
    let kept = [
        ("albedo", planes.albedo),
        ("normal", planes.normal),
        ("depth", planes.depth),
        ("ids", planes.ids),
        ("alpha", planes.alpha),
    ];
    let kept: Vec<&str> = kept.into_iter().filter(|(_, k)| *k).map(|(name, _)| name).collect();
    Ok(json!({
        "kind": "film",
        "size": [film.size().x, film.size().y],
        "replicates": film.replicates(),
        "planes": kept,
        "spp": info.samples.count(),
        "sample_ranges": report::ranges(&info.samples),
        "settings": info.words,
        "scene_hash": format!("{:032x}", info.scene.value),
        "settings_hash": format!("{:032x}", info.settings.value),
        "opaque": info.is_opaque(),
        "residual_relmse": Reference::from_film(film).map(|r| r.residual.relative),
        "digest": format!("{:032x}", film.digest()),
    }))
}

/// The same as lines to read: `key: value`, lists one entry a line.
fn tell(indent: &str, value: &Value) -> Result<(), CliError> {
    let Value::Object(map) = value else { return Ok(()) };
    let plain = |v: &Value| v.as_str().map_or_else(|| v.to_string(), str::to_owned);
    for (key, v) in map {
        match v {
            Value::Object(inner) if !inner.is_empty() => {
                print(&format!("{indent}{key}:"))?;
                tell(&format!("{indent}  "), v)?;
            }
            Value::Array(list) if list.iter().any(|e| e.is_string() || e.is_object()) => {
                print(&format!("{indent}{key}:"))?;
                for e in list {
                    print(&format!("{indent}  {}", plain(e)))?;
                }
            }
            other => print(&format!("{indent}{key}: {}", plain(other)))?,
        }
    }
    Ok(())
}
