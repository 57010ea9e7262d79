//! Text into HTML.

/// HTML being written: markup as it is, text escaped.
#[derive(Default)]
pub(super) struct Html(String);

impl Html {
    /// Adds what is markup already.
    pub(super) fn raw(&mut self, markup: &str) -> &mut Self {
        self.0.push_str(markup);
        self
    }

    /// Adds text, for between tags or inside a quoted attribute.
    pub(super) fn text(&mut self, text: &str) -> &mut Self {
        for c in text.chars() {
            match c {
                '&' => self.0.push_str("&amp;"),
                '<' => self.0.push_str("&lt;"),
                '>' => self.0.push_str("&gt;"),
                '"' => self.0.push_str("&quot;"),
                '\'' => self.0.push_str("&#39;"),
                '\r' => self.0.push('\n'),
                c if !printable(c) => self.0.push(char::REPLACEMENT_CHARACTER),
                c => self.0.push(c),
            }
        }
        self
    }

    /// One paragraph of this class for every note.
    pub(super) fn notes<'a>(&mut self, notes: impl IntoIterator<Item = &'a String>) -> &mut Self {
        for note in notes {
            self.raw("<p class=\"note\">").text(note).raw("</p>\n");
        }
        self
    }

    /// The buffer itself, for encoders that append.
    pub(super) fn buffer(&mut self) -> &mut String {
        &mut self.0
    }

    pub(super) fn finish(self) -> String {
        self.0
    }
}

/// HTML has no way to write control characters, and marks of direction would let a name rearrange the text after it.
fn printable(c: char) -> bool {
    match c {
        '\n' | '\t' => true,
        '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => false,
        c => !c.is_control() && u32::from(c) & 0xfffe != 0xfffe,
    }
}

/// The first `most` characters, the last of them an ellipsis if there were more.
pub(super) fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn escaped(text: &str) -> String {
        let mut h = Html::default();
        h.text(text);
        h.finish()
    }

    #[test]
    fn nothing_gets_out_of_text() {
        assert_eq!(
            escaped("<script>alert('&\"')</script>"),
            "&lt;script&gt;alert(&#39;&amp;&quot;&#39;)&lt;/script&gt;"
        );
        assert_eq!(escaped("&lt;"), "&amp;lt;", "escaped once, however it looks");
        assert_eq!(escaped("a\0b\u{1b}[31m\u{7f}\u{85}\u{fffe}\u{1ffff}"), "a�b�[31m����");
        assert_eq!(escaped("abc\u{202e}fed\u{2067}"), "abc�fed�");
        assert_eq!(escaped("a\tb\nc\rd"), "a\tb\nc\nd");
        assert_eq!(escaped("Étendue 10⁻³ 光 🙂"), "Étendue 10⁻³ 光 🙂");
    }

    #[test]
    fn short_by_characters() {
        assert_eq!(shortened("ééé", 3), "ééé");
        assert_eq!(shortened("éééé", 3), "éé…");
        assert_eq!(shortened("ab", 0), "…");
    }
}
