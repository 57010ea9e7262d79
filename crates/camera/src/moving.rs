use etendue_core::{Fingerprint, Motion, Needs, UVec2, Vec2, vector};

use crate::{Camera, CameraSample};

/// Why a shutter cannot be set.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShutterError {
    /// Times outside of the scene's interval, or not numbers.
    #[error(
        "a shutter that is open from {open} to {close} leaves the interval of the scene's motion, which is 0 to 1"
    )]
    Outside {
        /// Opening asked for.
        open: f32,
        /// Closing asked for.
        close: f32,
    },
    /// It closes before it opens.
    #[error("a shutter cannot close at {close} and open later, at {open}; exchange the two")]
    Backwards {
        /// Opening asked for.
        open: f32,
        /// Closing asked for.
        close: f32,
    },
}

/// The last moment that a ray can have.
const LAST: f32 = 1.0 - f32::EPSILON * 0.5;

/// A camera whose shutter is open for part of the scene's interval, and which may move itself.
///
/// All instants between `open` and `close` count alike. The camera of time 0 is displaced by the motion at the time of
/// the ray, which is the scene's time: a camera that moves with an object sees it stand still. Closing when it opens
/// freezes that moment, and of itself it asks for no number.
///
/// A shutter around a shutter opens within the inner one's interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Shutter<C> {
    camera: C,
    open: f32,
    close: f32,
    motion: Option<Motion>,
}

impl<C: Camera> Shutter<C> {
    /// A camera that sees the moments from `open` to `close` of the interval \[0, 1\] in which the scene moves.
    ///
    /// # Errors
    /// [`ShutterError`]: times outside of \[0, 1\], NaN among them, or `open` after `close`.
    pub fn new(camera: C, open: f32, close: f32) -> Result<Self, ShutterError> {
        let inside = |t: f32| (0.0..=1.0).contains(&t);
        if !(inside(open) && inside(close)) {
            return Err(ShutterError::Outside { open, close });
        }
        if open > close {
            return Err(ShutterError::Backwards { open, close });
        }
        Ok(Self { camera, open, close, motion: None })
    }

    /// A camera that sees the one moment `time`.
    ///
    /// # Errors
    /// [`ShutterError::Outside`].
    pub fn frozen(camera: C, time: f32) -> Result<Self, ShutterError> {
        Self::new(camera, time, time)
    }

    /// The same camera, moving over the scene's interval.
    #[must_use]
    pub fn with_motion(mut self, motion: Motion) -> Self {
        self.motion = (!motion.is_still()).then_some(motion);
        self
    }

    /// The camera as it is at time 0.
    pub fn camera(&self) -> &C {
        &self.camera
    }

    /// What it does then.
    pub fn motion(&self) -> Option<&Motion> {
        self.motion.as_ref()
    }
}

impl<C: Camera> Camera for Shutter<C> {
    fn resolution(&self) -> UVec2 {
        self.camera.resolution()
    }

    fn ray(&self, film: Vec2, lens: Vec2, time: f32) -> Option<CameraSample> {
        let at = self.open + (self.close - self.open) * time;
        let mut s = self.camera.ray(film, lens, if at < LAST { at } else { LAST })?;
        if let Some(motion) = &self.motion {
            let placed = motion.at(s.ray.time);
            s.ray.o = placed.point(s.ray.o);
            s.ray.d = vector::try_normalize(placed.vector(s.ray.d))?;
        }
        Some(s)
    }

    fn needs(&self) -> Needs {
        let mut needs = self.camera.needs();
        if self.open == self.close {
            // Whatever moves inside is frozen as well.
            needs.remove(Needs::MOTION);
        } else if self.motion.is_some() {
            needs |= Needs::MOTION;
        }
        needs
    }

    fn exposure(&self) -> [f32; 2] {
        let [open, close] = self.camera.exposure();
        [open + (close - open) * self.open, open + (close - open) * self.close]
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("shutter");
        f.floats(&[self.open, self.close]);
        if let Some(motion) = &self.motion {
            motion.fingerprint(f);
        }
        self.camera.fingerprint(f);
    }
}
