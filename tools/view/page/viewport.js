// The picture area: draws the pictures as they arrive, those of two files side by side with a movable divider.
// Handles mouse, touch and keys.

const kTurn = 0.35;        // degrees per pixel
const kKeyTurn = 5;        // degrees per key press
const kKeyPan = 0.05;      // share of the height
const kWheel = 0.0015;
const kKeyZoom = 1.15;

export class Viewport {
  /** `on` has turn(az, el), pan(x, y) in picture heights, zoom(times), split(share), and point(at, none): `at` is
   *  {x, y} in [0, 1] or null, and `none` is the text if nothing is seen there. */
  constructor(frame, canvas, divider, on) {
    this.frame = frame;
    this.canvas = canvas;
    this.divider = divider;
    this.on = on;
    this.layers = [];
    this.split = null;
    this.pointers = new Map();
    this.listen();
  }

  get width() { return this.frame.clientWidth; }
  get height() { return this.frame.clientHeight; }

  /** Draws a picture. With two layers, its upper half is the file and its lower half the compared file. */
  async draw(header, blob) {
    this.picture = await createImageBitmap(blob);
    this.header = header;
    this.paint();
    this.canvas.dispatchEvent(new CustomEvent("drawn", {detail: header}));
  }

  paint() {
    if (!this.picture) return;
    const {width, height, layers} = this.header;
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    const context = this.canvas.getContext("2d");
    context.drawImage(this.picture, 0, 0, width, height, 0, 0, width, height);
    if (layers === 2 && this.split !== null) {
      const from = Math.round(this.split * width);
      if (from < width) context.drawImage(this.picture, from, height, width - from, height, from, 0, width - from, height);
    }
  }

  set_split(share) {
    this.split = share;
    this.divider.hidden = share === null;
    if (share === null) return;
    this.divider.style.left = `${share * 100}%`;
    this.divider.setAttribute("aria-valuenow", Math.round(share * 100));
    this.paint();
  }

  listen() {
    const {frame, divider} = this;
    frame.addEventListener("pointerdown", (event) => this.press(event));
    frame.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) frame.addEventListener(name, (event) => this.release(event));
    // A lifted finger also causes this event, and the value at its tap must stay.
    frame.addEventListener("pointerleave", (event) => event.pointerType !== "touch" && this.on.point(null));
    frame.addEventListener("contextmenu", (event) => event.preventDefault());
    frame.addEventListener("wheel", (event) => {
      event.preventDefault();
      const pixels = event.deltaMode === 1 ? event.deltaY * 20 : event.deltaY;
      this.on.zoom(Math.exp(-kWheel * pixels));
    }, {passive: false});
    frame.addEventListener("keydown", (event) => this.key(event));
    divider.addEventListener("keydown", (event) => {
      const step = {ArrowLeft: -0.02, ArrowRight: 0.02}[event.key];
      if (!step) return;
      event.preventDefault();
      event.stopPropagation();
      this.on.split(Math.min(1, Math.max(0, this.split + step)));
    });
  }

  place(event) {
    const box = this.frame.getBoundingClientRect();
    return {x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height};
  }

  press(event) {
    if (event.target.closest("button")) return;
    this.frame.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    this.dividing = event.target === this.divider;
    if (!this.dividing) this.frame.focus({preventScroll: true});
    this.on.point(null);
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) {
      if (event.pointerType === "mouse") this.on.point(this.place(event));
      return;
    }
    const now = {x: event.clientX, y: event.clientY};
    const [dx, dy] = [now.x - before.x, now.y - before.y];
    if (this.dividing) {
      this.on.split(Math.min(1, Math.max(0, this.place(event).x)));
    } else if (this.pointers.size >= 2) {
      this.pinch(event.pointerId, now);
    } else if (event.shiftKey || event.buttons === 2 || event.buttons === 4) {
      this.on.pan(dx / this.height, dy / this.height);
    } else {
      this.on.turn(-dx * kTurn, dy * kTurn);
    }
    this.moved = (this.moved ?? 0) + Math.abs(dx) + Math.abs(dy);
    this.pointers.set(event.pointerId, now);
  }

  // Two fingers: their distance zooms, their midpoint pans.
  pinch(id, now) {
    const [key, other] = [...this.pointers].find(([found]) => found !== id) ?? [];
    if (key === undefined) return;
    const before = this.pointers.get(id);
    const apart = (p) => Math.hypot(p.x - other.x, p.y - other.y) || 1;
    this.on.zoom(apart(now) / apart(before));
    this.on.pan((now.x - before.x) / 2 / this.height, (now.y - before.y) / 2 / this.height);
  }

  release(event) {
    // A tap of a finger shows the value at its place, like a resting mouse.
    if (this.pointers.size === 1 && (this.moved ?? 0) < 6 && event.type === "pointerup") this.on.point(this.place(event));
    this.pointers.delete(event.pointerId);
    if (this.pointers.size === 0) {
      this.moved = 0;
      this.dividing = false;
    }
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const along = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    if (along && event.shiftKey) this.on.pan(along[0] * kKeyPan, along[1] * kKeyPan);
    else if (along) this.on.turn(along[0] * kKeyTurn, -along[1] * kKeyTurn);
    else if (event.key === "+" || event.key === "=") this.on.zoom(kKeyZoom);
    else if (event.key === "-") this.on.zoom(1 / kKeyZoom);
    else if (event.key === "Enter") this.on.point({x: 0.5, y: 0.5}, "No value in the middle of the picture.");
    else return;
    event.preventDefault();
  }
}
