#![doc = include_str!("../README.md")]

#[cfg(not(target_arch = "wasm32"))]
mod clock;

#[cfg(not(target_arch = "wasm32"))]
pub use clock::SystemClock;
pub use etendue_bsdf as bsdf;
pub use etendue_bvh as bvh;
pub use etendue_camera as camera;
pub use etendue_core as core;
pub use etendue_core::glam;
pub use etendue_geometry as geometry;
pub use etendue_integrator as integrator;
pub use etendue_io as io;
pub use etendue_light as light;
pub use etendue_material as material;
pub use etendue_measure as measure;
pub use etendue_sampling as sampling;
pub use etendue_scene as scene;
pub use etendue_texture as texture;

/// What most programs use, in one import.
pub mod prelude {
    pub use etendue_bsdf::{Bsdf, BsdfAt, BsdfSample, Lobes, Mode};
    pub use etendue_camera::{
        Camera, CameraSample, Film, Filter, Orthographic, Panorama, Perspective, Planes, Shutter,
    };
    pub use etendue_core::{
        CancelFlag, Frame, Motion, Needs, Origin, Progress, Ray, Spectrum, Transform, UVec2, Vec2, Vec3,
        Vec3A, Vec4,
    };
    pub use etendue_geometry::{
        Cylinder, Disc, Geometry, Hit, Parallelogram, Plane, Shape, ShapeHit, ShapeSample, Sphere, Surface,
        TriangleMesh,
    };
    pub use etendue_integrator::{
        Context, DirectLight, Integrator, PathTracer, Recorder, RenderOptions, Report, Roulette, Sample,
        render, replay,
    };
    pub use etendue_light::{
        ConstantEnvironment, DirectionalLight, GoniometricLight, ImageEnvironment, Light, LightPicker,
        PointLight, SpotLight,
    };
    pub use etendue_material::{Diffuse, Glass, Material, Metal, NormalMapped, Principled};
    pub use etendue_sampling::{Dim, Independent, Sampler, Slot, Sobol, Stratified};
    pub use etendue_scene::{Emission, Scene, SceneBuilder};
    pub use etendue_texture::{ImageTexture, Tex, Texture};
}
