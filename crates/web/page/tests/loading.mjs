// How the page comes: a picture before any module, one analysis by a small one, the rest behind it.

import assert from "node:assert/strict";
import { MOVING, headline, settled } from "./harness.mjs";

/** What was asked for before an instant of the page's clock, with the bytes that came. */
const before = (page, mark) =>
  page.evaluate((mark) => {
    const until = performance.getEntriesByName(mark)[0].startTime;
    const [page] = performance.getEntriesByType("navigation");
    const asked = performance.getEntriesByType("resource").filter((entry) => entry.startTime < until);
    const came = [page, ...asked].filter((entry) => entry.responseEnd <= until);
    return { asked: asked.map(({ name }) => name.replace(/^.*\//, "")), bytes: came.reduce((sum, { transferSize }) => sum + transferSize, 0) };
  }, mark);

export function loading(test, on, site) {
  test("the first picture comes before any module, within 350 kB, and says what it is", () =>
    on(async (page) => {
      const { asked, bytes } = await before(page, "first-picture");
      assert.ok(asked.includes("first.json") && !asked.some((name) => name.endsWith(".wasm")), `asked for ${asked}`);
      assert.ok(bytes > 20_000 && bytes <= 350_000, `${bytes} bytes`);
    }, MOVING));

  test("until a module is there the picture is that of the build, and says so; what is changed is answered then", () =>
    on(async (page) => {
      const live = await headline(page);
      let give;
      const given = new Promise((done) => (give = done));
      await page.route(/\.wasm$/, async (route) => {
        await given;
        await route.continue();
      });
      await page.reload();
      await page.waitForFunction(() => globalThis.slipstick?.updates > 0);
      assert.match(await page.locator(".results .certificate").innerText(), /^Loading\s+This picture was computed when the page was built/);
      assert.deepEqual(await headline(page), live, "its figures are those that are computed here");
      const shape = await page.evaluate(() => {
        const { s, time, storeyDisplacement } = globalThis.slipstick.answer;
        return [s.length, time.length, storeyDisplacement.length, Math.max(...s.map(Math.abs))];
      });
      await page.evaluate(() => globalThis.slipstick.desk.set([["slider.kinetic_friction", "0.03"]]));
      give();
      await settled(page);
      assert.notDeepEqual(await headline(page), live);
      assert.match(await page.locator(".results .certificate").innerText(), /^Computed right/);
      await page.getByRole("button", { name: "Reset" }).click();
      await settled(page);
      const now = await page.evaluate(() => {
        const { s, time, storeyDisplacement } = globalThis.slipstick.answer;
        return [s.length, time.length, storeyDisplacement.length, Math.max(...s.map(Math.abs))];
      });
      assert.deepEqual(now.slice(0, 3), shape.slice(0, 3));
      assert.ok(Math.abs(now[3] / shape[3] - 1) < 1e-4, `${now[3]} ${shape[3]}`);
    }, MOVING));

  test("one analysis is answered before the whole module is there, with its bits, and checked once it is", () =>
    on(async (page) => {
      const whole = await page.evaluate(() => [...globalThis.slipstick.answer.s]);
      let give;
      const given = new Promise((done) => (give = done));
      await page.route(/slipstick\.wasm$/, async (route) => {
        await given;
        await route.continue();
      });
      await page.reload();
      await page.waitForFunction(() => globalThis.slipstick?.updates > 1);
      assert.match(await page.locator(".results .certificate").innerText(), /^Loading\s+Not yet checked/);
      assert.deepEqual(await page.evaluate(() => [...globalThis.slipstick.answer.s]), whole, "the bits of the whole module");
      const peak = await headline(page);
      await page.evaluate(() => globalThis.slipstick.desk.set([["slider.kinetic_friction", "0.03"]]));
      await page.waitForFunction((peak) => document.querySelector(".headline dd").innerText !== peak, peak[0]);
      await page.locator("#tab-suite").click();
      assert.match(await page.locator("#panel-suite").innerText(), /Loading/);
      give();
      await settled(page);
      await page.locator("#panel-suite label.field").first().waitFor();
      await page.locator("#tab-motion").click();
      assert.match(await page.locator(".results .certificate").innerText(), /^Computed right/);
    }, MOVING));

  test("a whole module that does not come is said where it is needed, and asked for again", () =>
    on(async (page, { said }) => {
      await page.route(/slipstick\.wasm$/, (route) => route.abort());
      await page.reload();
      await page.waitForFunction(() => globalThis.slipstick?.updates > 1);
      const message = await page.evaluate(() => globalThis.slipstick.desk.helper.call("form", "ida", globalThis.slipstick.text, "si").catch((error) => error.message));
      assert.match(message, /expected the rest of the page/);
      await page.unroute(/slipstick\.wasm$/);
      await page.evaluate(() => globalThis.slipstick.desk.set([["slider.kinetic_friction", "0.04"]]));
      await settled(page);
      // The browser says itself what did not come.
      said.splice(0, said.length, ...said.filter((text) => !/ERR_FAILED|Failed to load/.test(text)));
    }, MOVING));
}
