// Keys of the whole page, except those that the focused control uses itself.

import {kModes} from "./look.js";

const kFields = "input[type=text], input[type=password], input[type=number], select, textarea";
const kPressed = "button, summary, input:not([type=range])";  // elements that Space presses

/** `does` has mode(name), reset(), play(), step(by), undo("undo" or "redo"). */
export function listen_to_keys(does) {
  addEventListener("keydown", (event) => {
    if (event.target.matches?.(kFields)) return;
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z") {
      event.preventDefault();
      does.undo(event.shiftKey ? "redo" : "undo");
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key >= "1" && event.key <= "4") does.mode(kModes[Number(event.key) - 1]);
    else if (event.key === "0") does.reset();
    else if (event.key === " " && !event.target.matches?.(kPressed)) does.play();
    else if (event.key === "[") does.step(-1);
    else if (event.key === "]") does.step(1);
    else return;
    event.preventDefault();
  });
}
