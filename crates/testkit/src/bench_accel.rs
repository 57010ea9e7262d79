use etendue_bvh::Accel;
use etendue_core::{Clock, Ray, Vec3A};
use etendue_sampling::{Dim, Independent, Sampler, warp};

/// How fast a ray-query structure answers, by kind of ray.
#[derive(Clone, Debug, PartialEq)]
pub struct AccelSpeed {
    /// The kind of ray.
    pub kind: &'static str,
    /// Rays asked.
    pub rays: usize,
    /// How many hit: the same for every right structure over the same geometry.
    pub hits: usize,
    /// Seconds by the clock handed in.
    pub seconds: f64,
}

impl AccelSpeed {
    /// Million rays a second.
    pub fn mrays(&self) -> f64 {
        self.rays as f64 / self.seconds.max(1e-12) / 1e6
    }
}

/// Asks a structure `n` rays of each kind and times them: coherent rays from a camera, rays scattered from what those
/// hit, short any-hit rays, and lines through the bounds. The rays depend on the geometry alone, so two structures
/// can be compared ray by ray; alternate them to be fair to both.
pub fn bench_accel(accel: &dyn Accel, n: usize, clock: &dyn Clock) -> Vec<AccelSpeed> {
    let bounds = accel.bounds();
    let (center, radius) = (bounds.center(), bounds.radius().max(f32::MIN_POSITIVE));
    let sampler = Independent::new(1, 1);
    let draw = |kind: u64, i: usize, dim| sampler.start(kind, i as u64).get_2d(dim);

    let side = (n as f64).sqrt().ceil().max(1.0) as usize;
    let eye = center + Vec3A::new(0.4, 0.5, 1.0) * (1.6 * radius);
    let primary: Vec<Ray> = (0..n)
        .map(|i| {
            let (x, y) = ((i % side) as f32 / side as f32 - 0.5, (i / side) as f32 / side as f32 - 0.5);
            let at = center + Vec3A::new(x, y, 0.0) * (1.6 * radius);
            Ray::new(eye, etendue_core::vector::normalize(at - eye))
        })
        .collect();
    let hits: Vec<Vec3A> =
        primary.iter().filter_map(|r| accel.intersect(r).map(|h| r.at(h.t * 0.999))).collect();
    let from = |i: usize| if hits.is_empty() { center } else { hits[(i * 7919) % hits.len()] };
    let diffuse: Vec<Ray> = (0..n).map(|i| Ray::new(from(i), warp::sphere(draw(1, i, Dim::FILM)))).collect();
    let short: Vec<Ray> = (0..n)
        .map(|i| Ray { t_max: 0.2 * radius, ..Ray::new(from(i), warp::sphere(draw(2, i, Dim::FILM))) })
        .collect();
    let lines: Vec<Ray> = (0..n)
        .map(|i| {
            let (a, b) = (warp::sphere(draw(3, i, Dim::FILM)), warp::sphere(draw(3, i, Dim::LENS)));
            Ray::new(center + a * radius, etendue_core::vector::normalize(b - a * 1.000_1))
        })
        .collect();

    let closest = |kind, rays: &[Ray]| {
        let start = clock.seconds();
        let hits = rays.iter().filter(|r| accel.intersect(r).is_some()).count();
        AccelSpeed { kind, rays: rays.len(), hits, seconds: clock.seconds() - start }
    };
    let mut out = vec![closest("primary", &primary), closest("diffuse", &diffuse)];
    let start = clock.seconds();
    let blocked = short.iter().filter(|r| accel.occluded(r)).count();
    out.push(AccelSpeed {
        kind: "short any",
        rays: short.len(),
        hits: blocked,
        seconds: clock.seconds() - start,
    });
    out.push(closest("lines", &lines));
    out
}
