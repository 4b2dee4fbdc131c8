// The WebSocket to the server: sends the newest view, and receives pictures and texts. Reconnects after a break.

const kAgain_ms = 1500;
const kView_ms = 12;  // least time between two views: a 360 Hz screen has more frames than the server takes messages
const encoder = new TextEncoder();

const hex = (text) => [...encoder.encode(text)].map((byte) => byte.toString(16).padStart(2, "0")).join("");

export class Connection {
  /** `on` has opened(), closed(), message(object), and picture(header, Blob), which returns a promise. */
  constructor(on) {
    this.on = on;
    this.socket = null;
    this.view = null;      // the view to send with the next frame of the screen
    this.waiting = false;
    this.sent = 0;         // when the last view was sent
  }

  /** Connects. `series` is this page's series; a server that shows another one refuses the connection. */
  open(token, series) {
    const protocols = ["weir.view"];
    if (token) protocols.push(`weir.token.${hex(token)}`);
    const place = new URL(`ws?series=${encodeURIComponent(series)}`, location.href);  // beside the page's own address
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

  /** Calls `ask` after a while; `ask` calls open() if the server answers. */
  retry(ask) {
    this.forget_retry();
    this.timer = setTimeout(ask, kAgain_ms);
  }

  /** Cancels a retry, because a new attempt begins now. */
  forget_retry() {
    clearTimeout(this.timer);
  }

  send(message) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  /** Sends the view with one of the next frames of the screen. Of several views before it, only the newest is sent. */
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
