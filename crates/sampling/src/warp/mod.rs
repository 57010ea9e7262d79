//! Maps from the unit square to directions and surfaces, each with its density.
//!
//! Every `u` lies in [0, 1)². All maps are total there: `u` in {0, 2⁻²⁴, ½, 1 − 2⁻²⁴}² gives a finite point of the
//! domain with positive density. Hemisphere maps are in the local frame with the pole at +z. Densities of directions
//! are per solid angle (sr⁻¹), of planar points per area.
//!
//! | map | density | source |
//! |---|---|---|
//! | [`disc`] | [`DISC_PDF`] | Shirley & Chiu 1997 |
//! | [`sphere`], [`hemisphere`] | [`SPHERE_PDF`], [`HEMISPHERE_PDF`] | Archimedes |
//! | [`cosine`] | [`cosine_pdf`] | Malley's method on [`disc`] |
//! | [`power_cosine`] | [`power_cosine_pdf`] | inversion |
//! | [`cone`] | [`cone_pdf`] | inversion in 1 − cos θ |
//! | [`triangle`] | 1 / area | Heitz 2019 |
//! | [`SphericalTriangle`] | 1 / solid angle | Arvo 1995, area by Van Oosterom & Strackee 1983 |
//! | [`SphericalRectangle`] | 1 / solid angle | Ureña, Fajardo & King 2013 |
//! | [`SphericalDisc`] | (1 + cos to the rim) / (2π sin α sin β) | sectors of the projected ellipse |

mod directional;
mod planar;
mod spherical_disc;
mod spherical_rectangle;
mod spherical_triangle;

pub use directional::{
    HEMISPHERE_PDF, SPHERE_PDF, cone, cone_pdf, cosine, cosine_pdf, hemisphere, power_cosine,
    power_cosine_pdf, sphere,
};
pub use planar::{DISC_PDF, disc, triangle, triangle_sqrt};
pub use spherical_disc::{DiscSample, SphericalDisc};
pub use spherical_rectangle::{RectangleAxes, RectangleSample, SphericalRectangle};
pub use spherical_triangle::{SphericalTriangle, TriangleSample};

/// Below this solid angle (sr) a triangle or rectangle is better sampled by area: the density varies little over it,
/// and single-precision corners no longer determine its shape.
pub const MIN_SOLID_ANGLE: f64 = 3e-4;
/// Above this solid angle (sr; nearly a hemisphere) the receiver touches the plane, and area sampling is safer.
pub const MAX_SOLID_ANGLE: f64 = 6.22;
