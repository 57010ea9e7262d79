//! Pictures, embedded.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::markup::Html;

/// More than these side by side become too small to see anything in.
const ABREAST: usize = 5;

/// Pictures side by side.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gallery {
    /// The pictures, from the left; they wrap.
    pub figures: Vec<Figure>,
    /// What the colours of false-colour pictures mean.
    pub scale: Option<ColourScale>,
}

/// One picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figure {
    /// Beneath the picture, and read out in its place.
    pub caption: String,
    /// The bytes of a PNG file, taken as they are; without any, the page says that there is no picture.
    pub png: Vec<u8>,
    /// Width of the picture in its own pixels.
    pub width: u32,
    /// Height of the picture in its own pixels.
    pub height: u32,
    /// Enlarged without smoothing, to tell pixels apart.
    pub pixelated: bool,
}

/// A strip of colours with its ends named.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColourScale {
    /// sRGB, evenly spaced from low to high.
    pub stops: Vec<[u8; 3]>,
    /// What the low end is.
    pub low_label: String,
    /// What the high end is.
    pub high_label: String,
}

impl Gallery {
    pub(super) fn write(&self, h: &mut Html) {
        let abreast = self.figures.len().clamp(1, ABREAST);
        // What is pixelated may be enlarged, the others would only be blurred.
        let widest = self.figures.iter().map(|f| f.width).max().unwrap_or(0);
        let most =
            if self.figures.iter().any(|f| f.pixelated) { "100%".into() } else { format!("{widest}px") };
        h.raw(&format!("<div class=\"gallery\" style=\"--abreast:{abreast};--most:{most}\">\n"));
        for figure in &self.figures {
            figure.write(h);
        }
        h.raw("</div>\n");
        if let Some(scale) = &self.scale {
            scale.write(h);
        }
    }
}

impl Figure {
    fn write(&self, h: &mut Html) {
        h.raw("<figure>\n");
        if self.png.is_empty() {
            h.raw("<p class=\"none\">no picture</p>\n");
        } else {
            let class = if self.pixelated { " class=\"pixelated\"" } else { "" };
            let (width, height) = (self.width.max(1), self.height.max(1));
            h.raw(&format!("<img{class} width=\"{width}\" height=\"{height}\" alt=\"")).text(&self.caption);
            h.raw("\" src=\"data:image/png;base64,");
            STANDARD.encode_string(&self.png, h.buffer());
            h.raw("\">\n");
        }
        h.raw("<figcaption>").text(&self.caption).raw("</figcaption>\n</figure>\n");
    }
}

impl ColourScale {
    fn write(&self, h: &mut Html) {
        let colour = |[r, g, b]: &[u8; 3]| format!("#{r:02x}{g:02x}{b:02x}");
        let mut stops: Vec<String> = self.stops.iter().map(colour).collect();
        // A gradient needs two ends.
        if let [only] = &*stops {
            stops.push(only.clone());
        }
        h.raw("<div class=\"scale\"><span>").text(&self.low_label).raw("</span><span class=\"strip\"");
        if !stops.is_empty() {
            h.raw(&format!(" style=\"background-image:linear-gradient(to right,{})\"", stops.join(",")));
        }
        h.raw("></span><span>").text(&self.high_label).raw("</span></div>\n");
    }
}
