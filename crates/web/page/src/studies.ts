/** The tabs over many runs, in their order. */

import { StudyTab } from "./study";
import { SuiteTab } from "./suite";
import { SweepTab } from "./sweep";
import type { Page, Tab } from "./tab";
import { Workbench } from "./workbench";

const SUITES = [["suite", "Suite"], ["spectrum", "Spectrum"], ["sensitivity", "Sensitivity"], ["ida", "IDA"], ["fragility", "Fragility"], ["design", "Design"]] as const;

export function tabs(page: Page): { all: Tab[]; study: StudyTab; leave: (names: string[]) => void } {
  const study = new StudyTab(page);
  const bench = new Workbench(page);
  const all: Tab[] = [new SweepTab(page), ...SUITES.map(([id, label]) => new SuiteTab(page, id, label, bench)), study];
  bench.onchoice = () => {
    for (const tab of all) tab.update?.();
    page.changed();
  };
  return { all, study, leave: (names) => bench.leave(names) };
}
