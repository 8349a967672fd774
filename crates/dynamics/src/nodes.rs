//! The nodal update: velocity, position, and the force cleared for the next step, in one pass.

use mesh::Padded;
use rayon::prelude::*;

/// Nodes per parallel chunk; fixed, so that partial sums do not depend on the threads.
const CHUNK: usize = 4096;

/// v^{n+1/2} = v^{n-1/2} + dt f/m and u^{n+1} = u^n + dt v^{n+1/2}; clears `force`.
///
/// Nodes of zero inverse mass keep their velocity: whoever holds them has set it. With `kinetic`
/// the result is sum 1/2 m v^{n-1/2} . v^{n+1/2} (J) over the free nodes, the kinetic energy that
/// central difference conserves, else zero. `partial` holds one entry per chunk.
pub(crate) fn advance(
    displacement: &mut [Padded],
    velocity: &mut [Padded],
    force: &mut [Padded],
    inverse_mass: &[f64],
    dt: f64,
    kinetic: bool,
    partial: &mut [f64],
) -> f64 {
    let chunk = |(((u, v), (f, m)), sum): Chunk<'_>| {
        *sum = if kinetic {
            update::<true>(u, v, f, m, dt)
        } else {
            update::<false>(u, v, f, m, dt)
        };
    };
    let chunks = displacement
        .par_chunks_mut(CHUNK)
        .zip(velocity.par_chunks_mut(CHUNK))
        .zip(
            force
                .par_chunks_mut(CHUNK)
                .zip(inverse_mass.par_chunks(CHUNK)),
        )
        .zip(partial.par_iter_mut());
    chunks.for_each(chunk);
    if kinetic { partial.iter().sum() } else { 0.0 }
}

type Chunk<'a> = (
    (
        (&'a mut [Padded], &'a mut [Padded]),
        (&'a mut [Padded], &'a [f64]),
    ),
    &'a mut f64,
);

/// Number of chunks, hence of partial sums, for `nodes` nodes.
pub(crate) fn chunks(nodes: usize) -> usize {
    nodes.div_ceil(CHUNK)
}

#[inline(always)]
fn update<const KINETIC: bool>(
    u: &mut [Padded],
    v: &mut [Padded],
    f: &mut [Padded],
    inverse_mass: &[f64],
    dt: f64,
) -> f64 {
    let mut twice_kinetic = 0.0;
    for (((u, v), f), &w) in u.iter_mut().zip(v).zip(f).zip(inverse_mass) {
        let before = *v;
        let scale = dt * w;
        for i in 0..4 {
            v.0[i] += scale * f.0[i];
            u.0[i] += dt * v.0[i];
            f.0[i] = 0.0;
        }
        if KINETIC && w > 0.0 {
            let product = before.0[0] * v.0[0] + before.0[1] * v.0[1] + before.0[2] * v.0[2];
            twice_kinetic += product / w;
        }
    }
    0.5 * twice_kinetic
}
