//! The cost of an element, counted by running its kernel on numbers that count their operations.

use crate::blocks::{BATCH, Batch};
use crate::formulation::Volumetric;
use crate::full::FullyIntegrated;
use crate::kernel::{Arrays, Constants, Kernel, OnePoint, block_force};
use crate::lanes::{Lanes, operators};
use mesh::Padded;
use std::cell::Cell;

/// Operations of one element in one evaluation of its internal force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Work {
    /// Additions, subtractions and minima.
    pub(crate) additions: u32,
    /// Multiplications.
    pub(crate) multiplications: u32,
    /// Fused multiply-additions, one instruction each.
    pub(crate) multiply_additions: u32,
    /// Divisions and square roots.
    pub(crate) divisions: u32,
    /// Nodal vectors read.
    pub(crate) gathered: u32,
    /// Nodal vectors read, added to and written.
    pub(crate) scattered: u32,
}

impl Work {
    /// Floating-point operations; a multiply-addition is two, a division one.
    pub(crate) fn flops(&self) -> u32 {
        let added = 3 * self.scattered;
        self.additions + self.multiplications + 2 * self.multiply_additions + self.divisions + added
    }
}

/// Counts the work of one element: a fully integrated one with `full`, else a one-point one.
pub(crate) fn work(full: Option<Volumetric>, energies: bool, viscous: bool) -> Work {
    match full {
        None => counted::<OnePoint>(energies, viscous),
        Some(Volumetric::Full) => counted::<FullyIntegrated<false>>(energies, viscous),
        Some(Volumetric::Mean) => counted::<FullyIntegrated<true>>(energies, viscous),
    }
}

fn counted<K: Kernel>(energies: bool, viscous: bool) -> Work {
    const CORNERS: [[f64; 3]; 8] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
    ];
    let reference = CORNERS.map(Padded::new);
    let rest = [Padded::ZERO; 8];
    let mut force = [Padded::ZERO; 8];
    let mut batch = Batch { nodes: [[0; BATCH]; 8] };
    for (corner, lanes) in batch.nodes.iter_mut().enumerate() {
        lanes.fill(corner as u32);
    }
    let constants = Constants {
        lambda: 1.0,
        shear: 1.0,
        hourglass: 1.0,
        kelvin_voigt: 1.0,
        bulk_linear: 1.0,
        bulk_quadratic: 1.0,
    };
    let arrays = Arrays {
        reference: reference.as_ptr(),
        displacement: rest.as_ptr(),
        velocity: rest.as_ptr(),
        force: force.as_mut_ptr(),
    };
    TALLY.set(Work::default());
    let block = match (energies, viscous) {
        (false, false) => block_force::<K, Counted, false, false>,
        (false, true) => block_force::<K, Counted, false, true>,
        (true, false) => block_force::<K, Counted, true, false>,
        (true, true) => block_force::<K, Counted, true, true>,
    };
    // SAFETY: `Counted` needs no special instructions, the batch's indices are those of the eight
    // nodes of each array, and these are local.
    unsafe { block(&[batch], 1, &constants, arrays) };
    TALLY.get()
}

thread_local! {
    /// Operations that [`Counted`] has done on this thread.
    static TALLY: Cell<Work> = const {
        Cell::new(Work {
            additions: 0,
            multiplications: 0,
            multiply_additions: 0,
            divisions: 0,
            gathered: 0,
            scattered: 0,
        })
    };
}

/// Changes the tally of this thread.
fn count(change: fn(&mut Work)) {
    let mut done = TALLY.get();
    change(&mut done);
    TALLY.set(done);
}

/// One lane whose operations are counted in the tally of the calling thread.
#[derive(Clone, Copy)]
struct Counted(f64);

fn addition(done: &mut Work) {
    done.additions += 1;
}

fn multiplication(done: &mut Work) {
    done.multiplications += 1;
}

fn multiply_addition(done: &mut Work) {
    done.multiply_additions += 1;
}

fn division(done: &mut Work) {
    done.divisions += 1;
}

/// Passes `value`, whose operations `change` counts.
fn counting(change: fn(&mut Work), value: f64) -> Counted {
    count(change);
    Counted(value)
}

operators! { Counted:
    Add add |a, b| counting(addition, a.0 + b.0);
    Sub sub |a, b| counting(addition, a.0 - b.0);
    Mul mul |a, b| counting(multiplication, a.0 * b.0);
    Div div |a, b| counting(division, a.0 / b.0);
}

// The arithmetic is that of the portable lane, whose methods need no special instructions.
impl Lanes for Counted {
    const N: usize = 1;
    unsafe fn splat(v: f64) -> Self {
        Self(v)
    }
    fn min(self, o: Self) -> Self {
        counting(addition, self.0.min(o.0))
    }
    fn sqrt(self) -> Self {
        counting(division, self.0.sqrt())
    }
    fn fma(self, b: Self, c: Self) -> Self {
        counting(multiply_addition, self.0.fma(b.0, c.0))
    }
    fn fnma(self, b: Self, c: Self) -> Self {
        counting(multiply_addition, self.0.fnma(b.0, c.0))
    }
    fn sum(self, lanes: usize) -> f64 {
        self.0.sum(lanes)
    }
    unsafe fn gather(base: *const Padded, index: *const u32) -> [Self; 3] {
        count(|done| done.gathered += 1);
        // SAFETY: the caller's contract is that of the trait.
        unsafe { f64::gather(base, index) }.map(Self)
    }
    unsafe fn scatter_sub(base: *mut Padded, index: *const u32, v: [Self; 3], lanes: usize) {
        count(|done| done.scattered += 1);
        // SAFETY: the caller's contract is that of the trait.
        unsafe { f64::scatter_sub(base, index, v.map(|lane| lane.0), lanes) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Guards the cost of the kernels, which is the same on every machine.
    #[test]
    fn an_element_costs_no_more_operations_than_when_it_was_measured() {
        for (full, flops, gathered) in [
            (None, 922, 16),
            (Some(Volumetric::Full), 2613, 16),
            (Some(Volumetric::Mean), 3208, 16),
        ] {
            let done = work(full, false, false);
            assert_eq!((done.flops(), done.gathered), (flops, gathered), "{full:?}: {done:?}");
        }
    }

    #[test]
    fn energies_and_viscous_stresses_cost_extra() {
        let one_point = |energies, viscous| work(None, energies, viscous);
        let plain = one_point(false, false);
        assert!(one_point(true, false).flops() > plain.flops());
        assert_eq!(one_point(false, true).gathered, plain.gathered + 8);
    }
}
