// The value under the pointer, or in the middle of the picture for a keyboard: asked of the server, and shown.

import {value_text} from "./certificate.js";
import {by_id, set_text} from "./dom.js";

const kRest_ms = 80;  // of the pointer, before it is asked for

export class Value {
  /** `send(message)` to the server. */
  constructor(send) {
    this.send = send;
    this.asked = {id: 0};  // the newest question: with its step and side
  }

  /** What is under the pointer is another value; an answer that is on its way is of the one before. */
  forget() {
    clearTimeout(this.timer);
    this.asked = {id: this.asked.id + 1};
    set_text(by_id("value"), "");
  }

  /** Of the point (x, y) of the picture of `look`, from 0 to 1; `none` is said where no voxel is seen there. */
  ask({x, y}, look, none = "") {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      const [across, down] = [x, y].map((share) => Math.min(1, Math.max(0, share)));
      const side = look.split !== null && across > look.split ? 1 : 0;
      this.asked = {id: this.asked.id + 1, step: look.step, side, none};
      this.send({type: "probe", id: this.asked.id, x: across, y: down, side});
    }, kRest_ms);
  }

  /** An answer; `facts_of(step, side)` are those of its file. */
  receive(message, facts_of) {
    if (message.id !== this.asked.id) return;
    const facts = facts_of(this.asked.step, this.asked.side);
    if (facts) set_text(by_id("value"), value_text(message, facts) || this.asked.none);
  }
}
