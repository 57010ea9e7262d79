use std::fmt;

use super::harmless::harmless;

/// How bad an issue is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Severity {
    /// The specification is broken.
    Error,
    /// Allowed, yet hardly meant.
    Warning,
}

/// One fault of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Issue {
    /// Whether the file is invalid for it.
    pub severity: Severity,
    /// The name that the Khronos validator gives it, or one of the same kind where the validator has none.
    pub code: &'static str,
    /// JSON pointer of its place (RFC 6901; empty for the whole); `@` and a byte offset in the framing of a GLB.
    pub pointer: String,
    /// The value, the limit, and what to do.
    pub message: String,
    /// Whether a static picture can be made all the same.
    pub harmless: bool,
}

impl Issue {
    pub(super) fn error(code: &'static str, pointer: impl fmt::Display, message: String) -> Self {
        let pointer = pointer.to_string();
        let harmless = harmless(code, &pointer);
        Self { severity: Severity::Error, code, pointer, message, harmless }
    }

    pub(super) fn warning(code: &'static str, pointer: impl fmt::Display, message: String) -> Self {
        Self { severity: Severity::Warning, code, pointer: pointer.to_string(), message, harmless: true }
    }
}

impl fmt::Display for Issue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.pointer.is_empty() {
            write!(f, "{} [{}]", self.message, self.code)
        } else {
            write!(f, "{}: {} [{}]", self.pointer, self.message, self.code)
        }
    }
}

/// The place of a value: a chain of steps on the stack, written out only when there is something to say about it.
#[derive(Clone, Copy, Debug)]
pub(super) enum At<'a> {
    Root,
    Key(&'a At<'a>, &'a str),
    Index(&'a At<'a>, usize),
}

impl<'a> At<'a> {
    pub(super) fn key(&'a self, key: &'a str) -> At<'a> {
        At::Key(self, key)
    }

    pub(super) fn index(&'a self, index: usize) -> At<'a> {
        At::Index(self, index)
    }
}

impl fmt::Display for At<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            At::Root => Ok(()),
            At::Key(parent, key) => write!(f, "{parent}/{}", key.replace('~', "~0").replace('/', "~1")),
            At::Index(parent, index) => write!(f, "{parent}/{index}"),
        }
    }
}

/// The issues found so far. A hostile file can have one per byte, so only the first are kept.
#[derive(Default)]
pub(super) struct Report {
    issues: Vec<Issue>,
    more: u64,
    more_errors: bool,
    more_harm: bool,
}

impl Report {
    /// Issues kept.
    pub(super) const KEPT: usize = 1000;

    pub(super) fn error(&mut self, code: &'static str, at: &At<'_>, message: impl FnOnce() -> String) {
        if self.issues.len() < Self::KEPT {
            self.issues.push(Issue::error(code, at, message()));
        } else {
            self.more = self.more.saturating_add(1);
            self.more_errors = true;
            self.more_harm |= !harmless(code, &at.to_string());
        }
    }

    pub(super) fn warning(&mut self, code: &'static str, at: &At<'_>, message: impl FnOnce() -> String) {
        if self.issues.len() < Self::KEPT {
            self.issues.push(Issue::warning(code, at, message()));
        } else {
            self.more = self.more.saturating_add(1);
        }
    }

    pub(super) fn finish(mut self) -> Vec<Issue> {
        if self.more > 0 {
            let message = format!("and {} more; correct the first ones and try again", self.more);
            self.issues.push(Issue {
                severity: if self.more_errors { Severity::Error } else { Severity::Warning },
                code: "MORE_ISSUES",
                pointer: String::new(),
                message,
                harmless: !self.more_harm,
            });
        }
        self.issues
    }
}
