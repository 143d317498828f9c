/** Workers and what they are asked: one at a time, the newest wish first, late answers dropped. */

import type { Answer, Calls, Fault, Judgement, Op, Reply, Revision, Setting } from "./types";

/** A module, and what makes a worker for it. */
export interface Part {
  module: () => Promise<WebAssembly.Module>;
  worker: () => Worker;
}

/** How a build gets its module and makes its workers. */
export interface Engine extends Part {
  /** A module that is there sooner and answers one analysis, unchecked. */
  first?: Part;
}

/** What the first module answers. */
const EARLY = new Set<Op>(["add", "remove", "hash", "analyse", "histories", "wait", "trap"]);

/** An error of the module. */
export class ModuleError extends Error {
  constructor(readonly fault: Fault) {
    super(fault.message);
  }
}

/** Its worker was ended before it answered. */
export class Ended extends Error {}

interface Waiting {
  op: Op;
  args: unknown[];
  done: (result: unknown) => void;
  failed: (error: Error) => void;
}

/** How long a worker may be silent before it counts as busy, in ms. */
const PATIENCE_MS = 2000;

/** A worker with a queue of requests. */
export class Helper {
  private worker: Worker | undefined;
  private queue: Waiting[] = [];
  private current: (Waiting & { id: number }) | undefined;
  private next = 1;
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** Told of progress. */
  onprogress: (done: number, planned: number) => void = () => {};
  /** Told where the worker is silent for long, and where it speaks again. */
  onbusy: (busy: boolean) => void = () => {};
  /** Told that an answer is being judged, and what its text says. */
  onjudging: (number: number, text: string) => void = () => {};
  /** Told of what was judged at rest. */
  onjudged: (number: number, found: Judgement | Fault) => void = () => {};
  /** Told that its worker is gone, with why where nobody ended it; what it was to judge has no answer. */
  onended: (died: string | undefined) => void = () => {};
  /** Told where the whole module has taken the first one's place, and knows of no answer yet. */
  onwhole: () => unknown = () => {};
  /** Whether the first module is at work. */
  early: boolean;
  private whole: "wanted" | "here" | undefined;

  /** `early`: with the first module until the whole one is there. */
  constructor(
    private readonly engine: Engine,
    private readonly records: Map<string, Uint8Array>,
    early = false,
  ) {
    this.early = early && engine.first !== undefined;
  }

  get idle(): boolean {
    return !this.current && !this.judging && this.queue.length === 0;
  }

  /** Makes the worker before it is needed. */
  async start(): Promise<void> {
    if (this.worker) return;
    const part = (this.early && this.engine.first) || this.engine;
    const worker = part.worker();
    this.worker = worker;
    worker.onmessage = (event: MessageEvent<Reply>) => this.worker === worker && this.hear(event.data);
    worker.onmessageerror = () => this.worker === worker && this.lose("what the worker said could not be read");
    worker.onerror = (event) => {
      event.preventDefault();
      if (this.worker === worker) this.lose(event.message || "the worker ended");
    };
    let module: WebAssembly.Module;
    try {
      module = await part.module();
    } catch (error) {
      if (this.worker === worker) this.lose(`expected a browser with WebAssembly and its vector instructions, found ${String(error)}`);
      return;
    }
    if (this.worker !== worker) return;
    worker.postMessage({ module });
    for (const [name, bytes] of this.records) {
      worker.postMessage({ id: 0, op: "add", args: [name, bytes] });
    }
    this.send();
  }

  call<O extends Op>(op: O, ...args: Parameters<Calls[O]>): Promise<ReturnType<Calls[O]>> {
    return new Promise((done, failed) => {
      this.queue.push({ op, args, done: done as (result: unknown) => void, failed });
      void this.start();
      this.send();
    });
  }

  /** Ends the worker; what it was asked gets no answer. The next request gets a new one. */
  end(reason = "it was stopped"): void {
    this.give(new Ended(reason), undefined);
  }

  /** Gives the worker up; all that it was asked fails with an error. */
  private give(error: Error, died: string | undefined): void {
    this.worker?.terminate();
    this.worker = undefined;
    this.ready = false;
    this.judging = false;
    clearTimeout(this.timer);
    this.onbusy(false);
    const left = [...(this.current ? [this.current] : []), ...this.queue];
    this.current = undefined;
    this.queue = [];
    this.onended(died);
    for (const waiting of left) waiting.failed(error);
  }

  private ready = false;
  private judging = false;

  private send(): void {
    if (!this.ready || !this.worker || this.current) return;
    if (this.early && this.whole === "here") {
      this.widen();
      return;
    }
    const at = this.early ? this.queue.findIndex(({ op }) => EARLY.has(op)) : 0;
    if (at !== 0) void this.wantWhole();
    const [waiting] = at < 0 ? [] : this.queue.splice(at, 1);
    if (!waiting) return;
    const id = this.next++;
    this.current = { ...waiting, id };
    this.watch();
    this.worker.postMessage({ id, op: waiting.op, args: waiting.args });
  }

  /** Asks for the whole module, once. */
  private async wantWhole(): Promise<void> {
    if (this.whole) return;
    this.whole = "wanted";
    try {
      await this.engine.module();
      this.whole = "here";
      this.send();
    } catch (error) {
      this.whole = undefined;
      const fault = { message: `expected the rest of the page, which is fetched where it is first used, found ${String(error)}` };
      const left = this.queue.filter(({ op }) => !EARLY.has(op));
      this.queue = this.queue.filter(({ op }) => EARLY.has(op));
      for (const waiting of left) waiting.failed(new ModuleError(fault));
    }
  }

  /** Goes on with the whole module. */
  private widen(): void {
    this.worker?.terminate();
    this.worker = undefined;
    this.ready = false;
    this.early = false;
    void this.start();
    this.onwhole();
  }

  private watch(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.onbusy(true), PATIENCE_MS);
  }

  private hear(reply: Reply): void {
    if ("ready" in reply) {
      this.ready = true;
      this.send();
      return;
    }
    if ("progress" in reply) {
      this.watch();
      this.onprogress(...reply.progress);
      return;
    }
    if ("judging" in reply) {
      this.judging = true;
      this.watch();
      this.onjudging(reply.judging, reply.text);
      return;
    }
    if ("judged" in reply) {
      this.judging = false;
      if (this.current) this.watch();
      else clearTimeout(this.timer);
      this.onbusy(false);
      if ("judgement" in reply) this.onjudged(reply.judged, reply.judgement);
      else if (reply.fault.fatal) this.lose(reply.fault.message);
      else this.onjudged(reply.judged, reply.fault);
      return;
    }
    const current = this.current;
    if (!current || reply.id !== current.id) return;
    clearTimeout(this.timer);
    this.onbusy(false);
    this.current = undefined;
    if ("fault" in reply) {
      if (reply.fault.fatal) {
        this.queue.unshift(current);
        this.current = undefined;
        this.lose(reply.fault.message);
        return;
      }
      current.failed(new ModuleError(reply.fault));
    } else {
      current.done(reply.result);
    }
    // What is shown is to be checked, by what only the whole module has.
    if (this.early) void this.wantWhole();
    this.send();
  }

  /** The module trapped: its worker is ended, and all that was asked of it fails. */
  private lose(message: string): void {
    const died = `the analysis ended unexpectedly: ${message}`;
    this.give(new ModuleError({ message: died, fatal: true }), died);
  }
}

/** An answer that is shown. */
export interface Answered {
  of: Revision;
  /** The text of the revision as it was asked: its keys stand in `of.text` once it rests. */
  asked: string;
  answer: Answer;
  judgement?: Judgement;
  /** Why it is not judged, where it will not be by itself. */
  unchecked?: string;
  /** Its text with the keys is not known, and will not be by itself. */
  unread?: boolean;
  /** The files have changed since: it cannot be made again. */
  gone?: boolean;
}

/** Files made of an answer, with its model's text and the files that it was made of. */
export interface Files {
  answered: Answered;
  records: Map<string, Uint8Array>;
  text: string;
  files: string[];
}

/** How long an answer must stand before it is judged, in ms: longer than a frame. */
const REST_MS = 25;

/**
 * The one state of the page: what is wanted, and what is known of it, under one number. Every change of the model,
 * its files or how it is shown is a revision with the next number; one worker answers the newest and judges it once
 * it rests. What cannot be analysed leaves the last answer standing.
 */
export class Desk {
  readonly records = new Map<string, Uint8Array>();
  readonly helper: Helper;
  wanted: Revision = { number: 0, text: "", set: [], display: "si", stepwise: false };
  answered: Answered | undefined;
  private number = 0;
  /** Numbers of the revision in work, of that which was answered or refused last, and of that whose worker died. */
  private asked = 0;
  private done = 0;
  private lost = 0;
  private waiting: (() => void)[] = [];
  /** Told where another revision is wanted, or its keys stand in its text. */
  onwanted: () => void = () => {};
  onanswer: (answered: Answered) => void = () => {};
  /** Told where an answer is judged, or will not be by itself. */
  onjudged: (answered: Answered) => void = () => {};
  onfault: (fault: Fault, of?: Revision) => void = () => {};
  /** Told where what is wanted is judged. */
  onrest: () => void = () => {};

  constructor(readonly engine: Engine) {
    this.helper = new Helper(engine, this.records, true);
    // An answer of the first module that has just come is taken in before it is asked for again.
    this.helper.onwhole = () =>
      setTimeout(() => {
        if (this.asked || this.answered?.judgement) return;
        this.done = 0;
        void this.turn();
      });
    this.helper.onjudging = (number, text) => this.fold(number, text);
    this.helper.onjudged = (number, found) => this.settle(number, found);
    this.helper.onended = (died) => this.unjudged(died);
  }

  /** Whether nothing of what is wanted is on its way any more. */
  get rests(): boolean {
    const { answered } = this;
    if (this.asked || this.done !== this.wanted.number) return false;
    if (!answered || answered.judgement) return true;
    return answered.unchecked !== undefined && (answered.of.set.length === 0 || answered.unread === true);
  }

  /** Whether what is wanted has no answer, and will have none. */
  get refused(): boolean {
    return this.done === this.wanted.number && this.answered?.of.number !== this.wanted.number;
  }

  /** Waits until it rests. */
  rested(): Promise<void> {
    return this.rests ? Promise.resolve() : new Promise((done) => this.waiting.push(done));
  }

  /** Wants another revision; it replaces the one before it, and at most one is in work. */
  want(change: Partial<Omit<Revision, "number">>): void {
    this.wanted = { ...this.wanted, ...change, number: ++this.number };
    this.onwanted();
    void this.turn();
  }

  /** Sets values of the model; the newest value of a key counts. */
  set(settings: Setting[]): void {
    const keys = new Set(settings.map(([path]) => path));
    this.want({ set: [...this.wanted.set.filter(([path]) => !keys.has(path)), ...settings] });
  }

  private async turn(): Promise<void> {
    const of = this.wanted;
    if (this.asked || this.done === of.number) return;
    this.asked = of.number;
    try {
      const answer = await this.helper.call("analyse", of, REST_MS);
      this.asked = 0;
      this.done = of.number;
      this.answered = { of, asked: of.text, answer };
      this.onanswer(this.answered);
    } catch (error) {
      this.asked = 0;
      this.failed(of, error instanceof ModuleError ? error.fault : { message: error instanceof Ended ? "the analysis was stopped" : String(error) });
    }
    void this.turn();
  }

  private failed(of: Revision, fault: Fault): void {
    // A worker that died is replaced once.
    const again = fault.fatal && this.lost !== of.number;
    if (again) this.lost = of.number;
    // Something newer is asked for instead.
    if (again || of.number !== this.wanted.number) return;
    this.done = of.number;
    const good = this.answered;
    const same = good && !good.gone && (good.asked === of.text || good.of.text === of.text);
    // Keys that cannot be set are not asked for again.
    if (same) {
      this.wanted = good.of;
      this.done = good.of.number;
    } else if (of.set.length > 0) this.wanted = { ...of, set: [], number: ++this.number };
    this.onwanted();
    this.onfault(fault, of);
    // What stays is judged too.
    if (good && !good.judgement && good.unchecked === undefined) this.check();
    else {
      // It may have been judged while something else was wanted.
      if (same && good.judgement) this.onrest();
      this.release();
    }
  }

  /** Judges what is shown once more. */
  check(): void {
    const { answered } = this;
    if (!answered) return;
    answered.unchecked = undefined;
    this.onjudged(answered);
    // What becomes of it is told as of all that is judged.
    this.helper.call("check", answered.of).catch((error: unknown) => {
      const gone = this.answered !== answered || answered.judgement !== undefined;
      if (!gone && error instanceof ModuleError && !error.fault.fatal) this.leave(answered, error.fault);
    });
  }

  /** The keys set stand in the text now. */
  private fold(number: number, text: string): void {
    const { answered } = this;
    if (answered?.of.number !== number) return;
    answered.of = { ...answered.of, text, set: [] };
    if (this.wanted.number !== number) return;
    this.wanted = answered.of;
    this.onwanted();
  }

  private settle(number: number, found: Judgement | Fault): void {
    const { answered } = this;
    if (answered?.of.number !== number) return;
    if ("certificate" in found) {
      answered.judgement = found;
      this.onjudged(answered);
      if (this.wanted.number === number) this.onrest();
      this.release();
    } else this.leave(answered, found);
  }

  /** An answer stays without a check; the certificate says why. Its keys stand in its text all the same. */
  private leave(answered: Answered, { message }: Fault): void {
    answered.unchecked = message;
    this.onjudged(answered);
    if (answered.of.set.length === 0) {
      this.release();
      return;
    }
    const unread = () => {
      answered.unread = true;
    };
    void this.helper
      .call("text", answered.of)
      .then((text) => this.fold(answered.of.number, text), unread)
      .then(() => this.release());
  }

  /** The worker is gone that was to judge what is shown. */
  private unjudged(died: string | undefined): void {
    const { answered } = this;
    if (!answered || answered.judgement || answered.unchecked !== undefined || this.asked || this.done !== this.wanted.number) return;
    const { number } = answered.of;
    if (died !== undefined && this.lost !== number) {
      this.lost = number;
      // Not before all that was asked of that worker has failed.
      setTimeout(() => this.answered === answered && this.check());
    } else this.leave(answered, { message: died ?? "the check was stopped" });
  }

  private release(): void {
    if (!this.rests) return;
    const waiting = this.waiting;
    this.waiting = [];
    for (const done of waiting) done();
  }

  /** Files of what is judged, and what they are of; of the last answer where what is wanted has none. */
  async files(names: string[], command: (of: Revision) => string): Promise<Files> {
    await this.rested();
    const { answered } = this;
    if (!answered) throw new ModuleError({ message: "nothing was analysed yet" });
    if (answered.gone) throw new ModuleError({ message: "the files of what is shown have changed since, and the model cannot be analysed on them" });
    // As they are now: what changes later is asked of the worker later.
    const records = new Map(this.records);
    return { answered, records, ...(await this.helper.call("files", answered.of, names, command(answered.of))) };
  }

  /** Keeps a file; what is shown stays as it is until `changed`. */
  async put(name: string, bytes: Uint8Array): Promise<void> {
    this.records.set(name, bytes);
    await this.helper.call("add", name, bytes);
  }

  /** Forgets a file. */
  drop(name: string): void {
    this.records.delete(name);
    void this.helper.call("remove", name).catch(() => {});
  }

  /** The files are others: the model is analysed on them. */
  changed(): void {
    if (this.answered) this.answered.gone = true;
    this.want({});
  }
}

/** Several workers that share slices of work. */
export class Pool {
  private helpers: Helper[] = [];
  private known = new Map<string, Uint8Array>();

  constructor(
    private readonly engine: Engine,
    private readonly records: Map<string, Uint8Array>,
    readonly size = Math.max(1, Math.min(4, (navigator.hardwareConcurrency || 2) - 1)),
  ) {}

  /** So many workers that know all records. */
  private many(count: number): Helper[] {
    // Those that do not know them give way to others.
    const same = this.known.size === this.records.size && [...this.records].every(([name, bytes]) => this.known.get(name) === bytes);
    if (!same) this.stop();
    this.known = new Map(this.records);
    while (this.helpers.length < count) {
      this.helpers.push(new Helper(this.engine, this.records));
    }
    return this.helpers.slice(0, count);
  }

  /** What one of them answers. */
  call<O extends Op>(op: O, ...args: Parameters<Calls[O]>): Promise<ReturnType<Calls[O]>> {
    return this.many(1)[0]!.call(op, ...args);
  }

  /** All slices of `count`, in any order; `done` is told of each. */
  async slices(
    count: number,
    size: number,
    work: (helper: Helper, from: number, to: number) => Promise<void>,
  ): Promise<void> {
    let next = 0;
    const run = async (helper: Helper) => {
      while (next < count) {
        const from = next;
        next = Math.min(count, next + size);
        await work(helper, from, next);
      }
    };
    await Promise.all(this.many(this.size).map(run));
  }

  /** Ends all workers: what is in work is lost, and nothing else. */
  stop(): void {
    for (const helper of this.helpers) helper.end();
    this.helpers = [];
  }
}
