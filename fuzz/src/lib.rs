//! What several fuzz targets share.

pub use libfuzzer_sys::fuzz_target;
pub use slipstick::record;

pub mod plan;

/// The target of one format of records: any bytes, read with units and a time step and without them.
#[macro_export]
macro_rules! record_target {
    ($format:ident, $units:literal) => {
        $crate::fuzz_target!(|bytes: &[u8]| {
            use $crate::record::{self, Format, Options, Units};

            let format = Some(Format::$format);
            let options = Options { format, units: Units::parse($units), dt_s: Some(0.01) };
            let _ = record::read("fuzz", bytes, &options);
            let _ = record::read("fuzz", bytes, &Options { format, ..Options::default() });
        });
    };
}
