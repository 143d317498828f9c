// What the page is measured by: `node tests/bars.mjs FOLDER`, figures as JSON.

import { readFileSync, readdirSync } from "node:fs";
import { join, resolve } from "node:path";
import { gzipSync } from "node:zlib";
import { browser, host, settled } from "./harness.mjs";

const folder = resolve(process.argv[2]);
const site = await host(folder);
const chromium = await browser();
const median = (values) => values.toSorted((a, b) => a - b)[values.length >> 1];

async function fresh() {
  const context = await chromium.newContext({ viewport: { width: 1300, height: 900 }, serviceWorkers: "block" });
  const page = await context.newPage();
  await page.goto(site.url);
  await settled(page);
  return { page, context };
}

const first = [];
for (let i = 0; i < 7; i++) {
  const { page, context } = await fresh();
  first.push(await page.evaluate(() => performance.getEntriesByName("first-picture")[0].startTime));
  await context.close();
}

/** The page as it comes over a slow line to a slow processor: seconds to a mark, and what came before it; seconds to the certificate. */
async function slow(mark, url = site.url) {
  const context = await chromium.newContext({ viewport: { width: 390, height: 844 }, serviceWorkers: "block" });
  const page = await context.newPage();
  const control = await context.newCDPSession(page);
  await control.send("Network.enable");
  await control.send("Network.emulateNetworkConditions", { offline: false, latency: 150, downloadThroughput: 1.6e6 / 8, uploadThroughput: 0.75e6 / 8 });
  await control.send("Emulation.setCPUThrottlingRate", { rate: 4 });
  await page.goto(url, { waitUntil: "commit" });
  await page.waitForFunction((mark) => performance.getEntriesByName(mark).length > 0, mark, { timeout: 60000 });
  const found = await page.evaluate((mark) => {
    const until = performance.getEntriesByName(mark)[0].startTime;
    const came = [...performance.getEntriesByType("navigation"), ...performance.getEntriesByType("resource")].filter((entry) => entry.responseEnd <= until);
    return { seconds: until / 1000, bytes: came.reduce((sum, { transferSize }) => sum + transferSize, 0) };
  }, mark);
  const judged = mark === "first-answer" && (await page.waitForFunction(() => document.querySelector(".results .certificate.holds") && performance.now() / 1000, undefined, { timeout: 60000 }));
  const certified = judged ? await judged.jsonValue() : undefined;
  await context.close();
  return { ...found, certified };
}

const slowly = [];
for (let i = 0; i < 3; i++) slowly.push(await slow("first-picture"));
const live = [];
for (let i = 0; i < 3; i++) live.push(await slow("first-answer"));

const { page, context } = await fresh();
const dragged = await page.evaluate(async () => {
  const app = globalThis.slipstick;
  const slider = document.querySelector('input[type=range][aria-label="Kinetic friction"]');
  const frames = [];
  const start = performance.now();
  const before = app.updates;
  await new Promise((done) => {
    let last = start;
    const step = (now) => {
      frames.push(now - last);
      last = now;
      if (now - start > 4000) return done();
      slider.value = String(100 + 60 * Math.sin((now - start) / 300));
      slider.dispatchEvent(new Event("input", { bubbles: true }));
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  });
  const seconds = (performance.now() - start) / 1000;
  const updates = (app.updates - before) / seconds;
  const slow = frames.slice(1).filter((ms) => ms <= 33.4).length / (frames.length - 1);
  return { updates, within: 100 * slow };
});
await settled(page);

const certified = [];
for (let i = 0; i < 15; i++) {
  certified.push(
    await page.evaluate(async (i) => {
      const slider = document.querySelector('input[type=range][aria-label="Kinetic friction"]');
      const card = document.querySelector(".results .certificate");
      slider.value = String(120 + 5 * i);
      const start = performance.now();
      slider.dispatchEvent(new Event("input", { bubbles: true }));
      while (card.classList.contains("holds")) await new Promise((done) => setTimeout(done, 0));
      while (!card.classList.contains("holds")) await new Promise((done) => setTimeout(done, 1));
      return performance.now() - start;
    }, i),
  );
  await page.waitForTimeout(60);
}

const times = await page.evaluate(async () => {
  const { helper } = globalThis.slipstick.desk;
  const best = [];
  for (let i = 0; i < 7; i++) best.push(await helper.call("histories", 100));
  const sweeps = [];
  const over = "slider.kinetic_friction=0.02..0.12:1000";
  for (let i = 0; i < 5; i++) {
    const start = performance.now();
    await helper.call("sweep", `${globalThis.slipstick.text}#${i}`, over, 0, 1000);
    sweeps.push((performance.now() - start) / 1000);
  }
  return { history_ms: Math.min(...best), sweep_s: Math.min(...sweeps) };
});
await context.close();
const version = chromium.version();
await chromium.close();
site.close();

const files = readdirSync(folder).filter((name) => name !== "slipstick.html");
const zipped = files.reduce((sum, name) => sum + gzipSync(readFileSync(join(folder, name)), { level: 9 }).length, 0);
console.log(
  JSON.stringify({
    chromium: version,
    first_s: median(first) / 1000,
    slow_first_s: median(slowly.map(({ seconds }) => seconds)),
    slow_first_kB: median(slowly.map(({ bytes }) => bytes)) / 1000,
    slow_live_s: median(live.map(({ seconds }) => seconds)),
    slow_certified_s: median(live.map(({ certified }) => certified)),
    updates_per_s: dragged.updates,
    frames_within: dragged.within,
    certified_ms: median(certified),
    ...times,
    folder_kB: zipped / 1000,
    single_MB: readFileSync(join(folder, "slipstick.html")).length / 1e6,
  }),
);
