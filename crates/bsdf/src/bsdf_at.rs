use etendue_core::{Spectrum, Vec2, Vec3A};

use crate::{
    Black, BlinnPhong, Bsdf, BsdfSample, Conductor, Lambert, Lobes, Mirror, Mode, OrenNayar, Phong,
    Principled, RoughDielectric, Scatter, SmoothDielectric, ThinDielectric,
};

/// A BSDF at one point, as an integrator holds it: by value where it is ours, through one door where it is a user's.
///
/// It is a [`Bsdf`] itself; every call is one predictable branch and then static.
pub enum BsdfAt<'a> {
    /// Diffuse reflection.
    Lambert(Lambert),
    /// Perfect mirror.
    Mirror(Mirror),
    /// Clear glass.
    SmoothDielectric(SmoothDielectric),
    /// Metal.
    Conductor(Conductor),
    /// Frosted glass.
    RoughDielectric(RoughDielectric),
    /// A wall of glass without thickness.
    ThinDielectric(ThinDielectric),
    /// glTF's surface.
    Principled(Principled),
    /// A rough matte surface.
    OrenNayar(OrenNayar),
    /// A lobe around the mirrored direction.
    Phong(Phong),
    /// A lobe around the half vector.
    BlinnPhong(BlinnPhong),
    /// Nothing comes back.
    Black(Black),
    /// A user's, living as long as the scene.
    Ref(&'a dyn Bsdf),
    /// A user's, made for this point.
    Open(Box<dyn Bsdf + 'a>),
}

/// The same expression for the payload of every variant.
macro_rules! dispatch {
    ($self:expr, $b:ident => $e:expr) => {
        match $self {
            BsdfAt::Lambert($b) => $e,
            BsdfAt::Mirror($b) => $e,
            BsdfAt::SmoothDielectric($b) => $e,
            BsdfAt::Conductor($b) => $e,
            BsdfAt::RoughDielectric($b) => $e,
            BsdfAt::ThinDielectric($b) => $e,
            BsdfAt::Principled($b) => $e,
            BsdfAt::OrenNayar($b) => $e,
            BsdfAt::Phong($b) => $e,
            BsdfAt::BlinnPhong($b) => $e,
            BsdfAt::Black($b) => $e,
            BsdfAt::Ref($b) => $e,
            BsdfAt::Open($b) => $e,
        }
    };
}

impl std::fmt::Debug for BsdfAt<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Lambert(b) => b.fmt(f),
            Self::Mirror(b) => b.fmt(f),
            Self::SmoothDielectric(b) => b.fmt(f),
            Self::Conductor(b) => b.fmt(f),
            Self::RoughDielectric(b) => b.fmt(f),
            Self::ThinDielectric(b) => b.fmt(f),
            Self::Principled(b) => b.fmt(f),
            Self::OrenNayar(b) => b.fmt(f),
            Self::Phong(b) => b.fmt(f),
            Self::BlinnPhong(b) => b.fmt(f),
            Self::Black(b) => b.fmt(f),
            Self::Ref(b) => write!(f, "Ref({:?})", b.lobes()),
            Self::Open(b) => write!(f, "Open({:?})", b.lobes()),
        }
    }
}

impl Bsdf for BsdfAt<'_> {
    #[inline]
    fn lobes(&self) -> Lobes {
        dispatch!(self, b => b.lobes())
    }

    #[inline]
    fn eval(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> Spectrum {
        dispatch!(self, b => b.eval(wo, wi, mode))
    }

    #[inline]
    fn pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> f32 {
        dispatch!(self, b => b.pdf(wo, wi, mode))
    }

    #[inline]
    fn sample(&self, wo: Vec3A, u_lobe: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        dispatch!(self, b => b.sample(wo, u_lobe, u, mode))
    }

    #[inline]
    fn eval_pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> (Spectrum, f32) {
        dispatch!(self, b => b.eval_pdf(wo, wi, mode))
    }

    #[inline]
    fn scatter(&self, wo: Vec3A, toward_light: Option<Vec3A>, u_lobe: f32, u: Vec2, mode: Mode) -> Scatter {
        dispatch!(self, b => b.scatter(wo, toward_light, u_lobe, u, mode))
    }

    fn albedo(&self, wo: Vec3A) -> Spectrum {
        dispatch!(self, b => b.albedo(wo))
    }

    fn delta_lobes(&self, wo: Vec3A, mode: Mode) -> [Option<BsdfSample>; 2] {
        dispatch!(self, b => b.delta_lobes(wo, mode))
    }

    fn eval_classes(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> [Spectrum; 4] {
        dispatch!(self, b => b.eval_classes(wo, wi, mode))
    }

    fn at(&self) -> BsdfAt<'_> {
        dispatch!(self, b => b.at())
    }
}
