//! Point sets by their definitions, and independent values of their measures.

use etendue_sampling::Sobol;

/// Agreement with the reference values. The smallest of them, 10⁻⁶, is a difference of sums near 1.
pub(crate) const TOLERANCE: f64 = 1e-12;

#[derive(Clone, Copy, Debug)]
pub(crate) enum Set {
    /// Radical inverses in the bases 2, 3, 5, 7, from index 0 on.
    Halton,
    /// i/N, and Halton's.
    Hammersley,
    /// Joe & Kuo's without scrambling.
    Sobol,
    /// Centres of N cells.
    Grid,
}
pub(crate) use Set::{Grid, Halton, Hammersley};

/// Values that scipy 1.17.1 has for a set (`scipy.stats.qmc`), and of an enumeration of all boxes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub(crate) set: Set,
    pub(crate) dims: usize,
    pub(crate) n: usize,
    pub(crate) star: Option<f64>,
    /// The root.
    pub(crate) l2_star: f64,
    /// Squares: centred, wrap-around, mixture.
    pub(crate) squares: [f64; 3],
}

const fn row(set: Set, dims: usize, n: usize, star: Option<f64>, l2_star: f64, squares: [f64; 3]) -> Row {
    Row { set, dims, n, star, l2_star, squares }
}

#[rustfmt::skip]
pub(crate) const REFERENCE: [Row; 32] = [
    row(Halton, 1, 16, Some(0.0625), 0.03608439182435135, [0.0013020833333332593, 0.0006510416666667407, 0.0009765624999993339]),
    row(Halton, 1, 64, Some(0.015625), 0.009021097956086877, [8.138020833325932e-05, 4.069010416674068e-05, 6.103515624755751e-05]),
    row(Halton, 1, 256, Some(0.00390625), 0.0022552744890178733, [5.0862630207593185e-06, 2.5431315104906815e-06, 3.814697256521171e-06]),
    row(Halton, 2, 16, Some(0.2013888888888889), 0.06824779161021054, [0.009016290777176694, 0.004043306996957208, 0.00851869168867836]),
    row(Halton, 2, 64, Some(0.05208333333333326), 0.016409436360002316, [0.0007340847364840641, 0.00036796406445471774, 0.0006996769067622033]),
    row(Halton, 2, 256, Some(0.018759645061728447), 0.0053063698910007775, [6.666207181971195e-05, 3.00247502578177e-05, 6.178990795513428e-05]),
    row(Halton, 4, 16, Some(0.3564625850340136), 0.07090607664035281, [0.044579888672596324, 0.0327859180650818, 0.08156501150817874]),
    row(Halton, 4, 64, Some(0.1362500000000001), 0.023588354415097264, [0.004271764823749136, 0.0036143090330722494, 0.008101541968974502]),
    row(Halton, 4, 256, None, 0.007416063727727145, [0.00037709430239929453, 0.00038434524298258665, 0.0007808041252097553]),
    row(Hammersley, 2, 16, Some(0.171875), 0.06929083896187715, [0.004312939114040626, 0.002713097466362946, 0.0040588908725305295]),
    row(Hammersley, 2, 64, Some(0.0537109375), 0.02120510816627098, [0.0003581038779680856, 0.00020006133450412023, 0.0002950431986001867]),
    row(Hammersley, 2, 256, Some(0.01605224609375), 0.006277231397399603, [2.9866890852270345e-05, 1.4411085026644344e-05, 2.144649704538537e-05]),
    row(Hammersley, 4, 16, Some(0.34802083333333333), 0.08090034654147975, [0.03186717876282508, 0.026166905533430374, 0.05666727963005869]),
    row(Hammersley, 4, 64, Some(0.12105729166666657), 0.0223961776210226, [0.0032511280874290005, 0.0028561502095905134, 0.005835428621060679]),
    row(Hammersley, 4, 256, None, 0.006602114176176912, [0.0002622885934073782, 0.00027544506383048173, 0.0004712513435674026]),
    row(Set::Sobol, 1, 16, Some(0.0625), 0.03608439182435135, [0.0013020833333332593, 0.0006510416666667407, 0.0009765624999993339]),
    row(Set::Sobol, 1, 64, Some(0.015625), 0.009021097956086877, [8.138020833325932e-05, 4.069010416674068e-05, 6.103515624755751e-05]),
    row(Set::Sobol, 1, 256, Some(0.00390625), 0.0022552744890178733, [5.0862630207593185e-06, 2.5431315104906815e-06, 3.814697256521171e-06]),
    row(Set::Sobol, 2, 16, Some(0.171875), 0.047766230959700805, [0.0036243862575953134, 0.003968132866753571, 0.0045705371432815944]),
    row(Set::Sobol, 2, 64, Some(0.0537109375), 0.012869849626468793, [0.00024001962608743987, 0.00025360120667361485, 0.0002969226075566489]),
    row(Set::Sobol, 2, 256, Some(0.01458740234375), 0.0033074703678268075, [1.663160380993567e-05, 2.4205397090248937e-05, 2.2830333258117008e-05]),
    row(Set::Sobol, 4, 16, Some(0.2501220703125), 0.055360908728851244, [0.017769377209917003, 0.025595733345440852, 0.03714002443274378]),
    row(Set::Sobol, 4, 64, Some(0.10587596893310547), 0.014896763517805481, [0.0012377966129335505, 0.002562714248175002, 0.0032715946442500865]),
    row(Set::Sobol, 4, 256, None, 0.005123310002770821, [0.00012570491511532111, 0.0002772855383157413, 0.0003186465411246786]),
    row(Grid, 1, 16, Some(0.03125), 0.01804219591217529, [0.0003255208333332593, 0.0006510416666667407, 0.00048828124999933387]),
    row(Grid, 1, 64, Some(0.0078125), 0.0045105489780419, [2.034505208325932e-05, 4.069010416674068e-05, 3.051757812255751e-05]),
    row(Grid, 1, 256, Some(0.001953125), 0.0011276372445027832, [1.2715657551343185e-06, 2.5431315104906815e-06, 1.907348623264582e-06]),
    row(Grid, 2, 16, Some(0.234375), 0.05972575490197763, [0.011379665798610938, 0.02788628472222232, 0.02484469943576295]),
    row(Grid, 2, 64, Some(0.12109375), 0.029563313905579917, [0.0028271145290796884, 0.006951226128472321, 0.006191465589732825]),
    row(Grid, 2, 256, Some(0.0615234375), 0.014743973759951956, [0.0007056660122339853, 0.001736534966362946, 0.001546634568096561]),
    row(Grid, 4, 16, Some(0.68359375), 0.06477328387798371, [0.11695463863419864, 0.4139690634645068, 0.5219233933790184]),
    row(Grid, 4, 256, None, 0.02892010172018425, [0.02716106829451892, 0.0999288794435107, 0.12562978561439753]),
];

fn radical_inverse(mut i: usize, base: usize) -> f64 {
    let (mut numerator, mut denominator) = (0, 1);
    while i > 0 {
        numerator = numerator * base + i % base;
        denominator *= base;
        i /= base;
    }
    numerator as f64 / denominator as f64
}

impl Set {
    pub(crate) fn points<const D: usize>(self, n: usize) -> Vec<[f64; D]> {
        const BASES: [usize; 4] = [2, 3, 5, 7];
        let side = (1..=n).find(|s| s.pow(D as u32) == n).unwrap_or(0);
        let point = |i: usize| {
            std::array::from_fn(|d| match self {
                Halton => radical_inverse(i, BASES[d]),
                Hammersley if d == 0 => i as f64 / n as f64,
                Hammersley => radical_inverse(i, BASES[d - 1]),
                Set::Sobol => f64::from(sobol_digits(i, d)) / 4_294_967_296.0,
                Grid => ((i / side.pow(d as u32) % side) as f64 + 0.5) / side as f64,
            })
        };
        (0..n).map(point).collect()
    }
}

/// A coordinate of Sobol's sequence in units of 2⁻³².
fn sobol_digits(index: usize, dimension: usize) -> u32 {
    let v = Sobol::direction_numbers(dimension as u32).unwrap();
    (0..32).filter(|k| index >> k & 1 == 1).fold(0, |x, k| x ^ v[k])
}

/// The first reference value that a measure misses, among sets of dimension D.
pub(crate) fn missed<const D: usize>(
    measure: impl Fn(&[[f64; D]]) -> f64,
    value: impl Fn(&Row) -> Option<f64>,
) -> Option<String> {
    let mut compared = 0;
    let missed = REFERENCE.iter().filter(|row| row.dims == D).find_map(|row| {
        let want = value(row)?;
        compared += 1;
        let got = measure(&row.set.points(row.n));
        (!((got - want).abs() <= TOLERANCE)).then(|| format!("{row:?}: {got}, not {want}"))
    });
    assert!(compared > 0, "nothing to compare in {D} dimensions");
    missed
}
