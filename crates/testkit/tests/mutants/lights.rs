use etendue_core::{Origin, Ray, Spectrum, Vec2, Vec3A, vector};
use etendue_geometry::{Parallelogram, Shape, Surface};
use etendue_light::{
    ConstantEnvironment, DirectionalLight, Light, LightBounds, LightSample, LitPoint, ParallelogramLight,
    Sides, SpotLight,
};
use etendue_testkit::{check_light, lit_point};
use etendue_texture::Tex;

use crate::Case;

#[derive(Clone, Copy, PartialEq)]
enum Wrong {
    /// The density throughout.
    Pdf(f32),
    /// `pdf` alone.
    PdfCall(f32),
    /// Radiance of the sample alone.
    Radiance(f32),
    /// The area is sampled, and the density lacks the light's cosine.
    NoCosine,
    /// The area is sampled, and the density lacks the squared distance.
    NoDistance,
    /// The area is sampled with `u.x` to this power.
    Skewed(f64),
    /// Half of the light is never drawn.
    Half,
    Power(f32),
    /// The cone of emission is too narrow.
    Cone,
    /// The box is too small.
    Bounds,
    /// The sample ends behind the light.
    End,
    /// Drawn behind the receiver's surface too.
    Behind,
}

struct Mutant {
    right: ParallelogramLight,
    shape: Parallelogram,
    wrong: Wrong,
}

impl Mutant {
    /// Density of the point `p` of the light per solid angle, uniform over the area; with the defect.
    fn by_area(&self, at: &LitPoint, p: Vec3A) -> f32 {
        let d = p - at.p;
        let d2 = d.dot(d);
        let cos = vector::normalize(d).dot(self.shape.normal()).abs();
        let density = d2 / (cos * self.shape.area());
        match self.wrong {
            Wrong::NoCosine => density * cos,
            Wrong::NoDistance => density / d2,
            _ => density,
        }
    }

    fn is_by_area(&self) -> bool {
        matches!(self.wrong, Wrong::NoCosine | Wrong::NoDistance | Wrong::Skewed(_) | Wrong::Half)
    }
}

impl Light for Mutant {
    fn sample(&self, at: &LitPoint, part: u32, u: Vec2) -> Option<LightSample> {
        let free = LitPoint { sides: Sides::Both, ..*at };
        let at = if self.wrong == Wrong::Behind { &free } else { at };
        let mut s = self.right.sample(at, part, u)?;
        if self.is_by_area() {
            let x = match self.wrong {
                Wrong::Skewed(power) => f64::from(u.x).powf(power) as f32,
                Wrong::Half => 0.5 * u.x,
                _ => u.x,
            };
            let shape = &self.shape;
            let p = shape.origin() + shape.edge_u() * x + shape.edge_v() * u.y;
            s.wi = vector::normalize(p - at.p);
            s.pdf = self.by_area(at, p);
            s.end = s.end.map(|e| Origin { p, ..e });
            if at.sides == Sides::Same && s.wi.dot(at.ng) <= 0.0 {
                return None;
            }
        }
        match self.wrong {
            Wrong::Pdf(f) => s.pdf *= f,
            Wrong::Radiance(f) => s.li *= f,
            Wrong::End => s.end = s.end.map(|e| Origin { p: at.p + (e.p - at.p) * 1.01, ..e }),
            _ => {}
        }
        Some(s)
    }

    fn pdf(&self, at: &LitPoint, part: u32, wi: Vec3A, seen: Option<&Surface>) -> f32 {
        let p = self.right.pdf(at, part, wi, seen);
        match self.wrong {
            Wrong::Pdf(f) | Wrong::PdfCall(f) => p * f,
            _ if self.is_by_area() && p > 0.0 => seen.map_or(0.0, |s| self.by_area(at, s.p)),
            _ => p,
        }
    }

    fn power(&self, part: u32, scene_radius: f32) -> Spectrum {
        let p = self.right.power(part, scene_radius);
        if let Wrong::Power(f) = self.wrong { p * f } else { p }
    }

    fn bounds(&self, part: u32) -> Option<LightBounds> {
        let mut b = self.right.bounds(part)?;
        match self.wrong {
            Wrong::Cone => b.cos_emission = 0.9,
            Wrong::Bounds => b.bounds.hi.x -= 0.01,
            // A generous box, or the end would be found outside of it.
            Wrong::End => b.bounds = etendue_core::Aabb { lo: b.bounds.lo - 1.0, hi: b.bounds.hi + 1.0 },
            _ => {}
        }
        Some(b)
    }

    fn emitted(&self, part: u32, at: &Surface, wo: Vec3A) -> Spectrum {
        self.right.emitted(part, at, wo)
    }
}

/// A sky whose samples are right and whose power is not.
struct Sky(ConstantEnvironment);

impl Light for Sky {
    fn sample(&self, at: &LitPoint, part: u32, u: Vec2) -> Option<LightSample> {
        self.0.sample(at, part, u)
    }

    fn pdf(&self, at: &LitPoint, part: u32, wi: Vec3A, seen: Option<&Surface>) -> f32 {
        self.0.pdf(at, part, wi, seen)
    }

    fn power(&self, part: u32, scene_radius: f32) -> Spectrum {
        self.0.power(part, scene_radius) * 0.75
    }

    fn bounds(&self, _part: u32) -> Option<LightBounds> {
        None
    }

    fn escaped(&self, ray: &Ray) -> Spectrum {
        self.0.escaped(ray)
    }

    fn is_infinite(&self) -> bool {
        true
    }
}

/// A light of one direction at a time with another power, cone or end than it has.
struct Delta<L> {
    right: L,
    power: f32,
    cone: Option<f32>,
    end: Option<Origin>,
}

impl<L: Light> Light for Delta<L> {
    fn sample(&self, at: &LitPoint, part: u32, u: Vec2) -> Option<LightSample> {
        let s = self.right.sample(at, part, u)?;
        Some(LightSample { end: self.end.or(s.end), ..s })
    }

    fn pdf(&self, at: &LitPoint, part: u32, wi: Vec3A, seen: Option<&Surface>) -> f32 {
        self.right.pdf(at, part, wi, seen)
    }

    fn power(&self, part: u32, scene_radius: f32) -> Spectrum {
        self.right.power(part, scene_radius) * self.power
    }

    fn bounds(&self, part: u32) -> Option<LightBounds> {
        let mut b = self.right.bounds(part)?;
        b.cos_emission = self.cone.unwrap_or(b.cos_emission);
        Some(b)
    }

    fn is_delta(&self) -> bool {
        true
    }
}

pub(crate) fn mutants() -> Vec<Case<'static>> {
    let points = [
        lit_point(Vec3A::new(0.1, -1.0, 0.2), Vec3A::Y),
        lit_point(Vec3A::new(-1.0, -0.8, 0.5), vector::normalize(Vec3A::new(-0.6, 0.4, 0.2))),
    ];
    let case = |name: &str, wrong| {
        let shape =
            Parallelogram::new(Vec3A::new(-0.5, 0.0, -0.4), Vec3A::X, Vec3A::Z * 0.8).expect("an area");
        let mutant = Mutant { right: ParallelogramLight::new(shape, Tex::gray(2.0)), shape, wrong };
        Case::new(name, move |b| {
            let seen = |ray: &Ray| shape.intersect(ray).map(|h| shape.surface(ray, &h));
            check_light(&mutant, 0, &points, &seen, b)
        })
    };
    let right = case("", Wrong::Pdf(1.0));
    assert!((right.check)(&etendue_testkit::Budget::default()).is_ok(), "the right one is accepted");
    let by_area = case("", Wrong::Skewed(1.0));
    assert!((by_area.check)(&etendue_testkit::Budget::default()).is_ok(), "so is sampling the area");
    let sky = Sky(ConstantEnvironment::new(Spectrum::ONE));
    let sun = || DirectionalLight::new(Vec3A::new(0.2, -3.0, 0.4), Spectrum::gray(2.0));
    let spot = || SpotLight::new(Vec3A::Y, Vec3A::NEG_Y, Spectrum::ONE, 0.3, 1.2);
    fn delta<L: Light + 'static>(name: &str, mutant: Delta<L>, points: [LitPoint; 2]) -> Case<'static> {
        Case::new(name, move |b| check_light(&mutant, 0, &points, &|_| None, b))
    }
    let free = Some(Origin::free(Vec3A::ZERO));
    vec![
        delta(
            "a sun of three quarters of its power",
            Delta { right: sun(), power: 0.75, cone: None, end: None },
            points,
        ),
        delta(
            "a sun that stands somewhere",
            Delta { right: sun(), power: 1.0, cone: None, end: free },
            points,
        ),
        delta(
            "a spot of three quarters of its power",
            Delta { right: spot(), power: 0.75, cone: None, end: None },
            points,
        ),
        delta(
            "a spot with the cone of its full intensity",
            Delta { right: spot(), power: 1.0, cone: Some(0.955), end: None },
            points,
        ),
        case("density 2 % too large", Wrong::Pdf(1.02)),
        case("density 2 % too small", Wrong::Pdf(0.98)),
        case("pdf() says 2 % more than sample", Wrong::PdfCall(1.02)),
        case("the sample's radiance 2 % too large", Wrong::Radiance(1.02)),
        case("area density without the cosine", Wrong::NoCosine),
        case("area density without the distance", Wrong::NoDistance),
        case("draws skewed, 20 % rms", Wrong::Skewed(1.2)),
        case("half is never drawn", Wrong::Half),
        case("three quarters of the power", Wrong::Power(0.75)),
        case("too narrow a cone", Wrong::Cone),
        case("too small a box", Wrong::Bounds),
        case("samples end behind the light", Wrong::End),
        case("samples behind the receiver", Wrong::Behind),
        Case::new("a sky of three quarters of its power", move |b| {
            check_light(&sky, 0, &points, &|_| None, b)
        }),
    ]
}
