//! How samples are drawn, and how the drawn values hang together.

use super::{Distribution, Method, Sampling, Varied};
use crate::error::{InputError, similar};
use crate::input::plan_keys::MAX_RUNS;
use crate::input::reader::Values;
use crate::input::schema::Range;
use crate::input::tree::{Node, Value};
use crate::numerics::cholesky;

/// Reads `[sampling]`; it is there where something is varied.
pub(super) fn read(values: &mut Values, vary: &[Varied]) -> Result<Option<Sampling>, InputError> {
    if vary.is_empty() {
        if values.has("sampling") {
            let expected = "a table [vary] beside [sampling]";
            return Err(values.error("sampling", expected, "nothing to sample"));
        }
        return Ok(None);
    }
    if !values.has("sampling") {
        let expected = "a table [sampling] beside [vary]";
        return Err(values.error("sampling", expected, "nothing"));
    }
    let method = match values.text("sampling.method") {
        Some("grid") => Method::Grid,
        Some("latin-hypercube") => Method::LatinHypercube,
        _ => Method::Sobol,
    };
    let correlation = correlation(values, vary)?;
    let (count, seed) = match method {
        Method::Grid => (grid(values, vary)?, None),
        _ => {
            let whole = |key: &str| -> Result<u64, InputError> {
                let path = format!("sampling.{key}");
                let value = values.number(&path).map(|value| value as u64);
                value.ok_or_else(|| values.error(&path, "a whole number", "nothing"))
            };
            (whole("count")?, Some(whole("seed")?))
        }
    };
    Ok(Some(Sampling { method, count, seed, correlation }))
}

/// Number of combinations of a grid, and what a grid does not take.
fn grid(values: &Values, vary: &[Varied]) -> Result<u64, InputError> {
    for key in ["count", "seed", "correlation"] {
        let path = format!("sampling.{key}");
        if values.has(&path) {
            let expected = "no such key with method = \"grid\", which draws nothing";
            return Err(values.error(&path, expected, format!("\"{key}\"")));
        }
    }
    let mut count = 1_u64;
    for varied in vary {
        let place = format!("vary.{}", varied.path);
        if varied.paired_with.is_some() {
            continue;
        }
        let Distribution::List(list) = &varied.distribution else {
            let expected = "values, linspace or logspace with method = \"grid\"";
            return Err(values.error(&place, expected, "a distribution"));
        };
        count =
            count.checked_mul(list.len()).filter(|count| *count <= MAX_RUNS).ok_or_else(|| {
                let expected = format!("a grid of at most {MAX_RUNS} samples");
                values.error(&place, expected, "more")
            })?;
    }
    Ok(count)
}

/// The lower triangle of the correlation matrix, where pairs are given.
fn correlation(values: &mut Values, vary: &[Varied]) -> Result<Option<Vec<f64>>, InputError> {
    const PLACE: &str = "sampling.correlation";
    let Some(node) = values.special(PLACE).cloned() else { return Ok(None) };
    let form = "a list of [\"PATH\", \"PATH\", NUMBER]";
    let Value::List(pairs) = &node.value else {
        return Err(values.mistyped(PLACE, &node, form));
    };
    let n = vary.len();
    let mut matrix = vec![0.0; n * n];
    for i in 0..n {
        matrix[i * n + i] = 1.0;
    }
    for (index, pair) in pairs.iter().enumerate() {
        let place = format!("{PLACE}.{}", index + 1);
        values.mark(&place, &pair.spot);
        let Value::List(items) = &pair.value else {
            return Err(values.mistyped(&place, pair, "[\"PATH\", \"PATH\", NUMBER]"));
        };
        let [first, second, rho] = items.as_slice() else {
            return Err(values.mistyped(&place, pair, "[\"PATH\", \"PATH\", NUMBER]"));
        };
        let i = dimension(values, &place, first, vary)?;
        let j = dimension(values, &place, second, vary)?;
        if i == j || matrix[i * n + j] != 0.0 {
            let found = if i == j { "one path twice" } else { "this pair again" };
            return Err(values.error(&place, "each pair of two paths once", found));
        }
        let rho = match rho.value {
            Value::Number(value, _) if Range::Fraction.contains(value) => value,
            _ => return Err(values.mistyped(&place, rho, Range::Fraction.expected("number"))),
        };
        matrix[i * n + j] = rho;
        matrix[j * n + i] = rho;
    }
    cholesky(&matrix, n).map(Some).ok_or_else(|| {
        let expected = "correlations that can hold together (a positive definite matrix)";
        values.error(PLACE, expected, "a matrix that is not positive definite")
    })
}

fn dimension(
    values: &Values,
    place: &str,
    node: &Node,
    vary: &[Varied],
) -> Result<usize, InputError> {
    let Value::Text(path) = &node.value else {
        return Err(values.mistyped(place, node, "a varied path in quotes"));
    };
    let own = |varied: &&Varied| varied.paired_with.is_none();
    vary.iter().position(|varied| own(&varied) && varied.path == *path).ok_or_else(|| {
        let nearest = similar(path, vary.iter().map(|varied| varied.path.as_str()));
        InputError {
            nearest,
            ..values.mistyped(place, node, "a path of [vary] that is drawn by itself")
        }
    })
}
