//! Right samplers, cameras and shapes are accepted.

mod support;

use etendue_camera::Perspective;
use etendue_core::{UVec2, Vec3A};
use etendue_geometry::{Parallelogram, Sphere};
use etendue_sampling::{Independent, Sobol, Stratified};
use etendue_testkit::{check_camera, check_sampler, check_shape};
use support::{Case, FEW, MANY, accept};

fn cases() -> Vec<Case<'static>> {
    let view = || {
        let eye = Vec3A::new(1.0, 2.0, 5.0);
        Perspective::look_at(eye, Vec3A::ZERO, Vec3A::Y, 40.0, UVec2::new(64, 48)).expect("a view")
    };
    let lens = view().with_lens(0.2, 4.0).expect("a lens");
    let pinhole = view();
    let sphere = Sphere::new(Vec3A::new(3.0, -2.0, 7.0), 0.6).expect("a sphere");
    let skew = Parallelogram::new(Vec3A::ONE, Vec3A::new(2.0, 0.0, 0.5), Vec3A::new(0.3, 1.5, -0.2));
    let skew = skew.expect("a parallelogram");
    vec![
        Case::new("independent", |b| check_sampler(&|seed| Independent::new(seed, 64), b)),
        Case::new("stratified, a square", |b| check_sampler(&|seed| Stratified::new(seed, 64), b)),
        Case::new("stratified, a prime", |b| check_sampler(&|seed| Stratified::new(seed, 61), b)),
        Case::new("sobol", |b| check_sampler(&|seed| Sobol::new(seed, 64), b)),
        Case::new("sobol, four replicates", |b| {
            check_sampler(&|seed| Sobol::new(seed, 64).with_replicates(4), b)
        }),
        Case::new("pinhole", move |b| check_camera(&pinhole, b)),
        Case::new("thin lens", move |b| check_camera(&lens, b)),
        Case::new("sphere", move |b| check_shape(&sphere, b)),
        Case::new("parallelogram", move |b| check_shape(&skew, b)),
    ]
}

#[test]
fn few_seeds() {
    accept(&cases(), FEW, 1.0);
}

#[test]
#[ignore = "minutes"]
fn hundred_seeds() {
    accept(&cases(), MANY, 1.0);
}
