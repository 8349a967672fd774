//! The distortion and energy of single elements, in plain scalar form: for the guards of a run and for reports on why
//! it stopped.

use super::Solid;
use crate::formulation::Volumetric;
use crate::gauss::gauss_points;
use crate::geometry::{displacement_gradient, mean_gradient};
use crate::stiffness::hourglass_shapes;
use crate::stress::{deformation, green};
use mesh::Padded;
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

/// The state of one element.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElementState {
    /// Mean det F (dimensionless): of a fully integrated element its volume over the undeformed one, of a one-point
    /// element det F of the mean gradient.
    pub volume_ratio: f64,
    /// Smallest det F at its corners (dimensionless): zero where the element is flat, negative where it is folded.
    pub corner_ratio: f64,
    /// Strain energy (J).
    pub strain_energy: f64,
    /// Energy of its hourglass stiffness (J); zero for a fully integrated element.
    pub hourglass_energy: f64,
}

/// For each corner, the neighbours that differ from it in xi, eta and zeta (`VTK_HEXAHEDRON` order).
const NEIGHBOURS: [[usize; 3]; 8] =
    [[1, 3, 4], [0, 2, 5], [3, 1, 6], [2, 0, 7], [5, 7, 0], [4, 6, 1], [7, 5, 2], [6, 4, 3]];

/// The triple product of the three edges at each corner (m^3): det(dx/dxi) there up to a constant factor and sign,
/// which cancel in a ratio.
fn corner_products(x: &[Vector3<f64>; 8]) -> [f64; 8] {
    std::array::from_fn(|corner| {
        let [a, b, c] = NEIGHBOURS[corner].map(|other| x[other] - x[corner]);
        a.dot(&b.cross(&c))
    })
}

/// Smallest det F at the corners. At a corner of a trilinear element, det F is the triple product of the deformed edges
/// over that of the undeformed ones. NaN if a displacement is NaN.
fn corner_ratio(x: &[Vector3<f64>; 8], u: &[Vector3<f64>; 8]) -> f64 {
    let deformed = std::array::from_fn(|c| x[c] + u[c]);
    let ratios = corner_products(&deformed).into_iter().zip(corner_products(x));
    ratios.map(|(now, reference)| now / reference).fold(f64::INFINITY, worse)
}

/// The smaller of two numbers, or NaN if one is.
fn worse(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// K_h/2 sum q_a . q_a (J) with the amplitudes q_a = sum u_I gamma_aI and K_h = kappa M
/// B_iI B_iI/(24 V); `modulus` is kappa M (Pa), M of [`crate::Material::hourglass_modulus`].
fn hourglass_energy(x: &[Vector3<f64>; 8], u: &[Vector3<f64>; 8], modulus: f64) -> f64 {
    let (volume, b) = mean_gradient(x);
    let squares: f64 = b.iter().flatten().map(|c| c * c).sum();
    let amplitudes = hourglass_shapes(x, volume, &b)
        .map(|gamma| gamma.iter().zip(u).map(|(g, u)| *g * u).sum::<Vector3<f64>>());
    let square: f64 = amplitudes.iter().flatten().map(|q| q * q).sum();
    0.5 * modulus * squares / (24.0 * volume) * square
}

impl Solid {
    /// The element with the smallest det F at a corner, and that det F (dimensionless). A NaN counts as the smallest;
    /// of equals the first element is returned, and `(usize::MAX, f64::INFINITY)` if there are no elements. At zero or
    /// below, the element is flat or folded. Allocates nothing.
    ///
    /// # Panics
    /// If there are fewer displacements (m) than nodes.
    pub fn most_folded(&self, displacement: &[Padded]) -> (usize, f64) {
        let rank = |(element, ratio): (usize, f64)| {
            let ratio = if ratio.is_nan() { f64::NEG_INFINITY } else { ratio };
            (ratio, element)
        };
        let least = |a: (usize, f64), b: (usize, f64)| {
            let ((x, i), (y, j)) = (rank(a), rank(b));
            if x < y || (x == y && i < j) { a } else { b }
        };
        let none = (usize::MAX, f64::INFINITY);
        self.bodies
            .iter()
            .enumerate()
            .map(|(body, (range, _))| {
                let elements = range.clone().into_par_iter().with_min_len(1024);
                let ratio = |element| {
                    let (x, u) = self.corners(displacement, body, element);
                    (element, corner_ratio(&x, &u))
                };
                elements.map(ratio).reduce(|| none, least)
            })
            .fold(none, least)
    }

    /// The hourglass energy (J) that the one-point elements would have with the hourglass coefficient `coefficient`
    /// (dimensionless) at these displacements (m).
    ///
    /// # Panics
    /// If there are fewer displacements than nodes.
    pub fn hourglass_energy(&self, displacement: &[Padded], coefficient: f64) -> f64 {
        let of = |element| {
            let body = self.body_of(element);
            if self.blocks.is_full(body, element) {
                return 0.0;
            }
            let (x, u) = self.corners(displacement, body, element);
            hourglass_energy(&x, &u, coefficient * self.bodies[body].1.hourglass_modulus())
        };
        exact_sum::sum((0..self.elements()).map(of))
    }

    /// The state of every element, in the order of the mesh, at these displacements (m).
    ///
    /// # Panics
    /// If there are fewer displacements than nodes.
    pub fn element_states(&self, displacement: &[Padded]) -> Vec<ElementState> {
        let of = |element| self.element_state(displacement, element);
        (0..self.elements()).into_par_iter().map(of).collect()
    }

    /// Nodes of an element in `VTK_HEXAHEDRON` order.
    ///
    /// # Panics
    /// If there is no such element.
    pub fn nodes_of(&self, element: usize) -> [u32; 8] {
        self.blocks.hex(self.body_of(element), element)
    }

    /// Index of the body of an element; zero if there is no such element.
    pub fn body_of(&self, element: usize) -> usize {
        self.bodies.iter().position(|(range, _)| range.contains(&element)).unwrap_or(0)
    }

    /// The state of one element at these displacements (m).
    ///
    /// # Panics
    /// If there is no such element, or there are fewer displacements than nodes.
    pub fn element_state(&self, displacement: &[Padded], element: usize) -> ElementState {
        let body = self.body_of(element);
        let material = &self.bodies[body].1;
        let (x, u) = self.corners(displacement, body, element);
        // lambda/2 theta^2 + G E:E
        let density = |e: &Matrix3<f64>, theta: f64| {
            let square: f64 = e.iter().map(|c| c * c).sum();
            0.5 * material.lame() * theta * theta + material.shear() * square
        };
        let corner_ratio = corner_ratio(&x, &u);
        if self.blocks.is_full(body, element) {
            let points = gauss_points(&x).map(|p| (p.volume, p.displacement_gradient(&u)));
            let volume: f64 = points.iter().map(|(w, _)| w).sum();
            let mean = points.iter().map(|(w, h)| w * green(h).trace()).sum::<f64>() / volume;
            let (mut now, mut strain_energy) = (0.0, 0.0);
            for (w, h) in &points {
                let e = green(h);
                let theta = match self.volumetric {
                    Volumetric::Full => e.trace(),
                    Volumetric::Mean => mean,
                };
                strain_energy += w * density(&e, theta);
                now += w * deformation(h).determinant();
            }
            let volume_ratio = now / volume;
            return ElementState {
                volume_ratio,
                corner_ratio,
                strain_energy,
                hourglass_energy: 0.0,
            };
        }
        let (h, volume) = displacement_gradient(&x, &u);
        let e = green(&h);
        let modulus = self.one_point.hourglass * material.hourglass_modulus();
        ElementState {
            volume_ratio: deformation(&h).determinant(),
            corner_ratio,
            strain_energy: volume * density(&e, e.trace()),
            hourglass_energy: hourglass_energy(&x, &u, modulus),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use crate::{Element, Elements, Level, Material, Solid, Viscosity, Volumetric};
    use mesh::Padded;
    use nalgebra::Vector3;

    const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7850.0 };

    #[test]
    fn energies_of_the_elements_add_up_to_those_of_the_kernels() {
        let mesh = mesh::block([4, 3, 3], [4e-3, 3e-3, 3e-3]);
        let wave = |x: &Vector3<f64>, i: usize| {
            1e-5 * libm::sin(900.0 * x[(i + 1) % 3] + i as f64) * libm::cos(700.0 * x[(i + 2) % 3])
        };
        let u: Vec<_> =
            mesh.nodes.iter().map(|x| Padded::new([0, 1, 2].map(|i| wave(x, i)))).collect();
        let some: Vec<_> = (0..mesh.hexes.len()).map(|e| e % 3 == 0).collect();
        let one_point = Element { hourglass: 0.05 };
        for volumetric in [Volumetric::Mean, Volumetric::Full] {
            let elements = Elements::mixed(one_point, &some, volumetric);
            let mut solid =
                Solid::new(&mesh, &[STEEL], elements, Viscosity::default(), Level::detect())
                    .unwrap();
            let states = solid.element_states(&u);
            let mut force = vec![Padded::ZERO; u.len()];
            let sums = solid.subtract_elastic_force(&u, &mut force, true);
            let strain: f64 = states.iter().map(|s| s.strain_energy).sum();
            let hourglass: f64 = states.iter().map(|s| s.hourglass_energy).sum();
            assert!((strain / sums.internal - 1.0).abs() < 1e-12, "{strain} {}", sums.internal);
            assert!(hourglass > 1e-3 * strain, "the elements do hourglass: {hourglass} {strain}");
            assert!(
                (hourglass / sums.hourglass - 1.0).abs() < 1e-12,
                "{hourglass} {}",
                sums.hourglass
            );
        }
    }

    #[test]
    fn a_corner_pushed_through_its_element_is_the_most_folded_and_nan_comes_first() {
        let mesh = mesh::block([5, 4, 3], [5.0, 4.0, 3.0]);
        let solid = Solid::new(
            &mesh,
            &[STEEL],
            Element { hourglass: 0.05 },
            Viscosity::default(),
            Level::detect(),
        )
        .unwrap();
        let mut u = vec![Padded::ZERO; mesh.nodes.len()];
        assert_eq!(solid.most_folded(&u), (0, 1.0));
        let element = 37;
        let [.., corner] = mesh.hexes[element];
        let [first, ..] = mesh.hexes[element];
        let (from, to) = (mesh.nodes[corner as usize], mesh.nodes[first as usize]);
        u[corner as usize] = Padded::from(1.2 * (to - from));
        let (found, ratio) = solid.most_folded(&u);
        assert!(ratio < 0.0 && mesh.hexes[found].contains(&corner), "{found} {ratio}");
        assert_eq!(solid.element_states(&u)[found].corner_ratio, ratio);
        u[corner as usize].0[1] = f64::NAN;
        let (found, ratio) = solid.most_folded(&u);
        let with = |e: &[u32; 8]| e.contains(&corner);
        assert_eq!(found, mesh.hexes.iter().position(with).unwrap());
        assert!(ratio.is_nan());
    }
}
