// Problems: the failed and quarantined jobs. Jobs with similar reasons share one line, which expands to its jobs.

import {get, query} from "./api.js";
import {button, by_id, element, part, set_text, show_items} from "./dom.js";
import * as format from "./format.js";
import {clamped, name_button} from "./names.js";

const kGroupsShown = 10;
const kJobsShown = 50;

const opened = new Map();  // key of a group -> page of its jobs; null until it has arrived
let newest = new Map();    // "id/changed_at" -> the newest job of a group
let problems = {total: 0, groups: []};
let actions = {};

const newest_key = (group) => `${group.newest}/${group.changed_at}`;
const group_query = (group, more = {}) => query({problem: group.key, ...more});

// Loads the newest job of a group, which the group gives only by number. Returns null if the job no longer exists.
async function load_newest(group) {
  const known = newest.get(newest_key(group));
  if (known) return known;
  try {
    return await get(`/api/jobs/${group.newest}`);
  } catch (error) {
    if (error.status !== 404) throw error;
    return null;
  }
}

async function load_opened(group) {
  const page = await get(`/api/jobs?${group_query(group, {limit: kJobsShown})}`);
  if (opened.has(group.key)) opened.set(group.key, page);
}

async function toggle(key) {
  if (opened.delete(key)) {
    show();
    return;
  }
  opened.set(key, null);
  show();
  const group = problems.groups.find((one) => one.key === key);
  try {
    if (group) await load_opened(group);
    show();
  } catch {
    // the page's next round reports the error and asks again
  }
}

function reason_line() {
  const line = clamped("");
  line.classList.add("reason", "bad");
  return line;
}

function make_job(job) {
  return element("li", "", name_button(job.source, () => actions.open(job.id)), element("span", "fact quiet"),
                 button("Retry", "control", () => actions.retry(job.id)), reason_line());
}

function update_job(child, job) {
  const attempts = job.attempts === 1 ? "1 attempt" : `${job.attempts} attempts`;
  set_text(part(child, "fact"), `${job.state}, ${attempts}, ${format.ago(job.changed_at)}`);
  set_text(part(child, "reason"), format.reason(job));
  part(child, "reason").title = job.reason;
}

let groups_made = 0;

function make_group(group) {
  const jobs = element("div", "group", element("ul", "inner"), element("p", "more quiet"));
  jobs.id = `problem-${++groups_made}`;
  const line = button("", "disclosure", () => toggle(group.key));
  line.setAttribute("aria-controls", jobs.id);
  line.append(clamped(""));
  return element("li", "", line, element("span", "fact quiet"),
                 button("", "retry-group control", () => actions.retry_group(group_query(group))), jobs);
}

function update_group(child, group, job) {
  const line = part(child, "disclosure");
  const count = format.count(group.count);
  set_text(part(line, "clamped"), `${count} \u00d7 ${job ? format.reason(job) : group.reason}`);
  line.title = group.reason;
  line.setAttribute("aria-expanded", String(opened.has(group.key)));
  set_text(part(child, "fact"), `${group.state}, the newest ${format.ago(group.changed_at)}`);
  set_text(part(child, "retry-group"), `Retry all ${count}`);
  const jobs = part(child, "group");
  const page = opened.get(group.key);
  jobs.hidden = !page;
  if (!page) return;
  show_items(part(jobs, "inner"), page.jobs, (one) => one.id, make_job, update_job, "");
  const more = page.total - page.jobs.length;
  set_text(part(jobs, "more"), more > 0 ? `and ${format.count(more)} more` : "");
}

function show() {
  by_id("problems-section").hidden = problems.total === 0;
  const items = problems.groups.map((group) => ({group, job: newest.get(newest_key(group))}))
                    .filter(({group, job}) => group.count > 1 || job);
  const key = ({group}) => (group.count > 1 ? `group ${group.key}` : `job ${group.newest}`);
  const make = ({group, job}) => (group.count > 1 ? make_group(group) : make_job(job));
  const update = (child, {group, job}) => (group.count > 1 ? update_group(child, group, job) : update_job(child, job));
  show_items(by_id("problems"), items, key, make, update, "");
  const more = problems.total - items.reduce((sum, {group}) => sum + group.count, 0);
  set_text(by_id("problems-more"), more > 0 ? `and ${format.count(more)} more` : "");
}

/** Asks for the problems and shows them; `what_to_do` has open(id), retry(id) and retry_group(query). */
export async function refresh_problems(what_to_do) {
  actions = what_to_do;
  const {total, groups} = await get("/api/problems");
  const shown = groups.slice(0, kGroupsShown);
  const jobs = await Promise.all(shown.map(load_newest));
  for (const key of opened.keys()) {
    if (!shown.some((group) => group.key === key && group.count > 1)) opened.delete(key);
  }
  await Promise.all(shown.filter((group) => opened.has(group.key)).map(load_opened));
  newest = new Map(shown.map((group, i) => [newest_key(group), jobs[i]]));
  problems = {total, groups: shown};
  show();
}
