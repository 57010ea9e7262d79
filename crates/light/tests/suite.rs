//! Every built-in light and picker through its check suite.

use std::sync::Arc;

use etendue_core::{Motion, Ray, Spectrum, Transform, Vec3A, vector};
use etendue_geometry::{Cylinder, Disc, Parallelogram, Shape, Sphere};
use etendue_light::{
    ConstantEnvironment, DiscLight, ImageEnvironment, Light, LightId, LitPoint, MeshLight, MovingLight,
    ParallelogramLight, PointLight, PowerPicker, ShapeLight, Sides, SphereLight, UniformPicker,
};
use etendue_testkit::{Budget, Seen, check_light, check_picker, lit_point};
use etendue_texture::{ImageTexture, Tex};

/// Lights, pickers and seeds that share one level.
const CALLS: usize = 38;

fn budgets() -> impl Iterator<Item = Budget> {
    (1..=2).map(|seed| Budget::default().shared(CALLS).seed(seed).effort(0.2))
}

fn points() -> [LitPoint; 4] {
    let tilted = vector::normalize(Vec3A::new(0.3, 1.0, -0.2));
    let mut through = lit_point(Vec3A::new(1.5, 1.8, 0.9), -tilted);
    through.sides = Sides::Both;
    [
        lit_point(Vec3A::new(0.1, -2.0, 0.2), tilted),
        // The light is half below the horizon of this one.
        lit_point(Vec3A::new(0.1, -2.0, 0.2), Vec3A::NEG_X),
        through,
        lit_point(Vec3A::new(30.0, -80.0, 50.0), Vec3A::ZERO),
    ]
}

fn check(name: &str, light: &dyn Light, seen: &Seen<'_>) {
    for budget in budgets() {
        if let Err(failure) = check_light(light, 0, &points(), seen, &budget) {
            panic!("{name}, seed {}: {failure}", budget.seed);
        }
    }
}

fn check_on(name: &str, light: &dyn Light, shape: &dyn Shape) {
    check(name, light, &|ray: &Ray| shape.intersect(ray).map(|h| shape.surface(ray, &h)));
}

#[test]
fn every_light_keeps_the_contract() {
    let white = || Tex::gray(3.0);
    let square = Parallelogram::new(Vec3A::new(-0.5, 0.0, -0.4), Vec3A::Z, Vec3A::X * 0.7).expect("a square");
    let skew = Parallelogram::new(Vec3A::new(-0.3, 0.1, -0.5), Vec3A::X, Vec3A::new(0.4, 0.2, 0.8));
    let skew = skew.expect("an area");
    let ball = Sphere::new(Vec3A::new(0.1, 0.2, -0.1), 0.5).expect("a ball");
    let sky = ImageTexture::from_f32(8, 4, 1, (0..32).map(|i| if i == 13 { 50.0 } else { 0.2 }).collect());
    let sky = ImageEnvironment::new(sky.expect("an image"), 1.0, 0.4).expect("a sky");
    check("point", &PointLight::new(Vec3A::new(0.1, 0.5, 0.0), Spectrum::rgb(1.0, 2.0, 3.0)), &|_| None);
    check("constant environment", &ConstantEnvironment::new(Spectrum::ONE), &|_| None);
    check("image environment", &sky, &|_| None);
    check_on("rectangle", &ParallelogramLight::new(square, white()), &square);
    check_on("parallelogram", &ParallelogramLight::new(skew, white()).with_two_sided(true), &skew);
    check_on("sphere", &SphereLight::new(ball, white()), &ball);
    check_on("shape", &ShapeLight::new(Arc::new(skew), None, white(), true), &skew);
    let disc = Disc::new(Vec3A::new(0.1, 0.2, -0.1), Vec3A::new(0.2, -1.0, 0.1), 0.5).expect("a disc");
    check_on("disc", &ShapeLight::new(Arc::new(disc), None, white(), false), &disc);
    check_on("disc, both sides", &ShapeLight::new(Arc::new(disc), None, white(), true), &disc);
    check_on("disc by solid angle", &DiscLight::new(disc, white()), &disc);
    let tube = Cylinder::new(Vec3A::new(-0.4, 0.1, -0.2), Vec3A::new(0.5, 0.4, 0.1), 0.3).expect("a tube");
    // Of the outside alone: through its ends it would hide a part of its own inside.
    check_on("cylinder", &ShapeLight::new(Arc::new(tube), None, white(), false), &tube);
    // Half of a parallelogram, found through the whole.
    let quad = etendue_geometry::presets::quad(skew.origin(), skew.edge_u(), skew.edge_v());
    let mesh = MeshLight::new(Arc::new(quad), None, white(), true);
    check("triangle", &mesh, &|ray: &Ray| {
        let hit = skew.intersect(ray).filter(|h| h.uv.y <= h.uv.x)?;
        Some(skew.surface(ray, &hit))
    });
}

/// Lamps of moving instances and others, at several times.
#[test]
fn moving_lights_keep_the_contract_at_every_time() {
    const TIMES: [f32; 4] = [0.0, 0.25, 0.7, 1.0 - f32::EPSILON];
    let calls = 2 * 7 * TIMES.len();
    let check = |name: &str, light: &dyn Light, seen: &Seen<'_>| {
        for (time, seed) in TIMES.into_iter().flat_map(|t| [(t, 1), (t, 2)]) {
            let points = points().map(|at| LitPoint { time, ..at });
            let budget = Budget::default().shared(calls).seed(seed).effort(0.1);
            if let Err(failure) = check_light(light, 0, &points, seen, &budget) {
                panic!("{name} at {time}, seed {seed}: {failure}");
            }
        }
    };
    let white = || Tex::gray(3.0);
    let motion = Motion::new(Vec3A::new(0.3, 1.0, 0.2), 2.5, Vec3A::X * 0.3, Vec3A::new(0.4, 0.3, -0.5));
    let motion = motion.expect("finite");
    let start = Transform::from_columns(
        Vec3A::new(1.1, 0.2, 0.0),
        Vec3A::new(0.0, 0.7, 0.3),
        Vec3A::new(0.1, 0.0, -1.2),
        Vec3A::new(0.2, 0.1, -0.1),
    );
    let start = start.expect("regular");
    // As a hierarchy finds it: by way of the placement at the ray's time.
    let traced = |shape: &dyn Shape, start: &Transform, ray: &Ray| {
        let placed = motion.placement(start, ray.time);
        let (object, _) = placed.ray_to_object(ray);
        let hit = shape.intersect(&object)?;
        let mut surface = shape.surface(&object, &hit).transformed(&placed);
        surface.time = ray.time;
        Some(surface)
    };
    let skew = Parallelogram::new(Vec3A::new(-0.3, 0.1, -0.5), Vec3A::X, Vec3A::new(0.4, 0.2, 0.8));
    let skew = skew.expect("an area");
    let ball = Sphere::new(Vec3A::new(0.1, 0.2, -0.1), 0.5).expect("a ball");
    let still = Transform::IDENTITY;
    let moving = |light: Arc<dyn Light>, start: &Transform| MovingLight::of_instance(light, start, motion);
    let square = Parallelogram::new(Vec3A::new(-0.5, 0.0, -0.4), Vec3A::Z, Vec3A::X * 0.7).expect("a square");
    let rectangle = moving(Arc::new(ParallelogramLight::new(square, white())), &still);
    check("rectangle", &rectangle, &|ray| traced(&square, &still, ray));
    let sphere = moving(Arc::new(SphereLight::new(ball, white())), &still);
    check("sphere", &sphere, &|ray| traced(&ball, &still, ray));
    let shape = moving(Arc::new(ShapeLight::new(Arc::new(skew), Some(start), white(), true)), &start);
    check("placed shape", &shape, &|ray| traced(&skew, &start, ray));
    let quad = Arc::new(etendue_geometry::presets::quad(skew.origin(), skew.edge_u(), skew.edge_v()));
    let mesh = moving(Arc::new(MeshLight::new(quad, Some(start), white(), false)), &start);
    check("placed triangle", &mesh, &|ray| {
        let placed = motion.placement(&start, ray.time);
        let hit = skew.intersect(&placed.ray_to_object(ray).0).filter(|h| h.uv.y <= h.uv.x)?;
        let _ = hit;
        traced(&skew, &start, ray)
    });
    let pattern =
        Tex::image(Arc::new(ImageTexture::from_f32(2, 2, 1, vec![1.0, 2.0, 4.0, 0.5]).expect("an image")));
    let textured = moving(Arc::new(ShapeLight::new(Arc::new(skew), Some(start), pattern, false)), &start);
    check("textured shape", &textured, &|ray| traced(&skew, &start, ray));
    let point = PointLight::new(Vec3A::new(0.1, 0.5, 0.0), Spectrum::rgb(1.0, 2.0, 3.0));
    check("point", &MovingLight::new(Arc::new(point), motion), &|_| None);
    let sky = ImageTexture::from_f32(8, 4, 1, (0..32).map(|i| if i == 13 { 50.0 } else { 0.2 }).collect());
    let sky = ImageEnvironment::new(sky.expect("an image"), 1.0, 0.4).expect("a sky");
    check("image environment", &MovingLight::new(Arc::new(sky), motion), &|_| None);
}

#[test]
fn every_picker_keeps_the_contract() {
    let lights: Vec<Arc<dyn Light>> = [0.1, 3.0, 0.5, 0.0]
        .map(|power| Arc::new(PointLight::new(Vec3A::ONE, Spectrum::gray(power))) as Arc<dyn Light>)
        .to_vec();
    let ids: Vec<LightId> = (0..4).map(|light| LightId { light, part: 0 }).collect();
    let shines = |_: &LitPoint, id: LightId| id.light < 3;
    let power = PowerPicker::new(&lights, 1.0).expect("something shines");
    let uniform = UniformPicker::new(&lights).expect("something is there");
    for budget in budgets() {
        check_picker(&power, &ids, &points(), &shines, &budget).expect("by power");
        check_picker(&uniform, &ids, &points(), &shines, &budget).expect("uniform");
    }
}
