/** Workers and what they are asked: one at a time, the newest wish first, late answers dropped. */

import type { Answer, Calls, Display, Fault, Judgement, Op, Reply, Setting } from "./types";

/** How a build gets its module and makes its workers. */
export interface Engine {
  module: () => Promise<WebAssembly.Module>;
  worker: () => Worker;
}

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
  /** Told where there is nothing to do. */
  onidle: () => void = () => {};

  constructor(
    private readonly engine: Engine,
    private readonly records: Map<string, Uint8Array>,
  ) {}

  get idle(): boolean {
    return !this.current && this.queue.length === 0;
  }

  /** Makes the worker before it is needed. */
  async start(): Promise<void> {
    if (this.worker) return;
    const worker = this.engine.worker();
    this.worker = worker;
    worker.onmessage = (event: MessageEvent<Reply>) => this.hear(event.data);
    worker.onerror = (event) => {
      event.preventDefault();
      this.lose(event.message || "the worker ended");
    };
    let module: WebAssembly.Module;
    try {
      module = await this.engine.module();
    } catch (error) {
      this.lose(`expected a browser with WebAssembly and its vector instructions, found ${String(error)}`);
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
    clearTimeout(this.timer);
    this.onbusy(false);
    const left = [...(this.current ? [this.current] : []), ...this.queue];
    this.current = undefined;
    this.queue = [];
    for (const waiting of left) waiting.failed(new Ended(reason));
  }

  private ready = false;

  private send(): void {
    if (!this.ready || !this.worker || this.current) return;
    const waiting = this.queue.shift();
    if (!waiting) {
      this.onidle();
      return;
    }
    const id = this.next++;
    this.current = { ...waiting, id };
    this.watch();
    this.worker.postMessage({ id, op: waiting.op, args: waiting.args });
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

/** How long a wish must stand before it is judged, in ms. */
const REST_MS = 25;

/** The one worker that answers what the page shows. */
export class Desk {
  readonly records = new Map<string, Uint8Array>();
  readonly helper: Helper;
  private wish: (Wish & { number: number }) | undefined;
  private asked = 0;
  private shown: (Wish & { number: number }) | undefined;
  private number = 0;
  private rest: ReturnType<typeof setTimeout> | undefined;
  stepwise = false;
  onanswer: (answer: Answer, wish: Wish) => void = () => {};
  onjudged: (judgement: Judgement, wish: Wish) => void = () => {};
  onfault: (fault: Fault, wish: Wish) => void = () => {};
  onrest: () => void = () => {};

  constructor(readonly engine: Engine) {
    this.helper = new Helper(engine, this.records);
  }

  /** A wish replaces the one before it; there is at most one in work. */
  want(wish: Wish): void {
    this.wish = { ...wish, number: ++this.number };
    clearTimeout(this.rest);
    this.turn();
  }

  private async turn(): Promise<void> {
    const wish = this.wish;
    if (!wish || this.asked) return;
    this.wish = undefined;
    this.asked = wish.number;
    try {
      const answer = await this.helper.call("analyse", wish.text, wish.set, wish.display);
      this.asked = 0;
      this.shown = wish;
      this.onanswer(answer, wish);
      clearTimeout(this.rest);
      this.rest = setTimeout(() => this.judge(), REST_MS);
    } catch (error) {
      this.asked = 0;
      if (error instanceof ModuleError) this.onfault(error.fault, wish);
    }
    if (this.wish) void this.turn();
  }

  /** Judges what is shown, unless something newer is wanted by then. */
  async judge(): Promise<void> {
    const of = this.shown;
    if (!of || this.wish || this.asked || of.number !== this.number) return;
    try {
      const judgement = await this.helper.call("judge", this.stepwise);
      if (of.number === this.number) {
        this.onjudged(judgement, of);
        this.onrest();
      }
    } catch (error) {
      if (error instanceof ModuleError) {
        this.onfault(error.fault, { text: "", set: [], display: "si" });
      }
    }
  }

  async add(name: string, bytes: Uint8Array): Promise<void> {
    this.records.set(name, bytes);
    await this.helper.call("add", name, bytes);
  }
}

/** Does the slices of a sweep on several workers. */
export class Pool {
  private helpers: Helper[] = [];
  private known = "";

  constructor(
    private readonly engine: Engine,
    private readonly records: Map<string, Uint8Array>,
    readonly size = Math.max(1, Math.min(4, (navigator.hardwareConcurrency || 2) - 1)),
  ) {}

  private many(count: number): Helper[] {
    while (this.helpers.length < count) {
      this.helpers.push(new Helper(this.engine, this.records));
    }
    return this.helpers.slice(0, count);
  }

  /** All slices of `count`, in any order; `done` is told of each. */
  async slices(
    count: number,
    size: number,
    work: (helper: Helper, from: number, to: number) => Promise<void>,
  ): Promise<void> {
    // Workers that do not know all records give way to others.
    const known = [...this.records].map(([name, bytes]) => `${name} ${bytes.length}`).join();
    if (known !== this.known) this.stop();
    this.known = known;
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
