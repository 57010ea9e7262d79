//! The virtual gonioreflectometer against what it should read: BSDFs of flat sheets, closed forms of grooves and cavities.

mod cavities;
mod flat;
mod grooves;
mod support;
