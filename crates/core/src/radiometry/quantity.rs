use std::f64::consts::{FRAC_1_PI, PI, TAU};
use std::fmt;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// Defines a quantity: sums, multiples and ratios of the same kind, and its unit in print.
macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident, $unit:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
        pub struct $name(pub f64);

        impl Add for $name {
            type Output = Self;
            fn add(self, o: Self) -> Self {
                Self(self.0 + o.0)
            }
        }
        impl AddAssign for $name {
            fn add_assign(&mut self, o: Self) {
                self.0 += o.0;
            }
        }
        impl Sub for $name {
            type Output = Self;
            fn sub(self, o: Self) -> Self {
                Self(self.0 - o.0)
            }
        }
        impl Neg for $name {
            type Output = Self;
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }
        impl Mul<f64> for $name {
            type Output = Self;
            fn mul(self, s: f64) -> Self {
                Self(self.0 * s)
            }
        }
        impl Mul<$name> for f64 {
            type Output = $name;
            fn mul(self, q: $name) -> $name {
                $name(self * q.0)
            }
        }
        impl Div<f64> for $name {
            type Output = Self;
            fn div(self, s: f64) -> Self {
                Self(self.0 / s)
            }
        }
        impl Div for $name {
            type Output = f64;
            fn div(self, o: Self) -> f64 {
                self.0 / o.0
            }
        }
        impl Sum for $name {
            fn sum<I: Iterator<Item = Self>>(items: I) -> Self {
                items.fold(Self(0.0), |a, b| a + b)
            }
        }
        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                fmt::Display::fmt(&self.0, f)?;
                f.write_str(concat!(" ", $unit))
            }
        }
    };
}

/// `$a / $b = $c`, and with it `$c · $b = $a`, `$b · $c = $a` and `$a / $c = $b`.
macro_rules! quotient {
    ($a:ident / $b:ident = $c:ident) => {
        impl Div<$b> for $a {
            type Output = $c;
            fn div(self, o: $b) -> $c {
                $c(self.0 / o.0)
            }
        }
        impl Div<$c> for $a {
            type Output = $b;
            fn div(self, o: $c) -> $b {
                $b(self.0 / o.0)
            }
        }
        impl Mul<$b> for $c {
            type Output = $a;
            fn mul(self, o: $b) -> $a {
                $a(self.0 * o.0)
            }
        }
        impl Mul<$c> for $b {
            type Output = $a;
            fn mul(self, o: $c) -> $a {
                $a(self.0 * o.0)
            }
        }
    };
}

quantity!(/** Time in seconds. */ Seconds, "s");
quantity!(/** Area in square metres. For radiance: the area projected across the beam. */ Area, "m²");
quantity!(/** Plane angle in radians: arc over radius. */ Angle, "rad");
quantity!(/** Solid angle in steradians: area on the unit sphere; 4π for all of it. */ SolidAngle, "sr");
quantity!(
    /** Solid angle weighted by the cosine against a normal, in steradians; π for a hemisphere. */
    ProjectedSolidAngle,
    "sr"
);
quantity!(/** Radiant energy Q in joules. */ RadiantEnergy, "J");
quantity!(/** Power (radiant flux) Φ = dQ/dt in watts. */ Power, "W");
quantity!(/** Irradiance E: power that arrives per area, in W·m⁻². */ Irradiance, "W/m²");
quantity!(/** Radiant exitance M: power that leaves per area, in W·m⁻². */ RadiantExitance, "W/m²");
quantity!(/** Radiosity B: all power that leaves per area, emitted and reflected, in W·m⁻². */ Radiosity, "W/m²");
quantity!(/** Intensity I of a point source: power per solid angle, in W·sr⁻¹. */ Intensity, "W/sr");
quantity!(
    /** Radiance L: power per projected area and solid angle, in W·m⁻²·sr⁻¹. Constant along a ray in a vacuum. */
    Radiance,
    "W/(m²·sr)"
);

quotient!(RadiantEnergy / Seconds = Power);
quotient!(Power / Area = Irradiance);
quotient!(Power / SolidAngle = Intensity);
quotient!(Intensity / Area = Radiance);
quotient!(Irradiance / ProjectedSolidAngle = Radiance);

impl SolidAngle {
    /// The whole sphere: 4π.
    pub const SPHERE: Self = Self(2.0 * TAU);
    /// Half of it: 2π.
    pub const HEMISPHERE: Self = Self(TAU);
}

impl Power {
    /// The exitance of a surface that sends this power out evenly.
    pub fn over(self, area: Area) -> RadiantExitance {
        RadiantExitance(self.0 / area.0)
    }

    /// The intensity of a point source that sends this power evenly in all directions: Φ/4π.
    pub fn isotropic_intensity(self) -> Intensity {
        self / SolidAngle::SPHERE
    }
}

impl Intensity {
    /// What arrives at `distance` metres on a surface whose normal makes `cos_theta` with the direction to the source
    /// (the inverse-square law): I cos θ / r²; 0 from behind.
    pub fn irradiance_at(self, distance: f64, cos_theta: f64) -> Irradiance {
        Irradiance(if cos_theta > 0.0 { self.0 * cos_theta / (distance * distance) } else { 0.0 })
    }
}

impl Irradiance {
    /// What a surface of this albedo sends back: ρE.
    pub fn reflected(self, albedo: f64) -> RadiantExitance {
        RadiantExitance(self.0 * albedo)
    }
}

impl RadiantExitance {
    /// The radiance of a diffuse surface with this exitance: M/π.
    pub fn diffuse_radiance(self) -> Radiance {
        Radiance(self.0 * FRAC_1_PI)
    }
}

impl Radiance {
    /// The exitance of a diffuse surface of this radiance: M = πL.
    pub fn diffuse_exitance(self) -> RadiantExitance {
        RadiantExitance(self.0 * PI)
    }
}

impl Radiosity {
    /// Emitted plus reflected: B = M + ρE.
    pub fn new(emitted: RadiantExitance, arriving: Irradiance, albedo: f64) -> Self {
        Self(emitted.0 + arriving.reflected(albedo).0)
    }

    /// The radiance of a diffuse surface with this radiosity: B/π.
    pub fn diffuse_radiance(self) -> Radiance {
        RadiantExitance(self.0).diffuse_radiance()
    }
}
