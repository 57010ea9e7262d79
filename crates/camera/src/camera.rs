use etendue_core::{Fingerprint, Needs, Origin, Ray, Spectrum, UVec2, Vec2, Vec3A};

/// A ray from the camera and what it counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraSample {
    /// World space, unit direction.
    pub ray: Ray,
    /// Factor of the radiance found; the filter's share is multiplied in by the renderer. May be negative.
    pub weight: f32,
    /// Angle in radians by which neighbouring pixels' rays part: how fast the ray's cone widens.
    pub spread: f32,
}

/// A connection from a point in the scene to the camera, for methods that trace from the lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Connect {
    /// Where on the film it lands, pixels.
    pub film: Vec2,
    /// Unit direction from the point toward the camera.
    pub wi: Vec3A,
    /// Importance arriving along it, including the aperture's cosine.
    pub we: Spectrum,
    /// Density of the lens point, per solid angle at the point, sr⁻¹.
    pub pdf: f32,
    /// The point on the lens.
    pub end: Origin,
}

/// Turns film positions into rays. `check_camera` of `etendue-testkit` tests any implementation.
pub trait Camera: Send + Sync {
    /// Width and height in pixels, both at least 1.
    fn resolution(&self) -> UVec2;

    /// The ray of a film position in pixels (`(0, 0)` is the outer corner of the top left pixel, `y` grows downward)
    /// through the lens position `lens` in `[0, 1)²` at `time` in `[0, 1)` of its [`Camera::exposure`]; `None` where the
    /// camera is blind. Without [`Needs::MOTION`] in scene and camera `time` is always 0.
    fn ray(&self, film: Vec2, lens: Vec2, time: f32) -> Option<CameraSample>;

    /// The way back from a point to the film; `None` where it is not seen or the camera cannot say.
    fn connect(&self, p: &Origin, lens: Vec2) -> Option<Connect> {
        let _ = (p, lens);
        None
    }

    /// What the camera asks of the renderer: [`Needs::LENS`] if `lens` matters, [`Needs::MOTION`] if `time` does.
    fn needs(&self) -> Needs {
        Needs::empty()
    }

    /// When the shutter opens and closes, within the interval \[0, 1\] of the scene's motion: the ray's own time is
    /// `open + (close − open) · time`, below 1.
    fn exposure(&self) -> [f32; 2] {
        [0.0, 1.0]
    }

    /// What decides the camera, for comparing renders.
    fn fingerprint(&self, f: &mut Fingerprint) {
        f.opaque();
    }
}

/// A pointer to a camera is the camera.
macro_rules! pointer {
    ($pointer:ty) => {
        impl<C: Camera + ?Sized> Camera for $pointer {
            fn resolution(&self) -> UVec2 {
                (**self).resolution()
            }

            fn ray(&self, film: Vec2, lens: Vec2, time: f32) -> Option<CameraSample> {
                (**self).ray(film, lens, time)
            }

            fn connect(&self, p: &Origin, lens: Vec2) -> Option<Connect> {
                (**self).connect(p, lens)
            }

            fn needs(&self) -> Needs {
                (**self).needs()
            }

            fn exposure(&self) -> [f32; 2] {
                (**self).exposure()
            }

            fn fingerprint(&self, f: &mut Fingerprint) {
                (**self).fingerprint(f);
            }
        }
    };
}

pointer!(&C);
pointer!(Box<C>);
pointer!(std::sync::Arc<C>);
