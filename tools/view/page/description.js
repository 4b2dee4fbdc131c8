// Describes the picture in words, for people who cannot see it.

import {values_text} from "./certificate.js";
import * as format from "./format.js";

const kModes = {dvr: "Volume", path: "Path tracing", iso: "Surface", mip: "Maximum"};

/** "Volume of a.nvdb, 64 × 64 × 64 voxels with values from 0 to 1, seen from 35° around and 20° above, ..." */
export function picture_text(look, facts, box) {
  const extent = facts.box[1].map((hi, i) => hi - facts.box[0][i]).join(" \u00d7 ");
  const unit = facts.certificate?.units ? ` ${facts.certificate.units}` : "";
  const parts = [`${kModes[look.mode]} of ${facts.file}, ${extent} voxels with values from ${values_text(facts)}`];
  parts.push(`seen from ${Math.round(look.az)}\u00b0 around and ${Math.round(look.el)}\u00b0 above, ${format.number(look.zoom)} times`);
  if (box) parts.push(`only the box ${box.map((ends) => ends.join(" to ")).join(", ")}`);
  const certificate = facts.certificate;
  if (certificate?.lossless) parts.push("without error");
  else if (certificate) {
    const psnr = certificate.psnr_db === null ? "" : `PSNR ${certificate.psnr_db.toFixed(1)} dB, `;
    parts.push(`${psnr}largest error ${format.bound(certificate.max_abs)}${unit}`);
  }
  return `${parts.join(", ")}.`;
}
