/** The tabs over many runs, in their order. */

import { StudyTab } from "./study";
import { type Field, friction, planOf, SuiteTab } from "./suite";
import { SweepTab } from "./sweep";
import { type Page, type Tab, value } from "./tab";
import type { State } from "./types";

const span = (state: State) => `${Number((friction(state) * 0.4).toPrecision(2))}..${Number((friction(state) * 2).toPrecision(2))}`;

export function tabs(page: Page): { all: Tab[]; study: StudyTab } {
  const measure: Field = { name: "measure", label: "Intensity measure", value: () => "PGA", hint: "PGA, PGV, Sa(1.2 s), Sa_avg(0.5 s, 3 s), …" };
  const gap = (state: State) => value(state, "slider.gap")?.text ?? "150 mm";
  const bounds: Field = { name: "bounds", label: "Bounds of friction", value: () => "nominal", hint: "nominal, lower, upper or all" };
  const study = new StudyTab(page);
  const all: Tab[] = [
    new SweepTab(page),
    new SuiteTab(page, "spectrum", "Spectrum", "Fractiles of the demands over a parameter, as slipstick spectrum draws them.", [
      { name: "over", label: "Parameter along the axis", value: () => "isolator.period=1..5 s:30" },
      { name: "friction", label: "Kinetic friction of each group", value: (state) => [0.6, 1, 1.6].map((f) => Number((f * friction(state)).toPrecision(2))).join(", ") },
      measure,
      { name: "scale-to", label: "Records scaled to", value: () => "0.4 g" },
      bounds,
    ], planOf),
    new SuiteTab(page, "ida", "IDA", "Incremental dynamic analysis: demands over intensity, record by record.", [
      measure,
      { name: "scale-to", label: "Levels", value: () => "0.05..1.2 g:24" },
      { name: "demand", label: "Demand", value: () => "peak_sliding_displacement_m" },
      { name: "limit", label: "Limit on the demand", value: gap },
      bounds,
    ], planOf),
    new SuiteTab(page, "fragility", "Fragility", "The probability of passing a limit, fitted to an incremental dynamic analysis over friction.", [
      measure,
      { name: "scale-to", label: "Levels", value: () => "0.05..1.2 g:24" },
      { name: "friction", label: "Kinetic friction, a design each", value: (state) => `${span(state)}:9` },
      { name: "demand", label: "Demand", value: () => "peak_sliding_displacement_m" },
      { name: "limit", label: "Limit on the demand", value: gap },
      bounds,
    ], planOf),
    new SuiteTab(page, "design", "Design", "Friction and radius for a gap: the least floor acceleration that stays within it.", [
      { name: "friction", label: "Kinetic friction", value: (state) => `${span(state)}:20` },
      { name: "vary", label: "Parameter to vary", value: () => "slider.radius=1..5 m:12" },
      measure,
      { name: "scale-to", label: "Records scaled to", value: () => "0.4 g" },
      { name: "gap", label: "Gap", value: gap },
      { name: "probability", label: "Share of the records within it", value: () => "0.9" },
      { name: "sensitivity", label: "Sample points of the sensitivity", value: () => "0", hint: "0 for none" },
    ], planOf),
    study,
  ];
  return { all, study };
}
