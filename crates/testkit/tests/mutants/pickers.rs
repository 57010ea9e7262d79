use etendue_light::{LightId, LightPicker, LitPoint, Pick};
use etendue_testkit::{check_picker, lit_point};

use crate::Case;

/// Picks part 0 once in ten and part 1 otherwise, or claims to.
struct Two {
    drawn: f32,
    claimed: f32,
    said: f32,
    stretched: bool,
}

const RIGHT: Two = Two { drawn: 0.1, claimed: 0.1, said: 0.1, stretched: true };

fn id(part: u32) -> LightId {
    LightId { light: 0, part }
}

impl LightPicker for Two {
    fn pick(&self, _at: &LitPoint, u: f32) -> Option<Pick> {
        let p = self.drawn;
        let (part, pmf, stretched) =
            if u < p { (0, self.said, u / p) } else { (1, 1.0 - self.said, (u - p) / (1.0 - p)) };
        let u = if self.stretched { stretched.min(1.0 - f32::EPSILON) } else { u };
        Some(Pick { id: id(part), pmf, u })
    }

    fn pmf(&self, _at: &LitPoint, id: LightId) -> f32 {
        if id.part == 0 { self.claimed } else { 1.0 - self.claimed }
    }
}

pub(crate) fn mutants() -> Vec<Case<'static>> {
    let case = |name: &str, picker: Two| {
        let at = [lit_point(etendue_core::Vec3A::ZERO, etendue_core::Vec3A::Y)];
        Case::new(name, move |b| check_picker(&picker, &[id(0), id(1)], &at, &|_, _| true, b))
    };
    assert!(
        (case("", RIGHT).check)(&etendue_testkit::Budget::default()).is_ok(),
        "the right one is accepted"
    );
    vec![
        case("a probability wrong by a tenth", Two { claimed: 0.11, said: 0.11, ..RIGHT }),
        case("pmf() is not that of the pick", Two { claimed: 0.101, ..RIGHT }),
        case("probabilities that do not fit the picks' own", Two { said: 0.101, ..RIGHT }),
        case("the number is not stretched", Two { stretched: false, ..RIGHT }),
        case("a part that shines is never picked", Two { drawn: 0.0, claimed: 0.0, said: 0.0, ..RIGHT }),
    ]
}
