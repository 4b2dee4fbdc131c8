// The camera: it orbits a point of world space. Angles are in degrees, as in a scene; vectors are [x, y, z].

export const kFov = 30;  // vertical, as in a scene
export const kSteepest = 89.9;  // largest elevation in degrees: straight above, the picture would have no up direction
const kCloser = 0.8;    // factor of the distance at which a sphere around the volume fills the picture
const kRadians = Math.PI / 180;

const add = (a, b, s = 1) => a.map((v, i) => v + s * b[i]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** Returns the middle of a file's box of voxels in world space, and half its diagonal. */
export function bounds(facts) {
  const [lo, hi] = facts.box;
  const middle = facts.origin.map((o, i) => o + facts.voxel_size[i] * ((lo[i] + hi[i]) / 2 - 0.5));
  const radius = Math.hypot(...facts.voxel_size.map((s, i) => s * (hi[i] - lo[i]))) / 2;
  return {middle, radius: radius || 1};
}

/** Returns unit vectors: from the target towards the camera, and right and up in the picture. */
function axes(look) {
  const [az, el] = [look.az * kRadians, look.el * kRadians];
  const towards = [Math.cos(el) * Math.cos(az), Math.cos(el) * Math.sin(az), Math.sin(el)];
  const right = [-Math.sin(az), Math.cos(az), 0];
  return {towards, right, up: cross(towards, right)};
}

/** Limits an elevation to the allowed range. */
export const level = (el) => Math.min(kSteepest, Math.max(-kSteepest, el));

function distance(facts, aspect) {
  return bounds(facts).radius / Math.sin(kFov / 2 * kRadians) * kCloser / Math.min(1, aspect);
}

export const target = (look, facts) => look.at ?? bounds(facts).middle;

/** Returns the camera's position for a picture with this ratio of width to height. */
export function position(look, facts, aspect) {
  return add(target(look, facts), axes(look).towards, distance(facts, aspect));
}

export function turned(look, az, el) {
  return {...look, az: ((look.az + az) % 360 + 360) % 360, el: level(look.el + el)};
}

export function zoomed(look, times) {
  return {...look, zoom: Math.min(60, Math.max(0.1, look.zoom * times))};
}

/** Moves the picture's content right and down by (x, y), shares of the picture's height. */
export function panned(look, facts, aspect, x, y) {
  const height = 2 * distance(facts, aspect) * Math.tan(kFov / 2 * kRadians) / look.zoom;
  const {right, up} = axes(look);
  return {...look, at: add(add(target(look, facts), right, -x * height), up, y * height)};
}
