//! Words of the command line to values. Every refusal says what would do.

use std::ops::Range;

use etendue::camera::Filter;
use etendue::core::UVec2;

/// Longest side of a picture.
const MOST_PIXELS: u32 = 65_536;
const MOST_SPP: u32 = 1 << 30;
const MOST_THREADS: usize = 4096;

/// A number of threads, at least 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Threads(pub(crate) usize);

/// One of the equal parts of the samples, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shard {
    part: u64,
    of: u64,
}

impl Shard {
    /// Its sample indices, of `0..spp`: neighbouring parts meet, all parts together are everything.
    pub(crate) fn indices(self, spp: u32) -> Range<u64> {
        let cut = |k: u64| u64::from(spp) * k / self.of;
        cut(self.part - 1)..cut(self.part)
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.part, self.of)
    }
}

pub(super) fn size(text: &str) -> Result<UVec2, String> {
    let help = || format!("write WIDTHxHEIGHT, both from 1 to {MOST_PIXELS}, as in 640x480");
    let (w, h) = text.split_once(['x', 'X']).ok_or_else(help)?;
    let side = |s: &str| s.parse().ok().filter(|n| (1..=MOST_PIXELS).contains(n)).ok_or_else(help);
    Ok(UVec2::new(side(w)?, side(h)?))
}

pub(super) fn spp(text: &str) -> Result<u32, String> {
    let n = text.parse().ok().filter(|n| (1..=MOST_SPP).contains(n));
    n.ok_or_else(|| format!("write a whole number from 1 to {MOST_SPP}; powers of two do best"))
}

pub(super) fn threads(text: &str) -> Result<Threads, String> {
    let n = text.parse().ok().filter(|n| (1..=MOST_THREADS).contains(n));
    n.map(Threads).ok_or_else(|| {
        format!("write a whole number from 1 to {MOST_THREADS}, or leave it out for one per core")
    })
}

pub(super) fn shard(text: &str) -> Result<Shard, String> {
    let help = || "write I/N with I from 1 to N, as in 2/8: the second of eight parts".to_owned();
    let (part, of) = text.split_once('/').ok_or_else(help)?;
    let (part, of) = (part.parse::<u32>().map_err(|_| help())?, of.parse::<u32>().map_err(|_| help())?);
    if part == 0 || part > of {
        return Err(help());
    }
    Ok(Shard { part: part.into(), of: of.into() })
}

pub(super) fn filter(text: &str) -> Result<Filter, String> {
    let help =
        || "write box, tent, gaussian or mitchell, with a radius in pixels if need be: tent:1.5".to_owned();
    let (name, radius) = match text.split_once(':') {
        None => (text, None),
        Some((name, r)) => {
            let r = r.parse::<f32>().ok().filter(|r| *r > 0.0 && *r <= 32.0);
            (name, Some(r.ok_or("the radius is a number of pixels above 0 and at most 32")?))
        }
    };
    match name {
        "box" => Ok(Filter::Box { radius: radius.unwrap_or(0.5) }),
        "tent" => Ok(Filter::Tent { radius: radius.unwrap_or(1.0) }),
        "gaussian" => {
            let radius = radius.unwrap_or(1.5);
            Ok(Filter::Gaussian { radius, sigma: radius / 3.0 })
        }
        "mitchell" => Ok(Filter::Mitchell { radius: radius.unwrap_or(2.0), b: 1.0 / 3.0, c: 1.0 / 3.0 }),
        _ => Err(help()),
    }
}

/// Seconds.
pub(super) fn time(text: &str) -> Result<f64, String> {
    let units = [("ms", 1e-3), ("s", 1.0), ("m", 60.0), ("h", 3600.0), ("", 1.0)];
    let split = units.iter().find_map(|(unit, factor)| Some((text.strip_suffix(unit)?, factor)));
    split
        .and_then(|(number, factor)| Some(number.parse::<f64>().ok()? * factor))
        .filter(|t| *t > 0.0 && t.is_finite())
        .ok_or_else(|| "write a number above 0 and its unit: 10s, 500ms, 2m or 1h".to_owned())
}

pub(super) fn finite(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|v: &f32| v.is_finite()).ok_or_else(|| "write a number".to_owned())
}

pub(super) fn scale(text: &str) -> Result<f32, String> {
    finite(text).ok().filter(|v| *v >= 0.0).ok_or_else(|| "write a number that is not below 0".to_owned())
}

pub(super) fn exposure(text: &str) -> Result<f32, String> {
    let v = finite(text).ok().filter(|v| v.abs() <= 64.0);
    v.ok_or_else(|| "write a number from -64 to 64; 1 is twice as bright".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(size("640x480"), Ok(UVec2::new(640, 480)));
        for bad in ["10x0", "0x10", "10", "x", "10x10x10", "-3x4", "65537x1", "1e2x5"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn shards_are_everything_once() {
        assert_eq!(shard("2/3").map(|s| s.indices(10)), Ok(3..6));
        for n in 1..20u32 {
            let mut at = 0;
            for i in 1..=n {
                let r = shard(&format!("{i}/{n}")).map(|s| s.indices(13)).expect("a shard");
                assert_eq!(r.start, at);
                at = r.end;
            }
            assert_eq!(at, 13);
        }
        for bad in ["5/3", "0/3", "1/0", "1", "/", "-1/2", "1/2/3"] {
            assert!(shard(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn times_and_filters() {
        assert_eq!(
            [time("10s"), time("500ms"), time("2m"), time("1h"), time("3")].map(Result::ok),
            [Some(10.0), Some(0.5), Some(120.0), Some(3600.0), Some(3.0)]
        );
        for bad in ["", "s", "0s", "-1s", "infs", "10 s", "nan"] {
            assert!(time(bad).is_err(), "{bad}");
        }
        assert_eq!(filter("box"), Ok(Filter::BOX));
        assert_eq!(filter("gaussian"), Ok(Filter::default()));
        assert_eq!(filter("tent:2"), Ok(Filter::Tent { radius: 2.0 }));
        for bad in ["", "lanczos", "tent:", "tent:0", "tent:-1", "tent:nan", "box:99"] {
            assert!(filter(bad).is_err(), "{bad}");
        }
        assert!(
            spp("0").is_err() && threads("0").is_err() && scale("-1").is_err() && exposure("inf").is_err()
        );
    }
}
