// A job's name in a list: a button that opens the job. A long name keeps its start and its end.

import {button, element} from "./dom.js";
import * as format from "./format.js";

const kLetters = 76;      // fits on two lines of a telephone
const kCardLetters = 36;  // fits on two lines of a card

/** A text of at most two lines. */
export const clamped = (text) => element("span", "clamped", text);

export function name_button(path, action, letters = kLetters) {
  const made = button("", "name", action);
  made.append(clamped(format.middle(format.base_name(path), letters)));
  made.title = path;
  return made;
}

export const card_name_button = (path, action) => name_button(path, action, kCardLetters);
