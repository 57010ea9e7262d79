use etendue_core::{Aabb, Frame, Ray, Vec2, Vec3A, vector};
use etendue_geometry::{Shape, ShapeHit, ShapeSample, Sphere, Surface};
use etendue_testkit::check_shape;

use crate::Case;

#[derive(Clone, Copy, PartialEq)]
enum Wrong {
    /// The area alone.
    Area(f32),
    /// Area and sampling density.
    AreaAndDensity(f32),
    /// Samples crowd toward one pole, but say they do not.
    Crowded,
    /// The lower quarter is never sampled.
    Partly,
    /// Normals leaned by this much.
    Normal(f32),
    /// The shading normal on the other side.
    Shading,
    /// No error bound, where one is needed.
    NoBound,
    /// The far side is found first.
    Far,
    /// Forgets the end of the ray.
    Interval,
    /// `t` in metres for any direction.
    Metres,
    Bounds,
    /// Half of the derivative.
    Derivative,
    /// Points a thousandth inside.
    Sunken,
}

struct Mutant {
    right: Sphere,
    wrong: Wrong,
}

impl Shape for Mutant {
    fn bounds(&self) -> Aabb {
        let b = self.right.bounds();
        if self.wrong == Wrong::Bounds { Aabb { hi: b.hi - Vec3A::Y * 0.01, ..b } } else { b }
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let hit = match self.wrong {
            Wrong::Interval if ray.is_valid() => self.right.intersect(&Ray { t_max: f32::INFINITY, ..*ray }),
            _ => self.right.intersect(ray),
        }?;
        let length = vector::length(ray.d);
        match self.wrong {
            Wrong::Far => self.right.intersect(&Ray { t_min: hit.t, ..*ray }).or(Some(hit)),
            Wrong::Metres => Some(ShapeHit { t: hit.t * length, ..hit }),
            _ => Some(hit),
        }
    }

    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        let mut s = self.right.surface(ray, hit);
        match self.wrong {
            Wrong::Normal(by) => {
                // A generous bound, or it would hit itself and be found by that.
                s.p_err *= 100.0;
                s.ng = vector::normalize(s.ng + s.shading.x * by);
                s.shading = Frame::from_normal(s.ng);
            }
            Wrong::Shading => s.shading = Frame::from_normal(-s.ng),
            Wrong::NoBound => s.p_err = Vec3A::ZERO,
            Wrong::Derivative => s.dpdu *= 0.5,
            Wrong::Sunken => s.p -= s.ng * (1e-3 * self.right.radius()),
            _ => {}
        }
        s
    }

    fn area(&self) -> f32 {
        match self.wrong {
            Wrong::Area(f) | Wrong::AreaAndDensity(f) => self.right.area() * f,
            _ => self.right.area(),
        }
    }

    fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let u = match self.wrong {
            // Twenty per cent rms.
            Wrong::Crowded => Vec2::new((f64::from(u.x).powf(1.2) as f32).min(1.0 - f32::EPSILON), u.y),
            Wrong::Partly => Vec2::new(0.25 + 0.75 * u.x, u.y),
            _ => u,
        };
        let mut s = self.right.sample(u)?;
        if let Wrong::AreaAndDensity(f) = self.wrong {
            s.pdf_area /= f;
        }
        Some(s)
    }
}

pub(crate) fn mutants() -> Vec<Case<'static>> {
    let case = |name: &str, wrong| {
        let right = Sphere::new(Vec3A::new(0.3, -0.7, 0.2), 0.8).expect("a ball");
        let mutant = Mutant { right, wrong };
        Case::new(name, move |b| check_shape(&mutant, b))
    };
    vec![
        case("area 5 % too large, and the density with it", Wrong::AreaAndDensity(1.05)),
        case("area 5 % too small, and the density with it", Wrong::AreaAndDensity(0.95)),
        case("area 1 % too large, the density not", Wrong::Area(1.01)),
        case("samples crowd at a pole, 20 % rms", Wrong::Crowded),
        case("a quarter is never sampled", Wrong::Partly),
        case("normals lean by 0.15", Wrong::Normal(0.15)),
        case("the shading normal is on the other side", Wrong::Shading),
        case("no error bound: hits itself", Wrong::NoBound),
        case("the far hit first", Wrong::Far),
        case("hits behind the ray's end", Wrong::Interval),
        case("t in metres whatever the direction's length", Wrong::Metres),
        case("bounds too small", Wrong::Bounds),
        case("half a derivative", Wrong::Derivative),
        case("points a thousandth inside", Wrong::Sunken),
    ]
}
