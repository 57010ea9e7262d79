//! A report as one HTML file: plots, tables and pictures, without scripts and without anything to fetch.
//!
//! The types here say what the document contains; [`Page::html`] writes it. They know nothing of rendering: who
//! measures fills them in. Every text is escaped, whatever is in it, and the same page gives the same bytes.
//! The page follows the reader's light or dark scheme, prints on white, and forbids the network to itself.
//!
//! ```
//! use etendue_measure::report::{Axis, Cell, Guide, Item, Page, Plot, Point, Row, Section, Series, Table, number};
//!
//! let points = (0..6).map(|i| {
//!     let n = 4.0f64.powi(i);
//!     Point { low: Some(0.08 / n), high: Some(0.13 / n), label: format!("{n} spp"), ..Point::new(0.02 * n, 0.1 / n) }
//! });
//! let plot = Plot {
//!     title: "Error over time".into(),
//!     x: Axis::log("seconds"),
//!     y: Axis::log("mean squared error"),
//!     series: vec![Series { name: "path".into(), points: points.collect(), ..Series::default() }],
//!     guide: Some(Guide::inverse()),
//!     ..Plot::default()
//! };
//! let table = Table {
//!     caption: "Efficiency".into(),
//!     head: vec!["Integrator".into(), "1 / (MSE · s)".into()],
//!     rows: vec![Row::new([Cell::text("path"), Cell::number(number(500.0))]).highlighted()],
//!     ..Table::default()
//! };
//! let page = Page {
//!     title: "Cornell box".into(),
//!     sections: vec![Section::new("Convergence", [Item::Plots(vec![plot]), Item::Table(table)])],
//!     command: "etendue bench cornell.glb".into(),
//!     ..Page::default()
//! };
//! assert!(page.html().starts_with("<!DOCTYPE html>"));
//! ```

mod figure;
mod frame;
mod markup;
mod number;
mod page;
mod plot;
mod scale;
mod svg;
mod table;
mod ticks;

pub use figure::{ColourScale, Figure, Gallery};
pub use number::number;
pub use page::{Item, Page, Section};
pub use plot::{Axis, Guide, Line, Plot, Point, Series};
pub use table::{Cell, Row, Table};
