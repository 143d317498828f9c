// The figures of all tabs: values under the pointer, zoom, and out as CSV, SVG and PNG.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const TABS = ["sweep", "suite", "spectrum", "sensitivity", "ida", "fragility", "design", "study"];

/** Opens a tab and waits for its figures. */
export async function shown(page, id) {
  await page.locator(`#tab-${id}`).click();
  const panel = page.locator(`#panel-${id}`);
  if (id !== "sweep") {
    await panel.locator("button.main:not([disabled])").click();
    await panel.locator(".sheet").waitFor({ timeout: 90000 });
  }
  await panel.locator(".figure-plot svg").first().waitFor();
  return panel;
}

async function got(page, button) {
  const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
  return [download.suggestedFilename(), readFileSync(await download.path())];
}

export function figures(test, on) {
  test("every figure of every tab tells values, zooms, and leaves as CSV, SVG and PNG, on a light and a dark ground", () =>
    on(
      async (page) => {
        for (const id of TABS) {
          const panel = await shown(page, id);
          assert.equal(await panel.locator("img").count(), 0, `${id}: a figure that is an image`);
          const count = await panel.locator(".figure").count();
          assert.ok(count > 0, id);
          for (const colorScheme of ["dark", "light"]) {
            await page.emulateMedia({ colorScheme });
            // They are drawn anew once the page hears of it.
            const inked = ([id, light]) => [...document.querySelectorAll(`#panel-${id} .figure-plot svg[role]`)].every((svg) => (svg.getAttribute("fill") === "#1a1a1a") === light);
            await page.waitForFunction(inked, [id, colorScheme === "light"]);
            for (let i = 0; i < count; i++) {
              const figure = panel.locator(".figure").nth(i);
              const svg = figure.locator(".figure-plot svg[role]");
              await svg.scrollIntoViewIfNeeded();
              const ground = await svg.evaluate((element) => getComputedStyle(element).backgroundColor);
              const light = ground.match(/\d+/g).slice(0, 3).every((part) => Number(part) > 200);
              assert.equal(light, colorScheme === "light", `${id}, figure ${i}: on ${ground}`);
              // The middle of the first frame, then where a point is, by keyboard.
              const frame = await svg.locator(":scope > rect[fill=none]").first().boundingBox();
              const ticks = () => svg.locator("text.tick").allTextContents();
              const readout = figure.locator(".readout");
              await page.mouse.move(frame.x + frame.width * 0.4, frame.y + frame.height * 0.5);
              await page.mouse.move(frame.x + frame.width * 0.42, frame.y + frame.height * 0.5);
              assert.match(await readout.textContent(), /\d/, `${id}, figure ${i}: the pointer`);
              const before = await ticks();
              await page.mouse.down();
              await page.mouse.move(frame.x + frame.width * 0.8, frame.y + frame.height * 0.52, { steps: 4 });
              await page.mouse.up();
              assert.notDeepEqual(await ticks(), before, `${id}, figure ${i}: zoomed`);
              await figure.getByRole("button", { name: "Whole" }).click();
              assert.deepEqual(await ticks(), before, `${id}, figure ${i}: whole again`);
            }
          }
          // In the colours of print, whatever the ground.
          await page.emulateMedia({ colorScheme: "dark" });
          await page.waitForFunction((id) => [...document.querySelectorAll(`#panel-${id} .figure-plot svg[role]`)].every((svg) => svg.getAttribute("fill") !== "#1a1a1a"), id);
          for (let i = 0; i < count; i++) {
            const figure = panel.locator(".figure").nth(i);
            const [csvName, csv] = await got(page, figure.getByRole("button", { name: "CSV", exact: true }));
            assert.match(csvName, /\.csv$/);
            assert.ok(csv.toString().split("\n").length > 3, `${id}, figure ${i}: ${csv}`);
            const [, drawn] = await got(page, figure.getByRole("button", { name: "SVG", exact: true }));
            assert.match(drawn.toString(), /^<svg[^>]*viewBox="0 0 860 \d+"[^]*fill="#ffffff"/);
            const [, png] = await got(page, figure.getByRole("button", { name: "PNG", exact: true }));
            assert.equal(png.readUInt32BE(0), 0x89504e47);
            assert.equal(png.readUInt32BE(16), 3 * 860);
          }
        }
      },
      { acceptDownloads: true },
    ));

  test("a figure follows the theme, and is drawn to the width that there is", () =>
    on(async (page) => {
      const panel = await shown(page, "sweep");
      const svg = panel.locator(".figure-plot svg[role]").first();
      const ink = () => svg.evaluate((element) => element.getAttribute("fill"));
      assert.equal(await ink(), "#1a1a1a");
      await page.emulateMedia({ colorScheme: "dark" });
      await page.waitForFunction(() => document.querySelector("#panel-sweep .figure-plot svg[role]").getAttribute("fill") !== "#1a1a1a");
      await page.setViewportSize({ width: 390, height: 844 });
      await page.waitForFunction(() => document.querySelector("#panel-sweep .figure-plot svg[role]").getAttribute("width") < 380);
      const sizes = await svg.locator("text").evaluateAll((all) => all.map((text) => Number(getComputedStyle(text).fontSize.replace("px", ""))));
      assert.ok(Math.min(...sizes) >= 11, `letters of ${Math.min(...sizes)} px`);
    }));

  test("the tornado's bars are the derivatives of the command's summary", () =>
    on(
      async (page) => {
        const panel = await shown(page, "sensitivity");
        const [, csv] = await got(page, panel.locator(".figure").first().getByRole("button", { name: "CSV", exact: true }));
        const [, summary] = await got(page, panel.getByRole("button", { name: "summary.json" }));
        const { derivatives } = JSON.parse(summary);
        const relative = derivatives.filter(({ demand }) => demand === "peak_sliding_displacement_m").map(({ relative }) => relative);
        const drawn = csv.toString().split("\n").slice(1).map((line) => Number(line.split(",").at(-2)));
        const missing = new Set(relative.filter((value) => value !== null && !drawn.includes(value)));
        // Over three records the median is one of them.
        assert.ok(relative.length > 3 && missing.size <= (relative.length * 2) / 3, `${[...missing]} of ${relative} not among ${drawn}`);
        assert.ok(drawn.some((value) => value !== 0));
      },
      { acceptDownloads: true },
    ));
}
