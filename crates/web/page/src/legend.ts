/** What is what in the picture: told where the pointer is or a finger taps, and listed. */

import { fill, h } from "./dom";
import type { Part } from "./scene";

export class Legend {
  /** Stands over the picture. */
  readonly tip = h("p", { class: "tip", role: "status", hidden: true });
  /** The same as a list. */
  readonly list = h("dl", { class: "parts" });
  private shown = "";

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly parts: () => Part[],
  ) {
    const tell = (event: PointerEvent) => this.tell(event.offsetX, event.offsetY);
    canvas.addEventListener("pointermove", tell);
    canvas.addEventListener("pointerdown", tell);
    canvas.addEventListener("pointerleave", (event) => {
      // What a tap tells stays until the next tap.
      if (event.pointerType === "mouse") this.tip.hidden = true;
    });
  }

  /** The part that was drawn last where the pointer is; a small one is easier to hit than it is. */
  private tell(x: number, y: number): void {
    const room = 6;
    const hit = [...this.parts()].reverse().find(({ box: [left, top, width, height] }) => x > left - room && x < left + width + room && y > top - room && y < top + height + room);
    this.tip.hidden = !hit;
    if (!hit) return;
    fill(this.tip, h("strong", {}, hit.name), ` ${hit.about}`);
    this.tip.style.left = `${Math.min(Math.max(8, x - 120), Math.max(8, this.canvas.clientWidth - 256))}px`;
    // Above or below the finger, within the picture.
    const above = y > this.canvas.clientHeight / 2;
    this.tip.style.top = above ? "auto" : `${this.canvas.offsetTop + y + 18}px`;
    this.tip.style.bottom = above ? `${this.canvas.clientHeight - y + 14}px` : "auto";
  }

  /** Lists what is in the picture now. */
  update(): void {
    const parts = new Map(this.parts().map(({ name, about }) => [name, about]));
    const shown = [...parts.keys()].join();
    if (shown === this.shown) return;
    this.shown = shown;
    fill(this.list, ...[...parts].flatMap(([name, about]) => [h("dt", {}, name), h("dd", {}, about)]));
  }
}
