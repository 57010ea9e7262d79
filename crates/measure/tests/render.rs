//! Renders as estimators: the film of a run is the film of one call, and the numbers are those of `compare`.

mod common;

use common::Wound;
use etendue_camera::{Film, Perspective};
use etendue_core::{UVec2, Vec3A};
use etendue_integrator::{PathTracer, RenderOptions, render};
use etendue_measure::{
    Axis, Budget, Clocks, Contender, Estimator, Metric, Reference, RenderRun, compare, convergence,
};
use etendue_sampling::{Sobol, Stratified};
use etendue_scene::Scene;
use etendue_scene::presets::empty_cornell_box;

const SIZE: UVec2 = UVec2::new(12, 10);

fn view() -> (Scene, Perspective) {
    let p = empty_cornell_box();
    let camera = Perspective::look_at(p.eye, p.target, Vec3A::Y, p.vertical_fov_deg, SIZE).expect("a camera");
    (p.builder.build().expect("a scene"), camera)
}

fn film(scene: &Scene, camera: &Perspective, seed: u64, spp: u32, replicates: u32) -> Film {
    let mut film = Film::new(SIZE, replicates).expect("a film");
    let sampler = Sobol::new(seed, spp).with_replicates(replicates);
    let options = RenderOptions::default();
    render(scene, camera, &PathTracer::default(), sampler, &mut film, &options).expect("a render");
    film
}

#[test]
fn a_run_is_a_render_in_parts() {
    let (scene, camera) = view();
    let tracer = PathTracer::default();
    let reference = Reference::from_film(&film(&scene, &camera, 99, 256, 4)).expect("four replicates");
    assert!(reference.residual.relative > 0.0 && reference.residual.trimmed <= reference.residual.relative);
    let run =
        |seed: u64| RenderRun::new(&scene, &camera, &tracer, move |n| Sobol::new(seed, n)).expect("a film");
    let clock = Wound::default();
    let runs = (1..=3).map(|seed| Box::new(run(seed)) as Box<dyn Estimator>).collect();
    let c = Contender { name: "path".into(), runs };
    let clocks = Clocks { wall: &clock, cpu: None };
    let curve =
        convergence(c, Some(&reference), &Budget { spp: 16, seconds: None }, clocks).expect("a curve");
    for p in &curve.points {
        let errors: Vec<_> = (1..=3)
            .map(|seed| compare(&film(&scene, &camera, seed, p.spp as u32, 1).to_rgb(), &reference.rgb))
            .collect::<Result<_, _>>()
            .expect("one size");
        let mean = |f: fn(&etendue_measure::Comparison) -> f64| errors.iter().map(f).sum::<f64>() / 3.0;
        for (metric, want) in [
            (Metric::Relative, mean(|c| c.relative_mse)),
            (Metric::Trimmed, mean(|c| c.relative_mse_trimmed)),
            (Metric::Absolute, mean(|c| c.rmse.powi(2))),
        ] {
            let got = p.error(metric).expect("a reference").value;
            assert!((got / want - 1.0).abs() < 1e-9, "{metric:?} at {}: {got}, not {want}", p.spp);
        }
        assert!(p.costs[0].rays > p.costs[0].samples);
    }
    let slope = curve.slope(Metric::Relative, Axis::Samples).expect("a slope");
    assert!(slope.value < -0.8, "{slope:?}");
}

#[test]
fn strata_are_divided_anew_and_a_reset_forgets() {
    let (scene, camera) = view();
    let tracer = PathTracer::default();
    let sampler = |n| Stratified::new(5, n);
    let mut run = RenderRun::new(&scene, &camera, &tracer, sampler).expect("a film").anew();
    assert!(run.starts_anew());
    run.draw(0..4).expect("drawn");
    run.reset();
    assert_eq!(run.film().total_samples(), 0);
    run.draw(0..16).expect("drawn");
    let mut whole = Film::new(SIZE, 1).expect("a film");
    render(&scene, &camera, &tracer, Stratified::new(5, 16), &mut whole, &RenderOptions::default())
        .expect("a render");
    assert_eq!(run.film().digest(), whole.digest());
}

#[test]
fn a_film_without_replicates_is_no_reference() {
    let (scene, camera) = view();
    assert_eq!(Reference::from_film(&film(&scene, &camera, 1, 4, 1)), None);
}
