//! IES files, good, cut off and hostile.
#![cfg(feature = "ies")]

use std::f64::consts::PI;

use etendue_core::{Spectrum, Transform, Vec3A};
use etendue_io::Limits;
use etendue_io::ies::{IesError, IesProfile, load, read};
use etendue_light::Light;
use etendue_scene::SceneBuilder;
use proptest::prelude::*;

/// 1000 cd · cos θ downward in steps of 10°, with everything that a file can have.
fn cosine(version: &str, tilt: &str, horizontal: &[u32]) -> String {
    let v: Vec<String> = (0..=9).map(|i| (i * 10).to_string()).collect();
    let h: Vec<String> = horizontal.iter().map(u32::to_string).collect();
    let row: Vec<String> =
        (0..=9).map(|i| format!("{:.6e}", 500.0 * f64::from(i * 10).to_radians().cos())).collect();
    let rows = vec![row.join(" "); h.len()].join("\r\n");
    format!(
        "{version}\r\n[TEST] no. 1\r\n[MANUFAC] \u{e9}tendue works\r\n[MORE] and more\r\nTILT={tilt}\r\n\
1 3141.6 2.0 10 {} 1 1 1.0 -1.0 0\r\n1.25 0.8 42.5\r\n{}\r\n{}\r\n{rows}\r\n",
        h.len(),
        v.join("\r\n"),
        h.join("  "),
    )
}

fn parse(text: &str) -> Result<IesProfile, IesError> {
    read("lamp.ies", text.as_bytes(), &Limits::default())
}

#[test]
fn all_versions_tilts_and_symmetries_are_read() {
    let include = "INCLUDE\r\n1\r\n3\r\n0 90 180\r\n1.0 0.9 0.8";
    let around = [&[0, 90, 180, 270, 360][..], &[0, 90, 180, 270], &[0, 60, 170, 260]];
    for version in ["IESNA:LM-63-1995", "IESNA:LM-63-2002", "IESNA91", "\u{feff}IESNA91", "A lamp of 1986"] {
        for tilt in ["NONE", include, "LAMP.TLT"] {
            for h in [&[0][..], &[0, 45, 90], &[0, 90, 180], &[90, 180, 270]].into_iter().chain(around) {
                let lamp = parse(&cosine(version, tilt, h)).unwrap();
                assert_eq!(lamp.keyword("test"), Some("no. 1"));
                assert_eq!((lamp.keyword("MANUFAC"), lamp.keywords.len()), (Some("étendue works"), 3));
                assert_eq!((lamp.lamps, lamp.lumens_per_lamp, lamp.watts), (1.0, 3141.6, 42.5));
                assert_eq!(lamp.size, [0.3048, -0.3048, 0.0]);
                // Twice 500 by the multiplier, and the factors 1.25 · 0.8 are 1.
                assert!((lamp.table.max() - 1000.0).abs() < 1e-3);
                // π · 1000 lm; linear between 10° steps, it is (π/18)² / 12 less.
                let off = lamp.lumens() / (1000.0 * PI) - 1.0;
                assert!((off + (PI / 18.0).powi(2) / 12.0).abs() < 1e-4, "{off}");
            }
        }
    }
    // No label at all.
    let bare = cosine("", "NONE", &[0]);
    let bare = bare.get(bare.find("TILT").unwrap()..).unwrap();
    assert_eq!(parse(bare).unwrap().keywords, []);
}

/// In 2019 the second factor became a code for how the file came about (1.1 is a measurement by an accredited
/// laboratory): taken for a factor, it makes a tenth more light than there is.
#[test]
fn the_generation_type_is_no_factor() {
    let at = |version: &str, second: &str| {
        let text = format!("{version}\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n0.5 {second} 5\n0 90\n0\n8 0\n");
        parse(&text).map(|l| l.table.max())
    };
    for code in ["1.00001", "1.1", "1.00000", "0"] {
        assert_eq!(at("IES:LM-63-2019", code).unwrap(), 4.0);
    }
    assert_eq!(at("IESNA:LM-63-2002", "1.1").unwrap(), 8.0 * 0.5 * 1.1);
    assert_eq!(at("IESNA91", "0.25").unwrap(), 1.0);
    assert!(at("IESNA91", "0").is_err());
}

/// Where 360° is left out it is 0° again; half a circle from 90° is mirrored at that plane.
#[test]
fn circles_are_closed() {
    let at = |angles: &str, n: usize, rows: &str| {
        let text = format!("IESNA91\nTILT=NONE\n1 -1 1 2 {n} 1 2 0 0 0\n1 1 5\n0 180\n{angles}\n{rows}\n");
        parse(&text).map(|l| l.table)
    };
    let open = at("0 100 200 260", 4, "1 1 2 2 3 3 5 5").unwrap();
    assert_eq!(open.horizontal(), [0.0, 100.0, 200.0, 260.0, 360.0]);
    assert_eq!((open.at(20.0, 310.0), open.at(20.0, 360.0), open.at(20.0, -50.0)), (3.0, 1.0, 3.0));
    let sides = at("90 180 270", 3, "1 1 2 2 3 3").unwrap();
    assert_eq!((sides.at(20.0, 0.0), sides.at(20.0, 90.0), sides.at(20.0, 315.0)), (2.0, 1.0, 2.5));
    // Most of a circle is not one.
    let e = at("0 80 190", 3, "1 1 2 2 3 3").expect_err("a gap of 170 degrees");
    assert!(e.to_string().contains("0, 90, 180 or 360"), "{e}");
}

/// A lamp of 683 cd straight down is 1 W/sr there.
#[test]
fn a_file_lights_a_floor() {
    let text = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0 1 1 5\n0 45 90\n0\n683 683 0\n";
    let lamp = parse(text).unwrap();
    let light = lamp.light(&Transform::translation(Vec3A::Y * 2.0), Spectrum::ONE);
    let s = light.sample(&floor(Vec3A::ZERO), 0, etendue_core::Vec2::ZERO).unwrap();
    assert!((s.li.r() - 0.25).abs() < 1e-6, "{:?}", s.li);
    assert_eq!(lamp.lumens_per_lamp, -1.0);
}

fn floor(p: Vec3A) -> etendue_light::LitPoint {
    let (ng, ns, sides) = (Vec3A::Y, Vec3A::Y, etendue_light::Sides::Same);
    etendue_light::LitPoint { p, p_err: Vec3A::ZERO, ng, ns, sides, time: 0.0 }
}

/// Each thing that can be wrong, with the line it is in and what is said.
#[test]
fn errors_name_the_line() {
    let commas = parse("IESNA91\nTILT=NONE\n1,1000,1,2,1,1,2,0,0,0,1,1,5\n0, 90\n0\n1,,1\n").unwrap();
    assert_eq!(commas.table.values(), [1.0, 1.0]);
    let head = "IESNA:LM-63-1995\n[A] b\nTILT=NONE\n";
    let cases = [
        ("", 1, "TILT="),
        ("LM-63\nTILT=NONE\n", 2, "cut off"),
        ("IESNA:LM-63-2050\nTILT=NONE\n", 1, "first line"),
        ("IESNA:LM-63-1995\n[A] b\n", 2, "TILT="),
        ("IESNA:LM-63-1995\nTILT= \n1\n", 2, "NONE, INCLUDE or"),
        (&format!("{head}1 1000 1 2 1 3 2 0 0 0 1 1 5\n0 90\n0\n1 1\n"), 4, "type C"),
        (&format!("{head}1 1000 1 2 1 1 3 0 0 0 1 1 5\n0 90\n0\n1 1\n"), 4, "unit of lengths"),
        (&format!("{head}1 1000 0 2 1 1 2 0 0 0 1 1 5\n0 90\n0\n1 1\n"), 4, "multiplier"),
        (&format!("{head}1 1000 1 2.5 1 1 2 0 0 0 1 1 5\n0 90\n0\n1 1\n"), 4, "whole number"),
        (&format!("{head}1 1000 1 -2 1 1 2 0 0 0 1 1 5\n0 90\n0\n1 1\n"), 4, "whole number"),
        (&format!("{head}1 1000 1 4000000000 1 1 2 0 0 0 1 1 5\n0 90\n0\n1 1\n"), 4, "more than"),
        (&format!("{head}1 1000 1 36001 36001 1 2 0 0 0 1 1 5\n0 90\n0\n1 1\n"), 6, "does not ascend"),
        (&format!("{head}1 1000 1 2 1 1 2 0 0 0\n1 nan 5\n0 90\n0\n1 1\n"), 5, "no finite number"),
        (&format!("{head}1 1000 1 2 1 1 2 0 0 0\n1 1 5\n0 90\n0\n1 1e39\n"), 8, "no finite number"),
        (&format!("{head}1 1000 1 2 1 1 2 0 0 0\n1 1 5\n0 90\n0\n1\n\n-1\n"), 10, "negative"),
        (&format!("{head}1 1000 1e38 2 1 1 2 0 0 0\n1 1 5\n0 90\n0\n1 1e38\n"), 8, "too large"),
        (&format!("{head}1 1000 1 3 1 1 2 0 0 0\n1 1 5\n0 90\n45\n0\n1 1 1\n"), 7, "does not ascend"),
        (&format!("{head}1 1000 1 2 1 1 2 0 0 0\n1 1 5\n0 200\n0\n1 1\n"), 8, "out of range"),
        (&format!("{head}1 1000 1 2 2 1 2 0 0 0\n1 1 5\n0 90\n0 45\n1 1 1 1\n"), 8, "0, 90, 180 or 360"),
        (&format!("{head}1 1000 1 1 1 1 2 0 0 0\n1 1 5\n0\n0\n1\n"), 8, "two or more"),
        (&format!("{head}1 1000 1 2 0 1 2 0 0 0\n1 1 5\n0 90\n"), 6, "one or more"),
        (&format!("{head}1 1000 1 2 1 1 2 0 0 0\n1 1 5\n0 90\n0\n1\n"), 8, "cut off"),
        (&format!("{head}1 1000 one\n"), 4, "should be a number"),
        ("IESNA91\nTILT=INCLUDE\n1\n99999\n", 4, "more than"),
    ];
    for (text, line, what) in cases {
        match parse(text) {
            Err(IesError::Line { file, line: l, what: w }) => {
                assert!(file == "lamp.ies" && l == line && w.contains(what), "{text:?}: line {l}: {w}");
            }
            other => panic!("{text:?}: {other:?}"),
        }
    }
    let limits = Limits { line_bytes: 64, ..Limits::default() };
    let long = format!("{head}1 1000 1 2 1 1 2 0 0 0 1 1 5\n0 90\n0\n1 {:>90}\n", 1);
    let e = read("lamp.ies", long.as_bytes(), &limits).expect_err("a long line");
    assert!(e.to_string().contains("line 7: the line is longer than 64"), "{e}");
    assert!(matches!(
        load(std::path::Path::new("no such file.ies"), &Limits::default()),
        Err(IesError::File(_))
    ));
}

/// Cut off anywhere, a file is an error, never half a lamp; only blanks at the end do not matter, and the last digits.
#[test]
fn every_shorter_file_is_an_error() {
    let text = cosine("IESNA:LM-63-2002", "NONE", &[0, 90]);
    let whole = parse(&text).unwrap();
    let mut good = 0;
    for n in 0..text.len() {
        if let Some(part) = text.get(..n)
            && let Ok(lamp) = parse(part)
        {
            assert!(n + 15 > text.len(), "{n} of {} bytes", text.len());
            assert_eq!(lamp.table.vertical(), whole.table.vertical());
            good += 1;
        }
    }
    assert!(good > 0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, rng_seed: proptest::test_runner::RngSeed::Fixed(8), failure_persistence: None, ..ProptestConfig::default() })]

    /// Any damage gives a sound lamp or a typed error.
    #[test]
    fn damaged_files_are_lamps_or_errors(
        version in prop::sample::select(vec!["IESNA:LM-63-1995", "IESNA91", "IES:LM-63-2019", "a lamp"]),
        tilt in prop::sample::select(vec!["NONE", "INCLUDE\n1 1 0 1", "lamp.tlt"]),
        angles in prop::sample::select(vec![&[0u32, 45, 90][..], &[0], &[90, 270], &[0, 100, 200, 300]]),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0u32..4), 1..6),
        words in prop::collection::vec((any::<prop::sample::Index>(), prop::sample::select(vec![
            "-1", "0", "1e39", "nan", "-inf", "4294967296", "99999999999999999999", "x", "36001", "",
        ])), 0..3),
    ) {
        let mut text: Vec<String> = cosine(version, tilt, angles).split(' ').map(String::from).collect();
        for (at, word) in words {
            let i = at.index(text.len());
            text[i] = word.into();
        }
        let mut bytes = text.join(" ").into_bytes();
        for (at, value, kind) in damage {
            let i = at.index(bytes.len());
            match kind {
                0 => bytes[i] = value,
                1 => bytes.insert(i, value),
                2 => { bytes.remove(i); }
                _ => bytes.truncate(i.max(8)),
            }
        }
        if let Ok(lamp) = read("damaged", &bytes, &Limits::default()) {
            prop_assert!(lamp.lumens().is_finite() && lamp.lumens() >= 0.0);
            let light = lamp.light(&Transform::IDENTITY, Spectrum::ONE);
            prop_assert!(light.power(0, 1.0).to_array().iter().all(|p| *p >= 0.0 && p.is_finite()));
            let mut b = SceneBuilder::new();
            b.light(light);
            prop_assert!(b.build().is_ok());
        }
    }
}
