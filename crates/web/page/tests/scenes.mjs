// The guided scenes: their figures are the command's, their words are true of them.

import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { MOVING, ran, settled, temporary } from "./harness.mjs";

/** What the words of an answer claim of the figures of its runs. */
const CLAIMS = {
  sticking: ({ below, above, heavy }) => [below.slips === 0, below.peak_m === 0, above.slips > 0, Math.abs(heavy.peak_m / above.peak_m - 1) < 1e-9],
  "static-kinetic": ({ higher, equal, strong, strongEqual }) => [higher.slips === 0, equal.slips > 20, Math.abs(strong.peak_m / strongEqual.peak_m - 1) < 0.2],
  residual: ({ flat, ten, two, half }) => [ten, two, half].every(({ residual_m }, i, all) => Math.abs(residual_m) < Math.abs((all[i - 1] ?? flat).residual_m)),
  resonance: (all) => {
    const runs = Object.entries(all).map(([f, { roof_m_per_s2 }]) => [Number(f), roof_m_per_s2]).sort(([a], [b]) => a - b);
    const above = runs.filter(([, roof]) => roof > 1).map(([f]) => f);
    const [at] = runs.reduce((a, b) => (b[1] > a[1] ? b : a));
    // One stretch without a gap, that of the chapter on the paper (1.54 to 1.94 Hz from rest), to the step looked at.
    const whole = Math.round((above.at(-1) - above[0]) / 0.05) + 1 === above.length;
    return [whole, above[0] === 1.55, above.at(-1) === 1.9, at > 1.625, Math.abs(at - 1.734) < 0.05, above.length < runs.length / 4];
  },
  stop: ({ narrow, middle, wide }) => [wide.peak_m < 0.08, middle.peak_m < wide.peak_m, narrow.peak_m < middle.peak_m, middle.block_m_per_s2 > 1.5 * wide.block_m_per_s2, narrow.block_m_per_s2 > 1.5 * wide.block_m_per_s2],
  bounds: ({ lower, nominal, upper }) => [lower.peak_m > nominal.peak_m, nominal.peak_m > upper.peak_m, upper.baseShear > lower.baseShear],
  vertical: ({ none, one, two }) => [one.peak_m !== none.peak_m, two.peak_m !== none.peak_m],
  "two-directions": (all) => [all[0].peak_m > 1.02 * all.alone.peak_m],
};

export function scenes(test, on, site) {
  test("eight guided scenes: question, what to drag, what to see, an answer of the command's figures, a code", () =>
    on(async (page) => {
      const command = process.env.SLIPSTICK_COMMAND;
      const out = temporary();
      const ids = Object.keys(CLAIMS);
      try {
        await page.getByText("Guided scenes", { exact: true }).click();
        const buttons = page.locator(".menu[open] button");
        assert.equal(await buttons.count(), ids.length);
        await buttons.first().click();
        for (const id of ids) {
          await settled(page);
          const card = page.locator(".guide");
          assert.equal(await page.evaluate(() => globalThis.slipstick.guides.id), id);
          assert.equal(await card.locator("dt").allInnerTexts().then(String), "Drag,See");
          for (const step of await card.locator("dd .actions button").all()) {
            const text = await page.locator("#model-text").inputValue();
            await step.click();
            await settled(page);
            assert.ok(!(await page.locator(".note-bar:not(.busy)").isVisible()), `${id}: ${await step.innerText()}`);
            assert.ok((await page.locator("#model-text").inputValue()) !== text || (await card.locator("dd .actions button").count()) > 0);
          }
          await card.getByRole("button", { name: "Show the answer" }).click();
          await card.locator(".answer h3").waitFor({ timeout: 60000 });
          const answer = await card.locator(".answer").innerText();
          assert.ok(!/NaN|undefined|Infinity/.test(answer), answer);
          assert.ok(!/e[-−]\d/.test(await page.locator(".headline").innerText()), `${id}: no figure of rounding`);
          console.log(`    ${id}: ${answer.replace(/\s+/g, " ")}`);
          const found = await page.evaluate(() => Object.fromEntries(Object.entries(globalThis.slipstick.guides.found).map(([name, { headline }]) => [name, headline])));
          const claims = [CLAIMS[id](found)].flat();
          assert.deepEqual(claims.filter((holds) => holds !== true), [], `${id}: ${JSON.stringify(found).slice(0, 900)}`);
          if (command) {
            const runs = await page.evaluate(async () => {
              const { guide } = globalThis.slipstick.guides;
              return Object.entries(guide.runs).map(([name, { text = guide.model, set = [] }]) => [name, text, set]);
            });
            const records = await page.evaluate(() => [...globalThis.slipstick.desk.records].map(([name, bytes]) => [name, new TextDecoder().decode(bytes)]));
            mkdirSync(join(out.folder, "records"), { recursive: true });
            for (const [name, text] of records) writeFileSync(join(out.folder, name), text);
            // Of many runs some: each is a call of the command.
            for (const [name, text, set] of runs.filter((_, i) => runs.length < 6 || i % 6 === 0)) {
              writeFileSync(join(out.folder, "model.toml"), text);
              const words = ["run", "model.toml", "--json", "-q", ...set.flatMap(([path, value]) => ["--set", `${path}=${value}`])];
              const there = JSON.parse(await ran(command, words, { cwd: out.folder }));
              assert.equal(found[name].peak_m, there.peak_sliding_displacement_m, `${id}, ${name}`);
              assert.equal(found[name].residual_m, there.residual_sliding_displacement_m, `${id}, ${name}`);
              assert.equal(found[name].block_m_per_s2, there.block.peak_acceleration_m_per_s2, `${id}, ${name}`);
              assert.equal(found[name].slips, there.slip_count, `${id}, ${name}`);
              if (found[name].roof_m_per_s2 !== null) assert.equal(found[name].roof_m_per_s2, there.storeys.at(-1).peak_acceleration_m_per_s2, `${id}, ${name}`);
            }
          }
          const next = card.getByRole("button", { name: "Next scene" });
          if (id !== ids.at(-1)) await next.click();
          else assert.equal(await next.count(), 0);
        }
        if (!command) return "skipped: SLIPSTICK_COMMAND names no command";
      } finally {
        out.remove();
      }
    }));

  for (const [width, height] of [[1440, 900], [1024, 768], [390, 844]]) {
    test(`a scene begins at its start, with what is to be dragged in view, at ${width} × ${height}`, () =>
      on(
        async (page) => {
          for (const id of Object.keys(CLAIMS)) {
            const time = await page.evaluate((id) => {
              const { desk, guides } = globalThis.slipstick;
              const hear = desk.onanswer;
              return new Promise((done) => {
                desk.onanswer = (answered) => {
                  hear(answered);
                  desk.onanswer = hear;
                  done(globalThis.slipstick.time);
                };
                guides.open(id);
              });
            }, id);
            assert.equal(time, 0, `${id} begins at its start`);
            await page.waitForFunction((id) => globalThis.slipstick.desk.rests && globalThis.slipstick.guides.id === id && document.querySelector(".second input[type=range]"), id);
            // It is brought into view with the next frame.
            await page.waitForFunction(() => document.querySelector(".second input[type=range]").getBoundingClientRect().bottom <= innerHeight, null, { timeout: 3000 }).catch(() => {});
            const scene = await page.locator(".scene").boundingBox();
            const control = await page.locator(".second input[type=range]").boundingBox();
            assert.ok(control.y >= 0 && control.y + control.height <= height, `${id}: its control from ${control.y} to ${control.y + control.height} px`);
            assert.ok(control.y >= scene.y + scene.height - 1 || control.x + control.width <= scene.x, `${id}: its control is not behind the picture`);
            const before = await page.evaluate(() => globalThis.slipstick.updates);
            await page.mouse.move(control.x + control.width * 0.5, control.y + control.height / 2);
            await page.mouse.down();
            await page.mouse.move(control.x + control.width * 0.55, control.y + control.height / 2, { steps: 3 });
            await page.mouse.up();
            await settled(page);
            assert.ok((await page.evaluate(() => globalThis.slipstick.updates)) > before, `${id}: it is followed`);
          }
        },
        { ...MOVING, viewport: { width, height } },
      ));
  }

  test("the bar of space plays and pauses from anywhere that is not a field", () =>
    on(async (page) => {
      await page.evaluate(() => globalThis.slipstick.guides.open("sticking"));
      await settled(page);
      const label = () => page.locator(".play").getAttribute("aria-label");
      const turns = async (why) => {
        const before = await label();
        await page.keyboard.press("Space");
        assert.notEqual(await label(), before, why);
      };
      await page.locator("footer").click();
      await turns("from the page itself");
      await page.getByRole("button", { name: "1.7 m/s²" }).click();
      await settled(page);
      await turns("after a button was pressed by a pointer");
      await page.locator(".second input[type=range]").focus();
      await turns("from a slider");
      await page.locator("#model-text").focus();
      const before = await label();
      await page.keyboard.press("Space");
      assert.equal(await label(), before, "a field takes it as a letter");
      // By keyboard a button is pressed.
      await page.locator(".play").focus();
      await page.keyboard.press("Tab");
      await page.keyboard.press("Shift+Tab");
      await page.keyboard.press("Space");
      assert.notEqual(await label(), before);
    }, MOVING));

  test("a scene opens by its short link, in the frame of another page too, and Close ends it", () =>
    on(
      async (page, { context }) => {
        assert.match(await page.locator(".guide h2").innerText(), /Resonance/);
        assert.match(await page.locator("#model-text").inputValue(), /1\.625 Hz/);
        await page.getByText("Embed this scene").click();
        const code = await page.getByLabel("Code to embed the scene").inputValue();
        assert.match(code, /^<iframe src="http:\/\/localhost:\d+\/#scene\.resonance" title="Slipstick: Resonance/);
        // Changed within a scene, the long link keeps the scene.
        await page.getByRole("button", { name: "2.5 Hz" }).click();
        await page.waitForFunction(() => location.hash.startsWith("#v1."));
        await settled(page);
        await page.waitForTimeout(200);
        const again = await context.newPage();
        await again.goto(page.url());
        await settled(again);
        assert.match(await again.locator(".guide h2").innerText(), /Resonance/);
        assert.match(await again.locator("#model-text").inputValue(), /frequency = "2\.5 Hz"/);
        await again.close();
        await page.locator(".guide").getByRole("button", { name: "Close" }).click();
        assert.ok(!(await page.locator(".guide").isVisible()));
        // As another page takes it up.
        const host = await context.newPage();
        await host.route("**/lesson.html", (route) => route.fulfill({ contentType: "text/html", body: `<!DOCTYPE html><title>A lesson</title>${code}` }));
        await host.goto(`${site.url}lesson.html`);
        const frame = host.frameLocator("iframe");
        await frame.locator(".guide h2", { hasText: "Resonance" }).waitFor();
        assert.ok(await frame.locator(".scene").isVisible());
        assert.ok(!(await frame.locator(".tabs").isVisible()), "the tabs are the whole page's");
        await host.close();
      },
      MOVING,
      `${site.url}#scene.resonance`,
    ));

  test("a scene that is not there is said, and the example is shown", () =>
    on(
      async (page) => {
        assert.match(await page.locator(".note-bar:not(.busy)").innerText(), /expected a guided scene, found "nothing"/);
        assert.match(await page.locator(".brand span").innerText(), /One storey/);
      },
      {},
      `${site.url}#scene.nothing`,
    ));
}
