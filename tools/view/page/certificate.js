// Shows a file's certificate: bytes, rate, error, and the number of blocks of each kind.

import {element} from "./dom.js";
import * as format from "./format.js";

// Colours that people with any kind of colour vision can distinguish (Okabe and Ito).
const kColours = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#999999"];

const unit_of = (facts) => facts.certificate?.units ? ` ${facts.certificate.units}` : "";

/** Returns the range of values of a file: "0 to 12740 K". */
export const values_text = (facts) => `${facts.values.map(format.exact).join(" to ")}${unit_of(facts)}`;

export function rows(facts) {
  const extent = facts.box[1].map((hi, i) => hi - facts.box[0][i]);
  const found = [["Voxels", extent.join(" \u00d7 ")], ["Bytes", `${format.count(facts.bytes)} (${format.bytes(facts.bytes)})`]];
  const certificate = facts.certificate;
  if (!certificate) {
    found.push(["Values", values_text(facts)], ["Certificate", "none beside the file"]);
    return found;
  }
  found.push(["Rate", `${format.number(certificate.rate)} (${format.bytes(certificate.dense_bytes)} as float32)`]);
  found.push(["Values", values_text(facts)]);
  if (certificate.lossless) found.push(["Error", "none, lossless"]);
  else {
    found.push(["PSNR", certificate.psnr_db === null ? "none" : `${certificate.psnr_db.toFixed(1)} dB`]);
    found.push(["Largest error", `${format.bound(certificate.max_abs)}${unit_of(facts)}`]);
  }
  if (certificate.time) found.push(["Time", certificate.time]);
  found.push(["Source", certificate.source]);
  return found;
}

export function show_rows(list, facts) {
  list.replaceChildren(...rows(facts).flatMap(([name, value]) => [element("dt", "", name), element("dd", "", value)]));
}

export function show_kinds(root, kinds) {
  const all = kinds.reduce((sum, [, blocks]) => sum + blocks, 0);
  if (all === 0) {
    root.replaceChildren();
    return;
  }
  const strip = element("div", "strip");
  strip.setAttribute("aria-hidden", "true");
  const names = element("ul");
  kinds.forEach(([name, blocks], i) => {
    const part = element("span");
    part.style.width = `${blocks / all * 100}%`;
    part.style.background = kColours[i % kColours.length];
    strip.append(part);
    const mark = element("i");
    mark.style.background = kColours[i % kColours.length];
    names.append(element("li", "", mark, `${name} ${format.count(blocks)}`));
  });
  root.replaceChildren(strip, names);
}

/** Returns the text of a server's answer: "0.42 K \u00b1 0.01 at 1, 2, 3 (world 0.1, 0.2, 0.3)". */
export function value_text(answer, facts) {
  if (!answer.found) return "";
  const unit = unit_of(facts);
  const certificate = facts.certificate;
  let text = `${format.exact(answer.value)}${unit}`;
  if (certificate) text += certificate.lossless ? ", exact" : ` \u00b1 ${format.bound(certificate.max_abs)}`;
  if (answer.outside) text += ", outside the other file";
  else if (answer.against !== undefined) text += `, other file ${format.exact(answer.against)}`;
  text += ` at ${answer.voxel.join(", ")}`;
  if (answer.world.every((place, axis) => place === answer.voxel[axis])) return text;
  return `${text} (world ${answer.world.map((place, axis) => format.place(place, facts.voxel_size[axis])).join(", ")})`;
}
