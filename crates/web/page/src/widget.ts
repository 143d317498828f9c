/** The page in a notebook, by anywidget. */

import { App } from "./app";
import { onRecord } from "./motion";
import { packed } from "./packed";

declare const SLIPSTICK_WASM: string;
declare const SLIPSTICK_WORKER: string;
declare const SLIPSTICK_STYLE: string;

interface Model {
  get(name: string): unknown;
  set(name: string, value: unknown): void;
  save_changes(): void;
}

function render({ model, el }: { model: Model; el: HTMLElement }): () => void {
  const root = el.attachShadow({ mode: "open" });
  const style = new CSSStyleSheet();
  style.replaceSync(SLIPSTICK_STYLE);
  root.adoptedStyleSheets = [style];
  const texts: Record<string, string> = { "slipstick-wasm": SLIPSTICK_WASM, "slipstick-worker": SLIPSTICK_WORKER };
  const records = Object.entries(model.get("records") as Record<string, string>).map(([name, data]) => ({
    name,
    bytes: Uint8Array.from(atob(data), (character) => character.charCodeAt(0)),
  }));
  const text = model.get("model") as string;
  const motion = model.get("motion") as string;
  const app = new App(root, packed((id) => texts[id] ?? ""), {
    model: motion ? onRecord(text, { name: motion }) : text,
    records,
    address: false,
    onstate: ({ model: text, summary }) => {
      model.set("model", text);
      model.set("summary", JSON.parse(summary));
      model.save_changes();
    },
  });
  return () => app.close();
}

export default { render };
