//! Texture (skeleton).
mod texture;
pub use texture::{TexPoint, Texture};
