//! The operations of an element, recorded by running its kernel on numbers that note what is done with them: their count,
//! and their text for a device.
//!
//! A device thus computes what the processor does, operation by operation, and the equations stand once, in the kernels.
//! The text is of the common part of OpenCL C and CUDA C++. It must be compiled without contraction, so that no product and sum
//! are fused but those that are here.

use crate::blocks::{BATCH, Batch};
use crate::formulation::Volumetric;
use crate::full::FullyIntegrated;
use crate::kernel::{Arrays, Constants, Kernel, OnePoint, block_force};
use crate::lanes::{Lanes, operators};
use mesh::Padded;
use std::cell::RefCell;
use std::fmt::{self, Display, Formatter};

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

/// An operation; what it is done with are the numbers of earlier ones.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Constant(f64),
    /// A component of a nodal vector, by its [`code`].
    Nodal(usize),
    Add(usize, usize),
    Sub(usize, usize),
    Mul(usize, usize),
    Div(usize, usize),
    Min(usize, usize),
    Sqrt(usize),
    /// a b + c
    Fma([usize; 3]),
    /// c - a b
    Fnma([usize; 3]),
}

/// The nodal arrays that an element reads.
const ARRAYS: [&str; 3] = ["reference", "displacement", "velocity"];

/// The number of a component of a corner's vector in an array.
const fn code(array: usize, corner: usize, axis: usize) -> usize {
    3 * (8 * array + corner) + axis
}

/// The operations of an element.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    operations: Vec<Operation>,
    /// The numbers of those that give what is subtracted from the forces on the corners.
    force: [[usize; 3]; 8],
}

/// What is recorded of an element; energies, which no device computes, are not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Recorded {
    /// Of a fully integrated element; none of a one-point element.
    pub(crate) full: Option<Volumetric>,
    /// With viscous stresses.
    pub(crate) viscous: bool,
}

impl Recorded {
    /// The operations of such an element with these constants.
    pub(crate) fn record(self, constants: &Constants) -> Record {
        match self.full {
            None => self.of::<OnePoint>(constants),
            Some(Volumetric::Full) => self.of::<FullyIntegrated<false>>(constants),
            Some(Volumetric::Mean) => self.of::<FullyIntegrated<true>>(constants),
        }
    }

    fn of<K: Kernel>(self, constants: &Constants) -> Record {
        // nodal vectors hold the codes of their components, and the forces come to hold the numbers of operations
        let codes: [[Padded; 8]; 3] = std::array::from_fn(|array| {
            std::array::from_fn(|corner| {
                Padded::new(std::array::from_fn(|axis| code(array, corner, axis) as f64))
            })
        });
        let mut force = [Padded::ZERO; 8];
        let mut batch = Batch { nodes: [[0; BATCH]; 8] };
        for (corner, lanes) in batch.nodes.iter_mut().enumerate() {
            lanes.fill(corner as u32);
        }
        let [reference, displacement, velocity] = codes.each_ref().map(|array| array.as_ptr());
        let arrays = Arrays { reference, displacement, velocity, force: force.as_mut_ptr() };
        OPERATIONS.take();
        let block = if self.viscous {
            block_force::<K, Number, false, true>
        } else {
            block_force::<K, Number, false, false>
        };
        // SAFETY: `Number` needs no special instructions, the batch's indices are those of the eight
        // nodes of each array, and these are local.
        unsafe { block(&[batch], 1, constants, arrays) };
        Record {
            operations: OPERATIONS.take(),
            force: force.map(|f| f.xyz().map(|number| number as usize)),
        }
    }
}

impl Record {
    /// How much work they are.
    pub(crate) fn work(&self) -> Work {
        let mut work = Work { scattered: 8, ..Work::default() };
        let mut components = 0;
        for operation in &self.operations {
            match operation {
                Operation::Constant(_) => (),
                Operation::Nodal(_) => components += 1,
                Operation::Add(..) | Operation::Sub(..) | Operation::Min(..) => work.additions += 1,
                Operation::Mul(..) => work.multiplications += 1,
                Operation::Div(..) | Operation::Sqrt(_) => work.divisions += 1,
                Operation::Fma(_) | Operation::Fnma(_) => work.multiply_additions += 1,
            }
        }
        work.gathered = components / 3;
        work
    }
}

/// Statements that define a number for each operation, and set the results `f[24]`; in scope are `n[8]`, the nodes of the corners, and
/// the arrays, of vectors of four.
impl Display for Record {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (number, operation) in self.operations.iter().enumerate() {
            write!(f, "    const double t{number} = ")?;
            match operation {
                Operation::Constant(value) => write!(f, "{}", Literal(*value)),
                Operation::Nodal(code) => {
                    let (vector, axis) = (code / 3, code % 3);
                    let (array, corner) = (ARRAYS[vector / 8], vector % 8);
                    write!(f, "{array}[4 * n[{corner}] + {axis}]")
                }
                Operation::Add(a, b) => write!(f, "t{a} + t{b}"),
                Operation::Sub(a, b) => write!(f, "t{a} - t{b}"),
                Operation::Mul(a, b) => write!(f, "t{a} * t{b}"),
                Operation::Div(a, b) => write!(f, "t{a} / t{b}"),
                Operation::Min(a, b) => write!(f, "t{a} < t{b} ? t{a} : t{b}"),
                Operation::Sqrt(a) => write!(f, "sqrt(t{a})"),
                Operation::Fma([a, b, c]) => write!(f, "fma(t{a}, t{b}, t{c})"),
                Operation::Fnma([a, b, c]) => write!(f, "fma(-t{a}, t{b}, t{c})"),
            }?;
            writeln!(f, ";")?;
        }
        for (component, number) in self.force.as_flattened().iter().enumerate() {
            writeln!(f, "    f[{component}] = t{number};")?;
        }
        Ok(())
    }
}

/// A number as both languages write it, to the last bit.
struct Literal(f64);

impl Display for Literal {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        // the shortest decimal that reads as the same number
        write!(f, "{:e}", self.0)
    }
}

thread_local! {
    /// The operations of [`Number`]s on this thread.
    static OPERATIONS: RefCell<Vec<Operation>> = const { RefCell::new(Vec::new()) };
}

/// The result of a recorded operation.
#[derive(Clone, Copy)]
struct Number(usize);

/// Not inlined: kernels are, and each of their operations would take the room of this.
#[inline(never)]
fn recorded(operation: Operation) -> Number {
    OPERATIONS.with_borrow_mut(|operations| {
        operations.push(operation);
        Number(operations.len() - 1)
    })
}

operators! { Number:
    Add add |a, b| recorded(Operation::Add(a.0, b.0));
    Sub sub |a, b| recorded(Operation::Sub(a.0, b.0));
    Mul mul |a, b| recorded(Operation::Mul(a.0, b.0));
    Div div |a, b| recorded(Operation::Div(a.0, b.0));
}

impl Lanes for Number {
    const N: usize = 1;
    unsafe fn splat(v: f64) -> Self {
        recorded(Operation::Constant(v))
    }
    fn min(self, o: Self) -> Self {
        recorded(Operation::Min(self.0, o.0))
    }
    fn sqrt(self) -> Self {
        recorded(Operation::Sqrt(self.0))
    }
    fn fma(self, b: Self, c: Self) -> Self {
        recorded(Operation::Fma([self.0, b.0, c.0]))
    }
    fn fnma(self, b: Self, c: Self) -> Self {
        recorded(Operation::Fnma([self.0, b.0, c.0]))
    }
    /// Of energies and power, which are not recorded.
    fn sum(self, _: usize) -> f64 {
        0.0
    }
    unsafe fn gather(base: *const Padded, index: *const u32) -> [Self; 3] {
        // SAFETY: the caller's contract is that of the trait.
        let codes = unsafe { f64::gather(base, index) };
        codes.map(|code| recorded(Operation::Nodal(code as usize)))
    }
    unsafe fn scatter_sub(base: *mut Padded, index: *const u32, v: [Self; 3], count: usize) {
        if count == 1 {
            // SAFETY: the caller's contract is that of the trait.
            unsafe { *base.add(*index as usize) = Padded::new(v.map(|number| number.0 as f64)) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONSTANTS: Constants = Constants {
        lambda: 1.0,
        shear: 1.0,
        hourglass: 1.0,
        kelvin_voigt: 1.0,
        bulk_linear: 1.0,
        bulk_quadratic: 1.0,
    };

    fn work(full: Option<Volumetric>, viscous: bool) -> Work {
        Recorded { full, viscous }.record(&CONSTANTS).work()
    }

    /// Guards the cost of the kernels, which is the same on every machine.
    #[test]
    fn an_element_costs_no_more_operations_than_when_it_was_measured() {
        for (full, flops, gathered) in [
            (None, 922, 16),
            (Some(Volumetric::Full), 2613, 16),
            (Some(Volumetric::Mean), 3208, 16),
        ] {
            let done = work(full, false);
            assert_eq!((done.flops(), done.gathered), (flops, gathered), "{full:?}: {done:?}");
        }
    }

    #[test]
    fn viscous_stresses_cost_extra() {
        let [plain, viscous] = [false, true].map(|viscous| work(None, viscous));
        assert!(viscous.flops() > plain.flops());
        assert_eq!(viscous.gathered, plain.gathered + 8);
    }
}
