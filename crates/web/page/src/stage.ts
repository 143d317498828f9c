/** The animation and its transport: play, pause, scrub, speed. */

import { fill, h } from "./dom";
import { Legend } from "./legend";
import type { Clock } from "./plots";
import { Loop, type Palette, palette, Plan, Scene, type Shown } from "./scene";
import type { Answer } from "./types";

const ICON = { play: "M4 2.5v11l9-5.5z", pause: "M3.5 2.5h3v11h-3zM9.5 2.5h3v11h-3z" };

function icon(path: string): SVGSVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("aria-hidden", "true");
  const shape = document.createElementNS("http://www.w3.org/2000/svg", "path");
  shape.setAttribute("d", path);
  svg.append(shape);
  return svg;
}

/** How often figures that run with time are written while it plays, in ms: faster, they cannot be read. */
const WRITTEN_MS = 120;

export class Stage {
  readonly element: HTMLElement;
  /** Force on the slider over sliding displacement. */
  readonly loopBox: HTMLElement;
  readonly canvas = h("canvas", { class: "scene", role: "img", "aria-label": "Animation of table, block and storeys" });
  /** The present instant in s. */
  time = 0;
  /** It has to be drawn again. */
  stale = true;
  playing = false;
  speed = 1;
  private shown: Shown | undefined;
  private pinned: Answer | undefined;
  private readonly legend: Legend;
  private drawnAt = 0;
  /** The next answer is shown from its start. */
  private begins = false;
  private writtenAt = 0;
  private readonly scene: Scene;
  private readonly plan: Plan;
  private readonly planCanvas = h("canvas", { class: "plan", role: "img", "aria-label": "The way of the block from above", hidden: true });
  private readonly loop: Loop;
  private readonly playButton = h("button", { type: "button", class: "main play", "aria-label": "Play" }, icon(ICON.play));
  private readonly scrub = h("input", { type: "range", min: 0, max: 1, step: 0.001, value: 0, class: "scrub", "aria-label": "Time" });
  private readonly clockText = h("output", {}, "0.00 s");

  constructor(
    headline: HTMLElement,
    severe: HTMLElement,
    compare: HTMLElement,
    private readonly clock: Clock,
  ) {
    this.scene = new Scene(this.canvas);
    this.legend = new Legend(this.canvas, () => this.scene.parts);
    const speeds = h("select", {}, ...[0.1, 0.25, 0.5, 1, 2, 5].map((x) => h("option", { value: x, selected: x === 1 }, `× ${x}`)));
    speeds.addEventListener("change", () => (this.speed = Number(speeds.value)));
    const scales = h("select", {}, h("option", { value: "true" }, "true to scale"), h("option", { value: "magnified" }, "magnified"));
    scales.addEventListener("change", () => {
      this.scene.magnified = scales.value === "magnified";
      this.stale = true;
    });
    const whole = h("button", { type: "button", hidden: true }, "Whole record");
    whole.addEventListener("click", () => clock.zoom(null));
    this.element = h(
      "section",
      { class: "card stage", "aria-label": "Motion" },
      h("div", { class: "picture" }, headline, severe, this.canvas, this.legend.tip),
      h("details", { class: "fold legend" }, h("summary", {}, "What is what"), this.legend.list),
      this.planCanvas,
      h("div", { class: "transport" }, this.playButton, this.scrub, this.clockText, h("label", {}, "Speed", speeds), h("label", {}, "Displacements", scales), whole),
      compare,
    );
    const loop = h("canvas", { class: "loop", role: "img", "aria-label": "Force on the slider over sliding displacement" });
    const dot = h("div", { class: "dot" });
    this.loopBox = h("div", { class: "loop-box" }, loop, dot);
    this.plan = new Plan(this.planCanvas);
    this.loop = new Loop(loop, dot);
    this.playButton.addEventListener("click", () => this.play(!this.playing));
    this.scrub.addEventListener("input", () => this.stopAt(Number(this.scrub.value)));
    clock.onpoint = (time) => {
      if (!this.playing) this.seek(time);
    };
    clock.onzoom = (zoomed) => (whole.hidden = !zoomed);
  }

  /** Colours of the place where the canvases are. */
  restyle(): Palette {
    this.scene.restyle();
    this.plan.restyle();
    this.loop.restyle();
    this.stale = true;
    return palette(this.canvas);
  }

  play(on: boolean): void {
    this.playing = on;
    fill(this.playButton, icon(on ? ICON.pause : ICON.play));
    this.playButton.setAttribute("aria-label", on ? "Pause" : "Play");
  }

  seek(time: number): void {
    this.time = time;
    this.stale = true;
  }

  /** Shows what comes next from its start, all of it. */
  begin(): void {
    this.begins = true;
    this.seek(0);
    this.clock.zoom(null);
  }

  stopAt(time: number): void {
    this.play(false);
    this.seek(time);
  }

  /** Takes what is to move. The first picture is a telling one: it starts before the peak, or stands at it. */
  take(shown: Shown): void {
    if (this.begins) this.time = 0;
    else if (!this.shown) {
      const peak = shown.answer.state.headline.peakTime_s;
      this.time = this.playing ? Math.max(0, peak - 4) : peak;
    }
    this.begins = false;
    this.shown = shown;
    this.planCanvas.hidden = shown.answer.sy.length === 0;
  }

  /** Draws what does not move with time, and B where one is kept. */
  draw(pinned: Answer | undefined): void {
    const { shown, end } = this;
    if (!shown) return;
    this.pinned = pinned;
    this.scrub.max = String(end);
    this.scrub.step = String(Math.max(0.001, end / 5000));
    this.loop.show(shown.answer, pinned);
    this.stale = true;
  }

  /** The frame of an instant of the browser's clock, in ms; drawn where it can be seen. */
  tick(now: number, visible: boolean): void {
    const { shown, clock, end } = this;
    if (!shown) return;
    if (this.playing) {
      this.time += Math.min(0.1, (now - this.drawnAt) / 1000) * this.speed;
      const [from, to] = clock.zoomed ?? [0, end];
      if (this.time > to || this.time < from) this.time = from;
      this.stale = true;
    }
    this.drawnAt = now;
    if (!this.stale || !visible) return;
    this.stale = false;
    this.time = Math.min(this.time, end);
    this.scene.draw(shown, this.time, this.pinned);
    if (!this.planCanvas.hidden) this.plan.draw(shown, this.time, this.pinned);
    this.loop.mark(shown.answer, this.time);
    clock.now(this.time);
    if (!this.playing || now - this.writtenAt > WRITTEN_MS) {
      this.writtenAt = now;
      this.clockText.textContent = `${this.time.toFixed(2)} s`;
      for (const chart of clock.charts) chart.tell(this.time);
      this.legend.update();
    }
    if (!this.scrub.matches(":active")) this.scrub.value = String(this.time);
    this.scrub.style.setProperty("--at", `${end > 0 ? (100 * this.time) / end : 0}%`);
  }

  /** By keyboard: + and − around the present instant, 0 the whole record. */
  zoomBy(key: string): void {
    const { clock, end } = this;
    const [from, to] = clock.zoomed ?? [0, end];
    const span = key === "0" ? Infinity : (to - from) * (key === "+" ? 0.5 : 2);
    if (span >= end) clock.zoom(null);
    else {
      const start = Math.min(Math.max(0, this.time - span / 2), end - span);
      clock.zoom([start, start + span]);
    }
  }

  /** The part that is shown; without a zoom, twelve seconds around the peak. */
  get span(): [number, number] {
    if (this.clock.zoomed) return this.clock.zoomed;
    const peak = this.shown?.answer.state.headline.peakTime_s ?? 0;
    return [Math.max(0, peak - 4), Math.min(this.end, peak + 8)];
  }

  private get end(): number {
    return this.shown?.answer.time.at(-1) ?? 0;
  }
}
