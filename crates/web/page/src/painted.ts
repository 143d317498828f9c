/** Computes the first picture while the page is built. */

import { initSync, Session } from "../pkg/slipstick_web.js";
import { answered, withTable } from "./answers";
import { RECORDS, START } from "./examples";
import { pack } from "./first";

export function first(module: Uint8Array): string {
  Object.assign(globalThis, { slipstickProgress: () => {} });
  initSync({ module: module as BufferSource });
  const session = new Session();
  for (const { name, text } of RECORDS) session.addRecord(name, new TextEncoder().encode(text));
  return pack(withTable(session, answered(session, START, [], "si")));
}
