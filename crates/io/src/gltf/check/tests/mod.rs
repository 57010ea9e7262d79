// Time limits are what some of these tests are about.
#![allow(clippy::disallowed_methods)]

mod containers;
mod contents;
mod corpus;
mod driver;
mod hostile;
mod mutated;
mod scene;
mod structure;
mod surfaces;
