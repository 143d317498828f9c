/** Axes of a drawing: where a value lies, and round ticks. */

import { digits } from "./dom";
import type { AxisData } from "./types";

export interface Tick {
  value: number;
  /** Empty of a minor mark. */
  text: string;
}

/** Where a value lies: 0 at the lower end, 1 at the upper one. */
export const fraction = ({ min, max, log }: AxisData, value: number): number => (log ? Math.log(value / min) / Math.log(max / min) : (value - min) / (max - min));

/** The value that lies there. */
export const valueAt = ({ min, max, log }: AxisData, part: number): number => (log ? min * (max / min) ** part : min + part * (max - min));

function round(low: number, high: number, about: number): Tick[] {
  const raw = (high - low) / Math.max(1, about);
  const power = 10 ** Math.floor(Math.log10(raw));
  // The nearest by ratio: the border between two steps is their geometric mean.
  const step = [1, 2, 5, 10].find((m, i, all) => i === 3 || raw / power < Math.sqrt(m * all[i + 1]!))! * power;
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const plain = decimals <= 5 && Math.max(Math.abs(low), Math.abs(high)) < 1e6;
  const found: Tick[] = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) {
    const value = k * step;
    found.push({ value, text: plain ? value.toFixed(decimals).replace("-", "−") : digits(value, 2) });
  }
  return found;
}

function decades(low: number, high: number, about: number): Tick[] {
  const found: Tick[] = [];
  for (let decade = Math.floor(Math.log10(low)); decade <= Math.ceil(Math.log10(high)); decade++) {
    for (let digit = 1; digit < 10; digit++) {
      const value = Number(`${digit}e${decade}`);
      if (value >= low * 0.999999 && value <= high * 1.000001) found.push({ value, text: String(value) });
    }
  }
  // The rounder ones keep their labels.
  const kept = [/^0*[.]?0*[1-9]0*$/, /^0*[.]?0*[125]0*$/, /^0*[.]?0*10*$/].find((roundness) => found.filter(({ text }) => roundness.test(text)).length <= about);
  return found.map((tick) => ({ ...tick, text: kept && !kept.test(tick.text) ? "" : tick.text }));
}

/** Round values; a single one gives no scale, so there are more until there are three. */
function scale({ min, max }: AxisData, about: number): Tick[] {
  for (let more = 0; more < 4; more++) {
    const found = round(min, max, about + more);
    if (found.length >= 3) return found;
  }
  return round(min, max, about);
}

/** Round values on an axis, about so many with labels. */
export function ticks(axis: AxisData, about: number): Tick[] {
  if (axis.names.length > 0) return axis.names.map((text, i) => ({ value: i + 1, text })).filter(({ value }) => value >= axis.min && value <= axis.max);
  if (!axis.log) return scale(axis, about);
  const found = decades(axis.min, axis.max, about);
  // Of a part of a decade there are none to speak of.
  return found.filter(({ text }) => text).length >= 2 ? found : scale(axis, about);
}
