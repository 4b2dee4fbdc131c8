// All jobs in pages of a table that can be searched, filtered and sorted.

import {get, query} from "./api.js";
import {button, by_id, element, offer, part, set_text, show_items} from "./dom.js";
import * as format from "./format.js";
import {clamped, name_button} from "./names.js";

const kPageLength = 50;
const kTypingPause_ms = 250;
const kColumns = [["source", "Name"], ["state", "State"], ["watch", "Watch"], ["bytes", "Size"], ["seconds", "Time taken"],
                  ["discovered", "Found"], ["changed", "Changed"]];
const kRising = ["source", "state", "watch"];  // sorted from A to Z at first; all other columns begin with the largest

const text_field = by_id("all-text");
const state_choice = by_id("all-state");
const watch_choice = by_id("all-watch");

let sort = "changed";
let order = "desc";
let offset = 0;
let total = 0;
let asked = 0;  // requests so far: an answer that arrives after a later one is not shown
let timer = 0;
let searched = "";  // the service's `state` text at the last search
let open = () => {};

function cell(name, title, ...content) {
  const made = element("td", `of-${name}`, ...content);
  made.dataset.title = title;
  made.setAttribute("role", "cell");
  return made;
}

function make_row(job) {
  const reason = clamped("");
  reason.classList.add("reason", "quiet");
  const cells = kColumns.slice(1).map(([name, title]) => cell(name, title));
  cells[0].append(element("span", "state"));
  const row = element("tr", "", cell("source", "", name_button(job.source, () => open(job.id)), reason), ...cells);
  row.setAttribute("role", "row");
  return row;
}

function show_time(child, time) {
  set_text(child, format.ago(time));
  child.title = format.date(time);
}

function update_row(row, job) {
  const reason = part(row, "reason");
  reason.hidden = !job.reason;
  reason.title = job.reason;
  set_text(reason, format.reason(job));
  set_text(part(row, "state"), format.state(job));
  part(row, "state").className = `state ${job.state}`;
  set_text(part(row, "of-watch"), job.watch);
  set_text(part(row, "of-bytes"), format.bytes(job.source_bytes));
  set_text(part(row, "of-seconds"), job.seconds === null ? "\u2013" : format.seconds(job.seconds));
  part(row, "of-seconds").classList.toggle("unknown", job.seconds === null);
  show_time(part(row, "of-discovered"), job.discovered_at);
  show_time(part(row, "of-changed"), job.changed_at);
}

function show_order() {
  for (const header of by_id("all-headers").children) {
    const mine = header.dataset.sort === sort;
    if (mine) header.setAttribute("aria-sort", order === "asc" ? "ascending" : "descending");
    else header.removeAttribute("aria-sort");
    set_text(part(header, "arrow"), mine ? (order === "asc" ? "\u25b2" : "\u25bc") : "");
  }
}

function show_place(length) {
  const asked_for = text_field.value || state_choice.value || watch_choice.value;
  const nothing = asked_for ? "No job fits." : "There are no jobs yet.";
  const to = offset + length;
  set_text(by_id("all-place"),
           total === 0 ? nothing : `${format.count(offset + 1)} to ${format.count(to)} of ${format.count(total)}`);
  by_id("all-previous").setAttribute("aria-disabled", String(offset === 0));
  by_id("all-next").setAttribute("aria-disabled", String(to >= total));
  by_id("all-previous").hidden = by_id("all-next").hidden = total <= kPageLength;
  by_id("all-table").hidden = total === 0;
}

/** Asks for the chosen page of jobs and shows it. A search is repeated only if `state`, a text, has changed. */
export async function refresh_all_jobs(state = "") {
  if (state && state === searched && text_field.value.trim()) return;
  searched = state;
  const mine = ++asked;
  const wanted = {text: text_field.value.trim() || null, state: state_choice.value || null,
                  watch: watch_choice.value || null, sort, order, limit: kPageLength, offset};
  const page = await get(`/api/jobs?${query(wanted)}`);
  if (mine !== asked) return;
  if (page.jobs.length === 0 && page.total > 0) {  // the page does not exist any more: show the last one
    offset = Math.floor((page.total - 1) / kPageLength) * kPageLength;
    await refresh_all_jobs();
    return;
  }
  total = page.total;
  show_items(by_id("all-rows"), page.jobs, (job) => job.id, make_row, update_row, "");
  show_place(page.jobs.length);
  show_order();
}

function show_anew(from = 0) {
  clearTimeout(timer);
  offset = from;
  refresh_all_jobs().catch(() => {});  // the page's next round reports the error
}

function turn(by) {
  const to = offset + by * kPageLength;
  if (to < 0 || to >= total) return;
  show_anew(to);
  by_id("all-title").scrollIntoView({block: "start"});
}

function sort_by(name) {
  if (name === sort) order = order === "asc" ? "desc" : "asc";
  else order = kRising.includes(name) ? "asc" : "desc";
  sort = name;
  show_order();
  show_anew();
}

function make_header([name, title]) {
  const arrow = element("span", "arrow");
  arrow.setAttribute("aria-hidden", "true");
  const sorter = button(title, "sort", () => sort_by(name));
  sorter.append(arrow);
  const header = element("th", `of-${name}`, sorter);
  header.dataset.sort = name;
  header.scope = "col";
  header.setAttribute("role", "columnheader");
  return header;
}

export function offer_watch_filter(watches) {
  const changed = offer(watch_choice, [["", "all watches"], ...watches.map(({label}) => [label, label])]);
  if (changed) show_anew();
}

/** Sets up the table. `open_job(id)` is called when a name is clicked. */
export function prepare_all_jobs(open_job) {
  open = open_job;
  by_id("all-headers").replaceChildren(...kColumns.map(make_header));
  text_field.addEventListener("input", () => {
    clearTimeout(timer);
    timer = setTimeout(show_anew, kTypingPause_ms);
  });
  state_choice.addEventListener("change", () => show_anew());
  watch_choice.addEventListener("change", () => show_anew());
  by_id("all-previous").addEventListener("click", () => turn(-1));
  by_id("all-next").addEventListener("click", () => turn(1));
}
