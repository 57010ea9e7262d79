//! glTF 2.0.

// The loader, which uses it, is not here yet.
#[allow(dead_code, unused_imports)]
mod check;
