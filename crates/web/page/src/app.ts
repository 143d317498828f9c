/** The page: state in, pictures out. It draws; the workers compute. */

import { Address } from "./address";
import { Compare } from "./compare";
import { Controls } from "./controls";
import { type Answered, Desk, type Engine } from "./desk";
import { h } from "./dom";
import { Editor } from "./editor";
import { MODELS, START } from "./examples";
import { Exports, menu } from "./exports";
import { Histories } from "./histories";
import { Intake } from "./intake";
import { onRecord } from "./motion";
import { Notices } from "./notices";
import { Clock } from "./plots";
import { Records } from "./records";
import * as results from "./results";
import { Guides } from "./scenes/guide";
import { palette, type Shown } from "./scene";
import { Stage } from "./stage";
import { Steps } from "./steps";
import { tabs } from "./studies";
import type { StudyTab } from "./study";
import { identity } from "./tab";
import { TabBar } from "./tabbar";
import uplotStyle from "uplot/dist/uPlot.min.css";
import type { Answer, Display, Fault, Judgement, Revision, Run, Setting } from "./types";

void uplotStyle;

export interface Options {
  /** The model's text; the address or the example where it is not given. */
  model?: string;
  /** Records besides those that the page carries. */
  records?: { name: string; bytes: Uint8Array }[];
  /** Whether the state is kept in the address. */
  address: boolean;
  /** What is shown of the example until the module is there. */
  first?: () => Promise<Answer>;
  /** Told of every state at rest. */
  onstate?: (state: { model: string; summary: string }) => void;
}

const SYSTEMS: [Display, string][] = [
  ["si", "SI"],
  ["si-g", "SI, accelerations in g"],
  ["kN-mm", "mm, kN, t"],
  ["us", "in, kip, lb"],
];

export class App {
  readonly root = h("div", { class: "slipstick" });
  readonly desk: Desk;

  // What is drawn.
  private shown: Shown | undefined;
  /** What is known and not drawn yet. */
  private news: "" | "answer" | "judgement" = "";
  /** The picture of the build, which is that of the first revision; and numbers of the revisions whose figures, whose check, and whose text are drawn. */
  private built: Answer | undefined;
  private builtOf = 0;
  private readonly drawnOf = { figures: 0, check: 0, text: 0 };
  private wasRefused = false;
  /** For the measurements: pictures drawn of new answers. */
  updates = 0;
  /** Whether an answer of a module is drawn next, the first one. */
  private answered: boolean | undefined;

  // Its parts.
  private readonly notices = new Notices();
  private readonly clock = new Clock();
  private readonly records: Records;
  private readonly controls: Controls;
  private readonly editor: Editor;
  private readonly stage: Stage;
  private readonly histories: Histories;
  private readonly peaks = new results.Peaks();
  private readonly exports: Exports;
  private readonly intake: Intake;
  private readonly study: StudyTab;
  private readonly bar: TabBar;
  private readonly compare: Compare;
  private readonly guides: Guides;
  private readonly address = new Address();
  private readonly steps = new Steps();
  private readonly undo = h("button", { type: "button", disabled: true, onclick: () => this.step(-1) }, "Undo");
  private readonly redo = h("button", { type: "button", disabled: true, onclick: () => this.step(1) }, "Redo");
  private frame = 0;

  // Elements that change.
  private readonly title = h("span", {}, "");
  private readonly headline = h("dl", { class: "headline" });
  private readonly severe = h("div", { class: "severe", tabindex: 0, role: "region", "aria-label": "Severe warnings", hidden: true });
  private readonly certificate = h("section", { class: "certificate", "aria-label": "Certificate" });
  private readonly loopCard = h("div", { class: "card pad" }, h("h2", {}, "Force on the slider"));
  private readonly peaksCard = h("div", { class: "card pad peaks" }, h("h2", {}, "Peaks"));
  private readonly beside = h("div", {});
  private readonly events = h("div", { class: "table-scroll", tabindex: 0, role: "region", "aria-label": "Events" });
  private readonly system = h("select", { "aria-label": "Units" }, ...SYSTEMS.map(([value, label]) => h("option", { value }, label)));
  private readonly stepwise = h("input", { type: "checkbox" });
  private readonly main = h("main", { id: "main", tabindex: -1 });
  private readonly motionPanel = h("div", { class: "motion" });
  private readonly dropping = h("div", { class: "dropping", hidden: true }, "Drop records, a model or a plan");

  constructor(
    host: HTMLElement | ShadowRoot,
    engine: Engine,
    private readonly options: Options,
  ) {
    host.append(this.root);
    this.desk = new Desk(engine);
    const { desk } = this;
    const text = () => this.text;
    const set = (settings: Setting[]) => desk.set(settings);
    const display = () => desk.wanted.display;
    const setText = (text: string) => this.setText(text);
    const state = () => this.answer?.state;
    const fault = (fault: Fault) => this.fault(fault);
    const say = (text: string) => this.notices.say(text);

    this.records = new Records({ desk, state, text, setText });
    this.controls = new Controls(set, this.records.motion);
    this.editor = new Editor((text) => desk.want({ text, set: [] }));
    this.theme();
    this.compare = new Compare({
      desk,
      text,
      state: () => (this.judgement ? state() : undefined),
      display,
      setText,
      changed: () => {
        if (this.answer) this.drawAnswer();
        // Beside B there is more to read.
        this.controls.bring();
        void this.remember();
      },
      say,
    });
    this.guides = new Guides({
      desk,
      display,
      open: (text, pinned) => {
        this.select("motion", false);
        this.open(text);
        this.compare.keep(pinned);
      },
      set,
      begin: (path) => {
        if (path) this.stage.begin();
        this.controls.twice(path, this.answer?.state);
        return this.controls.second;
      },
      changed: () => void this.remember(),
      copy: (text, said) => void this.exports.copy(text, said),
    });
    this.stage = new Stage(this.headline, this.severe, this.compare.element, this.clock);
    this.histories = new Histories(this.clock, palette(this.root));
    this.exports = new Exports({
      desk,
      motion: (state, files) => this.records.bytes(state, files),
      moved: (state) => this.records.moved(state),
      stage: this.stage,
      tables: [this.certificate, this.peaks.table],
      say,
      tell: (text) => this.notices.tell(text),
      fault,
    });
    const made = tabs({
      desk,
      state,
      display,
      dark: () => this.root.dataset.theme === "dark",
      records: () => this.records.all(),
      choice: (name) => this.records.choice(name),
      text,
      set,
      load: (run) => this.load(run),
      identity: (name) => identity(desk.records.get(name) ?? new Uint8Array()),
      progress: (tab, text) => this.bar.progress(tab, text),
      changed: () => void this.remember(),
      say,
      fault,
    });
    this.study = made.study;
    this.bar = new TabBar([{ id: "motion", label: "Motion", element: this.motionPanel, open: () => {} }, ...made.all], this.main, (id) => this.select(id, true));
    this.intake = new Intake({
      desk,
      root: this.root,
      own: this.records.own,
      text,
      setText: (text) => this.openModel(text),
      take: (record) => this.records.take(record),
      study: (plan) => {
        this.study.load(plan);
        this.select("study", true);
        void this.study.run();
      },
      many: () => this.select("suite", true),
      listRecords: () => this.records.show(),
      leave: (name) => made.leave([name]),
      fault,
    });
    this.layout();
    this.hear();
    this.keys();
    this.drops();
    for (const { name, bytes } of options.records ?? []) this.records.add(name, bytes);
    void this.begin();
  }

  private async begin(): Promise<void> {
    const { options, desk } = this;
    results.loading(this.certificate, "nothing");
    this.stage.play(!matchMedia("(prefers-reduced-motion: reduce)").matches);
    const opened = options.address && options.model === undefined && location.hash.length > 1 ? await this.fromAddress() : undefined;
    // A guided scene has opened its model.
    if (desk.wanted.number > 0) return;
    const wanted = { ...desk.wanted, text: options.model ?? START, ...opened };
    desk.wanted = wanted;
    this.editor.text = wanted.text;
    this.steps.opened(wanted.text);
    // The module is asked for after the first picture, which it would keep waiting on a slow network.
    if (wanted.text === START && wanted.display === "si") await this.showFirst();
    // A value may have been changed by then, which is asked for already.
    if (desk.wanted.number > 0) return;
    this.builtOf = 1;
    this.drawnOf.figures = this.built ? 1 : 0;
    desk.want({});
  }

  /** Shows the example as it was computed when the page was built. */
  private async showFirst(): Promise<void> {
    try {
      const answer = await this.options.first?.();
      if (!answer || this.desk.answered) return;
      this.built = answer;
      this.show(answer);
      results.loading(this.certificate, "built");
      // It is drawn first; a page that is not looked at draws nothing.
      await new Promise((done) => {
        requestAnimationFrame(done);
        setTimeout(done, 200);
      });
    } catch {
      // The module computes the same.
    }
  }

  // ---- layout

  private theme(): void {
    const dark = matchMedia("(prefers-color-scheme: dark)");
    const apply = () => {
      this.root.dataset.theme = dark.matches ? "dark" : "light";
    };
    dark.addEventListener("change", () => {
      apply();
      this.histories.restyle(this.stage.restyle());
      this.bar.restyle();
      if (this.answer) this.drawAnswer();
    });
    apply();
  }

  private layout(): void {
    const lead = h("p", { class: "welcome" }, "A building on sliding bearings in an earthquake: drag any value, and see at once how far it slides and what it feels.");
    this.root.classList.toggle("embedded", this.options.address && window.self !== window.top);
    this.motionPanel.append(h("div", { class: "middle" }, lead, this.stage.element), this.modelPart(), this.histories.element, this.resultsPart());
    this.root.append(
      h("a", { class: "skip", href: "#main", onclick: (event: Event) => { event.preventDefault(); this.main.focus(); } }, "To the model"),
      this.header(),
      this.bar.element,
      this.notices.fault,
      this.notices.work,
      this.main,
      h("footer", { class: "foot" }, "Exact to rounding between two events; everything is computed in this window, nothing is sent."),
      this.notices.live,
      this.exports.printed,
      this.dropping,
    );
    this.select("motion", false);
    this.records.show();
    this.stage.restyle();
  }

  private header(): HTMLElement {
    const button = (label: string, act: () => void) => h("button", { type: "button", onclick: act }, label);
    const open = h("input", { type: "file", multiple: true, class: "hidden", tabindex: -1, "aria-label": "Files" });
    open.addEventListener("change", () => {
      void this.intake.files([...(open.files ?? [])]);
      open.value = "";
    });
    return h(
      "header",
      { class: "top" },
      h("h1", { class: "brand" }, "Slipstick", this.title),
      h(
        "div",
        { class: "tools" },
        open,
        button("Open files…", () => open.click()),
        menu("Examples", ...MODELS.map(({ label, text }) => button(label, () => this.openModel(text)))),
        menu("Guided scenes", ...this.guides.buttons()),
        h("a", { class: "button whole", href: location.href, target: "_blank", onclick: (event: Event) => ((event.currentTarget as HTMLAnchorElement).href = location.href) }, "Open in Slipstick"),
        this.undo,
        this.redo,
        button("Reset", () => this.setText(this.steps.start)),
        this.system,
        this.options.address && button("Copy link", () => void this.link()),
        this.exports.menu,
      ),
    );
  }

  private modelPart(): HTMLElement {
    return h(
      "section",
      { class: "controls", "aria-label": "Model" },
      this.guides.element,
      h("div", { class: "card pad" }, this.controls.element),
      h("div", { class: "card pad" }, h("h2", {}, "Records"), this.records.list, h("p", { class: "drop-hint" }, "Drop a record of any of the 18 formats, a model or a plan anywhere on the page.")),
      this.editor.element,
    );
  }

  private resultsPart(): HTMLElement {
    this.loopCard.append(this.stage.loopBox);
    this.peaksCard.append(this.peaks.table, this.peaks.warnings);
    return h(
      "section",
      { class: "results", "aria-label": "Results" },
      this.certificate,
      this.loopCard,
      this.peaksCard,
      h("div", { class: "card pad" }, h("h2", {}, "For comparison"), h("label", { class: "switch" }, this.stepwise, "The paper's stepwise method"), this.beside),
      h("details", { class: "card pad fold" }, h("summary", {}, "Events"), this.events),
    );
  }

  private select(id: string, remember: boolean): void {
    this.bar.select(id);
    if (this.bar.tab === "motion" && this.answer) this.drawAnswer();
    if (remember) void this.remember();
  }

  // ---- what is heard

  private hear(): void {
    const { desk, notices } = this;
    desk.onwanted = () => this.want();
    desk.onanswer = (answered) => this.take(answered);
    desk.onjudged = (answered) => this.judged(answered);
    desk.onfault = (fault, of) => this.fault(fault, of);
    desk.onrest = () => {
      this.steps.rest(this.text);
      this.mark();
      this.controls.bring();
      void this.compare.update();
      void this.remember();
      if (this.answer) notices.say(results.sentence(this.answer.state, this.judgement?.certificate.holds));
      this.exports.prepareAtRest();
    };
    desk.helper.onbusy = (busy) =>
      notices.busy(busy, () => {
        desk.helper.end();
        void desk.helper.start();
      });
    this.system.addEventListener("change", () => desk.want({ display: this.system.value as Display }));
    this.stepwise.addEventListener("change", () => desk.want({ stepwise: this.stepwise.checked }));
    if (this.options.address) {
      addEventListener("popstate", () => {
        void this.fromAddress().then((opened) => opened && this.setText(opened.text, opened));
      });
    }
    new ResizeObserver(() => {
      if (this.bar.tab === "motion") this.stage.draw(this.compare.pinned?.answer);
    }).observe(this.motionPanel);
    const step = (now: number) => {
      this.frame = requestAnimationFrame(step);
      this.drawNews();
      this.stage.tick(now, this.bar.tab === "motion");
    };
    this.frame = requestAnimationFrame(step);
  }

  private keys(): void {
    // Where the page is the whole document, keys are heard wherever the focus is.
    const ears: HTMLElement = this.options.address ? document.documentElement : this.root;
    // A button that was pressed by a pointer keeps the focus, and is not meant by the next key.
    let pointed = false;
    ears.addEventListener("pointerdown", () => (pointed = true));
    ears.addEventListener("keydown", (event) => {
      const { tagName, type } = event.composedPath()[0] as HTMLInputElement;
      if (event.key !== " ") pointed = false;
      // A field of text has its own undo.
      const writes = tagName === "TEXTAREA" || (tagName === "INPUT" && type === "text");
      const key = (event.ctrlKey || event.metaKey) && !writes ? event.key.toLowerCase() : "";
      if (key === "z" || key === "y") {
        event.preventDefault();
        this.step(key === "z" && !event.shiftKey ? -1 : 1);
      }
      const field = /^(TEXTAREA|SELECT)$/.test(tagName) || (tagName === "INPUT" && type !== "range");
      const button = /^(BUTTON|SUMMARY|A)$/.test(tagName) && !pointed;
      if (event.key === " " && !field && !button) {
        event.preventDefault();
        this.stage.play(!this.stage.playing);
      }
      if (!/^(INPUT|TEXTAREA|SELECT)$/.test(tagName) && !event.ctrlKey && !event.metaKey && /^[-+0]$/.test(event.key)) this.stage.zoomBy(event.key);
    });
    document.addEventListener("pointerdown", (event) => {
      for (const menu of this.root.querySelectorAll<HTMLDetailsElement>("details.menu[open]")) {
        if (!event.composedPath().includes(menu)) menu.open = false;
      }
    });
  }

  private drops(): void {
    const { root, dropping } = this;
    let depth = 0;
    const carries = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
    root.addEventListener("dragenter", (event) => {
      if (!carries(event)) return;
      event.preventDefault();
      depth++;
      dropping.hidden = false;
    });
    root.addEventListener("dragover", (event) => carries(event) && event.preventDefault());
    root.addEventListener("dragleave", () => {
      depth = Math.max(0, depth - 1);
      if (depth === 0) dropping.hidden = true;
    });
    root.addEventListener("drop", (event) => {
      if (!carries(event)) return;
      event.preventDefault();
      depth = 0;
      dropping.hidden = true;
      void this.intake.files([...(event.dataTransfer?.files ?? [])]);
    });
  }

  // ---- what is wanted

  /** The text that is wanted; of keys that were set on it since it says nothing yet. */
  get text(): string {
    return this.desk.wanted.text;
  }

  /** Takes a whole text, and with it how it is shown. */
  private setText(text: string, how: Partial<Revision> = {}): void {
    this.controls.release();
    this.desk.want({ ...how, text, set: [] });
  }

  /** Another revision is wanted: what is of another one is greyed. */
  private want(): void {
    const { wanted } = this.desk;
    if (wanted.set.length === 0) {
      this.editor.text = wanted.text;
      this.drawnOf.text = wanted.number;
    }
    this.system.value = wanted.display;
    this.stepwise.checked = wanted.stepwise;
    this.bar.open.update?.();
    this.mark();
  }

  /** Shows a run of an analysis over many by itself. */
  private load({ record, scale, friction, set }: Run): void {
    const inputs = this.answer?.state.inputs ?? [];
    const factor = inputs.find(({ path }) => path === `slider.bounds.${friction}`)?.value ?? 1;
    // The coefficients of a bound, which are then those of the model.
    const bounded = inputs.flatMap(({ path, value }): Setting[] => {
      if (!/^slider\.(static|kinetic)_friction(\.(positive|negative|slow|fast))?$/.test(path) || typeof value !== "number") return [];
      const own = set.find(([key]) => key === path)?.[1];
      return [[path, String((own === undefined ? value : Number(own)) * factor)]];
    });
    const all = factor === 1 ? set : [...set.filter(([path]) => bounded.every(([other]) => other !== path)), ...bounded];
    this.controls.release();
    this.desk.want({ text: record === null ? this.text : onRecord(this.text, this.records.choice(record), scale), set: all });
    this.select("motion", true);
    const cannot = factor === 1 && friction !== "nominal";
    this.notices.tell(cannot ? `The run has ${friction} friction; shown is the model's own, with ${friction} friction beside it.` : `Shown: ${[record ?? "the model's motion", friction === "nominal" ? "" : `${friction} friction`].filter(Boolean).join(", ")}. Undo returns to what stood here.`);
  }

  /** Takes a whole text that Reset returns to. */
  private open(text: string): void {
    this.steps.opened(text);
    this.setText(text);
  }

  /** Opens a model by itself: no guided scene is about it. */
  private openModel(text: string): void {
    this.guides.show(undefined);
    this.open(text);
  }

  /** A state further on, or back. */
  private step(steps: number): void {
    const { text: now, set } = this.desk.wanted;
    const text = this.steps.go(steps, this.steps.changed(now, set.length));
    if (text !== undefined) this.setText(text);
  }

  // ---- what is known

  /** What is shown: the last answer, or the picture of the build. */
  get answer(): Answer | undefined {
    return this.desk.answered?.answer ?? this.built;
  }

  get judgement(): Judgement | undefined {
    return this.desk.answered?.judgement;
  }

  private take({ answer }: Answered): void {
    this.notices.right();
    this.editor.right();
    this.intake.miss(undefined);
    this.certify();
    this.answered ??= true;
    this.show(answer);
  }

  /** Says what is known of the check. */
  private certify(): void {
    const { desk } = this;
    const { answered, refused } = desk;
    this.wasRefused = refused;
    if (!answered) return;
    if (desk.helper.early && !answered.judgement) results.loading(this.certificate, "answer");
    else results.certificate(this.certificate, answered, refused, () => desk.check());
  }

  /** Greys what is of another revision than what is wanted, and says its number. */
  private mark(): void {
    const { desk, drawnOf } = this;
    const { wanted, answered, refused } = desk;
    if (refused !== this.wasRefused) this.certify();
    // Fields show what was set on the model that they are of.
    const own = answered === undefined || wanted.text === answered.asked || wanted.text === answered.of.text;
    const parts: [number, HTMLElement[]][] = [
      [drawnOf.figures, [this.stage.element, this.histories.element, this.loopCard, this.peaksCard]],
      [drawnOf.check, [this.beside, this.events]],
      [answered?.judgement || refused ? drawnOf.check : wanted.number, [this.certificate]],
      [drawnOf.text, [this.editor.element]],
      [own && !refused ? wanted.number : drawnOf.figures, [this.controls.element]],
    ];
    for (const [number, elements] of parts) {
      for (const element of elements) {
        if (element.dataset.number !== String(number)) element.dataset.number = String(number);
        element.classList.toggle("behind", number !== wanted.number && number > 0);
      }
    }
    this.root.dataset.number = String(wanted.number);
    const changed = this.steps.changed(wanted.text, wanted.set.length);
    this.undo.disabled = !this.steps.canUndo && !changed;
    this.redo.disabled = !this.steps.canRedo || changed;
  }

  private show(answer: Answer): void {
    const before = this.shown;
    const tableTimes = answer.tableTimes ?? before?.tableTimes ?? new Float64Array();
    const tableDisplacement = answer.tableDisplacement ?? before?.tableDisplacement ?? new Float64Array();
    let tablePeak = answer.tableDisplacement ? 0 : (before?.tablePeak ?? 0);
    if (answer.tableDisplacement) for (const u of tableDisplacement) tablePeak = Math.max(tablePeak, Math.abs(u));
    this.shown = { answer, tableTimes, tableDisplacement, tablePeak };
    this.stage.take(this.shown);
    this.news = "answer";
  }

  private judged({ judgement }: Answered): void {
    this.certify();
    this.bar.update();
    this.mark();
    if (judgement) this.news ||= "judgement";
    // Where what is wanted has no answer, the link is of what stays.
    if (judgement && this.desk.refused) void this.remember();
  }

  private fault(fault: Fault, of?: Revision): void {
    const { message, source, start, end } = fault;
    const { desk } = this;
    const inText = source === "model.toml" && start !== undefined;
    const show = () => {
      this.select("motion", false);
      this.editor.select(start!, Math.max(end ?? 0, start!));
    };
    this.intake.miss(fault.missing);
    if (fault.missing !== undefined) this.notices.needs(...this.intake.asking(fault.missing));
    else this.notices.wrong(message, inText ? show : undefined);
    if (inText && desk.refused && fault.missing === undefined) this.editor.wrong(message);
    if (!of) return;
    if (this.answer) this.controls.update(this.answer.state);
    this.controls.refuse(of.set.slice(-1), message);
    this.records.update();
    this.mark();
    void this.remember();
  }

  // ---- pictures

  /** Whether all that is known is drawn. */
  get drawn(): boolean {
    return this.news === "";
  }

  /** Draws what came since the last frame. */
  private drawNews(): void {
    const { news } = this;
    this.news = "";
    if (news === "answer") {
      this.drawAnswer();
      this.updates++;
      if (this.updates === 1) performance.mark("first-picture");
      if (this.answered) {
        performance.mark("first-answer");
        this.answered = false;
      }
    }
    if (news && this.judgement) this.drawJudgement(this.judgement);
  }

  private drawAnswer(): void {
    const { answer, judgement } = this;
    if (!answer) return;
    const { state } = answer;
    this.title.textContent = state.name;
    // What an address opens before there is an answer has nothing to show yet.
    if (this.updates === 0) this.bar.open.open();
    this.controls.update(state);
    this.records.update();
    const pinned = this.compare.pinned?.answer;
    results.headline(this.headline, state, pinned?.state);
    results.severe(this.severe, (judgement ?? state).warnings);
    this.peaks.show(judgement ?? state);
    this.drawnOf.figures = this.desk.answered?.of.number ?? this.builtOf;
    this.mark();
    if (this.bar.tab !== "motion") return;
    this.histories.show(answer, judgement, pinned);
    this.stage.draw(pinned);
  }

  private drawJudgement(judgement: Judgement): void {
    results.severe(this.severe, judgement.warnings);
    this.peaks.show(judgement);
    if (this.bar.tab === "motion") this.histories.judged(judgement);
    results.beside(this.beside, judgement);
    results.events(this.events, this.answer!, (time) => this.stage.stopAt(time));
    this.drawnOf.check = this.desk.answered?.of.number ?? 0;
    this.mark();
  }

  // ---- address

  /** Copies the link of what is wanted, once it rests. */
  private async link(): Promise<void> {
    await this.desk.rested();
    await this.remember();
    await this.exports.copy(location.href, "The link is in the clipboard.");
  }

  /** The address says what is at rest, whatever else is on its way. */
  private async remember(): Promise<void> {
    const { options, desk } = this;
    const { answered } = desk;
    if (!answered || !desk.rests || answered.of.set.length > 0) return;
    const { state } = answered.answer;
    const { text, display, stepwise } = answered.of;
    options.onstate?.({ model: text, summary: JSON.stringify(state.headline) });
    if (!options.address) return;
    await this.address.remember({ text, display, tab: this.bar.tab, settings: this.bar.open.settings?.() ?? {}, stepwise, records: this.records.needed(state, this.compare.pinned?.answer.state), pinned: this.compare.kept, scene: this.guides.id });
  }

  /** What the address wants; nothing where it opens a guided scene by itself, or says nothing that this page made. */
  private async fromAddress(): Promise<Partial<Revision> & { text: string } | undefined> {
    try {
      const scene = this.address.scene();
      if (scene !== undefined) {
        if (this.guides.open(scene)) return undefined;
        throw new Error(`the address: expected a guided scene, found "${scene}"`);
      }
      const shared = await this.address.read();
      if (shared === undefined) return undefined;
      if (!shared) {
        this.compare.keep(undefined);
        this.guides.show(undefined);
        return { text: START };
      }
      const { text, display, stepwise } = shared;
      this.intake.wanted = shared.records.filter(({ name }) => !this.desk.records.has(name));
      this.compare.keep(shared.pinned);
      this.guides.show(shared.scene);
      this.select(shared.tab, false);
      this.bar.open.restore?.(shared.settings);
      return { text, display, stepwise };
    } catch (error) {
      this.notices.keep(error instanceof Error ? error.message : String(error));
      return undefined;
    }
  }

  /** For the measurements and the tests: the present instant in s. */
  get time(): number {
    return this.stage.time;
  }

  /** Ends the workers and the animation. */
  close(): void {
    cancelAnimationFrame(this.frame);
    this.desk.helper.end();
    this.root.remove();
  }
}
