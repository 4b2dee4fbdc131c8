// Files for the reader of the page to keep.

import {element} from "./dom.js";

/** Offers `blob` as a download of that name. */
export function save(name, blob) {
  const link = element("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
