// "Convert for this scene": the command, and its run where the server allows it.

import {by_id, set_text} from "./dom.js";
import * as format from "./format.js";

export class Conversion {
  /** `scene()` as text, or null; `send(message)` to the server. */
  constructor({scene, send}) {
    this.scene = scene;
    this.send = send;
    this.id = 0;
    by_id("show-command").addEventListener("click", () => this.ask(false));
    by_id("run-convert").addEventListener("click", () => this.ask(true));
    by_id("convert-panel").addEventListener("toggle", (event) => event.target.open && this.ask(false));
    for (const id of ["rate", "encoding"]) by_id(id).addEventListener("change", () => this.ask(false));
  }

  set_up(allowed) {
    by_id("run-convert").hidden = !allowed;
    this.allowed = allowed;
  }

  ask(run) {
    const scene = this.scene();
    const rate = Number(by_id("rate").value);
    if (!scene || !(rate >= 1)) {
      set_text(by_id("convert-note"), "The rate is a number from 1 on.");
      return;
    }
    this.send({type: "convert", id: ++this.id, scene, rate, encoding: by_id("encoding").value, run});
  }

  receive({command, bytes, state, message}) {
    set_text(by_id("convert-command"), command);
    set_text(by_id("convert-size"), `At most ${format.bytes(bytes)}; the error of a scene is known when it is made.`);
    by_id("run-convert").disabled = state === "running";
    const note = {
      shown: this.allowed ? "" : "Save the scene beside it; or start weir view with --allow-convert to run it here.",
      running: "running",
      done: `done: ${message}`,
      failed: message,
    }[state];
    by_id("convert-note").className = state === "failed" ? "bad" : "quiet";
    set_text(by_id("convert-note"), note);
  }
}
