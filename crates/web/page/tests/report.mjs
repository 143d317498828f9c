// Reports as a reviewer opens and prints them, that of a suite that a code is checked on and one of each kind.

import assert from "node:assert/strict";
import { copyFileSync, cpSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { ran, temporary } from "./harness.mjs";

/** Records in the longest suite. */
const MANY = 42;

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

const TANK = `name = "Tank on pendulums"
[block]
mass = "300 t"
[slider]
static_friction = 0.08
kinetic_friction = 0.06
radius = "2 m"
gap = "60 mm"
[[storey]]
mass = "120 t"
frequency = "1.6 Hz"
damping_ratio = 0.02
[motion]
`;

const SINE = 'sine = { frequency = "1.1 Hz", amplitude = "3 m/s2", duration = "6 s", dt = "0.01 s" }\n';

const PLAN = `name = "Tank"
model = "tank.toml"
[records]
files = ["records/*.txt"]
units = "g"
dt = "0.01 s"
measure = "PGA"
levels = ["0.2 g", "0.4 g"]
[vary]
"slider.radius" = { values = ["1.5 m", "2 m"] }
[sampling]
method = "grid"
`;

const ON = ["--records", "records/*.txt", "--units", "g", "--dt", "0.01 s"];
const TESTS = "laboratory/cyclic";

/** A report of each kind: its folder and what makes it, in this order. */
const KINDS = [
  ["run", "run", "taft.toml"],
  ["suite", "run", "tank.toml", ...ON, "--scale-to", "0.4 g"],
  ["many", "run", "bounds.toml", "--records", "many/*.txt", "--units", "g", "--dt", "0.01 s", "--scale-to", "0.4 g"],
  ["sweep", "spectrum", "wave.toml", "--over", "motion.sine.frequency=0.5..3Hz:12"],
  ["ida", "ida", "tank.toml", ...ON],
  ["fragility", "fragility", "ida"],
  ["spectrum", "spectrum", "tank.toml", ...ON, "--over", "slider.radius=1..3m:8"],
  ["design", "design", "tank.toml", ...ON, "--scale-to", "0.4 g", "--friction", "0.04..0.1:6", "--vary", "slider.radius=1..3m:4", "--gap", "200 mm", "--bounds", "0.8,1.3"],
  ["sensitivity", "sensitivity", "wave.toml"],
  ["study", "study", "plan.toml", "--report"],
  ["identify", "identify", "cyclic", `${TESTS}-0.1hz.csv`, `${TESTS}-0.25hz.csv`, `${TESTS}-1hz.csv`, "--mass", "124 kg"],
  ["compare", "compare", "laboratory/shaking-table.csv", "table.toml", "--mapping", "laboratory/sensors.toml"],
];

/** Writes a report of each kind; gives their names and addresses. */
async function ofEachKind(command, root, folder) {
  for (const name of ["records", "laboratory", "taft.toml"]) cpSync(join(root, "examples", name), join(folder, name), { recursive: true });
  writeFileSync(join(folder, "tank.toml"), `${TANK}record = "records/taft-021.txt"\nunits = "g"\ndt = "0.01 s"\n`);
  const own = readFileSync(join(folder, "tank.toml"), "utf8");
  writeFileSync(join(folder, "bounds.toml"), own.replace("gap =", "bounds = { lower = 0.8, upper = 1.3 }\ngap ="));
  mkdirSync(join(folder, "many"));
  const records = ["taft-021", "taft-111", "el-centro-180"].map((name) => join(root, "examples/records", `${name}.txt`));
  for (let i = 10; i < 10 + MANY; i++) copyFileSync(records[i % 3], join(folder, "many", `STATION_NAME_${i}-N.txt`));
  writeFileSync(join(folder, "wave.toml"), TANK + SINE);
  writeFileSync(join(folder, "plan.toml"), PLAN);
  writeFileSync(join(folder, "table.toml"), '[block]\nmass = "124 kg"\n[slider]\nstatic_friction = 0.165\nkinetic_friction = 0.153\n');
  const reports = [];
  for (const [name, ...words] of KINDS) {
    try {
      await ran(command, [...words, "-q", "--out", name], { cwd: folder });
    } catch (error) {
      // Status 1: an answer that says what it lacks.
      if (error.code !== 1) throw error;
    }
    reports.push([name, pathToFileURL(join(folder, name, "report.html")).href]);
  }
  return reports;
}

/** What of a printed page is broken: hashes of files that do not stand in one line. */
const broken = () => {
  const lines = (cell) => {
    const range = document.createRange();
    range.selectNodeContents(cell);
    return new Set([...range.getClientRects()].map(({ top }) => Math.round(top))).size;
  };
  return [...document.querySelectorAll("td.hash")].filter((cell) => lines(cell) > 1).map((cell) => cell.textContent);
};

/** Breaches of WCAG AA on a page. */
async function violations(page, axe) {
  await page.addScriptTag({ path: axe }).catch(async () => page.evaluate(readFileSync(axe, "utf8")));
  return page.evaluate(async () => {
    const result = await globalThis.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"] });
    return result.violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.target.join(" ")).slice(0, 4).join(", ")}`);
  });
}

/** How many sheets of A4 a page takes. */
async function printed(page) {
  const pdf = (await page.pdf({ format: "A4" })).toString("latin1");
  return pdf.match(/\/Type\s*\/Page\b/g)?.length ?? 0;
}

/** Brightness of a colour, 0 to 255. */
const brightness = (colour) => {
  const [r, g, b] = colour.match(/[\d.]+/g).map(Number);
  return 0.299 * r + 0.587 * g + 0.114 * b;
};

/** What of a page is light where it must be dark: its ground, and strokes and fills as dark as that. */
const colours = () => {
  const shown = [...document.querySelectorAll("figure svg path[stroke], figure svg text")].filter((of) => of.getClientRects().length > 0);
  const inks = shown.map((of) => (of.matches("text") ? getComputedStyle(of).fill : getComputedStyle(of).stroke)).filter((colour) => colour.startsWith("rgb"));
  return { ground: getComputedStyle(document.body).backgroundColor, inks: [...new Set(inks)] };
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
      assert.deepEqual(await violations(page, axe), []);
      assert.deepEqual(await page.evaluate(cut), [], "on the screen");
      // As wide as a sheet of A4 within its margins, at 96 dots an inch.
      await page.emulateMedia({ media: "print" });
      await page.setViewportSize({ width: 680, height: 1000 });
      assert.deepEqual(await page.evaluate(cut), [], "in print");
      assert.deepEqual(await page.evaluate(broken), [], "in print");
      const pages = await printed(page);
      assert.ok(pages >= 4 && pages <= PAGES, `${pages} pages`);
    } finally {
      await context.close();
      place.remove();
    }
  });

  test("reports of twelve kinds break no rule of WCAG AA, light and dark, and fit a phone", async () => {
    if (!command) return "skipped: SLIPSTICK_COMMAND names no command";
    const place = temporary();
    try {
      const reports = await ofEachKind(command, root, place.folder);
      for (const scheme of ["light", "dark"]) {
        const context = await browser().newContext({ viewport: { width: 1100, height: 900 }, colorScheme: scheme, bypassCSP: true });
        try {
          const page = await context.newPage();
          for (const [name, address] of reports) {
            const what = `${name}, ${scheme}`;
            await page.setViewportSize({ width: 1100, height: 900 });
            await page.goto(address);
            assert.deepEqual(await violations(page, axe), [], what);
            assert.deepEqual(await page.evaluate(cut), [], what);
            const { ground, inks } = await page.evaluate(colours);
            const light = scheme === "light";
            assert.equal(brightness(ground) > 200, light, `${what}: ${ground}`);
            // Lines and letters stand out from the ground; grid lines, the faintest, by 30 of 255.
            for (const ink of inks) assert.ok(Math.abs(brightness(ink) - brightness(ground)) > 30 || ink === ground, `${what}: ${ink} on ${ground}`);
            await page.setViewportSize({ width: 390, height: 844 });
            assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390, `${what}: the page scrolls sideways`);
            const first = await page.evaluate(() => {
              const shown = [...document.querySelector("figure").querySelectorAll(":scope > div")].filter((of) => of.clientWidth > 0);
              return shown.map((of) => of.scrollWidth - of.clientWidth);
            });
            assert.deepEqual(first, [0], `${what}: the first figure, once, without scrolling`);
            await page.emulateMedia({ media: "print" });
            assert.ok(brightness((await page.evaluate(colours)).ground) > 200, `${what}: paper is light`);
            if (light) {
              const pages = await printed(page);
              assert.ok(pages >= 1 && pages <= (name === "many" ? PAGES : 7), `${what}: ${pages} pages`);
            }
            await page.emulateMedia({ media: "screen" });
          }
        } finally {
          await context.close();
        }
      }
    } finally {
      place.remove();
    }
  });
}
