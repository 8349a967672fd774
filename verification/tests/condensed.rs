//! The condensed compliance against what it must equal.
#![allow(clippy::unwrap_used)]

use mesh::{Mesh, Padded, graded_block, graded_line};
use nalgebra::Vector3;
use solid::{Element, Level, Material, Solid, Viscosity, element_stiffness};
use statics::{Axis, Supports, Tied};
use verification::reference::{
    Block, Influence, InfluenceError, Lateral, Point, Press, SparseError, StiffnessMatrix,
    SurfaceCompliance, Symbolic, Unknowns, press,
};

const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7850.0 };
const ELEMENT: Element = Element { hourglass: 0.05 };

fn element(x: &[Vector3<f64>; 8], m: &Material) -> [[f64; 24]; 24] {
    element_stiffness(x, m, ELEMENT)
}

fn clamped(n: usize) -> (Mesh, Supports) {
    let mesh = mesh::block([n, n - 1, n - 2], [0.02, 0.015, 0.01]);
    let supports = Supports { held: mesh.bodies[0].node_sets["z-"].clone(), ..Supports::default() };
    (mesh, supports)
}

#[test]
fn the_solution_balances_the_load_in_the_kernel_of_the_dynamic_stage() {
    let (mesh, supports) = clamped(9);
    let unknowns = Unknowns::new(&mesh, &supports, &[]).unwrap();
    let stiffness = StiffnessMatrix::assemble(&mesh, &[STEEL], &element, &unknowns).unwrap();
    let symbolic = Symbolic::new(&stiffness).unwrap();
    let factor = symbolic.factor(&stiffness, &unknowns).unwrap();
    // Loads so small that the kernel, which is not linear, is linear to round-off.
    let loads: Vec<f64> = (0..2 * unknowns.count()).map(|i| 1e-4 * libm::sin(i as f64)).collect();
    let mut solutions = loads.clone();
    factor.solve(&mut solutions, 2).unwrap();
    let mut solid =
        Solid::new(&mesh, &[STEEL], ELEMENT, Viscosity::default(), Level::Portable).unwrap();
    for (u, f) in solutions.chunks(unknowns.count()).zip(loads.chunks(unknowns.count())) {
        let mut displacement = vec![Padded::ZERO; mesh.nodes.len()];
        for (node, d) in displacement.iter_mut().enumerate() {
            for axis in 0..3 {
                d[axis] = unknowns.of(node, axis).map_or(0.0, |dof| u[dof]);
            }
        }
        let mut force = vec![Padded::ZERO; mesh.nodes.len()];
        solid.add_stiffness_product(&displacement, &mut force);
        for (node, force) in force.iter().enumerate() {
            for axis in 0..3 {
                if let Some(dof) = unknowns.of(node, axis) {
                    assert!((force[axis] - f[dof]).abs() < 1e-4 * 1e-7, "{node} {axis}");
                }
            }
        }
    }
}

#[test]
fn one_analysis_serves_matrices_of_the_same_pattern() {
    let (mesh, supports) = clamped(6);
    let unknowns = Unknowns::new(&mesh, &supports, &[]).unwrap();
    let soft = Material { young: 70e9, ..STEEL };
    let [a, b] =
        [STEEL, soft].map(|m| StiffnessMatrix::assemble(&mesh, &[m], &element, &unknowns).unwrap());
    let symbolic = Symbolic::new(&a).unwrap();
    let solve = |k: &StiffnessMatrix| {
        let mut x = vec![1.0; unknowns.count()];
        symbolic.factor(k, &unknowns).unwrap().solve(&mut x, 1).unwrap();
        x
    };
    for (x, y) in solve(&a).iter().zip(solve(&b)) {
        assert!((3.0 * x - y).abs() < 1e-10 * y.abs().max(1e-12));
    }
}

#[test]
fn the_condensed_compliance_is_the_block_of_the_inverse() {
    let (mesh, supports) = clamped(8);
    let nodes: Vec<u32> = mesh.bodies[0].node_sets["z+"].iter().copied().step_by(3).collect();
    let compliance = SurfaceCompliance::new(&mesh, &[STEEL], &element, &supports, &nodes).unwrap();
    let unknowns = Unknowns::new(&mesh, &supports, &[]).unwrap();
    let stiffness = StiffnessMatrix::assemble(&mesh, &[STEEL], &element, &unknowns).unwrap();
    let symbolic = Symbolic::new(&stiffness).unwrap();
    let factor = symbolic.factor(&stiffness, &unknowns).unwrap();
    let scale = compliance.block(0, 0)[2][2];
    for (j, &node) in nodes.iter().enumerate().step_by(5) {
        for axis in 0..3 {
            let mut x = vec![0.0; unknowns.count()];
            x[unknowns.of(node as usize, axis).unwrap()] = 1.0;
            factor.solve(&mut x, 1).unwrap();
            for (i, &other) in nodes.iter().enumerate() {
                for b in 0..3 {
                    let full = x[unknowns.of(other as usize, b).unwrap()];
                    let condensed = compliance.block(i, j)[b][axis];
                    assert!((full - condensed).abs() < 1e-11 * scale, "{i} {j}");
                }
            }
        }
    }
}

#[test]
fn a_tied_group_moves_as_one_under_the_force_on_the_group() {
    let (mesh, mut supports) = clamped(6);
    let top = mesh.bodies[0].node_sets["z+"].clone();
    let axes = [Axis::Moved(0.0), Axis::Moved(0.0), Axis::Loaded(0.0)];
    supports.tied.push(Tied { nodes: top.clone(), axes });
    let confined: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
    let free = |n: &&u32| !top.contains(n) && !supports.held.contains(n);
    let inner: Vec<u32> = confined.iter().filter(free).copied().collect();
    for node in inner {
        supports.tied.push(Tied { nodes: vec![node], axes });
    }
    let c = SurfaceCompliance::new(&mesh, &[STEEL], &element, &supports, &top[..1]).unwrap();
    // A confined column: u = F h/((lambda + 2G) A).
    let column = 0.01 / (STEEL.p_modulus() * 0.02 * 0.015);
    assert!((c.block(0, 0)[2][2] / column - 1.0).abs() < 1e-12);
    assert_eq!(c.block(0, 0)[0][0], 0.0);
}

#[test]
fn a_body_that_floats_is_named() {
    let (mesh, _) = clamped(5);
    let top = &mesh.bodies[0].node_sets["z+"];
    let axes = [Axis::Moved(0.0), Axis::Moved(0.0), Axis::Loaded(-1.0)];
    let loose = Supports {
        held: Vec::new(),
        tied: vec![Tied { nodes: top.clone(), axes }],
        ..Supports::default()
    };
    let fault = SurfaceCompliance::new(&mesh, &[STEEL], &element, &loose, &top[..1]).err();
    assert!(matches!(fault, Some(SparseError::NotPositive { .. })), "{fault:?}");
    // Of two bodies the one that floats is named.
    let (block, supports) = clamped(5);
    let mut other = block.clone();
    other.nodes.iter_mut().for_each(|x| x[0] += 0.1);
    let both = mesh::join(&[block, other]);
    for last in [vec![], supports.held.clone(), vec![both.nodes.len() as u32 - 1]] {
        let unknowns = Unknowns::new(&both, &supports, &last).unwrap();
        let stiffness = StiffnessMatrix::assemble(&both, &[STEEL; 2], &element, &unknowns).unwrap();
        match Symbolic::new(&stiffness).unwrap().factor(&stiffness, &unknowns).err() {
            Some(SparseError::NotPositive { node, .. }) => {
                assert!(both.bodies[1].nodes.contains(&node), "{node}");
            }
            fault => panic!("{fault:?}"),
        }
    }
    let twice = Supports { held: vec![3, 3], ..Supports::default() };
    assert!(matches!(
        Unknowns::new(&mesh, &twice, &[]).err(),
        Some(SparseError::Twice { node: 3 })
    ));
    let outside = Supports { held: vec![9999], ..Supports::default() };
    assert!(matches!(Unknowns::new(&mesh, &outside, &[]).err(), Some(SparseError::Node { .. })));
}

#[test]
fn two_equal_blocks_have_the_influence_of_one_on_its_mirror_image() {
    let h = 1e-3;
    let block = Block {
        size: h,
        reach: [3.0 * h, 2.0 * h],
        depth: 2.0 * h,
        extent: 0.02,
        growth: 1.6,
        lateral: Lateral::Full,
        material: STEEL,
    };
    let gap = |x: f64, y: f64| (x * x + y * y) / 0.2;
    let mirrored = block.influence(&element, gap).unwrap();

    let lower = block.mesh().unwrap();
    let line = |fine: f64| graded_line([-0.02, 0.02], [-fine, fine], h, 1.6, 0.005).unwrap();
    let zs: Vec<f64> = graded_line([-0.02, 0.0], [-2.0 * h, 0.0], h, 1.6, 0.005)
        .unwrap()
        .iter()
        .rev()
        .map(|z| -z)
        .collect();
    let upper = graded_block([&line(3.0 * h), &line(2.0 * h), &zs]).unwrap();
    let compliance = |mesh: &Mesh, free: &str, points: &[Point]| {
        let sets = &mesh.bodies[0].node_sets;
        let sides = ["x-", "x+", "y-", "y+", "z-", "z+"].into_iter().filter(|s| *s != free);
        let mut held: Vec<u32> = sides.flat_map(|s| sets[s].clone()).collect();
        held.sort_unstable();
        held.dedup();
        let nodes: Vec<u32> = points.iter().map(|p| p.node).collect();
        let supports = Supports { held, ..Supports::default() };
        SurfaceCompliance::new(mesh, &[STEEL], &element, &supports, &nodes).unwrap()
    };
    let within = |at: Vector3<f64>| at.x.abs() < 3.1 * h && at.y.abs() < 2.1 * h;
    let points = |mesh: &Mesh, face: &str| {
        let surface = &mesh.bodies[0].surfaces[face];
        Point::on_surface(mesh, surface, within, |at| gap(at.x, at.y))
    };
    let [above, below] = [points(&upper, "z-"), points(&lower, "z+")];
    let pair = Influence::between(
        &compliance(&upper, "z-", &above),
        above.clone(),
        &compliance(&lower, "z+", &below),
        &lower.bodies[0].surfaces["z+"],
        &lower,
    )
    .unwrap();
    let scale = mirrored.normal(0, 0);
    for i in 0..above.len() {
        assert_eq!(above[i].at.xy(), below[i].at.xy());
        for j in 0..above.len() {
            assert!((pair.normal(i, j) - mirrored.normal(i, j)).abs() < 1e-10 * scale);
            let (p, m) = (pair.shear(i, j), mirrored.shear(i, j));
            for k in 0..4 {
                assert!((p[k / 2][k % 2] - m[k / 2][k % 2]).abs() < 1e-10 * scale);
            }
        }
    }
}

#[test]
fn contact_conditions_hold_to_round_off_and_load_and_approach_are_inverse() {
    let h = 0.5e-3;
    let block = Block {
        size: h,
        reach: [2.5e-3, 2.5e-3],
        depth: 1e-3,
        extent: 0.02,
        growth: 1.6,
        lateral: Lateral::Symmetric,
        material: STEEL,
    };
    let influence = block.influence(&element, |x, y| (x * x + y * y) / 0.2).unwrap();
    let pressed = press(&influence, Press::Load(5e3), None).unwrap();
    assert!((pressed.load() / 5e3 - 1.0).abs() < 1e-12);
    let most = pressed.force.iter().fold(0.0f64, |m, f| m.max(*f));
    for (gap, force) in pressed.gap.iter().zip(&pressed.force) {
        assert!(*force >= 0.0 && *gap > -1e-12 * pressed.approach);
        assert!(gap * force <= 1e-12 * most * pressed.approach);
    }
    let again = press(&influence, Press::Approach(pressed.approach), None).unwrap();
    assert_eq!(again.contact, pressed.contact);
    assert!((again.load() / 5e3 - 1.0).abs() < 1e-12);
    assert!(press(&influence, Press::Load(-1.0), None).is_err());
    assert!(press(&influence, Press::Approach(-1e-6), None).is_err());
}

#[test]
fn points_without_a_face_before_them_and_foreign_points_are_refused() {
    let (mesh, supports) = clamped(6);
    let top = &mesh.bodies[0].surfaces["z+"];
    let points = Point::on_surface(&mesh, top, |_| true, |_| 0.0);
    let nodes: Vec<u32> = points.iter().map(|p| p.node).collect();
    let compliance = SurfaceCompliance::new(&mesh, &[STEEL], &element, &supports, &nodes).unwrap();
    let between =
        |points: Vec<Point>| Influence::between(&compliance, points, &compliance, top, &mesh).err();
    let mut beside = points.clone();
    beside[0].at[0] -= 1.0;
    assert!(matches!(between(beside), Some(InfluenceError::NoFace { .. })));
    let foreign = Point { node: supports.held[0], ..points[0] };
    assert_eq!(between(vec![foreign]), Some(InfluenceError::Unknown { node: foreign.node }));
    assert_eq!(between(Vec::new()), Some(InfluenceError::Empty));
}
