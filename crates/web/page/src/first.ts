/**
 * The first picture: the answer of the example, computed when the page was built, as integers of a few ten
 * thousandths of its peaks. It stands until the module is there, which computes the example anew.
 */

import type { Answer } from "./types";

/** Lists of an answer; times are kept finer, for knots lie as close as they like. */
const LISTS = ["time", "table", "s", "velocity", "block", "friction", "force", "storeyDisplacement", "storeyAcceleration", "contents", "sy", "frictionY", "mode", "eventTimes", "eventKinds", "tableTimes", "tableDisplacement"] as const;
type List = (typeof LISTS)[number];
const FINE = new Set<List>(["time", "eventTimes", "tableTimes"]);
const WHOLE = new Set<List>(["mode", "eventKinds"]);

/** A list: the value of one, and the differences of its integers, their low bytes first. */
interface Packed {
  unit: number;
  count: number;
  bytes: string;
}

interface Whole extends Pick<Answer, "state"> {
  lists: Record<List, Packed>;
}

const width = (list: List) => (FINE.has(list) ? 4 : 2);

/** Packs an answer into a text. */
export function pack(answer: Answer): string {
  const lists = LISTS.map((list) => {
    const values = answer[list] ?? [];
    let peak = 0;
    for (const value of values) peak = Math.max(peak, Math.abs(value));
    const unit = WHOLE.has(list) ? 1 : peak / (FINE.has(list) ? 2 ** 26 : 2 ** 15 - 1) || 1;
    const bytes = new Uint8Array(values.length * width(list));
    let last = 0;
    values.forEach((value, i) => {
      const now = Math.round(value / unit);
      for (let byte = 0; byte < width(list); byte++) bytes[byte * values.length + i] = (now - last) >> (8 * byte);
      last = now;
    });
    let binary = "";
    for (const byte of bytes) binary += String.fromCharCode(byte);
    return [list, { unit, count: values.length, bytes: btoa(binary) }];
  });
  return JSON.stringify({ state: answer.state, lists: Object.fromEntries(lists) });
}

/** Unpacks it. */
export function unpack(text: string): Answer {
  const { state, lists } = JSON.parse(text) as Whole;
  const unpacked = LISTS.map((list) => {
    const { unit, count, bytes } = lists[list];
    const binary = atob(bytes);
    const values = new Float64Array(count);
    const shift = 32 - 8 * width(list);
    let now = 0;
    for (let i = 0; i < count; i++) {
      let difference = 0;
      for (let byte = 0; byte < width(list); byte++) difference |= binary.charCodeAt(byte * count + i) << (8 * byte);
      // The sign is that of as many bits as there are; a sum beyond them has gone round.
      now = ((now + difference) << shift) >> shift;
      values[i] = now * unit;
    }
    return [list, list === "mode" ? Int8Array.from(values) : list === "eventKinds" ? Uint8Array.from(values) : values];
  });
  return { state, ...Object.fromEntries(unpacked), ground: 0 } as Answer;
}
