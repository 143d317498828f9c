//! Slipstick in the browser: wrappers of the core for the page's workers.
//!
//! Thin: text and bytes in; typed arrays, one object of results as JSON, and whole files out. Errors are
//! JSON too, with the place in the text where they have one. Nothing is computed here.

#[cfg(all(target_family = "wasm", not(target_feature = "simd128")))]
compile_error!(
    "the WebAssembly module needs vector instructions: build it with `cargo xtask web`, or with \
     RUSTFLAGS=\"-C target-feature=+simd128\""
);

mod answer;
mod failure;
mod records;
mod session;
mod sheets;

pub use answer::{Answer, Judgement};
pub use session::Session;
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
