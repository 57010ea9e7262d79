//! Text, tables, pictures and the document around them.

use etendue_measure::report::{
    Axis, Cell, ColourScale, Figure, Gallery, Guide, Item, Line, Page, Plot, Point, Row, Section, Series,
    Table,
};
use proptest::prelude::*;

use crate::checker::well_formed;
use crate::{page_of, plot_of};

const HOSTILE: &str =
    "</title><script src=\"https://x.example/a.js\" onload='f()'>&amp;\0\u{1b}\u{202e}<!-- \" ' ]]>";

/// Something of everything, with this text wherever there is text.
fn everything(text: &str) -> Page {
    let t = || text.to_owned();
    let point =
        |i: f64| Point { low: Some(0.5 / i), high: Some(2.0 / i), label: t(), ..Point::new(i, 1.0 / i) };
    let plot = Plot {
        title: t(),
        x: Axis::log(t()),
        y: Axis::log(t()),
        series: vec![
            Series { name: t(), points: vec![point(1.0), point(4.0)], ..Series::default() },
            Series { name: t(), line: Line::Dashed, look: Some(70), ..Series::default() },
        ],
        guide: Some(Guide { slope: -1.0, label: t() }),
        notes: vec![t()],
    };
    let table = Table {
        caption: t(),
        head: vec![t(), t()],
        rows: vec![
            Row::new([Cell::text(t()), Cell::number(t()), Cell::text(t())]).highlighted(),
            Row::default(),
        ],
        notes: vec![t()],
    };
    let figure = Figure { caption: t(), png: vec![0xfb, 0xff, 0xbe], width: 4, height: 3, pixelated: true };
    let scale = ColourScale { stops: vec![[0, 128, 255]; 3], low_label: t(), high_label: t() };
    let gallery =
        Gallery { figures: vec![figure.clone(), Figure { png: vec![], ..figure }], scale: Some(scale) };
    let items = vec![Item::Text(t()), Item::Plots(vec![plot]), Item::Table(table), Item::Figures(gallery)];
    let section = Section { heading: t(), anchor: t(), items };
    Page {
        title: t(),
        lead: vec![t()],
        sections: vec![section.clone(), section],
        command: t(),
        facts: vec![(t(), t())],
    }
}

#[test]
fn hostile_names_stay_names() {
    let html = everything(HOSTILE).html();
    let tags = well_formed(&html);
    assert!(tags.iter().all(|t| t.name != "script" && t.attributes.iter().all(|(n, _)| n != "onload")));
    assert_eq!(
        tags.iter().filter(|t| t.name == "title").count(),
        1 + 2 * 4,
        "the page's, the points' and the axes'"
    );
    assert!(!html.contains("<script") && !html.contains("<!--"));
    assert!(html.contains("&lt;script src=&quot;https://x.example/a.js&quot;"), "shown as it is");
}

#[test]
fn nothing_is_fetched() {
    let html = everything("a scene").html();
    for word in ["http:", "https:", "//", "<script", "<link", "<iframe", "@import", "url(", "javascript:"] {
        assert!(!html.contains(word), "{word}");
    }
    let tags = well_formed(&html);
    for tag in &tags {
        let (href, src) = (tag.get("href"), tag.get("src"));
        assert!(href.is_empty() || href.starts_with('#'), "{href}");
        assert!(src.is_empty() || src.starts_with("data:image/png;base64,"), "{src}");
        if let Some(anchor) = href.strip_prefix('#') {
            assert!(tags.iter().any(|t| t.get("id") == anchor), "{anchor}");
        }
    }
    let policy =
        tags.iter().find(|t| t.get("http-equiv") == "Content-Security-Policy").unwrap().get("content");
    assert!(policy.starts_with("default-src 'none'; img-src data:; style-src 'unsafe-inline';"), "{policy}");
    assert!(html.find("charset").unwrap() < 100, "early enough to be seen");
}

proptest! {
    #[test]
    fn any_text_is_well_formed(text in any::<String>(), marks in "[<>&\"'/=a-z -]{0,24}") {
        well_formed(&everything(&text).html());
        well_formed(&everything(&marks).html());
    }
}

#[test]
fn tables_align_and_head_their_cells() {
    let table = Table {
        caption: "T".into(),
        head: vec!["Name".into(), "MSE".into(), "Mixed".into()],
        rows: vec![
            Row::new([Cell::text("a"), Cell::number("1"), Cell::text("x")]),
            Row::new([Cell::text("b"), Cell::number("2"), Cell::number("3"), Cell::text("extra")])
                .highlighted(),
            Row::new([]),
        ],
        notes: vec![],
    };
    let html = page_of(vec![Item::Table(table)]).html();
    well_formed(&html);
    assert!(html.contains("<tr><th scope=\"col\">Name</th><th scope=\"col\" class=\"number\">MSE</th><th scope=\"col\">Mixed</th><td></td></tr>"));
    assert!(html.contains("<tr><th scope=\"row\">a</th><td class=\"number\">1</td><td>x</td><td></td></tr>"));
    assert!(html.contains("<tr class=\"highlight\"><th scope=\"row\">b</th><td class=\"number\">2</td><td class=\"number\">3</td><td>extra</td></tr>"));
    assert!(html.contains("<tr><th scope=\"row\"></th><td></td><td></td><td></td></tr>"));
}

#[test]
fn pictures_are_inside_with_their_size() {
    let html = everything("e").html();
    let tags = well_formed(&html);
    let image = tags.iter().find(|t| t.name == "img").unwrap();
    assert_eq!((image.get("width"), image.get("height"), image.get("class")), ("4", "3", "pixelated"));
    assert_eq!((image.get("alt"), image.get("src")), ("e", "data:image/png;base64,+/++"));
    assert!(html.contains("no picture"));
    assert!(html.contains("linear-gradient(to right,#0080ff,#0080ff,#0080ff)"));
}

#[test]
fn anchors_are_unique_and_listed() {
    let section =
        |heading: &str, anchor: &str| Section { anchor: anchor.into(), ..Section::new(heading, []) };
    let mut page = page_of(vec![]);
    page.sections = vec![
        section("Run time & error", ""),
        section("x", "run-time-error"),
        section("光", ""),
        section("y", "a\" b"),
    ];
    let html = page.html();
    let ids: Vec<String> =
        well_formed(&html).iter().filter(|t| t.name == "section").map(|t| t.get("id").to_owned()).collect();
    assert_eq!(ids, ["run-time-error", "run-time-error-2", "section", "a-b"]);
    assert!(html.contains("<a href=\"#run-time-error-2\">x</a>"));
    page.sections.truncate(1);
    assert!(!page.html().contains("<nav"), "one section needs no contents");
}

#[test]
fn the_same_page_is_the_same_bytes_and_few() {
    let page = everything("the same");
    assert_eq!(page.html(), page.clone().html());
    let series = (0..4).map(|s| Series {
        name: format!("contender {s}"),
        points: (1..13)
            .map(|i| Point { low: Some(0.1), high: Some(3.0), ..Point::new(i as f64, 1.0) })
            .collect(),
        ..Series::default()
    });
    let plot = Plot { series: series.collect(), ..plot_of(vec![]) };
    let html = page_of(vec![Item::Plots(vec![plot; 3])]).html();
    assert!(html.len() < 100_000, "{} bytes", html.len());
}

/// WCAG 2.2's relative luminance of `#rrggbb` or `#rgb`.
fn luminance(colour: &str) -> f64 {
    let hex: String = if colour.len() == 4 {
        colour[1..].chars().flat_map(|c| [c, c]).collect()
    } else {
        colour[1..].into()
    };
    let channel = |i: usize| {
        let c = f64::from(u8::from_str_radix(&hex[2 * i..2 * i + 2], 16).unwrap()) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    0.2126 * channel(0) + 0.7152 * channel(1) + 0.0722 * channel(2)
}

#[test]
fn colours_stand_out_in_light_and_dark() {
    let html = page_of(vec![]).html();
    let schemes: Vec<&str> = html.split(":root {").skip(1).map(|s| s.split('}').next().unwrap()).collect();
    assert_eq!(schemes.len(), 2);
    for scheme in schemes {
        let of = |name: &str| {
            let value = scheme.split(&format!("--{name}: ")).nth(1).unwrap_or_else(|| panic!("{name}"));
            luminance(value.split(';').next().unwrap())
        };
        let contrast = |a: &str, b: &str| {
            let (a, b) = (of(a), of(b));
            (a.max(b) + 0.05) / (a.min(b) + 0.05)
        };
        let texts = [
            ("text", "ground"),
            ("quiet", "ground"),
            ("link", "ground"),
            ("text", "highlight"),
            ("text", "code"),
        ];
        for (text, ground) in texts {
            assert!(contrast(text, ground) >= 4.5, "{text} on {ground}: {}", contrast(text, ground));
        }
        for mark in ["s0", "s1", "s2", "s3", "s4", "s5", "s6", "s7", "axis", "guide", "edge"] {
            assert!(contrast(mark, "ground") >= 3.0, "{mark}: {}", contrast(mark, "ground"));
        }
    }
}
