//! Tables.

use super::markup::Html;

/// A table. The first cell of every row is the row's heading.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Heading.
    pub caption: String,
    /// Headings of the columns.
    pub head: Vec<String>,
    /// The rows; short ones are filled up.
    pub rows: Vec<Row>,
    /// Paragraphs beneath.
    pub notes: Vec<String>,
}

/// One row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// Its cells, from the left.
    pub cells: Vec<Cell>,
    /// Stands out: the baseline, or the best. The notes say which.
    pub highlight: bool,
}

impl Row {
    /// A row like the others.
    pub fn new(cells: impl IntoIterator<Item = Cell>) -> Self {
        Self { cells: cells.into_iter().collect(), highlight: false }
    }

    /// The same row, standing out.
    #[must_use]
    pub fn highlighted(self) -> Self {
        Self { highlight: true, ..self }
    }
}

/// What a cell contains.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cell {
    /// Words, to the left.
    Text(String),
    /// A number as it is to be read (see [`number`](super::number)), to the right.
    Number(String),
}

impl Cell {
    /// Words.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// A number, written out.
    pub fn number(text: impl Into<String>) -> Self {
        Self::Number(text.into())
    }
}

impl Table {
    pub(super) fn write(&self, h: &mut Html) {
        let columns = self.rows.iter().map(|r| r.cells.len()).max().unwrap_or(0).max(self.head.len());
        // The box scrolls where the table is too wide, and must be reachable by keyboard to do so.
        h.raw("<div class=\"table\">\n<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"");
        h.text(&self.caption).raw("\">\n<table>\n<caption>").text(&self.caption).raw("</caption>\n");
        if !self.head.is_empty() {
            h.raw("<thead>\n<tr>");
            for column in 0..columns {
                let class = if self.is_numeric(column) { " class=\"number\"" } else { "" };
                match self.head.get(column).filter(|text| !text.is_empty()) {
                    Some(text) => h.raw(&format!("<th scope=\"col\"{class}>")).text(text).raw("</th>"),
                    None => h.raw("<td></td>"),
                };
            }
            h.raw("</tr>\n</thead>\n");
        }
        h.raw("<tbody>\n");
        for row in &self.rows {
            h.raw(if row.highlight { "<tr class=\"highlight\">" } else { "<tr>" });
            for column in 0..columns {
                let (text, class) = match row.cells.get(column) {
                    Some(Cell::Text(text)) => (text.as_str(), ""),
                    Some(Cell::Number(text)) => (text.as_str(), " class=\"number\""),
                    None => ("", ""),
                };
                let (tag, scope) = if column == 0 { ("th", " scope=\"row\"") } else { ("td", "") };
                h.raw(&format!("<{tag}{scope}{class}>")).text(text).raw(&format!("</{tag}>"));
            }
            h.raw("</tr>\n");
        }
        h.raw("</tbody>\n</table>\n</div>\n").notes(&self.notes).raw("</div>\n");
    }

    /// Whether a column has numbers and nothing else, so that its heading stands above them.
    fn is_numeric(&self, column: usize) -> bool {
        let mut cells = self.rows.iter().filter_map(|r| r.cells.get(column)).peekable();
        cells.peek().is_some() && cells.all(|c| matches!(c, Cell::Number(_)))
    }
}
