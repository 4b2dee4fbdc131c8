// The page of weir view: connects the parts. The look is one object (look.js); every change of it goes through
// change().

import {by_id, offer, set_text} from "./dom.js";
import * as camera from "./camera.js";
import {ClipBox, roi_text} from "./clip_box.js";
import {Controls} from "./controls.js";
import {Conversion} from "./conversion.js";
import {picture_text} from "./description.js";
import {History} from "./history.js";
import {Keep} from "./keep.js";
import {listen_to_keys} from "./keys.js";
import {KnownFiles} from "./known_files.js";
import * as looks from "./look.js";
import {curve_of, show_banner, show_command, show_file, show_mode, show_quality, show_title, show_transfer} from "./panels.js";
import {Session} from "./session.js";
import {Steps} from "./steps.js";
import {TransferEditor, simplified} from "./transfer_editor.js";
import {Value} from "./value.js";
import {Viewport} from "./viewport.js";

const kStill_ms = 150;   // time without a change after which the picture is refined

let server = null;       // /api/state
let look = looks.from_hash(location.hash);
let history = new History(look);
let view_id = 0;
let drawn_first = false;  // a picture was requested since the server's state was received
let still_timer;
let wanted_file = null;    // name of a step that the address asks for but that has not arrived yet
const files = new KnownFiles();
const facts = () => files.facts(look.step);
const aspect = () => viewport.width / viewport.height;

// ---- What goes out

function picture_size() {
  const ratio = Math.min(devicePixelRatio || 1, 2);
  let [width, height] = [viewport.width * ratio, viewport.height * ratio];
  const layers = look.split === null ? 1 : 2;
  const too_many = Math.sqrt(width * height * layers / server.most_pixels);
  if (too_many > 1) [width, height] = [width / too_many, height / too_many];
  return [Math.max(1, Math.floor(width)), Math.max(1, Math.floor(height))];
}

function ask_picture(moving) {
  if (!facts()) return;
  drawn_first = true;
  const [width, height] = picture_size();
  const view = {type: "view", id: ++view_id, scene: looks.to_scene(look, facts(), width / height), width, height,
                step: look.step, moving};
  if (look.split !== null) view.against = true;
  set_text(by_id("quality"), "drawing");
  session.connection.show(view);
}

/** Sets a new look: updates the page, and asks for a small picture at once and a full one when nothing moves. */
function change(next, moving = true) {
  look = next;
  value.forget();
  show_look();
  conversion.changed();
  ask_picture(moving);
  clearTimeout(still_timer);
  if (moving) still_timer = setTimeout(() => ask_picture(false), kStill_ms);
  keep.soon();
}

/** Must be called at the end of a change. */
function done() {
  history.mark(look);
  show_undo();
}

// ---- What is shown

function show_undo() {
  by_id("undo").disabled = history.past.length === 0;
  by_id("redo").disabled = history.future.length === 0;
}

const scene = () => facts() && looks.to_scene(look, facts(), aspect());

/** Describes the finished picture in words. */
function describe() {
  const shown = facts();
  set_text(by_id("picture-text"), picture_text(look, shown, looks.shown_box(look, shown)));
}

const limits = (shown) => shown.box[0].map((lo, i) => [lo, shown.box[1][i]]);

function show_look() {
  const shown = facts();
  if (!shown) return;
  show_mode(look);
  show_transfer(editor, look, shown, files.histogram(look.step), server.colormaps);
  controls.show(look, shown);
  const box = looks.shown_box(look, shown);
  clip_box.show(limits(shown), box);
  set_text(by_id("roi"), `--roi ${roi_text(box ?? limits(shown))}`);
  steps.show(look.step);
  viewport.set_split(look.split);
  by_id("compare").checked = look.split !== null;
  for (const side of ["side-left", "side-right"]) by_id(side).hidden = look.split === null;
  show_undo();
  const [width, height] = picture_size();
  show_command(by_id("render-command"), `weir render ${server.render_input ?? shown.word} -o picture.png ` +
               `--scene scene.toml --size ${width}x${height}`);
}

// ---- What comes in

/** Shows the file of the present step; its own facts may come later. */
function show_shown_file() {
  const name = steps.names[look.step];
  show_title(name, steps.names.includes(server.title) ? name : `${server.title}: ${name}`);
  if (facts()) show_file(name, facts(), files.facts(look.step, 1));
}

function go_to_step(step, moving) {
  wanted_file = null;
  change({...look, step}, moving);
  show_shown_file();
}

function receive_steps(message) {
  const other_values = files.set_values(message);
  const name = steps.names[look.step];
  steps.set(message);
  const other_name = steps.names[look.step] !== name;  // names change when steps of another folder come
  const found = wanted_file === null ? undefined : steps.number(wanted_file);
  if (found !== undefined) go_to_step(found, false);
  else if (!message.order.includes(look.step)) show_banner(`${steps.names[look.step]} is no longer there.`);
  if (found !== undefined) return;
  if (other_name) show_shown_file();
  if (other_values) {
    show_look();
    conversion.changed();
  }
  if (other_name || (other_values && look.range === null)) ask_picture(false);
}

function receive(message) {
  if (message.type === "facts" || message.type === "histogram") {
    const before = scene();
    files.add(message);
    show_look();
    conversion.changed();
    if (message.type === "facts") show_shown_file();
    // A picture that was requested without these facts may show another box or range.
    if (!drawn_first || scene() !== before) ask_picture(steps.playing);
  } else if (message.type === "steps") {
    receive_steps(message);
  } else if (message.type === "value") {
    value.receive(message, (step, side) => files.facts(step, side));
  } else if (message.type === "progress") {
    if (message.what === "load") set_text(by_id("quality"), "loading the volume");
    else set_text(by_id("quality"), `${Math.round(message.share * 100)} % of a pass`);
  } else if (message.type === "error") {
    show_banner(message.message);
    if (message.view === view_id) steps.drawn(look.step);  // playback goes on
  } else if (message.type === "conversion") {
    conversion.receive(message);
  } else if (message.type === "forecast") {
    conversion.receive_forecast(message);
  }
}

const viewport = new Viewport(by_id("frame"), by_id("canvas"), by_id("divider"), {
  turn: (az, el) => change(camera.turned(look, az, el)),
  zoom: (times) => change(camera.zoomed(look, times)),
  pan: (x, y) => facts() && change(camera.panned(look, facts(), aspect(), x, y)),
  split: (share) => {  // no request is needed: both pictures are here
    look = {...look, split: share};
    viewport.set_split(share);
    keep.soon();
  },
  point: (at, none) => at ? value.ask(at, look, none) : value.forget(),
});

const session = new Session({
  file: () => look.file ?? steps.names[look.step] ?? null,
  ready: set_up,
  message: receive,
  picture: async (header, blob) => {
    await viewport.draw(header, blob);
    show_quality(header, header.view !== view_id);
    if (header.view === view_id && !header.moving && header.samples >= header.of) describe();
    if (header.view === view_id && steps.place() >= 0) show_banner("");
    steps.drawn(header.step);
  },
});

const value = new Value((message) => session.connection.send(message));
const editor = new TransferEditor(by_id("curve"), {
  changed: (points) => change({...look, opacity: points}),
  done,
});
const clip_box = new ClipBox(by_id("box"), {changed: (box) => change({...look, box}), done});
const controls = new Controls({changed: (part) => change({...look, ...part}), done});

/** Returns the opacity for a conversion, which needs explicit points even if the look has none. */
const converted_opacity = (shown) => look.opacity ?? simplified(curve_of(look, shown));

const conversion = new Conversion({
  scene: () => {
    const shown = facts();
    return shown ? looks.to_scene({...look, opacity: converted_opacity(shown)}, shown, aspect()) : null;
  },
  step: () => look.step,
  kept: () => {
    const shown = facts();
    return JSON.stringify([look.mode, look.opacity, look.range, look.iso, look.box, look.step, shown?.file, shown?.bytes,
                           shown?.box, shown?.range, shown?.background, shown?.certificate]);
  },
  send: (message) => session.connection.send(message),
});
const steps = new Steps(go_to_step);
const keep = new Keep({
  file: () => steps.names[look.step],
  scene: () => {
    const [width, height] = picture_size();
    const shown = facts();
    // The curve of a series depends on all its steps, which weir render of one file does not know.
    const curve = steps.names.length > 1 ? curve_of(look, shown) : null;
    const opacity = by_id("convert-panel").open ? converted_opacity(shown) : look.opacity ?? curve;
    return looks.to_scene({...look, opacity}, shown, width / height);
  },
  hash: () => looks.to_hash(look, steps.names[look.step]),
});

function set_mode(mode) {
  change({...look, mode}, false);
  done();
}

function undo(which) {
  const before = look;
  const next = history[which](look);
  if (next !== before) change(next, false);
}

function listen() {
  for (const choice of document.querySelectorAll("input[name=mode]")) {
    choice.addEventListener("change", () => set_mode(choice.value));
  }
  const press = (id, action) => by_id(id).addEventListener("click", action);
  press("reset-camera", () => change({...look, az: 35, el: 20, zoom: 1, at: null}, false));
  press("undo", () => undo("undo"));
  press("redo", () => undo("redo"));
  const reset = (part) => () => {
    change({...look, ...part}, false);
    done();
  };
  press("reset-transfer", reset({opacity: null, range: null, colormap: null, density: null, iso: null}));
  press("reset-light", reset({light: null, shading: null, exposure: null}));
  press("reset-box", reset({box: null}));
  by_id("log").addEventListener("change", () => change({...look, log: by_id("log").checked}, false));
  by_id("colormap").addEventListener("change", () => reset({colormap: by_id("colormap").value || null})());
  by_id("compare").addEventListener("change", () => {
    change({...look, split: by_id("compare").checked ? look.split ?? 0.5 : null}, false);
  });
  listen_to_keys({
    mode: set_mode,
    reset: () => by_id("reset-camera").click(),
    play: () => steps.toggle(),
    step: (by) => steps.by(by),
    undo,
  });
  addEventListener("hashchange", () => {
    look = looks.from_hash(location.hash);
    if (server) look = known(look);
    history = new History(look);
    change(look, false);
  });
  let resize_timer;
  new ResizeObserver(() => {
    clearTimeout(resize_timer);
    resize_timer = setTimeout(() => ask_picture(false), kStill_ms);
  }).observe(by_id("frame"));
}

/** Returns the look without the parts that the server lacks. A step that does not exist yet is awaited. */
function known(wanted) {
  const named = steps.number(wanted.file);
  wanted_file = wanted.file !== null && named === undefined ? wanted.file : null;
  return {
    ...wanted,
    file: null,
    colormap: wanted.colormap && server.colormaps[wanted.colormap] ? wanted.colormap : null,
    step: named ?? Math.min(...server.order),  // the first existing step
    split: server.against.length > 0 ? wanted.split : null,
  };
}

/** Starts with the server's state; it may be another server than before. */
function set_up(state) {
  server = state;
  set_text(by_id("version"), `weir ${server.version}, ${server.backend}.`);
  by_id("preview").hidden = server.preview_of === null;
  set_text(by_id("preview"), "preview");
  by_id("preview").title = `A quick conversion of ${server.preview_of}`;
  set_text(by_id("render-title"), server.preview_of === null ? "The same picture" : "This view of the source itself");
  offer(by_id("colormap"), [["", "of the mode"], ...Object.keys(server.colormaps).map((name) => [name, name])]);
  by_id("service").hidden = !location.pathname.endsWith("/view/");  // behind weir watch
  // A restarted server may number the steps differently.
  const file = look.file ?? steps.names[look.step] ?? null;
  files.clear();
  drawn_first = false;
  steps.set(server);
  look = known({...look, file});
  by_id("compare-field").hidden = server.against.length === 0;
  conversion.set_up(server.allow_convert);
  show_shown_file();
}

listen();
session.begin();
