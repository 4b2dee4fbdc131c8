// The look: one plain object with everything that decides the picture. It is written to the URL, to the scene of each
// picture, and to the saved scene.

import * as camera from "./camera.js";

export const kModes = ["dvr", "path", "iso", "mip"];

/** The look at the start. null: the default of weir render. */
export const kStart = Object.freeze({
  mode: "dvr", az: 35, el: 20, zoom: 1, at: null, colormap: null, opacity: null, range: null, density: null, iso: null,
  shading: null, box: null, light: null, exposure: null, step: 0, split: null, log: true,
  file: null,  // name of a step that the address asks for; the page finds its number
});

// The light if none is chosen; the sliders start from it. Direction in degrees, strength, and strength of the sky.
export const kStartLight = Object.freeze({az: 320, el: 49, power: 2.1, sky: 0.6});
export const kStartDensity = {dvr: 200, path: 250, iso: 1, mip: 1};

const short = (value) => Number(value.toPrecision(6));
// Values and places in the world may differ little from each other, so they keep all digits.
const kExact = ["at", "range", "iso"];

const kKeys = {
  mode: "m", az: "az", el: "el", zoom: "z", at: "at", colormap: "c", opacity: "o", range: "r", density: "d", iso: "iso",
  shading: "sh", box: "b", light: "l", exposure: "e", file: "f", split: "s", log: "log",
};

/** Returns the look as the text behind a URL's #. `file` names its step; it is left out for the first step. */
export function to_hash(look, file) {
  const parts = new URLSearchParams();
  for (const [key, name] of Object.entries(kKeys)) {
    const value = key === "file" ? (look.step > 0 ? file ?? null : null) : look[key];
    if (value === null || value === kStart[key]) continue;
    const digits = kExact.includes(key) ? String : short;
    if (key === "opacity") parts.set(name, value.map((point) => point.map(short).join("_")).join(","));
    else if (key === "box") parts.set(name, value.map((ends) => ends.join("_")).join(","));
    else if (key === "light") parts.set(name, [value.az, value.el, value.power, value.sky].map(short).join(","));
    else if (Array.isArray(value)) parts.set(name, value.map(digits).join(","));
    else if (typeof value === "boolean") parts.set(name, value ? 1 : 0);
    else parts.set(name, typeof value === "number" ? digits(value) : value);
  }
  return parts.toString().replaceAll("%2C", ",");
}

const numbers = (text, count) => {
  const found = text.split(",").map(Number);
  return found.length === count && found.every(Number.isFinite) ? found : null;
};
const between = (low, high) => (text) => {
  const value = Number(text);
  return text !== "" && value >= low && value <= high ? value : undefined;
};

const kReaders = {
  mode: (text) => kModes.includes(text) ? text : undefined,
  az: between(-3600, 3600), el: between(-90, 90), zoom: between(0.1, 60), density: between(0, 1e30),
  iso: between(-3.4e38, 3.4e38), shading: between(0, 1), exposure: between(0, 1e6), file: (text) => text,
  split: between(0, 1), log: (text) => text === "1",
  at: (text) => numbers(text, 3) ?? undefined,
  colormap: (text) => /^[a-z-]+$/.test(text) ? text : undefined,
  range: (text) => {
    const ends = numbers(text, 2);
    return ends && ends[0] <= ends[1] ? ends : undefined;
  },
  opacity: (text) => {
    const points = text.split(",").map((point) => point.split("_").map(Number));
    const fine = points.length >= 2 && points.length <= 64 && points.every((p, i) => p.length === 2 &&
      p.every((v) => v >= 0 && v <= 1) && (i === 0 || p[0] >= points[i - 1][0]));
    return fine ? points : undefined;
  },
  box: (text) => {
    const ends = text.split(",").map((axis) => axis.split("_").map(Number));
    return ends.length === 3 && ends.every((e) => e.length === 2 && e.every(Number.isInteger) && e[0] < e[1]) ? ends : undefined;
  },
  light: (text) => {
    const values = numbers(text, 4);
    if (!values || values[1] < -90 || values[1] > 90 || values[2] < 0 || values[3] < 0) return undefined;
    return {az: values[0], el: values[1], power: values[2], sky: values[3]};
  },
};

/** The inverse of to_hash(). Parts that cannot be read keep their start values. */
export function from_hash(text) {
  const look = {...kStart};
  const parts = new URLSearchParams(text.replace(/^#/, ""));
  for (const [key, name] of Object.entries(kKeys)) {
    const value = parts.has(name) ? kReaders[key](parts.get(name)) : undefined;
    if (value !== undefined) look[key] = value;
  }
  look.el = camera.level(look.el);
  return look;
}

/** Returns the default iso value: 35 % of the way from the background to the value farthest from it. */
export function start_iso(facts) {
  const [low, high] = facts.range;
  const from = Math.min(high, Math.max(low, facts.background));
  const farthest = high - from >= from - low ? high : low;
  return from + 0.35 * (farthest - from);
}

// If no opacity is chosen, values this close to the background are invisible, as a share of the largest distance from
// it.
const kTransparentShare = 0.06;

/** Returns the default opacity at a position from 0 to 1 in a range, like default_opacity of gpu/scene/. */
export function start_opacity(position, [low, high], background) {
  if (low === high) {
    const end = (background < low && position === 0) || (background > high && position === 1);
    return end ? 0 : 0.5;
  }
  const from = Number.isFinite(background) ? Math.min(high, Math.max(low, background)) : low;
  const reach = Math.max(high - from, from - low);
  const distance = Math.abs(low + position * (high - low) - from) / reach;
  return Math.max(0, (distance - kTransparentShare) / (1 - kTransparentShare)) ** 1.5;
}

// Returns a number in TOML syntax: 1e20 printed in plain digits would be an integer too large for TOML.
const toml = (value) => Number.isSafeInteger(value) ? String(value) : value.toExponential();
const array = (values) => `[${values.map((value) => Array.isArray(value) ? array(value) : toml(value)).join(", ")}]`;

/** Returns the shown box of voxels, limited to the volume; null: the whole volume. */
export function shown_box(look, facts) {
  if (!look.box) return null;
  const box = look.box.map(([from, to], i) => {
    const [lo, hi] = [facts.box[0][i], facts.box[1][i]];
    const start = Math.min(Math.max(from, lo), hi - 1);
    return [start, Math.min(Math.max(to, start + 1), hi)];
  });
  return box.every(([from, to], i) => from === facts.box[0][i] && to === facts.box[1][i]) ? null : box;
}

/** Returns the scene for `weir render --scene`, for a picture with this ratio of width to height. */
export function to_scene(look, facts, aspect) {
  const lines = [`mode = "${look.mode}"`, "", "[camera]"];
  lines.push(`position = ${array(camera.position(look, facts, aspect))}`, `look_at = ${array(camera.target(look, facts))}`,
             `zoom = ${toml(look.zoom)}`, `fov = ${camera.kFov}`, 'frame = "volume"', "", "[volume]");
  lines.push(`range = ${array(look.range ?? facts.range)}`);
  if (look.colormap) lines.push(`colormap = "${look.colormap}"`);
  if (look.opacity) lines.push(`opacity = ${array(look.opacity)}`);
  if (look.density !== null) lines.push(`density = ${toml(look.density)}`);
  if (look.shading !== null) lines.push(`shading = ${toml(look.shading)}`);
  if (look.mode === "iso") lines.push(`iso = ${toml(look.iso ?? start_iso(facts))}`);
  const box = shown_box(look, facts);
  if (box) lines.push(`region = ${array(box)}`);
  if (look.exposure !== null || look.light) lines.push("", "[lighting]");
  if (look.exposure !== null) lines.push(`exposure = ${toml(look.exposure)}`);
  if (look.light) {
    const {az, el, power, sky} = look.light;
    const [a, e] = [az * Math.PI / 180, el * Math.PI / 180];
    lines.push(`ambient = ${array([sky, sky, sky])}`, "", "[[light]]");
    lines.push(`direction = ${array([Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)])}`);
    lines.push(`irradiance = ${array([power, power, power])}`);
  }
  return lines.join("\n") + "\n";
}
