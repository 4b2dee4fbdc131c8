// The latest results: a card for each output, with its picture.

import {thumbnail} from "./api.js";
import {button, by_id, element, part, set_text, show_items} from "./dom.js";
import * as format from "./format.js";
import {card_name_button} from "./names.js";
import {open_pictures} from "./picture_dialog.js";
import {view_button} from "./viewer.js";

const kEmptyResults = "Nothing has been converted yet. What is finished shows up here.";

const key_of = ({job, index}) => `${job.id}/${index}/${job.changed_at}`;
let shown = [];  // {job, output, index}

function enlarge(key) {
  open_pictures(shown, shown.findIndex((result) => key_of(result) === key));
}

/** Puts the output's picture into `frame`, or says that there is none. */
async function fill_picture(frame, {job, output, index}) {
  try {
    if (!output.thumbnail) throw new Error("not rendered");
    frame.replaceChildren(await thumbnail(job, index, `Rendering of ${format.base_name(output.path)}`));
  } catch {
    frame.replaceChildren("no picture");
    frame.disabled = true;
  }
}

function make_card(result, open) {
  const {job, output} = result;
  const frame = button("", "picture", () => enlarge(key_of(result)));
  frame.title = "Enlarge";
  fill_picture(frame, result);
  return element("li", "card", frame,
                 element("div", "text", card_name_button(output.path, () => open(job.id)),
                         element("span", "fact", `${format.bytes(output.bytes)}, ${format.rate(output)}`),
                         element("span", "quality"), element("span", "when quiet"), view_button(() => result)));
}

function update_card(child, {job, output}) {
  set_text(part(child, "quality"), output.psnr_db === null ? format.quality(output) : `PSNR ${format.quality(output)}`);
  set_text(part(child, "when"), format.ago(job.changed_at));
}

export function show_results(page, open, limit) {
  shown = page.jobs.flatMap((job) => job.outputs.map((output, index) => ({job, output, index}))).slice(0, limit);
  show_items(by_id("results"), shown, key_of, (result) => make_card(result, open), update_card, kEmptyResults);
}
