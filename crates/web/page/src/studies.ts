/** The tabs over many runs, in their order. */

import { StudyTab } from "./study";
import { SuiteTab } from "./suite";
import { SweepTab } from "./sweep";
import type { Page, Tab } from "./tab";

const SUITES = [["suite", "Suite"], ["spectrum", "Spectrum"], ["ida", "IDA"], ["fragility", "Fragility"], ["design", "Design"]] as const;

export function tabs(page: Page): { all: Tab[]; study: StudyTab } {
  const study = new StudyTab(page);
  return { all: [new SweepTab(page), ...SUITES.map(([id, label]) => new SuiteTab(page, id, label)), study], study };
}
