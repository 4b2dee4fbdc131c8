// Asks the service how it is, every two seconds while the page is looked at, and
// shows the answer.

import {get, post, set_token} from "./api.js";
import {by_id, set_text} from "./dom.js";
import * as format from "./format.js";
import {open_job, prepare_dialog} from "./job_dialog.js";
import {show_problems, show_queue, show_results, show_running, show_watches} from "./lists.js";
import {offer_watches, refresh_series} from "./series.js";

const kRound_ms = 2000;
const kQueueShown = 10;
const kProblemsShown = 10;
const kResultsShown = 12;
const kSamples = 60;

const samples = [];       // throughput of the last rounds
let answered_at = 0;      // when the last answer came, Unix ms
let series_of = "";       // what the series was loaded for
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

function show_sparkline(bytes_per_s) {
  samples.push(bytes_per_s);
  if (samples.length > kSamples) samples.shift();
  const top = Math.max(...samples, 1);
  const points = samples.map((sample, i) => `${120 - 2 * (samples.length - 1 - i)},${27 - 26 * sample / top}`);
  by_id("sparkline").firstElementChild.setAttribute("points", points.join(" "));
}

function show_figures(status) {
  set_text(by_id("throughput"), `${format.bytes(status.bytes_per_s)}/s`);
  show_sparkline(status.bytes_per_s);
  set_text(by_id("waiting"), format.count(status.jobs.waiting));
  const queue = ["waiting"];
  if (status.jobs.waiting > 0) queue.push(`the oldest for ${format.seconds(status.queue_age_s)}`);
  if (status.jobs.discovered > 0) queue.push(`${format.count(status.jobs.discovered)} more not complete yet`);
  set_text(by_id("queue-age"), queue.join(", "));
  set_text(by_id("done"), format.count(status.jobs.done));
  set_text(by_id("totals"),
           `done; since start ${format.bytes(status.bytes_in_total)} in, ${format.bytes(status.bytes_out_total)} out`);
  const broken = status.jobs.failed + status.jobs.quarantined;
  set_text(by_id("broken"), format.count(broken));
  by_id("broken").classList.toggle("bad", broken > 0);
}

function show_status(status) {
  show_state(status.state);
  set_text(by_id("config"), status.config);
  by_id("config").title = status.config;
  by_id("pause").hidden = status.state !== "running" && status.state !== "paused";
  set_text(by_id("pause"), status.state === "paused" ? "Resume" : "Pause");
  const down = status.watches.filter((watch) => !watch.up).map((watch) => `${watch.directory} is not watched: ${watch.reason}.`);
  const paused = status.state === "paused" && status.reason ? [`Paused: ${status.reason}.`] : [];
  show_banner([...paused, ...down].join(" "), down.length > 0);
  document.title = `weir: ${status.jobs.running} running, ${status.jobs.waiting} waiting`;
  set_text(by_id("footer"), `weir ${status.version}, up since ${format.date(status.started_at)}`);
  show_figures(status);
  show_running(status.running, open_job);
  show_watches(status.watches);
  offer_watches(status.watches);
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

async function refresh_lists() {
  const jobs = (state, limit) => get(`/api/jobs?state=${state}&limit=${limit}`);
  const [failed, quarantined, waiting, done] = await Promise.all([
    jobs("failed", kProblemsShown), jobs("quarantined", kProblemsShown), jobs("waiting", kQueueShown),
    jobs("done", kResultsShown)]);
  show_problems(failed, quarantined, open_job, (id) => act(`/api/jobs/${id}/retry`));
  show_queue(waiting, open_job);
  show_results(done, open_job, kResultsShown);
}

async function refresh() {
  const status = await get("/api/status");
  show_status(status);
  await refresh_lists();
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
    if (error.status !== 409) show_failure(error);  // 409: it has moved on meanwhile, which the round shows
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
round();
