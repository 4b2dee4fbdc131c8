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

/** Sets the text only where it is another, so that a selection in it survives. */
export function set_text(target, text) {
  if (target.textContent !== text) target.textContent = text;
}

/**
 * Makes `list` show `items`, one child each, keeping the child of an item that stays: focus and pictures survive.
 * `make(item)` returns a child, `update(child, item)` fills it; `empty` is shown where there are none.
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
  if (children.length === 0) {
    const note = kept.get("empty") ?? element("li", "empty");
    note.dataset.key = "empty";
    set_text(note, empty);
    children.push(note);
  }
  const same = children.length === list.children.length && children.every((child, i) => child === list.children[i]);
  if (same) return;
  const focused = document.activeElement;
  list.replaceChildren(...children);
  if (list.contains(focused)) focused.focus({preventScroll: true});
}
