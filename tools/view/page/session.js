// The page's session with its server: asks for the server's state (and for the token if needed), checks that the
// server shows this page's series, and connects. Repeats all this after a break.

import {ApiError, get, set_token} from "./api.js";
import {Connection} from "./connection.js";
import {by_id, set_text} from "./dom.js";
import {show_banner, show_link} from "./panels.js";
import {is_own_series, series_key, show_no_viewer} from "./shown_series.js";

const kUnauthorised = 401;
const kUnavailable = 503;

export class Session {
  /**
   * `file()` returns the name of the file that this page shows, or null. `ready(state)` is called before the connection
   * with /api/state of a server that shows this series. `message` and `picture` are those of Connection.
   */
  constructor({file, ready, message, picture}) {
    Object.assign(this, {file, ready});
    this.connection = new Connection({
      opened: () => {
        show_link("connected", "good");
        show_banner("");
      },
      closed: () => {
        show_link("not connected", "bad");
        this.again();
      },
      message,
      picture,
    });
    by_id("login").addEventListener("submit", (event) => {
      event.preventDefault();
      set_token(by_id("token").value);
      by_id("token").value = "";
      this.begin();
    });
  }

  again() {
    this.connection.retry(() => this.begin());
  }

  async begin() {
    this.connection.forget_retry();
    let state;
    try {
      state = await get("api/state");
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refused(error);
      return;
    }
    by_id("login").hidden = true;
    show_banner("");
    if (!is_own_series(state, this.file())) {
      show_link("another file", "warn");
      this.again();
      return;
    }
    by_id("main").hidden = false;
    this.ready(state);
    if (state.viewers >= state.most_viewers) {
      show_link("waiting", "warn");
      show_banner(`${state.viewers} pages look already, as many as may; this one waits for one to be closed.`);
      this.again();
      return;
    }
    this.connection.open(sessionStorage.getItem("weir-token") ?? "", series_key());
  }

  refused(error) {
    if (error.status === kUnauthorised) {
      by_id("login").hidden = false;
      by_id("main").hidden = true;
      set_text(by_id("login-error"), sessionStorage.getItem("weir-token") ? error.message : "");
      show_link("token needed", "warn");
      return;
    }
    const starting = error.answer.state === "starting";
    show_link(starting ? "starting" : "not connected", starting ? "warn" : "bad");
    if (starting) show_banner("");
    else show_banner(error.status === 0 ? "The server does not answer; it may have ended." : error.message);
    if (error.status === kUnavailable) show_no_viewer(error.answer.state);
    this.again();
  }
}
