// The WebSocket to the server: the newest view goes out, pictures and texts come in; after a break it comes back.

const kAgain_ms = 1500;
const kView_ms = 12;  // between two views, at least: a screen of 360 Hz has more frames than the server takes messages
const encoder = new TextEncoder();

const hex = (text) => [...encoder.encode(text)].map((byte) => byte.toString(16).padStart(2, "0")).join("");

export class Connection {
  /** `on`: opened(), closed(), message(object), picture(header, Blob), which returns a promise. */
  constructor(on) {
    this.on = on;
    this.socket = null;
    this.view = null;      // that waits for the next frame of the screen
    this.waiting = false;
    this.sent = 0;         // when the last view went out
  }

  /** `series`: the only one that this page is of; a server of another one refuses. */
  open(token, series) {
    const protocols = ["weir.view"];
    if (token) protocols.push(`weir.token.${hex(token)}`);
    const place = new URL(`ws?series=${encodeURIComponent(series)}`, location.href);  // beside the page, wherever that is
    place.protocol = location.protocol === "https:" ? "wss" : "ws";
    place.hash = "";
    const socket = new WebSocket(place, protocols);
    socket.binaryType = "arraybuffer";
    const before = this.socket;
    this.socket = socket;
    before?.close();
    socket.addEventListener("open", () => this.on.opened());
    socket.addEventListener("message", (event) => this.receive(socket, event.data));
    socket.addEventListener("close", () => {
      if (this.socket !== socket) return;
      this.socket = null;
      this.on.closed();
    });
  }

  /** Tries again after a while, by `ask`, which calls open() where the server answers. */
  retry(ask) {
    this.forget_retry();
    this.timer = setTimeout(ask, kAgain_ms);
  }

  /** It is tried now. */
  forget_retry() {
    clearTimeout(this.timer);
  }

  send(message) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  /** Sends the view with a frame of the screen that comes soon, only the newest of those that come before it. */
  show(view) {
    this.view = view;
    if (this.waiting) return;
    this.waiting = true;
    const send = (now) => {
      if (now - this.sent < kView_ms) {
        requestAnimationFrame(send);
        return;
      }
      this.waiting = false;
      this.sent = now;
      this.send(this.view);
    };
    requestAnimationFrame(send);
  }

  async receive(socket, data) {
    if (typeof data === "string") {
      this.on.message(JSON.parse(data));
      return;
    }
    const length = new DataView(data).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    try {
      await this.on.picture(header, new Blob([new Uint8Array(data, 4 + length)], {type: `image/${header.format}`}));
    } finally {
      if (this.socket === socket) this.send({type: "shown", frame: header.frame});
    }
  }
}
