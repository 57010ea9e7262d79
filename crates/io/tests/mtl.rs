//! MTL files: what becomes of materials and textures.
#![cfg(feature = "obj")]

mod common;

use common::{Files, Folder};
use etendue_bsdf::{Bsdf, BsdfAt};
use etendue_core::{Needs, Ray, Spectrum, Vec3A};
use etendue_io::Limits;
use etendue_io::obj::{ObjReport, load, read};
use etendue_scene::{Scene, SceneBuilder};

const MESH: &str =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n";

fn with(mtl: &str) -> (ObjReport, Scene) {
    with_files(MESH, &Files::default().with("a.mtl", mtl), &Limits::default())
}

fn with_files(text: &str, files: &Files, limits: &Limits) -> (ObjReport, Scene) {
    let mut b = SceneBuilder::new();
    let report =
        read("a.obj", text.as_bytes(), files, limits, &mut b).expect("geometry is read whatever the colours");
    (report, b.build().expect("builds"))
}

/// The scattering at a point of the triangle.
fn at<R>(scene: &Scene, x: f32, y: f32, f: impl FnOnce(&BsdfAt<'_>) -> R) -> R {
    let ray = Ray::new(Vec3A::new(x, y, 1.0), Vec3A::NEG_Z);
    let hit = scene.accel().intersect(&ray).expect("the triangle");
    let surface = scene.surface(&ray, &hit, 0.0);
    f(&scene.material(&surface).expect("its material").bsdf(&surface))
}

fn albedo(scene: &Scene) -> Spectrum {
    at(scene, 0.3, 0.3, |b| b.albedo(Vec3A::Z))
}

fn png(width: u32, height: u32, rgb: impl Fn(u32, u32) -> [u8; 3]) -> Vec<u8> {
    let image = image::RgbImage::from_fn(width, height, |x, y| image::Rgb(rgb(x, y)));
    let mut out = std::io::Cursor::new(Vec::new());
    image.write_to(&mut out, image::ImageFormat::Png).expect("a picture");
    out.into_inner()
}

#[test]
fn colours_of_three_numbers_or_one() {
    let (report, scene) = with("newmtl m\nKd 0.1 0.2 0.3\n");
    assert_eq!(albedo(&scene), Spectrum::rgb(0.1, 0.2, 0.3));
    assert_eq!(report.warnings, Vec::<String>::new());
    assert_eq!(albedo(&with("newmtl m\nKd 0.5\n").1), Spectrum::gray(0.5));
    assert_eq!(albedo(&with("newmtl m\r\nKd 0.5\r\n").1), Spectrum::gray(0.5));
    assert_eq!(albedo(&with("\u{feff}newmtl m\nKd 0.5\n").1), Spectrum::gray(0.5));
    // Out of range is brought into it.
    assert_eq!(albedo(&with("newmtl m\nKd 2 nan -1\n").1), Spectrum::rgb(1.0, 0.0, 0.0));
}

#[test]
fn bad_lines_are_skipped_with_their_place() {
    let mtl = "newmtl m\nKd 0.1 0.2\nKd 0.25\nNs\nillum 99999999999\nmap_Kd\nKs spectral a.rfl\n";
    let (report, scene) = with(mtl);
    assert_eq!(albedo(&scene), Spectrum::gray(0.25));
    for line in [2, 4, 5, 6, 7] {
        let place = format!("a.mtl, line {line}: ");
        assert!(report.warnings.iter().any(|w| w.starts_with(&place)), "{line}: {:?}", report.warnings);
    }
    assert_eq!(report.warnings.len(), 5, "{:?}", report.warnings);
}

#[test]
fn missing_files_and_names_are_warnings() {
    let (report, scene) = with_files(MESH, &Files::default(), &Limits::default());
    assert!(report.warnings[0].contains("'a.mtl' cannot be opened"), "{:?}", report.warnings);
    assert_eq!(albedo(&scene), Spectrum::gray(0.6));
    let (report, scene) = with("newmtl other\nKd 1 0 0\n");
    assert!(
        report.warnings[0].contains("a.obj, line 8") && report.warnings[0].contains("'m'"),
        "{:?}",
        report.warnings
    );
    assert_eq!(albedo(&scene), Spectrum::gray(0.6));
}

#[test]
fn names_with_spaces_tabs_or_none_at_all() {
    let red = "newmtl my red\nKd 1 0 0\n";
    for (text, file, mtl) in [
        (MESH.replace("usemtl m", "usemtl\t my red  "), "a.mtl", red),
        (
            MESH.replace("mtllib a.mtl", "mtllib\tmy colours.mtl").replace("usemtl m", "usemtl my red"),
            "my colours.mtl",
            red,
        ),
        (
            MESH.replace("a.mtl", "my\\ colours.mtl").replace("usemtl m", "usemtl my red"),
            "my colours.mtl",
            red,
        ),
        (MESH.replace("usemtl m", "usemtl"), "a.mtl", "newmtl\nKd 1 0 0\n"),
    ] {
        let (report, scene) = with_files(&text, &Files::default().with(file, mtl), &Limits::default());
        assert_eq!(albedo(&scene), Spectrum::rgb(1.0, 0.0, 0.0), "{text}");
        assert!(report.warnings.is_empty(), "{:?}", report.warnings);
    }
}

#[test]
fn several_libraries_on_one_line() {
    let files = Files::default().with("a.mtl", "newmtl x\nKd 0 1 0\n").with("b.mtl", "newmtl m\nKd 1 0 0\n");
    let (report, scene) = with_files(&MESH.replace("a.mtl", "a.mtl b.mtl"), &files, &Limits::default());
    assert_eq!(albedo(&scene), Spectrum::rgb(1.0, 0.0, 0.0));
    assert!(report.warnings.is_empty(), "{:?}", report.warnings);
    let (report, _) = with_files(&MESH.replace("a.mtl", "c.mtl b.mtl"), &files, &Limits::default());
    assert!(report.warnings.len() == 1 && report.warnings[0].contains("'c.mtl'"), "{:?}", report.warnings);
}

#[test]
fn emission_makes_a_light() {
    let (report, scene) = with("newmtl m\nKd 0.5\nKe 3 2 1\n");
    assert!(report.has_light);
    assert_eq!(scene.lights().len(), 1);
    let ray = Ray::new(Vec3A::new(0.2, 0.2, 1.0), Vec3A::NEG_Z);
    let surface = scene.surface(&ray, &scene.intersect(&ray, 0).unwrap(), 0.0);
    let id = scene.light_at(&surface).unwrap();
    assert_eq!(scene.emitted(id, &surface, Vec3A::Z), Spectrum::rgb(3.0, 2.0, 1.0));
    assert_eq!(scene.emitted(id, &surface, Vec3A::NEG_Z), Spectrum::BLACK, "from the front only");
    for dark in ["Ke 0 0 0", "Ke -1 -2 -3", "Ke nan nan nan", "Ke 1"] {
        let expected = dark == "Ke 1";
        assert_eq!(with(&format!("newmtl m\n{dark}\n")).0.has_light, expected, "{dark}");
    }
    // A light with holes is refused by scenes; the loader keeps the light and says so.
    let (report, scene) = with("newmtl m\nKe 1 1 1\nd 0.5\n");
    assert!(report.has_light && !scene.needs().contains(Needs::CUTOUTS));
    assert!(report.warnings[0].contains("'m' emits light"), "{:?}", report.warnings);
}

#[test]
fn models_of_illumination() {
    assert!(at(
        &with("newmtl m\nillum 4\nNi 1.33\n").1,
        0.3,
        0.3,
        |b| matches!(b, BsdfAt::SmoothDielectric(g) if g.eta == 1.33)
    ));
    // An index that is none of glass's becomes window glass.
    for ni in ["0", "1", "-3", "nan", "inf"] {
        let mtl = format!("newmtl m\nillum 7\nNi {ni}\n");
        assert!(
            at(&with(&mtl).1, 0.3, 0.3, |b| matches!(b, BsdfAt::SmoothDielectric(g) if g.eta == 1.5)),
            "{ni}"
        );
    }
    let (_, mirror) = with("newmtl m\nillum 3\nKd 0 0 0\nKs 0.9 0.8 0.7\n");
    assert!(at(
        &mirror,
        0.3,
        0.3,
        |b| matches!(b, BsdfAt::Mirror(m) if m.reflectance == Spectrum::rgb(0.9, 0.8, 0.7))
    ));
    let (_, metal) = with("newmtl m\nKd 0.9 0.7 0.3\nPm 1\nPr 0.4\n");
    assert!(at(&metal, 0.3, 0.3, |b| matches!(b, BsdfAt::Conductor(_))));
    let (report, _) = with("newmtl m\nKd 0.5\nKs 0.5 0.5 0.5\nNs 10\n");
    assert!(report.warnings[0].contains("'m'") && report.warnings[0].contains("Ks"), "{:?}", report.warnings);
}

#[test]
fn dissolve_and_transparency_are_two_words_for_one_thing() {
    for mtl in ["newmtl m\nd 0.25\n", "newmtl m\nTr 0.75\n"] {
        let (_, scene) = with(mtl);
        assert!(scene.needs().contains(Needs::CUTOUTS), "{mtl}");
        let ray = Ray::new(Vec3A::new(0.2, 0.2, 1.0), Vec3A::NEG_Z);
        let hits =
            (0..4000u32).filter(|i| scene.intersect(&ray, i.wrapping_mul(0x9e37_79b9)).is_some()).count();
        // 5 standard errors around a quarter.
        assert!((hits as f64 - 1000.0).abs() < 137.0, "{mtl}: {hits}");
    }
    for solid in ["d 1", "d 2", "d nan", "Tr 0", "Tr -1"] {
        assert!(!with(&format!("newmtl m\n{solid}\n")).1.needs().contains(Needs::CUTOUTS), "{solid}");
    }
}

#[test]
fn textures_are_decoded_as_srgb_and_stand_upright() {
    // Red above, green below.
    let picture = png(2, 2, |_, y| if y == 0 { [188, 0, 0] } else { [0, 255, 0] });
    let files = Files::default()
        .with("a.mtl", "newmtl m\nmap_Kd -clamp on my wood.png\n")
        .with("my wood.png", picture);
    let (report, scene) = with_files(MESH, &files, &Limits::default());
    assert_eq!(report.warnings, Vec::<String>::new());
    assert!(scene.needs().contains(Needs::TEXTURES));
    // v = 0.25 in the file is the lower half of the picture, at a texel's middle.
    let low = at(&scene, 0.25, 0.25, |b| b.albedo(Vec3A::Z));
    assert_eq!(low, Spectrum::rgb(0.0, 1.0, 0.0));
    let high = at(&scene, 0.125, 0.75, |b| b.albedo(Vec3A::Z));
    // (188/255 + 0.055) / 1.055 to the 2.4.
    assert!((high.r() - 0.502_886).abs() < 1e-5 && high.g() == 0.0, "{high:?}");
}

#[test]
fn opacity_textures_are_numbers_not_colours() {
    let files = Files::default()
        .with("a.mtl", "newmtl m\nmap_d holes.png\nmap_Kd holes.png\n")
        .with("holes.png", png(1, 1, |_, _| [51, 51, 51]));
    let (_, scene) = with_files(MESH, &files, &Limits::default());
    let ray = Ray::new(Vec3A::new(0.2, 0.2, 1.0), Vec3A::NEG_Z);
    let hits = (0..4000u32).filter(|i| scene.intersect(&ray, i.wrapping_mul(0x9e37_79b9)).is_some()).count();
    // 51/255 is a fifth, 5 standard errors of 25; as sRGB it would be a thirtieth.
    assert!((hits as f64 - 800.0).abs() < 127.0, "{hits}");
    let (report, scene) = with("newmtl m\nKd 0.5\nmap_d missing.png\n");
    assert!(report.warnings[0].contains("'missing.png'"), "{:?}", report.warnings);
    assert!(!scene.needs().contains(Needs::CUTOUTS));
}

#[test]
fn textures_that_cannot_be_had_leave_the_colour() {
    let big = png(70, 3, |_, _| [255; 3]);
    let files = Files::default()
        .with("big.png", big)
        .with("bad.png", "this is no picture")
        .with("cut.png", png(8, 8, |x, y| [x as u8, y as u8, 0])[..60].to_vec());
    for (entry, limits, says) in [
        ("map_Kd nowhere.png", Limits::default(), "nowhere.png"),
        ("map_Kd bad.png", Limits::default(), "bad.png"),
        ("map_Kd cut.png", Limits::default(), "cut.png"),
        ("map_Kd big.png", Limits { image_side: 64, ..Limits::default() }, "big.png"),
        ("map_Kd big.png", Limits { image_bytes: 3 * 70 * 3 - 1, ..Limits::default() }, "630 bytes"),
        ("map_Kd big.png", Limits { all_image_bytes: 600, ..Limits::default() }, "630 bytes"),
        ("map_Kd -s", Limits::default(), "''"),
        ("map_Ke glow.png", Limits::default(), "map_Ke"),
        ("map_Bump -bm 2 bump.png", Limits::default(), "map_Bump"),
        ("norm normal.png", Limits::default(), "norm"),
    ] {
        let mut b = SceneBuilder::new();
        let files = Over(&files, format!("newmtl m\nKd 0.25\n{entry}\n"));
        let report = read("a.obj", MESH.as_bytes(), &files, &limits, &mut b).expect("geometry");
        let scene = b.build().expect("builds");
        assert_eq!(albedo(&scene), Spectrum::gray(0.25), "{entry}");
        assert!(
            report.warnings.len() == 1 && report.warnings[0].contains(says),
            "{entry}: {:?}",
            report.warnings
        );
    }
}

/// The files with a material file of its own.
struct Over<'a>(&'a Files, String);

impl etendue_io::Resolver for Over<'_> {
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, etendue_io::ResolveError> {
        if name == "a.mtl" { Ok(self.1.clone().into_bytes()) } else { self.0.read(name, limit) }
    }
}

#[test]
fn a_texture_is_decoded_once_and_materials_are_made_on_demand() {
    let mtl = "newmtl a\nmap_Kd t.png\nnewmtl b\nmap_Kd t.png\nnewmtl unused\nmap_Kd missing.png\n";
    let files = Files::default().with("a.mtl", mtl).with("t.png", png(16, 16, |_, _| [9, 9, 9]));
    let text =
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl a\nf 1 2 3\n";
    // Room for one picture, not for two.
    let limits = Limits { all_image_bytes: 16 * 16 * 4, ..Limits::default() };
    let (report, _) = with_files(text, &files, &limits);
    assert_eq!((report.materials, report.meshes), (2, 3));
    assert_eq!(report.warnings, Vec::<String>::new());
}

#[test]
fn files_on_disk_are_found_beside_the_scene() {
    let folder = Folder::new("beside");
    let path = folder.write("scenes/a.obj", MESH);
    folder.write("scenes/a.mtl", "newmtl m\nmap_Kd maps\\wood.png\n");
    folder.write("scenes/maps/wood.png", png(1, 1, |_, _| [255, 0, 0]));
    let mut b = SceneBuilder::new();
    let report = load(&path, &Limits::default(), &mut b).unwrap();
    assert_eq!(report.warnings, Vec::<String>::new());
    assert_eq!(albedo(&b.build().unwrap()), Spectrum::rgb(1.0, 0.0, 0.0));
}
