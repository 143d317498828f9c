/** The page: state in, pictures out. It draws; the workers compute. */

import { Controls } from "./controls";
import { Desk, type Engine, ModuleError, type Wish } from "./desk";
import { digits, download, drawing, fill, h } from "./dom";
import { MODELS, RECORDS, START } from "./examples";
import { Intake } from "./intake";
import { onMade, onRecord, type RecordChoice } from "./motion";
import { Chart, Clock, intervals } from "./plots";
import * as results from "./results";
import { Loop, type Palette, palette, Scene, type Shown } from "./scene";
import { decode, encode } from "./share";
import { type StudyTab, type Tab, tabs, warningList } from "./studies";
import uplotStyle from "uplot/dist/uPlot.min.css";
import type { Answer, Display, Drawing, Fault, Judgement, Setting } from "./types";

void uplotStyle;

export interface Options {
  /** The model's text; the address or the example where it is not given. */
  model?: string;
  /** Records besides those that the page carries. */
  records?: { name: string; bytes: Uint8Array }[];
  /** Whether the state is kept in the address. */
  address: boolean;
  /** Told of every state at rest. */
  onstate?: (state: { model: string; summary: string }) => void;
}

const SYSTEMS: [Display, string][] = [
  ["si", "SI"],
  ["si-g", "SI, accelerations in g"],
  ["kN-mm", "mm, kN, t"],
  ["us", "in, kip, lb"],
];

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

export class App {
  readonly root: HTMLElement;
  readonly desk: Desk;
  private text = START;
  private display: Display = "si";
  private tab = "motion";
  private pending: Setting[] = [];
  /** What the last answer answers. */
  private good: Wish = { text: "", set: [], display: "si" };
  private answer: Answer | undefined;
  private judgement: Judgement | undefined;
  private shown: Shown | undefined;
  private readonly own = new Map<string, { sha256: string; choice: RecordChoice }>();

  private readonly intake: Intake;
  private readonly clock = new Clock();
  private scene!: Scene;
  private loop!: Loop;
  private colours!: Palette;
  private charts!: { sliding: Chart; acceleration: Chart; third: Chart };
  private readonly controls: Controls;
  private tabs: Tab[] = [];
  private study!: StudyTab;

  private time = 0;
  private playing = false;
  private speed = 1;
  private frame = 0;
  private stale = true;
  private drawnAt = 0;
  private toldAt = 0;
  /** For the measurements: pictures drawn of new answers. */
  updates = 0;

  // Elements that change.
  private readonly title = h("span", {}, "");
  private readonly bar = h("div", { class: "note-bar", role: "alert", hidden: true });
  private readonly busyBar = h("div", { class: "note-bar busy", role: "status", hidden: true });
  private readonly live = h("p", { class: "hidden", role: "status", "aria-live": "polite" });
  private readonly headline = h("dl", { class: "headline" });
  private readonly sceneCanvas = h("canvas", { class: "scene", role: "img", "aria-label": "Animation of table, block and storeys" });
  private readonly loopCanvas = h("canvas", { class: "loop", role: "img", "aria-label": "Force on the slider over sliding displacement" });
  private readonly loopDot = h("div", { class: "dot" });
  private readonly playButton = h("button", { type: "button", class: "main play", "aria-label": "Play" }, icon(ICON.play));
  private readonly scrub = h("input", { type: "range", min: 0, max: 1, step: 0.001, value: 0, class: "scrub", "aria-label": "Time" });
  private readonly clockText = h("output", {}, "0.00 s");
  private readonly reset = h("button", { type: "button", hidden: true }, "Whole record");
  private readonly certificate = h("section", { class: "certificate", "aria-label": "Certificate" });
  private readonly warnings = h("div", {});
  private readonly peaks = h("div", { class: "table-scroll", tabindex: 0, role: "region", "aria-label": "Peaks" });
  private readonly beside = h("div", {});
  private readonly events = h("div", { class: "table-scroll", tabindex: 0, role: "region", "aria-label": "Events" });
  private readonly editor = h("textarea", { spellcheck: "false", autocomplete: "off", autocapitalize: "off", wrap: "off" });
  private readonly editorFault = h("p", { class: "fault", hidden: true });
  private readonly recordList = h("ul", { class: "records" });
  private readonly motionBox = h("div", {});
  private readonly motionSelect = h("select", { id: "motion-source" });
  private readonly motionWords = h("p", { class: "drop-hint" });
  private readonly system = h("select", { "aria-label": "Units" });
  private readonly stepwise = h("input", { type: "checkbox" });
  private readonly third = h("select", { "aria-label": "What the third picture shows" });
  private readonly printed = h("div", { class: "print-only" });
  private readonly main = h("main", { id: "main" });
  private readonly motionPanel = h("div", { class: "motion" });
  private readonly tabBar = h("div", { class: "tabs", role: "tablist", "aria-label": "Analyses" });
  private readonly dropping = h("div", { class: "dropping", hidden: true }, "Drop records, a model or a plan");

  constructor(
    host: HTMLElement | ShadowRoot,
    engine: Engine,
    private readonly options: Options,
  ) {
    this.desk = new Desk(engine);
    this.controls = new Controls((settings) => this.set(settings), this.motionBox);
    this.root = h("div", { class: "slipstick" });
    host.append(this.root);
    this.intake = new Intake({
      desk: this.desk,
      root: this.root,
      own: this.own,
      text: () => this.text,
      setText: (text) => this.setText(text),
      wish: () => this.wish(),
      study: (plan) => {
        this.study.load(plan);
        this.select("study", true);
        void this.study.run();
      },
      listRecords: () => this.listRecords(),
      fault: (fault) => this.fault(fault),
    });
    this.theme();
    this.layout();
    this.wire();
    for (const record of RECORDS) this.desk.records.set(record.name, new TextEncoder().encode(record.text));
    for (const { name, bytes } of options.records ?? []) {
      this.desk.records.set(name, bytes);
      this.own.set(name, { sha256: "", choice: { name } });
    }
    void this.begin();
  }

  private async begin(): Promise<void> {
    void this.desk.helper.start();
    if (this.options.model !== undefined) this.text = this.options.model;
    else if (this.options.address && location.hash.length > 1) await this.fromAddress();
    this.editor.value = this.text;
    this.play(!matchMedia("(prefers-reduced-motion: reduce)").matches);
    this.wish();
  }

  // ---- layout

  private theme(): void {
    const dark = matchMedia("(prefers-color-scheme: dark)");
    const apply = () => {
      this.root.dataset.theme = dark.matches ? "dark" : "light";
      if (this.scene) this.restyle();
    };
    dark.addEventListener("change", apply);
    apply();
  }

  private restyle(): void {
    this.colours = palette(this.root);
    this.scene.restyle();
    this.loop.restyle();
    for (const chart of this.clock.charts) chart.restyle(this.colours);
    if (this.answer) this.drawAnswer();
    this.stale = true;
  }

  private layout(): void {
    const button = (label: string, act: () => void, attributes = {}) => h("button", { type: "button", onclick: act, ...attributes }, label);
    fill(this.system, ...SYSTEMS.map(([value, label]) => h("option", { value }, label)));
    const exports = h(
      "details",
      { class: "menu" },
      h("summary", {}, "Export"),
      h(
        "div",
        {},
        button("Model (TOML)", () => download("model.toml", this.text, "application/toml")),
        button("History (CSV)", () => void this.exportFile("history.csv", "text/csv")),
        button("Events (CSV)", () => void this.exportFile("events.csv", "text/csv")),
        button("Summary (JSON)", () => void this.exportFile("summary.json", "application/json")),
        button("Report (HTML)", () => void this.exportFile("report.html", "text/html")),
        button("Figures (SVG)", () => void this.exportFigures("svg")),
        button("Figures (PNG)", () => void this.exportFigures("png")),
        button("Animation as it stands (PNG)", () => this.exportScene()),
        button("Copy the command that repeats it", () => void this.copy(this.command(), "The command is in the clipboard.")),
        button("Print", () => void this.print()),
      ),
    );
    const models = h(
      "details",
      { class: "menu" },
      h("summary", {}, "Examples"),
      h("div", {}, ...MODELS.map(({ label, text }) => button(label, () => this.setText(text)))),
    );
    const open = h("input", { type: "file", multiple: true, class: "hidden", tabindex: -1, "aria-label": "Files" });
    open.addEventListener("change", () => {
      void this.intake.files([...(open.files ?? [])]);
      open.value = "";
    });
    const header = h(
      "header",
      { class: "top" },
      h("h1", { class: "brand" }, "Slipstick", this.title),
      h(
        "div",
        { class: "tools" },
        open,
        button("Open files…", () => open.click()),
        models,
        this.system,
        this.options.address && button("Copy link", () => void this.copy(location.href, "The link is in the clipboard.")),
        exports,
      ),
    );
    for (const menu of [exports, models]) {
      menu.addEventListener("click", (event) => {
        if ((event.target as Element).closest("button")) menu.open = false;
      });
      menu.addEventListener("keydown", (event) => {
        if (event.key === "Escape") {
          menu.open = false;
          menu.querySelector("summary")?.focus();
        }
      });
    }

    const speeds = h("select", {}, ...[0.1, 0.25, 0.5, 1, 2, 5].map((x) => h("option", { value: x, selected: x === 1 }, `× ${x}`)));
    speeds.addEventListener("change", () => (this.speed = Number(speeds.value)));
    const scales = h("select", {}, h("option", { value: "true" }, "true to scale"), h("option", { value: "magnified" }, "magnified"));
    scales.addEventListener("change", () => {
      this.scene.magnified = scales.value === "magnified";
      this.stale = true;
    });
    const stage = h(
      "section",
      { class: "card stage", "aria-label": "Motion" },
      this.headline,
      this.sceneCanvas,
      h(
        "div",
        { class: "transport" },
        this.playButton,
        this.scrub,
        this.clockText,
        h("label", {}, "Speed", speeds),
        h("label", {}, "Displacements", scales),
        this.reset,
      ),
    );

    fill(this.third, ...[["energy", "Energy"], ["storeys", "Storey displacements"], ["force", "Force on the slider"], ["velocity", "Sliding velocity"]].map(([value, label]) => h("option", { value }, label!)));
    const editorId = "model-text";
    this.editor.id = editorId;
    this.editor.setAttribute("aria-describedby", "model-fault");
    this.editorFault.id = "model-fault";
    this.motionBox.append(
      h("div", { class: "choice" }, h("label", { for: "motion-source" }, "Table moves by"), this.motionSelect),
      this.motionWords,
    );
    const controls = h(
      "section",
      { class: "controls", "aria-label": "Model" },
      h("div", { class: "card pad" }, this.controls.element),
      h("div", { class: "card pad" }, h("h2", {}, "Records"), this.recordList, h("p", { class: "drop-hint" }, "Drop a record of any of the 18 formats, a model or a plan anywhere on the page.")),
      h("details", { class: "card pad fold editor", open: true }, h("summary", {}, h("label", { for: editorId }, "Model text (TOML)")), this.editorFault, this.editor),
    );
    // A click on the label inside the summary would fold it away.
    controls.querySelector("summary label")?.addEventListener("click", (event) => event.preventDefault());

    this.root.append(
      h("a", { class: "skip", href: "#main", onclick: (event: Event) => { event.preventDefault(); this.main.focus(); } }, "To the model"),
      header,
      this.tabBar,
      this.bar,
      this.busyBar,
      this.main,
      h("footer", { class: "foot" }, "Exact to rounding between two events; everything is computed in this window, nothing is sent."),
      this.live,
      this.printed,
      this.dropping,
    );
    this.main.tabIndex = -1;
    this.colours = palette(this.root);
    const make = (head: (string | Node)[], height: number) => new Chart(this.clock, head, this.colours, height);
    this.charts = {
      sliding: make([h("h2", {}, "Sliding displacement")], 220),
      acceleration: make([h("h2", {}, "Accelerations")], 220),
      third: make([this.third], 200),
    };
    const plots = h("section", { class: "plots", "aria-label": "Histories" }, this.charts.sliding.element, this.charts.acceleration.element, this.charts.third.element);
    const results = h(
      "section",
      { class: "results", "aria-label": "Results" },
      this.certificate,
      h("div", { class: "card pad" }, h("h2", {}, "Force on the slider"), h("div", { class: "loop-box" }, this.loopCanvas, this.loopDot)),
      h("div", { class: "card pad peaks" }, h("h2", {}, "Peaks"), this.peaks, this.warnings),
      h("div", { class: "card pad" }, h("h2", {}, "Beside it"), h("label", { class: "switch" }, this.stepwise, "The paper's stepwise method"), this.beside),
      h("details", { class: "card pad fold" }, h("summary", {}, "Events"), this.events),
    );
    this.motionPanel.append(stage, controls, plots, results);
    this.scene = new Scene(this.sceneCanvas);
    this.loop = new Loop(this.loopCanvas, this.loopDot);

    const made = tabs({
      desk: this.desk,
      state: () => this.answer?.state,
      display: () => this.display,
      colours: () => this.colours,
      records: () => this.allRecords(),
      choice: (name) => RECORDS.find((record) => record.name === name) ?? this.own.get(name)?.choice ?? { name },
      text: () => this.text,
      set: (settings) => this.set(settings),
      say: (text) => (this.live.textContent = text),
      fault: (fault) => this.fault(fault),
    });
    this.tabs = [{ id: "motion", label: "Motion", element: this.motionPanel, open: () => {} }, ...made.all];
    this.study = made.study;
    for (const tab of this.tabs) {
      tab.element.id = `panel-${tab.id}`;
      tab.element.setAttribute("role", "tabpanel");
      tab.element.setAttribute("aria-labelledby", `tab-${tab.id}`);
      const select = h("button", { type: "button", role: "tab", id: `tab-${tab.id}`, "aria-controls": tab.element.id }, tab.label);
      select.addEventListener("click", () => this.select(tab.id, true));
      this.tabBar.append(select);
      this.main.append(tab.element);
    }
    this.tabBar.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (step === undefined) return;
      const at = this.tabs.findIndex((tab) => tab.id === this.tab);
      const next = this.tabs[(at + step + this.tabs.length) % this.tabs.length]!;
      this.select(next.id, true);
      (this.tabBar.querySelector(`#tab-${next.id}`) as HTMLElement).focus();
      event.preventDefault();
    });
    this.select("motion", false);
    this.listRecords();
    this.certify();
    // The colours are those of the place where the canvases now are.
    this.scene.restyle();
    this.loop.restyle();
  }

  private select(id: string, remember: boolean): void {
    this.tab = this.tabs.some((tab) => tab.id === id) ? id : "motion";
    for (const tab of this.tabs) {
      const on = tab.id === this.tab;
      tab.element.hidden = !on;
      const button = this.tabBar.querySelector(`#tab-${tab.id}`) as HTMLElement;
      button.setAttribute("aria-selected", String(on));
      button.tabIndex = on ? 0 : -1;
      if (on) tab.open();
    }
    if (this.tab === "motion" && this.answer) {
      this.drawAnswer();
      this.stale = true;
    }
    if (remember) void this.remember();
  }

  private wire(): void {
    const desk = this.desk;
    desk.onanswer = (answer, wish) => this.take(answer, wish);
    desk.onjudged = (judgement, wish) => this.judged(judgement, wish);
    desk.onfault = (fault, wish) => this.fault(fault, wish);
    desk.onrest = () => {
      void this.remember();
      this.announce();
      this.scheduleFigures();
    };
    desk.helper.onbusy = (busy) => {
      this.busyBar.hidden = !busy;
      if (!busy) return;
      const replace = h("button", { type: "button" }, "Start another");
      replace.addEventListener("click", () => {
        desk.helper.end();
        this.busyBar.hidden = true;
        this.live.textContent = "Another worker has started; what was shown stays.";
        void desk.helper.start();
      });
      fill(this.busyBar, h("p", {}, "The analysis has been at work for more than two seconds. What is shown is the last answer."), replace);
    };

    this.editor.addEventListener("input", () => {
      this.pending = [];
      this.text = this.editor.value;
      this.wish();
    });
    this.system.addEventListener("change", () => {
      this.display = this.system.value as Display;
      this.wish();
    });
    this.stepwise.addEventListener("change", () => {
      desk.stepwise = this.stepwise.checked;
      void desk.judge();
    });
    this.third.addEventListener("change", () => this.drawThird());
    this.motionSelect.addEventListener("change", () => this.chooseMotion(this.motionSelect.value));
    this.playButton.addEventListener("click", () => this.play(!this.playing));
    this.scrub.addEventListener("input", () => {
      this.play(false);
      this.seek(Number(this.scrub.value));
    });
    this.reset.addEventListener("click", () => this.clock.zoom(null));
    this.clock.onpoint = (time) => {
      if (!this.playing) this.seek(time);
    };
    this.clock.onzoom = (zoomed) => {
      this.reset.hidden = !zoomed;
    };
    const away = (event: PointerEvent) => {
      for (const menu of this.root.querySelectorAll<HTMLDetailsElement>("details.menu[open]")) {
        if (!event.composedPath().includes(menu)) menu.open = false;
      }
    };
    document.addEventListener("pointerdown", away);
    this.root.addEventListener("keydown", (event) => {
      const target = event.composedPath()[0] as HTMLElement;
      if (event.key === " " && !/^(INPUT|TEXTAREA|SELECT|BUTTON|SUMMARY|A)$/.test(target.tagName)) {
        event.preventDefault();
        this.play(!this.playing);
      }
      if (!/^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName) && !event.ctrlKey && !event.metaKey && /^[-+0]$/.test(event.key)) this.zoomBy(event.key);
    });
    let depth = 0;
    const carries = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
    this.root.addEventListener("dragenter", (event) => {
      if (!carries(event)) return;
      event.preventDefault();
      depth++;
      this.dropping.hidden = false;
    });
    this.root.addEventListener("dragover", (event) => carries(event) && event.preventDefault());
    this.root.addEventListener("dragleave", () => {
      depth = Math.max(0, depth - 1);
      if (depth === 0) this.dropping.hidden = true;
    });
    this.root.addEventListener("drop", (event) => {
      if (!carries(event)) return;
      event.preventDefault();
      depth = 0;
      this.dropping.hidden = true;
      void this.intake.files([...(event.dataTransfer?.files ?? [])]);
    });
    if (this.options.address) {
      addEventListener("popstate", () => {
        void this.fromAddress().then(() => {
          this.pending = [];
          this.editor.value = this.text;
          this.wish();
        });
      });
    }
    new ResizeObserver(() => {
      if (this.answer && this.tab === "motion") this.loop.show(this.answer);
      this.stale = true;
    }).observe(this.motionPanel);
    const step = (now: number) => {
      this.frame = requestAnimationFrame(step);
      this.tick(now);
    };
    this.frame = requestAnimationFrame(step);
  }

  // ---- state

  private wish(): void {
    this.desk.want({ text: this.text, set: [...this.pending], display: this.display });
  }

  /** Sets values of the model; the newest value of a key counts. */
  private set(settings: Setting[]): void {
    const keys = new Set(settings.map(([path]) => path));
    this.pending = [...this.pending.filter(([path]) => !keys.has(path)), ...settings];
    this.wish();
  }

  /** Takes a whole text. */
  private setText(text: string): void {
    this.pending = [];
    this.text = text;
    this.editor.value = text;
    this.wish();
  }

  private take(answer: Answer, wish: Wish): void {
    this.good = wish;
    this.bar.hidden = true;
    this.editorFault.hidden = true;
    this.editor.removeAttribute("aria-invalid");
    const before = this.shown;
    this.answer = answer;
    this.judgement = undefined;
    this.certify();
    const tableTimes = answer.tableTimes ?? before?.tableTimes ?? new Float64Array();
    const tableDisplacement = answer.tableDisplacement ?? before?.tableDisplacement ?? new Float64Array();
    let tablePeak = answer.tableDisplacement ? 0 : (before?.tablePeak ?? 0);
    if (answer.tableDisplacement) for (const u of tableDisplacement) tablePeak = Math.max(tablePeak, Math.abs(u));
    this.shown = { answer, tableTimes, tableDisplacement, tablePeak };
    if (!before) {
      // The first picture is a telling one.
      const start = Math.max(0, answer.state.headline.peakTime_s - 4);
      this.time = this.playing ? start : answer.state.headline.peakTime_s;
    }
    this.dirty = true;
  }

  private dirty = false;

  /** Draws what came since the last frame. */
  private tick(now: number): void {
    const answer = this.answer;
    if (!answer) return;
    if (this.dirty) {
      this.dirty = false;
      this.drawAnswer();
      this.updates++;
      if (this.updates === 1) performance.mark("first-picture");
    }
    const end = answer.time[answer.time.length - 1] ?? 0;
    if (this.playing) {
      this.time += Math.min(0.1, (now - this.drawnAt) / 1000) * this.speed;
      const [from, to] = this.clock.zoomed ?? [0, end];
      if (this.time > to || this.time < from) this.time = from;
      this.stale = true;
    }
    this.drawnAt = now;
    if (this.stale && this.tab === "motion" && this.shown) {
      this.stale = false;
      this.time = Math.min(this.time, end);
      this.scene.draw(this.shown, this.time);
      this.loop.mark(answer, this.time);
      this.clock.now(this.time);
      // Figures that change faster than they can be read cost more than the pictures.
      if (!this.playing || now - this.toldAt > 120) {
        this.toldAt = now;
        this.clockText.textContent = `${this.time.toFixed(2)} s`;
        for (const chart of this.clock.charts) chart.tell(this.time);
      }
      if (!this.scrub.matches(":active")) this.scrub.value = String(this.time);
      this.scrub.style.setProperty("--at", `${end > 0 ? (100 * this.time) / end : 0}%`);
    }
  }

  private seek(time: number): void {
    this.time = time;
    this.stale = true;
  }

  /** By keyboard: + and − around the present instant, 0 the whole record. */
  private zoomBy(key: string): void {
    const end = this.answer?.time.at(-1) ?? 0;
    const [from, to] = this.clock.zoomed ?? [0, end];
    const span = key === "0" ? Infinity : (to - from) * (key === "+" ? 0.5 : 2);
    if (span >= end) this.clock.zoom(null);
    else {
      const start = Math.min(Math.max(0, this.time - span / 2), end - span);
      this.clock.zoom([start, start + span]);
    }
  }

  private play(on: boolean): void {
    this.playing = on;
    fill(this.playButton, icon(on ? ICON.pause : ICON.play));
    this.playButton.setAttribute("aria-label", on ? "Pause" : "Play");
  }

  // ---- pictures

  private drawAnswer(): void {
    const answer = this.answer!;
    const { state } = answer;
    this.title.textContent = state.name;
    this.controls.update(state);
    this.motionChoices();
    this.motionWords.textContent = state.motion.words;
    this.drawHeadline();
    this.drawPeaks();
    if (this.tab !== "motion") return;
    const end = answer.time[answer.time.length - 1] ?? 1;
    this.scrub.max = String(end);
    this.scrub.step = String(Math.max(0.001, end / 5000));
    this.clock.sliding = intervals(answer.time, answer.mode);
    this.drawSliding();
    this.drawAccelerations();
    this.drawThird();
    this.loop.show(answer);
    this.stale = true;
  }

  private drawSliding(): void {
    const { answer, colours, judgement } = this;
    if (!answer) return;
    const gap = answer.state.structure.gap_m;
    const peak = answer.state.headline.peak_m;
    const near = gap !== null && gap < 2.5 * peak ? [gap, -gap] : [];
    const of = (label: string, colour: string, beside: { time: Float64Array; s: Float64Array } | undefined, dash = false) => (beside ? [{ ...beside, label, colour, dash }] : []);
    this.charts.sliding.show({
      time: answer.time,
      lines: [{ label: "nominal", colour: colours.stick!, values: answer.s, width: 1.7 }],
      overlays: [
        ...of("lower friction", colours.bound!, judgement?.lower),
        ...of("upper friction", colours.table!, judgement?.upper),
        ...of("stepwise", colours.gap!, judgement?.steps, true),
      ],
      limits: near,
      unit: answer.state.units.length,
    });
  }

  private storey(values: Float64Array, place: number, count: number): Float64Array {
    const out = new Float64Array(count ? values.length / count : 0);
    for (let i = 0; i < out.length; i++) out[i] = values[i * count + place]!;
    return out;
  }

  private drawAccelerations(): void {
    const { answer, colours } = this;
    if (!answer) return;
    const storeys = answer.state.structure.storeyMasses_kg.length;
    const lines = [
      { label: "table", colour: colours.table!, values: answer.table, width: 1 },
      { label: "block", colour: colours.block!, values: answer.block, width: 1 },
    ];
    if (storeys > 0) {
      const roof = this.storey(answer.storeyAcceleration, storeys - 1, storeys);
      lines.push({ label: storeys > 1 ? "roof" : "storey", colour: colours.roof!, values: roof, width: 1 });
    }
    this.charts.acceleration.show({ time: answer.time, lines, unit: answer.state.units.acceleration });
  }

  private drawThird(): void {
    const { answer, colours, judgement } = this;
    if (!answer) return;
    const { units, structure } = answer.state;
    const chart = this.charts.third;
    const storeys = structure.storeyMasses_kg.length;
    switch (this.third.value) {
      case "energy": {
        const colour = [colours.quiet!, colours.stick!, colours.roof!, colours.bound!, colours.slide!];
        const names = ["input", "kinetic", "strain", "damping", "friction"];
        // Energies come with the check; until then there are none to show.
        const none = new Float64Array(answer.time.length).fill(Number.NaN);
        const lines = names.map((label, i) => ({ label, colour: colour[i]!, values: judgement?.energy[i]?.length === answer.time.length ? judgement.energy[i]! : none, width: 1.4 }));
        if (judgement || !this.energyShown) chart.show({ time: answer.time, lines, unit: units.energy });
        this.energyShown = true;
        return;
      }
      case "storeys": {
        const shown = storeys > 3 ? [0, Math.floor(storeys / 2), storeys - 1] : [...Array(storeys).keys()];
        const colour = [colours.stick!, colours.bound!, colours.roof!];
        const lines = shown.map((place, i) => ({ label: structure.storeyNames[place] ?? "", colour: colour[shown.length === 1 ? 2 : i]!, values: this.storey(answer.storeyDisplacement, place, storeys) }));
        chart.show({ time: answer.time, lines: lines.length ? lines : [{ label: "no storeys", colour: colours.quiet!, values: new Float64Array(answer.time.length) }], unit: units.length });
        break;
      }
      case "force":
        chart.show({
          time: answer.time,
          lines: [
            { label: "all of the slider", colour: colours.stick!, values: answer.force },
            { label: "friction alone", colour: colours.slide!, values: answer.friction, width: 1 },
          ],
          unit: units.force,
        });
        break;
      default:
        chart.show({ time: answer.time, lines: [{ label: "sliding velocity", colour: colours.stick!, values: answer.velocity }], unit: units.velocity });
    }
    this.energyShown = false;
  }

  private energyShown = false;

  private drawHeadline(): void {
    const { headline, units, structure } = this.answer!.state;
    const item = (label: string, value: string, unit: string, over = false) => h("div", { class: over ? "over" : "" }, h("dt", {}, label), h("dd", {}, value, unit && h("small", {}, unit)));
    const length = (value: number) => digits(value / units.length.in_si);
    const acceleration = (value: number) => digits(value / units.acceleration.in_si);
    fill(
      this.headline,
      item("Peak sliding", length(headline.peak_m), units.length.symbol),
      item("Residual", length(headline.residual_m), units.length.symbol),
      structure.gap_m !== null && headline.gapRatio !== null ? item("Gap used", digits(100 * headline.gapRatio, 3), "%", headline.gapRatio > 1) : item("Slips", String(headline.slips), ""),
      headline.roof_m_per_s2 === null ? item("Block acceleration", acceleration(headline.block_m_per_s2), units.acceleration.symbol) : item("Roof acceleration", acceleration(headline.roof_m_per_s2), units.acceleration.symbol),
      headline.roof_m_per_s2 === null ? "" : item("Base shear / weight", digits(headline.baseShear, 3), ""),
    );
  }

  private peaksShape = "";
  private peakCells: HTMLElement[][] = [];

  private drawPeaks(): void {
    const { rows, runs, warnings } = this.judgement ?? this.answer!.state;
    const shape = JSON.stringify([runs, rows.map(({ label, unit }) => [label, unit])]);
    if (shape !== this.peaksShape) {
      this.peaksShape = shape;
      this.peakCells = rows.map((row) => row.values.map(() => h("td", { class: "number" })));
      const head = runs.length > 1 ? [h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Friction"), ...runs.map((run) => h("th", { scope: "col", class: "number" }, run))))] : [];
      const body = rows.map((row, i) => h("tr", {}, h("th", { scope: "row" }, row.label, row.unit && h("small", {}, ` ${row.unit}`)), ...this.peakCells[i]!));
      fill(this.peaks, h("table", {}, ...head, h("tbody", {}, ...body)));
    }
    rows.forEach((row, i) =>
      row.values.forEach((value, run) => {
        const cell = this.peakCells[i]![run]!;
        const text = value.replace("-", "−");
        if (cell.textContent !== text) cell.textContent = text;
        cell.classList.toggle("governs", row.governing === run);
      }),
    );
    const told = JSON.stringify(warnings);
    if (told !== this.warned) {
      this.warned = told;
      fill(this.warnings, ...warningList(warnings));
    }
  }

  private warned = "";

  /** What is known of the answer that is shown. */
  private certify(): void {
    results.certificate(this.certificate, this.judgement);
  }

  private judged(judgement: Judgement, wish: Wish): void {
    this.judgement = judgement;
    // What was set stands in the text now; the page waits for it before it says that it rests.
    this.pending = [];
    this.settle(wish, judgement.text);
    this.certify();
    this.drawPeaks();
    if (this.tab === "motion") {
      this.drawSliding();
      if (this.third.value === "energy") this.drawThird();
      this.stale = true;
    }
    results.beside(this.beside, judgement);
    results.events(this.events, this.answer!, (time) => {
      this.play(false);
      this.seek(time);
    });
  }

  /** Takes the text over that says what was set. */
  private settle(wish: Wish, text: string): void {
    if (wish.text !== this.text) return;
    this.text = text;
    if (this.editor.value !== text) this.editor.value = text;
  }

  private announce(): void {
    const state = this.answer?.state;
    if (!state) return;
    const { headline, units } = state;
    const holds = this.judgement?.certificate.holds;
    this.live.textContent =
      `Peak sliding displacement ${digits(headline.peak_m / units.length.in_si)} ${units.length.symbol}, ` +
      `residual ${digits(headline.residual_m / units.length.in_si)} ${units.length.symbol}. ` +
      (holds === true ? "Checked." : holds === false ? "The check failed." : "Not judged.");
  }

  private fault(fault: Fault, wish?: Wish): void {
    const inText = fault.source === "model.toml" && fault.start !== undefined;
    this.bar.hidden = false;
    const show = h("button", { type: "button" }, "Show the place");
    show.addEventListener("click", () => {
      this.select("motion", false);
      (this.editor.closest("details") as HTMLDetailsElement).open = true;
      this.editor.focus();
      this.editor.setSelectionRange(fault.start!, Math.max(fault.end ?? 0, fault.start!));
    });
    fill(this.bar, h("p", {}, fault.message), h("span", { class: "drop-hint" }, "The last good state stays."), inText && show);
    if (inText) {
      this.editor.setAttribute("aria-invalid", "true");
      this.editorFault.hidden = false;
      this.editorFault.textContent = fault.message;
    }
    // A value that cannot be is not asked for again.
    if (wish && wish.set.length > 0) {
      this.pending = wish.text === this.good.text ? [...this.good.set] : [];
      if (this.answer) this.controls.update(this.answer.state);
    }
    if (this.answer && !this.judgement) void this.rejudge();
  }

  /** The state that stays is judged too. */
  private async rejudge(): Promise<void> {
    try {
      const judgement = await this.desk.helper.call("judge", this.stepwise.checked);
      if (!this.judgement) this.judged(judgement, this.good);
    } catch {
      // The next answer is judged by itself.
    }
  }

  // ---- records

  private allRecords(): { name: string; label: string }[] {
    const own = [...this.own.keys()].map((name) => ({ name, label: name }));
    return [...RECORDS.map(({ name, label }) => ({ name, label })), ...own];
  }

  private listRecords(): void {
    fill(
      this.recordList,
      ...RECORDS.map(({ label }) => h("li", {}, `${label} (U.S. Geological Survey)`)),
      ...[...this.own.keys()].map((name) => {
        const remove = h("button", { type: "button", "aria-label": `Remove ${name}` }, "×");
        remove.addEventListener("click", () => {
          this.own.delete(name);
          this.desk.records.delete(name);
          void this.desk.helper.call("remove", name);
          this.listRecords();
        });
        return h("li", {}, name, remove);
      }),
    );
    this.motionChoices();
  }

  private choices = "";

  private motionChoices(): void {
    const state = this.answer?.state;
    const record = state?.inputs.find((input) => input.path === "motion.record")?.text;
    const now = record !== undefined ? `record:${this.allRecords().find(({ name }) => name === record || name.endsWith(`/${record}`))?.name ?? record}` : (state?.motion.kind ?? "");
    const options = [
      ...this.allRecords().map(({ name, label }) => [`record:${name}`, label]),
      ["sine", "A sine"],
      ["sweep", "A sine sweep"],
      ["pulse", "A pulse"],
    ];
    if (now && !options.some(([value]) => value === now)) options.unshift([now, record ?? now]);
    const choices = JSON.stringify([options, now]);
    if (choices === this.choices) return;
    this.choices = choices;
    fill(this.motionSelect, ...options.map(([value, label]) => h("option", { value, selected: value === now }, label!)));
  }

  private chooseMotion(value: string): void {
    const name = value.startsWith("record:") ? value.slice(7) : undefined;
    if (name === undefined) {
      this.setText(onMade(this.text, value));
      return;
    }
    const carried = RECORDS.find((record) => record.name === name);
    const choice = carried ? { name, units: carried.units, dt: carried.dt } : (this.own.get(name)?.choice ?? { name });
    this.setText(onRecord(this.text, choice));
  }

  // ---- address

  private remembered = "";

  private async remember(): Promise<void> {
    const state = this.answer?.state;
    if (!state) return;
    const record = state.inputs.find((input) => input.path === "motion.record")?.text;
    const records = [...this.own].filter(([name]) => name === record).map(([name, { sha256 }]) => ({ name, sha256 }));
    const fragment = await encode({ text: this.text, display: this.display, tab: this.tab, stepwise: this.stepwise.checked, records });
    const summary = JSON.stringify(state.headline);
    this.options.onstate?.({ model: this.text, summary });
    if (!this.options.address || fragment === this.remembered || fragment === location.hash) return;
    const first = this.remembered === "" && location.hash === "";
    this.remembered = fragment;
    try {
      if (first) history.replaceState(null, "", fragment);
      else history.pushState(null, "", fragment);
    } catch {
      // A browser takes only so many states in a minute.
    }
  }

  private async fromAddress(): Promise<void> {
    try {
      const shared = await decode(location.hash);
      if (!shared) {
        this.text = START;
        return;
      }
      this.remembered = location.hash;
      this.text = shared.text;
      this.display = shared.display;
      this.system.value = shared.display;
      this.stepwise.checked = shared.stepwise;
      this.desk.stepwise = shared.stepwise;
      this.intake.wanted = shared.records.filter(({ name }) => !this.desk.records.has(name));
      this.select(shared.tab, false);
    } catch (error) {
      this.fault({ message: error instanceof Error ? error.message : String(error) });
    }
  }

  // ---- files out

  private command(): string {
    return "slipstick run model.toml --out out";
  }

  private async exportFile(name: string, type: string): Promise<void> {
    try {
      const text = await this.desk.helper.call("file", name, this.text, this.command());
      download(name, text, type);
    } catch (error) {
      if (error instanceof ModuleError) this.fault(error.fault);
    }
  }

  private async drawings(): Promise<Drawing[]> {
    return JSON.parse(await this.desk.helper.call("file", "figures", this.text, this.command())) as Drawing[];
  }

  private async exportFigures(kind: "svg" | "png"): Promise<void> {
    try {
      for (const drawn of await this.drawings()) {
        if (kind === "svg") download(`${drawn.id}.svg`, drawn.svg, "image/svg+xml");
        else {
          const image = drawing(drawn.svg, drawn.caption);
          await image.decode();
          const [, , , width = "800", height = "400"] = /viewBox="(\S+) (\S+) ([\d.]+) ([\d.]+)"/.exec(drawn.svg) ?? [];
          const canvas = h("canvas", { width: Math.round(Number(width) * 3), height: Math.round(Number(height) * 3) });
          const c = canvas.getContext("2d")!;
          c.fillStyle = "#fff";
          c.fillRect(0, 0, canvas.width, canvas.height);
          c.drawImage(image, 0, 0, canvas.width, canvas.height);
          await this.savePng(canvas, `${drawn.id}.png`);
        }
      }
    } catch (error) {
      if (error instanceof ModuleError) this.fault(error.fault);
    }
  }

  private savePng(canvas: HTMLCanvasElement, name: string): Promise<void> {
    return new Promise((done) =>
      canvas.toBlob((blob) => {
        if (blob) download(name, blob, "image/png");
        done();
      }),
    );
  }

  private exportScene(): void {
    void this.savePng(this.sceneCanvas, "animation.png");
  }

  private async copy(text: string, said: string): Promise<void> {
    try {
      await navigator.clipboard.writeText(text);
      this.live.textContent = said;
      this.tell(said);
    } catch {
      this.tell(text);
    }
  }

  /** A line that goes away. */
  private tell(text: string): void {
    this.busyBar.hidden = false;
    fill(this.busyBar, h("p", {}, h("code", {}, text)));
    setTimeout(() => (this.busyBar.hidden = true), 4000);
  }

  private figuresTimer: ReturnType<typeof setTimeout> | undefined;

  /** What is printed is the report's figures, drawn once the page rests. */
  private scheduleFigures(): void {
    clearTimeout(this.figuresTimer);
    this.figuresTimer = setTimeout(() => void this.preparePrint().catch(() => {}), 900);
  }

  private async preparePrint(): Promise<void> {
    const state = this.answer?.state;
    if (!state || !this.judgement) return;
    const drawings = await this.drawings();
    fill(
      this.printed,
      h("p", {}, state.line),
      h("p", {}, `Ground motion: ${state.motion.words}`),
      this.certificate.cloneNode(true),
      this.peaks.cloneNode(true),
      ...drawings.map((drawn) => h("figure", {}, drawing(drawn.svg, drawn.caption), h("figcaption", {}, drawn.caption))),
    );
  }

  private async print(): Promise<void> {
    await this.preparePrint().catch(() => {});
    await Promise.all([...this.printed.querySelectorAll("img")].map((image) => image.decode().catch(() => {})));
    print();
  }

  /** Ends the workers and the animation. */
  close(): void {
    cancelAnimationFrame(this.frame);
    this.desk.helper.end();
    this.root.remove();
  }
}
