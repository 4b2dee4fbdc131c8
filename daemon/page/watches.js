// The watched directories, each with the counts of its jobs.

import {by_id, element, part, set_text, show_items} from "./dom.js";
import * as format from "./format.js";

const kEmptyWatches = "No directory is watched.";
const kFigures = [["waiting", "Waiting"], ["failed", "Failed"], ["quarantined", "Quarantined"], ["rate", "Done a minute"],
                  ["last", "Last result"]];

function make_watch() {
  const figures = element("dl", "columns");
  for (const [name, title] of kFigures) {
    figures.append(element("div", "", element("dt", "quiet", title), element("dd", name)));
  }
  return element("li", "", element("span", "lead path"), element("span", "fact quiet"), figures,
                 element("span", "reason bad"));
}

function facts_of(watch) {
  const facts = [watch.up ? watch.method : "down", `${format.count(watch.jobs.done)} done`];
  if (watch.jobs.discovered > 0) facts.push(`${format.count(watch.jobs.discovered)} not taken yet`);
  if (watch.overflows > 0) facts.push(`${format.count(watch.overflows)} ${watch.overflows === 1 ? "overflow" : "overflows"}`);
  return facts.join(", ");
}

function update_watch(child, watch) {
  set_text(part(child, "lead"), `${watch.directory} \u2192 ${watch.output}`);
  set_text(part(child, "fact"), facts_of(watch));
  const size = watch.jobs.waiting > 0 ? ` (${format.bytes(watch.waiting_bytes)})` : "";
  set_text(part(child, "waiting"), `${format.count(watch.jobs.waiting)}${size}`);
  for (const state of ["failed", "quarantined"]) {
    set_text(part(child, state), format.count(watch.jobs[state]));
    part(child, state).classList.toggle("bad", watch.jobs[state] > 0);
  }
  set_text(part(child, "rate"), format.per_minute(watch.done_per_min));
  set_text(part(child, "last"), watch.last_done ? format.ago(watch.last_done.changed_at) : "none yet");
  part(child, "reason").hidden = watch.up;
  set_text(part(child, "reason"), watch.reason);
}

export function show_watches(watches) {
  show_items(by_id("watches"), watches, (watch) => watch.label, make_watch, update_watch, kEmptyWatches);
}
