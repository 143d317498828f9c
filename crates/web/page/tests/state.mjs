// One state: field, text, figures, link and ZIP are of one model at every instant, or greyed.

import assert from "node:assert/strict";
import { unzipSync } from "fflate";
import { rest } from "./harness.mjs";

/** How long random sequences are tried, in s, where `SLIPSTICK_SEQUENCES` says no number of them. */
const SECONDS = 16;
const STEPS = 7;

/** How long a page may take until it rests, in ms: where many sequences are tried, beside other work of the machine. */
const REST_MS = process.env.SLIPSTICK_SEQUENCES ? 120_000 : 20_000;

/** Random numbers of a seed, from 0 to 1. */
function random(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** What a step does, by its name: all of it in the page, with numbers from 0 to 1 to choose by. */
const ACTS = ["drag", "drag", "drag", "through zero", "type", "type", "half typed", "write", "break", "undo", "redo", "reset", "back", "back with a focus", "forward", "scene", "seven to eight", "units", "stepwise", "slow", "trap", "silent", "start another", "record", "remove", "pin", "swap", "restore", "nothing"];

/** Made in the page once: its acts, and what it tells of itself. */
function install() {
  const app = globalThis.slipstick;
  const { desk } = app;
  const Helper = desk.helper.constructor;
  const later = (ms) => new Promise((done) => setTimeout(done, ms));
  const sliders = () => [...document.querySelectorAll(".control input[type=range]")];
  const fields = () => [...document.querySelectorAll(".control input[type=text]")];
  const of = (list, number) => list[Math.floor(number * list.length)];
  const button = (label) => [...document.querySelectorAll(".slipstick button")].find((one) => one.textContent === label);
  const move = (slider, value) => {
    slider.value = String(Math.round(1000 * value));
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  };
  const type = (field, text, change) => {
    field.focus();
    field.value = text;
    field.dispatchEvent(new Event("input", { bubbles: true }));
    if (change) field.dispatchEvent(new Event("change", { bubbles: true }));
  };
  const gone = () => new Promise((done) => {
    addEventListener("popstate", () => done(), { once: true });
    setTimeout(done, 400);
  });
  const sine = (amplitude) => `time_s,acceleration_m_per_s2\n${Array.from({ length: 300 }, (_, i) => `${(i * 0.01).toFixed(2)},${(amplitude * Math.sin(i * 0.06)).toFixed(6)}\n`).join("")}`;
  const area = document.querySelector("#model-text");
  const write = (text) => {
    area.value = text;
    area.dispatchEvent(new Event("input", { bubbles: true }));
  };
  const silence = (ms) => void desk.helper.call("wait", ms).catch(() => {});
  const another = () => {
    desk.helper.end();
    void desk.helper.start();
  };
  const acts = {
    async drag([a, b, c]) {
      const slider = of(sliders(), a);
      if (!slider) return;
      for (let i = 0; i < 6; i++) {
        move(slider, Math.min(1, Math.max(0, b + 0.05 * i * (c - 0.5))));
        await later(4);
      }
      if (c > 0.3) slider.dispatchEvent(new Event("change", { bubbles: true }));
    },
    async "through zero"([a]) {
      const slider = document.querySelector('.control input[type=range][aria-label="Static friction"]');
      if (!slider) return;
      for (let twice = 0; twice < 2; twice++) {
        for (const value of [0.2, 0.1, 0, 0, 0.05 + 0.2 * a]) {
          move(slider, value);
          await later(2);
        }
      }
      slider.dispatchEvent(new Event("change", { bubbles: true }));
    },
    type([a, b]) {
      const field = of(fields(), a);
      if (!field) return;
      const now = Number(field.value.replace("−", "-")) || 1;
      type(field, of([`${(now * (0.6 + b)).toPrecision(3)}`, `${now}`, "5 lbf", "-1", "abc", "0"], b), true);
    },
    "half typed"([a]) {
      const field = of(fields(), a);
      if (field) type(field, "0.0", false);
    },
    write([a, b]) {
      const text = app.text;
      write(a < 0.6 ? text.replace(/^(kinetic_friction\s*=\s*)[\d.]+$/m, `$1${(0.01 + 0.04 * b).toPrecision(2)}`) : text.replace(/^name = .*$/m, `name = "Written ${b}"`));
    },
    break([a]) {
      write(a < 0.5 ? `${app.text}\nnonsense` : app.text.replace("kinetic_friction", "kinetic_fricton"));
    },
    undo: () => button("Undo").click(),
    redo: () => button("Redo").click(),
    reset: () => button("Reset").click(),
    async back() {
      if (!globalThis.navigation.canGoBack) return;
      const left = gone();
      history.back();
      await left;
    },
    async "back with a focus"([a]) {
      of(fields(), a)?.focus();
      await acts.back();
    },
    async forward() {
      if (!globalThis.navigation.canGoForward) return;
      const left = gone();
      history.forward();
      await left;
    },
    scene([a]) {
      app.guides.open(of(["sticking", "static-kinetic", "residual", "resonance", "stop", "bounds", "vertical", "two-directions"], a));
    },
    async "seven to eight"([a]) {
      app.guides.open("vertical");
      await later(40 * a);
      app.guides.open("two-directions");
    },
    units([a]) {
      const select = document.querySelector("select[aria-label=Units]");
      select.value = of(["si", "si-g", "kN-mm", "us"], a);
      select.dispatchEvent(new Event("change", { bubbles: true }));
    },
    stepwise() {
      app.stepwise.click();
    },
    slow: ([a]) => silence(10 + 120 * a),
    trap: () => void desk.helper.call("trap").catch(() => {}),
    async silent([a, b]) {
      // A worker that says nothing any more, in the middle of something, until a person starts another.
      const slider = of(sliders(), a);
      if (slider) move(slider, b);
      await later(30 * b);
      desk.helper.worker?.terminate();
      await later(20);
      another();
    },
    async "start another"([a, b, c]) {
      silence(150 * a);
      const slider = of(sliders(), b);
      if (slider) move(slider, c);
      await later(60 * a);
      another();
    },
    async record([a, b]) {
      await app.intake.files([new File([sine(2 + 3 * a)], b < 0.7 ? "own.csv" : "other.csv")]);
    },
    remove() {
      document.querySelector('button[aria-label^="Remove "]')?.click();
    },
    pin: () => button("Pin as B")?.click(),
    swap: () => button("Swap with B")?.click(),
    restore([a]) {
      const select = document.querySelector("select[id^=restoring]");
      if (!select) return;
      select.value = of(["none", "radius", "period", "spring"], a);
      select.dispatchEvent(new Event("change", { bubbles: true }));
    },
    nothing: () => later(15),
  };

  // What would be handed to the person is kept.
  let zip;
  const link = HTMLAnchorElement.prototype.click;
  HTMLAnchorElement.prototype.click = function () {
    if (!this.download) link.call(this);
  };
  const url = URL.createObjectURL;
  URL.createObjectURL = (blob) => {
    if (blob.type === "application/zip") zip = blob;
    return url.call(URL, blob);
  };
  const zipped = async () => {
    zip = undefined;
    await app.exports.everything();
    if (!zip) return undefined;
    const bytes = new Uint8Array(await zip.arrayBuffer());
    let binary = "";
    for (let i = 0; i < bytes.length; i += 32768) binary += String.fromCharCode(...bytes.subarray(i, i + 32768));
    return btoa(binary);
  };
  /** The same of its files alone, by the call that a ZIP is made by: what packs them takes the time. */
  const made = () => desk.files(["summary.json"], () => "").then(({ text, files }) => ({ text, summary: files[0] }), () => undefined);
  const linked = async () => {
    if (!location.hash.startsWith("#v1.")) return undefined;
    const bytes = Uint8Array.from(atob(location.hash.slice(4).replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
    return JSON.parse(await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"))).text());
  };
  /** Another worker that knows the same files: what a text says. */
  const oracle = new Helper(desk.engine, new Map());
  const known = new Map();
  const truth = async (text, display) => {
    for (const [name, bytes] of desk.records) {
      if (known.get(name) === bytes) continue;
      known.set(name, bytes);
      await oracle.call("add", name, bytes);
    }
    for (const name of [...known.keys()].filter((name) => !desk.records.has(name))) {
      known.delete(name);
      await oracle.call("remove", name);
    }
    try {
      const { state } = await oracle.call("analyse", { number: Math.random(), text, set: [], display, stepwise: false });
      return { headline: state.headline, inputs: Object.fromEntries(state.inputs.map(({ path, shown }) => [path, shown ?? null])) };
    } catch (error) {
      return { error: error.message };
    }
  };
  /** What stands on the screen, with its number where it is not greyed. */
  const shown = () => {
    const number = (element) => (element.classList.contains("behind") ? null : element.dataset.number);
    const { controls } = app.controls;
    return {
      number: app.root.dataset.number,
      wanted: String(desk.wanted.number),
      set: desk.wanted.set.length,
      parts: Object.fromEntries(Object.entries({ stage: ".stage", plots: ".plots", certificate: ".results .certificate", editor: ".editor", controls: ".controls .card [data-number]" }).map(([name, where]) => [name, number(document.querySelector(where))])),
      text: area.value,
      display: document.querySelector("select[aria-label=Units]").value,
      headline: app.answer?.state.headline,
      title: document.querySelector(".brand span").textContent,
      fields: Object.fromEntries([...controls].filter(([, { typed, field }]) => !typed && !field.hasAttribute("aria-invalid")).map(([path, { field }]) => [path, field.value])),
      said: document.querySelector(".results .certificate").textContent.slice(0, 22),
      refused: desk.refused,
      gone: desk.answered?.gone === true,
      stepwise: app.stepwise.checked === desk.wanted.stepwise && (!desk.answered?.judgement || desk.refused || (desk.answered.judgement.stepwise !== undefined) === app.stepwise.checked),
    };
  };
  globalThis.tried = { act: (name, numbers) => acts[name](numbers), shown, zipped, made, linked, truth, another };
}

/** At an instant: what is not greyed is of the number that is wanted, and of one model. */
async function atOnce(page) {
  const { now, truth } = await page.evaluate(async () => {
    const { shown, truth } = globalThis.tried;
    const now = shown();
    const whole = Object.values(now.parts).every((number) => number !== null) && now.set === 0 && now.headline && !now.refused && !now.gone;
    return { now, truth: whole ? await truth(now.text, now.display) : undefined };
  });
  assert.equal(now.number, now.wanted);
  for (const [part, number] of Object.entries(now.parts)) if (number !== null && number !== undefined && number !== "0") assert.equal(number, now.wanted, `${part} is of another number, and not greyed`);
  if (truth && !truth.error) same(now, truth, "at once");
}

function same(now, truth, when) {
  assert.deepEqual(now.headline, truth.headline, `${when}: figures and text`);
  for (const [path, value] of Object.entries(now.fields)) assert.equal(value, truth.inputs[path] ?? "", `${when}: the field ${path}, and the text`);
}

/** What a ZIP holds, of one model with its figures; `whole`: of the ZIP itself. Nothing where there is none to make. */
async function zipped(page, whole) {
  const packed = await page.evaluate((whole) => (whole ? globalThis.tried.zipped() : globalThis.tried.made()), whole);
  if (!packed) return undefined;
  let { text, summary } = packed;
  if (whole) {
    const files = unzipSync(Uint8Array.from(Buffer.from(packed, "base64")));
    text = Buffer.from(files["model.toml"]).toString();
    summary = Buffer.from(files["page/summary.json"]).toString();
  }
  const figures = JSON.parse(summary);
  const truth = await page.evaluate((text) => globalThis.tried.truth(text, "si"), text);
  assert.equal(truth.error, undefined, "the model in the ZIP");
  assert.equal(figures.peak_sliding_displacement_m, truth.headline.peak_m, "summary and model in the ZIP");
  assert.equal(figures.slip_count, truth.headline.slips, "summary and model in the ZIP");
  return { text, truth };
}

/** At rest: all five, of one model. What comes in between, such as a Back on a slow machine, is waited for. */
async function atRest(page, whole) {
  const wanted = () => page.evaluate(() => globalThis.tried.shown().wanted);
  for (;;) {
    await comesToRest(page);
    const before = await wanted();
    if (!(await page.evaluate(rest, [false, true]))) continue;
    try {
      return await compared(page, whole);
    } catch (error) {
      if (before === (await wanted())) throw error;
    }
  }
}

async function comesToRest(page) {
  const rests = () => page.waitForFunction(rest, [false, true], { timeout: REST_MS, polling: 20 });
  // What takes long is ended as a person would end it.
  await rests().catch(async () => {
    await page.evaluate(() => globalThis.tried.another());
    await rests();
  });
}

/** What stands there, compared; where what is wanted has no answer, all but the text are of the last that had one. */
async function compared(page, whole) {
  let now;
  let link;
  // The address follows within an instant.
  for (let i = 0; i < 100; i++) {
    [now, link] = await page.evaluate(async () => [globalThis.tried.shown(), await globalThis.tried.linked()]);
    if (now.refused || (link && link.text === now.text && link.display === now.display)) break;
    await page.waitForTimeout(20);
  }
  assert.ok(now.stepwise, "the stepwise method stands beside where it is asked for");
  const zip = await zipped(page, whole);
  if (now.refused || now.gone) {
    assert.equal(now.parts.stage, null, "figures are greyed where the model has no answer");
    assert.equal(now.parts.controls, null, "fields are greyed where the model has no answer");
    assert.match(now.said, /^Of the last good|^Not checked|^$/);
    assert.equal(now.gone, zip === undefined, "a ZIP, where there are the files for one");
    if (!zip) return;
    assert.deepEqual(now.headline, zip.truth.headline, "figures and ZIP");
    for (let i = 0; i < 100 && link && link.text !== zip.text; i++) {
      await page.waitForTimeout(20);
      link = await page.evaluate(() => globalThis.tried.linked());
    }
    if (link) assert.equal(link.text, zip.text, "link and ZIP");
    return;
  }
  for (const [part, number] of Object.entries(now.parts)) assert.equal(number, now.wanted, `${part} at rest`);
  assert.equal(zip?.text, now.text, "text and ZIP");
  if (now.said.startsWith("Computed")) {
    assert.equal(link?.text, now.text, "text and link");
    assert.equal(link.display, now.display, "units and link");
  }
  same(now, await page.evaluate(([text, display]) => globalThis.tried.truth(text, display), [now.text, now.display]), "at rest");
}

export function state(test, on, seed = Number(process.env.SLIPSTICK_SEED ?? Date.now() % 1e6)) {
  test("field, text, figures, link and ZIP are of one model, whatever is done to the page and to its workers", async () => {
    const wanted = Number(process.env.SLIPSTICK_SEQUENCES ?? 0);
    const start = performance.now();
    let number = 0;
    const more = () => (wanted > 0 ? number < wanted : (performance.now() - start) / 1000 < SECONDS);
    let steps = 0;
    while (more()) {
      // A page for some sequences: opening it costs more than one.
      await on(async (page) => {
        await page.evaluate(install);
        // On a short motion most of it is quick.
        await page.evaluate(() => globalThis.tried.act("record", [0.5, 0, 0]));
        for (let i = 0; i < 20 && more(); i++, number++) {
          if (wanted && number % 20 === 0) console.log(`    ${number} of ${wanted} sequences, ${steps} steps`);
          const next = random(seed + number);
          const told = [];
          try {
            for (let step = 0; step < STEPS; step++, steps++) {
              const act = ACTS[Math.floor(next() * ACTS.length)];
              const numbers = [next(), next(), next()];
              const waits = next();
              told.push(`${act} ${numbers.map((x) => x.toFixed(3))}`);
              await page.evaluate(([act, numbers]) => globalThis.tried.act(act, numbers), [act, numbers]);
              await atOnce(page);
              // Some steps follow before it rests; a ZIP that is asked for then is of one model too.
              if (waits < 0.15) await zipped(page, waits < 0.03);
              if (waits > 0.4) await atRest(page, waits > 0.95);
              else await page.waitForTimeout(60 * waits);
              await atOnce(page);
            }
            await atRest(page, false);
          } catch (error) {
            error.message = `seed ${seed + number}, after ${told.join("; ")}: ${error.message}`;
            error.stack = `${error.message}\n${error.stack.split("\n").filter((line) => /^\s+at /.test(line)).join("\n")}`;
            throw error;
          }
        }
      }, { reducedMotion: "reduce" });
    }
    console.log(`    ${number} sequences from seed ${seed}, ${steps} steps`);
  });
}
