// What a reader of the page keeps: the picture, the scene, and the address, which says the whole look.

import {by_id, element, set_text} from "./dom.js";

const kHash_ms = 300;

/** Offers `blob` as a download of that name. */
function save(name, blob) {
  const link = element("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export class Keep {
  /** `file()`: name of what is shown; `scene()`: of the picture, as text; `hash()`: the look, for the address. */
  constructor({file, scene, hash}) {
    this.hash = hash;
    by_id("save-picture").addEventListener("click", () => {
      by_id("canvas").toBlob((blob) => save(`${file().replace(/\.nvdb$/, "")}.png`, blob));
    });
    by_id("save-scene").addEventListener("click", () => save("scene.toml", new Blob([scene()], {type: "text/plain"})));
    by_id("copy-link").addEventListener("click", () => this.copy());
  }

  /** The look is another: so is the address, where no other one comes at once. */
  soon() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.now(), kHash_ms);
  }

  now() {
    const hash = this.hash();
    history.replaceState(null, "", hash ? `#${hash}` : location.pathname + location.search);
  }

  async copy() {
    this.now();
    try {
      await navigator.clipboard.writeText(location.href);
      set_text(by_id("keep-note"), "copied");
    } catch {
      set_text(by_id("keep-note"), location.href);
    }
  }
}
