//! Whole runs, one program of tests: each more would be linked with the whole solver again, and they take turns, where the
//! tests of one share the cores.
#![allow(clippy::unwrap_used)]

mod bits;
mod checkpoint;
mod contact_layers;
mod deformation;
mod determinism;
mod exact;
mod friction_laws;
mod half_model;
mod half_space;
mod irregular;
mod line_contact;
mod nearly_incompressible;
mod physics;
mod plane_strain;
mod preload;
mod profiles;
mod ranks;
mod resultants;
mod sideways;
mod window;
