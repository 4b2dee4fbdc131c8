// What the server has sent about the files: facts and histogram of each step, and of the file it is compared with.

export class KnownFiles {
  constructor() {
    this.entries = new Map();  // "step side" -> {facts, histogram}
  }

  entry(step, side) {
    return this.entries.get(`${step} ${side}`);
  }

  /** Returns the facts of `step`; if they have not arrived, those of the step whose facts came first. */
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

  /** Sets the values that all steps share from now on. Returns whether a step had others. */
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
