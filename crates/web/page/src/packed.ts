/** Module and worker from texts: what needs no server. */

import type { Engine } from "./desk";

/** The bytes of a text in base64, unpacked. */
export async function unpack(text: string): Promise<ArrayBuffer> {
  const binary = atob(text.trim());
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = binary.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

export function packed(text: (id: string) => string): Engine {
  const module = unpack(text("slipstick-wasm")).then((bytes) => WebAssembly.compile(bytes));
  const url = URL.createObjectURL(new Blob([text("slipstick-worker")], { type: "text/javascript" }));
  return { module: () => module, worker: () => new Worker(url) };
}
