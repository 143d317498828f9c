//! Slipstick in the browser: wrappers of the core for the page's workers.
//!
//! Thin: text and bytes in; typed arrays, one object of results as JSON, and whole files out. Errors are
//! JSON too, with the place in the text where they have one. Nothing is computed here.
//!
//! Without the feature `whole` it analyses one model on columns of numbers, unchecked: what a first picture
//! needs, in a fraction of the bytes.

#[cfg(all(target_family = "wasm", not(target_feature = "simd128")))]
compile_error!(
    "the WebAssembly module needs vector instructions: build it with `cargo xtask web`, or with \
     RUSTFLAGS=\"-C target-feature=+simd128\""
);

mod answer;
mod failure;
#[cfg(feature = "whole")]
mod figures;
#[cfg(feature = "whole")]
mod judged;
mod records;
#[cfg(feature = "whole")]
mod runs;
mod session;
#[cfg(feature = "whole")]
mod sheets;
#[cfg(feature = "whole")]
mod whole;

pub use answer::Answer;
#[cfg(feature = "whole")]
pub use judged::Judgement;
pub use session::Session;
#[cfg(feature = "whole")]
pub use sheets::Page;

use wasm_bindgen::prelude::wasm_bindgen;

/// The version of Slipstick.
#[wasm_bindgen]
#[must_use]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}

/// SHA-256 of bytes in hexadecimal digits.
#[wasm_bindgen]
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    slipstick::hash::sha256_hex(bytes)
}
