//! Known answers of radiometry: solid angles, form factors, units.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use etendue_core::glam::DVec3;
use etendue_core::radiometry::{
    Area, Hemispherical, Intensity, Irradiance, Power, ProjectedSolidAngle, Radiance, RadiantExitance,
    Radiosity, SolidAngle, arc_angle, cap_solid_angle, one_minus_cos, polygon_form_factor,
    polygon_solid_angle, projected_solid_angle, spherical_excess, triangle_solid_angle,
};

fn close(got: f64, want: f64, relative: f64) {
    assert!((got - want).abs() <= relative * want.abs(), "{got}, not {want}");
}

fn square(offset: f64, height: f64) -> [DVec3; 4] {
    [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, y)| DVec3::new(x + offset, y, height))
}

#[test]
fn units_combine_as_in_the_textbook() {
    assert_eq!(Power(100.0) / Area(0.1), Irradiance(1000.0));
    assert_eq!(Irradiance(1000.0) * Area(0.1), Power(100.0));
    assert_eq!(Power(100.0).over(Area(2.0)), RadiantExitance(50.0));
    assert_eq!(Radiance(2.0).diffuse_exitance(), RadiantExitance(TAU));
    close(RadiantExitance(TAU).diffuse_radiance().0, 2.0, 1e-15);
    close(Power(4.0 * PI).isotropic_intensity().0, 1.0, 1e-15);
    // A point source over a plane: E = I cos θ / r².
    assert_eq!(Intensity(8.0).irradiance_at(2.0, 0.5), Irradiance(1.0));
    assert_eq!(Intensity(8.0).irradiance_at(2.0, -0.5), Irradiance(0.0));
    // A uniform sky of radiance 1 gives π.
    assert_eq!(Radiance(1.0) * ProjectedSolidAngle(PI), Irradiance(PI));
    assert_eq!(Radiosity::new(RadiantExitance(1.0), Irradiance(4.0), 0.5), Radiosity(3.0));
    assert_eq!([Power(1.0), Power(2.0)].into_iter().sum::<Power>() / Power(1.5), 2.0);
    assert_eq!(format!("{:.1}", Radiance(1.25)), "1.2 W/(m²·sr)");
    assert_eq!(arc_angle(PI, 2.0).0, FRAC_PI_2);
}

#[test]
fn solid_angles_have_their_known_values() {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    close(triangle_solid_angle(x, y, z).0, FRAC_PI_2, 1e-15);
    close(triangle_solid_angle(z, y, x).0, FRAC_PI_2, 1e-15);
    close(spherical_excess(&[FRAC_PI_2; 3]).0, FRAC_PI_2, 1e-15);
    // Eight octants are the sphere.
    let octants: f64 = [x, -x]
        .iter()
        .flat_map(|&a| {
            [y, -y].into_iter().flat_map(move |b| [z, -z].map(|c| triangle_solid_angle(a, b, c).0))
        })
        .sum();
    close(octants, SolidAngle::SPHERE.0, 1e-15);
    // A face of a cube around the origin: a sixth.
    close(polygon_solid_angle(&square(0.0, 0.5)).0, SolidAngle::SPHERE.0 / 6.0, 1e-14);
    for (offset, height, omega) in [
        (0.0, 0.1, 5.170_198_016),
        (0.0, 1.0, 0.805_431_683),
        (1.0, 0.25, 0.306_682_215),
        (1.0, 1.0, 0.359_834_134),
    ] {
        close(polygon_solid_angle(&square(offset, height)).0, omega, 3e-9);
    }
    close(cap_solid_angle(PI).0, 2.0 * TAU, 1e-15);
    close(cap_solid_angle(FRAC_PI_2).0, TAU, 1e-15);
    close(cap_solid_angle(1e-8).0, PI * 1e-16, 1e-14);
    close(one_minus_cos(1e-9), 5e-19, 1e-14);
    // Small triangles keep their digits: area over squared distance.
    let tiny = |s: f64| triangle_solid_angle(z, z + x * s, z + y * s).0 / (0.5 * s * s);
    close(tiny(1e-7), 1.0, 1e-6);
    // An L of three unit squares seen from above: concave, but the sum of its parts.
    let p = |x: f64, y: f64| DVec3::new(x, y, 1.0);
    let l = [p(0.0, 0.0), p(2.0, 0.0), p(2.0, 1.0), p(1.0, 1.0), p(1.0, 2.0), p(0.0, 2.0)];
    let parts = polygon_solid_angle(&[p(0.0, 0.0), p(2.0, 0.0), p(2.0, 1.0), p(0.0, 1.0)]).0
        + polygon_solid_angle(&[p(0.0, 1.0), p(1.0, 1.0), p(1.0, 2.0), p(0.0, 2.0)]).0;
    close(polygon_solid_angle(&l).0, parts, 1e-14);
    // From every starting corner.
    for k in 0..6 {
        let mut turned = l;
        turned.rotate_left(k);
        close(polygon_solid_angle(&turned).0, parts, 1e-14);
    }
    assert_eq!(triangle_solid_angle(DVec3::ZERO, x, y).0, 0.0);
    assert_eq!(polygon_solid_angle(&[]).0, 0.0);
}

#[test]
fn lamberts_formula_has_its_known_values() {
    for (offset, height, e) in [
        (0.0, 0.1, 3.042_128_438),
        (0.0, 0.25, 2.610_753_031),
        (0.0, 0.5, 1.740_839_503),
        (0.0, 1.0, 0.752_274_688),
        (1.0, 0.25, 0.093_855_431),
        (1.0, 1.0, 0.265_004_852),
    ] {
        close(projected_solid_angle(&square(offset, height), DVec3::Z).0, e, 6e-9);
    }
    // Clipped by the horizon: a wall that reaches equally far up and down casts what its upper half casts.
    let wall =
        |z0: f64, z1: f64| [(-1.0, z0), (1.0, z0), (1.0, z1), (-1.0, z1)].map(|(x, z)| DVec3::new(x, 2.0, z));
    let upper = projected_solid_angle(&wall(0.0, 1.0), DVec3::Z).0;
    close(projected_solid_angle(&wall(-1.0, 1.0), DVec3::Z).0, upper, 1e-14);
    close(projected_solid_angle(&wall(-1e9, 1.0), DVec3::Z).0, upper, 1e-12);
    assert_eq!(projected_solid_angle(&wall(-2.0, -1.0), DVec3::Z).0, 0.0);
    // An endless ceiling is a sky; an endless wall half of one.
    let far = 1e9;
    close(projected_solid_angle(&square(0.0, 1e-9).map(|p| p * far), DVec3::Z).0, PI, 1e-8);
    let endless = [(-far, -far), (far, -far), (far, far), (-far, far)].map(|(x, z)| DVec3::new(x, 1.0, z));
    close(polygon_form_factor(&endless, DVec3::Z), 0.5, 1e-8);
    assert_eq!(projected_solid_angle(&[], DVec3::Z).0, 0.0);
    assert_eq!(projected_solid_angle(&square(0.0, 1.0), DVec3::ZERO).0, 0.0);
}

#[test]
fn form_factors_of_unit_squares_integrate_to_the_closed_forms() {
    // Midpoint rule over the receiver; its error falls with the square of the step, so two steps cancel it.
    let midpoint = |n: u32, square: &dyn Fn(f64, f64) -> [DVec3; 4]| {
        let at = |i: u32| (f64::from(i) + 0.5) / f64::from(n);
        let sum: f64 = (0..n)
            .flat_map(|i| (0..n).map(move |j| (i, j)))
            .map(|(i, j)| polygon_form_factor(&square(at(i), at(j)), DVec3::Z))
            .sum();
        sum / f64::from(n * n)
    };
    let mean = |n, square: &dyn Fn(f64, f64) -> [DVec3; 4]| {
        (4.0 * midpoint(2 * n, square) - midpoint(n, square)) / 3.0
    };
    let parallel = mean(50, &|x, y| {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(a, b)| DVec3::new(a - x, b - y, 1.0))
    });
    close(parallel, 0.199_824_895_698_387_4, 1e-8);
    let perpendicular = mean(200, &|x, y| {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(a, b)| DVec3::new(a - x, -y, b))
    });
    close(perpendicular, 0.200_043_776_075_403_2, 1e-5);
}

#[test]
fn hemispherical_coordinates_come_back() {
    for i in 0..200 {
        for j in 0..50 {
            let d = Hemispherical { theta: f64::from(i) / 200.0 * PI, phi: f64::from(j) / 50.0 * TAU };
            let w = d.direction();
            assert!((w.length() - 1.0).abs() < 1e-15);
            let back = Hemispherical::from_direction(w * 3.0);
            assert!((back.direction() - w).length() < 2e-15);
            assert!((back.theta - d.theta).abs() < 1e-14);
            assert!(i == 0 || (back.phi - d.phi).abs() < 1e-12, "{d:?} {back:?}");
            assert!((0.0..TAU).contains(&back.phi));
        }
    }
    assert_eq!(Hemispherical::from_direction(DVec3::Z), Hemispherical { theta: 0.0, phi: 0.0 });
    let almost = Hemispherical::from_direction(DVec3::new(1.0, -1e-20, 0.0));
    assert!((0.0..TAU).contains(&almost.phi));
    close(Hemispherical { theta: FRAC_PI_4, phi: 1.0 }.jacobian(), 0.5f64.sqrt(), 1e-15);
}
