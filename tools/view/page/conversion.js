// "Convert for this scene": shows the command and the forecast of its result, and runs it if the server allows this.

import {by_id, set_text} from "./dom.js";
import * as format from "./format.js";
import {show_command} from "./panels.js";

const kRest_ms = 600;  // time without a change of the look before a new request

const decibels = (value) => `${value.toFixed(1)} dB`;
const expected = ({value, low, high}, text) => {
  return low === null || high === null ? text(value) : `${text(value)} (${text(low)} to ${text(high)})`;
};
const is_known = (figure) => figure && figure.value !== null;

/**
 * Returns the text of a forecast: "8.0 MiB, PSNR of what is shown 45.2 dB, of all voxels 33.0 dB, largest error 0.365,
 * in about 1.2 s."
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
   * `scene()` returns the scene as text, or null. `step()` returns its step. `kept()` returns as text all properties of
   * the look and the file that decide which detail a conversion keeps. `send(message)` sends to the server.
   */
  constructor({scene, step, kept, send}) {
    Object.assign(this, {scene, step, kept, send});
    this.id = 0;           // number of the newest message
    this.forecast_id = 0;  // number of the newest message with a forecast
    this.running = null;   // number of the message whose conversion runs; null: none runs
    by_id("show-command").addEventListener("click", () => this.ask(false));
    by_id("run-convert").addEventListener("click", () => this.ask(true));
    by_id("convert-panel").addEventListener("toggle", (event) => event.target.open && this.ask(false));
    for (const id of ["budget", "rate", "psnr", "encoding"]) by_id(id).addEventListener("change", () => this.ask(false));
  }

  /** Starts with a new server, which knows nothing of earlier requests. */
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

  /** Must be called when the look or the file has changed: asks again if this changes the kept detail. */
  changed() {
    if (!by_id("convert-panel").open || this.kept() === this.asked) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.ask(false), kRest_ms);
  }

  /** Asks for the command and a forecast or, if `run`, for a run, which leaves the shown forecast alone. */
  ask(run) {
    const budget = by_id("budget").value;
    for (const each of ["rate", "psnr"]) by_id(`${each}-field`).hidden = each !== budget;
    const scene = this.scene();
    if (!scene) return;  // the page asks again when the file's facts arrive
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

  /** Shows why nothing is asked, and discards the answers to earlier questions. */
  refuse(why) {
    clearTimeout(this.timer);
    ++this.id;
    this.forecast_id = this.id;
    this.show(null, null);
    this.note("failed", why);
  }

  /** Shows the command. Without the source there is no command (null), and no forecast either. */
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

  /** Shows the command of the newest question. The note belongs to the run while there is one. */
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

  /** Shows the forecast. An answer to an earlier question is ignored. */
  receive_forecast(message) {
    if (message.id !== this.forecast_id) return;
    set_text(by_id("convert-forecast"), message.state === "done" ? `Expected: ${forecast_text(message)}`
                                                                 : `No forecast: ${message.message}.`);
  }
}
