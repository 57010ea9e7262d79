//! Ray casting, ambient occlusion, the first surface and Whitted's tree against closed forms.

mod support;

use std::f64::consts::PI;

use etendue::integrator::{AmbientOcclusion, FirstSurface, PathTracer, RayCaster, Show, Whitted};
use etendue::material::{Absorber, MirrorMaterial};
use etendue::prelude::*;
use etendue_testkit::{Budget, Radiance, check_integrator};
use support::{assert_mean, lamp, radiance};

const DOWN: Ray = Ray {
    o: Vec3A::new(0.1, 0.5, 0.2),
    d: Vec3A::NEG_Y,
    t_min: 0.0,
    t_max: f32::INFINITY,
    time: 0.0,
    mask: u32::MAX,
};

fn down(_: &Independent) -> Ray {
    DOWN
}

/// A floor, and what is added to it.
fn floor(add: impl FnOnce(&mut SceneBuilder)) -> Scene {
    let mut b = SceneBuilder::new();
    let m = b.material(Diffuse::new(Spectrum::gray(0.6)));
    b.add(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap(), m);
    add(&mut b);
    b.build().unwrap()
}

/// ρ/π · I cos θ / d², summed over the lamps, without noise; what stands between takes it away only if asked to.
#[test]
fn ray_casting_shades_by_the_closed_form() {
    let lamps = [(Vec3A::new(0.1, 2.0, 0.2), 5.0), (Vec3A::new(3.0, 1.0, -2.0), 40.0)];
    let truth: f64 = lamps
        .iter()
        .map(|(p, i)| {
            let d = support::wide(*p - Vec3A::new(0.1, 0.0, 0.2));
            0.6 / PI * i * (d.y / d.length()) / d.length_squared()
        })
        .sum();
    let scene = |blocked: bool| {
        floor(|b| {
            for (p, i) in lamps {
                b.light(PointLight::new(p, Spectrum::gray(i as f32)));
            }
            if blocked {
                let black = b.material(Absorber);
                b.add(Disc::new(Vec3A::new(0.1, 0.9, 0.2), Vec3A::Y, 5.0).unwrap(), black);
            }
        })
    };
    let cast = |shadows| RayCaster { shadows, ..RayCaster::default() };
    for (shadows, blocked) in [(true, false), (false, false), (false, true)] {
        assert_mean(&radiance(&scene(blocked), &cast(shadows), 1, 8, &down), truth, 1e-5, "two lamps");
    }
    assert!(radiance(&scene(true), &cast(true), 1, 8, &down).iter().all(|&x| x == 0.0));
    let names = |c: RayCaster| Integrator::<Independent>::bias(&c);
    assert!(names(cast(false)).iter().any(|b| b.contains("shadows")) && names(cast(true)).len() == 1);
}

/// Where nothing reflects, what is cast is what a path of no scattering event finds, bit for bit.
#[test]
fn ray_casting_black_surfaces_is_depth_zero() {
    let p = etendue::scene::presets::veach_mis();
    let camera =
        Perspective::look_at(p.eye, p.target, Vec3A::Y, p.vertical_fov_deg, UVec2::splat(16)).unwrap();
    let mut b = SceneBuilder::new();
    lamp(&mut b, Sphere::new(Vec3A::ZERO, 2.0).unwrap());
    b.light(ConstantEnvironment::new(Spectrum::rgb(0.1, 0.2, 0.3)));
    let scene = b.build().unwrap();
    let film = |integrator: &dyn Integrator<Sobol>| {
        let mut film = Film::new(UVec2::splat(16), 1).unwrap();
        render(&scene, &camera, integrator, Sobol::new(1, 16), &mut film, &RenderOptions::default()).unwrap();
        film.to_rgb()
    };
    let depth_zero = PathTracer { max_depth: Some(0), ..PathTracer::default() };
    assert_eq!(film(&RayCaster::default()), film(&depth_zero));
}

/// Open above a plane; a half in a corner; 1 − R²/(R² + h²) under a disc; and nothing counts beyond the reach.
#[test]
fn ambient_occlusion_obeys_the_closed_forms() {
    let ao = AmbientOcclusion::default();
    let of = |scene: &Scene, ao: AmbientOcclusion| radiance(scene, &ao, 3, 200_000, &down);
    assert!(of(&floor(|_| {}), ao).iter().all(|&x| x == 1.0));
    let disc = |r: f32, h: f32| {
        floor(move |b| {
            let m = b.material(Absorber);
            // Below the eye.
            b.add(Disc::new(Vec3A::new(0.1, h, 0.2), Vec3A::Y, r).unwrap(), m);
            b.add(Disc::new(Vec3A::new(0.1, 0.0, 0.2), Vec3A::Y, 0.01).unwrap(), m);
        })
    };
    for (r, h) in [(1.0f32, 1.0f32), (3.0, 2.0)] {
        let open = 1.0 - f64::from(r * r) / f64::from(r * r + h * h);
        assert_mean(&of(&disc(r, h), ao), open, 0.03, "a disc");
        // Within h nothing stands; what stands within the distance a beyond h is a smaller disc.
        let near = AmbientOcclusion { reach: 0.99 * h };
        assert!(of(&disc(r, h), near).iter().all(|&x| x == 1.0));
        let reach = 1.2 * h;
        let a2 = f64::from(reach * reach - h * h);
        assert_mean(
            &of(&disc(r, h), AmbientOcclusion { reach }),
            1.0 - a2 / f64::from(reach * reach),
            0.03,
            "reach",
        );
    }
    let corner = floor(|b| {
        let m = b.material(Absorber);
        b.add(Plane::new(Vec3A::X * (0.1 - 1e-5), Vec3A::X).unwrap(), m);
    });
    assert_mean(&of(&corner, ao), 0.5, 0.02, "a corner");
    assert!(Integrator::<Independent>::bias(&ao).iter().any(|b| b.contains("not radiance")));
}

#[test]
fn the_first_surface_is_shown_as_it_is() {
    let scene = floor(|b| b.light(PointLight::new(Vec3A::Y, Spectrum::ONE)));
    let cx = Context::new(&scene);
    let of = |show, d: Vec3A| {
        let s = CameraSample { ray: Ray { d, ..DOWN }, weight: 1.0, spread: 0.0 };
        FirstSurface { show }.li_plain(&cx, &s, Independent::new(1, 1))
    };
    let slanted = Vec3A::new(0.6, -0.8, 0.0);
    assert_eq!(of(Show::Normal, slanted).l, Spectrum::rgb(0.5, 1.0, 0.5));
    assert_eq!(of(Show::GeometricNormal, slanted).l, Spectrum::rgb(0.5, 1.0, 0.5));
    assert!((of(Show::Depth, slanted).l.r() - 0.625).abs() < 1e-6);
    assert_eq!(of(Show::Albedo, slanted).l, Spectrum::gray(0.6));
    assert_eq!(of(Show::Ids, slanted).l, of(Show::Ids, Vec3A::NEG_Y).l);
    for show in [Show::Normal, Show::Depth, Show::Ids, Show::Triangles, Show::Albedo, Show::Uv] {
        let up = of(show, Vec3A::Y);
        assert_eq!((up.l, up.alpha), (Spectrum::BLACK, 0.0), "{show:?}");
        assert_eq!(of(show, slanted).alpha, 1.0);
    }
}

/// Through a slab of glass straight on goes (1 − F)² / (1 − F²) of the light, with every reflection inside; no sample differs from another but
/// by where roulette ends the faint ones.
#[test]
fn whitted_follows_both_rays() {
    let f = 0.04f64;
    let mut b = SceneBuilder::new();
    let glass = b.material(Glass::new(1.5));
    let (x, z) = (Vec3A::X * 20.0, Vec3A::Z * 20.0);
    let corner = Vec3A::new(-10.0, 0.0, -10.0);
    b.add(Parallelogram::new(corner, z, x).unwrap(), glass);
    b.add(Parallelogram::new(corner - Vec3A::Y * 0.5, x, z).unwrap(), glass);
    lamp(&mut b, Parallelogram::new(corner - Vec3A::Y * 2.0, z, x).unwrap());
    let scene = b.build().unwrap();
    let through = (1.0 - f).powi(2) / (1.0 - f * f);
    let xs = radiance(&scene, &Whitted::default(), 5, 2_000, &down);
    assert_mean(&xs, through, 1e-3, "a slab");
    assert!(xs.iter().all(|x| (x - through).abs() < 0.02), "both are followed, not one of them");
    // The mutant follows one: a path.
    assert!(radiance(&scene, &PathTracer::default(), 5, 200, &down).contains(&0.0));
    // Without depth there is nothing to see through; with two refractions, what goes straight through.
    let of = |depth| radiance(&scene, &Whitted { max_depth: Some(depth), ..Whitted::default() }, 5, 4, &down);
    assert!(of(1).iter().all(|&x| x == 0.0));
    assert_mean(&of(2), (1.0 - f).powi(2), 1e-5, "two refractions");
    // A threshold drops the reflections inside, and says so.
    let cut = Whitted { threshold: 0.1, ..Whitted::default() };
    assert_mean(&radiance(&scene, &cut, 5, 4, &down), (1.0 - f).powi(2), 1e-5, "no faint rays");
    assert!(Integrator::<Independent>::bias(&cut).iter().any(|b| b.contains("threshold=0.1")));
}

/// Two perfect mirrors do not hold a ray for ever, nor does a ball of glass seen from inside.
#[test]
fn trees_of_rays_end() {
    let mut b = SceneBuilder::new();
    let mirror = b.material(MirrorMaterial::new(Spectrum::ONE));
    let glass = b.material(Glass::new(1.5));
    b.add(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap(), mirror);
    b.add(Plane::new(Vec3A::Y, Vec3A::NEG_Y).unwrap(), mirror);
    b.add(Sphere::new(Vec3A::new(0.1, 0.5, 0.2), 0.3).unwrap(), glass);
    b.light(PointLight::new(Vec3A::Y * 0.9, Spectrum::ONE));
    let scene = b.build().unwrap();
    let tilted = |u: &Independent| {
        let d = u.get_2d(Dim::FILM) - Vec2::splat(0.5);
        Ray { d: etendue::core::vector::normalize(Vec3A::new(d.x, -1.0, d.y)), ..DOWN }
    };
    assert_eq!(radiance(&scene, &Whitted::default(), 1, 20, &tilted).len(), 20);
}

/// The contract: the same bits however it is called, whatever is heard adds up, numbers only.
#[test]
fn integrators_keep_the_contract() {
    let p = etendue::scene::presets::cornell_box();
    let camera =
        Perspective::look_at(p.eye, p.target, Vec3A::Y, p.vertical_fov_deg, UVec2::splat(8)).unwrap();
    let scene = p.builder.build().unwrap();
    let mut area = etendue::integrator::AreaForm::new(&scene).unwrap();
    area.max_depth = Some(2);
    let direct = PathTracer::direct_only();
    let all: [&dyn Integrator<Sobol>; 7] = [
        &RayCaster::default(),
        &Whitted::default(),
        &AmbientOcclusion::default(),
        &FirstSurface::default(),
        &PathTracer {
            branching: etendue::integrator::Branching { factor: 3, levels: 2 },
            ..PathTracer::default()
        },
        &direct,
        &area,
    ];
    for integrator in all {
        // Each against itself with other seeds: the mean is no question here.
        let truth = Radiance::Same(integrator);
        let make = |seed| Sobol::new(seed, 4);
        let r = check_integrator(integrator, &make, &scene, &camera, &truth, 24, &Budget::default());
        let e = r.err().map(|e| e.to_string());
        assert!(e.as_deref().is_none_or(|e| e.starts_with("variance")), "{e:?}");
    }
}
