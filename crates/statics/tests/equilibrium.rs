//! Blocks in compression: closed forms, both enforcements, convergence, bits, failures.
#![allow(clippy::unwrap_used)]

use contact::{
    BodyMaterial, ExactSettings, GapFunction, Normals, PenaltyContact, PenaltySettings, Stiffness,
};
use friction::Coulomb;
use mesh::{Mesh, Padded};
use solid::{Element, Level, Material, Solid, Viscosity};
use statics::{
    Axis, Contact, Ending, Equilibrium, Iteration, LinearStatics, Problem, StaticsError, Supports,
    Tied, solve,
};

const YOUNG: f64 = 210e9;
const SIDE: f64 = 10e-3;
/// Without lateral contraction a block between rigid plates is in uniaxial stress.
const CORK: Material = Material { young: YOUNG, poisson: 0.0, density: 7800.0 };
const STEEL: Material = Material { young: YOUNG, poisson: 0.3, density: 7800.0 };

/// How the contact of a [`Rig`] is enforced.
#[derive(Clone, Copy, Debug)]
enum Enforcement {
    Penalty,
    Multipliers,
}

/// Force on a bar of unit area that is shortened by the engineering strain `e`
/// (St. Venant–Kirchhoff): (1 - e) E (e - e^2/2).
fn pressure(e: f64) -> f64 {
    (1.0 - e) * YOUNG * (e - 0.5 * e * e)
}

/// Engineering strain under a pressure, by bisection of [`pressure`].
fn shortening(p: f64) -> f64 {
    let (mut low, mut high) = (0.0, 0.2);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if pressure(middle) < p { low = middle } else { high = middle }
    }
    low
}

fn shifted(mut mesh: Mesh, by: [f64; 3], name: &str) -> Mesh {
    mesh.nodes.iter_mut().for_each(|x| (0..3).for_each(|i| x[i] += by[i]));
    mesh.bodies[0].name = name.into();
    mesh
}

/// The upper block of `fine` cells (body 0) on the lower one of `coarse` cells.
fn stack(fine: usize, coarse: usize) -> Mesh {
    let size = [SIDE; 3];
    mesh::join(&[
        shifted(mesh::block([fine; 3], size), [0.0, 0.0, SIDE], "upper"),
        shifted(mesh::block([coarse; 3], size), [0.0; 3], "lower"),
    ])
}

fn set(mesh: &Mesh, body: usize, name: &str) -> Vec<u32> {
    mesh.bodies[body].node_sets[name].clone()
}

/// The bottom of the last body held, the top of the first tied under `top` along z.
fn pressed(mesh: &Mesh, top: Axis) -> Supports {
    let last = mesh.bodies.len() - 1;
    let axes = [Axis::Moved(0.0), Axis::Moved(0.0), top];
    Supports {
        held: set(mesh, last, "z-"),
        tied: vec![Tied { nodes: set(mesh, 0, "z+"), axes }],
        ..Supports::default()
    }
}

struct Rig {
    mesh: Mesh,
    solid: Solid,
    contact: PenaltyContact,
    gaps: GapFunction,
}

impl Rig {
    fn new(mesh: Mesh, material: Material, factor: f64) -> Self {
        Self::with(mesh, material, Stiffness::Factor(factor))
    }

    fn with(mesh: Mesh, material: Material, stiffness: Stiffness) -> Self {
        let materials = vec![material; mesh.bodies.len()];
        let element = Element { hourglass: 0.05 };
        let solid =
            Solid::new(&mesh, &materials, element, Viscosity::default(), Level::detect()).unwrap();
        let settings = PenaltySettings {
            normal: stiffness,
            tangential: stiffness,
            damping: 0.0,
            curvature: true,
            normals: Normals::Averaged,
        };
        let behind = BodyMaterial { bulk_modulus: material.bulk(), density: material.density };
        let sides =
            [(&mesh.bodies[0].surfaces["z-"], behind), (&mesh.bodies[1].surfaces["z+"], behind)];
        let law = Box::new(Coulomb { mu: 0.0 });
        let contact = PenaltyContact::new(&mesh, sides, &settings, None, law).unwrap();
        let exact = ExactSettings { slave: Some(0), curvature: true, ..ExactSettings::default() };
        let gaps = GapFunction::new(&mesh, sides, &exact).unwrap();
        Self { mesh, solid, contact, gaps }
    }

    fn solve(
        &mut self,
        supports: &Supports,
        enforcement: Enforcement,
        depth: f64,
        observe: impl FnMut(&Iteration) -> bool,
    ) -> Result<Equilibrium, StaticsError> {
        let problem = Problem {
            mesh: &self.mesh,
            supports,
            spin: None,
            tolerance: 1e-10,
            max_iterations: 40,
        };
        let mut start = vec![Padded::ZERO; self.mesh.nodes.len()];
        start[self.mesh.bodies[0].nodes.clone()].iter_mut().for_each(|u| u[2] = -depth);
        let contact = match enforcement {
            Enforcement::Penalty => Contact::Penalty(&mut self.contact),
            Enforcement::Multipliers => Contact::Multipliers(&mut self.gaps),
        };
        solve(&mut self.solid, contact, &problem, &start, observe)
    }

    /// Displacement of the top.
    fn top(&self, found: &Equilibrium) -> f64 {
        found.displacement[set(&self.mesh, 0, "z+")[0] as usize][2]
    }
}

fn alone(material: Material) -> (Mesh, Solid) {
    let mesh = mesh::block([4, 5, 6], [SIDE; 3]);
    let element = Element { hourglass: 0.05 };
    let solid =
        Solid::new(&mesh, &[material], element, Viscosity::default(), Level::detect()).unwrap();
    (mesh, solid)
}

fn solve_alone(
    mesh: &Mesh,
    solid: &mut Solid,
    supports: &Supports,
    observe: impl FnMut(&Iteration) -> bool,
) -> Result<Equilibrium, StaticsError> {
    let problem = Problem { mesh, supports, spin: None, tolerance: 1e-12, max_iterations: 40 };
    solve(solid, Contact::None, &problem, &vec![Padded::ZERO; mesh.nodes.len()], observe)
}

#[test]
fn a_block_under_load_shortens_as_the_material_law_says() {
    let (mesh, mut solid) = alone(CORK);
    let strain = 0.01;
    let load = pressure(strain) * SIDE * SIDE;
    let supports = pressed(&mesh, Axis::Loaded(-load));
    let found = solve_alone(&mesh, &mut solid, &supports, |_| true).unwrap();
    for (u, x) in found.displacement.iter().zip(&mesh.nodes) {
        assert!(u[0].abs() + u[1].abs() < 1e-12 * SIDE, "{u:?}");
        assert!((u[2] + strain * x[2]).abs() < 1e-11 * SIDE, "{u:?} {x:?}");
    }
    let reaction: f64 = supports.held.iter().map(|&n| found.force[n as usize][2]).sum();
    assert!((reaction / load + 1.0).abs() < 1e-11, "{reaction}");
    let energy = 0.5 * YOUNG * (strain - 0.5 * strain * strain).powi(2) * SIDE.powi(3);
    assert!((found.report.internal / energy - 1.0).abs() < 1e-10, "{}", found.report.internal);
}

#[test]
fn a_given_displacement_gives_the_force_of_the_material_law() {
    let (mesh, mut solid) = alone(CORK);
    let supports = pressed(&mesh, Axis::Moved(-0.01 * SIDE));
    let found = solve_alone(&mesh, &mut solid, &supports, |_| true).unwrap();
    let force: f64 = supports.held.iter().map(|&n| found.force[n as usize][2]).sum();
    assert!((force / (pressure(0.01) * SIDE * SIDE) + 1.0).abs() < 1e-10, "{force}");
}

#[test]
fn newton_gains_two_digits_per_step_at_one_per_cent_of_strain() {
    let (mesh, mut solid) = alone(STEEL);
    let supports = pressed(&mesh, Axis::Loaded(-0.01 * YOUNG * SIDE * SIDE));
    let mut residuals = Vec::new();
    solve_alone(&mesh, &mut solid, &supports, |now| {
        residuals.push(now.residual);
        true
    })
    .unwrap();
    // The first step is linear to a tenth only, so that it costs little; then the forcing terms and
    // the tangent of the undeformed state, off by a few times the strain, set the pace.
    assert!(residuals.len() <= 9, "{residuals:?}");
    let rates: Vec<f64> = residuals.windows(2).skip(1).map(|w| w[1] / w[0]).collect();
    assert!(rates.iter().all(|rate| *rate < 0.05), "{residuals:?}");
}

#[test]
fn stacked_blocks_carry_the_load_exactly_and_evenly() {
    for (fine, coarse) in [(4, 3), (3, 4), (4, 4)] {
        let mut rig = Rig::new(stack(fine, coarse), CORK, 1.0);
        let p = 0.5e9;
        let supports = pressed(&rig.mesh, Axis::Loaded(-p * SIDE * SIDE));
        let found = rig.solve(&supports, Enforcement::Multipliers, 0.0, |_| true).unwrap();
        let top = rig.top(&found);
        // The load passes from node to face as it does from face to face only where the meshes
        // match: else the lower block is loaded by node forces.
        if fine == coarse {
            let e = shortening(p);
            assert!((top / (-2.0 * e * SIDE) - 1.0).abs() < 1e-9, "{top}");
            for (gap, force) in &found.pressed {
                assert!((force / gap.area / p - 1.0).abs() < 1e-8, "{force}");
            }
        }
        assert_eq!(found.pressed.len(), (fine + 1) * (fine + 1));
        assert!(found.pressed.iter().all(|(gap, f)| gap.gap.abs() < 1e-12 && *f >= 0.0));
        let total: f64 = found.pressed.iter().map(|(gap, f)| f * gap.normal[2]).sum();
        assert!((total / (p * SIDE * SIDE) - 1.0).abs() < 1e-9, "{total}");
    }
}

#[test]
fn penalty_approaches_the_exact_solution_as_one_over_its_stiffness() {
    let p = 0.5e9;
    let error = |factor: f64| {
        let mut rig = Rig::new(stack(4, 4), CORK, factor);
        let supports = pressed(&rig.mesh, Axis::Loaded(-p * SIDE * SIDE));
        let found = rig.solve(&supports, Enforcement::Penalty, 1e-6, |_| true).unwrap();
        assert_eq!(found.report.facets, 0.0);
        -rig.top(&found) - 2.0 * shortening(p) * SIDE
    };
    let errors = [1.0, 10.0, 100.0].map(error);
    // Two passes of areal stiffness SF K/d each.
    let depth = SIDE / 4.0;
    let expected = p / (2.0 * CORK.bulk() / depth);
    assert!((errors[0] / expected - 1.0).abs() < 0.01, "{errors:?} {expected}");
    assert!((errors[0] / errors[1] - 10.0).abs() < 0.2, "{errors:?}");
    assert!((errors[1] / errors[2] - 10.0).abs() < 0.2, "{errors:?}");
}

/// A block whose lower face is bent down in the middle: contact over a part of it only.
fn dome(cells: usize) -> Mesh {
    let mut mesh = stack(cells, cells);
    let upper = mesh.bodies[0].nodes.clone();
    for x in &mut mesh.nodes[upper] {
        let [a, b] = [0, 1].map(|i: usize| x[i] - 0.5 * SIDE);
        let lift = (a * a + b * b) / (2.0 * 0.1) * (2.0 - x[2] / SIDE);
        x[2] += lift;
    }
    mesh
}

#[test]
fn a_dome_presses_where_it_touches_and_nowhere_else() {
    let mut rig = Rig::new(dome(8), STEEL, 1.0);
    let load = 2e3;
    let supports = pressed(&rig.mesh, Axis::Loaded(-load));
    for depth in [0.0, 5e-6, 50e-6] {
        let mut closed = Vec::new();
        let found = rig
            .solve(&supports, Enforcement::Multipliers, depth, |now| {
                closed.push(now.closed);
                true
            })
            .unwrap();
        assert_eq!(found.report.ending, Ending::Tolerance, "{:?}", found.report);
        let count = found.pressed.len();
        assert!((5..60).contains(&count), "{count}");
        assert!(found.pressed.iter().all(|(_, force)| *force >= 0.0));
        let mut gaps = Vec::new();
        let reference: Vec<Padded> = rig.mesh.nodes.iter().copied().map(Padded::from).collect();
        rig.gaps.at(&reference, &found.displacement, &mut gaps);
        let pressed: Vec<u32> = found.pressed.iter().map(|(gap, _)| gap.node).collect();
        for gap in &gaps {
            let touches = pressed.contains(&gap.node);
            assert!(if touches { gap.gap.abs() < 1e-12 } else { gap.gap > -1e-12 }, "{gap:?}");
        }
        let total: f64 = found.pressed.iter().map(|(gap, f)| f * gap.normal[2]).sum();
        assert!((total / load - 1.0).abs() < 1e-9, "{total}");
        assert!(found.report.last.iteration < 15, "{closed:?}");
    }
}

#[test]
fn the_start_does_not_change_the_equilibrium() {
    // Nodes that stand over the middle of faces, and one stiffness everywhere: over an edge, where
    // two faces of a dented surface meet at an angle, the penalty's node stays on the face on which
    // it closed, and a spring keeps that face's stiffness. Both make its equilibrium depend on the
    // path, by 1e-5 on matched meshes with a scale factor.
    let mut mesh = dome(8);
    let upper = mesh.bodies[0].nodes.clone();
    let cell = SIDE / 8.0;
    for x in &mut mesh.nodes[upper] {
        x[0] += 0.4 * cell;
        x[1] += 0.3 * cell;
    }
    let mut rig = Rig::with(mesh, STEEL, Stiffness::Areal(3.5e14));
    let supports = pressed(&rig.mesh, Axis::Loaded(-2e3));
    for enforcement in [Enforcement::Penalty, Enforcement::Multipliers] {
        // Apart by 0.1 mm, just touching, and pressed in far too deep.
        let tops = [-100e-6, 0.0, 200e-6].map(|depth| {
            let found = rig.solve(&supports, enforcement, depth, |_| true).unwrap();
            assert_eq!(found.report.facets, 0.0);
            rig.top(&found)
        });
        for top in tops {
            assert!((top / tops[0] - 1.0).abs() < 1e-8, "{enforcement:?} {tops:?}");
        }
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let solve_with = |threads: usize, enforcement: Enforcement| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            // More than one chunk of nodes and several clusters.
            let mut rig = Rig::new(dome(14), STEEL, 1.0);
            assert!(rig.mesh.nodes.len() > 4096);
            let supports = pressed(&rig.mesh, Axis::Loaded(-2e3));
            let found = rig.solve(&supports, enforcement, 5e-6, |_| true).unwrap();
            found.displacement
        })
    };
    for enforcement in [Enforcement::Penalty, Enforcement::Multipliers] {
        let bits = |u: Vec<Padded>| u.iter().map(|u| u.0.map(f64::to_bits)).collect::<Vec<_>>();
        let one = bits(solve_with(1, enforcement));
        for threads in [2, 3, 4, 7] {
            assert!(one == bits(solve_with(threads, enforcement)), "{enforcement:?}, {threads}");
        }
    }
}

#[test]
fn a_body_that_nothing_holds_is_named() {
    let mut rig = Rig::new(stack(2, 2), STEEL, 1.0);
    let supports =
        Supports { held: set(&rig.mesh, 1, "z-"), tied: Vec::new(), ..Supports::default() };
    let error = rig.solve(&supports, Enforcement::Penalty, 0.0, |_| true).unwrap_err();
    assert!(matches!(&error, StaticsError::Floating { body, .. } if body == "upper"), "{error}");
}

#[test]
fn a_load_that_pulls_the_bodies_apart_is_refused() {
    for enforcement in [Enforcement::Penalty, Enforcement::Multipliers] {
        let mut rig = Rig::new(stack(2, 2), STEEL, 1.0);
        for load in [1e3, 0.0] {
            let supports = pressed(&rig.mesh, Axis::Loaded(load));
            let error = rig.solve(&supports, enforcement, 1e-6, |_| true).unwrap_err();
            let named =
                matches!(&error, StaticsError::Open { body, axis: 'z', .. } if body == "upper");
            assert!(named, "{enforcement:?} {load}: {error}");
        }
    }
}

#[test]
fn a_sideways_load_that_nothing_takes_up_is_refused() {
    let mut rig = Rig::new(stack(2, 2), STEEL, 1.0);
    let axes = [Axis::Loaded(10.0), Axis::Moved(0.0), Axis::Loaded(-1e3)];
    let tied = Tied { nodes: set(&rig.mesh, 0, "z+"), axes };
    let supports =
        Supports { held: set(&rig.mesh, 1, "z-"), tied: vec![tied], ..Supports::default() };
    let error = rig.solve(&supports, Enforcement::Penalty, 1e-6, |_| true).unwrap_err();
    assert!(matches!(&error, StaticsError::Open { axis: 'x', .. }), "{error}");
}

#[test]
fn an_absurd_load_names_an_element_or_says_that_nothing_converges() {
    let mut rig = Rig::new(stack(3, 3), STEEL, 1.0);
    let supports = pressed(&rig.mesh, Axis::Loaded(-10.0 * YOUNG * SIDE * SIDE));
    let error = rig.solve(&supports, Enforcement::Penalty, 1e-6, |_| true).unwrap_err();
    assert!(matches!(&error, StaticsError::Inverted { .. }), "{error}");
    assert!(error.to_string().contains("element"), "{error}");
}

#[test]
fn too_few_iterations_say_where_the_residual_is_largest() {
    let (mesh, mut solid) = alone(STEEL);
    let supports = pressed(&mesh, Axis::Loaded(-0.01 * YOUNG * SIDE * SIDE));
    let problem = Problem {
        mesh: &mesh,
        supports: &supports,
        spin: None,
        tolerance: 1e-12,
        max_iterations: 2,
    };
    let start = vec![Padded::ZERO; mesh.nodes.len()];
    let error = solve(&mut solid, Contact::None, &problem, &start, |_| true).unwrap_err();
    assert!(matches!(&error, StaticsError::Slow { at, .. } if at.iteration == 2), "{error}");
    assert!(error.to_string().contains("body 'block'"), "{error}");
}

#[test]
fn supports_that_contradict_each_other_are_refused() {
    let (mesh, mut solid) = alone(STEEL);
    let refused = |supports: Supports| {
        solve_alone(&mesh, &mut alone(STEEL).1, &supports, |_| true).unwrap_err()
    };
    let good = pressed(&mesh, Axis::Loaded(-1.0));
    let mut twice = good.clone();
    twice.tied.push(twice.tied[0].clone());
    assert!(matches!(refused(twice), StaticsError::TwiceSupported { .. }));
    let mut outside = good.clone();
    outside.held.push(1_000_000);
    assert_eq!(refused(outside), StaticsError::NoSuchNode { node: 1_000_000 });
    let mut nothing = good.clone();
    nothing.tied[0].nodes.clear();
    assert_eq!(refused(nothing), StaticsError::EmptyGroup);
    let mut endless = good.clone();
    endless.tied[0].axes[2] = Axis::Loaded(f64::NAN);
    assert!(matches!(refused(endless), StaticsError::NotANumber { .. }));
    assert!(solve_alone(&mesh, &mut solid, &good, |_| true).is_ok());
    let stopped = solve_alone(&mesh, &mut solid, &good, |_| false).unwrap_err();
    assert_eq!(stopped, StaticsError::Interrupted);
}

#[test]
fn a_clamped_block_under_two_pulls_stretches_as_hooke_says_under_each() {
    let (mesh, mut solid) = alone(CORK);
    let supports = Supports { held: set(&mesh, 0, "z-"), ..Supports::default() };
    let problem = Problem {
        mesh: &mesh,
        supports: &supports,
        spin: None,
        tolerance: 1e-10,
        max_iterations: 1,
    };
    let mut statics = LinearStatics::new(&mut solid, &problem).unwrap();
    for traction in [1e6, -3e6] {
        let mut force = vec![Padded::ZERO; mesh.nodes.len()];
        for face in &mesh.bodies[0].surfaces["z+"].faces {
            let areas = mesh::quad_corner_areas(&face.nodes.map(|n| mesh.at(n)));
            for (&n, area) in face.nodes.iter().zip(areas) {
                force[n as usize][2] += traction * area;
            }
        }
        let found = statics.displacement(&force).unwrap();
        let largest = traction.abs() * SIDE / YOUNG;
        for (x, u) in mesh.nodes.iter().zip(&found) {
            let expected = [0.0, 0.0, traction * x[2] / YOUNG];
            for i in 0..3 {
                assert!((u[i] - expected[i]).abs() < 1e-8 * largest, "{x:?}: {u:?}");
            }
        }
    }
}
