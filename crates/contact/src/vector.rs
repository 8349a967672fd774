//! The few products of three-vectors that contact kinematics is written in.

pub(crate) type Vec3 = [f64; 3];

#[inline(always)]
pub(crate) fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(crate) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(crate) fn scale(s: f64, a: Vec3) -> Vec3 {
    [s * a[0], s * a[1], s * a[2]]
}

/// `a + s b`.
#[inline(always)]
pub(crate) fn axpy(a: Vec3, s: f64, b: Vec3) -> Vec3 {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

#[inline(always)]
pub(crate) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
pub(crate) fn norm(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

/// The part of `a` in the plane with unit normal `n`.
#[inline(always)]
pub(crate) fn tangential(a: Vec3, n: Vec3) -> Vec3 {
    axpy(a, -dot(a, n), n)
}

/// Orthonormal vectors in the plane with unit normal `n`, the first along `tangent`.
pub(crate) fn frame(tangent: Vec3, n: Vec3) -> [Vec3; 2] {
    let e = tangential(tangent, n);
    let e1 = scale(1.0 / norm(e), e);
    [e1, cross(n, e1)]
}
