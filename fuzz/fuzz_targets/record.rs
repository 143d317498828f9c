//! Any bytes as a record whose format is to be recognised; what is read goes through measures and spectra,
//! which must end soon, whatever the times.
#![no_main]

use libfuzzer_sys::fuzz_target;
use slipstick::motion::intensity::{IntensityMeasures, Measure};
use slipstick::motion::spectrum;
use slipstick::record::{self, Options, Units};

const PERIODS_S: [f64; 5] = [0.0, 0.02, 0.3, 1.0, 7.0];

fuzz_target!(|bytes: &[u8]| {
    let _ = record::read("fuzz", bytes, &Options::default());
    let options = Options { units: Units::parse("g"), dt_s: Some(0.01), ..Options::default() };
    let Ok(record) = record::read("fuzz", bytes, &options) else { return };
    for channel in &record.channels {
        // A frame of 64 bytes codes 105 differences at most.
        assert!(channel.values.len() >= 2 && channel.values.len() <= 2 * bytes.len());
    }
    // One channel is enough: the others have its times.
    let Some(Ok(motion)) = record.channels.iter().find_map(|channel| channel.motion()) else {
        return;
    };
    let measures = IntensityMeasures::of(&motion);
    let pga = motion.figures().pga_m_per_s2;
    assert!(measures.pga_m_per_s2 == pga && measures.d5_95_s <= motion.duration_s());
    assert!(Measure::Sa { period_s: 0.5, damping_ratio: 0.05 }.of(&motion) >= 0.0);
    let (times_s, values) = (motion.times_s(), motion.horizontal_m_per_s2());
    let Ok(spectrum) = spectrum(times_s, values, &PERIODS_S, &[0.0, 0.05]) else { return };
    assert_eq!(spectrum.ordinates[0].sa_m_per_s2, pga);
});
