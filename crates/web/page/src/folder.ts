/** The page from a static host: modules and workers are files beside it. */

import { App } from "./app";
import type { Part } from "./desk";
import { unpack } from "./first";

/** A module and its worker, fetched where they are first asked for. */
function part(name: string, worker: string, then = () => {}): Part {
  let module: Promise<WebAssembly.Module> | undefined;
  const fetched = async () => {
    try {
      return await WebAssembly.compileStreaming(fetch(name));
    } catch (error) {
      module = undefined;
      throw error;
    } finally {
      then();
    }
  };
  return { module: () => (module ??= fetched()), worker: () => new Worker(worker) };
}

/** Keeps the page's files, once none is waited for. */
function keep(): void {
  if ("serviceWorker" in navigator && location.protocol.startsWith("http")) {
    void navigator.serviceWorker.register("service-worker.js").catch(() => {});
  }
}

const engine = { ...part("slipstick.wasm", "worker.js", keep), first: part("first.wasm", "first.js") };
const first = async () => unpack(await (await fetch("first.json")).text());
const app = new App(document.body, engine, { address: true, first });
Object.assign(globalThis, { slipstick: app });
