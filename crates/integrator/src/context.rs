use std::cell::Cell;

use etendue_scene::Scene;

/// How often each kind of work was done. What a scene does not have stays exactly zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Rays from the camera.
    pub camera_rays: u64,
    /// Rays that continue a path.
    pub scatter_rays: u64,
    /// Visibility questions toward lights.
    pub shadow_rays: u64,
    /// Lights picked.
    pub light_picks: u64,
    /// MIS weights evaluated.
    pub mis_weights: u64,
    /// Texture look-ups of materials.
    pub texture_fetches: u64,
    /// Rays that left the scene and were looked up in a light at infinity.
    pub escapes: u64,
    /// Paths ended by roulette.
    pub roulette_ends: u64,
    /// Random numbers drawn for the pixel filter (2 each).
    pub draws_film: u64,
    /// Random numbers drawn for the lens (2 each).
    pub draws_lens: u64,
    /// Random numbers drawn for the time.
    pub draws_time: u64,
    /// Random numbers drawn for lights (2 each).
    pub draws_light: u64,
    /// Random numbers drawn for BSDFs (3 each).
    pub draws_bsdf: u64,
    /// Random numbers drawn for roulette.
    pub draws_roulette: u64,
    /// Random numbers drawn for cut-outs.
    pub draws_cutout: u64,
}

impl Counts {
    /// All rays.
    pub fn rays(&self) -> u64 {
        self.camera_rays + self.scatter_rays + self.shadow_rays
    }

    /// All random numbers.
    pub fn sampler_draws(&self) -> u64 {
        self.draws_film
            + self.draws_lens
            + self.draws_time
            + self.draws_light
            + self.draws_bsdf
            + self.draws_roulette
            + self.draws_cutout
    }

    pub(crate) fn add(&mut self, o: &Self) {
        for (a, b) in self.fields_mut().into_iter().zip(o.fields()) {
            *a += b;
        }
    }

    fn fields(&self) -> [u64; 15] {
        let mut copy = *self;
        copy.fields_mut().map(|v| *v)
    }

    fn fields_mut(&mut self) -> [&mut u64; 15] {
        [
            &mut self.camera_rays,
            &mut self.scatter_rays,
            &mut self.shadow_rays,
            &mut self.light_picks,
            &mut self.mis_weights,
            &mut self.texture_fetches,
            &mut self.escapes,
            &mut self.roulette_ends,
            &mut self.draws_film,
            &mut self.draws_lens,
            &mut self.draws_time,
            &mut self.draws_light,
            &mut self.draws_bsdf,
            &mut self.draws_roulette,
            &mut self.draws_cutout,
        ]
    }
}

/// What an integrator works with: the scene, and counters of its own (one context per task, so counting needs no
/// locks and sums do not depend on scheduling).
pub struct Context<'a> {
    /// The scene.
    pub scene: &'a Scene,
    counts: Cell<Counts>,
}

impl<'a> Context<'a> {
    /// A context whose counters stand at zero.
    pub fn new(scene: &'a Scene) -> Self {
        Self { scene, counts: Cell::new(Counts::default()) }
    }

    /// Changes the counters.
    #[inline]
    pub fn count(&self, f: impl FnOnce(&mut Counts)) {
        let mut c = self.counts.get();
        f(&mut c);
        self.counts.set(c);
    }

    /// The counters so far.
    pub fn counts(&self) -> Counts {
        self.counts.get()
    }
}
