//! A free block of hexahedra without contact: the problem that other codes are timed on.

use super::median;
use crate::run::error::RunError;
use crate::scenario::ScenarioError;
use dynamics::{Setup, Simulation, System};
use mesh::Padded;
use serde::Serialize;
use solid::{Element, Elements, Level, Material, Solid, Viscosity, Volumetric};
use std::str::FromStr;

const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7800.0 };
/// Edge of an element (m) and time step (s).
const EDGE: f64 = 1e-3;
const DT: f64 = 1e-7;
/// Steps after which the corner's displacement is compared, as in `verify free-block`.
const COMPARED: usize = 20;

/// Which element the block is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BlockElement {
    /// One point with hourglass stiffness, as in rolling.
    #[default]
    OnePoint,
    /// Eight points, as the elements of general codes.
    Full,
}

impl BlockElement {
    /// `"one-point"` or `"full"`.
    pub fn name(self) -> &'static str {
        match self {
            Self::OnePoint => "one-point",
            Self::Full => "full",
        }
    }
}

impl FromStr for BlockElement {
    type Err = &'static str;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        let all = [Self::OnePoint, Self::Full];
        let found = all.into_iter().find(|element| element.name() == name);
        found.ok_or("one of one-point, full is needed")
    }
}

/// Speed on a free block.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct BlockBench {
    /// Elements along an edge.
    pub block: usize,
    /// Which element.
    pub element: &'static str,
    /// Threads used.
    pub threads: usize,
    /// The instructions that the kernels used.
    pub kernels: &'static str,
    /// Number of elements.
    pub elements: usize,
    /// u_z of the last node (m), to compare with other codes.
    pub corner_after_20_steps: f64,
    /// Whole step (ns).
    pub step_ns_per_element: f64,
}

/// Measures whole steps of a free block of `n`^3 elements of 1 mm that starts with v_z = -z/L (m/s), where L is its
/// edge, with so many `threads` and these `kernels` (by default the machine's best).
///
/// # Errors
/// Kernels that this machine cannot run; threads that cannot be started.
///
/// # Panics
/// If `n` is 0.
pub fn bench_block(
    n: usize,
    element: BlockElement,
    threads: usize,
    kernels: Option<Level>,
) -> Result<BlockBench, RunError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let level = kernels.unwrap_or_else(Level::detect);
    pool.install(|| {
        let mut simulation = block(n, element, level)?;
        (0..COMPARED).for_each(|_| {
            simulation.step(false);
        });
        let corner = simulation.displacement().last().map_or(f64::NAN, |u| u.0[2]);
        let elements = n.pow(3);
        let repeats = (2_000_000 / elements).max(1);
        let seconds = median(|| {
            (0..repeats).for_each(|_| {
                simulation.step(false);
            });
        });
        Ok(BlockBench {
            block: n,
            element: element.name(),
            threads,
            kernels: level.name(),
            elements,
            corner_after_20_steps: corner,
            step_ns_per_element: seconds / repeats as f64 / elements as f64 * 1e9,
        })
    })
}

fn block(n: usize, element: BlockElement, level: Level) -> Result<Simulation, RunError> {
    let size = n as f64 * EDGE;
    let mesh = mesh::block([n; 3], [size; 3]);
    let elements: Elements = match element {
        BlockElement::OnePoint => Element { hourglass: 0.05 }.into(),
        BlockElement::Full => Volumetric::Full.into(),
    };
    let solid = Solid::new(&mesh, &[STEEL], elements, Viscosity::default(), level)
        .map_err(ScenarioError::from)?;
    let nodes = mesh.nodes.len();
    Ok(Simulation::new(Setup {
        system: System::free(solid, solid::lumped_mass(&mesh, &[STEEL.density])),
        displacement: vec![Padded::ZERO; nodes],
        velocity: mesh.nodes.iter().map(|x| Padded::new([0.0, 0.0, -x[2] / size])).collect(),
        dt: DT,
        dt_limit: DT,
    }))
}
