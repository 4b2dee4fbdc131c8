// Undo: keeps former looks without camera and step, which nobody wants to restore.

const kMost = 100;
const kKept = ["mode", "colormap", "opacity", "range", "density", "iso", "shading", "box", "light", "exposure"];

const kept = (look) => JSON.stringify(kKept.map((key) => look[key]));
const apply = (look, text) => {
  const values = JSON.parse(text);
  return {...look, ...Object.fromEntries(kKept.map((key, i) => [key, values[i]]))};
};

export class History {
  constructor(look) {
    this.past = [];
    this.future = [];
    this.now = kept(look);
  }

  /** Records a completed change as one step of undo. */
  mark(look) {
    const now = kept(look);
    if (now === this.now) return;
    this.past.push(this.now);
    if (this.past.length > kMost) this.past.shift();
    this.future = [];
    this.now = now;
  }

  undo(look) { return this.go(look, this.past, this.future); }
  redo(look) { return this.go(look, this.future, this.past); }

  go(look, from, to) {
    if (from.length === 0) return look;
    to.push(this.now);
    this.now = from.pop();
    return apply(look, this.now);
  }
}
