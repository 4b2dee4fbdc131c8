// The plain lists of jobs: running, waiting, and not taken yet.

import {by_id, element, part, set_text, show_items} from "./dom.js";
import * as format from "./format.js";
import {clamped, name_button} from "./names.js";

const kEmptyRunning = "Nothing is being converted.";
const kEmptyQueue = "The queue is empty.";

export function show_running(jobs, open) {
  const make = (job) => {
    const bar = element("progress");
    bar.max = 1;
    return element("li", "", name_button(job.source, () => open(job.id)), element("span", "step quiet"), bar,
                   element("span", "fact quiet"), element("span", "reason bad"));
  };
  const update = (child, job) => {
    set_text(part(child, "step"), job.step);
    part(child, "reason").hidden = !job.stall;
    set_text(part(child, "reason"), job.stall);
    const bar = child.querySelector("progress");
    bar.setAttribute("aria-label", `${job.step} of ${format.base_name(job.source)}`);
    if (job.fraction === null) bar.removeAttribute("value");
    else bar.value = job.fraction;
    const share = job.fraction === null ? "" : `${Math.floor(100 * job.fraction)} %, `;
    set_text(part(child, "fact"), `${share}${format.seconds(job.seconds)}, source ${format.bytes(job.source_bytes)}`);
  };
  show_items(by_id("running"), jobs, (job) => job.id, make, update, kEmptyRunning);
}

function make_waiting(job, open) {
  const reason = clamped("");
  reason.classList.add("reason", "quiet");
  return element("li", "", name_button(job.source, () => open(job.id)), element("span", "fact quiet"), reason);
}

function update_waiting(child, job, facts) {
  const reason = part(child, "reason");
  reason.hidden = !job.reason;
  reason.title = job.reason;
  set_text(reason, format.reason(job));
  set_text(part(child, "fact"), facts.join(", "));
}

function show_more(id, page) {
  const more = page.total - page.jobs.length;
  set_text(by_id(id), more > 0 ? `and ${format.count(more)} more` : "");
}

export function show_queue(page, open) {
  const update = (child, job) => {
    const facts = [format.bytes(job.source_bytes)];
    if (job.next_attempt_at !== null) {
      const wait = job.next_attempt_at - Date.now() / 1000;
      facts.push(`attempt ${job.attempts + 1} ${wait > 0 ? `in ${format.seconds(Math.ceil(wait))}` : "is due"}`);
    }
    update_waiting(child, job, facts);
  };
  show_items(by_id("queue"), page.jobs, (job) => job.id, (job) => make_waiting(job, open), update, kEmptyQueue);
  show_more("queue-more", page);
}

/** Shows the files that were found but do not seem to be complete yet. */
export function show_not_taken(page, open) {
  by_id("not-taken-section").hidden = page.total === 0;
  const update = (child, job) =>
      update_waiting(child, job, [format.bytes(job.source_bytes), `found ${format.ago(job.discovered_at)}`]);
  show_items(by_id("not-taken"), page.jobs, (job) => job.id, (job) => make_waiting(job, open), update, "");
  show_more("not-taken-more", page);
}
