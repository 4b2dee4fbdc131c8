// What the server has said of the files: facts and histogram of each step, and of the file it is compared with.

export class KnownFiles {
  constructor() {
    this.entries = new Map();  // "step side" -> {facts, histogram}
  }

  entry(step, side) {
    return this.entries.get(`${step} ${side}`);
  }

  /** Of a step that nothing was said of yet, those of the one that was told first. */
  facts(step, side = 0) {
    return this.entry(step, side)?.facts ?? this.first(side)?.facts;
  }

  histogram(step) {
    return (this.entry(step, 0) ?? this.first(0))?.histogram;
  }

  first(side) {
    return [...this.entries].find(([key, {facts}]) => facts && key.endsWith(` ${side}`))?.[1];
  }

  clear() {
    this.entries.clear();
  }

  /** Keeps a message of the type "facts" or "histogram". */
  add(message) {
    const key = `${message.step} ${message.side}`;
    this.entries.set(key, {...this.entries.get(key), [message.type]: message});
  }

  /** All steps have these values in common from now on; whether any of them is another. */
  set_values({range, background, opacity}) {
    let other = false;
    for (const {facts} of this.entries.values()) {
      if (!facts) continue;
      other ||= facts.range[0] !== range[0] || facts.range[1] !== range[1] || facts.background !== background;
      Object.assign(facts, {range, background, opacity});
    }
    return other;
  }
}
