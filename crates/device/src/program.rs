//! The text of the kernels, in the common part of OpenCL C and CUDA C++.

use solid::DeviceElements;
use std::fmt::Write;

/// What stands before the kernels in OpenCL C.
pub const OPENCL: &str = "\
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#pragma OPENCL FP_CONTRACT OFF
#define KERNEL __kernel void
#define GLOBAL __global
#define INDEX get_global_id(0)
";

/// What stands before the kernels in CUDA C++, which is compiled with `--fmad=false`.
pub const CUDA: &str = "\
#define KERNEL extern \"C\" __global__ void
#define GLOBAL
#define INDEX (blockIdx.x * blockDim.x + threadIdx.x)
typedef unsigned int uint;
";

/// The nodes: the force on one is the sum of what its elements exert, in their order; then central difference,
/// `v += dt f/m`, `u += dt v`.
const NODES: &str = "
KERNEL subtract_forces(
    uint nodes, uint elements, GLOBAL const uint *begin, GLOBAL const uint *places, GLOBAL const double *corners, GLOBAL double *force
) {
    const uint node = INDEX;
    if (node >= nodes) return;
    double x = force[4 * node], y = force[4 * node + 1], z = force[4 * node + 2];
    for (uint k = begin[node]; k < begin[node + 1]; ++k) {
        const uint at = places[k];
        x -= corners[at];
        y -= corners[at + elements];
        z -= corners[at + 2 * elements];
    }
    force[4 * node] = x;
    force[4 * node + 1] = y;
    force[4 * node + 2] = z;
}

KERNEL advance(
    uint nodes, double dt, GLOBAL const double *inverse_mass, GLOBAL double *force, GLOBAL double *displacement, GLOBAL double *velocity
) {
    const uint node = INDEX;
    if (node >= nodes) return;
    const double scale = dt * inverse_mass[node];
    for (uint i = 4 * node; i < 4 * node + 3; ++i) {
        const double v = velocity[i] + scale * force[i];
        velocity[i] = v;
        displacement[i] += dt * v;
        force[i] = 0.0;
    }
}
";

/// The kernels after one of the prefaces: `elements_0`, `elements_1`, ... for each kind of `elements`, `subtract_forces`, `advance`.
pub fn text(preface: &str, elements: &DeviceElements) -> String {
    let mut text = String::from(preface);
    for (kind, of) in elements.kinds.iter().enumerate() {
        // a `String` takes all
        let _ = write!(
            text,
            "
KERNEL elements_{kind}(
    uint first, uint count, uint elements, GLOBAL const uint *nodes, GLOBAL const double *reference, GLOBAL const double *displacement,
    GLOBAL const double *velocity, GLOBAL double *corners
) {{
    if (INDEX >= count) return;
    const uint element = first + INDEX;
    uint n[8];
    double f[24];
    for (uint corner = 0; corner < 8; ++corner) n[corner] = nodes[corner * elements + element];
{}    for (uint i = 0; i < 24; ++i) corners[i * elements + element] = f[i];
}}
",
            of.text
        );
    }
    text + NODES
}
