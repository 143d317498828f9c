/** The address of the page: it holds the state, and Back undoes. */

import { decode, encode, type Shared } from "./share";

export class Address {
  private remembered = "";
  /** How often a state was taken up or read: an older one that comes later is left. */
  private turn = 0;
  private reading = 0;
  /** The address was short: the next state takes its place. */
  private short = false;

  /** Takes a state up; a new one is a step that Back undoes. */
  async remember(shared: Shared): Promise<void> {
    // What the address says by now comes before what was shown till now.
    if (this.reading > 0) return;
    const turn = ++this.turn;
    const fragment = await encode(shared);
    if (turn !== this.turn) return;
    if (fragment === this.remembered || fragment === location.hash) return;
    const first = this.short || (this.remembered === "" && location.hash === "");
    this.short = false;
    this.remembered = fragment;
    try {
      if (first) history.replaceState(null, "", fragment);
      else history.pushState(null, "", fragment);
    } catch {
      // A browser takes only so many states in a minute.
    }
  }

  /** The guided scene that a short address names. */
  scene(): string | undefined {
    const name = /^#scene\.([\w-]+)$/.exec(location.hash)?.[1];
    this.short = name !== undefined;
    return name;
  }

  /** The state that the address holds; `null` where there is none, nothing where it holds another by now. */
  async read(): Promise<Shared | null | undefined> {
    const turn = ++this.turn;
    const fragment = location.hash;
    this.reading++;
    const shared = await decode(fragment).finally(() => this.reading--);
    if (turn !== this.turn) return undefined;
    if (shared) this.remembered = fragment;
    return shared;
  }
}
