// The series of this page. Behind weir watch, the only viewer may be taken over for another series. Then this page
// says so, keeps its picture, and offers to bring its own series back.

import {post} from "./api.js";
import {by_id, set_text} from "./dom.js";

const kTaken = 423;

const asked = new URLSearchParams(location.search);
const job = asked.get("job");

let key = asked.get("series");  // null: the series that the server shows first
let name = null;                // of the shown file of this series; null: not known yet
let forced = false;             // the next click takes the viewer even from somebody who uses it

function show(text, {back = false, there = false} = {}) {
  by_id("other-series").hidden = !text;
  set_text(by_id("other-series-note"), text);
  by_id("take-back").hidden = !(back && job);
  by_id("go-there").hidden = !there;
}

async function take_back() {
  try {
    await post(`../api/jobs/${encodeURIComponent(job)}/view?output=${asked.get("output") ?? 0}${forced ? "&force=1" : ""}`);
    forced = false;
    show("The viewer is being started.");
  } catch (error) {
    forced = error.status === kTaken;
    set_text(by_id("take-back"), forced ? "Take it all the same" : "Take it back");
    set_text(by_id("other-series-note"), forced ? "Somebody looks at the other file, or opens it, and loses it when you take the viewer."
                                                : error.message);
  }
}

export const series_key = () => key;

/** Returns whether the server's `state` is of this page's series; if not, says so. `file` is this page's file. */
export function is_own_series(state, file) {
  key ??= state.series;
  name = file ?? name;
  const own = state.series === key;
  if (own) {
    forced = false;
    set_text(by_id("take-back"), "Take it back");
    show("");
    return true;
  }
  if (!forced) {
    show(`The viewer now shows another file, ${state.title}. ${name ? `This page is of ${name}` : "This address is of another series"}.`,
         {back: true, there: true});
  }
  return false;
}

/** Says that no viewer answers; `state` tells why. If none runs and a job is known, offers to start it again. */
export function show_no_viewer(state) {
  if (forced) return;
  if (state === "starting") show("The viewer is being started.");
  else if (job) show("No viewer runs for this page now.", {back: true});
}

by_id("take-back").addEventListener("click", take_back);
by_id("go-there").addEventListener("click", () => location.assign(location.pathname));
