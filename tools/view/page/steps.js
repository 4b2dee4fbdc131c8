// The steps of a series: a slider, and play, which goes on when the picture of a step is there.

import {set_text} from "/page/dom.js";

const kFrame_ms = 100;  // of a step, at least

export class Steps {
  /** `names` of the files; `go(step, moving)`. */
  constructor({root, slider, output, play}, names, go) {
    Object.assign(this, {slider, output, play, names, go});
    this.playing = false;
    root.hidden = names.length < 2;
    slider.max = names.length - 1;
    slider.addEventListener("input", () => go(Number(slider.value), true));
    slider.addEventListener("change", () => go(Number(slider.value), false));
    play.addEventListener("click", () => this.toggle());
  }

  show(step) {
    this.step = step;
    this.slider.value = step;
    const text = `${step + 1} of ${this.names.length}: ${this.names[step]}`;
    set_text(this.output, text);
    this.slider.setAttribute("aria-valuetext", text);
  }

  toggle() {
    if (this.names.length < 2) return;
    this.playing = !this.playing;
    set_text(this.play, this.playing ? "Stop" : "Play");
    this.play.setAttribute("aria-label", this.playing ? "Stop" : "Play the steps");
    if (this.playing) this.next();
    else this.go(this.step, false);
  }

  by(steps) {
    if (this.names.length > 1) this.go((this.step + steps + this.names.length) % this.names.length, false);
  }

  next() {
    this.turned = performance.now();
    this.go((this.step + 1) % this.names.length, true);
  }

  /** The picture of a step is there. */
  drawn(step) {
    if (!this.playing || step !== this.step) return;
    const wait = Math.max(0, kFrame_ms - (performance.now() - this.turned));
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.playing && this.next(), wait);
  }
}
