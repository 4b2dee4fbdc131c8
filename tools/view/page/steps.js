// The steps of a series: a slider and playback, which goes on when the picture of a step has arrived. A step has a
// number that never changes. Its place on the slider changes when other steps come before it.

import {by_id, set_text} from "./dom.js";

const kFrame_ms = 100;  // least time per step

export class Steps {
  /** `go(step, moving)` is called to show a step. */
  constructor(go) {
    Object.assign(this, {slider: by_id("step"), play: by_id("play"), follow: by_id("follow"), go});
    this.names = [];
    this.order = [];
    this.step = 0;
    this.playing = false;
    this.fresh = 0;  // number of steps that came since the last step of the series was shown
    const chosen = (moving) => {
      this.follow.checked = false;
      go(this.order[Number(this.slider.value)], moving);
    };
    this.slider.addEventListener("input", () => chosen(true));
    this.slider.addEventListener("change", () => chosen(false));
    this.play.addEventListener("click", () => this.toggle());
    this.follow.addEventListener("change", () => this.follow.checked && this.go_to_last());
  }

  /** Sets the steps: `steps` are names by number, `order` the numbers in order. With only one step, playback ends. */
  set({steps, order, grows}) {
    const known = this.names.length;
    const more = known > 0 ? order.filter((step) => step >= known).length : 0;
    const at_last = this.place() === this.order.length - 1;
    Object.assign(this, {names: steps, order});
    if (grows !== undefined) by_id("follow-field").hidden = !grows;
    by_id("steps").hidden = order.length < 2;
    this.slider.max = Math.max(order.length - 1, 0);
    this.fresh += more;
    this.show(this.step);
    if (more > 0 && this.follow.checked && at_last && !this.playing) this.go_to_last();
    if (!this.playing || order.length > 1) return;
    this.set_playing(false);
    if (order.length === 1) this.go(order[0], false);
  }

  /** Returns the number of the step with this name; undefined if there is none. */
  number(name) {
    return this.order.find((step) => this.names[step] === name);
  }

  place() {
    return this.order.indexOf(this.step);
  }

  show(step) {
    this.step = step;
    const place = this.place();
    if (place >= 0) this.slider.value = place;
    if (place === this.order.length - 1) this.fresh = 0;
    const where = place < 0 ? "no longer there" : `${place + 1} of ${this.order.length}`;
    const text = `${where}: ${this.names[step] ?? ""}`;
    set_text(by_id("step-name"), text);
    this.slider.setAttribute("aria-valuetext", text);
    const news = {0: "", 1: "new step"}[this.fresh] ?? `${this.fresh} new steps`;
    set_text(by_id("step-news"), news);
  }

  go_to_last() {
    const last = this.order.at(-1);
    if (last !== undefined && last !== this.step) this.go(last, false);
  }

  toggle() {
    if (this.order.length < 2) return;
    this.set_playing(!this.playing);
    if (this.playing) this.next();
    else this.go(this.step, false);
  }

  set_playing(playing) {
    this.playing = playing;
    set_text(this.play, playing ? "Stop" : "Play");
    this.play.setAttribute("aria-label", playing ? "Stop" : "Play the steps");
  }

  /** Returns the step `by` places further, in a circle; from a step that is gone, the first or the last one. */
  neighbour(by) {
    const place = by < 0 ? Math.max(this.place(), 0) : this.place();
    return this.order[(place + by + this.order.length) % this.order.length];
  }

  by(steps) {
    if (this.order.length < 2) return;
    this.follow.checked = false;
    this.go(this.neighbour(steps), false);
  }

  next() {
    this.turned = performance.now();
    this.go(this.neighbour(1), true);
  }

  /** Must be called when the picture of a step has arrived. */
  drawn(step) {
    if (!this.playing || step !== this.step) return;
    const wait = Math.max(0, kFrame_ms - (performance.now() - this.turned));
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.playing && this.next(), wait);
  }
}
