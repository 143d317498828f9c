/** The address of the page: it holds the state, and Back undoes. */

import { decode, encode, type Shared } from "./share";

export class Address {
  private remembered = "";
  /** The address was short: the next state takes its place. */
  private short = false;

  /** Takes a state up; a new one is a step that Back undoes. */
  async remember(shared: Shared): Promise<void> {
    const fragment = await encode(shared);
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

  /** The state that the address holds; `null` where there is none. */
  async read(): Promise<Shared | null> {
    const shared = await decode(location.hash);
    if (shared) this.remembered = location.hash;
    return shared;
  }
}
