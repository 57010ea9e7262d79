//! Writes a report of made-up numbers, to look at: `cargo run -p etendue-measure --example report_sample -- out.html`.

use etendue_measure::report::{
    Axis, Cell, ColourScale, Figure, Gallery, Guide, Item, Line, Page, Plot, Point, Row, Section, Series,
    Table, number,
};

/// Error after one sample, and seconds for one.
const CONTENDERS: [(&str, f64, f64); 3] =
    [("path", 0.21, 0.11), ("path with NEE", 0.034, 0.19), ("bdpt", 0.009, 0.62)];

fn main() -> std::io::Result<()> {
    let Some(path) = std::env::args().nth(1) else {
        eprintln!("usage: report_sample OUT.html");
        return Ok(());
    };
    std::fs::write(path, page().html())
}

fn page() -> Page {
    Page {
        title: "<b>Küche & \"Bad\"</b>.glb: three integrators".into(),
        lead: vec![
            "Bidirectional path tracing reaches the error of 256 samples of path tracing in a ninth of the time.".into(),
            "Errors are mean squared differences from a reference of 65536 samples, over eight runs each; bands are 95% \
             intervals of the mean."
                .into(),
        ],
        sections: vec![
            Section::new("Convergence", [
                Item::Plots(vec![
                    plot("Error over run time", "seconds", |n, cost| n * cost),
                    plot("Error over samples", "samples per pixel", |n, _| n),
                ]),
                Item::Text("Slopes flatter than the guide's mean bias, or samples that are not independent.".into()),
            ]),
            Section::new("Efficiency", [Item::Table(table())]),
            Section::new("Pictures", [Item::Figures(gallery(3)), Item::Figures(gallery(1)), Item::Figures(gallery(5))]),
            Section::new("Bias", [Item::Plots(vec![bias(), many(), Plot { title: "Nothing".into(), ..Plot::default() }])]),
        ],
        command: "etendue bench 'kitchen & bath.glb' --integrators path,nee,bdpt --spp 1..256 --runs 8 --html report.html"
            .into(),
        facts: [("version", "0.1.0"), ("machine", "x86_64, 2 cores"), ("threads", "2"), ("picture", "640 × 480")]
            .map(|(a, b)| (a.to_owned(), b.to_owned()))
            .to_vec(),
    }
}

/// Numbers that scatter about 1, the same every time.
fn scatter(i: usize) -> f64 {
    1.0 + 0.16 * ((i as f64 * 12.9898).sin() * 43_758.547).fract()
}

fn plot(title: &str, x: &str, at: impl Fn(f64, f64) -> f64) -> Plot {
    let series = CONTENDERS.iter().enumerate().map(|(c, (name, error, cost))| Series {
        name: (*name).to_owned(),
        points: (0..9)
            .map(|i| {
                let n = f64::from(1 << i);
                let y = error / n * scatter(9 * c + i);
                let half = 0.22 + 0.09 * (i as f64);
                Point {
                    low: Some(y * (1.0 - half * if c == 2 { 1.1 } else { 0.8 })),
                    high: Some(y * (1.0 + half)),
                    label: format!("{n} spp"),
                    ..Point::new(at(n, *cost), y)
                }
            })
            .collect(),
        line: if c == 0 { Line::Dashed } else { Line::Solid },
        look: None,
    });
    Plot {
        title: title.into(),
        x: Axis::log(x),
        y: Axis::log("mean squared error"),
        series: series.collect(),
        guide: Some(Guide::inverse()),
        notes: Vec::new(),
    }
}

fn bias() -> Plot {
    let points = (0..9).map(|i| Point {
        low: Some(-0.2 / f64::from(i + 1)),
        high: (i != 4).then_some(0.25 / f64::from(i + 1)),
        ..Point::new(f64::from(i * 32), 0.02 * scatter(i as usize) / f64::from(i + 1))
    });
    let mut points: Vec<Point> = points.collect();
    points.push(Point::new(f64::NAN, 0.0));
    Plot {
        title: "Mean difference, on linear axes".into(),
        x: Axis::linear("samples per pixel"),
        y: Axis::linear("mean difference, W·m⁻²·sr⁻¹"),
        series: vec![Series { name: "path".into(), points, ..Series::default() }],
        ..Plot::default()
    }
}

fn many() -> Plot {
    let series = (0..10).map(|s| Series {
        name: format!("contender {s} with a rather long name"),
        points: (0..5)
            .map(|i| {
                let y = 3e-3 * f64::from(s + 1) / f64::from(i + 1);
                Point { low: (i == 2).then_some(y / 2.0), ..Point::new(f64::from(1 << i), y) }
            })
            .collect(),
        ..Series::default()
    });
    Plot {
        title: "Ten contenders".into(),
        x: Axis::log("seconds"),
        y: Axis::log("relative mean squared error"),
        series: series.collect(),
        ..Plot::default()
    }
}

fn table() -> Table {
    let rows = CONTENDERS.iter().enumerate().map(|(i, (name, error, cost))| {
        let efficiency = 1.0 / (error * cost);
        let cells = [cost * 256.0, error / 256.0, efficiency, efficiency * 0.21 * 0.11];
        let row = Row::new(
            [Cell::text(*name)].into_iter().chain(cells.map(|v| Cell::number(number(v)))).chain([
                Cell::text(
                    ["baseline", "faster at every error", "fastest above 2 s"]
                        .get(i)
                        .copied()
                        .unwrap_or_default(),
                ),
            ]),
        );
        if i == 2 { row.highlighted() } else { row }
    });
    Table {
        caption: "Efficiency at 256 samples".into(),
        head: ["Integrator", "Seconds", "MSE", "1 / (MSE · s)", "Times the baseline", "Verdict"]
            .map(String::from)
            .to_vec(),
        rows: rows.collect(),
        notes: vec!["Highlighted: the most efficient.".into()],
    }
}

fn gallery(count: usize) -> Gallery {
    let (width, height) = if count == 1 { (64, 8) } else { (32, 24) };
    let figure = |i: usize| Figure {
        caption: ["path: squared error", "path with NEE: squared error", "bdpt: squared error"][i % 3].into(),
        png: png(width, height, |x, y| [((x * 8) as u8).wrapping_mul(i as u8 + 1), (y * 10) as u8, 90]),
        width,
        height,
        pixelated: count != 1,
    };
    let scale = ColourScale {
        stops: vec![[0, 0, 4], [87, 16, 110], [188, 55, 84], [249, 142, 9], [252, 255, 164]],
        low_label: "0".into(),
        high_label: number(0.25),
    };
    Gallery { figures: (0..count).map(figure).collect(), scale: (count == 3).then_some(scale) }
}

/// A PNG file with its pixels stored, not compressed.
fn png(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [u8; 3]) -> Vec<u8> {
    let mut raw = Vec::new();
    for y in 0..height {
        raw.push(0);
        (0..width).for_each(|x| raw.extend(pixel(x, y)));
    }
    let length = raw.len() as u16;
    let mut zlib = vec![0x78, 1, 1];
    zlib.extend(length.to_le_bytes());
    zlib.extend((!length).to_le_bytes());
    zlib.extend(&raw);
    let (mut a, mut b) = (1u32, 0u32);
    for byte in &raw {
        a = (a + u32::from(*byte)) % 65521;
        b = (b + a) % 65521;
    }
    zlib.extend((b << 16 | a).to_be_bytes());
    let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
    header.extend([8, 2, 0, 0, 0]);
    let mut out = b"\x89PNG\r\n\x1a\n".to_vec();
    for (kind, data) in [(b"IHDR", header), (b"IDAT", zlib), (b"IEND", Vec::new())] {
        out.extend((data.len() as u32).to_be_bytes());
        let body = [&kind[..], &data].concat();
        out.extend(&body);
        let crc = body.iter().fold(!0u32, |crc, byte| {
            (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { c >> 1 ^ 0xedb8_8320 } else { c >> 1 })
        });
        out.extend((!crc).to_be_bytes());
    }
    out
}
