// "Convert for this scene": the command, what it would come to, and its run where the server allows it.

import {by_id, set_text} from "./dom.js";
import * as format from "./format.js";
import {show_command} from "./panels.js";

const kRest_ms = 600;  // of the look, before it is asked for again

const decibels = (value) => `${value.toFixed(1)} dB`;
const expected = ({value, low, high}, text) => {
  return low === null || high === null ? text(value) : `${text(value)} (${text(low)} to ${text(high)})`;
};
const is_known = (figure) => figure && figure.value !== null;

/**
 * "8.0 MiB, PSNR of what is shown 45.2 dB, of all voxels 33.0 dB, largest error 0.365, in about 1.2 s.", of a forecast of
 * the server.
 */
function forecast_text({exact, share, none, bytes, lossless, psnr_db, visible, max_abs, total_s}) {
  const about = exact ? "" : "about ";
  const parts = [];
  if (is_known(bytes)) parts.push(`${bytes.exact ? "" : about}${expected(bytes, format.bytes)}`);
  if (lossless) parts.push("no error");
  else if (visible?.lossless) parts.push("no error in what is shown");
  else if (is_known(visible?.psnr_db)) parts.push(`PSNR of what is shown ${about}${expected(visible.psnr_db, decibels)}`);
  if (!lossless && is_known(psnr_db)) parts.push(`${is_known(visible?.psnr_db) ? "" : "PSNR "}of all voxels ${about}${expected(psnr_db, decibels)}`);
  if (!lossless && max_abs !== null) parts.push(`largest error ${format.bound(max_abs)}`);
  if (total_s !== null) parts.push(`in about ${format.seconds(total_s)}`);
  const text = parts.join(", ");
  if (none) return `${text ? `${text}; ` : ""}nothing was tried: ${none}.`;
  if (exact) return `${text}.`;
  const nothing = visible || lossless ? "" : " The scene shows nothing of it.";
  return `${text}: estimated by a sample of ${Number((100 * share).toPrecision(2))} % of the voxels.${nothing}`;
}

export class Conversion {
  /**
   * `scene()` as text, or null; `step()`: that it is of; `kept()`: what of the look and of the file decides what is kept, as
   * text; `send(message)` to the server.
   */
  constructor({scene, step, kept, send}) {
    Object.assign(this, {scene, step, kept, send});
    this.id = 0;           // of the newest message
    this.forecast_id = 0;  // of the newest that has a forecast
    this.running = null;   // id of the one that has the conversion run
    by_id("show-command").addEventListener("click", () => this.ask(false));
    by_id("run-convert").addEventListener("click", () => this.ask(true));
    by_id("convert-panel").addEventListener("toggle", (event) => event.target.open && this.ask(false));
    for (const id of ["budget", "rate", "psnr", "encoding"]) by_id(id).addEventListener("change", () => this.ask(false));
  }

  /** Of a server, which knows nothing of what another one was asked. */
  set_up(allowed) {
    by_id("run-convert").hidden = !allowed;
    this.allowed = allowed;
    this.asked = null;
    this.run_is(null);
  }

  run_is(id) {
    this.running = id;
    by_id("run-convert").disabled = id !== null;
  }

  /** The look or the file is another: so may be what is kept. */
  changed() {
    if (!by_id("convert-panel").open || this.kept() === this.asked) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.ask(false), kRest_ms);
  }

  /** What is asked of a run leaves the forecast alone. */
  ask(run) {
    const budget = by_id("budget").value;
    for (const each of ["rate", "psnr"]) by_id(`${each}-field`).hidden = each !== budget;
    const scene = this.scene();
    if (!scene) return;  // asked again with the file's facts
    const {valueAsNumber: amount, min, max} = by_id(budget);
    if (!(amount >= Number(min) && amount <= Number(max))) {
      this.refuse(`The ${budget === "rate" ? "rate" : "PSNR"} is a number from ${min} to ${max}.`);
      return;
    }
    ++this.id;
    if (run) this.run_is(this.id);
    else {
      clearTimeout(this.timer);
      this.asked = this.kept();
      this.forecast_id = this.id;
      set_text(by_id("convert-forecast"), "Being tried out \u2026");
    }
    this.send({type: "convert", id: this.id, step: this.step(), scene, [budget]: amount, encoding: by_id("encoding").value, run});
  }

  /** Nothing of an earlier question stays. */
  refuse(why) {
    clearTimeout(this.timer);
    ++this.id;
    this.forecast_id = this.id;
    this.show(null, null);
    this.note("failed", why);
  }

  /** Without a command where there is none, for want of the source: then nothing is tried out, either. */
  show(command, bytes) {
    show_command(by_id("convert-command"), command ?? "");
    const size = bytes === null ? "As few bytes as keep what the scene shows at that PSNR."
                                : `${format.count(bytes)} bytes, whatever the scene.`;
    set_text(by_id("convert-size"), command === null ? "" : size);
    if (command === null) set_text(by_id("convert-forecast"), "");
  }

  note(state, text) {
    by_id("convert-note").className = state === "failed" ? "bad" : "quiet";
    set_text(by_id("convert-note"), text);
  }

  /** The command is of the newest question, the note of the run while there is one. */
  receive({id, command, bytes, state, message}) {
    if (id === this.id) this.show(command, bytes);
    if (id === this.running) {
      if (state !== "running") this.run_is(null);
    } else if (id !== this.id || this.running !== null) return;
    this.note(state, {
      shown: this.allowed ? "" : "Save the scene beside it; or start weir view with --allow-convert to run it here.",
      running: "running",
      done: `done: ${message}`,
      failed: message,
    }[state]);
  }

  /** An answer to an earlier question is of no use. */
  receive_forecast(message) {
    if (message.id !== this.forecast_id) return;
    set_text(by_id("convert-forecast"), message.state === "done" ? `Expected: ${forecast_text(message)}`
                                                                 : `No forecast: ${message.message}.`);
  }
}
