//! What is varied: paths of the model, each with its distribution.

use super::{Distribution, List, Varied};
use crate::error::{InputError, cut, similar};
use crate::input::overrides::{find_kind, kind_of};
use crate::input::paths::join;
use crate::input::plan_keys::{DISTRIBUTION, MAX_RUNS};
use crate::input::reader::{LeafValue, Values};
use crate::input::schema::{Kind, Range};
use crate::input::tree::{Entry, Node, SourceSpan, TomlTable, Value};
use crate::units::Dimension;

/// Most paths that may be varied: there are Sobol' directions for as many.
pub(super) const MAX_PATHS: usize = crate::numerics::MAX_DIMENSIONS;

/// What a path of the model takes.
#[derive(Clone, Copy)]
struct Takes {
    /// `None` for a number without a unit.
    dimension: Option<Dimension>,
    /// Whether a number without a unit stands for it as well.
    or_ratio: bool,
    range: Range,
}

/// Reads `[vary]`, where it is given.
pub(super) fn read(values: &mut Values) -> Result<Vec<Varied>, InputError> {
    let Some(node) = values.special("vary").cloned() else { return Ok(Vec::new()) };
    let Value::Table(table) = &node.value else {
        let expected = "a table of paths of the model";
        return Err(values.mistyped("vary", &node, expected));
    };
    let mut all = Vec::new();
    walk(values, "", table, &mut all)?;
    if let Some(one_too_many) = all.get(MAX_PATHS) {
        let expected = format!("at most {MAX_PATHS} varied paths");
        let path = join("vary", &one_too_many.path);
        return Err(values.error(&path, expected, all.len().to_string()));
    }
    check_factors(values, &all)?;
    pair(values, &mut all)?;
    Ok(all)
}

/// Paths may be quoted, `"slider.radius"`, or written as keys inside keys.
fn walk(
    values: &mut Values,
    above: &str,
    table: &TomlTable,
    all: &mut Vec<Varied>,
) -> Result<(), InputError> {
    for entry in &table.0 {
        let path = join(above, &entry.name);
        let place = join("vary", &path);
        values.mark(&place, &entry.key);
        if let Value::Table(inner) = &entry.node.value
            && goes_deeper(&path, inner)
        {
            walk(values, &path, inner, all)?;
            continue;
        }
        let varied = varied(values, &path, entry)?;
        if all.iter().any(|other| other.path == path) {
            return Err(values.error(&place, "each path once", format!("\"{path}\" again")));
        }
        all.push(varied);
    }
    Ok(())
}

/// Whether a table holds keys of the model rather than a distribution.
fn goes_deeper(path: &str, table: &TomlTable) -> bool {
    match find_kind(path) {
        Ok(Kind::Section(_) | Kind::Sections(..) | Kind::Quantities(..) | Kind::Vectors(..)) => {
            table.0.iter().all(|entry| DISTRIBUTION.key(&entry.name).is_none())
        }
        Ok(Kind::NumberOr(_, both) | Kind::QuantityOr(_, _, both)) => {
            table.0.iter().any(|entry| both.key(&entry.name).is_some())
        }
        Ok(_) => false,
        // `storey` alone is a path of the model, `storey.x` is none.
        Err(_) => false,
    }
}

fn varied(values: &mut Values, path: &str, entry: &Entry) -> Result<Varied, InputError> {
    let place = join("vary", path);
    let takes = takes(values, path, &entry.key)?;
    let Value::Table(table) = &entry.node.value else {
        let expected = "a table such as { values = [1, 2] } or { uniform = [1, 2] }";
        return Err(values.mistyped(&place, &entry.node, expected));
    };
    values.read_table(&place, &entry.node.spot, table, &DISTRIBUTION)?;
    let factor_of = values.text(&join(&place, "factor_of")).map(str::to_owned);
    let drawn = match factor_of {
        // Factors have no unit, and what they give is judged by the model.
        Some(_) => Takes { dimension: None, or_ratio: false, range: Range::Any },
        None => takes,
    };
    let reader = Reader { values, place: &place, takes: drawn };
    let (distribution, has_unit) = reader.distribution()?;
    let unit = match (takes.dimension, &factor_of) {
        (Some(dimension), None) if has_unit => dimension.si_unit(),
        (Some(dimension), Some(_)) => dimension.si_unit(),
        _ => "",
    };
    let (path, range) = (path.to_owned(), takes.range);
    Ok(Varied { path, unit, range, of_records: false, distribution, factor_of, paired_with: None })
}

fn takes(values: &Values, path: &str, key: &SourceSpan) -> Result<Takes, InputError> {
    let place = join("vary", path);
    let refuse = |expected: &str, nearest: Option<String>| {
        let error = values.error_spot(key, &place, expected, format!("\"{}\"", cut(path)));
        InputError { nearest, ..error }
    };
    let kind = match find_kind(path) {
        Ok(kind) => kind,
        Err((expected, nearest)) => return Err(refuse(&expected, nearest)),
    };
    if path.starts_with("slider.bounds.") {
        return Err(refuse(
            "a path that a study varies: bounds of friction are chosen by bounds = \"all\", or vary the friction",
            None,
        ));
    }
    let numbered = path.rsplit('.').next().is_some_and(|last| last.parse::<usize>().is_ok());
    let (dimension, or_ratio, range) = match kind {
        Kind::Number(range) | Kind::NumberOr(range, _) => (None, false, *range),
        Kind::Quantity(dimension, range) | Kind::QuantityOr(dimension, range, _) => {
            (Some(*dimension), false, *range)
        }
        Kind::QuantityOrRatio(dimension, range) => (Some(*dimension), true, *range),
        Kind::Vector(dimension, range) => (Some(*dimension), false, *range),
        Kind::Quantities(dimension, range, _) | Kind::Vectors(dimension, range, _) if numbered => {
            (Some(*dimension), false, *range)
        }
        _ => return Err(refuse("the path of a number", None)),
    };
    Ok(Takes { dimension, or_ratio, range })
}

struct Reader<'a> {
    values: &'a Values,
    place: &'a str,
    takes: Takes,
}

impl Reader<'_> {
    /// The distribution, and whether its values were written with units.
    fn distribution(&self) -> Result<(Distribution, bool), InputError> {
        let truncated = match self.list("truncated") {
            Some(list) => {
                let ([lo, hi], unit) = self.pair("truncated", list, Range::Any)?;
                Some(([self.ordered("truncated", lo, hi)?, hi], unit))
            }
            None => None,
        };
        let uncut = |key: &str| match truncated {
            None => Ok(()),
            Some(_) => {
                let expected = "this key only beside \"normal\" or \"lognormal\"";
                let found = format!("\"truncated\" beside \"{key}\"");
                Err(self.values.error(&self.at("truncated"), expected, found))
            }
        };
        let same_unit = |unit: bool| match truncated {
            Some((_, other)) if other != unit => {
                let expected = "all values with a unit, or none";
                Err(self.values.error(&self.at("truncated"), expected, "both"))
            }
            _ => Ok(()),
        };
        let limits = truncated.map(|(limits, _)| limits);
        if let Some(list) = self.list("values") {
            uncut("values")?;
            let (values, unit) = self.all("values", list)?;
            return Ok((Distribution::List(List::Values(values)), unit));
        }
        for key in ["linspace", "logspace"] {
            let Some(list) = self.list(key) else { continue };
            uncut(key)?;
            let (list, unit) = self.spaced(key, list)?;
            return Ok((Distribution::List(list), unit));
        }
        if let Some(list) = self.list("uniform") {
            uncut("uniform")?;
            let ([lo, hi], unit) = self.pair("uniform", list, self.takes.range)?;
            return Ok((Distribution::Uniform([self.ordered("uniform", lo, hi)?, hi]), unit));
        }
        if let Some(list) = self.list("normal") {
            let [first, second] = self.exactly("normal", list)?;
            let (mean, unit) = self.value("normal.1", first, self.takes.range)?;
            let (deviation, other) = self.value("normal.2", second, Range::Positive)?;
            self.alike("normal", unit, other)?;
            same_unit(unit)?;
            return Ok((Distribution::Normal { mean, deviation, truncated: limits }, unit));
        }
        if let Some(list) = self.list("lognormal") {
            let [first, second] = self.exactly("lognormal", list)?;
            let (median, unit) = self.value("lognormal.1", first, Range::Positive)?;
            let place = self.at("lognormal.2");
            let sigma_ln = number(self.values.bare_number(&place, second, Range::Positive)?);
            same_unit(unit)?;
            if limits.is_some_and(|[_, most]| most <= 0.0) {
                let expected = "a largest value > 0 beside \"lognormal\"";
                return Err(self.values.error(&self.at("truncated"), expected, "none"));
            }
            return Ok((Distribution::Lognormal { median, sigma_ln, truncated: limits }, unit));
        }
        // The description has refused a table with none of these already.
        Err(self.values.error(self.place, "a distribution", "none"))
    }

    fn at(&self, key: &str) -> String {
        join(self.place, key)
    }

    fn list(&self, key: &str) -> Option<&Node> {
        self.values.special(&self.at(key))
    }

    /// A value of the path and whether it was written with its unit.
    fn value(&self, key: &str, node: &Node, range: Range) -> Result<(f64, bool), InputError> {
        let place = self.at(key);
        match (self.takes.dimension, &node.value) {
            (None, _) => Ok((number(self.values.bare_number(&place, node, range)?), false)),
            (Some(_), Value::Number(..)) if self.takes.or_ratio => {
                Ok((number(self.values.bare_number(&place, node, range)?), false))
            }
            (Some(dimension), _) => {
                Ok((number(self.values.quantity(&place, node, dimension, range)?), true))
            }
        }
    }

    fn alike(&self, key: &str, unit: bool, other: bool) -> Result<(), InputError> {
        if unit == other {
            return Ok(());
        }
        Err(self.values.error(&self.at(key), "all values with a unit, or none", "both"))
    }

    fn items<'n>(&self, key: &str, node: &'n Node) -> Result<&'n [Node], InputError> {
        match &node.value {
            Value::List(items) => Ok(items),
            _ => Err(self.values.mistyped(&self.at(key), node, "a list of values")),
        }
    }

    fn exactly<'n, const N: usize>(
        &self,
        key: &str,
        node: &'n Node,
    ) -> Result<[&'n Node; N], InputError> {
        let items = self.items(key, node)?;
        let all: Vec<&Node> = items.iter().collect();
        all.try_into().map_err(|_| {
            let expected = format!("a list of {N} values");
            self.values.error(&self.at(key), expected, items.len().to_string())
        })
    }

    fn all(&self, key: &str, node: &Node) -> Result<(Vec<f64>, bool), InputError> {
        let items = self.items(key, node)?;
        let mut values = Vec::with_capacity(items.len());
        let mut units = Vec::with_capacity(items.len());
        for (index, item) in items.iter().enumerate() {
            let key = format!("{key}.{}", index + 1);
            let (value, unit) = self.value(&key, item, self.takes.range)?;
            values.push(value);
            units.push(unit);
        }
        let Some(&unit) = units.first() else {
            return Err(self.values.error(&self.at(key), "at least one value", "none"));
        };
        for other in units {
            self.alike(key, unit, other)?;
        }
        Ok((values, unit))
    }

    fn pair(&self, key: &str, node: &Node, range: Range) -> Result<([f64; 2], bool), InputError> {
        let [first, second] = self.exactly(key, node)?;
        let (lo, unit) = self.value(&format!("{key}.1"), first, range)?;
        let (hi, other) = self.value(&format!("{key}.2"), second, range)?;
        self.alike(key, unit, other)?;
        Ok(([lo, hi], unit))
    }

    /// The lower one, where it is lower.
    fn ordered(&self, key: &str, lo: f64, hi: f64) -> Result<f64, InputError> {
        if lo < hi {
            return Ok(lo);
        }
        let expected = "a first value below the second";
        Err(self.values.error(&self.at(key), expected, format!("{lo} and {hi}")))
    }

    fn spaced(&self, key: &str, node: &Node) -> Result<(List, bool), InputError> {
        let [first, last, count] = self.exactly(key, node)?;
        let ratios = key == "logspace";
        let range = if ratios { Range::Positive } else { self.takes.range };
        let (from, unit) = self.value(&format!("{key}.1"), first, range)?;
        let (to, other) = self.value(&format!("{key}.2"), last, range)?;
        self.alike(key, unit, other)?;
        let whole = |value: f64| value >= 2.0 && value <= MAX_RUNS as f64 && value.fract() == 0.0;
        let count = match count.value {
            Value::Number(value, _) if whole(value) => value as u64,
            _ => {
                let expected = format!("a whole number from 2 to {MAX_RUNS}");
                return Err(self.values.mistyped(&self.at(&format!("{key}.3")), count, expected));
            }
        };
        let ends = [from, to];
        let list = if ratios { List::Ratios { ends, count } } else { List::Even { ends, count } };
        Ok((list, unit))
    }
}

fn number(given: LeafValue) -> f64 {
    match given {
        LeafValue::Number(value) => value,
        _ => f64::NAN,
    }
}

/// Finds the partner of each list that goes with another.
fn pair(values: &Values, all: &mut [Varied]) -> Result<(), InputError> {
    for i in 0..all.len() {
        let place = format!("vary.{}.paired_with", all[i].path);
        let Some(with) = values.text(&place) else { continue };
        let partner = all.iter().position(|other| other.path == with).ok_or_else(|| {
            let nearest = similar(with, all.iter().map(|varied| varied.path.as_str()));
            InputError { nearest, ..values.wrong(&place, "another path of [vary]") }
        })?;
        let length = |i: usize| match &all[i].distribution {
            Distribution::List(list) => Some(list.len()),
            _ => None,
        };
        let leads = !values.has(&format!("vary.{}.paired_with", all[partner].path));
        if partner == i || !leads || length(partner) != length(i) {
            let expected = match length(i) {
                Some(count) => format!("a path with a list of {count} values of its own"),
                None => "a path with a list".to_owned(),
            };
            return Err(values.wrong(&place, expected));
        }
        all[i].paired_with = Some(partner);
    }
    Ok(())
}

/// Each factor's path: of the same dimension, and not in the end its own.
fn check_factors(values: &Values, all: &[Varied]) -> Result<(), InputError> {
    for varied in all {
        let Some(of) = &varied.factor_of else { continue };
        let place = format!("vary.{}.factor_of", varied.path);
        let found = format!("\"{}\"", cut(of));
        let key = values.leaf(&place).map(|leaf| leaf.spot.clone()).unwrap_or_default();
        let target = takes(values, of, &key)?;
        let own = takes(values, &varied.path, &key)?;
        if target.dimension != own.dimension {
            let what = own.dimension.map_or("a number".to_owned(), Dimension::with_article);
            return Err(values.error(&place, format!("the path of {what}"), found));
        }
        let mut seen = vec![varied.path.as_str()];
        let mut next = Some(of.as_str());
        while let Some(path) = next {
            if seen.contains(&path) {
                let expected = "a path that does not follow from this one";
                return Err(values.error(&place, expected, found));
            }
            seen.push(path);
            let other = all.iter().find(|other| other.path == path);
            next = other.and_then(|other| other.factor_of.as_deref());
        }
    }
    debug_assert!(all.iter().all(|varied| kind_of(&varied.path).is_some()));
    Ok(())
}
