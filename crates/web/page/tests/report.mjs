// The report of a suite that a code is checked on, as a reviewer opens and prints it.

import assert from "node:assert/strict";
import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { ran, temporary } from "./harness.mjs";

/** Pairs in the suite, and the pages that they may take. */
const PAIRS = 11;
const PAGES = 12;

/** Samples of each record: its strongest part. A report is as long on fewer of them. */
const SAMPLES = [300, 950];

/** Writes the report of a building on many pairs under two hazards, which of the one pair at hand are copies. */
async function written(command, root, folder) {
  copyFileSync(join(root, "examples/hospital.toml"), join(folder, "hospital.toml"));
  const bounds = readFileSync(join(folder, "hospital.toml"), "utf8").replace("[frame]", "bounds = { lower = 0.6, upper = 1.8 }\n[frame]");
  writeFileSync(join(folder, "hospital.toml"), bounds);
  for (let i = 10; i < 10 + PAIRS; i++) {
    for (const [axis, name] of [["x", "taft-021.txt"], ["y", "taft-111.txt"]]) {
      const lines = readFileSync(join(root, "examples/records", name), "utf8").split("\n");
      writeFileSync(join(folder, `taft-${i}-${axis}.txt`), `${lines.slice(...SAMPLES).join("\n")}\n`);
    }
  }
  const on = ["--records", "*-x.txt", "--second", "*-y.txt", "--units", "g", "--dt", "0.01 s", "--scale-to", "0.4 g"];
  const code = ["--code", "asce7-22", "--code-values", "R = 4, I_e = 1.5", "--hazard", "MCE_R", "--hazard", "DE=0.6667"];
  const title = ["--project", "A building", "--author", "An engineer", "--date", "2026-01-01"];
  await ran(command, ["run", "hospital.toml", ...on, ...code, ...title, "-q", "--out", "out"], { cwd: folder });
  return pathToFileURL(join(folder, "out/report.html")).href;
}

/** What of a page is cut: wider than the sheet, or text that leaves its drawing. */
const cut = () => {
  const found = [];
  const width = document.documentElement.clientWidth + 1;
  for (const element of document.querySelectorAll("table, figure, h1, h2, h3, p, pre")) {
    if (element.getBoundingClientRect().right > width) found.push(`wide: ${element.textContent.trim().slice(0, 40)}`);
  }
  for (const svg of document.querySelectorAll("svg")) {
    const sheet = svg.getBoundingClientRect();
    for (const text of svg.querySelectorAll("text")) {
      const box = text.getBoundingClientRect();
      if (box.left < sheet.left - 1 || box.right > sheet.right + 1 || box.top < sheet.top - 1 || box.bottom > sheet.bottom + 1) found.push(`outside: ${text.textContent.slice(0, 40)}`);
    }
  }
  return found;
};

export function report(test, browser, axe, root) {
  const command = process.env.SLIPSTICK_COMMAND;

  test("the report of a suite breaks no rule of WCAG AA, and prints on few pages without a cut", async () => {
    if (!command) return "skipped: SLIPSTICK_COMMAND names no command";
    const place = temporary();
    const context = await browser().newContext({ viewport: { width: 1100, height: 900 }, bypassCSP: true });
    try {
      const page = await context.newPage();
      await page.goto(await written(command, root, place.folder));
      await page.addScriptTag({ path: axe }).catch(async () => page.evaluate(readFileSync(axe, "utf8")));
      const violations = await page.evaluate(async () => {
        const result = await globalThis.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"] });
        return result.violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.target.join(" ")).slice(0, 4).join(", ")}`);
      });
      assert.deepEqual(violations, []);
      assert.deepEqual(await page.evaluate(cut), [], "on the screen");
      // As wide as a sheet of A4 within its margins, at 96 dots an inch.
      await page.emulateMedia({ media: "print" });
      await page.setViewportSize({ width: 680, height: 1000 });
      assert.deepEqual(await page.evaluate(cut), [], "in print");
      const pdf = (await page.pdf({ format: "A4" })).toString("latin1");
      const pages = pdf.match(/\/Type\s*\/Page\b/g)?.length ?? 0;
      assert.ok(pages >= 4 && pages <= PAGES, `${pages} pages`);
    } finally {
      await context.close();
      place.remove();
    }
  });
}
