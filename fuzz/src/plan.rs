//! What every plan is put through: read, its samples drawn, a few models made of them.

use slipstick::input::Variation;
use slipstick::input::plan::Plan;
use slipstick::study::Design;

const MODEL: &str = include_str!("../../examples/studies/mock-up.toml");

/// Reads a plan; what is accepted makes models, what is refused has a place.
pub fn check(bytes: &[u8]) {
    match Plan::from_bytes("fuzz.toml", bytes) {
        Ok(plan) => {
            let Ok(model) = Variation::new("m.toml", MODEL, &plan.vary) else { return };
            let Ok(design) = Design::new(&plan, &model) else { return };
            for index in [0, design.count() / 2, design.count() - 1] {
                let values = design.values(index);
                if let Ok(parts) = model.parts(&values) {
                    assert_eq!(model.analysis(&values).unwrap().model, parts.model);
                }
            }
        }
        Err(error) => {
            assert!(error.place.line > 0 && error.place.column > 0, "{error}");
            assert!(error.place.span.end <= bytes.len(), "{error}");
        }
    }
}
