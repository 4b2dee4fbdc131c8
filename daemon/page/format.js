// Values as text. Sizes are in powers of 1024, as the command prints them. An unknown value (null) is a dash.

const kUnknown = "\u2013";

export function bytes(value) {
  if (value === null) return kUnknown;
  const units = ["B", "KiB", "MiB", "GiB", "TiB", "PiB"];
  let unit = 0;
  while (value >= 1024 && unit < units.length - 1) {
    value /= 1024;
    ++unit;
  }
  return `${unit === 0 ? Math.round(value) : value.toFixed(1)} ${units[unit]}`;
}

export function seconds(value) {
  if (value < 10) return `${value.toFixed(1)} s`;
  if (value < 120) return `${Math.round(value)} s`;
  if (value < 7200) return `${Math.round(value / 60)} min`;
  if (value < 172800) return `${Math.round(value / 3600)} h`;
  return `${Math.round(value / 86400)} days`;
}

/** Returns a number of files per minute: "12.5". */
export function per_minute(value) {
  if (value === null) return kUnknown;
  return value >= 100 ? count(Math.round(value)) : value.toFixed(1);
}

export function bytes_per_s(value) {
  return value === null ? kUnknown : `${bytes(value)}/s`;
}

// Values of usual size are in plain digits; others are in plain digits or with an exponent, whichever is shorter.
function written(value) {
  const size = Math.abs(value);
  const plain = String(value);
  if (size === 0 || (size >= 1e-3 && size < 1e6)) return plain;
  const exponential = value.toExponential().replace("e+", "e");
  return exponential.length < plain.length ? exponential : plain;
}

/** Returns three digits in their shortest form: "0.0125", "4.2e-7", "125000". */
export function number(value) {
  return value === null ? kUnknown : written(Number(value.toPrecision(3)));  // JSON has no NaN and no infinity
}

// Returns the value with the fewest digits that still identify its float32.
function shortest(value) {
  let digits = 1;
  while (digits < 9 && Math.fround(Number(value.toPrecision(digits))) !== Math.fround(value)) ++digits;
  return Number(value.toPrecision(digits));
}

/** Returns a float32 with all significant digits: "12666", "1013.2". An infinity is a text already. */
export function exact(value) {
  if (value === null) return kUnknown;
  return typeof value === "string" ? value : written(shortest(value));
}

/** Returns a world coordinate, rounded to a ten-thousandth of the voxel width `spacing` or less. */
export function place(value, spacing) {
  const unit = 10 ** (Math.floor(Math.log10(spacing)) - 4);
  return written(Number((Math.round(value / unit) * unit).toPrecision(15)));
}

/** Returns a float32 of a range of width `span`, rounded to a ten-thousandth of the width or less. */
export function within(value, span) {
  return span > 0 ? place(shortest(value), span) : exact(value);
}

/** Returns three digits of an upper bound, rounded up. */
export function bound(value) {
  if (value === null) return kUnknown;
  const short = Number(value.toPrecision(3));
  if (short >= value) return written(short);
  const [digits, power] = short.toExponential(2).split("e");
  return written(Number(`${(Number(digits) + 0.01).toFixed(2)}e${power}`));
}

export function count(value) {
  return value.toLocaleString("en").replaceAll(",", "\u202f");
}

/** Returns how long ago a Unix time was: "3 min ago". */
export function ago(time) {
  const passed = Date.now() / 1000 - time;
  return passed < 2 ? "just now" : `${seconds(Math.floor(passed)).replace(".0", "")} ago`;
}

export function date(time) {
  return new Date(time * 1000).toLocaleString();
}

export function base_name(path) {
  return path.slice(path.lastIndexOf("/") + 1);
}

/** Shortens a text to `letters` by leaving out its middle, because names differ at their beginning and their end. */
export function middle(text, letters) {
  if (text.length <= letters) return text;
  const end = Math.floor(letters * 0.45);
  return `${text.slice(0, letters - end - 1)}\u2026${text.slice(-end)}`;
}

/** Returns the reason of a job's state without its path, which the page shows beside it. */
export function reason(job) {
  const start = `${job.source}: `;
  return job.reason.startsWith(start) ? job.reason.slice(start.length) : job.reason;
}

export function state(job) {
  return job.state === "discovered" ? "not taken yet" : job.state;
}

/** Returns "51.2 dB" or "lossless". Without a value in the source, a voxel may hold the background: "valid voxels". */
export function quality(output) {
  if (output.lossless) return "lossless";
  if (output.psnr_db === null && output.max_error === 0) return "lossless over valid voxels";
  return output.psnr_db === null ? "no PSNR" : `${output.psnr_db.toFixed(1)} dB`;
}

export function rate(output) {
  return `rate ${Number(output.rate.toPrecision(3))}`;
}

/** Returns "largest error 0.0012", or "" if it is unknown. */
export function largest_error(output) {
  return output.max_error === null ? "" : `largest error ${bound(output.max_error)}`;
}

/** Returns "values 0 to 4.2", or "" if they are unknown. */
export function range(output) {
  return output.min === null || output.max === null ? "" : `values ${number(output.min)} to ${number(output.max)}`;
}

/** Returns all known figures of an output, one text each. */
export function output_facts(output) {
  return [bytes(output.bytes), rate(output), quality(output), largest_error(output), range(output)].filter(Boolean);
}
