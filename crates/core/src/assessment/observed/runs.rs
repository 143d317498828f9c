//! Data from single runs: counts at levels, first crossings, or a cloud.

use std::collections::{BTreeMap, HashMap};

use super::columns::{Columns, Records};
use super::intensity::Intensity;
use super::{Data, FitTo, FragilityRequest, rows};
use crate::assessment::censored::Known;
use crate::assessment::fragility::{Capacity, CloudPoint, Stripe};
use crate::assessment::ida::Curve;
use crate::assessment::{AssessmentError, refuse};
use crate::notice::{Notice, NoticeKind};
use crate::study::{Demanded, TRAVEL_USED_UP};

/// What single runs were made into, and why.
pub(super) struct OfRuns {
    pub(super) data: Data,
    /// The cluster of each of the data.
    pub(super) clusters: Option<Records>,
    pub(super) why: String,
}

/// The column in which an incremental dynamic analysis says how its levels were chosen.
const LEVEL_CHOICE: &str = "level_choice";

pub(super) fn of_runs(
    request: &FragilityRequest<'_>,
    columns: Columns<'_>,
    intensity: &Intensity,
    warnings: &mut Vec<Notice>,
) -> Result<OfRuns, AssessmentError> {
    if !columns.has(request.demand) {
        return Err(columns.lacking("demand", request.demand));
    }
    let Some(limit) = request.limit else {
        return Err(refuse("limit", "a limit on the demand, such as \"150 mm\"", "nothing"));
    };
    let levels = intensity.values(columns)?;
    let demands = demanded(columns, request.demand)?;
    let records = columns.records();
    let clusters = columns.clusters().map(|(_, clusters)| clusters);
    let hunted = columns.first_text(LEVEL_CHOICE).is_some_and(|choice| choice == "hunted");
    let (fit_to, why) = match (request.fit_to, hunted) {
        (Some(FitTo::Counts), true) => {
            let expected = "capacities: the levels of this table were hunted, each chosen by the \
                            answer at the one before";
            return Err(refuse("fit-to", expected, "counts"));
        }
        (Some(asked), _) => (asked, "as was asked for".to_owned()),
        (None, true) => (FitTo::Capacities, "the levels were hunted for each record".to_owned()),
        (None, false) => natural(&levels, records.as_ref()),
    };
    warnings.extend(without_answer(&demands, limit, fit_to));
    if fit_to == FitTo::Capacities {
        let Some(records) = records else { return Err(columns.lacking("fit-to", "record")) };
        let (capacities, row_of) = crossings(columns, &records, &levels, &demands, limit)?;
        let clusters = clusters.unwrap_or(records);
        let clusters = Records::numbered(row_of.iter().map(|&row| clusters.of_row[row]));
        return Ok(OfRuns { data: Data::Capacities(capacities), clusters: Some(clusters), why });
    }
    // A cloud takes what is known of a demand, counts what is known of the limit.
    let is_kept = |demand: &Demanded| match fit_to {
        FitTo::Cloud => *demand != Demanded::Unknown,
        _ => demand.exceeds(limit).is_some(),
    };
    let kept: Vec<usize> = (0..demands.len()).filter(|&row| is_kept(&demands[row])).collect();
    // A cluster of which no run is known is none.
    let of_kept =
        clusters.map(|clusters| Records::numbered(kept.iter().map(|&row| clusters.of_row[row])));
    if fit_to == FitTo::Counts {
        let cluster = |i: usize| of_kept.as_ref().map_or(0, |clusters| clusters.of_row[i]);
        let mut counts: BTreeMap<(u64, usize), Stripe> = BTreeMap::new();
        for (i, &row) in kept.iter().enumerate() {
            let level = levels[row];
            // Bits of numbers > 0 are in the order of the numbers.
            let stripe = counts.entry((level.to_bits(), cluster(i))).or_insert(Stripe {
                level,
                runs: 0,
                exceeded: 0,
            });
            stripe.runs += 1;
            stripe.exceeded += u64::from(demands[row].exceeds(limit) == Some(true));
        }
        let of_row = counts.keys().map(|(_, cluster)| *cluster).collect();
        let clusters = of_kept.map(|clusters| Records { of_row, count: clusters.count });
        let stripes = counts.into_values().collect();
        return Ok(OfRuns { data: Data::Stripes(stripes), clusters, why });
    }
    let floor = request.floor.unwrap_or(0.0);
    let mut points = Vec::with_capacity(kept.len());
    for &row in &kept {
        let level = levels[row];
        let (demand, is_bound) = match demands[row] {
            Demanded::AtLeast(reached) => (reached, true),
            known => (known.value(), false),
        };
        let (demand, known) = match request.cap {
            Some(cap) if demand > cap => (cap, Known::AtLeast),
            _ if is_bound => (demand, Known::AtLeast),
            _ if demand < floor => (floor, Known::AtMost),
            _ if demand == 0.0 => {
                let expected = "a floor for the runs in which nothing moves, such as \"1 mm\"";
                return Err(refuse("floor", expected, "a demand of 0, which has no logarithm"));
            }
            _ => (demand, Known::Exactly),
        };
        points.push(CloudPoint { level, demand, known });
    }
    Ok(OfRuns { data: Data::Cloud(points), clusters: of_kept, why })
}

/// What runs are best fitted to, and why: counts where every record was run at every level, first
/// crossings where each record has several levels of its own, else regression.
fn natural(levels: &[f64], records: Option<&Records>) -> (FitTo, String) {
    let Some(records) = records else {
        let mut runs: BTreeMap<u64, usize> = BTreeMap::new();
        for level in levels {
            *runs.entry(level.to_bits()).or_default() += 1;
        }
        return if runs.values().all(|runs| *runs >= 2) {
            (FitTo::Counts, "levels are shared".to_owned())
        } else {
            (FitTo::Cloud, "levels are not shared".to_owned())
        };
    };
    let mut at: HashMap<u64, Vec<bool>> = HashMap::new();
    for (level, &record) in levels.iter().zip(&records.of_row) {
        at.entry(level.to_bits()).or_insert_with(|| vec![false; records.count])[record] = true;
    }
    if records.count > 1 && at.values().all(|run| run.iter().all(|run| *run)) {
        return (FitTo::Counts, "every record was run at every level".to_owned());
    }
    let of_records: usize = at.values().map(|run| run.iter().filter(|run| **run).count()).sum();
    if of_records >= 2 * records.count {
        (FitTo::Capacities, "each record has levels of its own".to_owned())
    } else {
        (FitTo::Cloud, "the records were run at one level each".to_owned())
    }
}

/// The first crossing of each record's curve, for each design a curve, and a row of each.
fn crossings(
    columns: Columns<'_>,
    records: &Records,
    levels: &[f64],
    demands: &[Demanded],
    limit: f64,
) -> Result<(Vec<Capacity>, Vec<usize>), AssessmentError> {
    let (_, designs) = rows::designs(columns)?;
    let design = |row: usize| designs.as_ref().map_or(0, |designs| designs.of_row[row]);
    let channels = columns.table.texts_of("channel");
    let channel = |row: usize| channels.map_or("", |channels| &channels[row][..]);
    let key = |row: usize| (records.of_row[row], channel(row), design(row));
    let of_curve = Records::numbered((0..levels.len()).map(key));
    let mut curves = vec![Curve::default(); of_curve.count];
    let mut row_of = vec![0; of_curve.count];
    for (row, &curve) in of_curve.of_row.iter().enumerate() {
        curves[curve].insert(levels[row], demands[row]);
        row_of[curve] = row;
    }
    let known = |(curve, row): (&Curve, usize)| {
        let crossing = curve.first_crossing(limit);
        crossing.is_known().then(|| (crossing.capacity(), row))
    };
    Ok(curves.iter().zip(row_of).filter_map(known).unzip())
}

/// What runs say of a demand.
fn demanded(columns: Columns<'_>, demand: &str) -> Result<Vec<Demanded>, AssessmentError> {
    let sizes = columns.numbers_or_nan(demand)?.into_iter().map(f64::abs);
    let used_up = match columns.has(TRAVEL_USED_UP) {
        true => columns.numbers_or_nan(TRAVEL_USED_UP)?,
        false => vec![f64::NAN; sizes.len()],
    };
    let known = |travel_m: f64| (!travel_m.is_nan()).then_some(travel_m);
    let of = |(size, travel_m)| Demanded::of(demand, size, known(travel_m));
    let mut demands: Vec<Demanded> = sizes.zip(used_up).map(of).collect();
    // What the check does not confirm is no answer.
    for (demand, holds) in demands.iter_mut().zip(columns.holds().unwrap_or_default()) {
        *demand = if holds == 0.0 { Demanded::Unknown } else { *demand };
    }
    Ok(demands)
}

/// How many runs have no answer, and what they count as.
fn without_answer(demands: &[Demanded], limit: f64, fit_to: FitTo) -> Option<Notice> {
    let all = demands.len();
    let missing = demands.iter().filter(|demand| demand.value().is_nan()).count();
    if missing == 0 {
        return None;
    }
    let beyond = |demand: &&Demanded| match fit_to {
        FitTo::Cloud => matches!(demand, Demanded::AtLeast(_)),
        _ => matches!(demand, Demanded::AtLeast(_)) && demand.reaches(limit) == Some(true),
    };
    let beyond = demands.iter().filter(beyond).count();
    let left = missing - beyond;
    let message = match (beyond, left) {
        (0, _) => format!("{missing} of {all} runs have no demand and are left out"),
        (_, 0) => format!("{missing} of {all} runs used up their travel and count as beyond it"),
        _ => format!(
            "{missing} of {all} runs have no demand: {beyond} used up their travel and count as beyond it, \
             {left} are left out"
        ),
    };
    Some(Notice::new(NoticeKind::FailedRuns, message))
}

/// Counts of equal levels added up, by rising level.
pub(super) fn by_level(stripes: &[Stripe]) -> Vec<Stripe> {
    let mut levels: BTreeMap<u64, Stripe> = BTreeMap::new();
    for stripe in stripes {
        let of_level = levels.entry(stripe.level.to_bits()).or_insert(Stripe {
            level: stripe.level,
            runs: 0,
            exceeded: 0,
        });
        of_level.runs += stripe.runs;
        of_level.exceeded += stripe.exceeded;
    }
    levels.into_values().collect()
}
