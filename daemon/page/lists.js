// The page's lists: running, problems, queue, results, watches.

import {thumbnail} from "./api.js";
import {button, by_id, element, set_text, show_items} from "./dom.js";
import * as format from "./format.js";

const kEmptyRunning = "Nothing is being converted.";
const kEmptyQueue = "The queue is empty.";
const kEmptyResults = "Nothing has been converted yet. What is finished shows up here.";
const kEmptyWatches = "No directory is watched.";

const part = (child, classes) => child.querySelector(`.${classes}`);

function name_button(job, open) {
  const made = button(format.base_name(job.source), "name", () => open(job.id));
  made.title = job.source;
  return made;
}

export function show_running(jobs, open) {
  const make = (job) => {
    const bar = element("progress");
    bar.max = 1;
    return element("li", "", name_button(job, open), element("span", "step quiet"), bar,
                   element("span", "fact quiet"));
  };
  const update = (child, job) => {
    set_text(part(child, "step"), job.step);
    const bar = child.querySelector("progress");
    bar.setAttribute("aria-label", `${job.step} of ${format.base_name(job.source)}`);
    if (job.fraction === null) bar.removeAttribute("value");
    else bar.value = job.fraction;
    const share = job.fraction === null ? "" : `${Math.floor(100 * job.fraction)} %, `;
    set_text(part(child, "fact"), `${share}${format.seconds(job.seconds)}, source ${format.bytes(job.source_bytes)}`);
  };
  show_items(by_id("running"), jobs, (job) => job.id, make, update, kEmptyRunning);
}

export function show_problems(failed, quarantined, open, retry) {
  const jobs = [...failed.jobs, ...quarantined.jobs].sort((a, b) => b.changed_at - a.changed_at);
  const total = failed.total + quarantined.total;
  by_id("problems-section").hidden = total === 0;
  const make = (job) => element("li", "", name_button(job, open), element("span", "fact quiet"),
                                button("Retry", "", () => retry(job.id)), element("span", "reason bad"));
  const update = (child, job) => {
    const attempts = job.attempts === 1 ? "1 attempt" : `${job.attempts} attempts`;
    set_text(part(child, "fact"), `${job.state}, ${attempts}, ${format.ago(job.changed_at)}`);
    set_text(part(child, "reason"), job.reason);
  };
  show_items(by_id("problems"), jobs, (job) => job.id, make, update, "");
  set_text(by_id("problems-more"), total > jobs.length ? `and ${format.count(total - jobs.length)} more` : "");
}

export function show_queue(page, open) {
  const make = (job) => element("li", "", name_button(job, open), element("span", "fact quiet"),
                                element("span", "reason quiet"));
  const update = (child, job) => {
    part(child, "reason").hidden = !job.reason;
    set_text(part(child, "reason"), job.reason);
    const facts = [format.bytes(job.source_bytes)];
    if (job.next_attempt_at !== null) {
      const wait = job.next_attempt_at - Date.now() / 1000;
      facts.push(`attempt ${job.attempts + 1} ${wait > 0 ? `in ${format.seconds(Math.ceil(wait))}` : "is due"}`);
    }
    set_text(part(child, "fact"), facts.join(", "));
  };
  show_items(by_id("queue"), page.jobs, (job) => job.id, make, update, kEmptyQueue);
  const more = page.total - page.jobs.length;
  set_text(by_id("queue-more"), more > 0 ? `and ${format.count(more)} more` : "");
}

/** Puts the output's picture into `frame`, or says that there is none. */
async function fill_picture(frame, job, index) {
  const name = format.base_name(job.outputs[index].path);
  try {
    if (!job.outputs[index].thumbnail) throw new Error("not rendered");
    frame.replaceChildren(await thumbnail(job, index, `Rendering of ${name}`));
  } catch {
    frame.replaceChildren("no picture");
  }
}

export function show_results(page, open, limit) {
  const results = page.jobs.flatMap((job) => job.outputs.map((output, index) => ({job, output, index})));
  const make = ({job, output, index}) => {
    const frame = element("div", "picture");
    fill_picture(frame, job, index);
    const name = name_button(job, open);
    set_text(name, format.base_name(output.path));
    return element("li", "card", frame,
                   element("div", "text", name, element("span", "fact", `${format.bytes(output.bytes)}, ${format.rate(output)}`),
                           element("span", "quality"), element("span", "when quiet")));
  };
  const update = (child, {job, output}) => {
    set_text(part(child, "quality"), output.lossless ? "lossless" : `PSNR ${format.quality(output)}`);
    set_text(part(child, "when"), format.ago(job.changed_at));
  };
  show_items(by_id("results"), results.slice(0, limit), ({job, index}) => `${job.id}/${index}/${job.changed_at}`, make,
             update, kEmptyResults);
}

export function show_watches(watches) {
  const make = () => element("li", "", element("span", "lead path"), element("span", "fact quiet"),
                             element("span", "reason bad"));
  const update = (child, watch) => {
    set_text(part(child, "lead"), `${watch.directory} \u2192 ${watch.output}`);
    const facts = [watch.up ? watch.method : "down", `${format.count(watch.jobs.done)} done`];
    if (watch.overflows > 0) facts.push(`${format.count(watch.overflows)} ${watch.overflows === 1 ? "overflow" : "overflows"}`);
    set_text(part(child, "fact"), facts.join(", "));
    part(child, "reason").hidden = watch.up;
    set_text(part(child, "reason"), watch.reason);
  };
  show_items(by_id("watches"), watches, (watch) => watch.label, make, update, kEmptyWatches);
}
