use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use etendue_camera::{Camera, CameraSample, Film, FilterSampler, FirstHit, Planes, Tile, TileRect};
use etendue_core::{Needs, Spectrum, UVec2, Vec2};
use etendue_sampling::{Dim, Sampler};
use etendue_scene::Scene;

use crate::{
    Context, Counts, Ended, FirstHitRecorder, Integrator, Recorder, Rejected, RenderError, RenderOptions,
    Report,
};

/// Samples of one pixel handed to the integrator at a time.
const BATCH: usize = 16;

/// The random stream of a pixel: its place, independent of the picture's size and of tiles.
pub fn stream_of(pixel: UVec2) -> u64 {
    u64::from(pixel.y) << 32 | u64::from(pixel.x)
}

/// Everything one task needs to make samples of a pixel.
struct Job<'a, S: Sampler> {
    scene: &'a Scene,
    camera: &'a dyn Camera,
    integrator: &'a dyn Integrator<S>,
    sampler: S,
    filter: FilterSampler,
    needs: Needs,
}

/// A camera sample on its way.
struct Started<S> {
    sample: CameraSample,
    /// Camera weight times filter weight.
    weight: f32,
    u: S,
}

impl<S: Sampler> Job<'_, S> {
    fn start(&self, cx: &Context<'_>, pixel: UVec2, index: u64) -> Option<Started<S>> {
        let u = self.sampler.start(stream_of(pixel), index);
        let f = self.filter.sample(u.get_2d(Dim::FILM));
        let film = Vec2::new(pixel.x as f32 + 0.5, pixel.y as f32 + 0.5) + f.offset;
        let lens = self.needs.contains(Needs::LENS);
        let motion = self.needs.contains(Needs::MOTION);
        cx.count(|c| {
            c.draws_film += 2;
            c.draws_lens += if lens { 2 } else { 0 };
            c.draws_time += u64::from(motion);
        });
        let at = if lens { u.get_2d(Dim::LENS) } else { Vec2::ZERO };
        let time = if motion { u.get_1d(Dim::TIME) } else { 0.0 };
        let sample = self.camera.ray(film, at, time)?;
        cx.count(|c| c.camera_rays += 1);
        Some(Started { sample, weight: sample.weight * f.weight, u })
    }

    /// Draws the samples `indices` of one pixel into the tile.
    fn pixel(
        &self,
        cx: &Context<'_>,
        tile: &mut Tile,
        pixel: UVec2,
        indices: std::ops::Range<u64>,
        planes: Planes,
        rejected: &mut Vec<Rejected>,
    ) {
        let replicates = u64::from(self.sampler.replicates().max(1));
        let mut add = |tile: &mut Tile, index: u64, l: Spectrum| {
            if !tile.add(pixel, (index % replicates) as u32, l) {
                rejected.push(Rejected { pixel, index, value: l });
            }
        };
        if planes.any() {
            for index in indices {
                let Some(s) = self.start(cx, pixel, index) else {
                    add(tile, index, Spectrum::BLACK);
                    continue;
                };
                let mut rec = FirstHitRecorder { planes, first: None };
                let out = self.integrator.li(cx, &s.sample, s.u, &mut rec);
                tile.add_alpha(pixel, out.alpha);
                if let Some(first) = rec.first {
                    tile.add_first_hit(pixel, index, &first);
                }
                add(tile, index, out.l * s.weight);
            }
            return;
        }
        let mut paths = Vec::with_capacity(BATCH);
        let mut tags = Vec::with_capacity(BATCH);
        let mut out = [crate::Sample::default(); BATCH];
        for index in indices.clone() {
            match self.start(cx, pixel, index) {
                Some(s) => {
                    paths.push((s.sample, s.u));
                    tags.push((index, s.weight));
                }
                None => add(tile, index, Spectrum::BLACK),
            }
            if paths.len() == BATCH || index + 1 == indices.end {
                out.fill(crate::Sample::default());
                self.integrator.li_batch(cx, &paths, &mut out[..paths.len()]);
                for (&(index, weight), o) in tags.iter().zip(&out) {
                    add(tile, index, o.l * weight);
                }
                paths.clear();
                tags.clear();
            }
        }
    }
}

/// Fills a film: the main call.
///
/// Runs on the *current* rayon pool with the feature `parallel`, else on this thread; the film's bits are the same
/// either way. Samples are drawn in passes over the whole picture, so that a stopped render is noisier, not partly
/// black; whatever is in the film at any moment is valid.
///
/// # Errors
/// Film, camera and sampler that do not fit together; a time budget without a clock.
pub fn render<S: Sampler>(
    scene: &Scene,
    camera: &dyn Camera,
    integrator: &dyn Integrator<S>,
    sampler: S,
    film: &mut Film,
    options: &RenderOptions<'_>,
) -> Result<Report, RenderError> {
    if film.size() != camera.resolution() {
        return Err(RenderError::Size { film: film.size(), camera: camera.resolution() });
    }
    if film.replicates() != sampler.replicates() {
        return Err(RenderError::Replicates { film: film.replicates(), sampler: sampler.replicates() });
    }
    if options.seconds.is_some() && options.clock.is_none() {
        return Err(RenderError::NoClock);
    }
    let started = options.clock.map(|c| c.seconds());
    let elapsed = || Some(options.clock?.seconds() - started?);
    let needs = scene.needs() | camera.needs();
    let job = Job { scene, camera, integrator, sampler, filter: options.filter.sampler(), needs };
    let size = film.size();
    let (replicates, planes) = (film.replicates(), film.planes());
    let indices = options.samples.clone().unwrap_or(0..u64::from(sampler.spp()));
    let pixels = u64::from(size.x) * u64::from(size.y);
    let total = indices.end.saturating_sub(indices.start).saturating_mul(pixels);
    // Any side gives the same picture; absurd ones would only cost memory.
    let tiles = TileRect::split(size, options.tile.clamp(4, 256));

    let done = AtomicU64::new(0);
    let (told, out_of_memory) = (Mutex::new(0), AtomicBool::new(false));
    let shared = Mutex::new((film, Counts::default(), Vec::<Rejected>::new(), 0u64));
    let cancelled = || options.progress.cancelled();
    let run_tile = |rect: &TileRect, pass: &std::ops::Range<u64>| {
        if cancelled() {
            return;
        }
        let cx = Context::new(job.scene);
        let Ok(mut tile) = Tile::try_new(*rect, replicates, planes) else {
            out_of_memory.store(true, Ordering::Relaxed);
            return;
        };
        let (mut rejected, mut drawn) = (Vec::new(), 0);
        for pixel in rect.iter() {
            if cancelled() {
                break;
            }
            job.pixel(&cx, &mut tile, pixel, pass.clone(), planes, &mut rejected);
            drawn += pass.end - pass.start;
        }
        // A panic elsewhere must not lose this tile: the sums are plain integers and stay valid.
        let mut guard = shared.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let (film, counts, all_rejected, rejected_count) = &mut *guard;
        film.absorb(&tile);
        counts.add(&cx.counts());
        *rejected_count += rejected.len() as u64;
        all_rejected.append(&mut rejected);
        if all_rejected.len() > 4 * Report::REJECTED_KEPT {
            keep_first(all_rejected);
        }
        // The listener is foreign code: it must not run under the lock, nor two at a time.
        drop(guard);
        let so_far = done.fetch_add(drawn, Ordering::Relaxed) + drawn;
        if let Ok(mut last) = told.try_lock()
            && *last < so_far
        {
            *last = so_far;
            options.progress.update(so_far, total);
        }
    };

    let mut ended = Ended::Complete;
    let mut complete = indices.start..indices.start;
    for pass in passes(indices, options.seconds.is_some()) {
        for_each_tile(&tiles, |rect| run_tile(rect, &pass));
        if out_of_memory.load(Ordering::Relaxed) {
            return Err(RenderError::OutOfMemory);
        }
        if cancelled() && done.load(Ordering::Relaxed) < total {
            ended = Ended::Cancelled;
            break;
        }
        complete.end = pass.end;
        if let (Some(budget), Some(t)) = (options.seconds, elapsed())
            && t >= budget
            && done.load(Ordering::Relaxed) < total
        {
            ended = Ended::Time;
            break;
        }
    }
    options.progress.update(done.load(Ordering::Relaxed), total);
    let (_, counts, mut rejected_at, rejected) =
        shared.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    keep_first(&mut rejected_at);
    Ok(Report {
        samples: done.into_inner(),
        complete,
        counts,
        rejected,
        rejected_at,
        ended,
        needs,
        bias: integrator.bias(),
        seconds: elapsed(),
    })
}

/// Ranges of sample indices that cover the whole picture one after the other: short at first, so that something is
/// there soon, then longer; under a time budget never so long that the end is overshot by much.
fn passes(indices: std::ops::Range<u64>, timed: bool) -> impl Iterator<Item = std::ops::Range<u64>> {
    let longest = if timed { 4 } else { 64 };
    let mut at = indices.start;
    let mut step = 1;
    std::iter::from_fn(move || {
        if at >= indices.end {
            return None;
        }
        let end = at.saturating_add(step).min(indices.end);
        let pass = at..end;
        at = end;
        step = (step * 2).min(longest);
        Some(pass)
    })
}

/// The lowest rejected samples by index and pixel: an order that does not depend on scheduling.
fn keep_first(rejected: &mut Vec<Rejected>) {
    rejected.sort_by_key(|r| (r.index, r.pixel.y, r.pixel.x));
    rejected.truncate(Report::REJECTED_KEPT);
}

#[cfg(feature = "parallel")]
fn for_each_tile(tiles: &[TileRect], f: impl Fn(&TileRect) + Sync + Send) {
    use rayon::prelude::*;
    tiles.par_iter().with_max_len(1).for_each(f);
}

#[cfg(not(feature = "parallel"))]
fn for_each_tile(tiles: &[TileRect], f: impl Fn(&TileRect) + Sync + Send) {
    tiles.iter().for_each(f);
}

/// One sample walked alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Replay {
    /// The camera sample; `None` where the camera is blind.
    pub camera: Option<CameraSample>,
    /// What the film got: radiance times camera and filter weight.
    pub contribution: Spectrum,
    /// The first surface.
    pub first: Option<FirstHit>,
}

/// Walks one sample alone, telling `rec` every event: the bits that [`render`] added to the film for this pixel and
/// index under the same options.
#[allow(clippy::too_many_arguments)]
pub fn replay<S: Sampler>(
    scene: &Scene,
    camera: &dyn Camera,
    integrator: &dyn Integrator<S>,
    sampler: S,
    options: &RenderOptions<'_>,
    pixel: UVec2,
    index: u64,
    rec: &mut dyn Recorder,
) -> Replay {
    let needs = scene.needs() | camera.needs();
    let job = Job { scene, camera, integrator, sampler, filter: options.filter.sampler(), needs };
    let cx = Context::new(scene);
    let Some(s) = job.start(&cx, pixel, index) else {
        return Replay { camera: None, contribution: Spectrum::BLACK, first: None };
    };
    let mut both = Both { first: FirstHitRecorder { planes: Planes::ALL, first: None }, rec };
    let out = integrator.li(&cx, &s.sample, s.u, &mut both);
    Replay { camera: Some(s.sample), contribution: out.l * s.weight, first: both.first.first }
}

/// Tells two recorders.
struct Both<'a> {
    first: FirstHitRecorder,
    rec: &'a mut dyn Recorder,
}

impl Recorder for Both<'_> {
    fn vertex(&mut self, v: &crate::Vertex<'_>) {
        self.first.vertex(v);
        self.rec.vertex(v);
    }
    fn contribution(&mut self, c: &crate::Contribution) {
        self.rec.contribution(c);
    }
}
