// Opens the viewer of an output: asks the service to start it, waits until it answers, and goes to its page.

import {get, post} from "./api.js";
import {button, by_id, set_text} from "./dom.js";
import * as format from "./format.js";

const kAgain_ms = 250;

const dialog = by_id("viewer");
let asked = 0;    // number of requests; only the answer to the latest one is shown
let wanted = {};  // {job, index, path}

const after = (ms) => new Promise((done) => setTimeout(done, ms));

function show(text, bad = false, taken = false) {
  set_text(by_id("viewer-note"), text);
  by_id("viewer-note").classList.toggle("bad", bad);
  by_id("viewer-force").hidden = !taken;
  if (!dialog.open) dialog.showModal();
}

async function ask(force) {
  const mine = ++asked;
  const {job, index, path} = wanted;
  set_text(by_id("viewer-title"), format.base_name(path));
  show("The viewer is being started.");
  try {
    const {url, ...first} = await post(`/api/jobs/${job}/view?output=${index}${force ? "&force=1" : ""}`);
    let viewer = first;
    while (mine === asked && viewer.state === "starting") {
      await after(kAgain_ms);
      viewer = await get("/api/viewer");
    }
    if (mine !== asked) return;
    if (viewer.state !== "ready") {
      show(`${viewer.reason || "The viewer has ended"}.`, true);
      return;
    }
    dialog.close();
    location.assign(url);
  } catch (error) {
    if (mine === asked) show(error.status === 423 ? "Somebody looks at another series. Whoever does loses it when you open this one."
                                                  : error.message, true, error.status === 423);
  }
}

export function open_viewer(job, index, path) {
  wanted = {job, index, path};
  ask(false);
}

/** Returns a button that opens the viewer of the output that `entry()` returns: {job, output, index}. */
export function view_button(entry) {
  return button("View", "view control", () => {
    const {job, output, index} = entry();
    open_viewer(job.id, index, output.path);
  });
}

/** Hides all view buttons if the service has no viewer. */
export function offer_viewer({state}) {
  document.body.classList.toggle("no-viewer", state === "off");
}

by_id("viewer-force").addEventListener("click", () => ask(true));
by_id("viewer-close").addEventListener("click", () => dialog.close());
dialog.addEventListener("close", () => ++asked);
