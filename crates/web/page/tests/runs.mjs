// From an answer over many runs to the motion of one, and the records that all tabs share.

import assert from "node:assert/strict";
import { drop, headline, settled } from "./harness.mjs";

const sine = (amplitude, frequency = 6) => `time_s,acceleration_m_per_s2\n${Array.from({ length: 500 }, (_, i) => `${(i * 0.01).toFixed(2)},${(amplitude * Math.sin(i * 0.01 * frequency)).toFixed(6)}\n`).join("")}`;

async function ran(page, id, timeout = 90000) {
  await page.locator(`#tab-${id}`).click();
  await page.locator(`#panel-${id} button.main:not([disabled])`).click();
  await page.locator(`#panel-${id} .sheet`).waitFor({ timeout });
}

/** Points at one of the runs that are drawn, and returns what is said of it; `press` clicks there. */
async function pointed(page, id, number) {
  const dot = page.locator(`#panel-${id} .explorer circle[data-point]`).nth(number);
  await dot.scrollIntoViewIfNeeded();
  const box = await dot.boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x + 1, y);
  await page.mouse.move(x, y);
  const said = await page.locator(`#panel-${id} .explorer .readout`).innerText();
  return { said, press: () => page.mouse.click(x, y) };
}

export function runs(test, on) {
  test("a click on a run of an IDA shows that run, with its figure", () =>
    on(async (page) => {
      await ran(page, "ida");
      const { said, press } = await pointed(page, "ida", 12);
      const [, peak, unit] = /Peak sliding displacement ([\d.]+) (\w+)/.exec(said);
      await press();
      await settled(page);
      assert.equal(await page.locator("#tab-motion").getAttribute("aria-selected"), "true");
      assert.match(await page.locator("#model-text").inputValue(), /scale = /);
      const si = await page.evaluate(() => globalThis.slipstick.answer.state.headline.peak_m);
      const factor = { mm: 1e-3, m: 1 }[unit];
      assert.ok(Math.abs(si / factor - Number(peak)) < 6e-4 * Number(peak), `${said}: ${si} m`);
    }));

  test("a design of the front is used by a click", () =>
    on(async (page) => {
      await ran(page, "design");
      const { said, press } = await pointed(page, "design", 0);
      const [, friction] = /Kinetic friction ([\d.]+)/.exec(said);
      await press();
      await settled(page);
      const text = await page.locator("#model-text").inputValue();
      const [, now] = /kinetic_friction\s*=\s*([\d.]+)/.exec(text);
      assert.ok(Math.abs(Number(now) - Number(friction)) < 1e-3 * Number(friction), `${said}: ${text}`);
      assert.match(await page.locator(".results .certificate").innerText(), /^Computed right/);
    }));

  test("a run of a study shows that run", () =>
    on(async (page) => {
      await ran(page, "study");
      const { said, press } = await pointed(page, "study", 20);
      const [, peak, unit] = /Peak sliding displacement ([\d.]+) (\w+)/.exec(said);
      await press();
      await page.waitForFunction(() => document.querySelector("#tab-motion").getAttribute("aria-selected") === "true");
      await settled(page);
      const si = await page.evaluate(() => globalThis.slipstick.answer.state.headline.peak_m);
      assert.ok(Math.abs(si / { mm: 1e-3, m: 1 }[unit] - Number(peak)) < 6e-4 * Number(peak), `${said}: ${si} m`);
    }));

  test("the plot of runs has axes to choose, a zoom, and leaves as CSV, SVG and PNG, in the dark too", () =>
    on(
      async (page) => {
        await ran(page, "spectrum");
        const explorer = page.locator("#panel-spectrum .explorer");
        const dots = () => explorer.locator("circle[data-point]").count();
        const all = await dots();
        assert.ok(all >= 100, `${all} runs`);
        await explorer.locator("svg").first().scrollIntoViewIfNeeded();
        const box = await explorer.locator("svg").first().boundingBox();
        await page.mouse.move(box.x + box.width * 0.2, box.y + box.height * 0.2);
        await page.mouse.down();
        await page.mouse.move(box.x + box.width * 0.5, box.y + box.height * 0.8, { steps: 5 });
        await page.mouse.up();
        assert.ok((await dots()) < all, "zoomed");
        await explorer.getByRole("button", { name: "Whole" }).click();
        assert.equal(await dots(), all);
        await explorer.getByLabel("Up").selectOption("block.peak_acceleration_m_per_s2");
        assert.match(await explorer.locator("text.axis").first().textContent(), /^Block peak acceleration \(.+\)$/);
        for (const [name, ending] of [["CSV", /\.csv$/], ["SVG", /\.svg$/], ["PNG", /\.png$/]]) {
          const [got] = await Promise.all([page.waitForEvent("download"), explorer.getByRole("button", { name, exact: true }).click()]);
          assert.match(got.suggestedFilename(), ending);
        }
        // By keyboard: to a run, and into it.
        await explorer.locator("svg").first().focus();
        await page.keyboard.press("ArrowRight");
        assert.notEqual(await explorer.locator(".readout").innerText(), "");
        await page.keyboard.press("Enter");
        await settled(page);
        assert.equal(await page.locator("#tab-motion").getAttribute("aria-selected"), "true");
      },
      { acceptDownloads: true, colorScheme: "dark" },
    ));

  test("demand, measure and what is varied are chosen from lists with units", () =>
    on(async (page) => {
      await page.locator("#tab-ida").click();
      const panel = page.locator("#panel-ida");
      await panel.locator("[name=measure]").waitFor();
      await panel.getByLabel("Measure: choose").selectOption("Sa");
      assert.equal(await panel.locator("[name=measure]").inputValue(), "Sa(1 s)");
      // The field says the name of what it is of, not the key.
      const demand = panel.locator("[name=demand]");
      const named = () => demand.evaluate((select) => select.selectedOptions[0].textContent);
      assert.match(await named(), /^Peak sliding displacement \(.*m\)$/);
      await demand.selectOption("block.peak_acceleration_m_per_s2");
      assert.match(await named(), /^Block peak acceleration \(m\/s²\)$/);
      assert.equal(await panel.locator("[name=demand]").inputValue(), "block.peak_acceleration_m_per_s2");
      await panel.getByText("More", { exact: true }).click();
      await panel.getByLabel("Vary: key").selectOption("slider.radius");
      await panel.getByRole("button", { name: "Add" }).click();
      assert.match(await panel.locator("[name=vary]").inputValue(), /^slider\.radius=[\d.]+\.\.[\d.]+ m:3$/);
    }));

  test("forty records are dropped at once, are told in one table, and count on every tab", () =>
    on(async (page) => {
      const files = Array.from({ length: 40 }, (_, i) => [`r${String(i).padStart(2, "0")}.csv`, sine(1 + 0.1 * i, 3 + 0.2 * i)]);
      await drop(page, ...files);
      await page.evaluate(() => globalThis.dropped);
      assert.equal(await page.locator("#tab-suite").getAttribute("aria-selected"), "true");
      const rows = page.locator(".workbench tbody tr");
      assert.equal(await rows.count(), 43);
      await page.waitForFunction(() => [...document.querySelectorAll(".workbench tbody tr")].every((row) => row.children[4].textContent !== ""), null, { timeout: 30000 });
      const cells = await rows.nth(3).locator("th, td").allInnerTexts();
      assert.equal(cells[1], "r00.csv");
      assert.match(cells[4], /^0\.10[12]\d* g$/, "PGA");
      assert.match(cells[5], /m\/s$/);
      assert.match(cells[6], /g$/);
      await page.locator("#panel-suite [name=scale-to]").fill("0.4 g");
      await page.locator("#panel-suite [name=scale-to]").blur();
      assert.match(await rows.nth(3).locator("td").nth(1).innerText(), /^3\.9\d+$/);
      await page.locator(".workbench thead input").click();
      await rows.nth(5).locator("input").click();
      await page.locator("#tab-ida").click();
      const ticked = await page.locator("#panel-ida .workbench tbody input").evaluateAll((all) => all.filter((box) => box.checked).length);
      assert.equal(ticked, 1);
    }));

  test("how far an analysis is, is seen from any tab", () =>
    on(async (page) => {
      await page.locator("#tab-study").click();
      const plan = page.locator("#panel-study textarea");
      await plan.fill((await plan.inputValue()).replace("count  = 64", "count  = 16384"));
      await page.locator("#panel-study button.main").click();
      await page.locator("#tab-motion").click();
      await page.waitForFunction(() => /\d %/.test(document.querySelector("#tab-study .running")?.textContent ?? ""), null, { timeout: 30000 });
      await page.locator("#tab-study").click();
      await page.locator("#panel-study").getByRole("button", { name: "Cancel" }).click();
      await page.locator("#tab-study .running").waitFor({ state: "detached" });
      assert.ok((await headline(page)).length > 0);
    }));
}
