// A path with a button that copies it.

import {button, element, part, set_text} from "./dom.js";

const kNote_ms = 2000;

function select(text) {
  const range = document.createRange();
  range.selectNodeContents(text);
  const selection = getSelection();
  selection.removeAllRanges();
  selection.addRange(range);
}

// A page may write to the clipboard only in a secure context (https, or localhost). Otherwise the text is selected,
// so that the reader can copy it.
async function copy(text, note) {
  try {
    await navigator.clipboard.writeText(text.textContent);
    set_text(note, "copied");
  } catch {
    select(text);
    set_text(note, "Select and copy: it is selected now.");
    return;
  }
  setTimeout(() => set_text(note, ""), kNote_ms);
}

/** Shows another path in an element that path_with_copy() made. */
export function show_path(shown, path) {
  set_text(part(shown, "path"), path);
  set_text(part(shown, "copy-note"), "");
}

/** Returns the path with a copy button. `what` names the path for screen readers, which announce only the button. */
export function path_with_copy(path, what) {
  const text = element("span", "path", path);
  const note = element("span", "copy-note quiet");
  note.setAttribute("role", "status");
  const copier = button("Copy", "copy", () => copy(text, note));
  copier.setAttribute("aria-label", `Copy the path of the ${what}`);
  return element("div", "copied-path", text, copier, note);
}
