use std::error::Error;
use std::ops::Range;

use etendue_camera::{Camera, Film, FilmError, Filter};
use etendue_core::Progress;
use etendue_integrator::{Ended, Integrator, RenderOptions, render};
use etendue_sampling::Sampler;
use etendue_scene::Scene;

/// What a call to [`Estimator::draw`] did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drawn {
    /// Samples drawn.
    pub samples: u64,
    /// Rays traced, if there are any.
    pub rays: u64,
    /// Samples that were no usable numbers.
    pub rejected: u64,
    /// Whether it was stopped before all samples asked for were there.
    pub stopped: bool,
}

/// Anything that estimates a picture sample by sample: a render, or an integral as a picture of one pixel. One value
/// is one run, with random numbers of its own.
pub trait Estimator {
    /// Adds the samples with these indices to every pixel. Called with ranges that follow each other from 0; the call
    /// alone is timed.
    ///
    /// # Errors
    /// Whatever goes wrong; it ends the measurement.
    fn draw(&mut self, indices: Range<u64>) -> Result<Drawn, Box<dyn Error + Send + Sync>>;

    /// Forgets all samples.
    fn reset(&mut self);

    /// The mean of all samples, linear, row by row.
    fn picture(&self) -> Vec<[f32; 3]>;

    /// Whether fewer samples than planned are no picture, as for a sampler that divides a number of samples into
    /// strata. Every point of the curve then begins anew, and costs what it alone costs.
    fn starts_anew(&self) -> bool {
        false
    }
}

/// An estimator with a name, in independent runs.
pub struct Contender<'a> {
    /// What the curve is called.
    pub name: String,
    /// The runs: they differ in nothing but their random numbers.
    pub runs: Vec<Box<dyn Estimator + 'a>>,
}

/// A picture under way: [`render`] as an [`Estimator`].
pub struct RenderRun<'a, S> {
    scene: &'a Scene,
    camera: &'a dyn Camera,
    integrator: &'a dyn Integrator<S>,
    sampler: Box<dyn Fn(u32) -> S + 'a>,
    filter: Filter,
    progress: &'a dyn Progress,
    film: Film,
    anew: bool,
}

impl<'a, S: Sampler> RenderRun<'a, S> {
    /// A render without samples. `sampler` makes the sampler for a number of samples per pixel, with the seed of this
    /// run.
    ///
    /// # Errors
    /// A picture without pixels, or one that does not fit in memory.
    pub fn new(
        scene: &'a Scene,
        camera: &'a dyn Camera,
        integrator: &'a dyn Integrator<S>,
        sampler: impl Fn(u32) -> S + 'a,
    ) -> Result<Self, FilmError> {
        let film = Film::new(camera.resolution(), sampler(1).replicates())?;
        let sampler = Box::new(sampler);
        Ok(Self {
            scene,
            camera,
            integrator,
            sampler,
            filter: Filter::default(),
            progress: &(),
            film,
            anew: false,
        })
    }

    /// With another pixel filter.
    #[must_use]
    pub fn filter(mut self, filter: Filter) -> Self {
        self.filter = filter;
        self
    }

    /// With a handle that can stop it.
    #[must_use]
    pub fn progress(mut self, progress: &'a dyn Progress) -> Self {
        self.progress = progress;
        self
    }

    /// Begins anew at every number of samples: for a sampler that divides them into strata.
    #[must_use]
    pub fn anew(mut self) -> Self {
        self.anew = true;
        self
    }

    /// What is in the film.
    pub fn film(&self) -> &Film {
        &self.film
    }
}

impl<S: Sampler> Estimator for RenderRun<'_, S> {
    fn draw(&mut self, indices: Range<u64>) -> Result<Drawn, Box<dyn Error + Send + Sync>> {
        let spp = u32::try_from(indices.end).map_err(|_| "more than 2^32 samples per pixel")?;
        let options = RenderOptions {
            samples: Some(indices),
            filter: self.filter,
            progress: self.progress,
            ..RenderOptions::default()
        };
        let sampler = (self.sampler)(spp);
        let report = render(self.scene, self.camera, self.integrator, sampler, &mut self.film, &options)?;
        Ok(Drawn {
            samples: report.samples,
            rays: report.counts.rays(),
            rejected: report.rejected,
            stopped: report.ended != Ended::Complete,
        })
    }

    fn reset(&mut self) {
        self.film.clear();
    }

    fn picture(&self) -> Vec<[f32; 3]> {
        self.film.to_rgb()
    }

    fn starts_anew(&self) -> bool {
        self.anew
    }
}
