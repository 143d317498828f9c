/** A study by its plan: its rows from several workers, and the ZIP that repeats it. */

import type { Pool } from "./desk";
import { hand } from "./exports";
import type { Sheet } from "./types";

/** What a study is of: its plan, the model's text, the names of the records that the plan may mean. */
export type Planned = [plan: string, text: string, names: string[]];

/** All rows of a study, in slices on several workers; `show` is told how many there are. */
export async function rowsOf(pool: Pool, of: Planned, show: (done: number, count: number) => void): Promise<Float64Array> {
  const [count, width] = await pool.call("studySize", ...of);
  const rows = new Float64Array(count * width);
  const size = Math.max(1, Math.min(250, Math.ceil(count / (8 * pool.size))));
  let done = 0;
  await pool.slices(count, size, async (helper, from, to) => {
    rows.set(await helper.call("studyRows", ...of, from, to), from * width);
    done += to - from;
    show(done, count);
  });
  return rows;
}

/** Hands over the plan with its model by the name that the plan calls it, and its records where it looks for them. */
export function handStudy(name: string, [plan, text]: Planned, sheet: Sheet, files: Map<string, Uint8Array>): void {
  const model = /^\s*model\s*=\s*"([^"]*)"/m.exec(plan)?.[1] ?? "model.toml";
  const bytes = (file: string) => files.get(file) ?? files.get(file.replace(/^.*[/\\]/, "")) ?? new Uint8Array();
  const records = Object.fromEntries(sheet.records.map(({ path, file }) => [path, bytes(file)]));
  hand(name, sheet.commands, [model, text], files, { "plan.toml": plan, ...records }, { "report.html": sheet.html }, "page/command.txt");
}
