//! Materials, textures, opacity and tangents.

use etendue::bsdf::Lobes;
use etendue::core::math;
use etendue::io::LoadOptions;
use etendue::prelude::*;
use serde_json::{Value, json};

use crate::doc::{Doc, Shape, quad};
use crate::{close, read, try_read};

/// Half sRGB white, decoded.
const MIDDLE: f32 = 0.215_860_5;
/// The four texels of [`four`]: red, green / blue, white.
const FOUR: [[u8; 4]; 4] = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 255, 255]];

fn nearest() -> Value {
    json!({"magFilter": 9728, "minFilter": 9728})
}

/// A matte material: no metal, no gloss.
fn matte(base: Value) -> Value {
    let mut pbr = base;
    pbr["metallicFactor"] = json!(0);
    json!({"pbrMetallicRoughness": pbr, "extensions": {"KHR_materials_specular": {"specularFactor": 0}}})
}

fn with(material: Value, change: impl FnOnce(&mut Doc, &mut Value)) -> Doc {
    let mut d = Doc::new();
    let mut material = material;
    d.uses("KHR_materials_specular");
    change(&mut d, &mut material);
    let m = d.push("materials", material);
    let mesh = d.mesh(&quad(), Some(m));
    d.node(json!({"mesh": mesh}));
    d
}

#[test]
fn textures_lie_the_right_way_up_and_are_decoded_from_srgb() {
    let d = with(matte(json!({"baseColorFactor": [0.5, 0.5, 0.5, 1.0]})), |d, m| {
        let mut texels = FOUR;
        texels[3] = [128, 128, 128, 255];
        m["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": d.texture(2, &texels, nearest())});
    });
    let r = read(&d);
    close(r.albedo(-0.5, 0.5), [0.5, 0.0, 0.0], 1e-6);
    close(r.albedo(0.5, 0.5), [0.0, 0.5, 0.0], 1e-6);
    close(r.albedo(-0.5, -0.5), [0.0, 0.0, 0.5], 1e-6);
    close(r.albedo(0.5, -0.5), [0.5 * MIDDLE; 3], 1e-6);
    let s = r.at(0.0, 0.0);
    let bsdf = r.scene.material(&s).expect("material").bsdf(&s).lobes();
    assert!(
        bsdf.contains(Lobes::DIFFUSE) && !bsdf.contains(Lobes::GLOSSY),
        "what has no gloss has no lobe for it"
    );
}

#[test]
fn texture_transform_moves_turns_and_chooses_the_set() {
    // The example of the extension's text: offset (0, 1), a quarter turn, half the size: the lower left quarter.
    let transform = json!({"offset": [0, 1], "rotation": std::f32::consts::FRAC_PI_2, "scale": [0.5, 0.5]});
    let d = with(matte(json!({})), |d, m| {
        d.uses("KHR_texture_transform");
        let t = d.texture(2, &FOUR, nearest());
        m["pbrMetallicRoughness"]["baseColorTexture"] =
            json!({"index": t, "extensions": {"KHR_texture_transform": transform}});
    });
    let r = read(&d);
    for (x, y) in [(-0.5, 0.5), (0.5, 0.5), (-0.5, -0.5), (0.5, -0.5)] {
        close(r.albedo(x, y), [0.0, 0.0, 1.0], 1e-6);
    }
}

#[test]
fn a_second_set_of_coordinates() {
    let mut d = Doc::new();
    let t = d.texture(2, &FOUR, nearest());
    d.uses("KHR_materials_specular");
    let m = d.push("materials", matte(json!({"baseColorTexture": {"index": t, "texCoord": 1}})));
    let mesh = d.mesh(&quad(), Some(m));
    // All of the quad looks at the blue texel.
    let uv1 = d.floats(&[[0.2, 0.8f32]; 4]);
    d.json["meshes"][mesh]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(uv1);
    d.node(json!({"mesh": mesh}));
    close(read(&d).albedo(0.5, 0.5), [0.0, 0.0, 1.0], 1e-6);
}

#[test]
fn samplers_say_what_lies_beyond_the_border() {
    let edge = |wrap: u32, x: f32| {
        let d = with(matte(json!({})), |d, m| {
            d.uses("KHR_texture_transform");
            let mut s = nearest();
            s["wrapS"] = json!(wrap);
            let row = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 255, 255]];
            let t = d.texture(4, &row, s);
            // The quad sees u from 0 to 2.
            m["pbrMetallicRoughness"]["baseColorTexture"] =
                json!({"index": t, "extensions": {"KHR_texture_transform": {"scale": [2, 1]}}});
        });
        read(&d).albedo(x, 0.0)
    };
    // u = 1.125: the first texel again, the last one held, the last one mirrored.
    close(edge(10497, 0.125), [1.0, 0.0, 0.0], 0.0);
    close(edge(33071, 0.125), [1.0, 1.0, 1.0], 0.0);
    close(edge(33648, 0.125), [1.0, 1.0, 1.0], 0.0);
    // u = 1.875.
    close(edge(10497, 0.875), [1.0, 1.0, 1.0], 0.0);
    close(edge(33071, 0.875), [1.0, 1.0, 1.0], 0.0);
    close(edge(33648, 0.875), [1.0, 0.0, 0.0], 0.0);
}

#[test]
fn bytes_stay_bytes() {
    let d = with(matte(json!({})), |d, m| {
        let texels = vec![[9, 9, 9, 255]; 256 * 256];
        m["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": d.texture(256, &texels, json!({}))});
    });
    let bytes = read(&d).scene.report().memory.materials;
    assert!((256 * 256 * 4..256 * 256 * 4 + 8192).contains(&bytes), "{bytes}");
}

#[test]
fn what_nothing_uses_is_not_decoded() {
    // A PNG with a sound header and nothing behind it.
    let broken = |d: &mut Doc| {
        let mut png = crate::doc::png(64, &[[1, 2, 3, 255]; 64 * 64]);
        png.truncate(60);
        let view = d.view(&png);
        let image = d.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
        d.push("textures", json!({"source": image}))
    };
    let unused = with(matte(json!({})), |d, _| {
        broken(d);
    });
    assert_eq!(read(&unused).loaded.report.images, 0);
    let used = with(matte(json!({})), |d, m| {
        m["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": broken(d)});
    });
    let error = try_read(&used, &LoadOptions::default()).err().expect("refused").to_string();
    assert!(error.contains("/images/0"), "{error}");
    let lenient =
        try_read(&used, &LoadOptions { lenient: true, ..LoadOptions::default() }).expect("gray instead");
    assert!(
        lenient.loaded.report.warnings.iter().any(|w| w.contains("/images/0")),
        "{:?}",
        lenient.loaded.report
    );
}

#[test]
fn vertex_colours_multiply_and_their_alpha_cuts() {
    let mut d = Doc::new();
    d.uses("KHR_materials_specular");
    let mut material = matte(json!({"baseColorFactor": [0.5, 1.0, 1.0, 1.0]}));
    material["alphaMode"] = json!("MASK");
    let m = d.push("materials", material);
    let mesh = d.mesh(&quad(), Some(m));
    let colors = d.floats(&[
        [0.5, 0.25, 1.0, 1.0],
        [0.5, 0.25, 1.0, 0.0f32],
        [0.5, 0.25, 1.0, 0.0],
        [0.5, 0.25, 1.0, 1.0],
    ]);
    d.json["meshes"][mesh]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    d.node(json!({"mesh": mesh}));
    let r = read(&d);
    close(r.albedo(-0.5, 0.1), [0.25, 0.25, 1.0], 1e-6);
    assert!(r.see(Vec3A::new(0.5, 0.0, 10.0), Vec3A::NEG_Z).is_none(), "alpha falls below one half");
}

#[test]
fn mask_is_sharp_and_blend_lets_its_share_through() {
    let read_with = |mode: &str, alpha: u8| {
        let d = with(matte(json!({})), |d, m| {
            m["alphaMode"] = json!(mode);
            let texels = [[255, 255, 255, alpha]];
            m["pbrMetallicRoughness"]["baseColorTexture"] =
                json!({"index": d.texture(1, &texels, nearest())});
        });
        let r = read(&d);
        let ray = Ray::new(Vec3A::new(0.1, 0.2, 5.0), Vec3A::NEG_Z);
        let hits =
            (0..4096u32).filter(|i| r.scene.intersect(&ray, i.wrapping_mul(2_654_435_761)).is_some()).count();
        (hits as f32 / 4096.0, r.scene.needs())
    };
    assert_eq!(read_with("MASK", 128).0, 1.0);
    assert_eq!(read_with("MASK", 127).0, 0.0);
    // Three standard deviations of 4096 coins at 64/255.
    let (share, _) = read_with("BLEND", 64);
    assert!((share - 64.0 / 255.0).abs() < 0.021, "{share}");
    let (solid, needs) = read_with("BLEND", 255);
    assert!(
        solid == 1.0 && !needs.contains(Needs::CUTOUTS),
        "what is solid everywhere has no holes to look for"
    );
    assert_eq!(read_with("OPAQUE", 0).0, 1.0);
}

#[test]
fn a_normal_map_tilts_along_the_tangents_given_or_made() {
    // A map that leans by 30° toward +x: (0.5, 0, 0.866), and one toward +y, which is up in the image.
    let lean = |texel: [u8; 4], given: bool, flipped: bool| {
        let mut d = Doc::new();
        let t = d.texture(1, &[texel], nearest());
        let m = d.push(
            "materials",
            json!({"normalTexture": {"index": t}, "pbrMetallicRoughness": {"metallicFactor": 0}}),
        );
        let mut shape = quad();
        if flipped {
            // The image mirrored: u runs to the left.
            for uv in &mut shape.uv {
                uv[0] = 1.0 - uv[0];
            }
        }
        let mesh = d.mesh(&shape, Some(m));
        if given {
            // u to the right, bitangent up.
            let tangents = d.floats(&[[1.0f32, 0.0, 0.0, 1.0]; 4]);
            d.json["meshes"][mesh]["primitives"][0]["attributes"]["TANGENT"] = json!(tangents);
        }
        d.node(json!({"mesh": mesh}));
        let r = read(&d);
        assert!(r.scene.needs().contains(Needs::NORMAL_MAPS));
        let s = r.at(0.3, -0.4);
        r.scene.material(&s).expect("material").shading_frame(&s).z
    };
    let (to_x, to_y) = ([191, 128, 238, 255], [128, 191, 238, 255]);
    for given in [false, true] {
        let x = lean(to_x, given, false);
        assert!((x - Vec3A::new(0.5, 0.0, 0.866)).length() < 0.01, "given {given}: {x}");
        let y = lean(to_y, given, false);
        assert!((y - Vec3A::new(0.0, 0.5, 0.866)).length() < 0.01, "given {given}: {y}");
    }
    let x = lean(to_x, false, true);
    assert!((x - Vec3A::new(-0.5, 0.0, 0.866)).length() < 0.01, "mirrored: {x}");
    let y = lean(to_y, false, true);
    assert!((y - Vec3A::new(0.0, 0.5, 0.866)).length() < 0.01, "mirrored: {y}");
}

fn glass(volume: Option<Value>, base: [f32; 4]) -> Doc {
    let mut m = json!({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0, "baseColorFactor": base},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.33}}});
    with(json!({}), |d, out| {
        d.uses("KHR_materials_transmission");
        d.uses("KHR_materials_ior");
        if let Some(v) = volume {
            d.uses("KHR_materials_volume");
            m["extensions"]["KHR_materials_volume"] = v;
        }
        *out = m;
    })
}

#[test]
fn transmission_bends_in_a_volume_and_goes_straight_through_a_thin_wall() {
    let through = |d: &Doc| {
        let r = read(d);
        let s = r.at(0.0, 0.0);
        let wo = Vec3A::new(0.6, 0.0, 0.8);
        let material = r.scene.material(&s).expect("material");
        let bsdf = material.bsdf(&s);
        (0..256)
            .filter_map(|i| bsdf.sample(wo, i as f32 / 256.0, Vec2::new(0.3, 0.6), Mode::Radiance))
            .find(|s| s.wi.z < 0.0)
            .expect("something goes through")
            .wi
    };
    let solid = through(&glass(Some(json!({"thicknessFactor": 1})), [1.0; 4]));
    assert!((solid.x + 0.6 / 1.33).abs() < 1e-5, "Snell: {solid}");
    for volume in [None, Some(json!({"thicknessFactor": 0}))] {
        let thin = through(&glass(volume, [1.0; 4]));
        assert!((thin - Vec3A::new(-0.6, 0.0, -0.8)).length() < 1e-5, "{thin}");
    }
}

#[test]
fn a_volume_absorbs_by_the_colour_at_its_distance() {
    let volume =
        json!({"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [0.25, 0.5, 1.0]});
    for base in [[1.0; 4], [0.9, 0.9, 0.9, 1.0]] {
        let r = read(&glass(Some(volume.clone()), base));
        let s = r.at(0.0, 0.0);
        let sigma = r.scene.material(&s).expect("material").absorption().expect("some");
        close(sigma, [math::ln(4.0) / 2.0, math::ln(2.0) / 2.0, 0.0], 1e-6);
    }
    assert!(!read(&glass(None, [1.0; 4])).scene.needs().contains(Needs::ABSORPTION));
}

/// Reflectance of a smooth surface seen head-on: its mirror part alone, with a black base.
fn head_on(extensions: Value) -> [f32; 3] {
    let m = json!({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.0, "baseColorFactor": [0, 0, 0, 1]},
        "extensions": extensions});
    let names: Vec<String> = extensions.as_object().expect("object").keys().cloned().collect();
    let d = with(m, |d, _| names.iter().for_each(|n| d.uses(n)));
    read(&d).albedo(0.0, 0.0).to_array()
}

#[test]
fn ior_and_specular_set_the_reflectance_head_on() {
    let at = |e: Value, expected: [f32; 3]| {
        let found = head_on(e.clone());
        for (a, b) in found.into_iter().zip(expected) {
            assert!((a - b).abs() < 2e-3, "{e}: {found:?} against {expected:?}");
        }
    };
    at(json!({}), [0.04; 3]);
    let f2 = (1.0f32 / 3.0).powi(2);
    at(json!({"KHR_materials_ior": {"ior": 2.0}}), [f2; 3]);
    at(json!({"KHR_materials_specular": {"specularFactor": 0.5}}), [0.02; 3]);
    at(json!({"KHR_materials_specular": {"specularColorFactor": [1.0, 0.5, 0.0]}}), [0.04, 0.02, 0.0]);
}

#[test]
fn variants_are_chosen_by_name() {
    let mut d = Doc::new();
    d.uses("KHR_materials_specular");
    d.uses("KHR_materials_variants");
    d.json["extensions"] =
        json!({"KHR_materials_variants": {"variants": [{"name": "day"}, {"name": "night"}]}});
    let gray = |v: f32| matte(json!({"baseColorFactor": [v, v, v, 1.0]}));
    let own = d.push("materials", gray(0.5));
    let night = d.push("materials", gray(0.125));
    let mesh = d.mesh(&quad(), Some(own));
    d.json["meshes"][mesh]["primitives"][0]["extensions"] =
        json!({"KHR_materials_variants": {"mappings": [{"material": night, "variants": [1]}]}});
    d.node(json!({"mesh": mesh}));
    let shown = |name: Option<&str>| {
        let options = LoadOptions { variant: name.map(String::from), ..LoadOptions::default() };
        try_read(&d, &options).map(|r| r.albedo(0.0, 0.0).r())
    };
    assert_eq!(shown(None).expect("own"), 0.5);
    assert_eq!(shown(Some("day")).expect("own"), 0.5);
    assert_eq!(shown(Some("night")).expect("night"), 0.125);
    let error = shown(Some("noon")).expect_err("there is none").to_string();
    assert!(error.contains("'noon'") && error.contains("day, night"), "{error}");
}

#[test]
fn a_flat_mesh_takes_its_tangents_from_the_normal_maps_own_set() {
    let mut d = Doc::new();
    // Leans toward +x of its own coordinates, which run upward; the base colour's run to the right.
    let map = d.texture(1, &[[191, 128, 238, 255]], nearest());
    let base = d.texture(1, &[[255; 4]], nearest());
    let m = d.push(
        "materials",
        json!({"normalTexture": {"index": map, "texCoord": 1},
        "pbrMetallicRoughness": {"baseColorTexture": {"index": base}}}),
    );
    let mesh = d.mesh(&Shape { normals: Vec::new(), ..quad() }, Some(m));
    let uv = d.floats(&[[0.0f32, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]);
    d.json["meshes"][mesh]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(uv);
    d.node(json!({"mesh": mesh}));
    let r = read(&d);
    let s = r.at(0.3, -0.4);
    let z = r.scene.material(&s).expect("material").shading_frame(&s).z;
    assert!((z - Vec3A::new(0.0, 0.5, 0.866)).length() < 0.01, "{z}");
}

#[test]
fn what_specular_does_not_do_to_glass_is_said() {
    let mut d = glass(None, [1.0; 4]);
    d.uses("KHR_materials_specular");
    d.json["materials"][0]["extensions"]["KHR_materials_specular"] = json!({"specularFactor": 0.5});
    let warnings = try_read(&d, &LoadOptions::default()).expect("valid").loaded.report.warnings;
    assert!(warnings.iter().any(|w| w.contains("KHR_materials_specular")), "{warnings:?}");
}
