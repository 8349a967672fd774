//! What a device is given, computed here: statement by statement, and node by node.
#![allow(clippy::unwrap_used, missing_docs)]

use mesh::{Padded, block, join};
use solid::{DeviceElements, Element, Elements, Level, Material, Solid, Viscosity, Volumetric};

const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7800.0 };
const ALUMINIUM: Material = Material { young: 70e9, poisson: 0.33, density: 2700.0 };

/// The result `f[24]` of the statements in `text` at the nodes `n`.
fn force(text: &str, n: [u32; 8], arrays: &[(&str, &[Padded]); 3]) -> [f64; 24] {
    let (mut t, mut f): (Vec<f64>, _) = (Vec::new(), [0.0; 24]);
    let inside = |term: &str, left: char, right: char| -> usize {
        let (_, rest) = term.split_once(left).unwrap();
        rest.split_once(right).unwrap().0.parse().unwrap()
    };
    for statement in text.lines() {
        let (name, right) = statement.trim().strip_suffix(';').unwrap().split_once(" = ").unwrap();
        let value = |term: &str| -> f64 {
            let number = |term: &str| t[term.parse::<usize>().unwrap()];
            match term.split_at(1) {
                ("t", term) => number(term),
                ("-", term) if term.starts_with('t') => -number(&term[1..]),
                _ if term.contains('[') => {
                    let (array, at) = term.split_once('[').unwrap();
                    let (_, array) = arrays.iter().find(|(name, _)| *name == array).unwrap();
                    let (_, axis) = at.strip_suffix(']').unwrap().split_once("] + ").unwrap();
                    array[n[inside(at, '[', ']')] as usize].0[axis.parse::<usize>().unwrap()]
                }
                _ => term.parse().unwrap(),
            }
        };
        let result = if let Some(terms) = right.strip_prefix("fma(") {
            let terms: Vec<f64> = terms.trim_end_matches(')').split(", ").map(value).collect();
            terms[0].mul_add(terms[1], terms[2])
        } else if let Some(term) = right.strip_prefix("sqrt(") {
            value(term.trim_end_matches(')')).sqrt()
        } else {
            match right.split(' ').collect::<Vec<_>>()[..] {
                [a, "+", b] => value(a) + value(b),
                [a, "-", b] => value(a) - value(b),
                [a, "*", b] => value(a) * value(b),
                [a, "/", b] => value(a) / value(b),
                [a, "<", b, "?", x, ":", y] if (a, b) == (x, y) => value(a).min(value(b)),
                _ => value(right),
            }
        };
        if name.starts_with('f') {
            f[inside(name, '[', ']')] = result;
        } else {
            assert_eq!(name, format!("const double t{}", t.len()));
            t.push(result);
        }
    }
    f
}

/// Subtracts the force of all elements, as a device does.
fn subtract(elements: &DeviceElements, arrays: &[(&str, &[Padded]); 3], total: &mut [Padded]) {
    let count = elements.nodes.len() / 8;
    let mut corners = vec![f64::NAN; 24 * count];
    for kind in &elements.kinds {
        for element in kind.first..kind.first + kind.count {
            let n = std::array::from_fn(|corner| elements.nodes[corner * count + element]);
            for (i, f) in force(&kind.text, n, arrays).into_iter().enumerate() {
                corners[i * count + element] = f;
            }
        }
    }
    for (total, places) in total.iter_mut().zip(elements.begin.windows(2)) {
        for &at in &elements.places[places[0] as usize..places[1] as usize] {
            for axis in 0..3 {
                total.0[axis] -= corners[at as usize + axis * count];
            }
        }
    }
}

#[test]
fn a_device_is_given_the_operations_and_the_order_of_the_processor() {
    let part = |n| block(n, n.map(|n| 1e-3 * n as f64));
    let mesh = join(&[part([7, 5, 6]), part([5, 4, 3])]);
    let some: Vec<bool> = (0..mesh.hexes.len()).map(|e| e % 7 == 3 || e > 240).collect();
    let one_point = Element { hourglass: 0.05 };
    let viscous = Viscosity { bulk_linear: 0.06, bulk_quadratic: 1.2, kelvin_voigt: 2e-8 };
    let mixed = |volumetric| Elements::mixed(one_point, &some, volumetric);
    for (elements, viscosity, kinds) in [
        (Elements::from(one_point), Viscosity::default(), 2),
        (mixed(Volumetric::Full), viscous, 4),
        (mixed(Volumetric::Mean), viscous, 4),
    ] {
        let level = Level::pinned();
        let mut solid = Solid::new(&mesh, &[STEEL, ALUMINIUM], elements, viscosity, level).unwrap();
        let field = |scale: f64| -> Vec<Padded> {
            let value = |i: usize| {
                let k = i as f64;
                Padded::new([1.7 * k, 2.3 * k + 1.0, 0.9 * k].map(|x| scale * libm::sin(x)))
            };
            (0..mesh.nodes.len()).map(value).collect()
        };
        let (u, v) = (field(1e-6), field(2.0));
        let mut total = vec![field(3.0); 2];
        solid.subtract_internal_force(&u, &v, &mut total[0], false);
        let given = solid.on_device();
        assert!(given.kinds.len() >= kinds, "{} kinds", given.kinds.len());
        let arrays = [("reference", solid.reference()), ("displacement", &u), ("velocity", &v)];
        subtract(&given, &arrays, &mut total[1]);
        let bits = |field: &[Padded]| -> Vec<[u64; 3]> {
            field.iter().map(|v| v.xyz().map(f64::to_bits)).collect()
        };
        assert_eq!(bits(&total[1]), bits(&total[0]));
    }
}
