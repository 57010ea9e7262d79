//! The report as a file: that it is well formed, whatever comes in, and that it shows what it was given.

mod checker;
mod page;
mod plots;

use etendue_measure::report::{Axis, Item, Page, Plot, Point, Section, Series};

fn page_of(items: Vec<Item>) -> Page {
    Page { title: "A scene".into(), sections: vec![Section::new("Results", items)], ..Page::default() }
}

fn plot_of(points: Vec<Point>) -> Plot {
    Plot {
        title: "Error".into(),
        x: Axis::log("s"),
        y: Axis::log("MSE"),
        series: vec![Series { name: "path".into(), points, ..Series::default() }],
        ..Plot::default()
    }
}

fn html_of(plot: &Plot) -> String {
    page_of(vec![Item::Plots(vec![plot.clone()])]).html()
}
