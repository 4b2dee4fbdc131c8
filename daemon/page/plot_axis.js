// Axes of plots: at which share of the height a value lies, and where the round numbers are.

const kTicks = 3;  // intervals between ticks, about

/** Returns the smallest of 1, 2, 5 or 10 times a power of ten that is not less than `width`. */
function round_width(width) {
  const power = 10 ** Math.floor(Math.log10(width));
  return power * [1, 2, 5, 10].find((times) => times * power >= width * 0.999);
}

function tick_text(value, width) {
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e5 || width < 1e-4)) return Number(value.toPrecision(6)).toExponential().replace("e+", "e");
  return value.toFixed(Math.max(0, -Math.floor(Math.log10(width) + 0.001)));
}

/** Returns a linear axis from a round number below all `lows` to one above all `highs`. */
export function linear_axis(lows, highs) {
  let low = lows.reduce((a, b) => Math.min(a, b));
  let high = highs.reduce((a, b) => Math.max(a, b));
  if (high <= low) {  // all values are equal
    const around = Math.abs(low) * 0.1 || 1;
    low -= around;
    high += around;
  }
  const width = round_width((high - low) / kTicks);
  const first = Math.floor(low / width + 1e-9);
  const last = Math.ceil(high / width - 1e-9);
  const ticks = [];
  for (let i = first; i <= last; ++i) ticks.push({value: i * width, text: tick_text(i * width, width)});
  return {is_log: false, ticks, share: (value) => (value - first * width) / ((last - first) * width)};
}

/** Returns a logarithmic axis between powers of ten around values that are all greater than 0. */
export function log_axis(lows, highs) {
  const first = Math.floor(Math.log10(lows.reduce((a, b) => Math.min(a, b))) + 1e-9);
  const last = Math.ceil(Math.log10(highs.reduce((a, b) => Math.max(a, b))) - 1e-9);
  const every = Math.ceil((last - first) / 4);
  const ticks = [];
  for (let power = first; power <= last; power += every) ticks.push({value: 10 ** power, text: `1e${power}`});
  return {is_log: true, ticks, share: (value) => (Math.log10(value) - first) / (last - first)};
}

/** Returns about `room` round step numbers from 1 to `steps`, with 1 as the first. */
export function round_steps(steps, room) {
  const every = steps <= room ? 1 : Math.max(1, Math.round(round_width(steps / room)));
  const numbers = [1];
  for (let number = every; number <= steps; number += every) {
    if (number > 1 + every / 2 || every === 1 && number > 1) numbers.push(number);
  }
  return numbers;
}
