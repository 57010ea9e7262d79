//! `--integrator` by its words.

use std::str::FromStr;

use etendue::integrator::{
    AmbientOcclusion, Branching, DirectLight, FirstSurface, PathTracer, RayCaster, Roulette, Show, Whitted,
};

use super::Method;

/// What `--integrator` takes, for its help.
pub(crate) const WORDS: &str = "path, with :depth=N, :light=none|lights|bsdf|balance|power, \
:roulette=off|throughput|albedo|P (a probability), :from=N, :threshold=X, :branch=N, :levels=N; direct, split and hemisphere likewise, \
but without :depth or :light; area with :depth, :roulette, :from; whitted with :depth, :threshold, :each=N; \
raycast with :shadows=on|off, :each=N; ao with :reach=X; normal, depth, ids, triangles, albedo, uv";

/// How light is followed: a name, and what differs from its defaults.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct IntegratorChoice {
    /// As it was written.
    pub(crate) word: String,
    pub(crate) method: Method,
}

impl FromStr for IntegratorChoice {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let mut parts = word.split(':');
        let name = parts.next().unwrap_or_default();
        let mut method = named(name).ok_or_else(|| format!("write {WORDS}"))?;
        let options: Vec<&str> = parts.collect();
        for &option in &options {
            let (key, value) = option.split_once('=').unwrap_or((option, ""));
            let fixed = (name == "direct" && key == "depth")
                || (matches!(name, "split" | "hemisphere") && key == "light");
            if fixed || !set(&mut method, key, value)? {
                return Err(format!("'{option}': '{name}' has no such option; write {WORDS}"));
            }
        }
        // In any order: from when on is known only after which roulette.
        for &option in &options {
            if let Some(n) = option.strip_prefix("from=") {
                set_from(&mut method, option, whole(option, n)?)?;
            }
        }
        if let Method::Path(t) | Method::Direct(t) = &mut method {
            let leveled = options.iter().any(|o| o.starts_with("levels="));
            match (t.branching.factor > 1, leveled) {
                (true, false) => t.branching.levels = 1,
                (false, true) => return Err("'levels=…' says where paths branch; add branch=N".into()),
                _ => {}
            }
        }
        Ok(Self { word: word.to_owned(), method })
    }
}

fn named(name: &str) -> Option<Method> {
    let first = |show| Method::First(FirstSurface { show });
    Some(match name {
        "path" => Method::Path(PathTracer::default()),
        "direct" => Method::Direct(PathTracer::direct_only()),
        "split" => Method::Path(PathTracer::split_form()),
        "hemisphere" => Method::Path(PathTracer::hemisphere_form()),
        "area" => Method::Area { max_depth: None, roulette: PathTracer::default().roulette },
        "whitted" => Method::Whitted(Whitted::default()),
        "raycast" => Method::RayCast(RayCaster::default()),
        "ao" => Method::Occlusion(AmbientOcclusion::default()),
        "normal" => first(Show::Normal),
        "depth" => first(Show::Depth),
        "ids" => first(Show::Ids),
        "triangles" => first(Show::Triangles),
        "albedo" => first(Show::Albedo),
        "uv" => first(Show::Uv),
        _ => return None,
    })
}

/// Sets one option; false where the method has none of that name.
fn set(method: &mut Method, key: &str, value: &str) -> Result<bool, String> {
    let option = format!("{key}={value}");
    let number = || whole(&option, value);
    let positive = || match value.parse::<f32>() {
        Ok(x) if x >= 0.0 && x.is_finite() => Ok(x),
        _ => Err(format!("'{option}': write a number that is 0 or more")),
    };
    if matches!(key, "roulette" | "from") {
        let Some(r) = roulette_of(method) else { return Ok(false) };
        // From when on is set when it is known which roulette it is.
        if key == "roulette" {
            *r = roulette(&option, value)?;
        }
        return Ok(true);
    }
    match (method, key) {
        (Method::Path(t), "depth") => t.max_depth = Some(number()?),
        (Method::Path(t) | Method::Direct(t), "light") => t.direct = direct_light(value)?,
        (Method::Path(t) | Method::Direct(t), "threshold") => t.threshold = positive()?,
        (Method::Path(t) | Method::Direct(t), "branch") => match number()? {
            n @ 1..=Branching::MOST => t.branching.factor = n,
            _ => return Err(format!("'{option}': write a number from 1 to {}", Branching::MOST)),
        },
        (Method::Path(t) | Method::Direct(t), "levels") => t.branching.levels = number()?,
        (Method::Area { max_depth, .. }, "depth") => *max_depth = Some(number()?),
        (Method::Whitted(w), "depth") => w.max_depth = Some(number()?),
        (Method::Whitted(w), "threshold") => w.threshold = positive()?,
        (
            Method::Whitted(Whitted { each_light, .. }) | Method::RayCast(RayCaster { each_light, .. }),
            "each",
        ) => {
            *each_light = number()?;
        }
        (Method::RayCast(r), "shadows") => {
            r.shadows = match value {
                "on" => true,
                "off" => false,
                _ => return Err(format!("'{option}': write on or off")),
            }
        }
        (Method::Occlusion(a), "reach") => a.reach = positive()?,
        _ => return Ok(false),
    }
    Ok(true)
}

fn whole(option: &str, n: &str) -> Result<u32, String> {
    n.parse().map_err(|_| format!("'{option}': write a whole number"))
}

/// A number below 1 is a probability; a whole one is from when on the throughput decides.
fn roulette(option: &str, value: &str) -> Result<Roulette, String> {
    let from = 1;
    Ok(match value {
        "off" => Roulette::Off,
        "throughput" => Roulette::Throughput { from: 3 },
        "albedo" => Roulette::Albedo { from },
        _ => match (value.parse::<u32>(), value.parse::<f32>()) {
            (Ok(from), _) => Roulette::Throughput { from },
            (_, Ok(p)) if p > 0.0 && p < 1.0 => Roulette::Fixed { p, from },
            _ => {
                return Err(format!(
                    "'{option}': write off, throughput, albedo, a probability between 0 and 1, or a whole number"
                ));
            }
        },
    })
}

fn roulette_of(method: &mut Method) -> Option<&mut Roulette> {
    match method {
        Method::Path(t) | Method::Direct(t) => Some(&mut t.roulette),
        Method::Area { roulette, .. } => Some(roulette),
        _ => None,
    }
}

fn set_from(method: &mut Method, option: &str, n: u32) -> Result<(), String> {
    match roulette_of(method) {
        Some(Roulette::Fixed { from, .. } | Roulette::Albedo { from } | Roulette::Throughput { from }) => {
            *from = n;
            Ok(())
        }
        _ => Err(format!("'{option}': there is no roulette to begin")),
    }
}

fn direct_light(word: &str) -> Result<DirectLight, String> {
    match word {
        "none" => Ok(DirectLight::None),
        "lights" => Ok(DirectLight::Light),
        "bsdf" => Ok(DirectLight::Bsdf),
        "balance" => Ok(DirectLight::MisBalance),
        "power" => Ok(DirectLight::MisPower),
        _ => {
            Err(format!("'light={word}': write none (by chance), lights, bsdf, or both as balance or power"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn method(word: &str, limit: Option<u32>) -> Option<Method> {
        word.parse::<IntegratorChoice>().ok().map(|c| c.method.limited(limit))
    }

    fn tracer(word: &str, limit: Option<u32>) -> Option<PathTracer> {
        method(word, limit)
            .and_then(|m| if let Method::Path(t) | Method::Direct(t) = m { Some(t) } else { None })
    }

    #[test]
    fn ways_of_tracing_paths() {
        let path = PathTracer::default();
        assert_eq!(tracer("path", None), Some(path));
        assert_eq!(tracer("direct", Some(7)).and_then(|t| t.max_depth), Some(1));
        assert_eq!(tracer("direct", Some(0)).and_then(|t| t.max_depth), Some(0));
        assert_eq!(tracer("path:depth=3", Some(7)).and_then(|t| t.max_depth), Some(3));
        assert_eq!(
            tracer("path:light=bsdf:roulette=off", None),
            Some(PathTracer { direct: DirectLight::Bsdf, roulette: Roulette::Off, ..path })
        );
        let roulette = |word: &str| tracer(word, None).map(|t| t.roulette);
        assert_eq!(roulette("path:roulette=5"), Some(Roulette::Throughput { from: 5 }));
        assert_eq!(roulette("path:roulette=0.7"), Some(Roulette::Fixed { p: 0.7, from: 1 }));
        assert_eq!(roulette("path:from=2:roulette=albedo"), Some(Roulette::Albedo { from: 2 }));
        assert_eq!(
            tracer("path:branch=4:threshold=0.01", None),
            Some(PathTracer { branching: Branching { factor: 4, levels: 1 }, threshold: 0.01, ..path })
        );
        let branching = |word: &str| tracer(word, None).map(|t| t.branching);
        assert_eq!(branching("path:levels=0:branch=4"), Some(Branching { factor: 4, levels: 0 }));
        assert_eq!(branching("path:branch=4:levels=0"), branching("path:levels=0:branch=4"));
        assert_eq!(tracer("split", None), Some(PathTracer::split_form()));
        assert_eq!(tracer("hemisphere:depth=2", None).and_then(|t| t.max_depth), Some(2));
    }

    #[test]
    fn other_integrators() {
        let roulette = Roulette::Off;
        assert_eq!(method("area:roulette=off", Some(3)), Some(Method::Area { max_depth: Some(3), roulette }));
        let w = Whitted { max_depth: Some(2), each_light: 0, ..Whitted::default() };
        assert_eq!(method("whitted:each=0:depth=2", Some(9)), Some(Method::Whitted(w)));
        let r = RayCaster { shadows: false, ..RayCaster::default() };
        assert_eq!(method("raycast:shadows=off", Some(1)), Some(Method::RayCast(r)));
        assert_eq!(method("ao:reach=2.5", None), Some(Method::Occlusion(AmbientOcclusion { reach: 2.5 })));
        assert_eq!(method("depth", None), Some(Method::First(FirstSurface { show: Show::Depth })));
    }

    #[test]
    fn what_is_no_integrator_is_refused() {
        for bad in [
            "",
            "magic",
            "path:",
            "path:light",
            "path:light=x",
            "path:depth=-1",
            "direct:depth=2",
            "split:light=bsdf",
            "path:roulette=1.5",
            "path:roulette=-0.5",
            "path:threshold=-1",
            "path:reach=1",
            "ao:reach=x",
            "ao:depth=1",
            "raycast:shadows=maybe",
            "normal:from=1",
            "whitted:light=bsdf",
            "path:from=x",
            "path:roulette=off:from=5",
            "path:branch=0",
            "path:branch=100000",
            "path:levels=2",
        ] {
            assert!(bad.parse::<IntegratorChoice>().is_err(), "{bad}");
        }
    }
}
