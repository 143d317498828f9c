// What leaves the page is what the command makes of the same: figures, reports, whole analyses.

import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { unzipSync } from "fflate";
import { drop, ran, settled, temporary } from "./harness.mjs";

const SINE = 'sine = { frequency = "1.1 Hz", amplitude = "3 m/s2", duration = "6 s", dt = "0.01 s" }';
const model = (name, slider, more = "", motion = SINE) => [name, `name = "${name}"\n[block]\nmass = "20 t"\n[slider]\n${slider}\n${more}\n[motion]\n${motion}\n[analysis]\ntail = "2 s"\n`];
const storey = '[[storey]]\nmass = "12 t"\nfrequency = "1.6 Hz"\ndamping_ratio = 0.02\n';
const two = 'static_friction = 0.08\nkinetic_friction = 0.06\n';
const pair = 'record = "records/taft-021.txt"\nrecord_y = "records/taft-111.txt"\nunits = "g"\ndt = "0.01 s"\nunits_y = "g"\ndt_y = "0.01 s"';

/** Devices, structures and directions: each a model of its own. */
const MODELS = [
  model("rigid", two),
  model("pendulum", `${two}radius = "2 m"\ngap = "150 mm"`, storey),
  model("spring and damper", `${two}spring = "300 kN/m"\ndamping_ratio = 0.05`, storey),
  model("bounds", `${two}radius = "2 m"\nbounds = { lower = 0.8, upper = 1.3 }`, storey),
  model("tilt and asymmetry", `${two}radius = "3 m"\ntilt = "2 mrad"\nasymmetry = 0.1`),
  model("rigid stop", `${two}radius = "2 m"\nstop = { gap = "30 mm", restitution = 0.4 }`, storey),
  model("friction of the speed", `static_friction = 0.08\nkinetic_friction = { slow = 0.03, fast = 0.08, rate = "50 s/m" }\nradius = "2 m"`, storey),
  model("contents", `${two}radius = "2 m"`, `${storey}[[contents]]\nfloor = 1\nmass = "200 kg"\nstatic_friction = 0.2\nkinetic_friction = 0.15\n`),
  model("frame", `${two}radius = "2 m"`, `${storey.replace('frequency = "1.6 Hz"', 'stiffness = "4 MN/m"').repeat(3)}`),
  model("two directions", `${two}radius = "2 m"`, "", pair),
];

/** Unpacks a download into a folder, and runs its commands there. */
async function repeated(got, command, folder) {
  for (const [name, bytes] of Object.entries(unzipSync(readFileSync(await got.path())))) {
    mkdirSync(dirname(join(folder, name)), { recursive: true });
    writeFileSync(join(folder, name), bytes);
  }
  const said = ["command.txt", "page/command.txt"].map((name) => join(folder, name)).find(existsSync);
  for (const line of readFileSync(said, "utf8").trim().split("\n")) {
    const words = line.split(" ").slice(1).join(" ");
    // The shell reads the quotes.
    await ran("/bin/sh", ["-c", `"$SLIPSTICK" ${words}`], { cwd: folder, env: { ...process.env, SLIPSTICK: command } });
  }
}

function same(folder, names) {
  for (const name of names) {
    assert.equal(readFileSync(join(folder, "page", name), "utf8"), readFileSync(join(folder, "out", name), "utf8"), name);
  }
}

/** That the report of a study is the command's, byte for byte but for the certificates of some runs, which only the command makes. */
function sameStudy(folder) {
  const report = readdirSync(join(folder, "out")).find((name) => name.endsWith(".html"));
  const told = (file) => readFileSync(file, "utf8").replace(/<li>(Certificates: |[^<]* run again alone)[^<]*<\/li>/g, "");
  assert.equal(told(join(folder, "page/report.html")), told(join(folder, "out", report)));
  return told(join(folder, "page/report.html"));
}

export function whole(test, on, root) {
  const command = process.env.SLIPSTICK_COMMAND;
  const skipped = "skipped: SLIPSTICK_COMMAND names no command";

  test("headline figures of ten models are the command's bits, devices and two directions among them", () =>
    on(async (page) => {
      if (!command) return skipped;
      const out = temporary();
      try {
        mkdirSync(join(out.folder, "records"));
        for (const name of ["taft-021.txt", "taft-111.txt"]) writeFileSync(join(out.folder, "records", name), readFileSync(join(root, "examples/records", name)));
        for (const [name, text] of MODELS) {
          writeFileSync(join(out.folder, "model.toml"), text);
          const there = JSON.parse(await ran(command, ["run", "model.toml", "--json", "-q"], { cwd: out.folder }));
          await drop(page, ["model.toml", text]);
          await page.evaluate(() => globalThis.dropped);
          await page.waitForFunction((name) => globalThis.slipstick.answer?.state.name === name, name);
          await settled(page);
          const here = await page.evaluate(() => globalThis.slipstick.answer.state.headline);
          assert.ok(here.peak_m > 0, `${name} slides`);
          for (const [own, key] of [["peak_m", "peak_sliding_displacement_m"], ["peakTime_s", "peak_sliding_displacement_time_s"], ["residual_m", "residual_sliding_displacement_m"], ["gapRatio", "gap_ratio"], ["slips", "slip_count"], ["baseShear", "base_shear_coefficient"]]) {
            assert.ok(key in there, key);
            assert.ok(Object.is(here[own], there[key]), `${name}: ${key} ${here[own]} here, ${there[key]} there`);
          }
          assert.ok(Object.is(here.block_m_per_s2, there.block.peak_acceleration_m_per_s2), `${name}: the block's acceleration`);
          assert.ok(Object.is(here.roof_m_per_s2, there.storeys.at(-1)?.peak_acceleration_m_per_s2 ?? null), `${name}: the roof's acceleration`);
        }
      } finally {
        out.remove();
      }
    }));

  test("the report in the ZIP is the command's, byte for byte, in the units of the page", () =>
    on(async (page) => {
      if (!command) return skipped;
      for (const units of ["si", "us"]) {
        await page.getByLabel("Units", { exact: true }).selectOption(units);
        await settled(page);
        await page.getByText("Export", { exact: true }).click();
        const [got] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Everything (ZIP)" }).first().click()]);
        const out = temporary();
        try {
          await repeated(got, command, out.folder);
          same(out.folder, ["report.html", "summary.json", "history.csv", "events.csv"]);
        } finally {
          out.remove();
        }
      }
    }, { acceptDownloads: true }));

  test("a dropped table of modes is used, and the ZIPs hold it: their commands make the same bytes", () =>
    on(async (page) => {
      if (!command) return skipped;
      const model = readFileSync(join(root, "examples/structures/building.toml"), "utf8").replace("../records/taft-021.txt", "records/taft-021.txt");
      await drop(page, ["building-modes.csv", readFileSync(join(root, "examples/structures/building-modes.csv"))], ["building.toml", model]);
      await page.evaluate(() => globalThis.dropped);
      await page.waitForFunction(() => globalThis.slipstick.answer?.state.name === "Building by its modes, Taft");
      await settled(page);
      assert.deepEqual(await page.evaluate(() => globalThis.slipstick.answer.state.structure.storeyNames), ["First", "Second", "Roof"]);
      const repeats = async (button, compared) => {
        const [got] = await Promise.all([page.waitForEvent("download"), button.click()]);
        const out = temporary();
        try {
          await repeated(got, command, out.folder);
          assert.equal(readFileSync(join(out.folder, "building-modes.csv"), "utf8"), readFileSync(join(root, "examples/structures/building-modes.csv"), "utf8"));
          compared(out.folder);
        } finally {
          out.remove();
        }
      };
      await page.getByText("Export", { exact: true }).click();
      await repeats(page.getByRole("button", { name: "Everything (ZIP)" }).first(), (folder) => same(folder, ["report.html", "summary.json", "history.csv", "events.csv"]));
      const analysed = async (id) => {
        const panel = page.locator(`#panel-${id}`);
        await panel.locator("button.main:not([disabled])").click();
        await panel.locator(".sheet").waitFor({ timeout: 90000 });
        return panel.getByRole("button", { name: "Everything (ZIP)" });
      };
      await page.locator("#tab-suite").click();
      await repeats(await analysed("suite"), (folder) => same(folder, ["report.html", "summary.json"]));
      await page.locator("#tab-study").click();
      const plan = page.locator("#panel-study textarea");
      await plan.fill((await plan.inputValue()).replace("count  = 64", "count  = 4"));
      await repeats(await analysed("study"), sameStudy);
    }, { acceptDownloads: true }));

  test("the same motion under two names is warned of, in the words of the command", () =>
    on(async (page) => {
      if (!command) return skipped;
      const rows = Array.from({ length: 800 }, (_, i) => `${(i * 0.01).toFixed(2)},${(3 * Math.sin(0.06 * i)).toFixed(6)}`);
      const columns = `time_s,acceleration_m_per_s2\n${rows.join("\n")}\n`;
      await drop(page, ["first.csv", columns], ["again.csv", columns]);
      await page.evaluate(() => globalThis.dropped);
      await page.locator("#tab-suite").click();
      const panel = page.locator("#panel-suite");
      await panel.locator("button.main:not([disabled])").click();
      await panel.locator(".sheet").waitFor({ timeout: 90000 });
      const said = "first.csv and again.csv are the same motion: it counts twice";
      assert.ok((await panel.locator(".sheet").innerText()).includes(said));
      const [got] = await Promise.all([page.waitForEvent("download"), panel.getByRole("button", { name: "Everything (ZIP)" }).click()]);
      const out = temporary();
      try {
        await repeated(got, command, out.folder);
        same(out.folder, ["summary.json", "report.html"]);
      } finally {
        out.remove();
      }
      // A study says it too.
      await page.locator("#tab-study").click();
      const plan = page.locator("#panel-study textarea");
      await plan.fill((await plan.inputValue()).replace('["*.txt"]', '["*.csv"]').replace(/^units.*\n|^dt .*\n/gm, ""));
      await page.locator("#panel-study button.main").click();
      await page.locator("#panel-study .sheet").waitFor({ timeout: 60000 });
      assert.ok((await page.locator("#panel-study .sheet").innerText()).includes("are the same motion: it counts twice"));
    }, { acceptDownloads: true }));

  for (const id of ["suite", "spectrum", "sensitivity", "ida", "fragility", "design"]) {
    test(`the ZIP of ${id} holds all that its command needs, which makes the same of it`, () =>
      on(async (page) => {
        if (!command) return skipped;
        // A file that says its units beside those that do not.
        await drop(page, ["own.AT2", readFileSync(join(root, "data/records/nga-west2.AT2"))]);
        await page.evaluate(() => globalThis.dropped);
        await settled(page);
        await page.locator(`#tab-${id}`).click();
        const panel = page.locator(`#panel-${id}`);
        await panel.locator("button.main:not([disabled])").click();
        await panel.locator(".sheet").waitFor({ timeout: 90000 });
        const [got] = await Promise.all([page.waitForEvent("download"), panel.getByRole("button", { name: "Everything (ZIP)" }).click()]);
        const out = temporary();
        try {
          await repeated(got, command, out.folder);
          same(out.folder, ["summary.json", "report.html"]);
        } finally {
          out.remove();
        }
      }, { acceptDownloads: true }));
  }

  test("the ZIP of study runs as it stands, and tells the same of the same files, warnings among it", () =>
    on(async (page) => {
      if (!command) return skipped;
      await page.getByLabel("Units", { exact: true }).selectOption("us");
      await settled(page);
      await page.locator("#tab-study").click();
      const panel = page.locator("#panel-study");
      const plan = panel.locator("textarea");
      await plan.fill((await plan.inputValue()).replace("count  = 64", "count  = 8"));
      await panel.locator("button.main").click();
      await panel.locator(".sheet").waitFor({ timeout: 90000 });
      const [got] = await Promise.all([page.waitForEvent("download"), panel.getByRole("button", { name: "Everything (ZIP)" }).click()]);
      const out = temporary();
      try {
        await repeated(got, command, out.folder);
        assert.match(sameStudy(out.folder), /the first of them run \d/);
      } finally {
        out.remove();
      }
    }, { acceptDownloads: true }));

  test("the ZIP of sweep is a study of the model's own motion, whose runs are those of the pictures", () =>
    on(async (page) => {
      if (!command) return skipped;
      await page.locator("#tab-sweep").click();
      const panel = page.locator("#panel-sweep");
      await panel.locator(".figure-plot svg").first().waitFor();
      await panel.getByLabel("Number of runs").fill("20");
      await panel.locator("button.main").click();
      await panel.locator(".progress").waitFor({ state: "hidden" });
      const [got] = await Promise.all([page.waitForEvent("download"), panel.getByRole("button", { name: "Everything (ZIP)" }).click()]);
      const out = temporary();
      try {
        await repeated(got, command, out.folder);
        assert.match(sameStudy(out.folder), /20 runs/);
        const of = ["plan.toml", "model.toml"].map((name) => readFileSync(join(out.folder, name), "utf8"));
        const [swept, studied] = await page.evaluate(async ([plan, text]) => {
          const { pool } = globalThis.slipstick.study;
          const rows = await pool.call("studyRows", plan, text, [], 0, 20);
          const { runs } = await pool.call("study", plan, text, [], rows, "si");
          const [from, to] = ["From", "To"].map((label) => [...document.querySelectorAll("#panel-sweep label")].find((one) => one.textContent === label).querySelector("input").value);
          const sweep = await pool.call("sweep", text, `slider.kinetic_friction=${from}..${to}:20`, 0, 20);
          pool.stop();
          return [[...sweep].filter((_, i) => i % 6 === 1), runs[0].columns.find(({ name }) => name === "peak_sliding_displacement_m").values];
        }, of);
        assert.deepEqual(studied, swept);
        assert.equal(new Set(swept).size, 20);
      } finally {
        out.remove();
      }
    }, { acceptDownloads: true }));

  test("a plan has as many runs as the analysis that the page shows, or says why there is none", () =>
    on(async (page) => {
      if (!command) return skipped;
      await page.locator("#tab-spectrum").click();
      const panel = page.locator("#panel-spectrum");
      await panel.locator("[name=over]").waitFor();
      await panel.locator("button.main:not([disabled])").click();
      await panel.locator(".sheet").waitFor({ timeout: 60000 });
      const runs = await page.evaluate(() => Number(/([\d ]+) runs/.exec(document.querySelector("#panel-spectrum .sheet").innerText)?.[1].replaceAll(" ", "")));
      const [got] = await Promise.all([page.waitForEvent("download"), panel.getByRole("button", { name: "Plan (TOML)" }).click()]);
      const out = temporary();
      try {
        writeFileSync(join(out.folder, "plan.toml"), readFileSync(await got.path()));
        writeFileSync(join(out.folder, "model.toml"), await page.evaluate(() => globalThis.slipstick.text));
        mkdirSync(join(out.folder, "records"));
        for (const name of ["taft-021.txt", "taft-111.txt", "el-centro-180.txt"]) writeFileSync(join(out.folder, "records", name), readFileSync(join(root, "examples/records", name)));
        const dry = await ran(command, ["study", "plan.toml", "--dry-run", "-q"], { cwd: out.folder });
        assert.equal(Number(/runs +([\d ,]+)/.exec(dry)[1].replaceAll(/[ ,]/g, "")), runs, dry);
      } finally {
        out.remove();
      }
      await page.locator("#tab-ida").click();
      const ida = page.locator("#panel-ida");
      await ida.locator("[name=measure]").waitFor();
      await ida.getByRole("button", { name: "Plan (TOML)" }).click();
      await page.waitForFunction(() => /the levels are hunted, record by record/.test(document.querySelector(".note-bar:not(.busy)").textContent));
    }, { acceptDownloads: true }));

  test("the animation leaves as a film", () =>
    on(async (page) => {
      await page.evaluate(() => {
        globalThis.slipstick.clock.zoom([4, 5.5]);
        globalThis.slipstick.stage.speed = 1;
      });
      await page.getByText("Export", { exact: true }).click();
      const [got] = await Promise.all([page.waitForEvent("download", { timeout: 20000 }), page.getByRole("button", { name: "Animation (film)" }).click()]);
      assert.equal(got.suggestedFilename(), "animation.webm");
      const bytes = readFileSync(await got.path());
      assert.equal(bytes.readUInt32BE(0), 0x1a45dfa3, "an EBML file");
      assert.ok(bytes.length > 10_000, `${bytes.length} bytes`);
      assert.ok(existsSync(await got.path()));
    }, { acceptDownloads: true }));
}
