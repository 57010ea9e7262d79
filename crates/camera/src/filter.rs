use etendue_core::{Fingerprint, Vec2, math};

/// Cells of a tabulated filter axis: fine enough that a sample's weight stays within 1 % of ±1.
const CELLS: usize = 1024;

/// A reconstruction filter. Radii are in pixels, from the pixel's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// Every position within the radius counts alike.
    Box {
        /// Half the width.
        radius: f32,
    },
    /// Falls linearly to zero at the radius.
    Tent {
        /// Half the width.
        radius: f32,
    },
    /// A Gaussian lowered to zero at the radius.
    Gaussian {
        /// Half the width.
        radius: f32,
        /// Standard deviation.
        sigma: f32,
    },
    /// The two-parameter family of Mitchell & Netravali (1988); has negative lobes.
    Mitchell {
        /// Half the width.
        radius: f32,
        /// Blur.
        b: f32,
        /// Ringing.
        c: f32,
    },
}

impl Default for Filter {
    /// A Gaussian of sigma 0.5 and radius 1.5.
    fn default() -> Self {
        Self::Gaussian { radius: 1.5, sigma: 0.5 }
    }
}

impl Filter {
    /// A box of one pixel: a sample counts for the pixel it falls in.
    pub const BOX: Self = Self::Box { radius: 0.5 };

    /// The filter's value along one axis at distance `x` pixels, up to a constant factor.
    pub fn value(&self, x: f32) -> f32 {
        let a = x.abs();
        match *self {
            Self::Box { radius } => f32::from(u8::from(a <= radius)),
            Self::Tent { radius } => (1.0 - a / radius).max(0.0),
            Self::Gaussian { radius, sigma } => {
                let g = |x: f32| math::exp(-x * x / (2.0 * sigma * sigma));
                (g(a) - g(radius)).max(0.0)
            }
            Self::Mitchell { radius, b, c } => {
                let x = 2.0 * a / radius;
                if x < 1.0 {
                    ((12.0 - 9.0 * b - 6.0 * c) * x * x * x
                        + (-18.0 + 12.0 * b + 6.0 * c) * x * x
                        + (6.0 - 2.0 * b))
                        / 6.0
                } else if x < 2.0 {
                    ((-b - 6.0 * c) * x * x * x
                        + (6.0 * b + 30.0 * c) * x * x
                        + (-12.0 * b - 48.0 * c) * x
                        + (8.0 * b + 24.0 * c))
                        / 6.0
                } else {
                    0.0
                }
            }
        }
    }

    /// Half the width in pixels.
    pub fn radius(&self) -> f32 {
        match *self {
            Self::Box { radius }
            | Self::Tent { radius }
            | Self::Gaussian { radius, .. }
            | Self::Mitchell { radius, .. } => radius,
        }
    }

    /// Prepares the filter for sampling. A radius or width that is not positive and finite acts as [`Filter::BOX`].
    pub fn sampler(&self) -> FilterSampler {
        FilterSampler::new(*self)
    }

    /// Into a digest.
    pub fn fingerprint(&self, f: &mut Fingerprint) {
        match *self {
            Self::Box { radius } => {
                f.tag("box");
                f.f32(radius);
            }
            Self::Tent { radius } => {
                f.tag("tent");
                f.f32(radius);
            }
            Self::Gaussian { radius, sigma } => {
                f.tag("gaussian");
                f.floats(&[radius, sigma]);
            }
            Self::Mitchell { radius, b, c } => {
                f.tag("mitchell");
                f.floats(&[radius, b, c]);
            }
        }
    }
}

/// A position drawn from a filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSample {
    /// Offset from the pixel's centre, pixels.
    pub offset: Vec2,
    /// Filter over density, normalised so that its mean is 1. Negative in a negative lobe.
    pub weight: f32,
}

/// Draws positions with a density proportional to a filter's magnitude (Ernst, Stamminger & Greiner 2006), so that
/// each sample belongs to one pixel and no neighbours need to be written.
#[derive(Clone, Debug)]
pub struct FilterSampler {
    filter: Filter,
    /// Cumulated |filter| over `CELLS` equal cells of one axis, from 0 to 1; empty for the analytic filters.
    cdf: Vec<f64>,
    /// Weight of each cell: the filter's sign times ∫|f| / ∫f along one axis.
    weights: Vec<f32>,
}

impl FilterSampler {
    fn new(filter: Filter) -> Self {
        let sound = |v: f32| v > 0.0 && v.is_finite();
        let ok = match filter {
            Filter::Box { radius } | Filter::Tent { radius } => sound(radius),
            Filter::Gaussian { radius, sigma } => sound(radius) && sound(sigma),
            Filter::Mitchell { radius, b, c } => sound(radius) && b.is_finite() && c.is_finite(),
        };
        let filter = if ok { filter } else { Filter::BOX };
        if matches!(filter, Filter::Box { .. } | Filter::Tent { .. }) {
            return Self { filter, cdf: Vec::new(), weights: Vec::new() };
        }
        let (mut cdf, mut weights, mut sum, mut signed) = (vec![0.0], Vec::new(), 0.0, 0.0);
        for i in 0..CELLS {
            let v = f64::from(filter.value(Self::cell_center(&filter, i)));
            sum += v.abs();
            signed += v;
            cdf.push(sum);
            weights.push(if v < 0.0 { -1.0 } else { 1.0 });
        }
        if !(sum > 0.0 && signed > 0.0) {
            return Self { filter: Filter::BOX, cdf: Vec::new(), weights: Vec::new() };
        }
        for c in &mut cdf {
            *c /= sum;
        }
        for w in &mut weights {
            *w *= (sum / signed) as f32;
        }
        Self { filter, cdf, weights }
    }

    fn cell_center(filter: &Filter, i: usize) -> f32 {
        ((i as f32 + 0.5) / CELLS as f32 * 2.0 - 1.0) * filter.radius()
    }

    /// The filter sampled.
    pub fn filter(&self) -> Filter {
        self.filter
    }

    /// A position from `u` in `[0, 1)²`.
    #[inline]
    pub fn sample(&self, u: Vec2) -> FilterSample {
        let (x, wx) = self.axis(u.x);
        let (y, wy) = self.axis(u.y);
        FilterSample { offset: Vec2::new(x, y), weight: wx * wy }
    }

    /// Offset and weight along one axis.
    #[inline]
    fn axis(&self, u: f32) -> (f32, f32) {
        match self.filter {
            Filter::Box { radius } => ((2.0 * u - 1.0) * radius, 1.0),
            Filter::Tent { radius } => {
                let x = if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 * (1.0 - u)).sqrt() };
                (x * radius, 1.0)
            }
            _ => {
                let u = f64::from(u);
                // The last cell whose lower end is not above u and that has a width.
                let i = self.cdf.partition_point(|&c| c <= u).clamp(1, CELLS) - 1;
                let (lo, hi) = (self.cdf[i], self.cdf[i + 1]);
                let within = if hi > lo { (u - lo) / (hi - lo) } else { 0.5 };
                let x = ((i as f64 + within) / CELLS as f64 * 2.0 - 1.0) * f64::from(self.filter.radius());
                // Within a cell the density is constant, and so is the weight: the steps stand for the filter.
                (x as f32, self.weights[i])
            }
        }
    }
}
