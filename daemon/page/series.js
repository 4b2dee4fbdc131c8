// The time slider: every rendered output of one watch, in the order of the
// sources' names, numbers by value.

import {get, query, thumbnail} from "./api.js";
import {by_id, element, set_text} from "./dom.js";
import * as format from "./format.js";

const kPageLength = 200;
const kLongest = 5000;  // jobs; of more, the latest
const kFrame_ms = 200;

const order = new Intl.Collator("en", {numeric: true});
const slider = by_id("series-slider");
const play_button = by_id("series-play");
const watch_choice = by_id("series-watch");

let jobs = new Map();  // of the chosen watch, by id
let frames = [];       // {job, output, index}
let shown = "";        // key of the frame in the picture
let player = 0;        // timer of the one that plays
let loading = null;    // the load in progress

const key_of = ({job, index}) => `${job.id}/${index}/${job.changed_at}`;

// The latest jobs come first, so reading stops at a page with nothing new in it.
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

function order_frames() {
  const sorted = [...jobs.values()].sort((a, b) => order.compare(a.source, b.source));
  frames = sorted.flatMap((job) => job.outputs.map((output, index) => ({job, output, index})))
               .filter((frame) => frame.output.thumbnail);
}

async function show_frame() {
  const place = Number(slider.value);
  const frame = frames[place];
  if (!frame) return;
  const name = format.base_name(frame.output.path);
  slider.setAttribute("aria-valuetext", `${place + 1} of ${frames.length}: ${name}`);
  set_text(by_id("series-place"), `${place + 1} of ${frames.length}`);
  by_id("series-caption").replaceChildren(
      element("strong", "path", name), element("span", "", format.bytes(frame.output.bytes)),
      element("span", "", format.rate(frame.output)), element("span", "", format.quality(frame.output)),
      element("span", "quiet", format.date(frame.job.changed_at)));
  const key = key_of(frame);
  if (key === shown) return;
  shown = key;
  let picture;
  try {
    picture = await thumbnail(frame.job, frame.index, `Rendering of ${name}`);
  } catch {
    picture = "no picture";
  }
  if (shown !== key) return;  // another one was asked for meanwhile
  by_id("series-picture").replaceChildren(picture);
  const next = frames[(place + 1) % frames.length];
  thumbnail(next.job, next.index, "").catch(() => {});  // so that playing need not wait for it
}

function show_frames() {
  const at_end = slider.value === slider.max;
  const current = frames.findIndex((frame) => key_of(frame) === shown);
  by_id("series").hidden = frames.length === 0;
  by_id("series-empty").hidden = frames.length > 0;
  slider.max = String(Math.max(frames.length - 1, 0));
  // Whoever looks at the newest step goes on to the next one.
  if (at_end && !player) slider.value = slider.max;
  else if (current >= 0) slider.value = String(current);
  if (frames.length < 2) stop();
  play_button.disabled = frames.length < 2;
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
  const labels = watches.map((watch) => watch.label);
  const offered = [...watch_choice.options].map((option) => option.value);
  if (labels.join("\n") === offered.join("\n")) return;
  watch_choice.hidden = by_id("series-label").hidden = labels.length < 2;
  const chosen = watch_choice.value;
  watch_choice.replaceChildren(...labels.map((label) => new Option(label, label)));
  if (labels.includes(chosen)) watch_choice.value = chosen;
  if (watch_choice.value !== chosen) jobs = new Map();
}

slider.addEventListener("input", show_frame);
play_button.addEventListener("click", () => (player ? stop() : play()));
watch_choice.addEventListener("change", () => {
  stop();
  jobs = new Map();
  frames = [];
  shown = "";
  slider.value = slider.max;
  refresh_series().catch(() => {});  // the page's own round says what is wrong
});
