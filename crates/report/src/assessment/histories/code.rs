//! What a code asks of runs over a suite: demand beside capacity, the hand calculation, property factors.

use slipstick::assessment::code::PropertyFactors;
use slipstick::assessment::histories::ModelHistories;
use slipstick::assessment::histories::alone::ALONE;
use slipstick::assessment::lateral::{LEAST_TOTAL, LateralForce};
use slipstick::notice::{Notice, NoticeKind};
use slipstick::response::DemandColumn;

use super::{HistoriesReport, SHOWN};
use crate::assessment::sheet::{SheetTable, cell};
use crate::display::Quantity;

/// A figure of the equivalent lateral force: one description for JSON and the table.
pub(super) struct LateralFigure {
    /// Its key in JSON.
    pub key: &'static str,
    /// What the row of it is called, without the unit of a quantity.
    title: &'static str,
    shown: LateralUnit,
    /// In SI, with the total displacement over `D_M`.
    pub value: fn(&LateralForce, f64) -> f64,
}

/// How a figure is shown.
enum LateralUnit {
    /// In the unit of its quantity.
    Of(Quantity),
    /// As it is.
    Plain,
    /// A ratio in percent.
    Percent,
}

/// The displacements, then the isolators at them.
pub(super) const LATERAL: [LateralFigure; 6] = [
    LateralFigure {
        key: "displacement_m",
        title: "Displacement D_M",
        shown: LateralUnit::Of(Quantity::Length),
        value: |found, _| found.displacement_m,
    },
    LateralFigure {
        key: TOTAL,
        title: "1.15 D_M, the least D_TM",
        shown: LateralUnit::Of(Quantity::Length),
        value: |found, total| total * found.displacement_m,
    },
    LateralFigure {
        key: "stiffness_n_per_m",
        title: "Effective stiffness k_M",
        shown: LateralUnit::Of(Quantity::Stiffness),
        value: |found, _| found.stiffness_n_per_m,
    },
    LateralFigure {
        key: "damping_ratio",
        title: "Effective damping β_M (%)",
        shown: LateralUnit::Percent,
        value: |found, _| found.damping_ratio,
    },
    LateralFigure {
        key: "damping_factor",
        title: "Damping factor B_M",
        shown: LateralUnit::Plain,
        value: |found, _| found.damping_factor,
    },
    LateralFigure {
        key: "period_s",
        title: "Effective period T_M (s)",
        shown: LateralUnit::Plain,
        value: |found, _| found.period_s,
    },
];

/// The total displacement, whose row says how it follows from `D_M` where a plan tells it.
const TOTAL: &str = "total_displacement_m";
/// How many of them are displacements.
const DISPLACEMENTS: usize = 2;

/// Something that isolators, or what stands on them, can take.
struct Capacity {
    name: String,
    /// What is asked of it.
    demand: DemandColumn,
    /// How much of that it can take, where that is known; else the largest demand of all runs is shown.
    capacity: Option<f64>,
    /// The demand that says of a run whether it goes beyond, and from where on.
    beyond: (DemandColumn, f64),
    /// What the demand is multiplied by before it is compared: torsion.
    factor: f64,
}

impl HistoriesReport<'_> {
    /// What the isolators and what stands on them can take, beside what is asked of it, and how many runs go
    /// beyond; none for a model without gap, ends of travel, stop or contents.
    pub(super) fn capacity(&self, model: &ModelHistories) -> Option<SheetTable> {
        let statistic = format!("Demand, {}", model.statistic());
        let heads = ["", &statistic, "Friction", "Capacity", "Used (%)", "Runs beyond"];
        let place = self.histories.models.iter().position(|other| core::ptr::eq(other, model));
        let torsion = place.and_then(|place| self.torsion(place));
        let rows: Vec<Vec<String>> =
            capacities(model, torsion).iter().map(|of| self.capacity_row(model, of)).collect();
        let rows = core::iter::once(heads.map(str::to_owned).to_vec()).chain(rows);
        let rows: Vec<Vec<String>> = rows.collect();
        (rows.len() > 1).then(|| (self.of_model("Demand and capacity", model), rows))
    }

    fn capacity_row(&self, model: &ModelHistories, of: &Capacity) -> Vec<String> {
        let Capacity { name, demand, capacity, beyond: (counted, limit), factor } = of;
        let runs = |column: &DemandColumn| -> Vec<(usize, f64)> {
            let of = |bound| model.sizes(column, bound).into_iter().map(move |size| (bound, size));
            (0..model.bounds.len()).flat_map(of).filter(|(_, size)| !size.is_nan()).collect()
        };
        let largest = || runs(demand).into_iter().reduce(|a, b| if b.1 > a.1 { b } else { a });
        let governs = match capacity {
            Some(_) => model.governs(demand).map(|(bound, value)| (bound.name, value)),
            None => largest().map(|(bound, value)| (model.bounds[bound].name, value)),
        };
        let (bound, value) = governs.unwrap_or(("—", f64::NAN));
        let value = factor * value;
        let capacity = capacity.unwrap_or(f64::NAN);
        // Sliding displacements in the unit of the headline.
        let unit = match demand.name() == SHOWN[0] {
            true => self.unit_of(&self.peaks()),
            false => self.display.unit(demand.dimension().into(), value.max(capacity)),
        };
        let counted = runs(counted);
        let over = counted.iter().filter(|(_, size)| factor * size > *limit).count();
        vec![
            unit.label(name),
            cell(unit.of(value)),
            bound.to_owned(),
            cell(unit.of(capacity)),
            cell(100.0 * value / capacity),
            format!("{over} of {}", counted.len()),
        ]
    }

    /// A heading, with the name of the model where there are several.
    pub(super) fn of_model(&self, heading: &str, model: &ModelHistories) -> String {
        match self.histories.models.len() {
            1 => heading.to_owned(),
            _ => format!("{heading}, {}", model.name),
        }
    }

    /// Peak sliding displacements in two directions beside what each component says by itself, with the bound
    /// that governs: a row a pair, and the mean or the maximum of each column.
    pub(super) fn alone(&self, model: &ModelHistories) -> Option<(String, Vec<Vec<String>>)> {
        let peak = model.shape().find(SHOWN[0])?.1;
        let bound = model.governing_bound(&peak).filter(|_| model.is_in_plane())?;
        let unit = self.display.unit(Quantity::Length, model.governing(&peak, bound));
        let of = |values: [f64; 4]| values.map(|value| cell(unit.of(value)));
        let row = |name: &str, values: [f64; 4]| {
            core::iter::once(name.to_owned()).chain(of(values)).collect::<Vec<_>>()
        };
        let heads = ["Pair", "Both at once", "x alone", "y alone", "100 % + 30 %"];
        let mut rows = vec![heads.map(str::to_owned).to_vec()];
        for on in &model.records {
            let found = on.alone.get(bound).copied().flatten();
            let [x, y, combined] = ALONE.map(|(_, of)| found.map_or(f64::NAN, |alone| of(&alone)));
            rows.push(row(&on.record, [on.size(&peak, bound), x, y, combined]));
        }
        if model.records.len() > 1 {
            let [x, y, combined] = ALONE.map(|(_, of)| model.governing_alone(bound, of));
            let statistic = if model.statistic() == "mean" { "Mean" } else { "Maximum" };
            rows.push(row(statistic, [model.governing(&peak, bound), x, y, combined]));
        }
        let friction = match model.bounds.len() {
            1 => String::new(),
            _ => format!(", {} friction", model.bounds[bound].name),
        };
        let heading =
            format!("Peak sliding displacement, both components at once and alone{friction}");
        Some((unit.label(&self.of_model(&heading, model)), rows))
    }

    /// Where the equivalent-lateral-force displacement of a model passes what its isolators can take, with the
    /// bound by which it does so most.
    pub(super) fn passed(&self, model: &ModelHistories) -> Option<Notice> {
        let each = model.bounds.iter().zip(&model.lateral);
        let passed = each.filter_map(|(bound, found)| {
            let found = found.as_ref()?;
            Some((bound, found.displacement_m, found.passes?))
        });
        let (bound, displacement_m, (what, reach_m)) =
            passed.reduce(|a, b| if b.1 > a.1 { b } else { a })?;
        let unit = self.display.unit(Quantity::Length, displacement_m);
        let of_model = match self.histories.models.len() {
            1 => String::new(),
            _ => format!("{}: ", model.name),
        };
        let friction = match model.bounds.len() {
            1 => String::new(),
            _ => format!(" with {} friction", bound.name),
        };
        let message = format!(
            "{of_model}the displacement D_M = {} {} of the equivalent-lateral-force procedure{friction} exceeds the {what} \
             of {} {}: the isolators cannot take what the spectrum asks for, and k_M, T_M and D_M beyond it are of \
             isolators that could",
            cell(unit.of(displacement_m)),
            unit.symbol,
            cell(unit.of(reach_m)),
            unit.symbol
        );
        Some(Notice::new(NoticeKind::LateralBeyondTravel, message))
    }

    /// The total displacement over `D_M`.
    pub(super) fn total_over_displacement(&self) -> f64 {
        self.plan.map_or(LEAST_TOTAL, |plan| plan.total_over_displacement())
    }

    /// The equivalent-lateral-force displacement with each bound, beside that of the runs.
    pub(super) fn lateral(&self, model: &ModelHistories) -> Option<(String, Vec<Vec<String>>)> {
        let found = model.lateral.iter().flatten();
        let largest = found.clone().map(|found| found.displacement_m).reduce(f64::max)?;
        let stiffest = found.map(|found| found.stiffness_n_per_m).fold(0.0, f64::max);
        let length = self.display.unit(Quantity::Length, largest);
        let unit = |quantity: Quantity| match quantity {
            Quantity::Length => length,
            other => self.display.unit(other, stiffest),
        };
        let place = self.histories.models.iter().position(|other| core::ptr::eq(other, model));
        let torsion = place.and_then(|place| self.torsion(place));
        let total = self.total_over_displacement();
        let peak = model.shape().find(SHOWN[0])?.1;
        let runs = |bound: usize| model.governing(&peak, bound);
        let row = |name: String, value: &dyn Fn(&LateralForce, usize) -> f64| -> Vec<String> {
            let of = |(bound, found): (usize, &Option<LateralForce>)| {
                cell(found.map_or(f64::NAN, |found| value(&found, bound)))
            };
            core::iter::once(name).chain(model.lateral.iter().enumerate().map(of)).collect()
        };
        let figure = |figure: &LateralFigure| {
            let title = match self.plan {
                Some(_) if figure.key == TOTAL => {
                    format!("Total displacement D_TM = {} D_M", cell(total))
                }
                _ => figure.title.to_owned(),
            };
            let value = |found: &LateralForce| (figure.value)(found, total);
            match figure.shown {
                LateralUnit::Of(quantity) => {
                    let unit = unit(quantity);
                    row(unit.label(&title), &|found, _| unit.of(value(found)))
                }
                LateralUnit::Plain => row(title, &|found, _| value(found)),
                LateralUnit::Percent => row(title, &|found, _| 100.0 * value(found)),
            }
        };
        let heads = model.bounds.iter().map(|bound| bound.name.to_owned());
        let mut rows = vec![core::iter::once(String::new()).chain(heads).collect::<Vec<_>>()];
        let (displacements, isolators) = LATERAL.split_at(DISPLACEMENTS);
        rows.extend(isolators.iter().chain(displacements).map(figure));
        rows.extend(model.gap_m.map(|gap_m| {
            row("  of the gap (%)".to_owned(), &|found, _| {
                100.0 * total * found.displacement_m / gap_m
            })
        }));
        let of_runs = length.label(&format!("Runs, {}", model.statistic()));
        rows.push(row(of_runs, &|_, bound| length.of(runs(bound))));
        rows.extend(torsion.map(|torsion| {
            let name = length.label(&format!("  with torsion × {}", cell(torsion)));
            row(name, &|_, bound| length.of(torsion * runs(bound)))
        }));
        rows.push(row("  over D_M".to_owned(), &|found, bound| runs(bound) / found.displacement_m));
        let heading = format!("Equivalent lateral force{} beside the runs", self.at());
        Some((self.of_model(&heading, model), rows))
    }
}

/// What a model can take: its gap, to which torsion brings it nearer, the travel of its surfaces, its stop, its contents.
fn capacities(model: &ModelHistories, torsion: Option<f64>) -> Vec<Capacity> {
    let shape = model.shape();
    let of = |name: &str| Some(shape.find(name)?.1);
    let mut all = Vec::new();
    let mut add = |name: String, demand: &str, capacity, beyond: Option<DemandColumn>, limit| {
        if let (Some(demand), Some(beyond)) = (of(demand), beyond) {
            let factor = 1.0;
            all.push(Capacity { name, demand, capacity, beyond: (beyond, limit), factor });
        }
    };
    if let Some(gap_m) = model.gap_m {
        let name = torsion.map_or("Gap".to_owned(), |torsion| {
            format!("Gap, demand with torsion × {}", cell(torsion))
        });
        add(name, SHOWN[0], model.gap_m, of(SHOWN[0]), gap_m);
    }
    for (i, travel_m) in model.travels_m.iter().enumerate().filter(|(_, travel)| travel.is_some()) {
        let key = |key: &str| format!("surface{}_{key}", i + 1);
        let name = format!("Travel of surface {}", i + 1);
        add(name, &key("peak_displacement_m"), *travel_m, of(&key("end_reached")), 0.0);
    }
    for (name, demand, count) in [
        ("Stop struck: largest force", "stop.peak_force_n", "stop.contact_count"),
        ("Stop struck: fastest", "stop.peak_impact_speed_m_per_s", "stop.impact_count"),
    ] {
        let struck = of(count).filter(|column| {
            (0..model.bounds.len()).any(|i| model.sizes(column, i).iter().any(|n| *n > 0.0))
        });
        add(name.to_owned(), demand, None, struck, 0.0);
    }
    for part in 1..=shape.contents {
        let demand = format!("contents{part}_{}", SHOWN[0]);
        add(format!("Contents {part} slide: farthest"), &demand, None, of(&demand), 0.0);
    }
    if let (Some(_), Some(torsion), Some(gap)) = (model.gap_m, torsion, all.first_mut()) {
        gap.factor = torsion;
    }
    all
}

/// Which of the factors that are run are milder than the code takes without qualification tests.
pub(super) fn milder_than_code(factors: PropertyFactors) -> Option<Notice> {
    let (run, [least, most]) = (factors.bounds(), PropertyFactors::CODE_LIMITS);
    let lower =
        (run.lower > least).then(|| format!("the least, {}, is above {least:.2}", cell(run.lower)));
    let upper =
        (run.upper < most).then(|| format!("the largest, {}, is below {most:.2}", cell(run.upper)));
    let milder: Vec<String> = lower.into_iter().chain(upper).collect();
    (!milder.is_empty()).then(|| {
        let message = format!(
            "The products of property modification factors are milder than those of ASCE/SEI 7, section 17.2.8.4, \
             without qualification tests (at most {least:.2}, at least {most:.2}): {}. limits = {least}..{most} among \
             the factors applies the code's.",
            milder.join("; ")
        );
        Notice::new(NoticeKind::MildFactors, message)
    })
}

/// Property modification factors and their products.
pub(super) fn factor_table(factors: &PropertyFactors) -> SheetTable {
    let bounds = factors.bounds();
    let [least, most] = factors.products();
    let row =
        |(name, [least, most]): (&str, [f64; 2])| vec![name.to_owned(), cell(least), cell(most)];
    let rows = [
        ("λ_test: heating, speed, cycling", factors.test),
        ("λ_ae: aging and environment", factors.aging),
        ("λ_spec: tolerance of the specification", factors.specification),
        ("λ on friction, with 0.75 of aging", [least, most]),
    ];
    let limited = factors.limits.map(|limits| {
        let [least, most] = limits.map(cell);
        (format!("λ at most {least}, at least {most}: as run"), [bounds.lower, bounds.upper])
    });
    let heads = ["", "Least", "Largest"].map(str::to_owned).to_vec();
    let limited = limited.iter().map(|(name, factors)| row((name, *factors)));
    let rows = core::iter::once(heads).chain(rows.into_iter().map(row)).chain(limited).collect();
    ("Property modification factors".to_owned(), rows)
}
