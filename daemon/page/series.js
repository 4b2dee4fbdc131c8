// The time slider over all outputs of one watch, sorted by the sources' names with numbers in numeric order. Shows
// the picture of the chosen output, and plots of the figures of all.

import {get, query, thumbnail} from "./api.js";
import {by_id, element, offer, set_text} from "./dom.js";
import * as format from "./format.js";
import {open_pictures} from "./picture_dialog.js";
import {mark_step, prepare_plots, show_plots} from "./plots.js";
import {open_viewer} from "./viewer.js";

const kPageLength = 200;
const kLongest = 5000;  // jobs; if there are more, the latest ones
const kFrame_ms = 200;
const kLetters = 90;  // letters of a name; fit on two lines of the caption

const order = new Intl.Collator("en", {numeric: true});
const slider = by_id("series-slider");
const play_button = by_id("series-play");
const watch_choice = by_id("series-watch");
const field_choice = by_id("series-field");
const picture = by_id("series-picture");

let jobs = new Map();  // of the chosen watch, by id
let frames = [];       // {job, output, index}
let shown = "";        // key of the frame in the picture
let player = 0;        // interval timer of the playback
let loading = null;    // the load in progress

const key_of = ({job, index}) => `${job.id}/${index}/${job.changed_at}`;

// The latest jobs come first, so reading stops at a page without new jobs.
async function load_new(watch, into) {
  for (let offset = 0; offset < kLongest; offset += kPageLength) {
    const page = await get(`/api/jobs?${query({state: "done", watch, limit: kPageLength, offset})}`);
    let news = 0;
    for (const job of page.jobs) {
      if (into.get(job.id)?.changed_at !== job.changed_at) ++news;
      into.set(job.id, job);
    }
    if (news === 0 || offset + page.jobs.length >= page.total) return;
  }
}

/** Returns the name that all steps of a field share: the output's name without its numbers. */
const field_of = (output) => format.base_name(output.path).replaceAll(/\d+/g, "\u2026");

/** Returns the fields of the jobs' outputs if a source has several fields, otherwise none. */
function fields_of(all) {
  const mixed = [...jobs.values()].some(({outputs}) => new Set(outputs.map(field_of)).size > 1);
  return mixed ? [...new Set(all.map(({output}) => field_of(output)))] : [];
}

function order_frames() {
  const sorted = [...jobs.values()].sort((a, b) => order.compare(a.source, b.source));
  const all = sorted.flatMap((job) => job.outputs.map((output, index) => ({job, output, index})));
  const fields = fields_of(all);
  offer(field_choice, fields.map((field) => [field, field]));
  field_choice.hidden = by_id("series-field-label").hidden = fields.length === 0;
  frames = fields.length === 0 ? all : all.filter(({output}) => field_of(output) === field_choice.value);
}

function show_caption({job, output}) {
  const name = element("strong", "", format.middle(format.base_name(output.path), kLetters));
  name.title = output.path;
  by_id("series-caption").replaceChildren(name, ...format.output_facts(output).map((fact) => element("span", "", fact)),
                                          element("span", "quiet", format.date(job.changed_at)));
}

async function picture_of({job, output, index}) {
  if (!output.thumbnail) return "no picture";
  try {
    return await thumbnail(job, index, `Rendering of ${format.base_name(output.path)}`);
  } catch {
    return "no picture";
  }
}

async function show_frame() {
  const place = Number(slider.value);
  const frame = frames[place];
  if (!frame) return;
  const name = format.base_name(frame.output.path);
  slider.setAttribute("aria-valuetext", `${place + 1} of ${frames.length}: ${name}`);
  set_text(by_id("series-place"), `${place + 1} of ${frames.length}`);
  show_caption(frame);
  mark_step(place);
  const key = key_of(frame);
  if (key === shown) return;
  shown = key;
  const image = await picture_of(frame);
  if (shown !== key) return;  // another frame was requested meanwhile
  picture.replaceChildren(image);
  picture.disabled = !frame.output.thumbnail;
  picture_of(frames[(place + 1) % frames.length]);  // loads the next picture early, for the playback
}

function go_to(place) {
  stop();
  slider.value = String(place);
  show_frame();
}

function enlarge() {
  stop();
  const follow = (entry) => {
    const place = frames.findIndex((frame) => key_of(frame) === key_of(entry));
    if (place >= 0) go_to(place);
  };
  open_pictures(frames, Number(slider.value), follow);
}

function show_frames() {
  const at_end = slider.value === slider.max;
  const current = frames.findIndex((frame) => key_of(frame) === shown);
  by_id("series").hidden = frames.length === 0;
  by_id("series-empty").hidden = frames.length > 0;
  slider.max = String(Math.max(frames.length - 1, 0));
  // A reader who looks at the newest step moves on to each new one.
  if (at_end && !player) slider.value = slider.max;
  else if (current >= 0) slider.value = String(current);
  if (frames.length < 2) stop();
  play_button.disabled = frames.length < 2;
  picture.hidden = !frames.some(({output}) => output.thumbnail);
  show_plots(frames.map(({output}) => output));
  show_frame();
}

function stop() {
  clearInterval(player);
  player = 0;
  set_text(play_button, "Play");
  play_button.setAttribute("aria-pressed", "false");
}

function play() {
  player = setInterval(() => {
    slider.value = String((Number(slider.value) + 1) % frames.length);
    show_frame();
  }, kFrame_ms);
  set_text(play_button, "Stop");
  play_button.setAttribute("aria-pressed", "true");
}

/** Brings the series of the chosen watch up to date. */
export async function refresh_series() {
  const watch = watch_choice.value;
  if (!watch || loading) return loading;
  const known = jobs;
  loading = load_new(watch, known);
  try {
    await loading;
  } finally {
    loading = null;
  }
  if (known !== jobs) return refresh_series();  // another watch was chosen meanwhile
  order_frames();
  show_frames();
}

/** Offers the watches; keeps the choice. */
export function offer_watches(watches) {
  watch_choice.hidden = by_id("series-label").hidden = watches.length < 2;
  if (offer(watch_choice, watches.map(({label}) => [label, label]))) jobs = new Map();
}

prepare_plots(go_to);
picture.addEventListener("click", enlarge);
slider.addEventListener("input", show_frame);
by_id("series-view").addEventListener("click", () => {
  const frame = frames[Number(slider.value)];
  if (frame) open_viewer(frame.job.id, frame.index, frame.output.path);
});
play_button.addEventListener("click", () => (player ? stop() : play()));
field_choice.addEventListener("change", () => {
  stop();
  order_frames();
  show_frames();
});
watch_choice.addEventListener("change", () => {
  stop();
  jobs = new Map();
  frames = [];
  shown = "";
  slider.value = slider.max;
  refresh_series().catch(() => {});  // the page's next round reports the error
});
