// The dialog of one job: all its facts, and buttons to retry or cancel it.

import {get, post} from "./api.js";
import {path_with_copy} from "./copy.js";
import {by_id, element, set_text} from "./dom.js";
import * as format from "./format.js";
import {view_button} from "./viewer.js";

const dialog = by_id("job");
let shown = 0;  // id
let changed = () => {};

function facts_of(job) {
  const facts = [["Source", path_with_copy(job.source, "source")], ["State", format.state(job)],
                 ["Size", format.bytes(job.source_bytes)]];
  if (job.reason) facts.push(["Reason", job.reason]);
  facts.push(["Since", `${format.date(job.changed_at)} (${format.ago(job.changed_at)})`]);
  if (job.attempts > 0) facts.push(["Failed attempts", String(job.attempts)]);
  if (job.exit_code !== null) facts.push(["Exit code", String(job.exit_code)]);
  if (job.seconds !== null) facts.push(["Time taken", format.seconds(job.seconds)]);
  if (job.peak_rss_bytes > 0) facts.push(["Peak memory", format.bytes(job.peak_rss_bytes)]);
  for (const [index, output] of job.outputs.entries()) {
    const path = path_with_copy(output.path, "result");
    if (job.state === "done") {
      const view = view_button(() => ({job, output, index}));
      view.addEventListener("click", () => dialog.close());
      path.append(view);
    }
    facts.push(["Result", path], ["Figures", format.output_facts(output).join(", ")]);
  }
  return facts;
}

function show(job) {
  set_text(by_id("job-title"), `Job ${job.id}: ${format.base_name(job.source)}`);
  by_id("job-facts").replaceChildren(
      ...facts_of(job).flatMap(([name, value]) => [element("dt", "", name), element("dd", "", value)]));
  by_id("job-log").hidden = !job.log_tail;
  set_text(by_id("job-log"), job.log_tail ?? "");
  set_text(by_id("job-error"), "");
  by_id("job-retry").hidden = !["failed", "quarantined", "cancelled", "done"].includes(job.state) &&
      job.next_attempt_at === null;
  by_id("job-cancel").hidden = !["discovered", "waiting", "running"].includes(job.state);
}

async function act(action) {
  try {
    show(await post(`/api/jobs/${shown}/${action}`));
    changed();
  } catch (error) {
    set_text(by_id("job-error"), error.message);
  }
}

/** `on_change` is called after a job was retried or cancelled. */
export function prepare_dialog(on_change) {
  changed = on_change;
  by_id("job-retry").addEventListener("click", () => act("retry"));
  by_id("job-cancel").addEventListener("click", () => act("cancel"));
  by_id("job-close").addEventListener("click", () => dialog.close());
}

export async function open_job(id) {
  shown = id;
  try {
    const job = await get(`/api/jobs/${id}`);
    if (shown !== id) return;
    show(job);
    if (!dialog.open) dialog.showModal();
  } catch {
    changed();  // the page's next round reports the error
  }
}
