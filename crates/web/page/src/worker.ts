/** The worker: holds a session of the module and answers one request after the other. */

import { initSync, type Page, Session, sha256, version } from "../pkg/slipstick_web.js";
import { answered, withTable } from "./answers";
import type { Answer, Calls, Fault, Judgement, Op, Reply, Request, Revision, Sheet } from "./types";

const scope = globalThis as unknown as DedicatedWorkerGlobalScope & {
  slipstickProgress: (done: number, planned: number) => void;
};

const say = (reply: Reply, transfer: Transferable[] = []) => scope.postMessage(reply, transfer);

let told = 0;
scope.slipstickProgress = (done, planned) => {
  const now = performance.now();
  if (now - told > 50) {
    told = now;
    say({ progress: [done, planned] });
  }
};

let session: Session;
let lastGround = 0;

const flat = (pairs: [string, string][]) => pairs.flat();

function sheet(page: Page): Sheet {
  const made = { ...JSON.parse(page.state()), runs: JSON.parse(page.tables()), html: page.html(), json: page.json() };
  page.free();
  return made;
}

let resting: ReturnType<typeof setTimeout> | undefined;

/** The revision that the session's last answer is of, by its number, and whether that is judged. */
let held: number | undefined;
let judged = false;

/** The answer of a revision; the session holds it then. */
function answerOf({ number, text, set, display }: Revision): Answer {
  const answer = answered(session, text, set, display);
  [held, judged] = [number, false];
  return answer;
}

/** Whatever is asked of an answer is asked of that revision: another one is analysed again. */
function hold(of: Revision): void {
  if (held !== of.number) answerOf(of);
}

function judge(of: Revision): Judgement {
  hold(of);
  const found = session.judge(of.stepwise);
  judged = true;
  const beside = (number: number) => {
    const [time, s] = [found.beside(2 * number), found.beside(2 * number + 1)];
    return time.length > 0 ? { time: time as Float64Array, s: s as Float64Array } : undefined;
  };
  const result: Judgement = {
    ...JSON.parse(found.state()),
    energy: [0, 1, 2, 3, 4].map((kind) => found.energy(kind) as Float64Array),
    lower: beside(0),
    upper: beside(1),
    steps: beside(2),
  };
  found.free();
  return result;
}

/** Judges an answer that nothing newer has followed; what its text says then is told before. */
function judgeAtRest(of: Revision): void {
  const { number } = of;
  try {
    hold(of);
    say({ judging: number, text: session.text() });
    const judgement = judge(of);
    say({ judged: number, judgement }, buffers(judgement));
  } catch (error) {
    say({ judged: number, fault: fault(error) });
  }
}

/** What was made of other bytes is not held any more. */
function changed(): void {
  held = undefined;
}

const calls: Calls = {
  add(name, bytes) {
    session.addRecord(name, bytes);
    changed();
  },
  remove(name) {
    session.removeRecord(name);
    changed();
  },
  hash: (bytes) => sha256(bytes),
  inspect: (name, units, dt) => JSON.parse(session.inspect(name, units, dt)),
  analyse(of, restMs): Answer {
    clearTimeout(resting);
    let result = answerOf(of);
    if (result.ground !== lastGround) {
      lastGround = result.ground;
      result = withTable(session, result);
    }
    if (restMs !== undefined && "judge" in session) resting = setTimeout(() => judgeAtRest(of), restMs);
    return result;
  },
  judge,
  text(of) {
    hold(of);
    return session.text();
  },
  check(of) {
    clearTimeout(resting);
    resting = setTimeout(() => judgeAtRest(of));
  },
  files(of, names, command) {
    hold(of);
    if (!judged) judge(of);
    const text = of.set.length > 0 ? session.text() : of.text;
    return { text, files: names.map((name) => session.file(name, text, command)) };
  },
  sweep: (text, over, from, to) => session.sweep(text, over, from, to) as Float64Array,
  plan: (what, text, options) => session.plan(what, text, flat(options)),
  form: (what, text, display) => JSON.parse(session.form(what, text, display)),
  survey: (asked, measure, display) => JSON.parse(session.survey(asked, measure, display)),
  studyRun: (plan, text, names, run) => JSON.parse(session.studyRun(plan, text, names, run)),
  assess: (what, text, options, display) => sheet(session.assess(what, text, flat(options), display)),
  studySize: (plan, text, names) => [...session.studySize(plan, text, names)] as [number, number],
  studyRows: (plan, text, names, from, to) => session.studyRows(plan, text, names, from, to) as Float64Array,
  study: (plan, text, names, rows, display) => sheet(session.study(plan, text, names, rows, display)),
  // For the measurements: ms for a history, so many of them in turn.
  histories(count) {
    const start = performance.now();
    session.histories(count);
    return (performance.now() - start) / count;
  },
  // For the tests: a worker that is silent, and one whose module traps.
  wait(ms) {
    const end = performance.now() + ms;
    while (performance.now() < end);
  },
  trap() {
    throw new WebAssembly.RuntimeError("unreachable");
  },
};

/** Buffers of a result, which need not be copied. */
function buffers(result: unknown, found: Transferable[] = []): Transferable[] {
  if (ArrayBuffer.isView(result)) {
    found.push(result.buffer as ArrayBuffer);
  } else if (result && typeof result === "object") {
    for (const value of Object.values(result)) {
      if (value && typeof value === "object") buffers(value, found);
    }
  }
  return found;
}

function fault(error: unknown): Fault {
  if (typeof error === "string") {
    try {
      return JSON.parse(error) as Fault;
    } catch {
      return { message: error };
    }
  }
  // A trap leaves the module in no state to go on with.
  return { message: error instanceof Error ? error.message : String(error), fatal: true };
}

function answer({ id, op, args }: Request) {
  try {
    const call = calls[op as Op] as (...args: unknown[]) => unknown;
    const result = call(...args);
    say({ id, result }, buffers(result));
  } catch (error) {
    say({ id, fault: fault(error) });
  }
}

scope.onmessage = (event: MessageEvent) => {
  if (event.data?.module) {
    initSync({ module: event.data.module as WebAssembly.Module });
    session = new Session();
    scope.onmessage = (event: MessageEvent) => answer(event.data as Request);
    say({ ready: version() });
  }
};
