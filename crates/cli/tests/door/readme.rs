//! The README: its model is the one that its command runs, its links lead somewhere.

use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

#[test]
fn the_sample_model_is_the_one_that_runs() {
    let readme = read("README.md");
    let shown = readme.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next());
    let model = read("examples/taft.toml");
    let keys = model.find("name = ").expect("a name");
    assert_eq!(shown, Some(&model[keys..]));
    assert!(readme.contains("run examples/taft.toml --out out"));
}

#[test]
fn links_lead_to_files() {
    let readme = read("README.md");
    let links = readme.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let images = readme.split("src=\"").skip(1).filter_map(|rest| rest.split('"').next());
    let mut count = 0;
    for link in links.chain(images).filter(|link| !link.starts_with("https:")) {
        assert!(root().join(link).is_file(), "{link}");
        count += 1;
    }
    assert!(count >= 15, "{count} links");
}
