/** What leaves the page: files, figures, pictures, links, paper. */

import { strToU8, zipSync } from "fflate";
import { type Desk, ModuleError } from "./desk";
import { download, drawing, fill, h } from "./dom";
import type { Drawing, Fault, State } from "./types";

/** What the exports need of the page. */
export interface Shelf {
  desk: Desk;
  text: () => string;
  /** Of a judged answer. */
  state: () => State | undefined;
  /** The files of the motion, by their paths in the model. */
  records: () => [path: string, bytes: Uint8Array][];
  /** The animation as it stands. */
  scene: HTMLCanvasElement;
  /** What stands before the figures on paper. */
  tables: HTMLElement[];
  say: (text: string) => void;
  /** Shows a line for a while. */
  tell: (text: string) => void;
  fault: (fault: Fault) => void;
}

/** How long the page rests before its print is prepared, in ms. */
const PRINT_REST_MS = 900;

const COMMAND = "slipstick run model.toml --out out";

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
      button("Model (TOML)", () => download("model.toml", page.text(), "application/toml")),
      button("History (CSV)", () => this.file("history.csv", "text/csv")),
      button("Events (CSV)", () => this.file("events.csv", "text/csv")),
      button("Summary (JSON)", () => this.file("summary.json", "application/json")),
      button("Report (HTML)", () => this.file("report.html", "text/html")),
      button("Figures (SVG)", () => this.figures("svg")),
      button("Figures (PNG)", () => this.figures("png")),
      button("Animation as it stands (PNG)", () => this.savePng(page.scene, "animation.png")),
      button("Copy the command that repeats it", () => this.copy(COMMAND, "The command is in the clipboard.")),
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

  private made(name: string): Promise<string> {
    return this.page.desk.helper.call("file", name, this.page.text(), COMMAND);
  }

  private async drawings(): Promise<Drawing[]> {
    return JSON.parse(await this.made("figures")) as Drawing[];
  }

  private async file(name: string, type: string): Promise<void> {
    try {
      download(name, await this.made(name), type);
    } catch (error) {
      if (error instanceof ModuleError) this.page.fault(error.fault);
    }
  }

  /** Model, records, what came of them, and the command that makes it again. */
  private async everything(): Promise<void> {
    try {
      const files: Record<string, Uint8Array> = {
        "model.toml": strToU8(this.page.text()),
        "command.txt": strToU8(`${COMMAND}\n`),
        ...Object.fromEntries(this.page.records()),
      };
      for (const name of ["summary.json", "history.csv", "events.csv", "report.html"]) files[`page/${name}`] = strToU8(await this.made(name));
      download("slipstick.zip", zipSync(files) as BlobPart, "application/zip");
    } catch (error) {
      if (error instanceof ModuleError) this.page.fault(error.fault);
    }
  }

  private async figures(kind: "svg" | "png"): Promise<void> {
    try {
      for (const drawn of await this.drawings()) {
        if (kind === "svg") download(`${drawn.id}.svg`, drawn.svg, "image/svg+xml");
        else await this.png(drawn);
      }
    } catch (error) {
      if (error instanceof ModuleError) this.page.fault(error.fault);
    }
  }

  private async png(drawn: Drawing): Promise<void> {
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

  private savePng(canvas: HTMLCanvasElement, name: string): Promise<void> {
    return new Promise((done) =>
      canvas.toBlob((blob) => {
        if (blob) download(name, blob, "image/png");
        done();
      }),
    );
  }

  private async prepare(): Promise<void> {
    const state = this.page.state();
    if (!state) return;
    const drawings = await this.drawings();
    fill(
      this.printed,
      h("p", {}, state.line),
      h("p", {}, `Ground motion: ${state.motion.words}`),
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
