// Small helpers over the document.

export const by_id = (id) => document.getElementById(id);

/** element("li", "quiet", "text" or children...) */
export function element(tag, classes = "", ...content) {
  const made = document.createElement(tag);
  if (classes) made.className = classes;
  made.append(...content);
  return made;
}

export function button(text, classes, action) {
  const made = element("button", classes, text);
  made.type = "button";
  made.addEventListener("click", action);
  return made;
}

/** Sets the text only if it differs, so that a selection in it survives. */
export function set_text(target, text) {
  if (target.textContent !== text) target.textContent = text;
}

/** The first child of `parent`, at any depth, that has the class. */
export const part = (parent, name) => parent.querySelector(`.${name}`);

/** Makes `select` offer [value, text] pairs; keeps the choice if it is still offered. Returns whether it changed. */
export function offer(select, choices) {
  const offered = [...select.options].map((option) => option.value);
  if (choices.map(([value]) => value).join("\n") === offered.join("\n")) return false;
  const chosen = select.value;
  select.replaceChildren(...choices.map(([value, text]) => new Option(text, value)));
  if (choices.some(([value]) => value === chosen)) select.value = chosen;
  return select.value !== chosen;
}

/** Returns the focused element, the index of its child in the list, and its index among the child's buttons. */
function focus_in(list) {
  const focused = document.activeElement;
  const place = [...list.children].findIndex((child) => child.contains(focused));
  const buttons = place < 0 ? [] : [...list.children[place].querySelectorAll("button")];
  return {focused, place, button_place: buttons.indexOf(focused)};
}

// If the focused element is gone, the element at its place in the list gets the focus, so that keyboard users
// continue there.
function keep_focus(list, {focused, place, button_place}) {
  if (place < 0) return;
  if (list.contains(focused)) {
    focused.focus({preventScroll: true});
    return;
  }
  const buttons = list.children[Math.min(place, list.children.length - 1)]?.querySelectorAll("button") ?? [];
  (buttons[button_place] ?? buttons[0])?.focus({preventScroll: true});
}

/**
 * Makes `list` show `items`, one child each. The child of an item that stays is kept, so focus and pictures survive.
 * `make(item)` returns a child, `update(child, item)` fills it. Without items, `empty` is shown unless it is "".
 */
export function show_items(list, items, key, make, update, empty) {
  const kept = new Map([...list.children].map((child) => [child.dataset.key, child]));
  const children = items.map((item) => {
    const id = String(key(item));
    let child = kept.get(id);
    if (!child) {
      child = make(item);
      child.dataset.key = id;
    }
    update(child, item);
    return child;
  });
  if (children.length === 0 && empty) {
    const note = kept.get("empty") ?? element("li", "empty");
    note.dataset.key = "empty";
    set_text(note, empty);
    children.push(note);
  }
  const same = children.length === list.children.length && children.every((child, i) => child === list.children[i]);
  if (same) return;
  const focus = focus_in(list);
  list.replaceChildren(...children);
  keep_focus(list, focus);
}
