/** The page from a static host: module and worker are files beside it. */

import { App } from "./app";

const module = WebAssembly.compileStreaming(fetch("slipstick.wasm"));
const app = new App(document.body, { module: () => module, worker: () => new Worker("worker.js") }, { address: true });
Object.assign(globalThis, { slipstick: app });

if ("serviceWorker" in navigator && location.protocol.startsWith("http")) {
  addEventListener("load", () => void navigator.serviceWorker.register("service-worker.js").catch(() => {}));
}
