/** Workers and what they are asked: one at a time, the newest wish first, late answers dropped. */

import type { Answer, Calls, Display, Fault, Judgement, Op, Reply, Setting } from "./types";

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
  /** Told of what was judged at rest. */
  onjudged: (number: number, found: Judgement | Fault) => void = () => {};
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
    worker.onmessage = (event: MessageEvent<Reply>) => this.hear(event.data);
    worker.onerror = (event) => {
      event.preventDefault();
      this.lose(event.message || "the worker ended");
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
    this.worker?.terminate();
    this.worker = undefined;
    this.ready = false;
    this.judging = false;
    clearTimeout(this.timer);
    this.onbusy(false);
    const left = [...(this.current ? [this.current] : []), ...this.queue];
    this.current = undefined;
    this.queue = [];
    for (const waiting of left) waiting.failed(new Ended(reason));
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
      return;
    }
    if ("judged" in reply) {
      this.judging = false;
      if (this.current) this.watch();
      else clearTimeout(this.timer);
      this.onbusy(false);
      if ("judgement" in reply) this.onjudged(reply.judged, reply.judgement);
      else {
        if (reply.fault.fatal) this.lose(reply.fault.message);
        this.onjudged(reply.judged, reply.fault);
      }
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
    const fault = { message: `the analysis ended unexpectedly: ${message}` };
    const left = [...(this.current ? [this.current] : []), ...this.queue];
    this.current = undefined;
    this.queue = [];
    this.end();
    for (const waiting of left) waiting.failed(new ModuleError(fault));
  }
}

/** What is to be shown. */
export interface Wish {
  text: string;
  set: Setting[];
  display: Display;
}

/** How long an answer must stand before it is judged, in ms: longer than a frame. */
const REST_MS = 25;

/** The one worker that answers what the page shows. */
export class Desk {
  readonly records = new Map<string, Uint8Array>();
  readonly helper: Helper;
  private wish: (Wish & { number: number }) | undefined;
  private asked = 0;
  private shown: (Wish & { number: number }) | undefined;
  private number = 0;
  stepwise = false;
  onanswer: (answer: Answer, wish: Wish) => void = () => {};
  onjudged: (judgement: Judgement, wish: Wish) => void = () => {};
  onfault: (fault: Fault, wish: Wish) => void = () => {};
  onrest: () => void = () => {};

  constructor(readonly engine: Engine) {
    this.helper = new Helper(engine, this.records, true);
    // An answer of the first module that has just come is taken in before it is asked for again.
    this.helper.onwhole = () =>
      setTimeout(() => {
        if (this.shown && !this.wish && !this.asked) this.want(this.shown);
      });
    this.helper.onjudged = (number, found) => {
      if (this.shown?.number === number && number === this.number) this.settle(this.shown, found);
    };
  }

  /** A wish replaces the one before it; there is at most one in work. */
  want(wish: Wish): void {
    this.wish = { ...wish, number: ++this.number };
    void this.turn();
  }

  private async turn(): Promise<void> {
    const wish = this.wish;
    if (!wish || this.asked) return;
    this.wish = undefined;
    this.asked = wish.number;
    try {
      const rest = { after_ms: REST_MS, number: wish.number, stepwise: this.stepwise };
      const answer = await this.helper.call("analyse", wish.text, wish.set, wish.display, rest);
      this.asked = 0;
      this.shown = wish;
      this.onanswer(answer, wish);
    } catch (error) {
      this.asked = 0;
      if (error instanceof ModuleError) this.onfault(error.fault, wish);
    }
    if (this.wish) void this.turn();
  }

  /** Judges what is shown once more, unless something newer is wanted by then. */
  async judge(): Promise<void> {
    const of = this.shown;
    if (!of || this.wish || this.asked || of.number !== this.number) return;
    try {
      const judgement = await this.helper.call("judge", this.stepwise);
      if (of.number === this.number) this.settle(of, judgement);
    } catch (error) {
      if (error instanceof ModuleError) this.settle(of, error.fault);
    }
  }

  private settle(of: Wish, found: Judgement | Fault): void {
    if ("certificate" in found) {
      this.onjudged(found, of);
      this.onrest();
    } else this.onfault(found, { text: "", set: [], display: "si" });
  }

  async add(name: string, bytes: Uint8Array): Promise<void> {
    this.records.set(name, bytes);
    await this.helper.call("add", name, bytes);
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
