// The figures at the top: how fast files arrive and are converted, when the queue ends, and how full the disks are.

import {by_id, element, part, set_text, show_items} from "./dom.js";
import * as format from "./format.js";

const kSamples = 60;
const samples = [];  // throughput of the last rounds

function show_sparkline(bytes_per_s) {
  samples.push(bytes_per_s);
  if (samples.length > kSamples) samples.shift();
  const top = Math.max(...samples, 1);
  const points = samples.map((sample, i) => `${120 - 2 * (samples.length - 1 - i)},${27 - 26 * sample / top}`);
  by_id("sparkline").firstElementChild.setAttribute("points", points.join(" "));
}

function show_flow(name, per_min, bytes_per_s, most) {
  set_text(by_id(`${name}-rate`), `${format.per_minute(per_min)} / min`);
  set_text(by_id(`${name}-bytes`), format.bytes_per_s(bytes_per_s));
  by_id(`${name}-bar`).style.width = `${100 * (per_min ?? 0) / most}%`;
}

/** Returns in words when the queue will be empty. */
function queue_end(status) {
  if (status.jobs.waiting === 0) return "";
  const seconds = status.queue_ends_in_s;
  if (seconds !== null) return `empty in about ${format.seconds(Math.ceil(seconds)).replace(".0", "")}`;
  if (status.state === "paused") return "end not in sight: the service is paused";
  if (status.done_per_min === 0) return "end not in sight: nothing was converted in the last 10 minutes";
  return "end not in sight: files arrive faster than they are converted";
}

function show_queue_figures(status) {
  set_text(by_id("waiting"), format.count(status.jobs.waiting));
  const queue = ["waiting"];
  if (status.jobs.waiting > 0) {
    queue.push(format.bytes(status.waiting_bytes), `the oldest for ${format.seconds(status.queue_age_s)}`);
  }
  if (status.jobs.discovered > 0) queue.push(`${format.count(status.jobs.discovered)} more not taken yet`);
  set_text(by_id("queue-age"), queue.join(", "));
  set_text(by_id("queue-end"), queue_end(status));
  by_id("queue-end").classList.toggle("warn", status.queue_ends_in_s === null);
}

export function show_figures(status) {
  set_text(by_id("throughput"), format.bytes_per_s(status.bytes_per_s));
  show_sparkline(status.bytes_per_s);
  show_queue_figures(status);
  set_text(by_id("done"), format.count(status.jobs.done));
  set_text(by_id("totals"),
           `done; since start ${format.bytes(status.bytes_in_total)} in, ${format.bytes(status.bytes_out_total)} out`);
  const broken = status.jobs.failed + status.jobs.quarantined;
  set_text(by_id("broken"), format.count(broken));
  set_text(by_id("broken-states"),
           `${format.count(status.jobs.failed)} failed, ${format.count(status.jobs.quarantined)} quarantined`);
  by_id("broken").classList.toggle("bad", broken > 0);
  const most = Math.max(status.arrived_per_min, status.done_per_min, 0.1);
  show_flow("arrived", status.arrived_per_min, status.arrived_bytes_per_s, most);
  show_flow("converted", status.done_per_min, status.converted_bytes_per_s, most);
  show_disks(status.disks);
}

function fills(disk) {
  if (disk.written_bytes_per_s === 0) return "nothing written in the last 10 minutes";
  const speed = `${format.bytes_per_s(disk.written_bytes_per_s)} written`;
  return disk.fills_in_s === null ? `${speed}, not full within a year` :
                                    `${speed}, full in about ${format.seconds(disk.fills_in_s)}`;
}

function make_disk() {
  const bar = element("progress");
  bar.max = 1;
  return element("li", "panel disk", element("span", "lead path"), bar, element("span", "fact"),
                 element("span", "fills quiet"), element("span", "reason bad"));
}

function update_disk(child, disk) {
  set_text(part(child, "lead"), `Disk ${disk.path}`);
  part(child, "lead").title = disk.directories.join("\n");
  const bar = child.querySelector("progress");
  bar.setAttribute("aria-label", `${disk.path}, used`);
  bar.value = disk.total_bytes > 0 ? 1 - disk.free_bytes / disk.total_bytes : 1;
  set_text(part(child, "fact"), `${format.bytes(disk.free_bytes)} of ${format.bytes(disk.total_bytes)} free`);
  set_text(part(child, "fills"), fills(disk));
  child.classList.toggle("held", disk.held !== "");
  part(child, "reason").hidden = disk.held === "";
  set_text(part(child, "reason"), disk.held && `Jobs wait: ${disk.held}`);
}

function show_disks(disks) {
  show_items(by_id("disks"), disks, (disk) => disk.path, make_disk, update_disk, "");
}
