// The first minute: what is what, in words and in view.

import assert from "node:assert/strict";
import { setField, slider } from "./fields.mjs";
import { MOVING, settled } from "./harness.mjs";

const at = (page, time) =>
  page.evaluate(async (time) => {
    globalThis.slipstick.stage.stopAt(time);
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const { parts, said } = globalThis.slipstick.stage.scene;
    return { parts: parts.map(({ name, box }) => ({ name, box })), said, width: document.querySelector(".scene").clientWidth };
  }, time);

const instants = (page, count) => page.evaluate((count) => Array.from({ length: count }, (_, i) => (globalThis.slipstick.stage.end * i) / (count - 1)), count);

/** Names of what is in the picture over the whole motion. */
async function seen(page, count) {
  const names = new Set();
  for (const time of await instants(page, count)) for (const { name } of (await at(page, time)).parts) names.add(name);
  return names;
}

export function minute(test, on) {
  test("the picture says what is what: by the pointer, by a tap, as a list", () =>
    on(async (page) => {
      assert.match(await page.locator(".welcome").innerText(), /^[^.]+\.$/, "one sentence");
      const names = await seen(page, 40);
      for (const name of ["Shaking table", "Block", "Dish", "Gap", "Start", "Friction", "Friction over weight", "How far it has slid"]) assert.ok(names.has(name), `${name} of ${[...names]}`);
      const peak = await page.evaluate(() => globalThis.slipstick.answer.state.headline.peakTime_s);
      const { parts } = await at(page, peak);
      const [left, top, width, height] = parts.find(({ name }) => name === "Block").box;
      await page.locator(".scene").hover({ position: { x: left + width / 2, y: top + height / 2 } });
      assert.match(await page.locator(".tip").innerText(), /^Block The rigid base/);
      await page.mouse.move(2, 2);
      await page.locator(".tip").waitFor({ state: "hidden" });
      await page.locator(".legend summary").click();
      const listed = await page.locator(".parts dt").allInnerTexts();
      for (const name of ["Shaking table", "Block", "Dish", "Gap"]) assert.ok(listed.includes(name), `${name} is listed`);
    }));

  test("no figure of the headline runs into the next, at three widths", () =>
    on(async (page) => {
      await page.getByRole("button", { name: "Pin as B" }).click();
      await page.waitForFunction(() => globalThis.slipstick.compare.pinned);
      for (const scene of [undefined, "resonance"]) {
        if (scene) await page.evaluate((scene) => globalThis.slipstick.guides.open(scene), scene);
        await settled(page);
        for (const width of [1440, 1024, 390]) {
          await page.setViewportSize({ width, height: 900 });
          const cut = await page.locator(".headline dt, .headline dd").evaluateAll((all) => all.filter((one) => one.scrollWidth > one.clientWidth + 1).map((one) => one.textContent));
          assert.deepEqual(cut, [], `${width} px`);
        }
      }
    }));

  test("what a tap tells stays", () =>
    on(
      async (page) => {
        await at(page, 0);
        const { parts } = await at(page, await page.evaluate(() => globalThis.slipstick.answer.state.headline.peakTime_s));
        const [left, top, width] = parts.find(({ name }) => name === "Shaking table").box;
        await page.locator(".scene").tap({ position: { x: left + width / 4, y: top + 16 } });
        await page.waitForTimeout(200);
        assert.match(await page.locator(".tip").innerText(), /^Shaking table/);
        const [tip, scene] = [await page.locator(".tip").boundingBox(), await page.locator(".scene").boundingBox()];
        assert.ok(tip.x >= scene.x && tip.x + tip.width <= scene.x + scene.width, "it is within the picture");
      },
      { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true },
    ));

  test("every axis has a title and a unit", () =>
    on(async (page) => {
      for (const choice of ["energy", "storeys", "force", "velocity"]) {
        await page.getByLabel("What the third picture shows").selectOption(choice);
        const labels = await page.evaluate(() => globalThis.slipstick.clock.charts.map(({ plot }) => plot.axes.map(({ label }) => label)));
        for (const [x, y] of labels) {
          assert.equal(x, "Time (s)");
          assert.match(y, /^[A-Z][a-z]+ \(\S+\)$/);
        }
      }
    }));

  test("magnified or not, block and frame stay in the picture", () =>
    on(async (page) => {
      for (const example of ["One storey, Taft 1952", "Frame on pendulum sliders", "Rigid block, sine"]) {
        await page.getByText("Examples", { exact: true }).click();
        await page.getByRole("button", { name: example }).click();
        await settled(page);
        for (const scale of ["true", "magnified"]) {
          await page.getByLabel("Displacements").selectOption(scale);
          const all = await page.evaluate(async (times) => {
            const { stage } = globalThis.slipstick;
            const drawn = [];
            for (const time of times) {
              stage.stopAt(time);
              // The frame of that instant, as the browser's clock would have it drawn.
              stage.tick(performance.now(), true);
              drawn.push({ time, parts: stage.scene.parts.map(({ name, box }) => ({ name, box })), width: document.querySelector(".scene").clientWidth });
            }
            return drawn;
          }, await instants(page, 60));
          for (const { time, parts, width } of all) {
            for (const { name, box: [left, , wide] } of parts) {
              if (/^(Shaking table|Gap|Dish|Spring)$/.test(name)) continue;
              assert.ok(left > -2 && left + wide < width + 2, `${example}, ${scale}, ${time.toFixed(2)} s: ${name} from ${left.toFixed()} to ${(left + wide).toFixed()} of ${width}`);
            }
          }
        }
      }
    }));

  for (const [what, viewport, near] of [["a phone", { width: 390, height: 844 }, 0.55], ["a desk", { width: 1300, height: 900 }, 1]]) {
    test(`on ${what} the picture stays in view while any slider is dragged`, () =>
      on(
        async (page) => {
          for (const label of ["Static friction", "Radius of the pendulum", "Peak acceleration of the table", "Damping ratio", "Mass of the block"]) {
            const one = slider(page, label);
            await one.scrollIntoViewIfNeeded();
            if (what === "a phone") await one.evaluate((element) => element.scrollIntoView({ block: "end" }));
            const box = await one.boundingBox();
            const scene = await page.locator(".scene").boundingBox();
            assert.ok(scene.y >= -1 && scene.y + scene.height <= near * viewport.height, `${label}: the picture from ${scene.y.toFixed()} to ${(scene.y + scene.height).toFixed()} px`);
            assert.ok(box.y > scene.y + scene.height || box.x + box.width < scene.x, `${label} is not behind it`);
            const before = await page.evaluate(() => globalThis.slipstick.updates);
            await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
            await page.mouse.down();
            await page.mouse.move(box.x + box.width * 0.6, box.y + box.height / 2, { steps: 6 });
            await page.mouse.up();
            await settled(page);
            assert.ok((await page.evaluate(() => globalThis.slipstick.updates)) > before, `${label} is followed`);
          }
        },
        { ...MOVING, viewport },
      ));
  }

  test("the block stops at a stop; beyond a gap the picture says that it would not", () =>
    on(async (page) => {
      await setField(page, "Gap", "20 mm");
      await settled(page);
      const peak = () => page.evaluate(() => globalThis.slipstick.answer.state.headline.peakTime_s);
      assert.match((await at(page, await peak())).said, /beyond its gap: a wall there would stop it/);
      assert.ok(!/gap|stop/.test((await at(page, 0)).said));
      const text = await page.locator("#model-text").inputValue();
      await page.locator("#model-text").fill(text.replace(/^gap.*\n/m, "").replace(/^\[\[storey/m, '[slider.stop]\ngap = "20 mm"\nrestitution = 0.3\n\n[[storey'));
      await page.waitForFunction(() => globalThis.slipstick.answer.state.structure.stop_m);
      await settled(page);
      let struck = false;
      for (const time of [...(await instants(page, 80)), await peak()]) {
        const { parts, said } = await at(page, time);
        const block = parts.find(({ name }) => name === "Block").box;
        const walls = parts.filter(({ name }) => name === "Stop").map(({ box }) => box[0] + 9);
        assert.ok(walls.every((x) => (x > block[0] + block[2] / 2 ? x >= block[0] + block[2] - 1 : x <= block[0] + 1)), `${time}: ${walls} ${block}`);
        struck ||= /at the stop/.test(said);
      }
      assert.ok(struck, "it came to the stop");
    }));
}
