/// What parts numbers: blanks and commas.
type Parts<'a> = std::str::Split<'a, fn(char) -> bool>;

fn parts(line: &str) -> Parts<'_> {
    line.split(|c: char| c.is_whitespace() || c == ',')
}

/// The numbers of a text one after the other, across lines, with the line that each stands in.
pub(super) struct Numbers<'a> {
    /// Lines that are still to come, with their numbers from 1.
    lines: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>,
    words: Parts<'a>,
    line: usize,
}

impl<'a> Numbers<'a> {
    pub(super) fn new(lines: impl Iterator<Item = (usize, &'a str)> + 'a) -> Self {
        Self { lines: Box::new(lines), words: parts(""), line: 0 }
    }

    /// The line of the number read last, or where the text ends.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// The next number, finite.
    pub(super) fn next(&mut self, what: &str) -> Result<f32, String> {
        let word = loop {
            if let Some(word) = self.words.find(|w| !w.is_empty()) {
                break word;
            }
            let Some((line, text)) = self.lines.next() else {
                return Err(format!("the file ends where {what} should be; it may be cut off"));
            };
            (self.line, self.words) = (line, parts(text));
        };
        let shown: String = word.chars().take(24).collect();
        match word.parse::<f32>() {
            Ok(v) if v.is_finite() => Ok(v),
            Ok(_) => Err(format!("{what} is {shown}, which is no finite number")),
            Err(_) => Err(format!("{what} should be a number, not `{shown}`")),
        }
    }

    /// The next number, which counts something: whole, and of `most` at most.
    pub(super) fn count(&mut self, what: &str, most: u32) -> Result<usize, String> {
        let v = self.next(what)?;
        if v < 0.0 || v.fract() != 0.0 {
            return Err(format!("{what} is {v}: it must be a whole number, zero or more"));
        }
        if v > most as f32 {
            return Err(format!("{what} is {v}: more than {most} are not read"));
        }
        Ok(v as usize)
    }

    /// So many numbers. Memory is taken as they are found, not as they are promised.
    pub(super) fn list(&mut self, count: usize, what: &str) -> Result<Vec<f32>, String> {
        let mut out = Vec::new();
        for _ in 0..count {
            out.push(self.next(what)?);
        }
        Ok(out)
    }
}
