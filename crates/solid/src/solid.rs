//! All bodies as one assembly of elements: internal force, energies, stiffness product, stress.

use crate::blocks::{Batch, Block, Blocks, Pieces};
use crate::device::DeviceElements;
use crate::formulation::{Element, Elements, Formulation, Volumetric};
use crate::full::FullyIntegrated;
use crate::gauss::gauss_points;
use crate::geometry::displacement_gradient;
use crate::kernel::{Arrays, Constants, Kernel, OnePoint, Sums, block_force};
#[cfg(target_arch = "aarch64")]
use crate::lanes::neon;
#[cfg(target_arch = "x86_64")]
use crate::lanes::x86;
use crate::lanes::{Four, Level};
use crate::material::{Material, MaterialError};
use crate::record::Recorded;
use crate::stress::{deformation, mean_cauchy, one_point_cauchy};
use exact_sum::ExactSum;
use mesh::{Mesh, Padded};
use nalgebra::Vector3;
use rayon::prelude::*;
use thiserror::Error;

/// Coefficients of the viscous stresses in the elements, each zero by default. Bulk viscosity q is a pressure that acts
/// in compression only (tr dE/dt < 0); its length l is V sqrt(3/2)/|B|, the edge of a cube. Stresses are second
/// Piola–Kirchhoff stresses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Viscosity {
    /// Linear coefficient b1 (dimensionless; 0.06 is usual): q = b1 rho c_p l |tr dE/dt|.
    pub bulk_linear: f64,
    /// Quadratic coefficient b2 (dimensionless; 1.2 to 1.5 is usual): q = b2^2 rho l^2 (tr dE/dt)^2.
    pub bulk_quadratic: f64,
    /// Kelvin–Voigt time eta (s): S_v = eta C : dE/dt, C the elasticity tensor.
    pub kelvin_voigt: f64,
}

impl Viscosity {
    /// Whether any viscous stress acts.
    pub fn any(&self) -> bool {
        self.bulk_linear != 0.0 || self.bulk_quadratic != 0.0 || self.kelvin_voigt != 0.0
    }
}

/// Sums over all elements of an evaluation of the internal force: rounded, or exact (`T` is [`ExactSum`]) over the elements
/// whose energies are counted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ForceSums<T = f64> {
    /// Strain energy (J); zero unless energies were asked for.
    pub internal: T,
    /// Hourglass energy (J); zero unless energies were asked for.
    pub hourglass: T,
    /// Power dissipated by viscous stresses (W); zero if there are none.
    pub viscous_power: T,
}

impl ForceSums<ExactSum> {
    /// The sums, rounded.
    pub fn value(&self) -> ForceSums {
        ForceSums {
            internal: self.internal.value(),
            hourglass: self.hourglass.value(),
            viscous_power: self.viscous_power.value(),
        }
    }
}

/// Why a solid cannot be set up.
#[derive(Debug, Error)]
pub enum SolidError {
    /// A body's material is not physical.
    #[error("body '{body}': {source}")]
    Material {
        /// Name of the body.
        body: String,
        /// The constant that is not physical.
        source: MaterialError,
    },
    /// An element has no positive volume.
    #[error(
        "element {element} of body '{body}' has volume {volume:e} m^3; its nodes are ordered inside out or it is degenerate"
    )]
    Inverted {
        /// Name of the body.
        body: String,
        /// Index in the mesh.
        element: usize,
        /// Its signed volume (m^3).
        volume: f64,
    },
    /// A fully integrated element is folded at a Gauss point.
    #[error(
        "element {element} of body '{body}' is folded: its Jacobian at a Gauss point is {jacobian:e} of its mean"
    )]
    Folded {
        /// Name of the body.
        body: String,
        /// Index in the mesh.
        element: usize,
        /// Smallest volume of a Gauss point over an eighth of the element's (dimensionless), not positive.
        jacobian: f64,
    },
    /// This machine cannot run the level of this name.
    #[error("this machine has no {0} instructions")]
    Level(&'static str),
    /// The numbers of materials and of bodies differ.
    #[error("{bodies} bodies need as many materials, not {materials}")]
    Count {
        /// Bodies in the mesh.
        bodies: usize,
        /// Materials given.
        materials: usize,
    },
}

type BlockForce = unsafe fn(&[Batch], usize, &Constants, Arrays) -> Sums;

/// All elements of a mesh with their materials.
pub struct Solid {
    reference: Vec<Padded>,
    blocks: Blocks,
    /// What is computed of them, and the sums over each piece.
    pieces: Pieces,
    /// Per body, for its one-point and for its fully integrated elements.
    constants: Vec<[Constants; 2]>,
    one_point: Element,
    volumetric: Volumetric,
    sums: Vec<Sums>,
    level: Level,
    viscous: bool,
    bodies: Vec<(std::ops::Range<usize>, Material)>,
}

impl Solid {
    /// The elements of `mesh` with one material per body, in order. An [`Element`] for `elements` gives one-point
    /// elements throughout, a [`Volumetric`] fully integrated ones. `level` is the instruction set of the kernels.
    ///
    /// # Errors
    /// [`SolidError::Count`], [`SolidError::Level`], [`SolidError::Material`]; [`SolidError::Inverted`] for an element
    /// without positive volume; [`SolidError::Folded`] for a fully integrated element whose Jacobian is not
    /// positive at a Gauss point.
    pub fn new<'a>(
        mesh: &Mesh,
        materials: &[Material],
        elements: impl Into<Elements<'a>>,
        viscosity: Viscosity,
        level: Level,
    ) -> Result<Self, SolidError> {
        let elements = elements.into();
        if mesh.bodies.len() != materials.len() {
            return Err(SolidError::Count {
                bodies: mesh.bodies.len(),
                materials: materials.len(),
            });
        }
        if !level.available() {
            return Err(SolidError::Level(level.name()));
        }
        for (body, material) in mesh.bodies.iter().zip(materials) {
            material
                .checked()
                .map_err(|source| SolidError::Material { body: body.name.clone(), source })?;
            for element in body.hexes.clone() {
                let x = mesh.hexes[element].map(|n| mesh.at(n));
                let (volume, _) = crate::mean_gradient(&x);
                if volume.is_nan() || volume <= 0.0 {
                    let body = body.name.clone();
                    return Err(SolidError::Inverted { body, element, volume });
                }
                if elements.is_full(element) {
                    let points = gauss_points(&x).map(|point| point.volume * 8.0 / volume);
                    let jacobian = points.into_iter().fold(f64::INFINITY, f64::min);
                    if jacobian <= 0.0 {
                        let body = body.name.clone();
                        return Err(SolidError::Folded { body, element, jacobian });
                    }
                }
            }
        }
        let hourglass = elements.one_point().hourglass;
        let constants = |m: &Material, w: f64| Constants {
            lambda: m.lame() / w,
            shear: m.shear() / w,
            hourglass: hourglass * m.hourglass_modulus() / 192.0,
            kelvin_voigt: viscosity.kelvin_voigt,
            bulk_linear: viscosity.bulk_linear * m.density * m.c_p() / w,
            bulk_quadratic: viscosity.bulk_quadratic.powi(2) * m.density / w,
        };
        let constants = materials.iter().map(|m| [64.0, 512.0].map(|w| constants(m, w))).collect();
        let blocks = Blocks::new(mesh, &elements);
        let pieces = Pieces::new(&blocks, |_| true, |_| true);
        Ok(Self {
            reference: mesh.nodes.iter().map(|x| Padded::from(*x)).collect(),
            sums: vec![[0.0; 3]; pieces.all.len()],
            pieces,
            blocks,
            constants,
            one_point: elements.one_point(),
            volumetric: elements.volumetric(),
            level,
            viscous: viscosity.any(),
            bodies: mesh.bodies.iter().map(|b| b.hexes.clone()).zip(materials.to_vec()).collect(),
        })
    }

    /// Coefficient kappa of the hourglass stiffness of the one-point elements (dimensionless).
    pub fn hourglass(&self) -> f64 {
        self.one_point.hourglass
    }

    /// Kelvin–Voigt time of all elements (s).
    pub fn kelvin_voigt(&self) -> f64 {
        self.constants.first().map_or(0.0, |body| body[0].kelvin_voigt)
    }

    /// Reference coordinates of the nodes (m).
    pub fn reference(&self) -> &[Padded] {
        &self.reference
    }

    /// The instruction set in use.
    pub fn level(&self) -> Level {
        self.level
    }

    /// Floating-point operations of one evaluation of the internal force without energies; a
    /// multiply-addition is two, a division one.
    pub fn flops(&self) -> u64 {
        let of = |block: &Block| {
            let done = self.recorded(block.full).record(&self.constants[block.body][0]).work();
            u64::from(done.flops()) * block.elements as u64
        };
        self.blocks.blocks.iter().map(of).sum()
    }

    /// What is recorded of an element in a step without energies.
    fn recorded(&self, full: bool) -> Recorded {
        let full = full.then_some(self.volumetric);
        Recorded { full, viscous: self.viscous }
    }

    /// What a device needs to compute the internal force of all elements with the bits of [`Level::pinned`], whatever the level of
    /// this solid.
    ///
    /// # Panics
    /// With more than 178 million elements.
    pub fn on_device(&self) -> DeviceElements {
        let text = |body: usize, full: bool| {
            self.recorded(full).record(&self.constants[body][usize::from(full)]).to_string()
        };
        DeviceElements::new(&self.blocks, self.reference.len(), text)
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.bodies.last().map_or(0, |(range, _)| range.end)
    }

    /// Memory that the time loop reads here: nodes of the elements in batches, reference positions (bytes).
    pub fn bytes(&self) -> usize {
        self.blocks.batches.len() * size_of::<Batch>() + self.reference.len() * size_of::<Padded>()
    }

    /// Subtracts the internal force: `force -= f_int(u, v)` (N), with `displacement` u (m) and `velocity` v (m/s).
    ///
    /// Explicit time integration gives v at the last half step. All arrays hold one entry per node; `velocity` may be
    /// empty if there is no viscosity. Energies are summed if `energies`. The bits of the result do not depend on the
    /// number of threads.
    ///
    /// # Panics
    /// If an array is shorter than the number of nodes.
    pub fn subtract_internal_force(
        &mut self,
        displacement: &[Padded],
        velocity: &[Padded],
        force: &mut [Padded],
        energies: bool,
    ) -> ForceSums {
        self.subtract_internal_force_beside(displacement, velocity, force, energies, || ())
            .0
            .value()
    }

    /// As [`subtract_internal_force`](Self::subtract_internal_force), while one of the threads does the independent
    /// work `beside`; returns also its result.
    ///
    /// # Panics
    /// As [`subtract_internal_force`](Self::subtract_internal_force).
    pub fn subtract_internal_force_beside<R: Send>(
        &mut self,
        displacement: &[Padded],
        velocity: &[Padded],
        force: &mut [Padded],
        energies: bool,
        beside: impl FnOnce() -> R + Send,
    ) -> (ForceSums<ExactSum>, R) {
        self.run(displacement, velocity, force, energies, self.viscous, beside)
    }

    /// Subtracts the internal force without viscous stresses, for bodies at rest: `force -= f_int(u)` (N).
    ///
    /// # Panics
    /// As [`subtract_internal_force`](Self::subtract_internal_force).
    pub fn subtract_elastic_force(
        &mut self,
        displacement: &[Padded],
        force: &mut [Padded],
        energies: bool,
    ) -> ForceSums {
        self.run(displacement, &[], force, energies, false, || ()).0.value()
    }

    /// `y += K x` (N) with the stiffness K of the undeformed state. The product is the internal force at the
    /// displacements x (m), which must be so small that it is linear in them: about 1e-13 m in millimetre elements.
    ///
    /// # Panics
    /// If an array is shorter than the number of nodes.
    pub fn add_stiffness_product(&mut self, x: &[Padded], y: &mut [Padded]) {
        let negate = |y: &mut [Padded]| y.iter_mut().for_each(|y| *y = Padded(y.0.map(|c| -c)));
        negate(y);
        self.run(x, &[], y, false, false, || ());
        negate(y);
    }

    fn run<R: Send>(
        &mut self,
        displacement: &[Padded],
        velocity: &[Padded],
        force: &mut [Padded],
        energies: bool,
        viscous: bool,
        beside: impl FnOnce() -> R + Send,
    ) -> (ForceSums<ExactSum>, R) {
        let nodes = self.reference.len();
        assert!(displacement.len() >= nodes && force.len() >= nodes);
        assert!(!viscous || velocity.len() >= nodes);
        let kernels = [None, Some(self.volumetric)]
            .map(|full| block_force_of(self.level, full, energies, viscous));
        let arrays = Shared(Arrays {
            reference: self.reference.as_ptr(),
            displacement: displacement.as_ptr(),
            velocity: velocity.as_ptr(),
            force: force.as_mut_ptr(),
        });
        let sums = SharedSums(self.sums.as_mut_ptr());
        let Blocks { batches, blocks, colours, .. } = &self.blocks;
        let Pieces { all: pieces, of_block } = &self.pieces;
        let constants = &self.constants;
        let run = |&b: &u32| {
            let (arrays, sums) = (&arrays, &sums);
            let block: &Block = &blocks[b as usize];
            for p in of_block[b as usize].clone() {
                let piece = &pieces[p];
                // SAFETY: the level was checked in `new`; node indices were taken from the mesh whose
                // node count the asserts above compare; blocks of one colour share no nodes, colours
                // run one after the other, and each piece writes its own entry of `sums`.
                unsafe {
                    *sums.0.add(p) = kernels[usize::from(block.full)](
                        &batches[piece.batches.clone()],
                        piece.elements,
                        &constants[block.body][usize::from(block.full)],
                        arrays.0,
                    );
                }
            }
        };
        let done_beside = if rayon::current_num_threads() == 1 {
            colours.iter().flatten().for_each(run);
            beside()
        } else {
            let force = || colours.iter().for_each(|colour| colour.par_iter().for_each(run));
            rayon::join(force, beside).1
        };
        let counted = self.sums.iter().zip(pieces).filter(|(_, piece)| piece.counts);
        let sum = |i: usize, wanted: bool| {
            counted.clone().filter(|_| wanted).map(|(sums, _)| sums[i]).collect::<ExactSum>()
        };
        let sums = ForceSums {
            internal: sum(0, energies),
            hourglass: sum(1, energies),
            viscous_power: sum(2, viscous),
        };
        (sums, done_beside)
    }

    /// From now on computes the share of a process alone: all elements of the nodes that it `owns`, whose forces then have the
    /// bits of the whole, and energies of groups of elements whose first node it owns. The others' nodes, which its
    /// elements have besides, receive forces without meaning.
    pub fn take_share(&mut self, owns: impl Fn(u32) -> bool) {
        let needed = |batch: &Batch| batch.nodes.as_flattened().iter().any(|&n| owns(n));
        self.take(Pieces::new(&self.blocks, |batch| owns(batch.nodes[0][0]), needed));
    }

    /// Computes all elements again.
    pub fn take_all(&mut self) {
        self.take(Pieces::new(&self.blocks, |_| true, |_| true));
    }

    fn take(&mut self, pieces: Pieces) {
        self.sums = vec![[0.0; 3]; pieces.all.len()];
        self.pieces = pieces;
    }

    /// The nodes of the elements that are computed, some of them several times.
    pub fn nodes_of_share(&self) -> impl Iterator<Item = u32> + '_ {
        let batches = self.pieces.all.iter().flat_map(|piece| piece.batches.clone());
        batches.flat_map(|b| self.blocks.batches[b].nodes.as_flattened()).copied()
    }

    /// Number of elements that are computed, as the kernels count them: in whole batches.
    pub fn elements_of_share(&self) -> usize {
        self.pieces.all.iter().map(|piece| piece.elements).sum()
    }

    /// Writes the Cauchy stress of each element into `stress` (Pa): xx yy zz xy yz xz in the global axes, without
    /// viscous parts. For a fully integrated element it is the mean over the deformed volume.
    ///
    /// # Panics
    /// If there are fewer displacements than nodes or fewer stresses than elements.
    pub fn cauchy_stress(&self, displacement: &[Padded], stress: &mut [[f64; 6]]) {
        assert!(displacement.len() >= self.reference.len());
        for (body, (range, material)) in self.bodies.iter().enumerate() {
            stress[range.clone()].par_iter_mut().zip(range.clone()).for_each(|(out, element)| {
                let (batch, lane, full) = self.blocks.place(body, element);
                *out = if full {
                    let (x, u) = self.corners(displacement, body, element);
                    mean_cauchy(&x, &u, material, self.volumetric)
                } else {
                    one_point_cauchy(&self.reference, displacement, batch, lane, material)
                };
            });
        }
    }

    /// How an element of a body is integrated.
    fn formulation(&self, body: usize, element: usize) -> Formulation {
        if self.blocks.is_full(body, element) {
            Formulation::Full(self.volumetric)
        } else {
            Formulation::OnePoint(self.one_point)
        }
    }

    /// Corners of an element in the reference configuration and their displacements.
    fn corners(
        &self,
        displacement: &[Padded],
        body: usize,
        element: usize,
    ) -> ([Vector3<f64>; 8], [Vector3<f64>; 8]) {
        let hex = self.blocks.hex(body, element);
        let x = hex.map(|n| self.reference[n as usize].vector());
        (x, hex.map(|n| displacement[n as usize].vector()))
    }

    /// The element with the smallest det F (dimensionless), the index of its body, and that det F: of a one-point
    /// element that of the mean gradient, of a fully integrated one the smallest of its Gauss points. Below zero the
    /// element is inside out. The first NaN is returned at once.
    ///
    /// # Panics
    /// If there are fewer displacements than nodes.
    pub fn smallest_jacobian(&self, displacement: &[Padded]) -> (usize, usize, f64) {
        let mut worst = (0, 0, f64::INFINITY);
        for (body, (range, _)) in self.bodies.iter().enumerate() {
            for element in range.clone() {
                let (x, u) = self.corners(displacement, body, element);
                let det = if self.blocks.is_full(body, element) {
                    let points = gauss_points(&x);
                    let dets =
                        points.map(|p| deformation(&p.displacement_gradient(&u)).determinant());
                    dets.into_iter()
                        .fold(f64::INFINITY, |a, b| if b < a || b.is_nan() { b } else { a })
                } else {
                    deformation(&displacement_gradient(&x, &u).0).determinant()
                };
                if det < worst.2 || det.is_nan() {
                    worst = (element, body, det);
                    if det.is_nan() {
                        return worst;
                    }
                }
            }
        }
        worst
    }

    /// Centre of an element in the reference configuration (m): the mean of its corners.
    ///
    /// # Panics
    /// If there is no such element.
    pub fn centre(&self, element: usize) -> Vector3<f64> {
        let body = self.bodies.iter().position(|(range, _)| range.contains(&element));
        let corners = self.blocks.hex(body.unwrap_or(0), element);
        corners.iter().map(|&n| self.reference[n as usize].vector() / 8.0).sum()
    }
}

struct Shared(Arrays);
// SAFETY: threads write disjoint nodes (see `Solid::run`).
unsafe impl Sync for Shared {}
struct SharedSums(*mut Sums);
// SAFETY: threads write disjoint entries (see `Solid::run`).
unsafe impl Sync for SharedSums {}

macro_rules! level_kernels {
    ($name:ident, $lanes:ty $(, $features:literal)?) => {
        /// The kernel for this level and these options: of fully integrated elements with `full`, else of one-point
        /// elements.
        fn $name(full: Option<Volumetric>, energies: bool, viscous: bool) -> BlockForce {
            $(#[target_feature(enable = $features)])?
            unsafe fn run<K: Kernel, const ENERGY: bool, const VISCOUS: bool>(
                batches: &[Batch],
                elements: usize,
                constants: &Constants,
                arrays: Arrays,
            ) -> Sums {
                // SAFETY: the caller's contract is that of `block_force`.
                unsafe {
                    block_force::<K, $lanes, ENERGY, VISCOUS>(batches, elements, constants, arrays)
                }
            }
            fn choose<K: Kernel>(energies: bool, viscous: bool) -> BlockForce {
                match (energies, viscous) {
                    (false, false) => run::<K, false, false>,
                    (false, true) => run::<K, false, true>,
                    (true, false) => run::<K, true, false>,
                    (true, true) => run::<K, true, true>,
                }
            }
            match full {
                None => choose::<OnePoint>(energies, viscous),
                Some(Volumetric::Full) => choose::<FullyIntegrated<false>>(energies, viscous),
                Some(Volumetric::Mean) => choose::<FullyIntegrated<true>>(energies, viscous),
            }
        }
    };
}

#[cfg(target_arch = "x86_64")]
level_kernels!(avx512, x86::F64x8, "avx512f,avx2,fma");
#[cfg(target_arch = "x86_64")]
level_kernels!(avx2, x86::F64x4, "avx2,fma");
#[cfg(target_arch = "aarch64")]
level_kernels!(neon, neon::F64x2x2, "neon");
level_kernels!(fused, Four);
level_kernels!(portable, f64);

fn block_force_of(
    level: Level,
    full: Option<Volumetric>,
    energies: bool,
    viscous: bool,
) -> BlockForce {
    match level {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => avx512(full, energies, viscous),
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => avx2(full, energies, viscous),
        #[cfg(target_arch = "aarch64")]
        Level::Neon => neon(full, energies, viscous),
        Level::Fused => fused(full, energies, viscous),
        _ => portable(full, energies, viscous),
    }
}

mod diagonal;
mod shape;

pub use shape::ElementState;

#[cfg(test)]
mod tests;
