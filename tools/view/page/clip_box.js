// The box of voxels that is shown, with two sliders for each axis.

import {element, set_text} from "./dom.js";

export class ClipBox {
  /** Calls `changed(box)` during a change (null: the whole volume) and `done()` at its end. */
  constructor(root, {changed, done}) {
    this.changed = changed;
    this.rows = ["x", "y", "z"].map((axis) => {
      const sliders = ["from", "to"].map((end) => {
        const made = element("input");
        made.type = "range";
        made.step = 1;
        made.setAttribute("aria-label", `${axis} ${end}`);
        made.addEventListener("input", () => this.read(axis, end));
        made.addEventListener("change", done);
        return made;
      });
      const text = element("output");
      text.setAttribute("aria-hidden", "true");  // the sliders announce the same values
      root.append(element("div", "axis", element("span", "", axis), ...sliders, text));
      return {sliders, text};
    });
  }

  /** `limits` is [[x0, x1], ...] of the volume; `box` is the same of the shown part, null for all. */
  show(limits, box) {
    this.limits = limits;
    this.rows.forEach(({sliders: [from, to], text}, i) => {
      const [lo, hi] = limits[i];
      const [start, end] = box ? box[i] : limits[i];
      [from.min, from.max, to.min, to.max] = [lo, hi - 1, lo + 1, hi];
      [from.value, to.value] = [start, end];
      set_text(text, `${start} to ${end}`);
    });
  }

  read(axis, moved) {
    const i = "xyz".indexOf(axis);
    const box = this.rows.map(({sliders}) => sliders.map((slider) => Number(slider.value)));
    if (box[i][0] >= box[i][1]) box[i] = moved === "from" ? [box[i][1] - 1, box[i][1]] : [box[i][0], box[i][0] + 1];
    const all = box.every((ends, at) => ends[0] === this.limits[at][0] && ends[1] === this.limits[at][1]);
    this.changed(all ? null : box);
  }
}

/** Returns the box in the syntax of --roi: "0:64,0:64,16:48". */
export const roi_text = (box) => box.map((ends) => ends.join(":")).join(",");
