//! `etendue render`, `merge`, `compare` and `info` from outside.

mod common;

use common::Bench;
use etendue::io::{Limits, read_film, read_picture};
use serde_json::Value;

#[test]
fn the_default_output_is_a_png_in_the_working_folder() {
    let b = Bench::new("default");
    let [stdout, stderr] = b.good("render a.obj --size 20x10 --spp 2");
    assert_eq!(b.names(), ["a.mtl", "a.obj", "a.png"]);
    assert!(stdout.contains("a.png: 2 samples per pixel"), "{stdout}");
    assert_eq!(stderr.matches("no camera").count(), 1, "{stderr}");
    let p = read_picture(&b.path("a.png"), &Limits::default()).expect("a picture");
    assert_eq!((p.width, p.height), (20, 10));
}

#[test]
fn one_render_writes_every_kind() {
    let b = Bench::new("kinds");
    b.good("render a.obj -o x.exr -o x.png -o x.hdr -o x.film --size 24x16 --spp 4 --aov albedo,normal,depth,ids,alpha --json r.json --seed 3");
    let exr = read_picture(&b.path("x.exr"), &Limits::default()).expect("exr");
    let film = read_film(&b.path("x.film"), &Limits::default()).expect("film");
    assert_eq!(exr.rgb, film.film().to_rgb());
    assert!(exr.layers.iter().any(|l| l == "albedo.R") && exr.layers.iter().any(|l| l == "id.prim"));
    let note = |name: &str| exr.metadata.iter().find(|(k, _)| k == name).map(|(_, v)| v.clone());
    assert_eq!(note("etendue.note.seed").as_deref(), Some("3"));
    assert_eq!(note("etendue.bias").as_deref(), Some("none"));
    assert_eq!(note("etendue.scene"), Some(format!("{:032x}", film.info().scene.value)));
    assert_eq!(film.info().samples.to_string(), "0..4");

    let r = b.json("r.json");
    for key in ["load", "build", "render"] {
        assert!(r["seconds"][key].is_f64() && r["cpu_seconds"][key].is_f64(), "{r}");
    }
    for key in ["spp", "rays", "rejected", "seed", "samples", "threads"] {
        assert!(r[key].is_u64(), "{key}: {r}");
    }
    for key in ["needs", "skipped", "warnings", "bias", "outputs", "sample_ranges", "size"] {
        assert!(r[key].is_array(), "{key}: {r}");
    }
    assert_eq!((&r["spp"], &r["samples"], &r["seed"]), (&4.into(), &(24 * 16 * 4).into(), &3.into()));
    assert_eq!(r["outputs"], serde_json::json!(["x.exr", "x.png", "x.hdr", "x.film"]));
    assert_eq!(r["sample_ranges"], serde_json::json!([[0, 4]]));
    assert_eq!(
        (&r["ended"], &r["integrator"], &r["sampler"]),
        (&"complete".into(), &"path".into(), &"sobol".into())
    );
    assert!(r["needs"].as_array().is_some_and(|n| n.contains(&"lights".into())), "{r}");
    assert!(r["rays"].as_u64() > r["samples"].as_u64());
    if cfg!(target_os = "linux") {
        assert!(r["peak_bytes"].as_u64() > Some(1 << 20), "{r}");
    }
    assert!(r["scene_hash"].as_str().is_some_and(|h| h.len() == 32));
}

#[test]
fn threads_and_the_outputs_asked_for_do_not_change_a_bit() {
    let b = Bench::new("threads");
    for n in [1, 2, 3] {
        b.good(&format!("render a.obj -o {n}.exr -o {n}.film --size 40x30 --spp 5 --threads {n}"));
    }
    assert_eq!(b.bytes("1.film"), b.bytes("2.film"));
    assert_eq!(b.bytes("1.exr"), b.bytes("3.exr"));
    b.good("render a.obj -o plain.exr --size 40x30 --spp 5");
    assert_eq!(b.bytes("1.exr"), b.bytes("plain.exr"));
}

#[test]
fn shards_merge_to_the_undivided_film_bit_for_bit() {
    let b = Bench::new("shards");
    let how = "--size 24x16 --spp 11 --aov ids,depth";
    b.good(&format!("render a.obj -o whole.film -o whole.exr {how}"));
    for i in 1..=3 {
        b.good(&format!("render a.obj -o part{i}.film {how} --shard {i}/3"));
    }
    let [stdout, _] = b.good("merge part3.film part1.film part2.film -o merged.film -o merged.exr");
    assert!(stdout.contains("0..11"), "{stdout}");
    assert_eq!(b.bytes("merged.film"), b.bytes("whole.film"));
    assert_eq!(b.bytes("merged.exr"), b.bytes("whole.exr"));

    let e = b.bad("merge part1.film part2.film part1.film -o twice.film", 1);
    assert!(e.contains("part1.film") && e.contains("0..3"), "{e}");
    b.good(&format!("render a.obj -o other.film {how} --shard 2/3 --seed 9 --filter box"));
    let e = b.bad("merge part1.film other.film -o bad.film", 1);
    assert!(e.contains("seed: 0 and 9") && e.contains("filter: gaussian:1.5 and box:0.5"), "{e}");
    b.good("render a.obj -o small.film --size 24x15 --spp 11 --aov ids,depth --shard 2/3");
    let e = b.bad("merge part1.film small.film -o bad.film", 1);
    assert!(e.contains("24x16 and 24x15"), "{e}");
    let mtl = String::from_utf8(b.bytes("a.mtl")).expect("text").replace("0.7", "0.8");
    b.write("a.mtl", mtl);
    b.good(&format!("render a.obj -o scene.film {how} --shard 2/3"));
    let e = b.bad("merge part1.film scene.film -o bad.film", 1);
    assert!(e.contains("different scenes"), "{e}");
    assert!(!b.names().iter().any(|n| n == "bad.film" || n == "twice.film"));
}

#[test]
fn a_render_goes_on_where_it_was() {
    let b = Bench::new("resume");
    b.good("render a.obj -o whole.film --size 20x20 --spp 24");
    b.good("render a.obj -o part.film --size 20x20 --spp 9");
    b.good("render a.obj -o mid.film --size 20x20 --spp 24 --shard 2/2");
    b.good("render a.obj -o rest.film -o rest.exr --size 20x20 --spp 24 --resume part.film --json r.json");
    assert_eq!(b.bytes("rest.film"), b.bytes("whole.film"));
    assert_eq!(b.json("r.json")["samples"], 400 * 15);
    // A gap in front.
    b.good("render a.obj -o mid.film --size 20x20 --spp 24 --resume mid.film");
    assert_eq!(b.bytes("mid.film"), b.bytes("whole.film"));
    // Nothing left to do.
    let [_, stderr] = b.good("render a.obj -o again.exr --size 20x20 --spp 24 --resume rest.film");
    assert!(stderr.contains("in the film already"), "{stderr}");
    assert_eq!(b.bytes("again.exr"), b.bytes("rest.exr"));
    let e = b.bad("render a.obj -o x.film --size 20x20 --spp 24 --resume part.film --max-depth 3", 1);
    assert!(e.contains("max-depth: none and 3") && e.contains("part.film"), "{e}");
    let mut damaged = b.bytes("part.film");
    let middle = damaged.len() / 2;
    damaged[middle] ^= 1;
    b.write("damaged.film", damaged);
    let e = b.bad("render a.obj -o x.film --size 20x20 --resume damaged.film", 1);
    assert!(e.contains("damaged.film") && e.contains("checksum"), "{e}");
}

#[test]
fn a_time_budget_ends_a_render_well() {
    let b = Bench::new("time");
    b.good("render a.obj -o x.film -o x.png --size 64x64 --time 300ms --json r.json");
    let r = b.json("r.json");
    assert_eq!(r["ended"], "time");
    let spp = r["spp"].as_u64().expect("a number");
    assert!(spp >= 1 && r["samples"] == spp * 64 * 64, "{r}");
    let film = read_film(&b.path("x.film"), &Limits::default()).expect("a film");
    assert_eq!(film.info().samples.count(), spp);
    b.good("render a.obj -o y.png --size 8x8 --spp 3 --time 1h --json r.json");
    assert_eq!(b.json("r.json")["ended"], "complete");
}

#[test]
fn direct_is_path_with_one_scattering_event_and_no_bias() {
    let b = Bench::new("direct");
    b.good("render a.obj -o d.exr --size 16x16 --spp 2 --integrator direct --json d.json");
    b.good("render a.obj -o p.exr --size 16x16 --spp 2 --max-depth 1 --json p.json");
    b.good("compare d.exr p.exr --json c.json");
    assert_eq!(b.json("c.json")["rmse"], 0.0);
    assert_eq!(b.json("d.json")["bias"], serde_json::json!([]));
    assert!(b.json("p.json")["bias"][0].as_str().is_some_and(|s| s.contains("max_depth=1")));
    b.good("render a.obj -o e.exr --size 16x16 --spp 2 --max-depth 0");
    let dark = read_picture(&b.path("e.exr"), &Limits::default()).expect("a picture");
    let sum = |p: &etendue::io::Picture| p.rgb.iter().flatten().map(|v| f64::from(*v)).sum::<f64>();
    let direct = read_picture(&b.path("d.exr"), &Limits::default()).expect("a picture");
    assert!(sum(&dark) < sum(&direct));
}

/// Each by its name: full integrators are not biased, the others say what they leave out.
#[test]
fn integrators_are_the_ones_asked_for() {
    let b = Bench::new("integrators");
    let mut pictures = Vec::new();
    for (word, says) in [
        ("path", None),
        ("path:roulette=0.7:branch=2", None),
        ("path:roulette=albedo:from=2", None),
        ("split", None),
        ("area", None),
        ("hemisphere", Some("point lights")),
        ("path:threshold=0.1", Some("threshold=0.1")),
        ("whitted:each=0", Some("whitted")),
        ("raycast:shadows=off", Some("shadows")),
        ("ao:reach=1", Some("not radiance")),
        ("normal", Some("not radiance")),
        ("depth", Some("not radiance")),
        ("ids", Some("not radiance")),
        ("triangles", Some("not radiance")),
        ("albedo", Some("not radiance")),
    ] {
        b.good(&format!("render a.obj -o a.exr --size 12x12 --spp 2 --integrator {word} --json a.json"));
        let report = b.json("a.json");
        assert_eq!(report["integrator"], word);
        match (says, report["bias"].as_array().expect("a list").as_slice()) {
            (None, []) => {}
            (Some(says), bias) => {
                assert!(bias.iter().any(|b| b.as_str().is_some_and(|b| b.contains(says))), "{bias:?}")
            }
            (None, bias) => panic!("{word}: {bias:?}"),
        }
        let picture = read_picture(&b.path("a.exr"), &Limits::default()).expect("a picture").rgb;
        assert!(picture.iter().flatten().any(|&v| v > 0.0), "{word}: all black");
        assert!(!pictures.contains(&picture), "{word} is another one's picture");
        pictures.push(picture);
    }
    let e = b.bad("render a.obj --integrator whitted:light=bsdf", 2);
    assert!(e.contains("light=bsdf") && e.contains("raycast"), "{e}");
    b.good("bench a.obj --size 8x8 --spp 2 --runs 2 --integrator path,whitted,area,path:branch=4 --json bench.json");
}

#[test]
fn an_environment_lights_a_scene_without_lights() {
    let b = Bench::new("env");
    b.write("b.obj", "v -1 0 -1\nv 1 0 -1\nv 0 1.5 0\nf 1 2 3\n");
    let [_, stderr] = b.good("render b.obj -o dark.exr --size 16x16 --spp 1");
    assert!(stderr.contains("no light"), "{stderr}");
    b.good("render a.obj -o sky.hdr --size 16x8 --spp 4");
    let [_, stderr] =
        b.good("render b.obj -o lit.exr --size 16x16 --spp 1 --env sky.hdr --env-rotate -90 --env-scale 2");
    assert!(!stderr.contains("no light"), "{stderr}");
    let e = b.bad("render b.obj --env missing.hdr", 1);
    assert!(e.contains("missing.hdr"), "{e}");
    b.bad("render b.obj --env-scale 2", 2);
}

#[test]
fn samplers_and_filters_are_the_ones_asked_for() {
    let b = Bench::new("samplers");
    let mut pictures = Vec::new();
    for sampler in ["sobol", "stratified", "halton", "latin", "cmj", "independent"] {
        b.good(&format!("render a.obj -o a.hdr --size 16x16 --spp 4 --sampler {sampler} --filter tent:1"));
        let picture = b.bytes("a.hdr");
        assert!(!pictures.contains(&picture), "{sampler} is another one's picture");
        pictures.push(picture);
    }
    let e = b.bad("render a.obj --time 1s --sampler cmj", 2);
    assert!(e.contains("--sampler cmj"), "{e}");
    b.good("render a.obj -o up.png --size 16x16 --spp 4 --exposure 2");
    b.good("render a.obj -o filmic.png --size 16x16 --spp 4 --exposure 2 --tone-map filmic");
    assert_ne!(b.bytes("up.png"), b.bytes("filmic.png"));
}

#[test]
fn compare_and_info_say_what_there_is() {
    let b = Bench::new("info");
    b.good("render a.obj -o a.film -o a.exr -o a.hdr -o a.png --size 24x16 --spp 4");
    b.good("render a.obj -o more.exr --size 24x16 --spp 64");
    let [stdout, _] = b.good("compare a.exr more.exr --json c.json");
    assert!(stdout.contains("relMSE trimmed"), "{stdout}");
    let c = b.json("c.json");
    assert!(c["relmse"].as_f64() > Some(0.0) && c["relmse_trimmed"].as_f64() < c["relmse"].as_f64(), "{c}");
    b.good("compare a.film a.exr --json c.json");
    assert_eq!(b.json("c.json")["rmse"], 0.0);
    b.good("compare a.hdr a.png");
    b.good("render a.obj -o small.png --size 8x8 --spp 1");
    let e = b.bad("compare a.exr small.png", 2);
    assert!(e.contains("24x16") && e.contains("8x8"), "{e}");

    b.good("info a.obj --json i.json");
    let i = b.json("i.json");
    assert_eq!(
        (&i["kind"], &i["triangles"], &i["cameras"]),
        (&"scene".into(), &12.into(), &Value::Array(vec![]))
    );
    assert_eq!(i["light_parts"], 2);
    let [stdout, _] = b.good("info a.film --json i.json");
    assert!(stdout.contains("seed: 0") && stdout.contains("sample_ranges: [[0,4]]"), "{stdout}");
    assert_eq!(b.json("i.json")["size"], serde_json::json!([24, 16]));
    let [stdout, _] = b.good("info a.exr");
    assert!(stdout.contains("etendue.note.sampler: sobol"), "{stdout}");
    b.good("info a.png");
    let e = b.bad("info a.mtl", 1);
    assert!(e.contains("a.mtl"), "{e}");
}
