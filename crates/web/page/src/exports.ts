/** What leaves the page: files, figures, pictures, links, paper. */

import { strToU8, zipSync } from "fflate";
import { type Desk, type Files, ModuleError } from "./desk";
import { download, drawing, fill, h, picture, savePng } from "./dom";
import { film } from "./film";
import type { Stage } from "./stage";
import type { Display, Drawing, Fault, State } from "./types";

/** What the exports need of the page. */
export interface Shelf {
  desk: Desk;
  /** Those files that the motion of a model is of, by their paths in it. */
  motion: (state: State, files: Map<string, Uint8Array>) => [path: string, bytes: Uint8Array][];
  /** What the table moves by, in a few words: the file's name of a record. */
  moved: (state: State) => string;
  /** The animation. */
  stage: Stage;
  /** What stands before the figures on paper. */
  tables: HTMLElement[];
  say: (text: string) => void;
  /** Shows a line for a while. */
  tell: (text: string) => void;
  fault: (fault: Fault) => void;
}

/** How long the page rests before its print is prepared, in ms. */
const PRINT_REST_MS = 900;

/** The command that repeats the page's run. */
const command = ({ display }: { display: Display }) => `slipstick run model.toml${display === "si" ? "" : ` --display-units ${display}`} --out out`;

/** The table of modes that a model names, by its path there, where it is among the files of the page. */
function modes(model: string, files: Map<string, Uint8Array>): Record<string, Uint8Array> {
  const [, , path = ""] = /^[ \t]*modes[ \t]*=[ \t]*(["'])(.+?)\1/m.exec(model) ?? [];
  const table = files.get(path) ?? files.get(path.replace(/^.*[/\\]/, ""));
  return table ? { [path]: table } : {};
}

/** Hands over a ZIP of texts and bytes by their paths: a model and what it names of the files of the page, what a command needs besides, the command, and what the page made of it. The command stands in `said`, where no pattern of a plan takes it for a record. */
export function hand(name: string, commands: string[], [path, model]: [path: string, text: string], files: Map<string, Uint8Array>, besides: Record<string, string | Uint8Array>, made: Record<string, string>, said = "command.txt"): void {
  const needed = { [path]: model, ...modes(model, files), ...besides };
  const bytes = (data: string | Uint8Array) => (typeof data === "string" ? strToU8(data) : data);
  const under = Object.entries(made).map(([file, text]) => [`page/${file}`, text] as const);
  const all = [...Object.entries(needed), [said, `${commands.join("\n")}\n`] as const, ...under];
  download(name, zipSync(Object.fromEntries(all.map(([path, data]) => [path, bytes(data)]))) as BlobPart, "application/zip");
}

/** Folds a menu up where a person chooses from it or leaves it. */
export function menu(label: string, ...buttons: HTMLElement[]): HTMLDetailsElement {
  const element = h("details", { class: "menu" }, h("summary", {}, label), h("div", {}, ...buttons));
  element.addEventListener("click", (event) => {
    if ((event.target as Element).closest("button")) element.open = false;
  });
  element.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    element.open = false;
    element.querySelector("summary")?.focus();
  });
  return element;
}

export class Exports {
  readonly menu: HTMLElement;
  /** What is printed: the report's figures. */
  readonly printed = h("div", { class: "print-only" });
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly page: Shelf) {
    const button = (label: string, act: () => unknown) => h("button", { type: "button", onclick: () => void act() }, label);
    this.menu = menu(
      "Export",
      button("Everything (ZIP)", () => this.everything()),
      button("Model (TOML)", () => this.model()),
      button("History (CSV)", () => this.file("history.csv", "text/csv")),
      button("Events (CSV)", () => this.file("events.csv", "text/csv")),
      button("Summary (JSON)", () => this.file("summary.json", "application/json")),
      button("Report (HTML)", () => this.file("report.html", "text/html")),
      button("Figures (SVG)", () => this.figures("svg")),
      button("Figures (PNG)", () => this.figures("png")),
      button("Animation as it stands (PNG)", () => savePng(page.stage.canvas, "animation.png")),
      button("Animation (film)", () => this.film()),
      button("Copy the command that repeats it", () => this.copy(command(page.desk.wanted), "The command is in the clipboard. Model and records for it are in the ZIP.")),
      button("Print", () => this.print()),
    );
  }

  async copy(text: string, said: string): Promise<void> {
    try {
      await navigator.clipboard.writeText(text);
      this.page.say(said);
      this.page.tell(said);
    } catch {
      this.page.tell(text);
    }
  }

  /** Draws what is printed once the page rests. */
  prepareAtRest(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.prepare().catch(() => {}), PRINT_REST_MS);
  }

  private made(...names: string[]): Promise<Files> {
    return this.page.desk.files(names, command);
  }

  private async drawings(): Promise<Drawing[]> {
    return JSON.parse((await this.made("figures")).files[0]!) as Drawing[];
  }

  private async model(): Promise<void> {
    await this.page.desk.rested();
    download("model.toml", this.page.desk.wanted.text, "application/toml");
  }

  private async file(name: string, type: string): Promise<void> {
    try {
      download(name, (await this.made(name)).files[0]!, type);
    } catch (error) {
      if (error instanceof ModuleError) this.page.fault(error.fault);
    }
  }

  /** Model, records, what came of them, and the command that makes it again: all of one answer. */
  private async everything(): Promise<void> {
    try {
      const names = ["summary.json", "history.csv", "events.csv", "report.html"];
      const { answered, records, text, files } = await this.made(...names);
      const made = Object.fromEntries(names.map((name, i) => [name, files[i]!]));
      hand("slipstick.zip", [command(answered.of)], ["model.toml", text], records, Object.fromEntries(this.page.motion(answered.answer.state, records)), made);
    } catch (error) {
      if (error instanceof ModuleError) this.page.fault(error.fault);
    }
  }

  private async figures(kind: "svg" | "png"): Promise<void> {
    try {
      for (const drawn of await this.drawings()) {
        if (kind === "svg") download(`${drawn.id}.svg`, drawn.svg, "image/svg+xml");
        else await picture(drawn.svg, `${drawn.id}.png`);
      }
    } catch (error) {
      if (error instanceof ModuleError) this.page.fault(error.fault);
    }
  }

  /** The part that is shown, else what is around the peak. */
  private async film(): Promise<void> {
    const { stage, desk } = this.page;
    await desk.rested();
    const { answered } = desk;
    if (!answered) return;
    const { state } = answered.answer;
    this.page.say("The film is made as the animation plays.");
    this.page.tell("The film is made as the animation plays; pause ends it.");
    const made = await film(stage, `${state.name}: ${this.page.moved(state)}`, stage.span, () => desk.answered === answered);
    if (made) download(`animation.${made.ending}`, made.blob, made.blob.type);
    else this.page.fault({ message: "Animation: expected a browser that records films, found none; take a picture instead" });
  }

  private async prepare(): Promise<void> {
    const { answered, files } = await this.made("figures");
    // What is drawn may be of something newer; then it is prepared at rest again.
    if (this.page.desk.answered !== answered || this.page.desk.wanted.number !== answered.of.number) return;
    const { state } = answered.answer;
    const drawings = JSON.parse(files[0]!) as Drawing[];
    fill(
      this.printed,
      h("p", {}, state.line),
      h("p", {}, `Ground motion: ${this.page.moved(state)}`),
      h("p", {}, h("small", {}, state.motion.words)),
      ...this.page.tables.map((table) => table.cloneNode(true)),
      ...drawings.map((drawn) => h("figure", {}, drawing(drawn.svg, drawn.caption), h("figcaption", {}, drawn.caption))),
    );
  }

  private async print(): Promise<void> {
    await this.prepare().catch(() => {});
    await Promise.all([...this.printed.querySelectorAll("img")].map((image) => image.decode().catch(() => {})));
    print();
  }
}
