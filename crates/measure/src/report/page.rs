//! The document.

use std::collections::BTreeSet;

use super::figure::Gallery;
use super::markup::Html;
use super::plot::Plot;
use super::table::Table;

const STYLE: &str = include_str!("style.css");
/// Nothing is fetched and nothing runs, even if something in the page asked for it.
const POLICY: &str =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";
const ORIGIN: &str = "How this was made";

/// A whole report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// The heading, and the name of the browser's tab.
    pub title: String,
    /// Paragraphs beneath the heading: what was found.
    pub lead: Vec<String>,
    /// The parts; a list of contents is written if there are several.
    pub sections: Vec<Section>,
    /// The command line that makes the report again; may be empty.
    pub command: String,
    /// Names and values: version, machine, threads and what else the numbers depend on.
    pub facts: Vec<(String, String)>,
}

/// A part of a report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Its heading.
    pub heading: String,
    /// Its name in the page's address, after `#`; made of the heading if empty, and made unique in any case.
    pub anchor: String,
    /// What it contains, downward.
    pub items: Vec<Item>,
}

impl Section {
    /// With an anchor made of the heading.
    pub fn new(heading: impl Into<String>, items: impl IntoIterator<Item = Item>) -> Self {
        Self { heading: heading.into(), anchor: String::new(), items: items.into_iter().collect() }
    }
}

/// A piece of a section.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A paragraph.
    Text(String),
    /// Plots, side by side where there is room.
    Plots(Vec<Plot>),
    /// A table.
    Table(Table),
    /// Pictures side by side.
    Figures(Gallery),
}

impl Page {
    /// The report as one HTML file, in UTF-8.
    pub fn html(&self) -> String {
        let mut h = Html::default();
        h.raw("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
        h.raw("<meta http-equiv=\"Content-Security-Policy\" content=\"").raw(POLICY).raw("\">\n");
        h.raw("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
        h.raw("<meta name=\"color-scheme\" content=\"light dark\">\n<title>")
            .text(&self.title)
            .raw("</title>\n");
        h.raw("<style>\n").raw(STYLE).raw("</style>\n</head>\n<body>\n<header>\n<h1>").text(&self.title);
        h.raw("</h1>\n");
        for paragraph in &self.lead {
            h.raw("<p class=\"lead\">").text(paragraph).raw("</p>\n");
        }
        h.raw("</header>\n");

        let mut taken = BTreeSet::new();
        let anchors: Vec<String> = self.sections.iter().map(|s| s.id(&mut taken)).collect();
        if self.sections.len() > 1 {
            self.write_contents(&mut h, &anchors);
        }
        h.raw("<main>\n");
        for (section, anchor) in self.sections.iter().zip(&anchors) {
            section.write(&mut h, anchor);
        }
        h.raw("</main>\n");
        self.write_origin(&mut h);
        h.raw("</body>\n</html>\n");
        h.finish()
    }

    fn write_contents(&self, h: &mut Html, anchors: &[String]) {
        h.raw("<nav aria-label=\"Contents\">\n<ul>\n");
        for (section, anchor) in self.sections.iter().zip(anchors) {
            h.raw(&format!("<li><a href=\"#{anchor}\">")).text(&section.heading).raw("</a></li>\n");
        }
        h.raw("</ul>\n</nav>\n");
    }

    fn write_origin(&self, h: &mut Html) {
        if self.command.is_empty() && self.facts.is_empty() {
            return;
        }
        h.raw("<footer>\n<h2>").raw(ORIGIN).raw("</h2>\n");
        if !self.command.is_empty() {
            h.raw("<pre><code>");
            // A line may end between arguments, but not within `--name`.
            for (i, argument) in self.command.split(' ').enumerate() {
                h.raw(if i == 0 { "<span>" } else { " <span>" }).text(argument).raw("</span>");
            }
            h.raw("</code></pre>\n");
        }
        if !self.facts.is_empty() {
            h.raw("<dl>\n");
            for (name, value) in &self.facts {
                h.raw("<div><dt>").text(name).raw("</dt><dd>").text(value).raw("</dd></div>\n");
            }
            h.raw("</dl>\n");
        }
        h.raw("</footer>\n");
    }
}

impl Section {
    fn write(&self, h: &mut Html, anchor: &str) {
        h.raw(&format!("<section id=\"{anchor}\">\n<h2>")).text(&self.heading).raw("</h2>\n");
        for item in &self.items {
            match item {
                Item::Text(text) => {
                    h.raw("<p>").text(text).raw("</p>\n");
                }
                Item::Plots(plots) => {
                    h.raw("<div class=\"plots\">\n");
                    plots.iter().for_each(|plot| plot.write(h));
                    h.raw("</div>\n");
                }
                Item::Table(table) => table.write(h),
                Item::Figures(gallery) => gallery.write(h),
            }
        }
        h.raw("</section>\n");
    }

    /// Letters, digits and hyphens, as no other section has them.
    fn id(&self, taken: &mut BTreeSet<String>) -> String {
        let wanted = if self.anchor.is_empty() { &self.heading } else { &self.anchor };
        let words: Vec<String> = wanted
            .split(|c: char| !c.is_ascii_alphanumeric())
            .filter(|word| !word.is_empty())
            .map(str::to_ascii_lowercase)
            .collect();
        let base = if words.is_empty() { "section".to_owned() } else { words.join("-") };
        let mut id = base.clone();
        let mut count = 1u64;
        while !taken.insert(id.clone()) {
            count += 1;
            id = format!("{base}-{count}");
        }
        id
    }
}
