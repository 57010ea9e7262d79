use etendue_camera::{Camera, CameraSample, Connect, Perspective};
use etendue_core::{Needs, Origin, Spectrum, UVec2, Vec2, Vec3A};
use etendue_testkit::check_camera;

use crate::Case;

#[derive(Clone, Copy, PartialEq)]
enum Wrong {
    /// Uses the lens but does not declare it.
    Lens,
    /// Moves during the exposure but does not declare it.
    Motion,
    /// Every ray through its pixel's corner.
    Snapped,
    /// Neighbouring rays part ten times as fast as it says.
    Spread,
    NotUnit,
    /// The wrong time on the ray.
    Time,
    /// No ray for one film position in a thousand: not a number instead.
    Nan,
    /// The way back is mirrored.
    Connect,
}

struct Mutant {
    right: Perspective,
    wrong: Wrong,
}

impl Camera for Mutant {
    fn resolution(&self) -> UVec2 {
        self.right.resolution()
    }

    fn ray(&self, film: Vec2, lens: Vec2, time: f32) -> Option<CameraSample> {
        let film = if self.wrong == Wrong::Snapped { film.floor() } else { film };
        let mut s = self.right.ray(film, lens, time)?;
        match self.wrong {
            Wrong::Motion => s.ray.o += Vec3A::X * (0.01 * time),
            Wrong::Spread => s.spread *= 0.1,
            Wrong::NotUnit => s.ray.d *= 1.001,
            Wrong::Time => s.ray.time = 0.0,
            Wrong::Nan if (film.x * 31.7 + film.y * 17.3).fract().abs() < 1e-3 => s.ray.d = Vec3A::NAN,
            _ => {}
        }
        Some(s)
    }

    fn connect(&self, p: &Origin, lens: Vec2) -> Option<Connect> {
        if self.wrong != Wrong::Connect {
            return None;
        }
        let eye = self.right.ray(Vec2::ZERO, lens, 0.0)?.ray.o;
        let wi = etendue_core::vector::normalize(eye - p.p);
        let film = self.resolution().as_vec2() * 0.5;
        Some(Connect { film, wi, we: Spectrum::ONE, pdf: 1.0, end: Origin::free(eye) })
    }

    fn needs(&self) -> Needs {
        if self.wrong == Wrong::Lens { Needs::empty() } else { self.right.needs() }
    }
}

pub(crate) fn mutants() -> Vec<Case<'static>> {
    let case = |name: &str, wrong| {
        let size = UVec2::new(64, 48);
        let right = Perspective::look_at(Vec3A::new(0.0, 1.0, 5.0), Vec3A::ZERO, Vec3A::Y, 40.0, size);
        let right = right.expect("a view");
        let right = if wrong == Wrong::Lens { right.with_lens(0.01, 4.0).expect("a lens") } else { right };
        let mutant = Mutant { right, wrong };
        Case::new(name, move |b| check_camera(&mutant, b))
    };
    vec![
        case("a lens that is not declared", Wrong::Lens),
        case("motion that is not declared", Wrong::Motion),
        case("rays through the pixels' corners", Wrong::Snapped),
        case("a spread ten times too small", Wrong::Spread),
        case("directions a thousandth too long", Wrong::NotUnit),
        case("a ray of another moment", Wrong::Time),
        case("NaN for one film position in a thousand", Wrong::Nan),
        case("a way back to the middle of the film", Wrong::Connect),
    ]
}
