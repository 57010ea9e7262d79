//! The JSON schema level: every property against the tables.

use std::collections::{HashMap, HashSet};

use serde_json::{Map, Value};

use super::core_types::ROOT;
use super::extension_types::{EXTENSIONS, NEVER_OPTIONAL, WITHOUT_OBJECTS};
use super::kinds::{Kind, Range, Target, Type};
use super::report::{At, Report};
use super::values::{extension as extension_of, index, is_whole, list, short, shown, whole};

/// Checks the whole document against the tables, and the lists of extensions.
pub(super) fn check(root: &Map<String, Value>, document: &Value, report: &mut Report) {
    let used: HashSet<&str> = list(document, "extensionsUsed").iter().filter_map(Value::as_str).collect();
    let mut known: HashMap<&str, Vec<(&str, &Type)>> = HashMap::new();
    for extension in EXTENSIONS {
        known.entry(extension.name).or_default().push((extension.of, &extension.object));
    }
    for name in WITHOUT_OBJECTS {
        known.entry(name).or_default();
    }
    let mut walk = Walk { document, used, known, report };
    walk.object(root, &ROOT, &At::Root);
    walk.declared();
}

struct Walk<'v, 'r> {
    document: &'v Value,
    used: HashSet<&'v str>,
    known: HashMap<&'static str, Vec<(&'static str, &'static Type)>>,
    report: &'r mut Report,
}

impl<'v> Walk<'v, '_> {
    // The tables are a finite tree, so this recursion is as deep as they are and no deeper.
    fn object(&mut self, object: &'v Map<String, Value>, ty: &'static Type, at: &At<'_>) {
        for (key, value) in object {
            let here = at.key(key);
            match ty.fields.iter().find(|f| f.name == key) {
                Some(field) => {
                    self.value(value, field.kind, &here);
                    if let Some(needs) = field.needs.filter(|n| !object.contains_key(*n)) {
                        self.report.error("UNSATISFIED_DEPENDENCY", &here, || {
                            format!("this needs '{needs}', which is missing; add it or leave this out")
                        });
                    }
                }
                None if key == "extensions" => self.extensions(value, ty, &here),
                None if key == "extras" => {}
                None if key == "name" && ty.named => self.value(value, Kind::Text, &here),
                None => self.report.warning("UNEXPECTED_PROPERTY", &here, || {
                    "the specification has no such property here; check its spelling or move it into 'extras'".into()
                }),
            }
        }
        for field in ty.fields.iter().filter(|f| f.required && !object.contains_key(f.name)) {
            self.report
                .error("UNDEFINED_PROPERTY", at, || format!("'{}' is missing; it must be there", field.name));
        }
    }

    fn value(&mut self, value: &'v Value, kind: Kind, at: &At<'_>) {
        match kind {
            Kind::Bool if value.is_boolean() => {}
            Kind::Bool => self.mismatch(value, "true or false", at),
            Kind::Text if value.is_string() => {}
            Kind::Text => self.mismatch(value, "a string", at),
            Kind::OneOf(names) => match value.as_str() {
                Some(name) if names.contains(&name) => {}
                Some(name) => not_in_list(self.report, at, &format!("'{name}'"), &names.join("', '")),
                None => self.mismatch(value, "a string", at),
            },
            Kind::Code(codes) => match whole(value) {
                Some(code) if codes.contains(&code) => {}
                _ if is_whole(value) => {
                    let known: Vec<String> = codes.iter().map(u64::to_string).collect();
                    not_in_list(self.report, at, &shown(value), &known.join("', '"));
                }
                _ => self.mismatch(value, "a whole number", at),
            },
            Kind::Whole(least, most, multiple) => self.whole(value, least..=most, multiple, at),
            Kind::Number(range) => match value.as_f64() {
                Some(x) => self.range(x, &range, at),
                None => self.mismatch(value, "a number", at),
            },
            Kind::Numbers(lengths, range) => self.numbers(value, lengths, &range, at),
            Kind::Words => self.words(value, at),
            Kind::Local => {
                self.index(value, at);
            }
            Kind::Ref(target) => self.reference(value, target, at),
            Kind::Refs(target) => self.references(value, target, at),
            Kind::Attributes => match value.as_object() {
                Some(attributes) => self.attributes(attributes, at),
                None => self.mismatch(value, "an object", at),
            },
            Kind::Targets => {
                for (i, element) in self.array(value, at).iter().enumerate() {
                    match element.as_object() {
                        Some(attributes) => self.attributes(attributes, &at.index(i)),
                        None => self.element_mismatch(element, "an object", at),
                    }
                }
            }
            Kind::Object(ty) => match value.as_object() {
                Some(object) => self.object(object, ty, at),
                None => self.mismatch(value, "an object", at),
            },
            Kind::List(ty) => {
                for (i, element) in self.array(value, at).iter().enumerate() {
                    match element.as_object() {
                        Some(object) => self.object(object, ty, &at.index(i)),
                        None => self.element_mismatch(element, "an object", at),
                    }
                }
            }
            Kind::Elements(ty) => {
                for (i, element) in self.array(value, at).iter().enumerate() {
                    let here = at.index(i);
                    match element.as_object() {
                        Some(object) => self.object(object, ty, &here),
                        None => self.mismatch(element, "an object", &here),
                    }
                }
            }
        }
    }

    fn whole(&mut self, value: &Value, range: std::ops::RangeInclusive<u64>, multiple: u64, at: &At<'_>) {
        match whole(value) {
            Some(n) if !range.contains(&n) => self.report.error("VALUE_NOT_IN_RANGE", at, || {
                let most = match *range.end() {
                    u64::MAX => String::new(),
                    most => format!(" and the most {most}"),
                };
                format!("{n} is out of range; the least is {}{most}", range.start())
            }),
            Some(n) if n.checked_rem(multiple) != Some(0) => {
                self.report.error("VALUE_MULTIPLE_OF", at, || {
                    format!("{n} is not a multiple of {multiple}, which it must be")
                });
            }
            Some(_) => {}
            None if is_whole(value) => self.report.error("VALUE_NOT_IN_RANGE", at, || {
                format!("{} is out of range; the least is {}", shown(value), range.start())
            }),
            None => self.mismatch(value, "a whole number", at),
        }
    }

    fn range(&mut self, x: f64, range: &Range, at: &At<'_>) {
        if !range.has(x) {
            self.report
                .error("VALUE_NOT_IN_RANGE", at, || format!("{x} is out of range; it must be {range}"));
        }
    }

    fn numbers(&mut self, value: &'v Value, lengths: &[usize], range: &Range, at: &At<'_>) {
        let array = self.array(value, at);
        if !lengths.is_empty() && !array.is_empty() && !lengths.contains(&array.len()) {
            return self.report.error("ARRAY_LENGTH_NOT_IN_LIST", at, || {
                let lengths: Vec<String> = lengths.iter().map(usize::to_string).collect();
                format!("{} numbers where there must be {}", array.len(), lengths.join(" or "))
            });
        }
        for (i, element) in array.iter().enumerate() {
            match element.as_f64() {
                Some(x) => self.range(x, range, &at.index(i)),
                None => self.element_mismatch(element, "a number", at),
            }
        }
    }

    fn words(&mut self, value: &'v Value, at: &At<'_>) {
        let mut seen = HashSet::new();
        for (i, element) in self.array(value, at).iter().enumerate() {
            match element.as_str() {
                Some(word) if !seen.insert(word) => self.duplicate(&at.index(i), word),
                Some(_) => {}
                None => self.element_mismatch(element, "a string", at),
            }
        }
    }

    /// The elements of an array, which may not be empty.
    fn array(&mut self, value: &'v Value, at: &At<'_>) -> &'v [Value] {
        match value.as_array() {
            Some(array) => {
                if array.is_empty() {
                    self.empty(at);
                }
                array
            }
            None => {
                self.mismatch(value, "an array", at);
                &[]
            }
        }
    }

    fn index(&mut self, value: &Value, at: &At<'_>) -> Option<usize> {
        let found = index(value);
        if found.is_none() {
            if is_whole(value) {
                self.report.error("INVALID_INDEX", at, || {
                    format!("{} is no index; indices start at 0", shown(value))
                });
            } else {
                self.mismatch(value, "a whole number", at);
            }
        }
        found
    }

    fn reference(&mut self, value: &Value, target: Target, at: &At<'_>) {
        let Some(index) = self.index(value, at) else { return };
        self.resolve(index, target, at);
    }

    fn resolve(&mut self, index: usize, target: Target, at: &At<'_>) {
        let (array, place) = match target {
            Target::Root(name) => (list(self.document, name), format!("'{name}'")),
            Target::Extension(extension, name) => {
                // Without the extension at the root there is nothing to point into: another check says so.
                let Some(root) = extension_of(self.document, extension) else { return };
                (list(root, name), format!("'{name}' of {extension}"))
            }
        };
        if index >= array.len() {
            self.report.error("UNRESOLVED_REFERENCE", at, || {
                format!("there is no element {index} in {place}, which has {}", array.len())
            });
        }
    }

    fn references(&mut self, value: &'v Value, target: Target, at: &At<'_>) {
        let mut seen = HashSet::new();
        for (i, element) in self.array(value, at).iter().enumerate() {
            let here = at.index(i);
            let Some(index) = self.index(element, &here) else { continue };
            if !seen.insert(index) {
                self.duplicate(&here, &index.to_string());
            }
            self.resolve(index, target, &here);
        }
    }

    fn attributes(&mut self, attributes: &'v Map<String, Value>, at: &At<'_>) {
        if attributes.is_empty() {
            self.empty(at);
        }
        for (name, value) in attributes {
            self.reference(value, Target::Root("accessors"), &at.key(name));
        }
    }

    fn extensions(&mut self, value: &'v Value, ty: &'static Type, at: &At<'_>) {
        let Some(extensions) = value.as_object() else {
            return self.mismatch(value, "an object", at);
        };
        for (name, value) in extensions {
            let here = at.key(name);
            let Some(object) = value.as_object() else {
                self.mismatch(value, "an object", &here);
                continue;
            };
            if !self.used.contains(name.as_str()) {
                self.report.error("UNDECLARED_EXTENSION", &here, || {
                    format!("'{name}' is not in 'extensionsUsed'; add it there")
                });
                continue;
            }
            let Some(places) = self.known.get(name.as_str()) else { continue };
            match places.iter().find(|(of, _)| *of == ty.name) {
                Some((_, extension)) => {
                    let extension = *extension;
                    self.object(object, extension, &here);
                }
                None => self.report.error("UNEXPECTED_EXTENSION_OBJECT", &here, || {
                    format!("'{name}' does not extend a {}; move it or leave it out", ty.name)
                }),
            }
        }
    }

    /// The lists of extensions.
    fn declared(&mut self) {
        let required: HashSet<&str> =
            list(self.document, "extensionsRequired").iter().filter_map(Value::as_str).collect();
        let used = At::Root.key("extensionsUsed");
        for (i, name) in list(self.document, "extensionsUsed").iter().enumerate() {
            let Some(name) = name.as_str() else { continue };
            let here = used.index(i);
            if !well_named(name) {
                self.report.warning("INVALID_EXTENSION_NAME_FORMAT", &here, || {
                    format!("'{}' is not named like an extension: PREFIX_name", short(name))
                });
            }
            if NEVER_OPTIONAL.contains(&name) && !required.contains(name) {
                self.report.error("NON_REQUIRED_EXTENSION", &here, || {
                    format!("'{name}' must also be in 'extensionsRequired'; add it there")
                });
            }
        }
        let array = At::Root.key("extensionsRequired");
        for (i, name) in list(self.document, "extensionsRequired").iter().enumerate() {
            let Some(name) = name.as_str().filter(|n| !self.used.contains(n)) else { continue };
            self.report.error("UNUSED_EXTENSION_REQUIRED", &array.index(i), || {
                format!("'{}' is required but not in 'extensionsUsed'; add it there", short(name))
            });
        }
    }

    fn mismatch(&mut self, value: &Value, wanted: &str, at: &At<'_>) {
        self.report.error("TYPE_MISMATCH", at, || format!("{} where {wanted} must be", shown(value)));
    }

    fn element_mismatch(&mut self, value: &Value, wanted: &str, at: &At<'_>) {
        self.report
            .error("ARRAY_TYPE_MISMATCH", at, || format!("{} in it, where {wanted} must be", shown(value)));
    }

    fn empty(&mut self, at: &At<'_>) {
        self.report.error("EMPTY_ENTITY", at, || "it is empty; fill it or leave it out".into());
    }

    fn duplicate(&mut self, at: &At<'_>, what: &str) {
        self.report
            .error("DUPLICATE_ELEMENTS", at, || format!("{} is there twice; once is enough", short(what)));
    }
}

fn not_in_list(report: &mut Report, at: &At<'_>, value: &str, known: &str) {
    report.warning("VALUE_NOT_IN_LIST", at, || {
        format!("{} is not one of '{known}'; what it belongs to is left out", short(value))
    });
}

/// Capital letters and digits, `_`, then letters, digits and `_`.
fn well_named(name: &str) -> bool {
    let Some((prefix, rest)) = name.split_once('_') else { return false };
    let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    !prefix.is_empty()
        && !rest.is_empty()
        && prefix.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit())
        && rest.chars().all(word)
}
