//! How surfaces reflect, by the definition of the BRDF: reflected radiance over irradiance, measured.
//!
//! `cargo run --release --example gonioreflectometer` measures a rough metal, a matte sheet (EON) and grooves of the
//! same matte material at several angles, prints the readings with their intervals beside what the material itself
//! says, and writes `gonioreflectometer.html` with polar plots of the lobes in the plane of incidence.
//! Options: `--size N` (directions of a lobe), `--spp N` (detector rays of each of 8 runs), `--out FOLDER`.
//!
//! The BRDF of flat sheets is read exactly: nothing is left to chance. The grooves' sides are of the same clay as the
//! sheet, but as a whole they throw more light back to where it comes from, since whoever looks along the light sees
//! no shadow.

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;

use etendue::geometry::presets as meshes;
use etendue::material::OrenNayar;
use etendue::measure::Measured;
use etendue::measure::gonio::{
    Gonioreflectometer, Reading, Specimen, Spot, measure_albedo, measure_brdf, measure_lobe,
};
use etendue::measure::report::{Axis, Item, Page, Plot, Point, Section, Series};
use etendue::prelude::*;

type Outcome<T> = Result<T, Box<dyn Error>>;

/// One specimen, and what its material says where the material is all there is.
struct Entry {
    name: &'static str,
    specimen: Specimen<'static>,
    flat: Option<Arc<dyn Material>>,
}

fn main() -> Outcome<()> {
    let (mut size, mut spp, mut out) = (73u32, 512u32, PathBuf::from("."));
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let value = args.next().ok_or(format!("{arg} needs a value"))?;
        match arg.as_str() {
            "--size" => size = value.parse::<u32>()?.max(2),
            "--spp" => spp = value.parse()?,
            "--out" => out = value.into(),
            _ => return Err(format!("unknown option {arg}").into()),
        }
    }
    let by = Gonioreflectometer { samples: spp, runs: 8, ..Gonioreflectometer::default() };

    let metal: Arc<dyn Material> = Arc::new(Metal::gold(0.5));
    let clay: Arc<dyn Material> = Arc::new(OrenNayar::new(Spectrum::gray(0.8), 0.6));
    let entries = [
        Entry { name: "rough gold", specimen: Specimen::flat(metal.clone()), flat: Some(metal) },
        Entry { name: "clay (EON)", specimen: Specimen::flat(clay.clone()), flat: Some(clay.clone()) },
        Entry { name: "grooves of clay", specimen: grooves(clay), flat: None },
    ];
    let mut plots = Vec::new();
    for entry in &entries {
        table(entry, &by)?;
        plots.push(lobes(entry, size, &by)?);
    }

    let page = Page {
        title: "Measured reflection".into(),
        lead: vec!["BRDF, green channel, in the plane of incidence: the distance from the origin.".into()],
        sections: vec![Section::new("Lobes", [Item::Plots(plots)])],
        ..Page::default()
    };
    let to = out.join("gonioreflectometer.html");
    std::fs::write(&to, page.html())?;
    println!("wrote {}", to.display());
    Ok(())
}

/// V-grooves along y with sides of 45°, ridges at z = 0. The spot is one period, so that it stands for all.
fn grooves(material: Arc<dyn Material>) -> Specimen<'static> {
    let frame = Frame { x: Vec3A::X, y: Vec3A::Y, z: Vec3A::Z };
    Specimen::new(Spot::rectangle(Vec3A::ZERO, frame, Vec2::ONE), move |b| {
        let material = b.material_arc(material.clone());
        let along = Vec3A::Y * 2000.0;
        for k in -4..=4 {
            let bottom = Vec3A::new(2.0 * k as f32, -1000.0, -1.0);
            b.add(meshes::quad(bottom, along, Vec3A::new(-1.0, 0.0, 1.0)), material);
            b.add(meshes::quad(bottom, Vec3A::new(1.0, 0.0, 1.0), along), material);
        }
    })
}

/// In the plane y = 0, at so many degrees from the normal, toward −x if negative.
fn direction(theta_deg: f32) -> Vec3A {
    let (sin, cos) = etendue::core::math::sin_cos(theta_deg.to_radians());
    Vec3A::new(sin, 0.0, cos)
}

fn table(entry: &Entry, by: &Gonioreflectometer) -> Outcome<()> {
    println!("{}", entry.name);
    println!("     θi    θo   measured, sr⁻¹ (green)     material");
    for theta_i in [0.0, 30.0, 60.0] {
        for theta_o in [-60.0, -30.0, 0.0, 30.0, 60.0] {
            let (wi, wo) = (direction(theta_i), direction(theta_o));
            let r = measure_brdf(&entry.specimen, wi, wo, by)?;
            let truth = entry.flat.as_deref().map(|m| value(m, wi, wo));
            let truth = truth.map_or("-".into(), |t| format!("{t:.5}"));
            println!("   {theta_i:4}°  {theta_o:4}°   {:<24}   {truth:>8}", with_interval(&r.rgb[1]));
        }
    }
    let albedo = measure_albedo(&entry.specimen, Vec3A::Z, by)?[1];
    println!("   albedo from the normal: {}\n", with_interval(&albedo));
    Ok(())
}

/// The material's own BRDF, green.
fn value(material: &dyn Material, wi: Vec3A, wo: Vec3A) -> f32 {
    let at = Surface::new(Vec3A::ZERO, Vec3A::ZERO, Vec3A::Z);
    material.bsdf(&at).eval(wo, wi, Mode::Radiance).g() / wi.z
}

fn with_interval(m: &Measured) -> String {
    let [low, high] = m.bounds();
    format!("{:.5} ± {:.5}", m.value, 0.5 * (high - low))
}

/// The lobes under three directions of light, each point as far from the origin as the BRDF is large there.
fn lobes(entry: &Entry, size: u32, by: &Gonioreflectometer) -> Outcome<Plot> {
    let wo: Vec<Vec3A> = (0..size).map(|k| direction(-85.0 + 170.0 * k as f32 / (size - 1) as f32)).collect();
    let mut series = Vec::new();
    for theta_i in [0.0, 30.0, 60.0] {
        let readings = measure_lobe(&entry.specimen, direction(theta_i), &wo, by)?;
        series.push(Series {
            name: format!("light at {theta_i}°"),
            points: readings.iter().map(polar).collect(),
            ..Series::default()
        });
    }
    Ok(Plot {
        title: entry.name.into(),
        x: Axis::linear("f sin θ, sr⁻¹"),
        y: Axis::linear("f cos θ, sr⁻¹"),
        series,
        ..Plot::default()
    })
}

fn polar(r: &Reading) -> Point {
    let m = &r.rgb[1];
    let [x, y] = [r.wo.x, r.wo.z].map(|c| f64::from(c) * m.value);
    Point { label: with_interval(m), ..Point::new(x, y) }
}
