//! Elements and nodes on a graphics processor.
//!
//! The kernels of the elements are those of `solid`, recorded operation by operation; a node adds what its elements exert in the
//! processor's order. So the bits are those of [`solid::Level::pinned`].

#[cfg(feature = "gpu")]
pub mod opencl;
pub mod program;
