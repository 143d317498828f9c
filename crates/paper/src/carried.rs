//! The mock-ups and records of the paper, carried in the program.

use crate::{Library, PaperError};

/// Pairs of name and text of the models in `examples/paper`.
macro_rules! models {
    ($($name:literal,)*) => {
        [$((
            $name,
            include_str!(concat!("../../../examples/paper/", $name, ".toml")),
        ),)*]
    };
}

/// Pairs of name and bytes of the records in `examples/records`.
macro_rules! records {
    ($($name:literal,)*) => {
        [$((
            $name,
            include_bytes!(concat!("../../../examples/records/", $name)).as_slice(),
        ),)*]
    };
}

/// The library of the paper's reproduction: the models of `examples/paper`, the records of
/// `examples/records`.
///
/// # Errors
/// [`PaperError`] for a text that cannot be read, which tests rule out.
pub fn paper_library() -> Result<Library, PaperError> {
    let models = models![
        "section3-124kg-free-sine",
        "section3-124kg-free-taft",
        "section3-124kg-spring128-sine",
        "section3-124kg-spring128-taft",
        "section3-124kg-spring143-sine",
        "section3-124kg-spring143-taft",
        "section3-124kg-spring19-sine",
        "section3-124kg-spring19-taft",
        "section3-248kg-free-sine",
        "section3-248kg-free-taft",
        "section3-248kg-spring128-sine",
        "section3-248kg-spring128-taft",
        "section3-248kg-spring143-sine",
        "section3-248kg-spring143-taft",
        "section3-248kg-spring19-sine",
        "section3-248kg-spring19-taft",
        "section6-45kg-1_625hz-sine",
        "section6-45kg-1_625hz-taft",
        "section6-90kg-1_75hz-sine",
        "section6-90kg-1_75hz-taft",
        "section6-90kg-2_15hz-sine",
        "section6-90kg-2_15hz-taft",
        "section6-201kg-1_125hz-sine",
        "section6-201kg-1_125hz-taft",
        "section6-201kg-2_65hz-sine",
        "section6-201kg-2_65hz-taft",
    ];
    let records = records!["taft-111.txt", "taft-021.txt", "el-centro-180.txt",];
    Library::read(&models, &records)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every model of `examples/paper` is carried, so that none is forgotten when one is added.
    #[test]
    fn file_every_example_is_in_the_library() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/paper");
        let names = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let mut names: Vec<String> =
            names.map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).collect();
        names.sort();
        let library = paper_library().unwrap();
        let mut carried: Vec<String> = library.experiments().iter().map(|e| e.id.clone()).collect();
        carried.sort();
        assert_eq!(carried, names);
    }
}
