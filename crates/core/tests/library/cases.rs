//! Every verification case of `data/reference/`, each a test of its own named by its source of truth:
//! `closed_form_` a closed form, `reference_` the independent 50-digit solver.

// Every case says how close it came: `cargo xtask reference` makes the book's table of it. Helpers of
// tests may panic as tests do.
#![allow(clippy::disallowed_macros, clippy::expect_used)]

use crate::common::cases::{Case, all, case, cycles};
use crate::common::compare::{Outcome, Report, judged, of_response};
use crate::common::values::judge;
use slipstick::model::Model;
use slipstick::motion::GroundMotion;
use slipstick::response::EventKind;
use slipstick::slider::Friction;
use slipstick::solver::exact;

fn by_exact_method(model: &Model, motion: &GroundMotion) -> Outcome {
    of_response(model, &exact(model, motion).expect("a response"))
}

/// Fails with every number of the case that is outside its stated tolerance.
fn run(case: &Case) {
    let report = if case.is_history() {
        judged(case, by_exact_method)
    } else {
        let mut report = Report::default();
        for per_cycle in [200, 1000] {
            judge(case, by_exact_method, per_cycle, &mut report);
        }
        report
    };
    let Report { figures, worst, what, tolerance, wrong } = report;
    println!(
        "case {}: {figures} figures, worst {worst:.1e} of its tolerance {tolerance:.1e} ({what})",
        case.id
    );
    assert!(wrong.is_empty(), "{}:\n{}", case.id, wrong.join("\n"));
}

/// What the formula of HARM-CRIT says, in responses: a little below the critical μ g/A the block
/// never stops, a little above it does in every half cycle.
#[test]
fn closed_form_critical_ratio_separates_stops_from_none() {
    let formula = case("HARM-CRIT").list("expect")[0]["value"].as_f64().expect("a number");
    let sticks = |eta: f64| {
        let friction = Friction::new(eta, eta).expect("friction");
        let model = Model::rigid_block(124.0, friction).expect("a model");
        let motion = cycles([model.gravity_m_per_s2(), 9.0, 0.0], None, 1000, 0, 40);
        let events = exact(&model, &motion).expect("a response").events;
        let late = events.iter().filter(|e| e.time_s > 0.75 * motion.duration_s());
        late.filter(|e| e.kind == EventKind::Stick).count()
    };
    assert_eq!(sticks(formula - 1e-4), 0);
    assert_eq!(sticks(formula + 1e-4), 20);
}

macro_rules! cases {
    ($($name:ident: $id:literal,)*) => {
        $(#[test]
        fn $name() {
            run(&case($id));
        })*

        /// No case of the file is left out.
        #[test]
        fn every_case_is_a_test() {
            let listed = [$($id),*];
            let ids: Vec<String> = all().into_iter().map(|c| c.id).collect();
            assert_eq!(ids, listed);
        }
    };
}

cases! {
    closed_form_newmark_rect_1: "NEWMARK-RECT-1",
    closed_form_newmark_rect_2: "NEWMARK-RECT-2",
    closed_form_newmark_rect_mus: "NEWMARK-RECT-MUS",
    closed_form_newmark_square_2way_1: "NEWMARK-SQUARE-2WAY-1",
    closed_form_newmark_square_1way_1: "NEWMARK-SQUARE-1WAY-1",
    closed_form_newmark_tri_1: "NEWMARK-TRI-1",
    closed_form_newmark_tri_2: "NEWMARK-TRI-2",
    closed_form_newmark_halfsine_1: "NEWMARK-HALFSINE-1",
    closed_form_newmark_halfsine_2: "NEWMARK-HALFSINE-2",
    closed_form_newmark_sine1_1: "NEWMARK-SINE1-1",
    closed_form_newmark_sine1_2: "NEWMARK-SINE1-2",
    closed_form_ramp_rigid_1: "RAMP-RIGID-1",
    closed_form_ramp_2dof_1: "RAMP-2DOF-1",
    closed_form_harm_crit: "HARM-CRIT",
    closed_form_harm_eta_0_1: "HARM-ETA-0.1",
    closed_form_harm_eta_0_3: "HARM-ETA-0.3",
    closed_form_harm_eta_0_5: "HARM-ETA-0.5",
    closed_form_harm_eta_0_54: "HARM-ETA-0.54",
    closed_form_harm_eta_0_6: "HARM-ETA-0.6",
    closed_form_harm_eta_0_7: "HARM-ETA-0.7",
    closed_form_harm_eta_0_8: "HARM-ETA-0.8",
    closed_form_harm_eta_0_9: "HARM-ETA-0.9",
    closed_form_harm_eta_1: "HARM-ETA-1",
    closed_form_harm_eta_1_05: "HARM-ETA-1.05",
    closed_form_harm_musd_0_6_0_4: "HARM-MUSD-0.6-0.4",
    closed_form_harm_musd_0_7_0_25: "HARM-MUSD-0.7-0.25",
    closed_form_harm_start_0_3_0: "HARM-START-0.3-0",
    closed_form_harm_start_0_3_45: "HARM-START-0.3-45",
    closed_form_harm_start_0_3_90: "HARM-START-0.3-90",
    closed_form_harm_start_0_7_0: "HARM-START-0.7-0",
    closed_form_harm_start_0_7_90: "HARM-START-0.7-90",
    closed_form_denhartog_free_1: "DENHARTOG-FREE-1",
    closed_form_denhartog_free_2: "DENHARTOG-FREE-2",
    closed_form_denhartog_free_3: "DENHARTOG-FREE-3",
    closed_form_denhartog_forced_0_8_0_4: "DENHARTOG-FORCED-0.8-0.4",
    closed_form_denhartog_forced_1_5_0_3: "DENHARTOG-FORCED-1.5-0.3",
    closed_form_restick_k1_1: "RESTICK-K1-1",
    closed_form_sdof_ss_1_1_125: "SDOF-SS-1-1.125",
    closed_form_sdof_ss_2_984_2_687: "SDOF-SS-2.984-2.687",
    closed_form_sdof_ramp_1: "SDOF-RAMP-1",
    closed_form_freefree_1: "FREEFREE-1",
    closed_form_launch_2dof_1: "LAUNCH-2DOF-1",
    closed_form_tilt_drift_1: "TILT-DRIFT-1",
    closed_form_tilt_drift_2: "TILT-DRIFT-2",
    closed_form_tilt_drift_5: "TILT-DRIFT-5",
    closed_form_vert_drift_1: "VERT-DRIFT-1",
    closed_form_uplift_1: "UPLIFT-1",
    reference_mockup_45_1_625: "MOCKUP-45-1.625",
    reference_mockup_201_1_125: "MOCKUP-201-1.125",
    reference_block_k1_sine: "BLOCK-K1-SINE",
    reference_block_k1_quake: "BLOCK-K1-QUAKE",
    reference_full_2dof_quake: "FULL-2DOF-QUAKE",
    reference_nonuniform_dt: "NONUNIFORM-DT",
    reference_huge_dt: "HUGE-DT",
    reference_double_cross: "DOUBLE-CROSS",
    reference_between_samples: "BETWEEN-SAMPLES",
    reference_chatter_thresh: "CHATTER-THRESH",
    reference_chatter_alt: "CHATTER-ALT",
    reference_chatter_osc: "CHATTER-OSC",
    closed_form_events_on_samples: "EVENTS-ON-SAMPLES",
    closed_form_plateau_at_threshold: "PLATEAU-AT-THRESHOLD",
    closed_form_zero_length_stick: "ZERO-LENGTH-STICK",
    closed_form_grazing_stop: "GRAZING-STOP",
    reference_plateaus: "PLATEAUS",
    reference_zero_mu: "ZERO-MU",
    reference_huge_mu: "HUGE-MU",
    closed_form_zero_record: "ZERO-RECORD",
    reference_tiny_m2: "TINY-M2",
    reference_tiny_m1: "TINY-M1",
    reference_stiff_k2: "STIFF-K2",
    reference_big_c1: "BIG-C1",
    reference_launch_k1: "LAUNCH-K1",
    reference_asym_mu_2dof: "ASYM-MU-2DOF",
    reference_jumps: "JUMPS",
    reference_free_run_out: "FREE-RUN-OUT",
    reference_storeys_2: "STOREYS-2",
    reference_storeys_3_quake: "STOREYS-3-QUAKE",
    reference_storeys_5: "STOREYS-5",
    reference_ampwin_45_1_625_a1_f1_625: "AMPWIN-45-1.625-A1-f1.625",
    reference_ampwin_45_1_625_a1_f1_73385: "AMPWIN-45-1.625-A1-f1.73385",
    reference_ampwin_45_1_625_a1_f0_577951: "AMPWIN-45-1.625-A1-f0.577951",
    reference_ampwin_45_1_625_a3_f1_73385: "AMPWIN-45-1.625-A3-f1.73385",
    reference_ampwin_201_1_125_a1_f1: "AMPWIN-201-1.125-A1-f1",
    reference_ampwin_201_2_687_a2_f2_984: "AMPWIN-201-2.687-A2-f2.984",
    reference_ampwin_201_1_125_a3_f1_43121: "AMPWIN-201-1.125-A3-f1.43121",
    reference_ampwin_45_1_625_a1_f1: "AMPWIN-45-1.625-A1-f1",
}
