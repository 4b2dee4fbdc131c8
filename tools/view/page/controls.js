// Sliders of single numbers: iso value, extinction, light.

import {by_id, set_text} from "./dom.js";
import * as format from "./format.js";
import {kStartDensity, kStartLight, start_iso} from "./look.js";

const kIsoSteps = 1000;

export class Controls {
  /** Calls `changed({key: value})` during a change and `done()` at its end. */
  constructor({changed, done}) {
    this.changed = changed;
    const slider = (id, read) => {
      by_id(id).addEventListener("input", () => changed(read(Number(by_id(id).value))));
      by_id(id).addEventListener("change", done);
    };
    slider("iso", (value) => {
      const [low, high] = this.range;
      return {iso: low + (high - low) * value};
    });
    slider("density", (value) => ({density: Number((10 ** value).toPrecision(3))}));
    slider("shading", (value) => ({shading: value}));
    slider("exposure", (value) => ({exposure: Number((2 ** value).toPrecision(3))}));
    for (const [id, key] of [["light-az", "az"], ["light-el", "el"], ["light-power", "power"], ["light-sky", "sky"]]) {
      slider(id, (value) => ({light: {...this.light, [key]: value}}));
    }
  }

  show(look, facts) {
    this.range = look.range ?? facts.range;
    this.light = look.light ?? kStartLight;
    const set = (id, value, text) => {
      by_id(id).value = value;
      by_id(id).setAttribute("aria-valuetext", text);
      set_text(by_id(`${id}-value`), text);
    };
    const iso = look.iso ?? start_iso(facts);
    const [low, high] = this.range;
    set("iso", Math.round(kIsoSteps * (iso - low) / (high - low || 1)) / kIsoSteps, format.within(iso, high - low));
    const density = look.density ?? kStartDensity[look.mode];
    set("density", Math.log10(Math.max(density, 1)), format.number(density));
    set("shading", look.shading ?? 0.7, (look.shading ?? 0.7).toFixed(2));
    const exposure = look.exposure ?? {dvr: 1.8, path: 1.4, iso: 0.8, mip: 1}[look.mode];
    set("exposure", Math.log2(exposure), format.number(exposure));
    set("light-az", this.light.az, `${Math.round(this.light.az)}\u00b0`);
    set("light-el", this.light.el, `${Math.round(this.light.el)}\u00b0`);
    set("light-power", this.light.power, this.light.power.toFixed(1));
    set("light-sky", this.light.sky, this.light.sky.toFixed(2));
  }
}
