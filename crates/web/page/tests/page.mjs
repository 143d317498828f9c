// The page as a person uses it: `node tests/page.mjs FOLDER [NAME|NAME…]`, parts of the names of tests. The last line counts.

import assert from "node:assert/strict";
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { unzipSync } from "fflate";
import { compare } from "./compare.mjs";
import { figures } from "./figures.mjs";
import { field, setField, slider } from "./fields.mjs";
import { minute } from "./minute.mjs";
import { scenes } from "./scenes.mjs";
import { MOVING, browser, drop, headline, host, message, open, ran, settled, temporary } from "./harness.mjs";
import { loading } from "./loading.mjs";
import { report } from "./report.mjs";
import { runs } from "./runs.mjs";
import { state } from "./state.mjs";
import { whole } from "./whole.mjs";

const folder = resolve(process.argv[2]);
const only = process.argv[3];
const root = resolve(dirname(fileURLToPath(import.meta.url)), "../../../..");
const axe = createRequire(import.meta.url).resolve("axe-core/axe.min.js");
const site = await host(folder);
let chromium = await browser();
const shots = join(folder, "../web-pictures");
mkdirSync(shots, { recursive: true });

/** Tests whose times are told at the end. */
const SLOWEST = 12;

/** The longest that a test may take, in s; as many sequences as are asked for take their time. */
const LONGEST_S = process.env.SLIPSTICK_SEQUENCES ? 40_000 : 240;

const tests = [];
const test = (name, run) => tests.push([name, run]);

/** A page of its own, on which nothing may go wrong. */
async function on(run, options, url = site.url) {
  const opened = await open(chromium, url, options);
  try {
    const skipped = await run(opened.page, opened);
    assert.deepEqual(opened.said, [], "said on the console");
    assert.deepEqual(opened.outside, [], "asked of others");
    return skipped;
  } finally {
    await opened.close();
  }
}

test("the first picture shows the Taft example, moving and checked", () =>
  on(async (page) => {
    const [peak] = await headline(page);
    assert.match(peak, /^6\d\.\d+\s*mm$/);
    assert.match(await page.locator(".results .certificate").innerText(), /Computed right/);
    const time = () => page.evaluate(() => globalThis.slipstick.time);
    const before = await time();
    await page.waitForTimeout(300);
    assert.ok((await time()) > before, "it moves");
    const painted = await page.evaluate(() => {
      const canvas = document.querySelector("canvas.scene");
      const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
      const colours = new Set();
      for (let i = 0; i < data.length; i += 4) colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
      return colours.size;
    });
    assert.ok(painted > 6, `${painted} colours`);
  }, MOVING));

test("a slider that is dragged is followed, and checked when it rests", () =>
  on(async (page) => {
    const box = await slider(page, "Kinetic friction").boundingBox();
    const before = await page.evaluate(() => globalThis.slipstick.updates);
    await page.mouse.move(box.x + box.width * 0.17, box.y + box.height / 2);
    await page.mouse.down();
    for (let i = 0; i <= 30; i++) {
      await page.mouse.move(box.x + box.width * (0.17 + 0.01 * i), box.y + box.height / 2);
      const [judged, said] = await page.evaluate(() => [!!globalThis.slipstick.judgement, document.querySelector(".results .certificate").textContent]);
      assert.match(said, judged ? /^Computed right/ : /^Not yet checked/);
    }
    await page.mouse.up();
    await settled(page);
    const after = await page.evaluate(() => globalThis.slipstick.updates);
    assert.ok(after - before > 5, `${after - before} updates`);
    // Static friction went along, and the text says both.
    const text = await page.locator("#model-text").inputValue();
    const [, s] = /static_friction\s*=\s*([\d.]+)/.exec(text);
    const [, k] = /kinetic_friction\s*=\s*([\d.]+)/.exec(text);
    assert.ok(Number(k) > 0.12 && s === k, text);
    assert.match(text, /# A building of one storey/, "comments stay");
    assert.match(await page.locator(".results .certificate").innerText(), /Computed right/);
  }, MOVING));

test("what is shown is what the text says, in every field", () =>
  on(async (page) => {
    await setField(page, "Radius of the pendulum", "120 in");
    await settled(page);
    assert.match(await page.locator("#model-text").inputValue(), /radius = "120 in"/);
    await setField(page, "Radius of the pendulum", "3");
    await settled(page);
    assert.match(await page.locator("#model-text").inputValue(), /radius = "3 in"/);
    await page.getByLabel("Restoring force").selectOption("spring");
    await settled(page);
    const text = await page.locator("#model-text").inputValue();
    assert.ok(/spring = "/.test(text) && !/radius/.test(text), text);
    await page.getByLabel("Table moves by").selectOption("sine");
    await settled(page);
    assert.match(await page.locator("#model-text").inputValue(), /\[motion\]\nsine = \{/);
    await page.getByLabel("Table moves by").selectOption("record:records/el-centro-180.txt");
    await settled(page);
    assert.match(await page.locator("#model-text").inputValue(), /record = "records\/el-centro-180.txt"/);
  }));

test("units: the same motion in three systems", () =>
  on(async (page) => {
    for (const [system, unit] of [["us", "in"], ["kN-mm", "mm"], ["si-g", "mm"], ["si", "mm"]]) {
      await page.getByLabel("Units", { exact: true }).selectOption(system);
      await settled(page);
      assert.match((await headline(page))[0], new RegExp(`${unit}$`));
    }
    await page.getByLabel("Units", { exact: true }).selectOption("us");
    await settled(page);
    await setField(page, "Gap", "5");
    await settled(page);
    assert.match(await page.locator("#model-text").inputValue(), /gap\s+= "5 in"/);
  }));

test("history, summary and events are those of the command, digit by digit", () =>
  on(async (page) => {
    const command = process.env.SLIPSTICK_COMMAND;
    if (!command) return "skipped: SLIPSTICK_COMMAND names no command";
    const out = temporary();
    try {
      for (const name of ["taft", "el-centro", "frame-pendulum"]) {
        const model = join(root, "examples", `${name}.toml`);
        await ran(command, ["run", model, "-q", "--out", out.folder]);
        await drop(page, [`${name}.toml`, readFileSync(model)]);
        await page.evaluate(() => globalThis.dropped);
        await settled(page);
        for (const file of ["history.csv", "events.csv", "summary.json"]) {
          const here = await page.evaluate((file) => globalThis.slipstick.desk.files([file], () => "").then(({ files }) => files[0]), file);
          const there = readFileSync(join(out.folder, file), "utf8");
          assert.ok(here === there, `${name}: ${file} differs from the command's`);
        }
      }
    } finally {
      out.remove();
    }
  }));

test("every format that is read can be dropped", () =>
  on(async (page) => {
    const records = join(root, "data/records");
    const taken = [];
    for (const name of readdirSync(records).filter((name) => name !== "README.md")) {
      await drop(page, [name, readFileSync(join(records, name))]);
      const dialog = page.locator("dialog");
      await page.evaluate(() => {
        const { dropped } = globalThis;
        globalThis.over = false;
        void dropped.then(() => (globalThis.over = globalThis.dropped === dropped));
      });
      // It asks, or it is done.
      const ended = () => page.waitForFunction(() => (globalThis.over ? "over" : document.querySelector("dialog[open]") && !document.querySelector("dialog[aria-busy]") ? "asks" : undefined), null, { polling: 20 }).then((said) => said.jsonValue()).then((said) => said === "over");
      for (let round = 0; round < 4 && !(await ended()); round++) {
        const units = dialog.locator("input[name=units]");
        if (await units.isVisible()) await units.fill(/counts/.test(await dialog.innerText()) ? "1e-5 m/s2" : "g");
        const dt = dialog.locator("input[name=dt]");
        if ((await dt.isVisible()) && /time step/.test(await dialog.locator(".fault").innerText())) await dt.fill("0.01 s");
        await dialog.getByRole("button", { name: "Use it" }).click();
      }
      if (await dialog.count()) await dialog.getByRole("button", { name: "Leave it" }).click();
      const text = await page.locator("#model-text").inputValue();
      if (text.includes(JSON.stringify(name))) taken.push(name);
      else assert.match(await message(page), new RegExp(name.replaceAll(".", "\\.")), name);
    }
    console.log(`    ${taken.length} records taken`);
    for (const ending of ["AT2", "V1", "V2c", "smc", "m0a", "v1", "EW", "ASC", "acc", "asa", "dat", "V1A", "mseed", "sac", "csv", "txt"]) {
      assert.ok(taken.some((name) => name.endsWith(`.${ending}`)), `a record .${ending}`);
    }
  }));

test("bad input is one message, and the last good state stays", () =>
  on(async (page) => {
    const before = await headline(page);
    const stays = async (why, pattern) => {
      await page.locator(".note-bar:not(.busy)").waitFor();
      assert.match(await message(page), pattern, why);
      assert.deepEqual(await headline(page), before, why);
      await page.evaluate(() => (document.querySelector(".note-bar").hidden = true));
    };
    const dropped = async (name, data) => {
      await drop(page, [name, data]);
      await page.evaluate(() => globalThis.dropped);
    };
    const noise = Buffer.from(Array.from({ length: 5000 }, (_, i) => (i * 7919 + (i >> 3) * 104729) & 255));
    await dropped("noise.bin", noise);
    await stays("binary garbage", /noise\.bin.*expected/);
    await dropped("empty.txt", "");
    await stays("an empty file", /empty\.txt.*expected.*found/);
    await page.evaluate(() => void (globalThis.dropped = globalThis.slipstick.intake.files([new File([new Uint8Array(2e8)], "large.txt")])));
    await page.evaluate(() => globalThis.dropped);
    await stays("200 MB", /large\.txt: expected a file of at most 128 MiB, found 191 MiB/);
    await page.evaluate(() => void (globalThis.dropped = globalThis.slipstick.intake.files([new File(["0.1\n".repeat(1e7)], "long.txt")])));
    const dialog = page.locator("dialog");
    await dialog.waitFor({ timeout: 30000 });
    await dialog.locator("input[name=units]").fill("g");
    await dialog.locator("input[name=dt]").fill("0.01 s");
    await dialog.getByRole("button", { name: "Use it" }).click();
    await page.waitForFunction(() => /at most 1000000 samples/.test(document.querySelector("dialog .fault")?.textContent ?? ""), null, { timeout: 30000 });
    await dialog.getByRole("button", { name: "Leave it" }).click();
    await page.evaluate(() => globalThis.dropped);
    assert.deepEqual(await headline(page), before);

    await dropped("model.toml", noise);
    await stays("a model that is no text", /model\.toml.*expected text in UTF-8/);
    const good = await page.locator("#model-text").inputValue();
    await page.locator("#model-text").fill(good.replace("kinetic_friction", "kinetic_fricton"));
    await stays("a wrong key", /model\.toml:\d+:\d+:.*kinetic_fricton.*nearest is "kinetic_friction"|model\.toml:\d+:\d+:.*expected/s);
    assert.equal(await page.locator("#model-text").getAttribute("aria-invalid"), "true");
    await page.locator("#model-text").fill(good);
    await settled(page);
    assert.ok(!(await page.locator(".note-bar:not(.busy)").isVisible()), "a good text clears the message");

    await dropped("plan.toml", 'model = "m.toml"\n[records]\nfiles = ["far-field/*.AT2"]\nscale = [1.0]\n');
    await page.locator("#panel-study .fault").waitFor();
    assert.match(await page.locator("#panel-study .fault").innerText(), /plan\.toml:3:\d+: records\.files: expected the plan's records.*found no file for "far-field/);
  }));

test("a plan of pairs with vertical motions runs", () =>
  on(async (page) => {
    const csv = (of) => "time_s,acceleration_m_per_s2\n" + Array.from({ length: 400 }, (_, i) => `${(i * 0.01).toFixed(2)},${of(i * 0.01)}\n`).join("");
    const dropped = async (...files) => {
      await drop(page, ...files);
      await page.evaluate(() => globalThis.dropped);
    };
    await drop(page, ["h1.csv", csv((t) => 2 * Math.sin(6 * t))], ["h2.csv", csv((t) => 3 * Math.sin(5 * t))], ["up.csv", csv((t) => Math.sin(9 * t))]);
    // By its name one of them is vertical.
    await page.locator("dialog").getByRole("button", { name: "Keep it beside" }).click();
    await page.evaluate(() => globalThis.dropped);
    const plan = (up) => `model = "m.toml"\n[records]\nfiles = ["h1.csv"]\nsecond = ["h2.csv"]\nvertical = [${up}]\nscale = [1.0, 2.0]\n`;
    await dropped(["plan.toml", plan('"up.csv", "up.csv"')]);
    await page.locator("#panel-study .fault").waitFor();
    assert.match(await page.locator("#panel-study .fault").innerText(), /plan\.toml:5:\d+: records\.vertical: expected one vertical motion for each of 1 records, found 2/);
    await dropped(["plan.toml", plan('"up.csv"')]);
    await page.waitForFunction(() => /h1\.csv/.test(document.querySelector("#panel-study")?.textContent ?? ""), null, { timeout: 20000 });
    assert.equal(await page.locator("#panel-study .fault").count(), 0);
  }));

const sine = (amplitude) => `time_s,acceleration_m_per_s2\n${Array.from({ length: 400 }, (_, i) => `${(i * 0.01).toFixed(2)},${(amplitude * Math.sin(i * 0.06)).toFixed(6)}\n`).join("")}`;

async function dropped(page, ...files) {
  await drop(page, ...files);
  await page.evaluate(() => globalThis.dropped);
  await settled(page);
}

test("a dropped record moves the table as it was recorded, under its own name", () =>
  on(async (page) => {
    await dropped(page, ["own.csv", sine(3)]);
    const text = await page.locator("#model-text").inputValue();
    assert.match(text, /\[motion\]\nrecord = "own.csv"\n(?!scale)/);
    assert.match(text, /^name = "One storey on sliders, own.csv"/m);
    assert.match(await page.locator(".brand span").innerText(), /own\.csv$/);
    await page.getByLabel("Table moves by").selectOption("record:records/el-centro-180.txt");
    await settled(page);
    assert.match(await page.locator("#model-text").inputValue(), /^name = "One storey on sliders, El Centro 1940, 180°"/m);
  }));

test("another file of the same name and length is another record, in every run", () =>
  on(async (page) => {
    const peakOfSweep = async () => {
      await page.locator("#tab-sweep").click();
      await page.locator("#panel-sweep button.main:not([disabled])").waitFor();
      await page.locator("#panel-sweep .result > .out-of-date").waitFor({ state: "hidden" });
      const peak = await page.evaluate(async () => {
        const app = globalThis.slipstick;
        const rows = await app.study.pool.call("sweep", app.text, "slider.kinetic_friction=0.04..0.05:2", 0, 1);
        return rows[1];
      });
      await page.locator("#tab-motion").click();
      return peak;
    };
    await dropped(page, ["own.csv", sine(3)]);
    const first = await peakOfSweep();
    await dropped(page, ["own.csv", sine(4)]);
    assert.ok((await peakOfSweep()) > 1.05 * first);
  }));

test("a result is greyed where model, records or settings are others, and no longer once they are back", () =>
  on(async (page) => {
    await page.locator("#tab-suite").click();
    await page.locator("#panel-suite button.main").click();
    await page.locator("#panel-suite .sheet").waitFor({ timeout: 60000 });
    const note = page.locator("#panel-suite .result > .out-of-date");
    assert.ok(!(await note.isVisible()), "it is of what stands there");
    await page.locator("#tab-motion").click();
    await setField(page, "Kinetic friction", "0.03");
    await settled(page);
    await page.locator("#tab-suite").click();
    assert.match(await note.innerText(), /^Out of date/);
    assert.equal(await page.locator("#panel-suite .stale .sheet").count(), 1);
    await page.getByRole("button", { name: "Undo" }).click();
    await settled(page);
    await note.waitFor({ state: "hidden" });
    await page.locator("#panel-suite input[type=checkbox]").last().click();
    assert.ok(await note.isVisible(), "another choice of records");
    await page.locator("#panel-suite input[type=checkbox]").last().click();
    await note.waitFor({ state: "hidden" });
  }));

test("the certificate is of the computation, and what forbids the figures stands with them", () =>
  on(async (page) => {
    assert.ok(!(await page.locator(".severe").isVisible()));
    await setField(page, "Gap", "20 mm");
    await settled(page);
    assert.match(await page.locator(".severe").innerText(), /gap exceeded.*past its gap of 20 mm/);
    assert.match(await page.locator(".results .certificate").innerText(), /^Computed right/);
    const good = await page.locator("#model-text").inputValue();
    await page.locator("#model-text").fill(good.replace("kinetic_friction", "kinetic_fricton"));
    await page.waitForFunction(() => /Of the last good state/.test(document.querySelector(".results .certificate").textContent));
    await page.locator("#model-text").fill(good);
    await settled(page);
    assert.match(await page.locator(".results .certificate").innerText(), /^Computed right/);
  }));

test("a coefficient that goes along comes back, and all is undone", () =>
  on(async (page) => {
    const coefficients = async () => {
      const text = await page.locator("#model-text").inputValue();
      return ["static", "kinetic"].map((kind) => Number(new RegExp(`${kind}_friction\\s*=\\s*([\\d.]+)`).exec(text)[1]));
    };
    const before = await coefficients();
    const box = await slider(page, "Kinetic friction").boundingBox();
    const to = async (share) => page.mouse.move(box.x + box.width * share, box.y + box.height / 2, { steps: 8 });
    await to(before[1] / 0.3);
    await page.mouse.down();
    await to(0.7);
    await settled(page);
    const [s, k] = await coefficients();
    assert.ok(k > 0.15 && s === k, `${s} ${k}`);
    await to(before[1] / 0.3);
    await page.mouse.up();
    await settled(page);
    const back = await coefficients();
    assert.equal(back[0], before[0], "static friction is where it was");
    assert.ok(Math.abs(back[1] - before[1]) < 0.01);
    await setField(page, "Kinetic friction", "0.02");
    await settled(page);
    await page.getByRole("button", { name: "Undo" }).click();
    await settled(page);
    assert.deepEqual(await coefficients(), back);
    await page.getByRole("button", { name: "Redo" }).click();
    await settled(page);
    assert.equal((await coefficients())[1], 0.02);
    await page.locator("main").focus();
    await page.keyboard.press("Control+z");
    await settled(page);
    assert.deepEqual(await coefficients(), back);
    await page.getByRole("button", { name: "Reset" }).click();
    await settled(page);
    assert.deepEqual(await coefficients(), before);
  }));

test("a link restores the tab with its settings, records and all", () =>
  on(async (page, { context }) => {
    await page.locator("#tab-ida").click();
    await page.locator("#panel-ida").getByText("More", { exact: true }).click();
    const limit = page.locator("#panel-ida [name=limit]");
    await limit.fill("33 mm");
    await limit.blur();
    await page.locator("#panel-ida .workbench tbody input").last().click();
    await page.waitForTimeout(300);
    const other = await context.newPage();
    await other.goto(page.url());
    await settled(other);
    assert.equal(await other.locator("#tab-ida").getAttribute("aria-selected"), "true");
    await other.waitForFunction(() => document.querySelector("#panel-ida [name=limit]")?.value === "33 mm");
    const ticked = await other.locator("#panel-ida .workbench tbody input").evaluateAll((all) => all.map((box) => box.checked));
    assert.deepEqual(ticked, [true, true, false]);
    await other.close();
  }));

test("a link of an earlier version says settings by the words of then", () =>
  on(async (page, { context }) => {
    await page.locator("#tab-design").click();
    await page.waitForFunction(() => location.hash.startsWith("#v1."));
    for (const [tab, name, formerly, text] of [["design", "friction-factors", "bounds", "0.9,1.2"], ["sensitivity", "vary", "paths", "slider.kinetic_friction"]]) {
      const fragment = await page.evaluate(async ([tab, formerly, text]) => {
        const through = async (bytes, by) => new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(by)).arrayBuffer());
        const packed = Uint8Array.from(atob(location.hash.slice(4).replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
        const now = JSON.parse(new TextDecoder().decode(await through(packed, new DecompressionStream("deflate-raw"))));
        const bytes = await through(JSON.stringify({ ...now, tab, settings: { [formerly]: text } }), new CompressionStream("deflate-raw"));
        return `#v1.${btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
      }, [tab, formerly, text]);
      const other = await context.newPage();
      await other.goto(new URL(fragment, page.url()).href);
      await settled(other);
      await other.waitForFunction(([tab, name, text]) => document.querySelector(`#panel-${tab} [name=${name}]`)?.value === text, [tab, name, text]);
      await other.close();
    }
  }));

test("a link of more than a megabyte is refused", () =>
  on(async (page) => {
    const fragment = await page.evaluate(async () => {
      const text = JSON.stringify({ text: " ".repeat(4e7) });
      const packed = new Uint8Array(await new Response(new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"))).arrayBuffer());
      let binary = "";
      for (const byte of packed) binary += String.fromCharCode(byte);
      return `#v1.${btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
    });
    await page.evaluate((fragment) => (location.hash = fragment), fragment);
    await page.waitForFunction(() => /too large/.test(document.querySelector(".note-bar:not(.busy)").textContent));
  }));

test("two components: the way of the block from above, turned by a slider, with the command's figures", () =>
  on(async (page) => {
    assert.ok(!(await page.locator(".plan").isVisible()));
    await page.getByText("Examples", { exact: true }).click();
    await page.getByRole("button", { name: "Pendulum, Taft, two components" }).click();
    await settled(page);
    assert.ok(await page.locator(".plan").isVisible());
    assert.match(await page.locator(".results .certificate").innerText(), /^Computed right/);
    const first = await headline(page);
    await setField(page, "Turn of the pair, x towards y", "45 deg");
    await settled(page);
    assert.match(await page.locator("#model-text").inputValue(), /rotate = "45 deg"/);
    assert.notDeepEqual(await headline(page), first);
    const command = process.env.SLIPSTICK_COMMAND;
    if (command) {
      const out = temporary();
      try {
        await ran(command, ["run", join(root, "examples/taft-two-directions.toml"), "--set", "motion.rotate=45 deg", "-q", "--out", out.folder]);
        const here = await page.evaluate(() => globalThis.slipstick.desk.files(["history.csv"], () => "").then(({ files }) => files[0]));
        assert.ok(here === readFileSync(join(out.folder, "history.csv"), "utf8"), "history.csv differs from the command's");
      } finally {
        out.remove();
      }
    }
    await page.waitForTimeout(300);
    await page.screenshot({ path: join(shots, "two-directions.png") });
  }));

test("a value that cannot be is marked where it was written, and is right again with a good one", () =>
  on(async (page) => {
    const gap = field(page, "Gap");
    const before = await headline(page);
    await setField(page, "Gap", "5 kg");
    await page.waitForFunction(() => document.querySelector(".control input[aria-invalid]"));
    assert.equal(await gap.getAttribute("aria-invalid"), "true");
    assert.equal(await gap.inputValue(), "5 kg");
    assert.match(await gap.getAttribute("title"), /expected a length/);
    assert.deepEqual(await headline(page), before);
    await setField(page, "Gap", "90 mm");
    await settled(page);
    assert.equal(await gap.getAttribute("aria-invalid"), null);
  }));

test("a ZIP has model and records, and the command makes the same bytes of them", () =>
  on(async (page) => {
    const command = process.env.SLIPSTICK_COMMAND;
    if (!command) return "skipped: SLIPSTICK_COMMAND names no command";
    await dropped(page, ["own.csv", sine(3)]);
    await page.getByText("Export", { exact: true }).click();
    const [got] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Everything (ZIP)" }).click()]);
    const out = temporary();
    try {
      for (const [name, bytes] of Object.entries(unzipSync(readFileSync(await got.path())))) {
        mkdirSync(dirname(join(out.folder, name)), { recursive: true });
        writeFileSync(join(out.folder, name), bytes);
      }
      const [, ...words] = readFileSync(join(out.folder, "command.txt"), "utf8").trim().split(" ");
      await ran(command, [...words, "-q"], { cwd: out.folder });
      for (const name of ["summary.json", "history.csv", "events.csv"]) {
        assert.equal(readFileSync(join(out.folder, "out", name), "utf8"), readFileSync(join(out.folder, "page", name), "utf8"), name);
      }
    } finally {
      out.remove();
    }
  }, { acceptDownloads: true }));

test("half an address is one message that stays, and the example is shown", () =>
  on(
    async (page) => {
      await page.waitForTimeout(500);
      assert.ok(await page.locator(".note-bar:not(.busy)").isVisible());
      assert.match(await message(page), /the address: expected an address that this page made/);
      assert.match((await headline(page))[0], /mm$/);
      await page.getByRole("button", { name: "Close" }).click();
      assert.ok(!(await page.locator(".note-bar:not(.busy)").isVisible()));
    },
    {},
    `${site.url}#v1.7VPLbtswEPwVg2cXlm`,
  ));

test("text that people wrote is never markup", () =>
  on(async (page) => {
    const evil = '<img src=x onerror="globalThis.hacked=1">';
    const text = (await page.locator("#model-text").inputValue()).replace(/^name = .*$/m, `name = ${JSON.stringify(evil)}`);
    await drop(page, ["model.toml", text], [`${evil.slice(0, 20)}.txt`, "x"]);
    await page.evaluate(() => globalThis.dropped);
    await settled(page);
    assert.equal(await page.locator(".brand span").innerText(), evil);
    await page.waitForTimeout(1200);
    assert.equal(await page.evaluate(() => globalThis.hacked), undefined);
    assert.equal(await page.locator("img[src=x]").count(), 0);
  }));

test("an address holds the state, and Back undoes", () =>
  on(async (page, { context }) => {
    const start = await headline(page);
    await page.waitForFunction(() => location.hash.startsWith("#v1."));
    await setField(page, "Kinetic friction", "0.03");
    await settled(page);
    const changed = await headline(page);
    assert.notDeepEqual(changed, start);
    await page.waitForTimeout(150);
    const other = await context.newPage();
    await other.goto(page.url());
    await settled(other);
    assert.deepEqual(await headline(other), changed);
    await other.close();
    await page.goBack();
    await page.waitForFunction((text) => document.querySelector(".headline dd").innerText === text, start[0]);
    assert.deepEqual(await headline(page), start);
    await page.goForward();
    await page.waitForFunction((text) => document.querySelector(".headline dd").innerText === text, changed[0]);
  }));

test("an address asks for a record of one's own, by name and hash", () =>
  on(async (page, { context }) => {
    const own = readFileSync(join(root, "data/records/nga-west2.AT2"), "utf8");
    await drop(page, ["own.AT2", own]);
    await page.evaluate(() => globalThis.dropped);
    await settled(page);
    const shown = await headline(page);
    await page.waitForTimeout(300);
    const other = await context.newPage();
    await other.goto(page.url());
    await other.locator(".note-bar:not(.busy)").waitFor();
    assert.match(await message(other), /^This link needs the file own\.AT2: choose it, or drop it on the page\./);
    await drop(other, ["own.AT2", own.replace(/1/, "2")]);
    await other.evaluate(() => globalThis.dropped);
    assert.match(await message(other), /own\.AT2: expected the file of the address, with the SHA-256/);
    // By its hash it is known under another name.
    await drop(other, ["own (1).AT2", own]);
    await other.evaluate(() => globalThis.dropped);
    await settled(other);
    assert.deepEqual(await headline(other), shown);
    assert.equal(await other.locator("#model-text").inputValue(), await page.locator("#model-text").inputValue());
    await other.close();
  }));

test("a model asks for its record, which is chosen by a button and read as the model says", () =>
  on(async (page) => {
    const model = readFileSync(join(root, "examples/taft.toml"), "utf8").replace("records/taft-111.txt", "records/ARL360.at2").replace(/^scale_to.*$/m, 'scale_to = "0.2 g"');
    await drop(page, ["model.toml", model]);
    await page.evaluate(() => globalThis.dropped);
    await page.getByRole("button", { name: "Choose ARL360.at2…" }).waitFor();
    assert.match(await message(page), /^This model needs the file ARL360\.at2: choose it/);
    assert.ok(await page.locator(".stage.behind").count(), "what is shown is of the model before");
    const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.getByRole("button", { name: "Choose ARL360.at2…" }).click()]);
    const numbers = readFileSync(join(root, "examples/records/taft-021.txt"));
    await chooser.setFiles([{ name: "downloaded.txt", mimeType: "text/plain", buffer: numbers }]);
    await settled(page);
    assert.match(await page.locator("#model-text").inputValue(), /record\s*= "records\/ARL360\.at2"\n[^]*scale_to = "0\.2 g"/);
    assert.equal(await page.locator(".behind").count(), 0);
  }));

test("a motion that is vertical alone is asked about; of several channels those of acceleration are offered, a horizontal one first", () =>
  on(async (page) => {
    const dialog = page.locator("dialog");
    const text = await page.locator("#model-text").inputValue();
    const dropped = async (name) => drop(page, [name, readFileSync(join(root, "data/records", name))]);
    await dropped("kiknet.UD2");
    await dialog.getByText("is vertical").waitFor();
    await dialog.getByRole("button", { name: "Keep it beside" }).click();
    await page.evaluate(() => globalThis.dropped);
    assert.equal(await page.locator("#model-text").inputValue(), text, "the table moves as before");
    assert.match(await page.locator(".records").innerText(), /kiknet\.UD2/);
    await dropped("kiknet.UD2");
    await dialog.getByRole("button", { name: "Use it" }).click();
    await page.evaluate(() => globalThis.dropped);
    await settled(page);
    assert.match(await page.locator("#model-text").inputValue(), /record = "kiknet\.UD2"/);
    await dropped("geonet.V2A");
    await dialog.locator("select[name=channel]").waitFor();
    const offered = await dialog.locator("select[name=channel] option").allTextContents();
    assert.ok(offered.length > 0 && offered.every((one) => /acceleration/.test(one)), String(offered));
    const chosen = await dialog.locator("select[name=channel]").evaluate((select) => select.selectedOptions[0].textContent);
    assert.ok(!/vertical/.test(chosen), chosen);
    await dialog.getByRole("button", { name: "Leave it" }).click();
  }));

test("two files of one name that come together are two records", () =>
  on(async (page) => {
    await drop(page, ["x.csv", sine(1)], ["x.csv", sine(2)]);
    await page.evaluate(() => globalThis.dropped);
    const rows = page.locator("#panel-suite .workbench tbody tr");
    await rows.nth(4).waitFor();
    assert.deepEqual(await rows.locator("th").allInnerTexts().then((all) => all.slice(-2)), ["x.csv", "x (2).csv"]);
  }));

test("a check that is stopped leaves figures, text and link of one model, and is made when asked for", () =>
  on(async (page) => {
    await page.evaluate(() => {
      const { desk } = globalThis.slipstick;
      // As "Start another" does, before the check is made.
      const hear = desk.onanswer;
      desk.onanswer = (answered) => {
        hear(answered);
        desk.onanswer = hear;
        desk.helper.end();
        void desk.helper.start();
      };
      desk.set([["slider.kinetic_friction", "0.031"]]);
    });
    await page.locator(".results .certificate", { hasText: "Not checked" }).waitFor();
    assert.equal(await page.locator(".stage.behind").count(), 0);
    await page.getByRole("button", { name: "Check it" }).click();
    await settled(page);
    assert.match(await page.locator(".results .certificate").innerText(), /^Computed right/);
    assert.match(await page.locator("#model-text").inputValue(), /kinetic_friction = 0\.031/);
  }));

test("a silent worker is shown as busy and can be replaced", () =>
  on(async (page) => {
    const before = await headline(page);
    await page.evaluate(() => void globalThis.slipstick.desk.helper.call("wait", 60000).catch(() => {}));
    await page.locator(".note-bar.busy").waitFor({ timeout: 4000 });
    assert.deepEqual(await headline(page), before);
    await page.getByRole("button", { name: "Start another" }).click();
    assert.equal(await page.locator(".behind").count(), 0, "what is shown stays, and is what is wanted");
    await setField(page, "Kinetic friction", "0.04");
    await settled(page);
    assert.notDeepEqual(await headline(page), before);
  }));

test("a trap ends its worker only", () =>
  on(async (page) => {
    const before = await headline(page);
    const said = await page.evaluate(() => globalThis.slipstick.desk.helper.call("trap").catch((error) => error.message));
    assert.match(said, /ended unexpectedly/);
    assert.deepEqual(await headline(page), before);
    await setField(page, "Kinetic friction", "0.04");
    await settled(page);
    assert.notDeepEqual(await headline(page), before);
  }, MOVING));

test("a sweep runs in slices, and can be cancelled", () =>
  on(async (page) => {
    await page.locator("#tab-sweep").click();
    await page.locator("#panel-sweep .figure-plot svg").first().waitFor();
    assert.equal(await page.locator("#panel-sweep .plot").count(), 2);
    await page.getByLabel("Number of runs").fill("50000");
    await page.locator("#panel-sweep button.main").click();
    await page.locator("#panel-sweep .progress").waitFor();
    await page.locator("#panel-sweep").getByRole("button", { name: "Cancel" }).click();
    await page.locator("#panel-sweep .progress").waitFor({ state: "hidden" });
    await page.getByLabel("Number of runs").fill("40");
    await page.locator("#panel-sweep button.main").click();
    await page.locator("#panel-sweep .progress").waitFor({ state: "hidden" });
    const box = await page.locator("#panel-sweep .figure-plot svg").first().boundingBox();
    await page.mouse.click(box.x + box.width * 0.5, box.y + box.height / 2);
    await page.waitForFunction(() => !/kinetic_friction = 0.050/.test(document.querySelector("#model-text").value));
  }));

test("a study runs in slices on further workers, and can be cancelled", () =>
  on(async (page) => {
    const same = await page.evaluate(async () => {
      const app = globalThis.slipstick;
      const { helper } = app.desk;
      const of = [document.querySelector("#panel-study textarea").value, app.text, [...app.desk.records.keys()]];
      const [count, width] = await helper.call("studySize", ...of);
      const whole = await helper.call("studyRows", ...of, 0, count);
      const parts = [];
      for (let from = count; from > 0; from -= 37) {
        const first = Math.max(0, from - 37);
        parts.unshift(...(await helper.call("studyRows", ...of, first, from)));
      }
      return count > 300 && whole.length === count * width && whole.every((number, i) => Object.is(number, parts[i]));
    });
    assert.ok(same, "the slices of a study are its rows");
    await page.locator("#tab-study").click();
    const plan = page.locator("#panel-study textarea");
    const text = await plan.inputValue();
    await plan.fill(text.replace("count  = 64", "count  = 16384"));
    await page.locator("#panel-study button.main").click();
    await page.waitForFunction(() => /of 294912 runs/.test(document.querySelector("#panel-study .progress").textContent));
    // The page is free meanwhile.
    await page.locator("#tab-motion").click();
    await setField(page, "Kinetic friction", "0.04");
    await settled(page);
    await page.locator("#tab-study").click();
    assert.ok(await page.locator("#panel-study .progress").isVisible(), "it is still at work");
    await page.locator("#panel-study").getByRole("button", { name: "Cancel" }).click();
    await page.locator("#panel-study .progress").waitFor({ state: "hidden" });
    assert.equal(await page.locator("#panel-study .sheet").count(), 0);
    await plan.fill(text);
    await page.locator("#panel-study button.main").click();
    await page.locator("#panel-study .sheet").waitFor({ timeout: 60000 });
  }));

test("fragility takes the bounds of friction apart", () =>
  on(async (page) => {
    await page.locator("#tab-fragility").click();
    await page.locator("#panel-fragility select[name=bounds]").selectOption("all");
    await page.locator("#panel-fragility button.main").click();
    await page.locator("#panel-fragility .sheet").waitFor({ timeout: 60000 });
    const said = await page.locator("#panel-fragility .sheet").innerText();
    for (const bound of ["lower", "nominal", "upper"]) assert.match(said, new RegExp(bound));
  }));

test("contents are added key by key, and the text says them", () =>
  on(async (page) => {
    await page.evaluate(() => globalThis.slipstick.desk.set([["contents.1.floor", "1"], ["contents.1.mass", "20 kg"], ["contents.1.static_friction", "0.3"], ["contents.1.kinetic_friction", "0.25"]]));
    await settled(page);
    const text = await page.locator("#model-text").inputValue();
    assert.match(text, /\[\[contents\]\]\nfloor = 1\nmass = "20 kg"\nstatic_friction = 0.3\nkinetic_friction = 0.25\n/);
    assert.match(text, /# A building of one storey/, "comments stay");
  }));

test("a form is the table of fields, and its errors name them", () =>
  on(async (page) => {
    await page.locator("#tab-spectrum").click();
    const panel = page.locator("#panel-spectrum");
    await panel.locator("[name=over]").waitFor();
    const names = await panel.locator("label.field [name]").evaluateAll((all) => all.map((one) => one.name).sort());
    assert.deepEqual(names, ["bounds", "demand", "friction", "measure", "over", "scale", "scale-to", "vary"]);
    assert.equal(await panel.locator("[name=over]").inputValue(), "isolator.period=1..5s:40");
    const [plan] = await Promise.all([page.waitForEvent("download"), panel.getByRole("button", { name: "Plan (TOML)" }).click()]);
    const text = readFileSync(await plan.path(), "utf8");
    assert.match(text, /\nmeasure = "PGA"\nlevels = \["3\.92266.* m\/s2"\]\n\n\[vary\]\n"slider\.radius" = \{ values = \["0\.24/);
    await panel.locator("[name=scale-to]").fill("0.4 m");
    await panel.locator("button.main").click();
    await panel.locator(".fault").waitFor();
    assert.match(await panel.locator(".fault").innerText(), /^Scale to: expected an acceleration/);
  }, { acceptDownloads: true }));

for (const [id, heading] of [["suite", /response histories/i], ["spectrum", /sliding spectra/i], ["ida", /incremental dynamic/i], ["fragility", /fragility/i], ["design", /design/i], ["study", /study/i]]) {
  test(`${id} runs over the records, as the command draws it`, () =>
    on(async (page) => {
      await page.locator(`#tab-${id}`).click();
      await page.locator(`#panel-${id} button.main`).click();
      await page.locator(`#panel-${id} .sheet`).waitFor({ timeout: 60000 });
      assert.match(await page.locator(`#panel-${id} .sheet h2`).innerText(), heading);
      const drawn = page.locator(`#panel-${id} .sheet .figure-plot svg[role]`).first();
      await drawn.waitFor();
      assert.ok(await drawn.evaluate((svg) => svg.clientWidth > 100 && svg.querySelectorAll("path").length > 2));
      await page.screenshot({ path: join(shots, `tab-${id}.png`), fullPage: true });
    }));
}

test("all files out", () =>
  on(async (page) => {
    for (const [label, name] of [
      ["Model (TOML)", "model.toml"],
      ["History (CSV)", "history.csv"],
      ["Events (CSV)", "events.csv"],
      ["Summary (JSON)", "summary.json"],
      ["Report (HTML)", "report.html"],
      ["Animation as it stands (PNG)", "animation.png"],
      ["Figures (SVG)", "sliding-displacement.svg"],
      ["Figures (PNG)", "sliding-displacement.png"],
    ]) {
      await page.getByText("Export", { exact: true }).click();
      const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: label, exact: true }).click()]);
      assert.equal(download.suggestedFilename(), name);
      await page.waitForTimeout(400);
    }
  }, { acceptDownloads: true }));

test("everything is done by keyboard", () =>
  on(async (page) => {
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement.className), "skip");
    const seen = new Set();
    for (let i = 0; i < 60; i++) {
      await page.keyboard.press("Tab");
      const at = await page.evaluate(() => {
        const element = document.activeElement;
        const outline = getComputedStyle(element).outlineStyle;
        return [element.tagName, element.getAttribute("aria-label") ?? element.labels?.[0]?.textContent ?? element.textContent.slice(0, 30), outline];
      });
      if (at[0] === "BODY") break;
      assert.notEqual(at[2], "none", `${at[1]} shows its focus`);
      seen.add(at[1]);
    }
    for (const wanted of ["Kinetic friction", "Pause", "Time"]) assert.ok(seen.has(wanted), `${wanted} is reached`);
    await slider(page, "Kinetic friction").focus();
    const before = await headline(page);
    for (let i = 0; i < 40; i++) await page.keyboard.press("ArrowLeft");
    await settled(page);
    assert.notDeepEqual(await headline(page), before);
    await page.locator("#tab-motion").focus();
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.locator("#tab-sweep").getAttribute("aria-selected"), "true");
    await page.keyboard.press("ArrowLeft");
    await page.locator("main").focus();
    const label = () => page.locator(".play").getAttribute("aria-label");
    assert.equal(await label(), "Pause");
    await page.keyboard.press("Space");
    assert.equal(await label(), "Play");
  }, MOVING));

test("no violation of WCAG AA on any tab, light and dark, with forced colours too", () =>
  on(
    async (page) => {
      // A scene with its answer, and B, which it keeps.
      await page.evaluate(() => globalThis.slipstick.guides.open("bounds"));
      await settled(page);
      await page.locator(".guide").getByRole("button", { name: "Show the answer" }).click();
      await page.locator(".guide .answer h3").waitFor();
      await page.locator(".legend summary").click();
      await page.addScriptTag({ path: axe }).catch(async () => page.evaluate(readFileSync(axe, "utf8")));
      for (const tab of ["motion", "sweep", "suite", "spectrum", "sensitivity", "ida", "fragility", "design", "study"]) {
        await page.locator(`#tab-${tab}`).click();
        if (tab === "spectrum") {
          await page.locator("#panel-spectrum button.main").click();
          await page.locator("#panel-spectrum .sheet").waitFor({ timeout: 60000 });
        }
        for (const [colorScheme, forcedColors] of [["light", "none"], ["dark", "none"], ["light", "active"], ["dark", "active"]]) {
          await page.emulateMedia({ colorScheme, forcedColors });
          await page.waitForTimeout(300);
          // What is not of colours is the same in all of them.
          const rules = colorScheme === "light" && forcedColors === "none" ? ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"] : { type: "rule", values: ["color-contrast", "link-in-text-block"] };
          const found = await page.evaluate(async (runOnly) => {
            const result = await globalThis.axe.run(document, { runOnly });
            return result.violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.target.join(" ")).slice(0, 4).join(", ")}`);
          }, rules);
          assert.deepEqual(found, [], `${tab}, ${colorScheme}${forcedColors === "active" ? ", forced colours" : ""}`);
        }
      }
    },
    { bypassCSP: true },
  ));

loading(test, on, site);
state(test, on);
whole(test, on, root);
report(test, () => chromium, axe, root);
runs(test, on);
figures(test, on);

test("it opens without a network once it was open, and asks for nothing after it", async () => {
  // A host of its own, of which no other page asks.
  const site = await host(folder);
  const opened = await open(chromium, site.url, { ...MOVING, serviceWorkers: "allow" });
  try {
    const { page, context } = opened;
    await page.evaluate(() => navigator.serviceWorker.ready);
    await page.waitForTimeout(500);
    const count = site.asked.length;
    await setField(page, "Kinetic friction", "0.04");
    await settled(page);
    await page.locator("#tab-sweep").click();
    await page.locator("#panel-sweep .figure-plot svg").first().waitFor();
    assert.equal(site.asked.length, count, `asked for ${site.asked.slice(count)}`);
    await context.setOffline(true);
    await page.reload();
    await settled(page);
    assert.match((await headline(page))[0], /mm$/);
    assert.deepEqual(opened.said, []);
  } finally {
    await opened.close();
    site.close();
  }
});

test("slipstick.html opens from a file", () =>
  on(
    async (page) => {
      assert.match((await headline(page))[0], /^60\.0\d\s*mm$/);
      await setField(page, "Kinetic friction", "0.04");
      await settled(page);
      await page.locator("#tab-sweep").click();
      await page.locator("#panel-sweep .figure-plot svg").first().waitFor();
    },
    {},
    pathToFileURL(join(folder, "slipstick.html")).href,
  ));

test("the notebook's bundle shows a model with a motion of its own", () =>
  on(async (page) => {
    const bundle = readFileSync(join(root, "crates/python/python/slipstick/page.js")).toString("base64");
    const motion = ["time_s,acceleration_m_per_s2", ...Array.from({ length: 400 }, (_, i) => `${i * 0.01},${3 * Math.sin(i * 0.06)}`)].join("\n");
    const text = readFileSync(join(root, "examples/taft.toml"), "utf8");
    await page.evaluate(
      async ([bundle, motion, text]) => {
        const module = await import(`data:text/javascript;base64,${bundle}`);
        const traits = { model: text, motion: "motion.csv", records: { "motion.csv": btoa(motion) }, summary: {} };
        const model = { get: (name) => traits[name], set: (name, value) => (traits[name] = value), save_changes: () => (globalThis.saved = traits) };
        const el = document.createElement("div");
        document.body.append(el);
        globalThis.ended = module.default.render({ model, el });
        globalThis.widget = el;
      },
      [bundle, motion, text],
    );
    await page.waitForFunction(() => globalThis.saved?.summary.peak_m > 0);
    const [peak, certificate] = await page.evaluate(() => [...globalThis.widget.shadowRoot.querySelectorAll(".headline dd, .certificate strong")].map((e) => e.textContent).filter((_, i, all) => i === 0 || i === all.length - 1));
    assert.match(peak, /mm|m/);
    assert.match(certificate, /Computed right/);
    assert.match(await page.evaluate(() => globalThis.saved.model), /record = "motion.csv"\n(?!scale)/);
    await page.evaluate(() => globalThis.ended());
  }, { bypassCSP: true }));

test("reduced motion: it stands at its peak", () =>
  on(
    async (page) => {
      assert.equal(await page.locator(".play").getAttribute("aria-label"), "Play");
      const [time, peak] = await page.evaluate(() => [globalThis.slipstick.time, globalThis.slipstick.answer.state.headline.peakTime_s]);
      assert.ok(Math.abs(time - peak) < 1e-9);
    },
    { reducedMotion: "reduce" },
  ));

minute(test, on);
compare(test, on);
scenes(test, on, site);

test("it prints as pages of A4 with the report's figures", () =>
  on(async (page) => {
    await page.locator(".print-only figure").nth(3).waitFor({ state: "attached", timeout: 8000 });
    const pdf = await page.pdf({ format: "A4", printBackground: true });
    const pages = pdf.toString("latin1").match(/\/Type\s*\/Page\b/g)?.length ?? 0;
    assert.ok(pages >= 2 && pages <= 8, `${pages} pages`);
  }));

test("pictures at three widths, in light and dark", () =>
  on(async (page) => {
    for (const [width, height] of [[390, 844], [900, 900], [1600, 1000]]) {
      await page.setViewportSize({ width, height });
      for (const colorScheme of ["light", "dark"]) {
        await page.emulateMedia({ colorScheme });
        await page.waitForTimeout(600);
        const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
        assert.ok(wide <= 0, `${width}: ${wide} px too wide`);
        await page.screenshot({ path: join(shots, `${width}-${colorScheme}.png`), fullPage: width < 1500 });
      }
    }
  }));

let [passed, failed, skipped] = [0, 0, 0];
/** How long each test took, in s. */
const took = [];
const left = tests.filter(([name]) => !only || only.split("|").some((part) => name.includes(part)));
/** Runs tests, one after the other, until none is left. */
async function some() {
  for (let next = left.shift(); next; next = left.shift()) {
    const [name, run] = next;
    const start = performance.now();
    try {
      if (!chromium.isConnected()) chromium = await browser();
      let timer;
      const late = new Promise((_, reject) => {
        timer = setTimeout(() => reject(new Error(`it took longer than ${LONGEST_S} s`)), 1000 * LONGEST_S);
      });
      const said = await Promise.race([run(), late]).finally(() => clearTimeout(timer));
      if (typeof said === "string") {
        skipped++;
        console.log(`  ${said}`);
      } else passed++;
    } catch (error) {
      failed++;
      console.log(`  FAILED: ${name}\n    ${String(error.stack ?? error).split("\n").slice(0, 14).join("\n    ")}`);
    }
    took.push([(performance.now() - start) / 1000, name]);
  }
}
// Two at a time: a page keeps one processor busy, and not all the time.
await Promise.all([some(), some()]);
await chromium.close();
site.close();
took.sort(([a], [b]) => b - a);
console.log("  the longest:");
for (const [seconds, name] of took.slice(0, SLOWEST)) console.log(`    ${seconds.toFixed(1).padStart(5)} s  ${name}`);
console.log(`${passed} passed, ${failed} failed, ${skipped} skipped`);
process.exitCode = failed > 0 ? 1 : 0;
