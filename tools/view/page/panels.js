// Fills the panels beside the picture from a look, and shows the state of the picture and the connection.

import {by_id, element, set_text} from "./dom.js";
import * as format from "./format.js";
import * as certificate from "./certificate.js";
import {start_iso, start_opacity} from "./look.js";

/** Returns the opacity of a look without points: the server's, or the default for the look's own range. */
export function curve_of(look, facts) {
  const last = facts.opacity.length - 1;
  const range = look.range?.map(Math.fround);  // values are float32
  return facts.opacity.map((value, i) => [i / last, range ? start_opacity(i / last, range, facts.background) : value]);
}

function gradient(look, colormaps) {
  const chosen = look.colormap ?? {dvr: "viridis", mip: "gray"}[look.mode] ?? "white";
  return `linear-gradient(to right, ${(colormaps[chosen] ?? colormaps.gray).join(", ")})`;
}

export function show_transfer(editor, look, facts, histogram, colormaps) {
  const range = look.range ?? facts.range;
  editor.show(look.opacity, curve_of(look, facts), range);
  editor.show_histogram(histogram, range, look.log);
  const iso = look.iso ?? start_iso(facts);
  editor.show_iso(look.mode === "iso" ? (iso - range[0]) / (range[1] - range[0] || 1) : null);
  by_id("gradient").style.backgroundImage = gradient(look, colormaps);
  for (const [i, end] of ["low", "high"].entries()) {
    set_text(by_id(`range-${end}`), format.within(range[i], range[1] - range[0]));
  }
  set_text(by_id("range-unit"), facts.title || "value");
  by_id("log").checked = look.log;
}

/** Sets the titles of the window and of the page; the page's title, `more`, also has the command line's name. */
export function show_title(file, more) {
  document.title = `${file} \u2013 weir view`;
  set_text(by_id("title"), more);
}

/** Shows the file `name`, whose own facts may come later. `other` is the compared file's facts, if there is one. */
export function show_file(name, facts, other) {
  set_text(by_id("file-name"), name);
  for (const id of ["certificate", "kinds"]) by_id(id).classList.toggle("awaited", facts.file !== name);
  certificate.show_rows(by_id("certificate"), facts);
  certificate.show_kinds(by_id("kinds"), facts.kinds);
  by_id("against-facts").hidden = !other;
  if (!other) return;
  set_text(by_id("against-name"), other.file);
  certificate.show_rows(by_id("against-certificate"), other);
  set_text(by_id("side-left"), facts.file);
  set_text(by_id("side-right"), other.file);
}

export function show_mode(look) {
  for (const choice of document.querySelectorAll("input[name=mode]")) choice.checked = choice.value === look.mode;
  by_id("iso-field").hidden = look.mode !== "iso";
  by_id("density-field").hidden = look.mode === "iso" || look.mode === "mip";
  by_id("shading-field").hidden = look.mode !== "dvr";
  by_id("colormap").value = look.colormap ?? "";
}

/** Shows the quality of a picture. `awaited`: another picture is expected. */
export function show_quality(header, awaited) {
  const bar = by_id("progress");
  const size = `${header.width} \u00d7 ${header.height}`;
  if (header.moving || header.samples === 0) {
    bar.value = 0;
    set_text(by_id("quality"), `${size}, ${header.moving ? "moving" : "refining"}`);
    return;
  }
  bar.value = Math.log2(header.samples + 1) / Math.log2(header.of + 1);
  if (awaited) return;
  const done = header.samples >= header.of ? ", done" : "";
  set_text(by_id("quality"), `${size}, ${header.samples} of ${header.of} samples a pixel${done}`);
}

/** Shows a command. Lines break only between words if there is room: a line must not end within "--scene". */
export function show_command(target, text) {
  if (target.textContent === text) return;  // an unchanged text keeps the reader's selection
  const words = text === "" ? [] : text.split(" ");
  target.replaceChildren(...words.flatMap((word, i) => [i > 0 ? " " : "", element("span", "word", word)]));
}

export function show_banner(text) {
  by_id("banner").hidden = !text;
  set_text(by_id("banner"), text);
}

export function show_link(text, kind) {
  by_id("link").className = `badge ${kind}`;
  set_text(by_id("link"), text);
}
