// Values as text. Sizes are in powers of 1024, as the command prints them. What is unknown (null) is a dash.

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

/** "12.5", a number of files a minute. */
export function per_minute(value) {
  if (value === null) return kUnknown;
  return value >= 100 ? count(Math.round(value)) : value.toFixed(1);
}

export function bytes_per_s(value) {
  return value === null ? kUnknown : `${bytes(value)}/s`;
}

// Of usual sizes in plain digits, else in those or with an exponent, whichever is shorter.
function written(value) {
  const size = Math.abs(value);
  const plain = String(value);
  if (size === 0 || (size >= 1e-3 && size < 1e6)) return plain;
  const exponential = value.toExponential().replace("e+", "e");
  return exponential.length < plain.length ? exponential : plain;
}

/** Three digits, as short as they can be written: "0.0125", "4.2e-7", "125000". */
export function number(value) {
  return value === null ? kUnknown : written(Number(value.toPrecision(3)));  // JSON has no NaN and no infinity
}

// With as few digits as tell its float32 from all others.
function shortest(value) {
  let digits = 1;
  while (digits < 9 && Math.fround(Number(value.toPrecision(digits))) !== Math.fround(value)) ++digits;
  return Number(value.toPrecision(digits));
}

/** A float32 with all digits that count: "12666", "1013.2". An infinity comes as its text. */
export function exact(value) {
  if (value === null) return kUnknown;
  return typeof value === "string" ? value : written(shortest(value));
}

/** A place in the world where voxels are `spacing` wide, to a ten-thousandth of that or less. */
export function place(value, spacing) {
  const unit = 10 ** (Math.floor(Math.log10(spacing)) - 4);
  return written(Number((Math.round(value / unit) * unit).toPrecision(15)));
}

/** A float32 of a range that is `span` wide, likewise. */
export function within(value, span) {
  return span > 0 ? place(shortest(value), span) : exact(value);
}

/** Three digits of a bound, never below it. */
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

/** "3 min ago", of a Unix time. */
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

/** The text with its middle left out where it is longer than `letters`: what tells names apart stands at both ends. */
export function middle(text, letters) {
  if (text.length <= letters) return text;
  const end = Math.floor(letters * 0.45);
  return `${text.slice(0, letters - end - 1)}\u2026${text.slice(-end)}`;
}

/** Why a job is where it is; without its path, which stands beside it. */
export function reason(job) {
  const start = `${job.source}: `;
  return job.reason.startsWith(start) ? job.reason.slice(start.length) : job.reason;
}

export function state(job) {
  return job.state === "discovered" ? "not taken yet" : job.state;
}

/** "51.2 dB" of an output, or "lossless"; the background may stand where the source holds no value. */
export function quality(output) {
  if (output.lossless) return "lossless";
  if (output.psnr_db === null && output.max_error === 0) return "lossless over valid voxels";
  return output.psnr_db === null ? "no PSNR" : `${output.psnr_db.toFixed(1)} dB`;
}

export function rate(output) {
  return `rate ${Number(output.rate.toPrecision(3))}`;
}

/** "largest error 0.0012", or nothing where that is unknown. */
export function largest_error(output) {
  return output.max_error === null ? "" : `largest error ${bound(output.max_error)}`;
}

/** "values 0 to 4.2", or nothing where they are unknown. */
export function range(output) {
  return output.min === null || output.max === null ? "" : `values ${number(output.min)} to ${number(output.max)}`;
}

/** All that is known of an output, a text for each figure. */
export function output_facts(output) {
  return [bytes(output.bytes), rate(output), quality(output), largest_error(output), range(output)].filter(Boolean);
}
