//! Vectors of two components.

/// Length of a vector.
#[inline(always)]
pub(super) fn norm([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

/// Scalar product.
#[inline(always)]
pub(super) fn inner(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// `a − b`.
#[inline(always)]
pub(super) fn apart(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// `a × b`.
#[inline(always)]
pub(super) fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The direction of a vector, 0 of none.
pub(super) fn unit(v: [f64; 2]) -> [f64; 2] {
    let size = norm(v);
    if size > 0.0 { v.map(|v| v / size) } else { [0.0; 2] }
}
