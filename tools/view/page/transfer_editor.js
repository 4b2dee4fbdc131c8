// The opacity curve over the values, drawn over their histogram. Points are dragged, added and removed by mouse,
// touch and keys.

import {element} from "./dom.js";
import {within} from "./format.js";

const kSvg = "http://www.w3.org/2000/svg";
const kWidth = 320;   // of the drawing, in its own units
const kHeight = 150;
const kEdge = 9;      // margin around the curve: room for a point
const kMostPoints = 32;
const kKeyStep = 0.02;
const kCoarse = 0.02;  // largest deviation in opacity when a curve is reduced to points

const svg = (tag, attributes = {}) => {
  const made = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
};
const clamp = (value, low, high) => Math.min(high, Math.max(low, value));

/** Returns a few points that approximate the curve (Ramer, Douglas and Peucker). */
export function simplified(points) {
  if (points.length < 3) return points;
  const [first, last] = [points[0], points[points.length - 1]];
  let farthest = 0;
  let at = 0;
  points.forEach(([x, y], i) => {
    const line = first[1] + (last[1] - first[1]) * (x - first[0]) / (last[0] - first[0] || 1);
    if (Math.abs(y - line) > farthest) [farthest, at] = [Math.abs(y - line), i];
  });
  if (farthest < kCoarse) return [first, last];
  return [...simplified(points.slice(0, at + 1)), ...simplified(points.slice(at)).slice(1)];
}

export class TransferEditor {
  /** Calls `changed(points)` during a change and `done()` at its end, which is one step of undo. */
  constructor(root, {changed, done}) {
    this.root = root;
    this.changed = changed;
    this.done = done;
    this.points = [];
    this.pressed = [];  // targets of the last two presses
    this.drawing = svg("svg", {viewBox: `0 0 ${kWidth} ${kHeight}`, preserveAspectRatio: "none", class: "curve"});
    this.bars = svg("path", {class: "bars"});
    this.area = svg("path", {class: "area"});
    this.line = svg("polyline", {class: "line"});
    this.iso = svg("line", {class: "iso", y1: 0, y2: kHeight});
    this.drawing.append(this.bars, this.area, this.line, this.iso);
    this.handles = element("div", "handles");
    const field = element("div", "curve-field");
    field.append(this.drawing, this.handles);
    root.append(field);
    this.field = field;
    field.addEventListener("pointerdown", (event) => this.press(event));
    field.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) field.addEventListener(name, () => this.release());
    field.addEventListener("contextmenu", (event) => {
      event.preventDefault();
      this.remove(Number(event.target.dataset?.point ?? -1));
    });
    field.addEventListener("dblclick", () => this.remove_pressed());
    field.addEventListener("keydown", (event) => this.key(event));
  }

  /** Draws `counts` of equal bins over [min, max], on an axis over `range`; as logarithms if `log`. */
  show_histogram(histogram, range, log) {
    if (!histogram || histogram.counts.length === 0) {
      this.bars.setAttribute("d", "");
      return;
    }
    const {min, max, counts} = histogram;
    const height = log ? (count) => Math.log1p(count) : (count) => count;
    const most = height(Math.max(...counts)) || 1;
    const width = range[1] - range[0] || 1;
    let path = "";
    counts.forEach((count, i) => {
      if (count === 0) return;
      const value = (share) => min + (max - min) * (i + share) / counts.length;
      const [from, to] = [this.x((value(0) - range[0]) / width), this.x((value(1) - range[0]) / width)];
      if (to < 0 || from > kWidth) return;
      const top = kHeight - height(count) / most * (kHeight - kEdge);
      path += `M${from.toFixed(2)} ${kHeight}V${top.toFixed(2)}H${Math.max(to, from + 0.6).toFixed(2)}V${kHeight}Z`;
    });
    this.bars.setAttribute("d", path);
  }

  show_iso(position) {
    this.iso.toggleAttribute("hidden", position === null);
    this.iso.style.display = position === null ? "none" : "";
    if (position === null) return;
    this.iso.setAttribute("x1", this.x(position));
    this.iso.setAttribute("x2", this.x(position));
  }

  /** Shows `points` of [position, opacity]; without points, draws `curve`. */
  show(points, curve, range) {
    this.curve = curve;
    this.range = range;
    this.points = points ?? simplified(curve);
    const drawn = points ?? curve;
    const ends = [[0, drawn[0][1]], ...drawn, [1, drawn[drawn.length - 1][1]]];
    const line = ends.map(([x, y]) => `${this.x(x).toFixed(2)},${this.y(y).toFixed(2)}`).join(" ");
    this.line.setAttribute("points", line);
    this.area.setAttribute("d", `M${this.x(0)} ${kHeight}L${line.replaceAll(" ", "L")}L${this.x(1)} ${kHeight}Z`);
    this.show_handles();
  }

  show_handles() {
    while (this.handles.children.length > this.points.length) this.handles.lastChild.remove();
    while (this.handles.children.length < this.points.length) {
      const made = element("div", "handle");
      made.tabIndex = 0;
      made.setAttribute("role", "slider");
      made.setAttribute("aria-valuemin", 0);
      made.setAttribute("aria-valuemax", 1);
      this.handles.append(made);
    }
    this.points.forEach(([x, y], i) => {
      const handle = this.handles.children[i];
      handle.dataset.point = i;
      handle.style.left = `${this.x(x) / kWidth * 100}%`;
      handle.style.top = `${this.y(y) / kHeight * 100}%`;
      const span = this.range[1] - this.range[0];
      const value = within(this.range[0] + x * span, span);
      handle.setAttribute("aria-label", `Opacity at ${value}`);
      handle.setAttribute("aria-valuenow", y.toFixed(2));
      handle.title = `${value}: opacity ${y.toFixed(2)}`;
    });
  }

  x(position) { return kEdge + position * (kWidth - 2 * kEdge); }
  y(opacity) { return kHeight - kEdge - opacity * (kHeight - 2 * kEdge); }

  place(event) {
    const box = this.field.getBoundingClientRect();
    const x = (event.clientX - box.left) / box.width * kWidth;
    const y = (event.clientY - box.top) / box.height * kHeight;
    return [clamp((x - kEdge) / (kWidth - 2 * kEdge), 0, 1), clamp((kHeight - kEdge - y) / (kHeight - 2 * kEdge), 0, 1)];
  }

  press(event) {
    if (event.button !== 0) return;
    event.preventDefault();
    this.pressed = [this.pressed.at(-1), event.target];
    const found = event.target.dataset?.point;
    if (found !== undefined) {
      this.dragged = Number(found);
    } else {
      this.dragged = this.insert(this.place(event));
      if (this.dragged < 0) return;
    }
    this.handles.children[this.dragged]?.focus();
    this.field.setPointerCapture(event.pointerId);
  }

  insert(point) {
    if (this.points.length >= kMostPoints) return -1;
    const at = this.points.findIndex(([x]) => x > point[0]);
    const place = at < 0 ? this.points.length : at;
    this.change([...this.points.slice(0, place), point, ...this.points.slice(place)]);
    return place;
  }

  move(event) {
    if (this.dragged === undefined) return;
    this.set(this.dragged, this.place(event));
  }

  set(i, [x, y]) {
    const low = i > 0 ? this.points[i - 1][0] : 0;
    const high = i < this.points.length - 1 ? this.points[i + 1][0] : 1;
    this.change(this.points.map((point, at) => at === i ? [clamp(x, low, high), clamp(y, 0, 1)] : point));
  }

  release() {
    if (this.dragged === undefined) return;
    this.dragged = undefined;
    this.done();
  }

  remove(i) {
    if (!(i >= 0) || this.points.length <= 2) return;
    this.dragged = undefined;
    this.change(this.points.filter((_, at) => at !== i));
    this.done();
    this.handles.children[Math.min(i, this.points.length - 1)]?.focus();
  }

  /** Removes a double-clicked point. The event's target may be the field, which captures the pointer, so the targets
   *  of the presses count. A point that the first press made stays. */
  remove_pressed() {
    const [first, second] = this.pressed;
    if (first === second) this.remove(Number(second?.dataset.point ?? -1));
  }

  key(event) {
    const i = Number(event.target.dataset?.point ?? -1);
    if (i < 0) return;
    const step = event.shiftKey ? kKeyStep / 4 : kKeyStep;
    const along = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    if (along) {
      const [x, y] = this.points[i];
      this.set(i, [x + along[0] * step, y + along[1] * step]);
      this.done();
    } else if (event.key === "Delete" || event.key === "Backspace") {
      this.remove(i);
    } else if (event.key === "Insert" || event.key === "Enter") {
      const next = this.points[i + 1] ?? this.points[i - 1];
      const at = this.insert(this.points[i].map((value, axis) => (value + next[axis]) / 2));
      this.done();
      this.handles.children[at]?.focus();
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }

  change(points) {
    this.changed(points.map(([x, y]) => [Number(x.toFixed(4)), Number(y.toFixed(4))]));
  }
}
