//! A view and a light for scenes that bring none.

use etendue_camera::{CameraError, Perspective};
use etendue_core::{Aabb, UVec2, Vec3A, vector};
use etendue_light::ImageEnvironment;
use etendue_scene::SceneBuilder;
use etendue_texture::ImageTexture;

/// Vertical field of view of the fallback camera, degrees.
const FOV_DEG: f32 = 35.0;

/// A camera in front of the box, a little to the right and above, far enough that all of it is seen.
///
/// # Errors
/// No pixels.
pub fn camera(bounds: &Aabb, size: UVec2) -> Result<Perspective, CameraError> {
    let sound = bounds.is_finite() && !bounds.is_empty() && bounds.radius() > 0.0;
    // Nothing to look at is looked at all the same: the picture shows the background.
    let (center, radius) = if sound { (bounds.center(), bounds.radius()) } else { (Vec3A::ZERO, 1.0) };
    let half_height = etendue_core::math::tan((FOV_DEG * 0.5).to_radians());
    let aspect = if size.x < size.y { size.x as f32 / size.y as f32 } else { 1.0 };
    // Distance at which the bounding sphere touches the narrower side of the view.
    let half = half_height * aspect;
    let distance = radius * (1.0 + half * half).sqrt() / half;
    let from = center + vector::normalize(Vec3A::new(0.45, 0.35, 1.0)) * distance;
    Perspective::look_at(from, center, Vec3A::Y, FOV_DEG, size)
}

/// Width of the fallback sky, texels.
const SKY: UVec2 = UVec2::new(64, 32);

/// A soft sky: bright above, dim below, with one warm broad light over the camera's left shoulder.
pub fn light(builder: &mut SceneBuilder) {
    let key = vector::normalize(Vec3A::new(-0.6, 0.7, 0.75));
    let mut texels = Vec::new();
    for y in 0..SKY.y {
        for x in 0..SKY.x {
            let phi = (x as f32 + 0.5) / SKY.x as f32 * std::f32::consts::TAU;
            let theta = (y as f32 + 0.5) / SKY.y as f32 * std::f32::consts::PI;
            let (sin_phi, cos_phi) = etendue_core::math::sin_cos(phi);
            let (sin_theta, cos_theta) = etendue_core::math::sin_cos(theta);
            let d = Vec3A::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi);
            let up = 0.5 + 0.5 * d.y;
            let lobe = {
                let c = d.dot(key);
                let c = if c > 0.0 { c } else { 0.0 };
                let c2 = c * c;
                let c8 = c2 * c2 * c2 * c2;
                c8 * c8
            };
            let sky = 0.18 + 0.55 * up * up;
            texels.extend([sky * 0.92 + 5.0 * lobe, sky + 4.7 * lobe, sky * 1.1 + 4.2 * lobe]);
        }
    }
    if let Ok(image) = ImageTexture::from_f32(SKY.x, SKY.y, 3, texels)
        && let Ok(sky) = ImageEnvironment::new(image, 1.0, 0.0)
    {
        builder.light(sky);
    }
}
