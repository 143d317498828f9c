//! The keys of the `--json` object, which are a promise to other programs.

use serde::{Serialize, Serializer};
use slipstick::assessment::floors::{FloorSpectra, PlaceSpectra};
use slipstick::assessment::suite::Recorded;
use slipstick::motion::Figures;
use slipstick::notice::Notice;
use slipstick::response::{
    DEMANDS, Demand, DemandColumn, DemandKind, DemandOf, Demands, InDirections,
};

use slipstick::input::Names;
use slipstick::record::Origin;
use slipstick::study::{Certified, Worst};

use super::{ByAxis, Checks, Summary, method_name};
use crate::json::{Members, Scalar, each};
use crate::view;

/// `x`, `y`, `stop`, `surfaces`, `contents`, `iterations`, `floor_spectrum` and `bounds` only where there are any.
impl Serialize for Summary {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let Self { demands, names, .. } = self;
        let absent = self.by_axis.as_ref().map(|_| InDirections::Axis);
        let by_axis = self.by_axis.as_ref().map(|by_axis| {
            let ByAxis { peak_sliding_displacement_direction_rad, .. } = **by_axis;
            let axis = |i: usize| {
                view! {
                    record: figures(&by_axis.record[i]),
                    #[serde(flatten)] demands: axis_demands(&by_axis.demands[i], names),
                }
            };
            view! {
                peak_sliding_displacement_direction_rad,
                least_sliding_speed_m_per_s: by_axis.least_sliding_speed_m_per_s,
                x: axis(0),
                y: axis(1),
            }
        });
        let iterations = self.iterations.map(|found| {
            view! { iterations: view! { mean: found.mean, max: found.max } }
        });
        let floor_spectrum = self.floor_spectra.as_ref().map(|spectra| {
            view! { floor_spectrum: floor_spectrum(spectra) }
        });
        let bounds = self.bounds.as_ref().map(|bounds| {
            view! { bounds: view! { lower: &bounds.lower, upper: &bounds.upper } }
        });
        let motion_hash = self.motion_hash.as_ref();
        view! {
            slipstick: self.slipstick,
            model: &self.model,
            model_hash: &self.model_hash,
            method: method_name(self.method),
            samples: self.samples,
            dt_s: self.dt_s,
            duration_s: self.duration_s,
            friction_factor: self.friction_factor,
            record: view! {
                #[serde(flatten)] origin: origin(&self.origin),
                #[serde(flatten)] hash: motion_hash.map(|motion_hash| view! { motion_hash }),
                factor: self.record_factor,
                #[serde(flatten)] figures: figures(&self.record),
            },
            #[serde(flatten)] demands: self::demands(demands, names, |demand| {
                Some(demand.in_directions) != absent
            }),
            #[serde(flatten)] by_axis,
            contact_loss_s: &self.contact_loss_s,
            warnings: listed(&self.warnings, false),
            notes: listed(&self.warnings, true),
            checks: checks(&self.checks),
            #[serde(flatten)] iterations,
            #[serde(flatten)] floor_spectrum,
            #[serde(flatten)] bounds,
        }
        .serialize(to)
    }
}

fn figures(figures: &Figures) -> impl Serialize {
    view! {
        pga_m_per_s2: figures.pga_m_per_s2,
        pgv_m_per_s: figures.pgv_m_per_s,
        pgd_m: figures.pgd_m,
        end_velocity_m_per_s: figures.end_velocity_m_per_s,
    }
}

/// What a file says of where it was recorded.
fn origin(origin: &Origin) -> impl Serialize {
    let along_y = origin.along_y.as_ref();
    view! {
        event: &origin.event,
        station: &origin.station,
        component: &origin.component,
        azimuth_deg: origin.azimuth_deg,
        #[serde(flatten)] along_y: along_y.map(|y| {
            view! { component_y: &y.component, azimuth_y_deg: y.azimuth_deg }
        }),
    }
}

/// How many runs of an answer were certified, and which of them was the worst.
pub(crate) fn certified_keys(certified: &Certified) -> impl Serialize {
    view! {
        runs: certified.runs,
        certified: certified.certified,
        worst: certified.worst.as_ref().map(worst_keys),
        unconfirmed: each(&certified.unconfirmed, |of| view! { run: &of.run, what: &of.what }),
    }
}

/// The worst of certified runs: what it is called, the figure or demand, and its size.
#[must_use]
pub fn worst_keys(worst: &Worst) -> impl Serialize {
    view! { run: &worst.run, what: &worst.what, error: worst.error }
}

/// The records that an answer is of, each with what its file says and what reading it gave notice of.
pub(crate) fn suite(records: &[Recorded]) -> impl Serialize {
    each(records, |on| {
        view! {
            record: &on.name,
            #[serde(flatten)] origin: origin(&on.origin),
            #[serde(flatten)] hash: on.motion_hash.as_ref().map(|motion_hash| view! { motion_hash }),
            scale: on.factor,
            pga_m_per_s2: on.pga_m_per_s2,
            notices: each(&on.notices, warning),
        }
    })
}

fn floor_spectrum(spectra: &FloorSpectra) -> impl Serialize {
    let axes = spectra.axes.as_ref().map(|[x, y]| {
        view! { x: place_spectra(x), y: place_spectra(y) }
    });
    view! {
        damping_ratio: spectra.damping_ratio,
        period_s: &spectra.periods_s,
        #[serde(flatten)] sa: place_spectra(&spectra.sa),
        #[serde(flatten)] axes,
    }
}

fn place_spectra(sa: &PlaceSpectra) -> impl Serialize {
    view! {
        table_acceleration_m_per_s2: &sa.table_m_per_s2,
        block_acceleration_m_per_s2: &sa.block_m_per_s2,
        storeys_acceleration_m_per_s2: &sa.storeys_m_per_s2,
    }
}

/// Demands as members of an object, and of objects and lists in it.
#[derive(Serialize)]
#[serde(untagged)]
enum Entry<'a> {
    Value(Scalar<'a>),
    Object(Members<Scalar<'a>>),
    List(Vec<Members<Scalar<'a>>>),
}

/// Those of an axis, without what is of neither.
fn axis_demands<'a>(demands: &Demands, names: &'a Names) -> Members<Entry<'a>> {
    let Members(mut all) = self::demands(demands, names, |_| true);
    let of_resultant = |key: &str| {
        let of = |demand: &&Demand| demand.key == key && demand.of == DemandOf::Run;
        let demand = DEMANDS.iter().find(of);
        demand.is_some_and(|demand| demand.in_directions == InDirections::Resultant)
    };
    all.retain(|(key, _)| !of_resultant(key));
    Members(all)
}

/// The demands in the order of the registry; `block.x` is `x` in the object `block`. Block and storeys
/// have their names, where the model gives them; what has no value here is null.
fn demands<'a>(
    demands: &Demands,
    names: &'a Names,
    has_value: impl Fn(&Demand) -> bool,
) -> Members<Entry<'a>> {
    let named = |name: &'a String| ("name", Scalar::Text(name));
    let value = |column: DemandColumn| {
        let value = column.value(demands).filter(|_| has_value(column.demand));
        scalar(column.demand.kind, value)
    };
    let of_part = |of: DemandOf, part: usize| {
        let own = DEMANDS.iter().filter(|demand| demand.of == of);
        let own = own.map(|demand| (demand.key, value(DemandColumn { demand, part })));
        let storey = names.storeys.get(part - 1).filter(|_| of == DemandOf::Storey);
        let point = names.points.get(part - 1).filter(|_| of == DemandOf::Point);
        let name = storey.and_then(Option::as_ref).or(point).map(named);
        Members(name.into_iter().chain(own).collect())
    };
    let mut keys: Vec<(&'static str, Entry<'a>)> = Vec::new();
    for demand in DEMANDS.iter().filter(|demand| demand.in_summary) {
        if let Some(list) = demand.of.list() {
            let count = match demand.of {
                DemandOf::Surface => demands.surfaces.len(),
                DemandOf::Contents => demands.contents.len(),
                DemandOf::Point => demands.points.len(),
                _ => demands.storeys.len(),
            };
            // Only storeys are listed where there are none.
            let wanted = count > 0 || demand.of == DemandOf::Storey;
            if wanted && !keys.iter().any(|(key, _)| *key == list) {
                let parts = (1..=count).map(|part| of_part(demand.of, part));
                keys.push((list, Entry::List(parts.collect())));
            }
            continue;
        }
        if demand.of == DemandOf::Stop && demands.stop.is_none() {
            continue;
        }
        let value = value(DemandColumn { demand, part: 0 });
        match (demand.key.split_once('.'), keys.last_mut()) {
            (None, _) => keys.push((demand.key, Entry::Value(value))),
            (Some((group, key)), Some((last, Entry::Object(Members(members)))))
                if *last == group =>
            {
                members.push((key, value));
            }
            (Some((group, key)), _) => {
                let name = names.block.as_ref().filter(|_| group == "block").map(named);
                let members = name.into_iter().chain([(key, value)]).collect();
                keys.push((group, Entry::Object(Members(members))));
            }
        }
    }
    Members(keys)
}

fn scalar(kind: DemandKind, value: Option<f64>) -> Scalar<'static> {
    match (kind, value) {
        (DemandKind::Count, Some(value)) => Scalar::Count(value as u64),
        (DemandKind::Flag, Some(value)) => Scalar::Flag(Some(value != 0.0)),
        (_, value) => Scalar::Number(value),
    }
}

/// The warnings among some, or the notes.
pub(crate) fn listed(all: &[Notice], notes: bool) -> impl Serialize {
    each(all.iter().filter(|warning| warning.is_note() == notes), warning)
}

fn warning(warning: &Notice) -> impl Serialize {
    view! {
        kind: warning.kind.name(),
        severity: warning.severity().name(),
        time_s: warning.time_s,
        message: &warning.message,
    }
}

fn checks(checks: &Checks) -> impl Serialize {
    view! {
        equilibrium_residual: checks.equilibrium_residual,
        friction_excess: checks.friction_excess,
        energy_balance_error: checks.energy_balance_error,
        demands_error: checks.demands_error,
        closest_call: checks.closest_call.map(|call| {
            view! {
                margin: call.margin,
                time_s: call.time_s,
                kind: call.kind.name(),
                interface: call.interface_name(),
            }
        }),
        bound: checks.bound,
        holds: checks.holds,
    }
}
