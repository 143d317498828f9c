//! `slipstick paper`.

use serde_json::Value;

use super::support::Folder;

/// Chapter, figures and claims are written; what is printed is what is written.
#[test]
fn paper_writes_what_it_prints() {
    let folder = Folder::new("paper");
    let printed = folder.stdout(&["paper", "--quick", "--json", "--quiet", "--out", "out"]);
    assert_eq!(printed, folder.read("out/claims.json"));
    let claims: Value = serde_json::from_str(&printed).unwrap();
    let claims = claims.as_array().unwrap();
    assert!(claims.len() > 40);
    for claim in claims {
        for key in ["id", "section", "claim", "unit", "verdict", "why"] {
            assert!(claim[key].is_string(), "{key} in {claim}");
        }
        for key in ["paper_value", "computed_value"] {
            assert!(claim[key].is_number() || claim[key].is_null(), "{key} in {claim}");
        }
        let verdict = claim["verdict"].as_str().unwrap();
        assert!(["agrees", "differs", "cannot be checked"].contains(&verdict), "{verdict}");
    }
    assert!(folder.read("out/chapter.md").starts_with("# The paper, reproduced\n"));
    assert!(folder.read("out/figures/paper-figure-9.svg").starts_with("<svg "));
}

#[test]
fn paper_refuses_a_folder_without_records() {
    let folder = Folder::new("paper-records");
    folder.write("records/note.md", "# no record\n");
    let told = folder.refused(&["paper", "--quick", "--records", "records"]);
    assert!(told.contains("records: expected records, found none"), "{told}");
}
