//! Wrong parts, each of which its suite must reject on 99 of 100 seeds. The defect named with each is the suite's
//! power at effort 1: what is this small is still seen.

#[path = "../support/mod.rs"]
mod support;

mod bsdfs;
mod cameras;
mod integrators;
mod lights;
mod pickers;
mod samplers;
mod shapes;

use support::{Case, MANY, reject};

/// Seeds of the ordinary run.
const SOME: u64 = 10;

/// An ordinary and a long test for a list of mutants.
macro_rules! rejected {
    ($($name:ident),*) => {$(
        mod $name {
            #[test]
            fn on_ten_seeds() {
                super::reject(&crate::$name::mutants(), super::SOME, 1.0);
            }

            #[test]
            #[ignore = "minutes"]
            fn on_99_of_100_seeds() {
                super::reject(&crate::$name::mutants(), super::MANY, 1.0);
            }
        }
    )*};
}

/// The tests, by the list of mutants they run.
mod tests {
    use super::{MANY, SOME, reject};
    rejected!(bsdfs, cameras, integrators, lights, pickers, samplers, shapes);
}
