//! Any bytes as a model file.
#![no_main]

use libfuzzer_sys::fuzz_target;
use slipstick::input::{self, MotionSource};

/// Samples that a made motion may have here, so that making it takes no time.
const FEW: f64 = 1e4;

fuzz_target!(|bytes: &[u8]| {
    match input::from_bytes("fuzz.toml", bytes, &[]) {
        Ok(analysis) => {
            assert!(analysis.model.total_mass_kg() > 0.0);
            for input in analysis.inputs() {
                assert!(input.value.is_none_or(f64::is_finite), "{}", input.path);
            }
            make(&analysis);
        }
        Err(error) => {
            assert!(error.place.line > 0 && error.place.column > 0, "{error}");
            assert!(error.place.span.end <= bytes.len(), "{error}");
        }
    }
});

/// Makes a short motion, or takes its error to the key that caused it.
fn make(analysis: &input::Analysis) {
    let motion = match &analysis.motion {
        Some(MotionSource::Sine(sine)) if sine.duration_s < FEW * sine.dt_s => sine.motion(),
        Some(MotionSource::Sweep(sweep)) if sweep.duration_s < FEW * sweep.dt_s => sweep.motion(),
        Some(MotionSource::Pulse(pulse)) if pulse.start_s + pulse.duration_s < FEW * pulse.dt_s => {
            pulse.motion()
        }
        _ => return,
    };
    match motion {
        Ok(motion) => assert!(motion.duration_s() > 0.0),
        Err(error) => drop(analysis.motion_error(&error).to_string()),
    }
}
