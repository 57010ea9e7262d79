//! Measures of point sets against independent values, closed forms, brute force, and their own invariances.

use etendue_sampling::Sobol;
use etendue_sampling::quality::{self, QualityError, StarBounds};
use proptest::prelude::*;

/// Agreement with the reference values. The smallest of them, 10⁻⁶, is a difference of sums near 1.
const TOLERANCE: f64 = 1e-12;

#[derive(Clone, Copy, Debug)]
enum Set {
    /// Radical inverses in the bases 2, 3, 5, 7, from index 0 on.
    Halton,
    /// i/N, and Halton's.
    Hammersley,
    /// Joe & Kuo's without scrambling.
    Sobol,
    /// Centres of N cells.
    Grid,
}
use Set::{Grid, Halton, Hammersley};

/// Values that scipy 1.17.1 has for a set (`scipy.stats.qmc`), and of an enumeration of all boxes.
#[derive(Clone, Copy, Debug)]
struct Row {
    set: Set,
    dims: usize,
    n: usize,
    star: Option<f64>,
    /// The root.
    l2_star: f64,
    /// Squares: centred, wrap-around, mixture.
    squares: [f64; 3],
}

const fn row(set: Set, dims: usize, n: usize, star: Option<f64>, l2_star: f64, squares: [f64; 3]) -> Row {
    Row { set, dims, n, star, l2_star, squares }
}

#[rustfmt::skip]
const REFERENCE: [Row; 32] = [
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
    fn points<const D: usize>(self, n: usize) -> Vec<[f64; D]> {
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
fn missed<const D: usize>(
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

/// Largest excess (closed boxes) and deficit (open boxes) of points at every corner of the grid of their coordinates.
/// O(N^(D + 1)).
fn enumerated<const D: usize>(points: &[[f64; D]]) -> [f64; 2] {
    let n = points.len();
    let corner = |d: usize, i: usize| points.get(i).map_or(1.0, |p| p[d]);
    let mut worst = [0.0f64; 2];
    for index in 0..(n + 1).pow(D as u32) {
        let q: [f64; D] = std::array::from_fn(|d| corner(d, index / (n + 1).pow(d as u32) % (n + 1)));
        let volume: f64 = q.iter().product();
        let closed = points.iter().filter(|p| p.iter().zip(&q).all(|(x, q)| x <= q)).count();
        let open = points.iter().filter(|p| p.iter().zip(&q).all(|(x, q)| x < q)).count();
        worst[0] = worst[0].max(closed as f64 / n as f64 - volume);
        worst[1] = worst[1].max(volume - open as f64 / n as f64);
    }
    worst
}

/// Random points; every other set on a coarse lattice, where coordinates tie.
fn point_sets<const D: usize>(most: usize) -> impl Strategy<Value = Vec<[f64; D]>> {
    (prop::collection::vec(prop::array::uniform(0.0..1.0f64), 1..=most), any::<bool>()).prop_map(
        |(mut points, lattice)| {
            if lattice {
                points.iter_mut().flatten().for_each(|x| *x = (*x * 8.0).floor() / 8.0);
            }
            points
        },
    )
}

fn config(cases: u32, seed: u64) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: prop::test_runner::RngSeed::Fixed(seed),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

#[test]
fn star_discrepancy_matches_the_reference() {
    let star = |row: &Row| row.star;
    assert_eq!(missed::<1>(|p| quality::star_discrepancy_1d(p).unwrap(), star), None);
    assert_eq!(missed::<1>(|p| quality::star_discrepancy(p).unwrap(), star), None);
    assert_eq!(missed::<2>(|p| quality::star_discrepancy_2d(p).unwrap(), star), None);
    assert_eq!(missed::<4>(|p| quality::star_discrepancy(p).unwrap(), star), None);
}

/// Whether a measure misses the reference values, or the star discrepancy max(1 - xy, x, y) of a single point.
fn is_wrong_star(measure: impl Fn(&[[f64; 2]]) -> f64) -> bool {
    let single = [[0.25, 0.5], [0.75, 0.75], [0.875, 0.125], [0.5, 0.9375]];
    let misses = |[x, y]: [f64; 2]| measure(&[[x, y]]) != (1.0 - x * y).max(x).max(y);
    single.into_iter().any(misses) || missed::<2>(measure, |row| row.star.filter(|_| row.n <= 64)).is_some()
}

#[test]
fn star_discrepancy_of_wrong_boxes_is_rejected() {
    assert!(!is_wrong_star(|p| quality::star_discrepancy_2d(p).unwrap()));
    assert!(!is_wrong_star(|p| enumerated(p).into_iter().fold(0.0, f64::max)));
    // Only boxes with too many points, only boxes with too few.
    assert!(is_wrong_star(|p| enumerated(p)[0]));
    assert!(is_wrong_star(|p| enumerated(p)[1]));
    // Closed boxes for both: points on the far faces of a box fill what should be empty. And open ones for both.
    let both = |points: &[[f64; 2]], is_inside: fn(&f64, &f64) -> bool| {
        let mut worst = 0.0f64;
        let coordinates = |d: usize| points.iter().map(move |p| p[d]).chain([1.0]);
        for (x, y) in coordinates(0).flat_map(|x| coordinates(1).map(move |y| (x, y))) {
            let inside = points.iter().filter(|p| is_inside(&p[0], &x) && is_inside(&p[1], &y)).count();
            worst = worst.max((inside as f64 / points.len() as f64 - x * y).abs());
        }
        worst
    };
    assert!(is_wrong_star(|p| both(p, f64::le)));
    assert!(is_wrong_star(|p| both(p, f64::lt)));
}

#[test]
fn star_discrepancy_matches_the_closed_forms() {
    for m in 0..=12 {
        let n = 1 << m;
        let len = n as f64;
        let near = |got: f64, want: f64| assert!((got - want).abs() <= TOLERANCE, "2^{m}: {got}, not {want}");
        near(quality::star_discrepancy_1d(&Halton.points(n)).unwrap(), 1.0 / len);
        near(quality::star_discrepancy_1d(&Grid.points(n)).unwrap(), 0.5 / len);
        // Hammersley in base 2 (Halton & Zaremba 1969), from four points on: two have 3/4.
        if m > 1 {
            let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
            let want = (f64::from(m) / 3.0 + 13.0 / 9.0 - sign * 4.0 / (9.0 * len)) / len;
            near(quality::star_discrepancy_2d(&Hammersley.points(n)).unwrap(), want);
        }
    }
}

proptest! {
    #![proptest_config(config(300, 1))]

    #[test]
    fn star_discrepancy_is_that_of_all_boxes_in_1d(points in point_sets::<1>(40)) {
        let want = enumerated(&points).into_iter().fold(0.0, f64::max);
        prop_assert!((quality::star_discrepancy_1d(&points).unwrap() - want).abs() <= TOLERANCE);
        prop_assert!((quality::star_discrepancy(&points).unwrap() - want).abs() <= TOLERANCE);
    }

    #[test]
    fn star_discrepancy_is_that_of_all_boxes_in_2d(points in point_sets::<2>(24)) {
        let want = enumerated(&points).into_iter().fold(0.0, f64::max);
        prop_assert!((quality::star_discrepancy_2d(&points).unwrap() - want).abs() <= TOLERANCE);
    }

    #[test]
    fn star_discrepancy_is_that_of_all_boxes_in_3d(points in point_sets::<3>(10)) {
        let want = enumerated(&points).into_iter().fold(0.0, f64::max);
        prop_assert!((quality::star_discrepancy(&points).unwrap() - want).abs() <= TOLERANCE);
    }
}

/// Whether bounds hold the exact value and are as close as a grid of that many cells has them.
fn are_bounds<const D: usize>(bounds: StarBounds, exact: f64, cells: usize) -> bool {
    let most = 1.0 - (1.0 - 1.0 / cells as f64).powi(D as i32);
    let StarBounds { lower, upper } = bounds;
    lower <= exact + TOLERANCE && exact <= upper + TOLERANCE && upper - lower <= most + TOLERANCE
}

/// Bounds by the definition: every corner by itself, all points each.
fn plain_bounds<const D: usize>(points: &[[f64; D]], cells: usize) -> StarBounds {
    let n = points.len() as f64;
    let corner = |at: [usize; D]| at.map(|j| j as f64 / cells as f64);
    let share =
        |q: [f64; D]| points.iter().filter(|p| p.iter().zip(&q).all(|(x, q)| x < q)).count() as f64 / n;
    let volume = |q: [f64; D]| q.iter().product::<f64>();
    let mut bounds = StarBounds { lower: 0.0, upper: 0.0 };
    for index in 0..cells.pow(D as u32) {
        let near: [usize; D] = std::array::from_fn(|d| index / cells.pow(d as u32) % cells);
        let (far, near) = (corner(near.map(|j| j + 1)), corner(near));
        bounds.lower = bounds.lower.max((share(far) - volume(far)).abs());
        bounds.upper = bounds.upper.max(share(far) - volume(near)).max(volume(far) - share(near));
    }
    bounds
}

proptest! {
    #![proptest_config(config(300, 4))]

    #[test]
    fn bounds_are_bounds(points in point_sets::<3>(12), cells in 1..=12usize) {
        let bounds = quality::star_discrepancy_bounds(&points, cells).unwrap();
        prop_assert!(are_bounds::<3>(bounds, quality::star_discrepancy(&points).unwrap(), cells));
        let plain = plain_bounds(&points, cells);
        prop_assert!((bounds.lower - plain.lower).abs() <= TOLERANCE);
        prop_assert!((bounds.upper - plain.upper).abs() <= TOLERANCE);
    }
}

#[test]
fn bounds_hold_the_reference() {
    for row in REFERENCE.iter().filter(|row| row.dims == 4) {
        let Some(exact) = row.star else { continue };
        for cells in [1, 7, 16, 48] {
            let bounds = quality::star_discrepancy_bounds(&row.set.points::<4>(row.n), cells).unwrap();
            assert!(are_bounds::<4>(bounds, exact, cells), "{row:?}: {bounds:?}");
            // Bounds that change places do not.
            let swapped = StarBounds { lower: bounds.upper, upper: bounds.lower };
            assert!(!are_bounds::<4>(swapped, exact, cells));
        }
    }
}

#[test]
fn grids_that_cannot_be_are_refused() {
    let points = [[0.5; 3]];
    for cells in [0, 256, usize::MAX - 1, usize::MAX] {
        let refused = Err(QualityError::Grid { cells, dimensions: 3 });
        assert_eq!(quality::star_discrepancy_bounds(&points, cells), refused);
    }
    let exact = StarBounds { lower: 0.0, upper: 0.0 };
    assert_eq!(quality::star_discrepancy_bounds::<0>(&[[]], 3), Ok(exact));
    assert_eq!(quality::star_discrepancy_bounds::<1>(&[], 3), Err(QualityError::Empty));
}

/// The four discrepancies in L2 by their index in a row, squared.
fn l2_square<const D: usize>(which: usize, points: &[[f64; D]]) -> f64 {
    let root = match which {
        0 => quality::l2_star(points),
        1 => quality::centred_l2(points),
        2 => quality::wrap_around_l2(points),
        _ => quality::mixture(points),
    };
    root.unwrap().powi(2)
}

fn l2_square_reference(which: usize, row: &Row) -> f64 {
    if which == 0 { row.l2_star * row.l2_star } else { row.squares[which - 1] }
}

fn l2_missed<const D: usize>() {
    assert_eq!(missed::<D>(|p| quality::l2_star(p).unwrap(), |row| Some(row.l2_star)), None);
    for which in 0..4 {
        let value = |row: &Row| Some(l2_square_reference(which, row));
        assert_eq!(missed::<D>(|p| l2_square(which, p), value), None);
        // Without the root or the square, or by another's name, nothing agrees (but on a line, where the centred
        // one is the star's).
        assert!(missed::<D>(|p| l2_square(which, p).sqrt(), value).is_some());
        assert!(missed::<D>(|p| l2_square(which, p).powi(2), value).is_some());
        for other in (0..4).filter(|&other| other != which && D > 1) {
            assert!(missed::<D>(|p| l2_square(other, p), value).is_some(), "{other} passes for {which}");
        }
    }
}

#[test]
fn l2_discrepancies_match_the_reference() {
    l2_missed::<1>();
    l2_missed::<2>();
    l2_missed::<4>();
}

#[test]
fn l2_star_matches_the_closed_forms() {
    for m in 0..=12 {
        let n = 1 << m;
        let (len, log) = (n as f64, f64::from(m));
        let near = |got: f64, want: f64| assert!((got - want).abs() <= TOLERANCE, "2^{m}: {got}, not {want}");
        near(quality::l2_star(&Halton.points::<1>(n)).unwrap(), 1.0 / (3f64.sqrt() * len));
        near(quality::l2_star(&Grid.points::<1>(n)).unwrap(), 1.0 / (12f64.sqrt() * len));
        // Hammersley in base 2 (Halton & Zaremba 1969; Vilenkin 1967).
        let scaled = log * log / 64.0 + 29.0 * log / 192.0 + 0.375 - log / (16.0 * len) + 0.25 / len
            - 1.0 / (72.0 * len * len);
        near(quality::l2_star(&Hammersley.points::<2>(n)).unwrap(), scaled.sqrt() / len);
    }
}

/// Whether a discrepancy stays as it is when points are mirrored in an axis, and when they are shifted on the torus.
fn invariances(which: usize, points: &[[f64; 3]]) -> [bool; 2] {
    let want = l2_square(which, points);
    let moved =
        |f: fn(f64) -> f64| -> Vec<[f64; 3]> { points.iter().map(|&[x, y, z]| [x, f(y), z]).collect() };
    [moved(|y| (1.0 - y).min(1f64.next_down())), moved(|y| (y + 0.3) % 1.0)]
        .map(|moved| (l2_square(which, &moved) - want).abs() <= 1e-12)
}

proptest! {
    #![proptest_config(config(100, 2))]

    #[test]
    fn l2_discrepancies_keep_their_invariances(
        points in prop::collection::vec(prop::array::uniform3(0.0..1.0f64), 2..=30),
    ) {
        prop_assert_eq!(invariances(0, &points), [false, false]);
        prop_assert_eq!(invariances(1, &points), [true, false]);
        prop_assert_eq!(invariances(2, &points), [true, true]);
        prop_assert_eq!(invariances(3, &points), [true, false]);
    }
}

#[test]
fn bad_points_are_refused() {
    assert_eq!(quality::star_discrepancy_1d(&[]), Err(QualityError::Empty));
    for value in [1.0, -0.1, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        let points = [[0.5, 0.5, 0.5], [0.25, 0.75, value]];
        for got in [
            quality::star_discrepancy(&points),
            quality::l2_star(&points),
            quality::centred_l2(&points),
            quality::wrap_around_l2(&points),
            quality::mixture(&points),
        ] {
            match got {
                Err(QualityError::OutsideUnitCube { point: 1, axis: 2, value: v }) => {
                    assert_eq!(v.to_bits(), value.to_bits());
                }
                other => panic!("{value}: {other:?}"),
            }
        }
    }
    // Points without coordinates are all in the one box.
    assert_eq!(quality::star_discrepancy::<0>(&[[]]), Ok(0.0));
    assert_eq!(quality::l2_star::<0>(&[[], []]), Ok(0.0));
    assert_eq!(quality::star_discrepancy_2d(&[[-0.0, 0.0]]), Ok(1.0));
}
