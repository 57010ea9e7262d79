//! Takes pages apart.

use std::collections::BTreeSet;

/// An opening, closing or empty tag with its attributes.
pub(crate) struct Tag {
    pub(crate) name: String,
    pub(crate) attributes: Vec<(String, String)>,
}

/// Takes a page apart; panics unless every tag is closed in order, every attribute quoted and given once, every id
/// unique and every ampersand one of ours.
pub(crate) fn well_formed(html: &str) -> Vec<Tag> {
    let mut rest = html.strip_prefix("<!DOCTYPE html>\n").expect("a doctype");
    let (mut open, mut ids, mut tags) = (Vec::<String>::new(), BTreeSet::new(), Vec::new());
    while let Some(at) = rest.find('<') {
        plain(&rest[..at]);
        rest = &rest[at + 1..];
        if let Some(closing) = rest.strip_prefix('/') {
            let end = closing.find('>').expect("a closed tag");
            assert_eq!(open.pop().as_deref(), Some(&closing[..end]), "before {:.80}", &closing[end..]);
            rest = &closing[end + 1..];
            continue;
        }
        let end = rest.find(|c: char| !c.is_ascii_alphanumeric()).expect("the end of a name");
        assert!(end > 0, "a bare < before {rest:.80}");
        let mut tag = Tag { name: rest[..end].to_owned(), attributes: Vec::new() };
        rest = &rest[end..];
        let empty = loop {
            if let Some(after) = rest.strip_prefix("/>") {
                rest = after;
                break true;
            }
            if let Some(after) = rest.strip_prefix('>') {
                rest = after;
                break ["meta", "img"].contains(&&*tag.name);
            }
            let attribute =
                rest.strip_prefix(' ').unwrap_or_else(|| panic!("a space in {} at {rest:.80}", tag.name));
            let (name, after) = attribute.split_once("=\"").expect("a quoted attribute");
            assert!(name.chars().all(|c| c.is_ascii_alphabetic() || c == '-'), "{name:?}");
            let (value, after) = after.split_once('"').expect("a closing quote");
            plain(value);
            assert!(!value.contains('<'), "{value}");
            assert!(!name.starts_with("on"), "{name}");
            assert!(tag.attributes.iter().all(|(n, _)| n != name), "{name} twice");
            assert!(name != "id" || ids.insert(value.to_owned()), "two of {value}");
            tag.attributes.push((name.to_owned(), value.to_owned()));
            rest = after;
        };
        if !empty {
            open.push(tag.name.clone());
        }
        tags.push(tag);
    }
    assert!(open.is_empty() && rest == "\n", "{open:?}, {rest:?}");
    tags
}

fn plain(text: &str) {
    for piece in text.split('&').skip(1) {
        let known = ["amp;", "lt;", "gt;", "quot;", "#39;"].iter().any(|e| piece.starts_with(e));
        assert!(known, "&{piece:.20}");
    }
    assert!(text.chars().all(|c| !c.is_control() || c == '\n' || c == '\t'), "{text:?}");
}

impl Tag {
    pub(crate) fn get(&self, name: &str) -> &str {
        self.attributes.iter().find(|(n, _)| n == name).map_or("", |(_, v)| v)
    }

    pub(crate) fn number(&self, name: &str) -> f64 {
        self.get(name).parse().unwrap_or_else(|_| panic!("{name} of {}: {:?}", self.name, self.get(name)))
    }
}
