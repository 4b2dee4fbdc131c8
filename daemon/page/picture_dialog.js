// One picture in full size, with its figures. Arrow keys go to the next or the previous one.

import {thumbnail} from "./api.js";
import {path_with_copy, show_path} from "./copy.js";
import {by_id, element, set_text} from "./dom.js";
import * as format from "./format.js";
import {open_viewer} from "./viewer.js";

const dialog = by_id("picture");
const result_path = path_with_copy("", "result");
const source_path = path_with_copy("", "source");

let entries = [];  // {job, output, index}, all with a picture
let place = 0;
let on_show = () => {};

async function show_image({job, output, index}) {
  const mine = entries[place];
  let image;
  try {
    image = await thumbnail(job, index, `Rendering of ${format.base_name(output.path)}`);
  } catch {
    image = "no picture";
  }
  if (entries[place] === mine) by_id("picture-frame").replaceChildren(image);
}

function show() {
  const entry = entries[place];
  const {job, output} = entry;
  set_text(by_id("picture-title"), format.base_name(output.path));
  set_text(by_id("picture-place"), `${place + 1} of ${entries.length}`);
  by_id("picture-facts").replaceChildren(
      ...format.output_facts(output).map((fact) => element("span", "", fact)),
      element("span", "quiet", format.date(job.changed_at)));
  show_path(result_path, output.path);
  show_path(source_path, job.source);
  show_image(entry);
  on_show(entry);
}

function go_to(to) {
  place = (to + entries.length) % entries.length;
  show();
}

function go_by_key(event) {
  if (event.altKey || event.ctrlKey || event.metaKey || event.shiftKey) return;
  const steps = {ArrowLeft: place - 1, ArrowRight: place + 1, Home: 0, End: entries.length - 1};
  if (!(event.key in steps)) return;
  event.preventDefault();
  go_to(steps[event.key]);
}

/** Opens the picture of all[start]. Keys and buttons go to the others; `shown(entry)` is called for each one shown. */
export function open_pictures(all, start, shown = () => {}) {
  const first = all[start];
  entries = all.filter(({output}) => output.thumbnail);
  place = entries.indexOf(first);
  if (place < 0) return;
  on_show = shown;
  by_id("picture-previous").hidden = by_id("picture-next").hidden = entries.length < 2;
  by_id("picture-frame").replaceChildren();
  show();
  dialog.showModal();
}

by_id("picture-paths").append(element("dt", "", "Result"), element("dd", "", result_path),
                              element("dt", "", "Source"), element("dd", "", source_path));
dialog.addEventListener("keydown", go_by_key);
by_id("picture-previous").addEventListener("click", () => go_to(place - 1));
by_id("picture-next").addEventListener("click", () => go_to(place + 1));
by_id("picture-view").addEventListener("click", () => {
  const {job, output, index} = entries[place];
  dialog.close();
  open_viewer(job.id, index, output.path);
});
by_id("picture-close").addEventListener("click", () => dialog.close());
