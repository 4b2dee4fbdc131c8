// "Convert for this scene": the command, what it would come to, and its run where the server allows it.

import {by_id, set_text} from "./dom.js";
import * as format from "./format.js";
import {show_command} from "./panels.js";

const kRest_ms = 600;  // of the look, before it is asked for again

const decibels = (value) => `${value.toFixed(1)} dB`;
const expected = ({value, low, high}, text) => low === null ? text(value) : `${text(value)} (${text(low)} to ${text(high)})`;

/**
 * "8.0 MiB, PSNR of what is shown 45.2 dB, of all voxels 33.0 dB, largest error 0.365, in about 1.2 s.", of a forecast of
 * the server.
 */
function forecast_text({exact, share, none, bytes, lossless, psnr_db, visible, max_abs, total_s}) {
  const about = exact ? "" : "about ";
  const parts = [];
  if (bytes) parts.push(`${bytes.exact ? "" : about}${expected(bytes, format.bytes)}`);
  if (lossless) parts.push("no error");
  else if (visible?.lossless) parts.push("no error in what is shown");
  else if (visible?.psnr_db) parts.push(`PSNR of what is shown ${about}${expected(visible.psnr_db, decibels)}`);
  if (!lossless && psnr_db) parts.push(`${visible?.psnr_db ? "" : "PSNR "}of all voxels ${about}${expected(psnr_db, decibels)}`);
  if (!lossless && max_abs !== null) parts.push(`largest error ${format.number(max_abs)}`);
  if (total_s !== null) parts.push(`in about ${format.seconds(total_s)}`);
  const text = parts.join(", ");
  if (none) return `${text ? `${text}; ` : ""}nothing was tried: ${none}.`;
  if (exact) return `${text}.`;
  const nothing = visible || lossless ? "" : " The scene shows nothing of it.";
  return `${text}: estimated by a sample of ${Number((100 * share).toPrecision(2))} % of the voxels.${nothing}`;
}

export class Conversion {
  /** `scene()` as text, or null; `kept()`: what of the look decides what is kept, as text; `send(message)` to the server. */
  constructor({scene, kept, send}) {
    Object.assign(this, {scene, kept, send});
    this.id = 0;
    by_id("show-command").addEventListener("click", () => this.ask(false));
    by_id("run-convert").addEventListener("click", () => this.ask(true));
    by_id("convert-panel").addEventListener("toggle", (event) => event.target.open && this.ask(false));
    for (const id of ["budget", "rate", "psnr", "encoding"]) by_id(id).addEventListener("change", () => this.ask(false));
  }

  set_up(allowed) {
    by_id("run-convert").hidden = !allowed;
    this.allowed = allowed;
  }

  /** The look is another: so may be what is kept. */
  changed() {
    if (!by_id("convert-panel").open || this.kept() === this.asked) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.ask(false), kRest_ms);
  }

  ask(run) {
    clearTimeout(this.timer);
    const budget = by_id("budget").value;
    for (const each of ["rate", "psnr"]) by_id(`${each}-field`).hidden = each !== budget;
    const scene = this.scene();
    const amount = Number(by_id(budget).value);
    if (!scene || !(amount >= 1)) {
      set_text(by_id("convert-note"), `The ${budget === "rate" ? "rate" : "PSNR"} is a number from 1 on.`);
      return;
    }
    this.asked = this.kept();
    if (!run) set_text(by_id("convert-forecast"), "Being tried out \u2026");
    this.send({type: "convert", id: ++this.id, scene, [budget]: amount, encoding: by_id("encoding").value, run});
  }

  /** Without a command where there is none, for want of the source: then nothing is tried out, either. */
  receive({command, bytes, state, message}) {
    show_command(by_id("convert-command"), command ?? "");
    const size = bytes === null ? "As few bytes as keep what the scene shows at that PSNR."
                                : `${format.count(bytes)} bytes, whatever the scene.`;
    set_text(by_id("convert-size"), command === null ? "" : size);
    if (command === null) set_text(by_id("convert-forecast"), "");
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

  /** An answer to an earlier question is of no use. */
  receive_forecast(message) {
    if (message.id !== this.id) return;
    set_text(by_id("convert-forecast"), message.state === "done" ? `Expected: ${forecast_text(message)}`
                                                                 : `No forecast: ${message.message}.`);
  }
}
