//! The vocabulary of the tables in `core_types` and `extension_types`.

/// What an index points into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    /// An array at the root of the document.
    Root(&'static str),
    /// An array in an extension at the root: its name, the array.
    Extension(&'static str, &'static str),
}

/// The range of a number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub from: f64,
    pub to: f64,
    /// Whether `from` itself is out.
    pub above: bool,
    /// Whether `to` itself is out.
    pub below: bool,
    /// Whether 0 is in even so.
    pub or_zero: bool,
}

/// Any number.
pub(super) const ANY: Range =
    Range { from: f64::NEG_INFINITY, to: f64::INFINITY, above: false, below: false, or_zero: false };
/// 0 to 1.
pub(super) const UNIT: Range = Range { from: 0.0, to: 1.0, ..ANY };
/// -1 to 1.
pub(super) const SIGNED_UNIT: Range = Range { from: -1.0, to: 1.0, ..ANY };
/// 0 and more.
pub(super) const NOT_NEGATIVE: Range = Range { from: 0.0, ..ANY };
/// More than 0.
pub(super) const POSITIVE: Range = Range { from: 0.0, above: true, ..ANY };
/// 1 and more.
pub(super) const FROM_ONE: Range = Range { from: 1.0, ..ANY };

impl Range {
    pub(super) fn has(&self, x: f64) -> bool {
        let low = if self.above { x > self.from } else { x >= self.from };
        let high = if self.below { x < self.to } else { x <= self.to };
        x.is_finite() && (low && high || self.or_zero && x == 0.0)
    }
}

impl std::fmt::Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let low = if self.above { "more than" } else { "at least" };
        let high = if self.below { "less than" } else { "at most" };
        if self.or_zero {
            write!(f, "0 or ")?;
        }
        match (self.from.is_finite(), self.to.is_finite()) {
            (true, true) => write!(f, "{low} {} and {high} {}", self.from, self.to),
            (true, false) => write!(f, "{low} {}", self.from),
            (false, true) => write!(f, "{high} {}", self.to),
            (false, false) => write!(f, "finite"),
        }
    }
}

/// What a property must be.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Bool,
    Text,
    /// A string of a list; others are for later versions.
    OneOf(&'static [&'static str]),
    /// Strings, each once.
    Words,
    /// A number of a list; others are for later versions.
    Code(&'static [u64]),
    /// A whole number: least, most, and what it is a multiple of.
    Whole(u64, u64, u64),
    Number(Range),
    /// Numbers: the allowed lengths (none: any but 0).
    Numbers(&'static [usize], Range),
    /// An index into an array.
    Ref(Target),
    /// Indices, each once.
    Refs(Target),
    /// An index into an array of the parent, which is checked elsewhere.
    Local,
    /// Accessors by names.
    Attributes,
    /// Accessors by names, for each morph target.
    Targets,
    Object(&'static Type),
    /// Objects in an array.
    List(&'static Type),
    /// Objects in an array of the root.
    Elements(&'static Type),
}

/// A property.
#[derive(Debug)]
pub(super) struct Field {
    pub name: &'static str,
    pub kind: Kind,
    pub required: bool,
    /// Another property that must be there too.
    pub needs: Option<&'static str>,
}

/// A kind of object.
#[derive(Debug)]
pub(super) struct Type {
    pub name: &'static str,
    /// Whether it has a `name`.
    pub named: bool,
    pub fields: &'static [Field],
}

/// A property that may be left out.
pub(super) const fn may(name: &'static str, kind: Kind) -> Field {
    Field { name, kind, required: false, needs: None }
}

/// A property that must be there.
pub(super) const fn must(name: &'static str, kind: Kind) -> Field {
    Field { name, kind, required: true, needs: None }
}

/// A property that makes no sense without another.
pub(super) const fn with(name: &'static str, kind: Kind, needs: &'static str) -> Field {
    Field { name, kind, required: false, needs: Some(needs) }
}
