use etendue_core::{Ray, Transform, Vec2, Vec3A};
use etendue_geometry::{Geometry, Hit, Shape, Surface, TriangleMesh};
use etendue_sampling::{AliasTable, warp};
use etendue_scene::Scene;

/// Why a scene's surfaces cannot be drawn by area.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AreaError {
    /// A geometry without an area to draw from.
    #[error(
        "geometry {geom} has no finite area, or gives no samples of it (an infinite plane, a tube without ends, a shape \
         that does not implement Shape::area and Shape::sample): it cannot be drawn from by area"
    )]
    NoArea {
        /// Its number.
        geom: u32,
    },
    /// More triangles than can be told apart.
    #[error("geometry {geom} has more triangles than 32 bits can count")]
    TooMany {
        /// Its number.
        geom: u32,
    },
}

/// All surfaces of a scene that rays see, to be drawn from by area.
pub(super) struct Surfaces {
    placed: Vec<Placed>,
    /// Over `placed`; `None` in an empty scene.
    choice: Option<AliasTable>,
    /// Over the triangles of each mesh that is placed, by area in its own space.
    triangles: Vec<Option<AliasTable>>,
}

/// One geometry where it stands.
#[derive(Clone, Copy)]
struct Placed {
    inst: u32,
    geom: u32,
}

/// A point drawn on some surface.
pub(super) struct AreaSample {
    pub(super) surface: Surface,
    /// World space, m⁻².
    pub(super) pdf_area: f64,
}

/// Random numbers for one point.
pub(super) struct AreaNumbers {
    pub(super) geometry: f64,
    pub(super) triangle: f64,
    pub(super) point: Vec2,
}

impl Surfaces {
    pub(super) fn new(scene: &Scene) -> Result<Self, AreaError> {
        let world = scene.world();
        let mut triangles: Vec<Option<AliasTable>> = world.geometries.iter().map(|_| None).collect();
        let (mut placed, mut weights) = (Vec::new(), Vec::new());
        let mut place = |inst: u32, geom: u32, to_world: Option<&Transform>| {
            let Some(geometry) = world.geometries.get(geom as usize) else { return Ok(()) };
            let area = match geometry {
                Geometry::Mesh(mesh) => {
                    let table = &mut triangles[geom as usize];
                    if table.is_none() {
                        *table = over_triangles(mesh, geom)?;
                    }
                    table.as_ref().map_or(0.0, AliasTable::total)
                }
                _ => area_of(geometry.shape(), geom)?,
            };
            if area > 0.0 {
                // Exact where the placement scales evenly; else the density says by how much it is not.
                let scale = to_world.map_or(1.0, |m| {
                    [Vec3A::X, Vec3A::Y, Vec3A::Z].map(|n| m.area_scale(n)).iter().sum::<f64>() / 3.0
                });
                placed.push(Placed { inst, geom });
                weights.push(area * scale);
            }
            Ok(())
        };
        for &geom in world.direct.iter().filter(|&&g| world.mask(g) != 0) {
            place(Hit::NO_INSTANCE, geom, None)?;
        }
        for (inst, instance) in world.instances.iter().enumerate() {
            for &geom in instance.geoms.iter().filter(|&&g| world.mask(g) & instance.mask != 0) {
                place(inst as u32, geom, Some(&instance.to_world))?;
            }
        }
        let choice = AliasTable::new(weights.iter().copied()).ok();
        Ok(Self { placed, choice, triangles })
    }

    /// A point on one of the surfaces as it stands at `time`.
    pub(super) fn sample(&self, scene: &Scene, u: &AreaNumbers, time: f32) -> Option<AreaSample> {
        let world = scene.world();
        let chosen = self.choice.as_ref()?.sample(u.geometry);
        let Placed { inst, geom } = *self.placed.get(chosen.index)?;
        let to_world = world.instances.get(inst as usize).map(|i| i.placement(time));
        let stretch = |n: Vec3A| to_world.as_ref().map_or(1.0, |m| m.area_scale(n));
        let (uv, prim, ray, t, pdf_object, n) = match world.geometries.get(geom as usize)? {
            Geometry::Mesh(mesh) => {
                let table = self.triangles.get(geom as usize)?.as_ref()?;
                let triangle = table.sample(u.triangle);
                let prim = triangle.index as u32;
                // A mesh's surface is a function of triangle and weights; the ray says nothing more.
                let ray = Ray { time, ..Ray::new(Vec3A::ZERO, Vec3A::Z) };
                (warp::triangle(u.point), prim, ray, 0.0, 1.0 / table.total(), mesh.normal(prim)?)
            }
            geometry => {
                let shape = geometry.shape()?;
                let s = shape.sample(u.point)?;
                // As of a ray that fell straight onto it.
                let far = shape.bounds().radius();
                let (o, d) = (s.p + s.ng * far, -s.ng);
                let (o, d) = to_world.as_ref().map_or((o, d), |m| (m.point(o), m.vector(d)));
                (s.uv, 0, Ray { time, ..Ray::new(o, d) }, far, f64::from(s.pdf_area), s.ng)
            }
        };
        let surface = scene.surface(&ray, &Hit { t, uv, inst, geom, prim }, 0.0);
        let pdf_area = f64::from(chosen.pmf) * pdf_object / stretch(n);
        (pdf_area > 0.0 && pdf_area.is_finite()).then_some(AreaSample { surface, pdf_area })
    }
}

/// Triangles by their area in object space; `None` where none has any.
fn over_triangles(mesh: &TriangleMesh, geom: u32) -> Result<Option<AliasTable>, AreaError> {
    let count = u32::try_from(mesh.triangle_count()).map_err(|_| AreaError::TooMany { geom })?;
    let area = |prim| {
        let wide = |v: Vec3A| v.to_array().map(f64::from);
        let [a, b, c] = mesh.triangle(prim).map(wide);
        let along = |v: [f64; 3]| [0, 1, 2].map(|i| v[i] - a[i]);
        let ([x, y, z], [p, q, r]) = (along(b), along(c));
        let cross = [y * r - z * q, z * p - x * r, x * q - y * p];
        let drawn = !mesh.is_degenerate(prim) && mesh.normal(prim).is_some();
        if drawn { 0.5 * cross.iter().map(|v| v * v).sum::<f64>().sqrt() } else { 0.0 }
    };
    Ok(AliasTable::new((0..count).map(area)).ok())
}

fn area_of(shape: Option<&dyn Shape>, geom: u32) -> Result<f64, AreaError> {
    let area = shape.map_or(0.0, |s| f64::from(s.area()));
    let drawn = shape.and_then(|s| s.sample(Vec2::splat(0.5)));
    if area > 0.0 && area.is_finite() && drawn.is_some() { Ok(area) } else { Err(AreaError::NoArea { geom }) }
}
