//! Renders that are stopped: what is there is written, or nothing is harmed.
#![cfg(unix)]

mod common;

use std::time::Duration;

use common::{Bench, signal};
use etendue::SystemClock;
use etendue::core::Clock;
use etendue::io::{Limits, read_film, read_picture};

#[test]
fn ctrl_c_writes_what_is_there() {
    let b = Bench::new("int");
    for (name, after) in [("INT", 300), ("TERM", 700)] {
        let mut child =
            b.spawn("render a.obj -o x.png -o x.exr -o x.film --size 300x200 --spp 1000000 --json r.json");
        std::thread::sleep(Duration::from_millis(after));
        signal(&child, name);
        let asked = SystemClock::default();
        let status = child.wait().expect("it ends");
        assert!(asked.seconds() < 5.0, "{} s", asked.seconds());
        let out = child.wait_with_output().expect("its words");
        let stderr = String::from_utf8_lossy(&out.stderr);
        assert_eq!(status.code(), Some(130), "{stderr}");
        assert!(stderr.contains("interrupted; written with") && stderr.contains("x.film"), "{stderr}");
        assert!(out.stdout.is_empty());
        let r = b.json("r.json");
        assert_eq!(r["ended"], "interrupted");
        let film = read_film(&b.path("x.film"), &Limits::default()).expect("whole passes");
        assert_eq!(r["spp"], film.info().samples.count());
        read_picture(&b.path("x.png"), &Limits::default()).expect("a picture");
        read_picture(&b.path("x.exr"), &Limits::default()).expect("a picture");
    }
    // The film goes on, bit for bit.
    let film = read_film(&b.path("x.film"), &Limits::default()).expect("a film");
    let more = film.info().samples.count() + 3;
    b.good(&format!("render a.obj -o on.film --size 300x200 --spp {more} --resume x.film"));
    b.good(&format!("render a.obj -o whole.film --size 300x200 --spp {more}"));
    assert_eq!(b.bytes("on.film"), b.bytes("whole.film"));
    assert!(!b.names().iter().any(|n| n.ends_with(".part") || n.ends_with(".trial")), "{:?}", b.names());
}

#[test]
fn a_kill_leaves_the_old_file_or_the_new() {
    let b = Bench::new("kill");
    b.good("render a.obj -o x.film -o x.exr --size 120x80 --spp 1 --seed 1");
    let old = [b.bytes("x.film"), b.bytes("x.exr")];
    for k in 0..20u64 {
        let mut child = b.spawn("render a.obj -o x.film -o x.exr --size 120x80 --spp 2 --seed 2");
        std::thread::sleep(Duration::from_millis(k * 7));
        let _ = child.kill();
        let _ = child.wait();
        let film = read_film(&b.path("x.film"), &Limits::default()).expect("old or new");
        let seed = film.info().words.get("seed").cloned();
        assert!(seed.as_deref() == Some("2") || b.bytes("x.film") == old[0]);
        read_picture(&b.path("x.exr"), &Limits::default()).expect("old or new");
    }
}

#[test]
fn nothing_is_written_where_nothing_was_finished() {
    let b = Bench::new("early");
    // A first pass that takes far longer than the patience.
    let child = b.spawn("render a.obj -o x.film --size 2400x1600 --spp 4");
    std::thread::sleep(Duration::from_millis(600));
    signal(&child, "INT");
    let out = child.wait_with_output().expect("its words");
    let stderr = String::from_utf8_lossy(&out.stderr);
    assert_eq!(out.status.code(), Some(130), "{stderr}");
    assert!(stderr.contains("interrupted; nothing was"), "{stderr}");
    assert_eq!(b.names(), ["a.mtl", "a.obj"]);
}

#[test]
fn the_second_ctrl_c_ends_at_once() {
    let b = Bench::new("twice");
    let child = b.spawn("render a.obj -o x.exr --size 1200x900 --spp 1000000");
    std::thread::sleep(Duration::from_millis(700));
    signal(&child, "INT");
    std::thread::sleep(Duration::from_millis(30));
    // It may have ended by itself already.
    let _ = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    let asked = SystemClock::default();
    let out = child.wait_with_output().expect("its words");
    assert_eq!(out.status.code(), Some(130));
    assert!(asked.seconds() < 2.0, "{} s", asked.seconds());
    assert!(String::from_utf8_lossy(&out.stderr).contains("once more"));
}
