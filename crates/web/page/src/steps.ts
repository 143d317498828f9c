/** The states of a model that a person went through. */

const MOST = 200;

export class Steps {
  private texts: string[] = [];
  private at = -1;
  /** As it was opened. */
  private first = "";

  /** A whole text that was opened: what Reset returns to. */
  opened(text: string): void {
    this.first = text;
  }

  /** A state at rest. */
  rest(text: string): void {
    if (text === this.texts[this.at]) return;
    this.texts = [...this.texts.slice(0, this.at + 1), text].slice(-MOST);
    this.at = this.texts.length - 1;
  }

  /** Whether a text is another than that of the state at which the page came to rest last. */
  changed(text: string, set: number): boolean {
    return this.at >= 0 && (set > 0 || text !== this.texts[this.at]);
  }

  get canUndo(): boolean {
    return this.at > 0;
  }

  get canRedo(): boolean {
    return this.at < this.texts.length - 1;
  }

  /** The state so many steps on, or back; what has changed since the last one is undone first. */
  go(steps: number, changed: boolean): string | undefined {
    if (changed) return steps < 0 ? this.texts[this.at] : undefined;
    const text = this.texts[this.at + steps];
    if (text !== undefined) this.at += steps;
    return text;
  }

  get start(): string {
    return this.first;
  }
}
