//! Damaged files: any bytes give a scene or a typed error, never a panic.
#![cfg(feature = "obj")]

mod common;

use common::Files;
use etendue_io::Limits;
use etendue_io::obj::read;
use etendue_scene::SceneBuilder;
use proptest::prelude::*;

const OBJ: &str = "# a comment\nmtllib a.mtl b.mtl\no thing\nv 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0 1\nv 2 2 2\n\
vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nvn 0.6 0 0.8\ng one two\nusemtl red\ns off\nf 1/1/1 2/2/1 3/3/2 4/4/2\n\
usemtl glow\nf -1//-1 -2//-1 -3//-2\nl 1 2 3\np 1\nusemtl glass\nf 1 2 \\\n 3\nf 1/1 2/2 3/3 4/4 5/1\n";

const COLORED: &str = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n";

const MTL: &str = "newmtl red\nKa 0 0 0\nKd 0.8 0.1 0.1\nKs 0.5 0.5 0.5\nNs 20\nNi 1.5\nd 0.9\nillum 2\n\
map_Kd -s 1 1 1 wood.png\nmap_Bump -bm 0.2 bump.png\nmap_d holes.png\n\nnewmtl glow\nKe 4 4 3\nTr 0.2\n\
newmtl glass\nillum 4\nNi 1.5\nnewmtl metal\nPr 0.3\nPm 1\n";

/// What damage does to bytes.
#[derive(Clone, Debug)]
enum Damage {
    Set(u8),
    Insert(u8),
    Remove(usize),
    Repeat(usize),
    Swap(usize),
    Put(&'static str),
    /// The word or number there becomes another.
    Word(&'static str),
}

const WORDS: [&str; 12] = [
    "-9",
    "-3",
    "0",
    "9",
    "-9223372036854775808",
    "9223372036854775807",
    "99999999999999999999",
    "nan",
    "-inf",
    "1e39",
    "x",
    "",
];

const PUT: [&str; 16] = [
    "99999999999999999999",
    "-9223372036854775808",
    "9223372036854775807",
    "/",
    "//",
    " -1/-1/-1",
    "nan",
    "-inf",
    "1e39",
    "\nusemtl\n",
    "\nnewmtl\n",
    "\nmap_Kd\n",
    "\\\n",
    "\r",
    "\u{3000}",
    "\nKd 1\nKe 1 2\n",
];

fn damage() -> impl Strategy<Value = Vec<(prop::sample::Index, Damage)>> {
    let one = prop_oneof![
        1 => any::<u8>().prop_map(Damage::Set),
        1 => any::<u8>().prop_map(Damage::Insert),
        1 => (1usize..40).prop_map(Damage::Remove),
        1 => (1usize..40).prop_map(Damage::Repeat),
        1 => (1usize..40).prop_map(Damage::Swap),
        1 => prop::sample::select(&PUT[..]).prop_map(Damage::Put),
        4 => prop::sample::select(&WORDS[..]).prop_map(Damage::Word),
    ];
    prop::collection::vec((any::<prop::sample::Index>(), one), 1..6)
}

fn damaged(bytes: &str, damage: &[(prop::sample::Index, Damage)]) -> Vec<u8> {
    let mut out = bytes.as_bytes().to_vec();
    for (at, what) in damage {
        if out.is_empty() {
            break;
        }
        let at = at.index(out.len());
        let until = |n: usize| (at + n).min(out.len());
        match what {
            Damage::Set(b) => out[at] = *b,
            Damage::Insert(b) => out.insert(at, *b),
            Damage::Remove(n) => drop(out.drain(at..until(*n))),
            Damage::Repeat(n) => {
                let part = out[at..until(*n)].to_vec();
                out.splice(at..at, part);
            }
            Damage::Swap(n) => {
                let end = until(*n) - 1;
                out.swap(at, end);
            }
            Damage::Put(text) => drop(out.splice(at..at, text.bytes())),
            Damage::Word(text) => {
                let ends = |b: &u8| b.is_ascii_whitespace() || *b == b'/';
                let start = out[..at].iter().rposition(ends).map_or(0, |i| i + 1);
                let end = out[at..].iter().position(ends).map_or(out.len(), |i| at + i).max(start);
                out.splice(start..end, text.bytes());
            }
        }
    }
    out
}

/// Loads and builds. An error must name its file.
fn load(obj: &[u8], mtl: &[u8]) -> Result<(), TestCaseError> {
    let files = Files::default().with("a.mtl", mtl).with("b.mtl", mtl).with("wood.png", "not a picture");
    let mut b = SceneBuilder::new();
    match read("fuzzed.obj", obj, &files, &Limits::default(), &mut b) {
        Ok(report) => {
            prop_assert!(report.triangles > 0);
            prop_assert!(b.build().is_ok(), "what loads builds");
        }
        Err(e) => prop_assert!(e.to_string().contains("fuzzed.obj"), "{e}"),
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, rng_seed: proptest::test_runner::RngSeed::Fixed(7), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_geometry_never_panics(damage in damage()) {
        load(&damaged(OBJ, &damage), MTL.as_bytes())?;
    }

    #[test]
    fn damaged_colours_never_panic(damage in damage()) {
        load(&damaged(COLORED, &damage), MTL.as_bytes())?;
    }

    #[test]
    fn damaged_materials_never_panic(damage in damage()) {
        load(OBJ.as_bytes(), &damaged(MTL, &damage))?;
    }

    #[test]
    fn any_bytes_never_panic(obj in prop::collection::vec(any::<u8>(), 0..400), mtl in prop::collection::vec(any::<u8>(), 0..400)) {
        load(&obj, &mtl)?;
    }
}

#[test]
fn the_undamaged_files_load() {
    for obj in [OBJ, COLORED] {
        load(obj.as_bytes(), MTL.as_bytes()).unwrap();
    }
    let files = Files::default().with("a.mtl", MTL);
    let report = read("a.obj", OBJ.as_bytes(), &files, &Limits::default(), &mut SceneBuilder::new()).unwrap();
    assert_eq!(
        (report.triangles, report.has_light),
        (2 + 1 + 1 + 3, true),
        "so that the damage has something to hit"
    );
}
