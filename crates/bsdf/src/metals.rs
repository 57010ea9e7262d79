use crate::{Conductor, MetalFresnel};

/// Measured metals, by complex refractive indices at 630, 532 and 465 nm for red, green and blue, each linearly
/// interpolated between the two nearest wavelengths of a published table (as collected by refractiveindex.info). The
/// reflectances are those at normal incidence. `roughness` is in `[0, 1]`; the facets' alpha is its square.
impl Conductor {
    /// From indices at 630, 532 and 465 nm.
    fn measured(roughness: f32, eta: [f32; 3], k: [f32; 3]) -> Self {
        Self::new(roughness, MetalFresnel::Index { eta: eta.into(), k: k.into() })
    }

    /// Gold: Johnson & Christy 1972, "Optical constants of the noble metals", interpolated at 630, 532 and 465 nm.
    pub fn gold(roughness: f32) -> Self {
        Self::measured(roughness, [0.1884, 0.5439, 1.3319], [3.4034, 2.2309, 1.8693])
    }

    /// Silver: Johnson & Christy 1972, interpolated at 630, 532 and 465 nm.
    pub fn silver(roughness: f32) -> Self {
        Self::measured(roughness, [0.0569, 0.0540, 0.0469], [4.2543, 3.4290, 2.8028])
    }

    /// Copper: Johnson & Christy 1972, interpolated at 630, 532 and 465 nm.
    pub fn copper(roughness: f32) -> Self {
        Self::measured(roughness, [0.2753, 1.1159, 1.2469], [3.3726, 2.5956, 2.4562])
    }

    /// Aluminium: Rakić 1995, "Algorithm for the determination of intrinsic optical constants of metal films",
    /// interpolated at 630, 532 and 465 nm.
    pub fn aluminium(roughness: f32) -> Self {
        Self::measured(roughness, [1.4303, 0.9388, 0.6860], [7.5081, 6.4195, 5.6351])
    }

    /// Chromium, (0.553, 0.556, 0.558): Johnson & Christy 1974, "Optical constants of transition metals", interpolated at
    /// 630, 532 and 465 nm.
    pub fn chromium(roughness: f32) -> Self {
        Self::measured(roughness, [3.1452, 3.0343, 2.4560], [3.3124, 3.3300, 3.2100])
    }

    /// Iron, (0.529, 0.511, 0.500): Johnson & Christy 1974, interpolated at 630, 532 and 465 nm.
    pub fn iron(roughness: f32) -> Self {
        Self::measured(roughness, [2.8924, 2.8954, 2.6460], [3.0655, 2.9179, 2.8050])
    }

    /// Nickel, (0.690, 0.634, 0.583): Johnson & Christy 1974, interpolated at 630, 532 and 465 nm.
    pub fn nickel(roughness: f32) -> Self {
        Self::measured(roughness, [1.9900, 1.8775, 1.7650], [4.0943, 3.4946, 3.0480])
    }

    /// Titanium, (0.612, 0.575, 0.548): Johnson & Christy 1974, interpolated at 630, 532 and 465 nm.
    pub fn titanium(roughness: f32) -> Self {
        Self::measured(roughness, [2.6979, 2.4793, 2.3050], [3.7571, 3.3511, 3.0820])
    }

    /// Platinum, (0.672, 0.632, 0.597): the Lorentz–Drude fit of Rakić, Djurišić, Elazar & Majewski 1998, "Optical
    /// properties of metallic films for vertical-cavity optoelectronic devices", interpolated at 630, 532 and 465 nm.
    pub fn platinum(roughness: f32) -> Self {
        Self::measured(roughness, [2.3100, 2.0461, 1.8870], [4.1472, 3.6019, 3.2241])
    }

    /// Tungsten, (0.514, 0.493, 0.475): Weaver, Olson & Lynch 1975, "Optical properties of crystalline tungsten",
    /// interpolated at 630, 532 and 465 nm.
    #[allow(clippy::approx_constant, reason = "an index that happens to be near e")]
    pub fn tungsten(roughness: f32) -> Self {
        Self::measured(roughness, [3.6170, 3.4953, 3.3250], [2.9100, 2.7183, 2.5740])
    }

    /// Brass of 70 % copper and 30 % zinc, (0.877, 0.752, 0.493): Querry 1985, "Optical constants", interpolated at 630, 532
    /// and 465 nm.
    pub fn brass(roughness: f32) -> Self {
        Self::measured(roughness, [0.4450, 0.5682, 0.9470], [3.5220, 2.5880, 1.9200])
    }
}
