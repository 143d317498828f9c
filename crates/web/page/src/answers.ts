/** An answer of a session of the module, as the page takes it. */

import type { Session } from "../pkg/slipstick_web.js";
import type { Answer, Display, Setting } from "./types";

/** Analyses a model; without the table's way, which a session tells apart. */
export function answered(session: Session, text: string, set: Setting[], display: Display): Answer {
  const answer = session.analyse(text, set.flat(), display);
  const column = (number: number) => answer.column(number) as Float64Array;
  const result: Answer = {
    state: JSON.parse(answer.state()),
    time: column(0),
    table: column(1),
    s: column(2),
    velocity: column(3),
    block: column(4),
    friction: column(5),
    force: column(6),
    storeyDisplacement: column(7),
    storeyAcceleration: column(8),
    contents: column(9),
    sy: column(10),
    frictionY: column(11),
    mode: answer.mode() as Int8Array,
    eventTimes: answer.eventTimes() as Float64Array,
    eventKinds: answer.eventKinds() as Uint8Array,
    ground: answer.ground(),
  };
  answer.free();
  return result;
}

/** The answer with the table's way in it. */
export function withTable(session: Session, answer: Answer): Answer {
  return { ...answer, tableTimes: session.tableTimes() as Float64Array, tableDisplacement: session.tableDisplacement() as Float64Array };
}
