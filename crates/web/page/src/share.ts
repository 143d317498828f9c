/** The state of the page in the fragment of its address. */

import type { Display } from "./types";

export interface Shared {
  /** The model's text. */
  text: string;
  display: Display;
  tab: string;
  /** What is set on the tab. */
  settings: Record<string, string>;
  stepwise: boolean;
  /** The text of the setting that is kept as B. */
  pinned?: string;
  /** The guided scene that is open. */
  scene?: string;
  /** Records of the person's own that the model needs, by name and hash. */
  records: { name: string; sha256: string }[];
}

const VERSION = "v1";

/** Most bytes of a state: no model of a person's is near it. */
const MOST_BYTES = 2 ** 20;

async function through(bytes: Uint8Array, by: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  const stream = new Blob([bytes as BlobPart]).stream().pipeThrough(by as unknown as ReadableWritablePair<Uint8Array, Uint8Array>);
  const parts: Uint8Array[] = [];
  let size = 0;
  for (const reader = stream.getReader(); ; ) {
    const { done, value } = await reader.read();
    if (done) break;
    size += value.length;
    if (size > MOST_BYTES) {
      void reader.cancel();
      throw new Error(`more than ${MOST_BYTES} bytes`);
    }
    parts.push(value);
  }
  return new Uint8Array(await new Blob(parts as BlobPart[]).arrayBuffer());
}

export async function encode(shared: Shared): Promise<string> {
  const bytes = await through(new TextEncoder().encode(JSON.stringify(shared)), new CompressionStream("deflate-raw"));
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return `#${VERSION}.${btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
}

const expected = "an address that this page made";

/** What a fragment says; `null` where there is none. */
export async function decode(fragment: string): Promise<Shared | null> {
  const [, version, data] = /^#([^.]*)\.?(.*)$/.exec(fragment) ?? [];
  if (!version) return null;
  if (version !== VERSION) throw new Error(`the address: expected ${expected}, of the version ${VERSION}, found "${version.slice(0, 20)}"`);
  try {
    const binary = atob(data!.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(binary, (character) => character.charCodeAt(0));
    const shared = JSON.parse(new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate-raw")))) as Shared;
    if (typeof shared.text !== "string") throw new Error("no text");
    const display = (["si", "si-g", "kN-mm", "us"] as Display[]).find((d) => d === shared.display) ?? "si";
    const records = Array.isArray(shared.records) ? shared.records.filter((r) => typeof r?.name === "string") : [];
    const settings = Object.fromEntries(Object.entries(shared.settings ?? {}).filter(([, value]) => typeof value === "string"));
    const said = (value: unknown) => (typeof value === "string" ? value : undefined);
    return { text: shared.text, display, tab: String(shared.tab ?? "motion"), settings, stepwise: shared.stepwise === true, records, pinned: said(shared.pinned), scene: said(shared.scene) };
  } catch {
    throw new Error(`the address: expected ${expected}, found one that is cut off, changed or too large (${data!.length} characters)`);
  }
}
