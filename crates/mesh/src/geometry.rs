//! What nalgebra lacks of the geometry of surfaces.

use nalgebra::{Matrix2, Matrix3, Matrix3x2, Rotation3, UnitVector3, Vector3};

/// The direction of `v`, by one division for all components; no number where `v` is zero.
#[inline(always)]
pub fn direction(v: Vector3<f64>) -> UnitVector3<f64> {
    UnitVector3::new_unchecked(v * (1.0 / v.norm()))
}

/// `(I - n n^T) v`, the part of `v` in the plane with unit normal `n`.
#[inline(always)]
pub fn tangential(v: Vector3<f64>, n: UnitVector3<f64>) -> Vector3<f64> {
    v - n.dot(&v) * *n
}

/// Orthonormal columns in the plane with unit normal `n`, the first along `tangent`.
#[inline]
pub fn frame(tangent: Vector3<f64>, n: UnitVector3<f64>) -> Matrix3x2<f64> {
    let e1 = direction(tangential(tangent, n));
    Matrix3x2::from_columns(&[*e1, n.cross(&e1)])
}

/// The rotation by `angle` (rad) about +y, with a sine and cosine of the same bits on every machine.
pub fn rotation_about_y(angle: f64) -> Rotation3<f64> {
    let (sin, cos) = libm::sincos(angle);
    Rotation3::from_matrix_unchecked(Matrix3::new(cos, 0.0, sin, 0.0, 1.0, 0.0, -sin, 0.0, cos))
}

/// Vector area of a quadrilateral: half the product of its diagonals.
pub fn vector_area([a, b, c, d]: [Vector3<f64>; 4]) -> Vector3<f64> {
    0.5 * (c - a).cross(&(d - b))
}

/// The lowest and the highest coordinates of points: the corners of the box around them.
pub fn hull<'a>(points: impl IntoIterator<Item = &'a Vector3<f64>>) -> [Vector3<f64>; 2] {
    let nothing = [f64::INFINITY, f64::NEG_INFINITY].map(Vector3::repeat);
    points.into_iter().fold(nothing, |[low, high], p| [low.inf(p), high.sup(p)])
}

/// The adjugate of a matrix: its inverse times its determinant.
#[inline(always)]
pub fn adjugate(m: &Matrix2<f64>) -> Matrix2<f64> {
    Matrix2::new(m.m22, -m.m12, -m.m21, m.m11)
}
