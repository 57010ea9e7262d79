//! Light (skeleton).
mod light;
mod picker;
pub use light::{Light, LightBounds, LightId, LightSample, LitPoint, Sides};
pub use picker::{LightPicker, Pick};
