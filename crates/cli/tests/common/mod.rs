//! A folder with a scene in it, and the program run there.
#![allow(dead_code)]

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

use serde_json::Value;

/// A box with a lamp, a mirror and a ball's worth of corners: enough to scatter in.
const OBJ: &str = "mtllib a.mtl
v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1
v -1 2 -1\nv 1 2 -1\nv 1 2 1\nv -1 2 1
v -0.3 1.99 -0.3\nv 0.3 1.99 -0.3\nv 0.3 1.99 0.3\nv -0.3 1.99 0.3
usemtl white\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nusemtl red\nf 1 5 8 4\nusemtl green\nf 2 3 7 6
usemtl lamp\nf 9 10 11 12\n";
const MTL: &str = "newmtl white\nKd 0.7 0.7 0.7\nnewmtl red\nKd 0.6 0.1 0.1\nnewmtl green\nKd 0.1 0.6 0.1
newmtl lamp\nKd 0 0 0\nKe 12 12 10\n";

pub(crate) struct Bench(PathBuf);

impl Bench {
    pub(crate) fn new(name: &str) -> Self {
        static COUNTER: AtomicU32 = AtomicU32::new(0);
        let n = COUNTER.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("etendue-cli-{name}-{}-{n}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a temporary folder");
        let bench = Self(path);
        bench.write("a.obj", OBJ);
        bench.write("a.mtl", MTL);
        bench
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub(crate) fn folder(&self) -> &Path {
        &self.0
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).expect("a file");
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}; there are {:?}", self.names()))
    }

    pub(crate) fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.bytes(name)).expect("JSON")
    }

    pub(crate) fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).expect("the folder");
        let mut names: Vec<String> =
            entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    fn command(&self, words: &str) -> Command {
        let mut c = Command::new(env!("CARGO_BIN_EXE_etendue"));
        c.current_dir(&self.0).args(words.split_whitespace()).stdin(Stdio::null());
        c
    }

    /// Runs to the end.
    pub(crate) fn run(&self, words: &str) -> Output {
        self.command(words).output().expect("the program runs")
    }

    /// Runs to an end that must be good; gives standard output and standard error.
    pub(crate) fn good(&self, words: &str) -> [String; 2] {
        let out = self.run(words);
        let [stdout, stderr] = [&out.stdout, &out.stderr].map(|b| String::from_utf8_lossy(b).into_owned());
        assert!(out.status.success(), "{words}: {:?}\n{stdout}\n{stderr}", out.status);
        [stdout, stderr]
    }

    /// Runs to an end that must be bad with this status; gives standard error.
    pub(crate) fn bad(&self, words: &str, status: i32) -> String {
        let out = self.run(words);
        let stderr = String::from_utf8_lossy(&out.stderr).into_owned();
        assert_eq!(out.status.code(), Some(status), "{words}: {stderr}");
        assert!(!stderr.contains("panicked"), "{words}: {stderr}");
        stderr
    }

    pub(crate) fn spawn(&self, words: &str) -> Child {
        self.command(words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts")
    }
}

impl Drop for Bench {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

pub(crate) fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([&format!("-{name}"), &child.id().to_string()]).status();
    assert!(sent.is_ok_and(|s| s.success()), "kill -{name}");
}
