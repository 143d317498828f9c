//! The extension module `slipstick._core`: values in, values out; everything is computed in the core.

mod assessment;
mod errors;
mod laboratory;
mod legend;
mod model;
mod motion;
mod requests;
mod response;
mod signal;
mod study;
mod table;
mod values;
mod work;

use pyo3::prelude::*;

/// Exact stick–slip response of structures on sliding bearings.
#[pymodule]
mod _core {
    #[pymodule_export]
    use super::assessment::{Assessment, assess, fit, read_suite, runs_of, suite};
    #[pymodule_export]
    use super::laboratory::{Comparison, Identified, compare_with, identify};
    #[pymodule_export]
    use super::legend::{
        along, axis, axis_of_column, axis_of_share, axis_of_words, band, change, colours, energies,
        is_key, lines, words_of_key,
    };
    #[pymodule_export]
    use super::model::Model;
    #[pymodule_export]
    use super::motion::Motion;
    #[pymodule_export]
    use super::requests::{
        check, fields, keys_of_modes, levels, schema, unit_at, unit_in, unit_of_measure, units,
    };
    #[pymodule_export]
    use super::response::{Response, run};
    #[pymodule_export]
    use super::signal::read_channels;
    #[pymodule_export]
    use super::study::{Study, demands, numbers_in, read_study, study, study_id};
    #[pymodule_export]
    use super::table::Table;
    #[pymodule_export]
    use super::values::{as_described, as_plain, nearest};
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
