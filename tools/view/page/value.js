// The value under the pointer, or in the middle of the picture for keyboard users: asks the server and shows the
// answer.

import {value_text} from "./certificate.js";
import {by_id, set_text} from "./dom.js";

const kRest_ms = 80;  // time that the pointer must rest before a request

export class Value {
  /** `send(message)` sends to the server. */
  constructor(send) {
    this.send = send;
    this.asked = {id: 0};  // the newest question, with its step and side
  }

  /** Clears the value, because another one may be under the pointer. An answer on its way is outdated. */
  forget() {
    clearTimeout(this.timer);
    this.asked = {id: this.asked.id + 1};
    set_text(by_id("value"), "");
  }

  /** Asks for the value at (x, y), from 0 to 1, in the picture of `look`; shows `none` if no voxel is seen there. */
  ask({x, y}, look, none = "") {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      const [across, down] = [x, y].map((share) => Math.min(1, Math.max(0, share)));
      const side = look.split !== null && across > look.split ? 1 : 0;
      this.asked = {id: this.asked.id + 1, step: look.step, side, none};
      this.send({type: "probe", id: this.asked.id, x: across, y: down, side});
    }, kRest_ms);
  }

  /** Shows an answer. `facts_of(step, side)` returns the facts of its file. */
  receive(message, facts_of) {
    if (message.id !== this.asked.id) return;
    const facts = facts_of(this.asked.step, this.asked.side);
    if (facts) set_text(by_id("value"), value_text(message, facts) || this.asked.none);
  }
}
