// Values as text. Sizes are in powers of 1024, as the command prints them.

export function bytes(value) {
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

/** "51.2 dB" of an output, or "lossless". */
export function quality(output) {
  if (output.lossless) return "lossless";
  return output.psnr_db === null ? "no PSNR" : `${output.psnr_db.toFixed(1)} dB`;
}

export function rate(output) {
  return `rate ${Number(output.rate.toPrecision(3))}`;
}
