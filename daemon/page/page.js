// Asks the service for its state every two seconds while the page is visible, and shows the answer.

import {offer_watch_filter, prepare_all_jobs, refresh_all_jobs} from "./all_jobs.js";
import {get, post, set_token} from "./api.js";
import {by_id, set_text} from "./dom.js";
import {show_figures} from "./figures.js";
import * as format from "./format.js";
import {open_job, prepare_dialog} from "./job_dialog.js";
import {show_not_taken, show_queue, show_running} from "./lists.js";
import {refresh_problems} from "./problems.js";
import {show_results} from "./results.js";
import {offer_watches, refresh_series} from "./series.js";
import {offer_viewer} from "./viewer.js";
import {show_watches} from "./watches.js";

const kRound_ms = 2000;
const kQueueShown = 10;
const kNotTakenShown = 10;
const kResultsShown = 12;

let answered_at = 0;      // when the last answer came, Unix ms
let series_of = "";       // watch and counts that the series was loaded for
let timer = 0;
let running = false;      // a round is under way

function show_state(state) {
  const pill = by_id("state");
  set_text(pill, state);
  pill.className = `state ${state}`;
}

function show_banner(text, bad) {
  const banner = by_id("banner");
  banner.hidden = text === "";
  banner.classList.toggle("bad", bad);
  set_text(banner, text);
}

/** Returns in words what keeps jobs from running, and whether it is a fault. */
function troubles(status) {
  const reason = status.state === "paused" ? status.reason : "";
  const paused = reason ? [`Paused: ${reason}.`] : [];
  const held = status.disks.filter((disk) => disk.held && !reason.includes(disk.held))
                   .map((disk) => `Jobs wait for room on ${disk.path}: ${disk.held}.`);
  // Disks without outputs, for example a full one for spill files, and outputs whose file system is not mounted.
  const of_disks = status.disks.flatMap((disk) => disk.held.split("; "));
  const others = status.reason.split("; ").filter((part) => !of_disks.includes(part));
  if (status.state === "running" && others.length > 0 && others[0]) held.push(`Jobs wait: ${others.join("; ")}.`);
  const down = status.watches.filter((watch) => !watch.up).map((watch) => `${watch.directory} is not watched: ${watch.reason}.`);
  return {text: [...paused, ...held, ...down].join(" "), bad: held.length + down.length > 0};
}

/** Hides the buttons for changes if only another address, `control_at`, accepts changes. */
function show_who_controls(control_at) {
  document.body.classList.toggle("view-only", control_at !== null);
  by_id("view-only").hidden = control_at === null;
  by_id("view-only").title = `Pause, retry and cancel at ${control_at}`;
}

function show_status(status) {
  show_state(status.state);
  set_text(by_id("config"), status.config);
  by_id("config").title = status.config;
  by_id("pause").hidden = status.state !== "running" && status.state !== "paused";
  set_text(by_id("pause"), status.state === "paused" ? "Resume" : "Pause");
  show_who_controls(status.control_at);
  const {text, bad} = troubles(status);
  show_banner(text, bad);
  document.title = `weir: ${status.jobs.running} running, ${status.jobs.waiting} waiting`;
  set_text(by_id("footer"), `weir ${status.version}, up since ${format.date(status.started_at)}`);
  show_figures(status);
  show_running(status.running, open_job);
  show_watches(status.watches);
  offer_watches(status.watches);
  offer_watch_filter(status.watches);
  offer_viewer(status.viewer);
}

function show_failure(error) {
  if (error.status === 401) {
    by_id("main").hidden = true;
    by_id("login").hidden = false;
    show_state("locked");
    show_banner("", false);
    by_id("pause").hidden = true;
    return;
  }
  show_state("unreachable");
  by_id("pause").hidden = true;
  by_id("main").classList.add("stale");
  const last = answered_at > 0 ? ` Its last answer came ${format.ago(answered_at / 1000)}.` : "";
  show_banner(`${error.message}${last} Trying again.`, true);
}

const kProblemActions = {
  open: open_job,
  retry: (id) => act(`/api/jobs/${id}/retry`),
  retry_group: (query) => act(`/api/retry-failed?${query}`),
};

async function refresh_lists(state) {
  const [waiting, discovered, done] = await Promise.all([
    get(`/api/jobs?state=waiting&limit=${kQueueShown}`),
    get(`/api/jobs?state=discovered&sort=discovered&order=asc&limit=${kNotTakenShown}`),
    get(`/api/jobs?state=done&limit=${kResultsShown}`), refresh_problems(kProblemActions), refresh_all_jobs(state)]);
  show_queue(waiting, open_job);
  show_not_taken(discovered, open_job);
  show_results(done, open_job, kResultsShown);
}

async function refresh() {
  const status = await get("/api/status");
  show_status(status);
  await refresh_lists(JSON.stringify([status.started_at, status.done_total, status.jobs]));
  const wanted = `${by_id("series-watch").value}\n${status.started_at}\n${status.jobs.done}\n${status.done_total}`;
  if (wanted !== series_of) await refresh_series();
  series_of = wanted;
}

async function round() {
  clearTimeout(timer);
  if (running) return;
  running = true;
  try {
    await refresh();
    answered_at = Date.now();
    by_id("login").hidden = true;
    by_id("main").hidden = false;
    by_id("main").classList.remove("stale");
  } catch (error) {
    show_failure(error);
  }
  running = false;
  if (!document.hidden && by_id("login").hidden) timer = setTimeout(round, kRound_ms);
}

async function act(path) {
  try {
    await post(path);
  } catch (error) {
    if (error.status !== 409) show_failure(error);  // 409: the job has changed already; see the next round
  }
  round();
}

by_id("pause").addEventListener("click", (event) => act(event.target.textContent === "Pause" ? "/api/pause" : "/api/resume"));
by_id("retry-all").addEventListener("click", () => act("/api/retry-failed"));
by_id("login").addEventListener("submit", async (event) => {
  event.preventDefault();
  set_token(by_id("token").value);
  by_id("token").value = "";
  await round();
  const locked = !by_id("login").hidden;
  set_text(by_id("login-error"), locked ? "This is not the token." : "");
  if (locked) by_id("token").focus();
});
document.addEventListener("visibilitychange", () => {
  if (!document.hidden) round();
});
prepare_dialog(round);
prepare_all_jobs(open_job);
round();
