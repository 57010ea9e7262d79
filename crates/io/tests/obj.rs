//! OBJ files, good and bad, line by line.
#![cfg(feature = "obj")]

mod common;

use common::Files;
use etendue_core::{Ray, Vec3A};
use etendue_io::obj::{ObjError, ObjReport, read};
use etendue_io::{Limits, NoFiles};
use etendue_scene::{Scene, SceneBuilder};

fn load(text: impl AsRef<[u8]>) -> Result<(ObjReport, Scene), ObjError> {
    load_with(text, &Limits::default())
}

fn load_with(text: impl AsRef<[u8]>, limits: &Limits) -> Result<(ObjReport, Scene), ObjError> {
    let mut b = SceneBuilder::new();
    let report = read("a.obj", text.as_ref(), &NoFiles, limits, &mut b)?;
    Ok((report, b.build().expect("what loads builds")))
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// How many of four probes along −z hit: at the corner triangle, at the far corner, outside on either side.
fn probes(scene: &Scene) -> [bool; 4] {
    [(0.2, 0.2), (0.8, 0.8), (1.2, 0.2), (-0.2, 0.2)]
        .map(|(x, y)| scene.intersect(&Ray::new(Vec3A::new(x, y, 1.0), Vec3A::NEG_Z), 0).is_some())
}

#[test]
fn a_triangle_is_where_the_file_says() {
    let (report, scene) = load(TRIANGLE).unwrap();
    assert_eq!((report.meshes, report.triangles, report.materials, report.has_light), (1, 1, 1, false));
    assert_eq!(report.warnings, Vec::<String>::new());
    assert_eq!(probes(&scene), [true, false, false, false]);
    assert_eq!(scene.report().triangles, 1);
}

#[test]
fn polygons_are_split() {
    let quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    let (report, scene) = load(format!("{quad}f 1 2 3 4\n")).unwrap();
    assert_eq!(report.triangles, 2);
    assert_eq!(probes(&scene), [true, true, false, false]);
    let (report, scene) = load(format!("{quad}v 0.5 1.5 0\nf 1 2 3 5 4\n")).unwrap();
    assert_eq!(report.triangles, 3);
    assert_eq!(probes(&scene), [true, true, false, false]);
}

#[test]
fn line_ends_continuations_and_comments() {
    let expected = probes(&load(TRIANGLE).unwrap().1);
    for text in [
        TRIANGLE.replace('\n', "\r\n"),
        TRIANGLE.trim_end().to_owned(),
        "v 0 0 0\nv 1 0 0\nv 0 \\\n1 0\nf 1 2 \\\r\n3\n".to_owned(),
        "v 0 0 0 # origin\n  v\t1 0 0\n# C:\\models\\\nv 0 1 0\nf 1 2 3 # the face".to_owned(),
        format!("\u{feff}{TRIANGLE}"),
        "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned(),
    ] {
        let (report, scene) = load(&text).unwrap();
        assert_eq!((report.triangles, probes(&scene)), (1, expected), "{text:?}");
        assert_eq!(report.warnings, Vec::<String>::new(), "{text:?}");
    }
}

#[test]
fn negative_indices_count_back_from_the_line() {
    let text = "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 7 7 7\n";
    let (report, scene) = load(text).unwrap();
    assert_eq!((report.triangles, probes(&scene)), (1, [true, false, false, false]));
}

#[test]
fn attributes_reach_the_surface() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0.6 0.8\nf 1/1/1 2/2/1 3/3/1\n";
    let (_, scene) = load(text).unwrap();
    let ray = Ray::new(Vec3A::new(0.25, 0.5, 1.0), Vec3A::NEG_Z);
    let surface = scene.surface(&ray, &scene.intersect(&ray, 0).unwrap(), 0.0);
    assert!((surface.shading.z - Vec3A::new(0.0, 0.6, 0.8)).length() < 1e-6);
    assert_eq!(surface.ng, Vec3A::Z);
    // Upward in the file, downward in pictures.
    assert!(
        (surface.uv[0].x - 0.25).abs() < 1e-6 && (surface.uv[0].y - 0.5).abs() < 1e-6,
        "{}",
        surface.uv[0]
    );
    let ray = Ray::new(Vec3A::new(0.25, 0.125, 1.0), Vec3A::NEG_Z);
    let surface = scene.surface(&ray, &scene.intersect(&ray, 0).unwrap(), 0.0);
    assert!((surface.uv[0].y - 0.875).abs() < 1e-6, "{}", surface.uv[0]);
}

#[test]
fn attributes_of_some_corners_only_are_dropped_with_a_warning() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0.6 0.8\nf 1//1 2 3\n";
    let (report, scene) = load(text).unwrap();
    assert!(report.warnings.iter().any(|w| w.contains("a.obj") && w.contains("1 normals for 3 vertices")));
    let ray = Ray::new(Vec3A::new(0.2, 0.2, 1.0), Vec3A::NEG_Z);
    assert_eq!(scene.surface(&ray, &scene.intersect(&ray, 0).unwrap(), 0.0).shading.z, Vec3A::Z);
}

#[test]
fn colours_of_some_vertices_are_dropped_with_a_warning() {
    let text = "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let (report, _) = load(text).unwrap();
    assert!(
        report.warnings.iter().any(|w| w.contains("1 of 3 vertices have a colour")),
        "{:?}",
        report.warnings
    );
    let (report, _) = load("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n").unwrap();
    assert!(report.warnings.is_empty(), "{:?}", report.warnings);
}

#[test]
fn lines_points_and_short_faces_are_dropped_with_a_warning() {
    let text = format!("{TRIANGLE}l 1 2 3\np 1 2\nf 1 2\nf 3\nl 2 3\ncurv 0 1 1 2\n");
    let (report, scene) = load(text).unwrap();
    assert_eq!((report.triangles, probes(&scene)), (1, [true, false, false, false]));
    let w = &report.warnings;
    assert_eq!(w.len(), 3, "{w:?}");
    assert!(w[0].contains("line 5 (and 2 more)") && w[0].contains("lines and points"), "{w:?}");
    assert!(w[1].contains("line 7 (and 1 more)") && w[1].contains("three corners"), "{w:?}");
    assert!(w[2].contains("line 10") && w[2].contains("'curv'"), "{w:?}");
}

#[test]
fn objects_and_groups_make_meshes() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\no\nf 1 2 3\ng a b\nf 1 2 3\n  o x\nf 1 2 3\n";
    let (report, _) = load(text).unwrap();
    assert_eq!((report.meshes, report.triangles), (3, 3));
}

/// Every error says which file, which line, what is wrong and what would be right.
#[test]
fn errors_name_file_line_and_cure() {
    for (text, line, what) in [
        ("v 0 0\n", 1, "three numbers"),
        ("\n\nv 1,5 0 0\n", 3, "decimal point"),
        ("v 0x1p3 0 0\n", 1, "three numbers"),
        ("v 0 0 0 0\n", 1, "fourth number is 0"),
        ("v 0 0 0 1 1\n", 1, "six numbers"),
        ("v 0 0 0 1 x 1\n", 1, "six numbers"),
        ("v 0 0 0\nvn 0 0\n", 2, "('vn') needs three"),
        ("v 0 0 0\nvt 0\n", 2, "('vt') needs two"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n", 4, "v//vn"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3.0\n", 4, "v//vn"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3/1/1/1\n", 4, "v//vn"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf /1 2 3\n", 4, "v//vn"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", 4, "count from 1"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\no later\nf 1 2 3\n", 4, "there are 3 in the file"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -4 2 3\n", 4, "there are 3 before this line"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/2 2/1 3/1\n", 5, "texture coordinate 2"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/-9223372036854775808 2/1 3/1\n", 5, "texture coordinate"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//9223372036854775807 2//1 3//1\n", 5, "normal"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n", 4, "v//vn"),
        ("v 0 0 0 \\\n 1 1\n", 1, "six numbers"),
    ] {
        let e = load(text).map(|(r, _)| r).expect_err(text);
        let ObjError::Syntax { file, line: at, what: said, .. } = &e else { panic!("{text:?}: {e:?}") };
        assert_eq!((file.as_str(), *at), ("a.obj", line), "{text:?}: {e}");
        assert!(said.contains(what), "{text:?}: {e}");
        assert!(e.to_string().starts_with(&format!("a.obj, line {line}: ")), "{e}");
    }
}

#[test]
fn a_file_without_faces_is_an_error() {
    for text in ["", "\n\n", "v 0 0 0\n", "l 1 1\n", "# nothing", "\\\n\\\n\\"] {
        let e = load(text).map(|(r, _)| r).expect_err(text);
        assert!(matches!(e, ObjError::NoFaces { .. }), "{text:?}: {e}");
        assert!(e.to_string().starts_with("a.obj: "), "{e}");
    }
}

#[test]
fn vertices_that_are_no_numbers_are_dropped_by_the_scene_and_counted() {
    let (report, scene) =
        load(format!("v nan inf 1e39\n{}f 1 2 3\n", TRIANGLE.replace("1 2 3", "2 3 4"))).unwrap();
    assert_eq!(report.triangles, 2);
    assert_eq!((scene.report().triangles, scene.report().non_finite_triangles), (1, 1));
}

#[test]
fn text_that_is_not_utf8_is_read_with_a_warning() {
    let mut bytes = b"o \xff\xfe\n".to_vec();
    bytes.extend_from_slice(TRIANGLE.as_bytes());
    let (report, _) = load(&bytes).unwrap();
    assert!(report.warnings[0].contains("a.obj, line 1") && report.warnings[0].contains("UTF-8"));
    // A file that is no text at all does not drown the caller in warnings.
    let e = load(vec![0xff; 100_000]).map(|(r, _)| r).expect_err("no faces");
    assert!(matches!(e, ObjError::NoFaces { .. }));
}

#[test]
fn limits_hold() {
    let limits = Limits { line_bytes: 20, ..Limits::default() };
    assert!(load_with(TRIANGLE, &limits).is_ok());
    let e = load_with(format!("{TRIANGLE}# 3456789012345678901\n"), &limits)
        .map(|(r, _)| r)
        .expect_err("too long");
    assert!(matches!(e, ObjError::LineTooLong { line: 5, limit: 20, .. }), "{e}");
    assert!(e.to_string().starts_with("a.obj, line 5: "), "{e}");
    // A line that is long and allowed: a fan of 60,000 triangles.
    let long = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf{}\n", " 1 2 3".repeat(20_000));
    assert_eq!(load(long).unwrap().0.triangles, 59_998);
}

#[test]
fn the_file_limit_holds_for_the_file_and_for_what_it_names() {
    let folder = common::Folder::new("limit");
    let path = folder.write("a.obj", TRIANGLE);
    let limits = Limits { file_bytes: 10, ..Limits::default() };
    let e = etendue_io::obj::load(&path, &limits, &mut SceneBuilder::new()).expect_err("too large");
    assert!(e.to_string().contains("a.obj") && e.to_string().contains("10 bytes"), "{e}");
    let files = Files::default().with("b.mtl", vec![b'#'; 200]);
    let limits = Limits { file_bytes: 100, ..Limits::default() };
    let text = format!("mtllib b.mtl\n{TRIANGLE}");
    let report = read("a.obj", text.as_bytes(), &files, &limits, &mut SceneBuilder::new()).unwrap();
    assert!(
        report.warnings[0].contains("b.mtl") && report.warnings[0].contains("100 bytes"),
        "{:?}",
        report.warnings
    );
}

#[test]
fn a_missing_file_is_named() {
    let e = etendue_io::obj::load("/no/such/a.obj".as_ref(), &Limits::default(), &mut SceneBuilder::new());
    assert!(e.expect_err("missing").to_string().contains("/no/such/a.obj"));
}
