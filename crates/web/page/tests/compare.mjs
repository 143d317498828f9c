// Pin and compare, as a person uses it.

import assert from "node:assert/strict";
import { MOVING, headline, settled } from "./harness.mjs";
import { setField } from "./fields.mjs";

/** Colours in a canvas, as numbers. */
const has = (page, selector, name) =>
  page.evaluate(
    ([selector, name]) => {
      const probe = document.createElement("canvas").getContext("2d");
      probe.fillStyle = getComputedStyle(document.querySelector(".slipstick")).getPropertyValue(name);
      const wanted = Number.parseInt(probe.fillStyle.slice(1), 16);
      return [...document.querySelectorAll(selector)].map((canvas) => {
        const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
        let count = 0;
        for (let i = 0; i < data.length; i += 4) if (((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]) === wanted) count++;
        return count;
      });
    },
    [selector, name],
  );

const pinned = (page) => page.waitForFunction(() => globalThis.slipstick.compare.pinned);

export function compare(test, on) {
  test("a setting that is pinned stands as B in headline, histories, loop and picture, and the link has both", () =>
    on(async (page, { context }) => {
      const before = await headline(page);
      await page.getByRole("button", { name: "Pin as B" }).click();
      await pinned(page);
      await page.locator(".play").click();
      await page.evaluate(() => globalThis.slipstick.stage.stopAt(globalThis.slipstick.answer.state.headline.peakTime_s));
      await setField(page, "Kinetic friction", "0.03");
      await settled(page);
      const beside = page.locator(".headline .versus");
      const [peak] = before[0].split("mm");
      assert.match(await beside.first().innerText(), new RegExp(`^B ${peak.trim()} mm, now \\+\\d+ %$`));
      assert.match(await page.locator(".compare").innerText(), /Kinetic friction: 0\.03, in B 0\.05/);
      assert.equal(await page.locator(".plot .key li", { hasText: /^B/ }).count(), 2, "sliding and acceleration");
      await page.waitForTimeout(200);
      for (const selector of [".scene", ".loop", ".plot canvas"]) {
        const [count] = await has(page, selector, "--versus");
        assert.ok(count > 20, `B in ${selector}: ${count} points`);
      }
      // The figures are those of the setting itself.
      const same = await page.evaluate(() => globalThis.slipstick.compare.pinned.answer.state.headline.peak_m);
      await page.waitForTimeout(200);
      const other = await context.newPage();
      await other.goto(page.url());
      await settled(other);
      await pinned(other);
      assert.equal(await other.evaluate(() => globalThis.slipstick.compare.pinned.answer.state.headline.peak_m), same);
      assert.deepEqual(await headline(other), await headline(page));
      await other.close();
      await page.getByRole("button", { name: "Swap with B" }).click();
      await page.waitForFunction((text) => document.querySelector(".headline dd").innerText === text, before[0]);
      await settled(page);
      await page.getByRole("button", { name: "Remove B" }).click();
      await beside.first().waitFor({ state: "detached" });
      assert.equal(await page.locator(".plot .key li", { hasText: /^B/ }).count(), 0);
    }, MOVING));

  test("B is in the units of the page, and says when it has no answer", () =>
    on(async (page, { context }) => {
      await page.getByRole("button", { name: "Pin as B" }).click();
      await pinned(page);
      await setField(page, "Kinetic friction", "0.03");
      await settled(page);
      await page.getByLabel("Units", { exact: true }).selectOption("us");
      await page.waitForFunction(() => /^B [\d.]+ in/.test(document.querySelector(".headline .versus")?.textContent ?? ""));
      await page.waitForTimeout(200);
      const link = await page.evaluate(async () => {
        const bytes = await new Response(new Blob([Uint8Array.from(atob(location.hash.slice(4).replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0))]).stream().pipeThrough(new DecompressionStream("deflate-raw"))).text();
        const state = JSON.parse(bytes);
        state.pinned = state.pinned.replace("taft-111.txt", "lost.txt");
        const packed = new Uint8Array(await new Response(new Blob([JSON.stringify(state)]).stream().pipeThrough(new CompressionStream("deflate-raw"))).arrayBuffer());
        return `#v1.${btoa(String.fromCharCode(...packed)).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
      });
      const other = await context.newPage();
      await other.goto(page.url().replace(/#.*/, link));
      await settled(other);
      await other.locator(".compare .fault").waitFor();
      assert.match(await other.locator(".compare .fault").innerText(), /B has no answer: .*lost\.txt/);
      assert.deepEqual(await headline(other).then((all) => all[0]), (await headline(page))[0]);
      await other.close();
    }));
}
