// What a reader can save: the picture, the scene, and the address, which contains the whole look.

import {by_id, element, set_text} from "./dom.js";

const kHash_ms = 300;

/** Offers `blob` as a download with this name. */
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
  /** `file()` returns the shown file's name, `scene()` the picture's scene, `hash()` the look for the address. */
  constructor({file, scene, hash}) {
    this.hash = hash;
    by_id("save-picture").addEventListener("click", () => {
      by_id("canvas").toBlob((blob) => save(`${file().replace(/\.nvdb$/, "")}.png`, blob));
    });
    by_id("save-scene").addEventListener("click", () => save("scene.toml", new Blob([scene()], {type: "text/plain"})));
    by_id("copy-link").addEventListener("click", () => this.copy());
  }

  /** Updates the address after a change of the look, unless another change follows at once. */
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
