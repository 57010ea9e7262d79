//! Choosing among lights: probabilities that add up, draws that follow them, numbers that stay fresh.

mod support;

use std::sync::Arc;

use etendue_core::{Spectrum, Vec3A};
use etendue_geometry::presets;
use etendue_light::{
    ConstantEnvironment, Light, LightId, LightPicker, MeshLight, PointLight, PowerPicker, SinglePicker,
    UniformPicker,
};
use support::free;

/// A dark point, a quad of two unequal halves, a bright point, a furnace: five parts.
fn lights() -> Vec<Arc<dyn Light>> {
    let mut quad = presets::quad(Vec3A::ZERO, Vec3A::X, Vec3A::Z).positions().to_vec();
    quad[3].z = 3.0;
    let mesh = etendue_geometry::TriangleMesh::new(quad, vec![[0, 1, 2], [0, 2, 3]]).expect("two triangles");
    vec![
        Arc::new(PointLight::new(Vec3A::X, Spectrum::BLACK)),
        Arc::new(MeshLight::new(Arc::new(mesh), None, Spectrum::gray(4.0).into(), false)),
        Arc::new(PointLight::new(Vec3A::Y, Spectrum::rgb(1.0, 2.0, 3.0))),
        Arc::new(ConstantEnvironment::new(Spectrum::gray(0.1))),
    ]
}

fn ids(lights: &[Arc<dyn Light>]) -> Vec<LightId> {
    let each = |(light, l): (usize, &Arc<dyn Light>)| {
        (0..l.parts()).map(move |part| LightId { light: light as u32, part }).collect::<Vec<_>>()
    };
    lights.iter().enumerate().flat_map(each).collect()
}

/// `n` evenly spaced numbers: counts are exact to one, the remapped numbers uniform to 1/count.
fn check(picker: &dyn LightPicker, ids: &[LightId], expected: &[f64]) {
    let at = free(Vec3A::ZERO);
    let n = 1 << 20;
    let mut counts = vec![0u32; ids.len()];
    let mut sums = vec![0.0f64; ids.len()];
    for i in 0..n {
        let pick = picker.pick(&at, (i as f32 + 0.5) / n as f32).expect("something shines");
        assert_eq!(pick.pmf, picker.pmf(&at, pick.id));
        assert!((0.0..1.0).contains(&pick.u));
        let k = ids.iter().position(|id| *id == pick.id).expect("an existing part");
        counts[k] += 1;
        sums[k] += f64::from(pick.u);
    }
    let total: f64 = ids.iter().map(|id| f64::from(picker.pmf(&at, *id))).sum();
    assert!((total - 1.0).abs() < 1e-6, "{total}");
    for (k, id) in ids.iter().enumerate() {
        let rate = f64::from(counts[k]) / f64::from(n);
        assert!((rate - expected[k]).abs() < 1e-5, "{id:?}: {rate} for {}", expected[k]);
        assert!((f64::from(picker.pmf(&at, *id)) - expected[k]).abs() < 1e-6);
        if counts[k] > 0 {
            let mean = sums[k] / f64::from(counts[k]);
            assert!((mean - 0.5).abs() < 1e-3, "{id:?}: remapped numbers average {mean}");
        }
    }
    for stranger in [LightId { light: 9, part: 0 }, LightId { light: 1, part: 2 }] {
        assert_eq!(picker.pmf(&at, stranger), 0.0);
    }
}

#[test]
fn power_picker_follows_the_powers() {
    let (lights, radius) = (lights(), 2.0);
    let ids = ids(&lights);
    let pi = std::f64::consts::PI;
    // π A L, 4π I and 4π² R² L, by hand.
    let powers = [0.0, pi * 0.5 * 4.0, pi * 1.5 * 4.0, 4.0 * pi * 2.0, 4.0 * pi * pi * 4.0 * 0.1];
    let total: f64 = powers.iter().sum();
    let expected: Vec<f64> = powers.iter().map(|p| p / total).collect();
    let picker = PowerPicker::new(&lights, radius).expect("something shines");
    check(&picker, &ids, &expected);
    assert!(PowerPicker::new(&lights[..1], radius).is_none(), "only a dark light");
    assert!(PowerPicker::new(&[], radius).is_none());
}

#[test]
fn uniform_picker_is_uniform() {
    let lights = lights();
    let ids = ids(&lights);
    check(&UniformPicker::new(&lights).expect("five parts"), &ids, &[0.2; 5]);
    assert!(UniformPicker::new(&[]).is_none());
}

#[test]
fn single_picker_has_no_choice() {
    let at = free(Vec3A::ZERO);
    let id = LightId { light: 2, part: 0 };
    let picker = SinglePicker::new(id);
    let pick = picker.pick(&at, 0.375).expect("the one");
    assert_eq!((pick.id, pick.pmf, pick.u), (id, 1.0, 0.375));
    assert_eq!(picker.pmf(&at, LightId { light: 2, part: 1 }), 0.0);
}
