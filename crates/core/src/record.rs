//! Record formats: bytes in, `Result` out.
