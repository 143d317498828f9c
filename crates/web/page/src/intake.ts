/** Files that come in: models, plans, records, and what has to be asked of them. */

import { type Desk, Ended, ModuleError } from "./desk";
import { fill, h } from "./dom";
import { RECORDS } from "./examples";
import { isPlan, type RecordChoice } from "./motion";
import type { Shared } from "./share";
import type { Fault, Inspected } from "./types";

/** The largest file that is read, and the most samples that are drawn. */
const MOST_BYTES = 128 * 2 ** 20;
const MOST_SAMPLES = 1_000_000;

/** What the intake needs of the page. */
export interface Taking {
  desk: Desk;
  root: HTMLElement;
  /** Records of the person's own, with what was said of them. */
  own: Map<string, { sha256: string; choice: RecordChoice }>;
  text: () => string;
  setText: (text: string) => void;
  /** Moves the table by a record. */
  take: (record: RecordChoice) => void;
  study: (plan: string) => void;
  /** Several records came at once. */
  many: () => void;
  listRecords: () => void;
  /** A record that counts in no suite unless a person says so. */
  leave: (name: string) => void;
  fault: (fault: Fault) => void;
}

export class Intake {
  /** Files that the address names, with their hashes, and that are not here. */
  wanted: Shared["records"] = [];
  /** The file that the model names and that is not here. */
  private missed: string | undefined;

  /** What was said of a file of those that come together: it is tried for the next ones. */
  private answered: { units: string; dt: string } | undefined;
  /** Whether those of them with a vertical motion alone are to move the table. */
  private upright: boolean | undefined;

  constructor(private readonly page: Taking) {}

  /** A file that the model names is not here, or none any more. */
  miss(path: string | undefined): void {
    this.missed = path;
  }

  /** What asks for the file that is not here: a sentence, and what a person chooses it by. */
  asking(path: string): [sentence: string, choose: HTMLElement] {
    const name = lastPart(path);
    const of = this.wanted.some((record) => record.name === name) ? "link" : "model";
    const input = h("input", { type: "file", class: "hidden", tabindex: -1, "aria-label": name });
    input.addEventListener("change", () => {
      void this.files([...(input.files ?? [])], name);
      input.value = "";
    });
    const choose = h("button", { type: "button", class: "main", onclick: () => input.click() }, `Choose ${name}…`);
    return [`This ${of} needs the file ${name}: choose it, or drop it on the page.`, h("span", {}, input, choose)];
  }

  /** Files that were dropped or opened: models, plans and records; `as`: chosen for a file of that name. */
  async files(files: File[], as?: string): Promise<void> {
    const taken: RecordChoice[] = [];
    this.answered = undefined;
    this.upright = undefined;
    const names = new Set<string>();
    let plan: string | undefined;
    for (const file of files) {
      try {
        if (file.size > MOST_BYTES) {
          throw new ModuleError({ message: `${file.name}: expected a file of at most ${MOST_BYTES / 2 ** 20} MiB, found ${(file.size / 2 ** 20).toFixed(0)} MiB; the command slipstick reads larger ones` });
        }
        const bytes = new Uint8Array(await file.arrayBuffer());
        if (/\.toml$/i.test(file.name)) {
          let text: string;
          try {
            text = new TextDecoder("utf-8", { fatal: true }).decode(bytes);
          } catch {
            throw new ModuleError({ message: `${file.name}: expected text in UTF-8, found other bytes` });
          }
          if (isPlan(text)) plan = text;
          else this.page.setText(text);
          continue;
        }
        if (isModes(bytes)) {
          await this.page.desk.put(file.name, bytes);
          this.page.desk.changed();
          continue;
        }
        // Two of one name, from two folders, are two.
        const name = as ?? another(file.name, names);
        names.add(name);
        const choice = await this.record(name, bytes);
        if (choice) taken.push(choice);
      } catch (error) {
        if (error instanceof ModuleError) this.page.fault(error.fault);
        else if (!(error instanceof Ended)) this.page.fault({ message: `${file.name}: ${String(error)}` });
      }
    }
    this.page.listRecords();
    if (plan !== undefined) this.page.study(plan);
    else if (taken.length > 1) this.page.many();
    else if (taken[0]) this.page.take(taken[0]);
  }

  /** Takes a record in; asks for what its file does not say. */
  private async record(dropped: string, bytes: Uint8Array): Promise<RecordChoice | undefined> {
    const { helper, records } = this.page.desk;
    const sha256 = await helper.call("hash", bytes);
    // The address knows its files whatever they are called here.
    const name = this.wanted.find((record) => record.sha256 === sha256)?.name ?? dropped;
    const before = records.get(name);
    await this.page.desk.put(name, bytes);
    const known = RECORDS.find((record) => record.name.endsWith(`/${name}`));
    let choice: RecordChoice | null = null;
    const missed = this.missed !== undefined && lastPart(this.missed) === name;
    const wanted = this.wanted.find((record) => record.name === name) ?? (missed ? { name, sha256: "" } : undefined);
    let beside = false;
    try {
      if (wanted && wanted.sha256 && wanted.sha256 !== sha256) {
        throw new ModuleError({ message: `${name}: expected the file of the address, with the SHA-256 ${wanted.sha256.slice(0, 12)}…, found another of this name, ${sha256.slice(0, 12)}…` });
      }
      let inspected: Inspected | undefined;
      let fault: Fault | undefined;
      try {
        inspected = await helper.call("inspect", name, "", "");
      } catch (error) {
        if (!(error instanceof ModuleError)) throw error;
        fault = error.fault;
      }
      if (inspected) refuseLong(name, inspected);
      if (wanted) {
        choice = { name };
      } else if (inspected?.plain) {
        choice = { name };
        if (inspected.upright) beside = !(this.upright ??= await this.askUpright(name));
      } else if (inspected && !inspected.channels.some((channel) => channel.usable || channel.counts)) {
        const found = [...new Set(inspected.channels.map((channel) => channel.quantity))].join(", ");
        throw new ModuleError({ message: `${name}: expected a channel of acceleration, found ${found}` });
      } else if (inspected || (fault && asks(fault.message))) {
        choice = known && !inspected ? { name, units: known.units, dt: known.dt } : ((await this.asBefore(name)) ?? (await this.ask(name, inspected, fault)));
      } else if (fault) throw new ModuleError(fault);
    } finally {
      if (!choice) {
        if (before) void this.page.desk.put(name, before).catch(() => {});
        else this.page.desk.drop(name);
      }
    }
    if (!choice) return undefined;
    this.page.own.set(name, { sha256, choice });
    if (before && !wanted) this.page.desk.changed();
    if (beside) {
      this.page.leave(name);
      return undefined;
    }
    if (wanted) {
      // The model of the address says how it is read.
      this.wanted = this.wanted.filter((record) => record !== wanted);
      this.page.desk.changed();
      return undefined;
    }
    return choice;
  }

  /** What was said of the file before it, where that says all of this one. */
  private async asBefore(name: string): Promise<RecordChoice | null> {
    if (!this.answered) return null;
    const { units, dt } = this.answered;
    try {
      const read = await this.page.desk.helper.call("inspect", name, units, dt);
      refuseLong(name, read);
      return read.plain ? { name, ...(units ? { units } : {}), ...(dt ? { dt } : {}) } : null;
    } catch (error) {
      if (error instanceof ModuleError) return null;
      throw error;
    }
  }

  /** Asks whether a motion that is vertical is to move the table all the same. */
  private askUpright(name: string): Promise<boolean> {
    const dialog = h("dialog", { "aria-labelledby": "upright-title" });
    let table = false;
    const button = (label: string, moves: boolean, main: boolean) =>
      h("button", { type: "button", class: main ? "main" : "", onclick: () => { table = moves; dialog.close(); } }, label);
    dialog.append(
      h(
        "form",
        { method: "dialog" },
        h("h2", { id: "upright-title" }, name),
        h("p", {}, "The motion of this record is vertical. Kept beside, a model may name it as its vertical motion."),
        h("div", { class: "actions" }, button("Keep it beside", false, true), button("Use it", true, false)),
      ),
    );
    this.page.root.append(dialog);
    dialog.showModal();
    return new Promise((resolve) =>
      dialog.addEventListener("close", () => {
        dialog.remove();
        resolve(table);
      }),
    );
  }

  /** Asks for channel, units and step where the file is silent. */
  private ask(name: string, inspected: Inspected | undefined, fault: Fault | undefined): Promise<RecordChoice | null> {
    const units = h("input", { type: "text", name: "units", placeholder: "g", autocomplete: "off" });
    const dt = h("input", { type: "text", name: "dt", placeholder: "0.01 s", autocomplete: "off" });
    const channel = h("select", { name: "channel" });
    const channelField = h("label", { class: "field" }, h("span", {}, "Channel"), channel);
    const problem = h("p", { class: "fault", role: "alert" });
    const what = h("p", { class: "drop-hint" });
    const dialog = h("dialog", { "aria-labelledby": "ask-title" });
    const choices = (inspected: Inspected | undefined) => {
      channelField.hidden = !inspected || inspected.channels.length < 2;
      const moving = (inspected?.channels ?? []).filter((c) => c.usable || c.counts);
      fill(channel, ...moving.map((c) => h("option", { value: c.name }, `${c.name}${c.vertical ? ", vertical" : ""} (${c.quantity})`)));
      // A vertical component is chosen by whoever wants it.
      const along = inspected?.channels.find((c) => (c.usable || c.counts) && !c.vertical);
      if (along) channel.value = along.name;
      const counts = inspected?.channels.every((c) => c.counts);
      what.textContent = !inspected ? "" : counts ? `${inspected.layout}. Its values are counts of a recorder: give the value of one as their unit, such as 4.67e-6 m/s2.` : `${inspected.layout}. Which channel is the table's motion?`;
    };
    choices(inspected);
    problem.textContent = fault?.message.replace(/: add (units|dt) = .*?(?=, found)/, "") ?? "";
    const needsUnits = !inspected || inspected.channels.every((c) => !c.usable);
    const form = h(
      "form",
      { method: "dialog" },
      h("h2", { id: "ask-title" }, name),
      what,
      problem,
      h("label", { class: "field" }, h("span", {}, "Units of the values"), units),
      h("label", { class: "field" }, h("span", {}, "Time step"), dt),
      channelField,
      h("div", { class: "actions" }, h("button", { type: "submit", class: "main" }, "Use it"), h("button", { type: "button", onclick: () => dialog.close() }, "Leave it")),
    );
    (units.parentElement as HTMLElement).hidden = !needsUnits;
    (dt.parentElement as HTMLElement).hidden = !needsUnits;
    dialog.append(form);
    this.page.root.append(dialog);
    return new Promise((resolve) => {
      let chosen: RecordChoice | null = null;
      dialog.addEventListener("close", () => {
        dialog.remove();
        resolve(chosen);
      });
      form.addEventListener("submit", (event) => {
        event.preventDefault();
        dialog.setAttribute("aria-busy", "true");
        this.page.desk.helper.call("inspect", name, units.value, dt.value).finally(() => dialog.removeAttribute("aria-busy")).then(
          (read) => {
            try {
              refuseLong(name, read);
            } catch (error) {
              problem.textContent = (error as Error).message;
              return;
            }
            const usable = read.channels.filter((c) => c.usable);
            if (usable.length === 0 || (read.channels.length > 1 && channelField.hidden)) {
              choices(read);
              problem.textContent = usable.length === 0 ? `${name}: expected a channel of acceleration, found ${read.channels.map((c) => c.quantity).join(", ")}` : "";
              return;
            }
            chosen = {
              name,
              ...(units.value.trim() ? { units: units.value.trim() } : {}),
              ...(dt.value.trim() ? { dt: dt.value.trim() } : {}),
              ...(read.channels.length > 1 ? { channel: channel.value || (usable.find((c) => !c.vertical) ?? usable[0]!).name } : {}),
            };
            this.answered = { units: units.value.trim(), dt: dt.value.trim() };
            dialog.close();
          },
          (error: unknown) => {
            problem.textContent = error instanceof ModuleError ? error.fault.message : String(error);
            for (const field of [units, dt]) (field.parentElement as HTMLElement).hidden = false;
          },
        );
      });
      dialog.showModal();
    });
  }
}

/** The name of a file without its folders. */
export const lastPart = (path: string) => path.replace(/^.*[/\\]/, "");

/** A name that is none of some. */
function another(name: string, names: Set<string>): string {
  const [, stem = name, ending = ""] = /^(.*?)(\.[^.]*)?$/s.exec(name) ?? [];
  let made = name;
  for (let count = 2; names.has(made); count++) made = `${stem} (${count})${ending}`;
  return made;
}

/** Whether a file is a table of the modes of a structure, by its header. */
function isModes(bytes: Uint8Array): boolean {
  const lines = new TextDecoder().decode(bytes.subarray(0, 65536)).split("\n");
  const header = lines.find((line) => line.trim() !== "" && !line.trimStart().startsWith("#")) ?? "";
  const names = header.replace(/^\uFEFF/, "").toLowerCase().split(/[,;\t]/).map((name) => name.trim().replaceAll('"', ""));
  return names.some((name) => /^(period_s|frequency_hz)$/.test(name)) && names.some((name) => /^(participation|effective_mass)/.test(name));
}

/** Refuses what is too long to be drawn. */
function refuseLong(name: string, inspected: Inspected): void {
  const most = Math.max(0, ...inspected.channels.map((channel) => channel.values));
  if (most > MOST_SAMPLES) {
    throw new ModuleError({ message: `${name}: expected at most ${MOST_SAMPLES} samples on the page, found ${most}; the command slipstick takes more` });
  }
}

/** Whether a message of the reader asks for what the file does not say. */
function asks(message: string): boolean {
  return /\badd (units|dt) = /.test(message);
}
