"""A web server on loopback that answers range requests and records them."""

import contextlib
import http.server
import re
import threading
import time


class QuietServer(http.server.ThreadingHTTPServer):
    def handle_error(self, request, client_address):
        pass  # the client closed the connection before the end of the answer


class RangeServer:
    """Serves `files`, {"/a.nvdb": bytes}. `asked` has (path, first byte, last byte) of each range that was sent.

    ranges: whether it knows ranges. tags: whether it tells versions apart. failures: how many requests it refuses
    with status 503 from now on. weak: whether its tags are weak. cut: how many answers end in the middle from now on.
    beyond: whether answers go on to the file's end. stalled: while it is set, no request is answered. coding: the
    Content-Encoding that it claims. moved: where it redirects a path to, with a body of 64 MiB; wasted: bytes of
    these that were sent. needs: headers without which it answers 401; headers: those of the last request.
    dated: the Last-Modified of all answers. changed(path) makes another version of a file of it.
    """

    def __init__(self, files, ranges=True, tags=True, weak=False, dated=None):
        self.files = dict(files)
        self.ranges = ranges
        self.tags = tags
        self.weak = weak
        self.dated = dated
        self.failures = 0
        self.cut = 0
        self.beyond = False
        self.stalled = threading.Event()
        self.forbidden = set()
        self.coding = None
        self.moved = {}
        self.wasted = 0
        self.needs = {}
        self.headers = {}
        self.versions = dict.fromkeys(files, 1)
        self.asked = []
        self.lock = threading.Lock()
        self.server = QuietServer(("127.0.0.1", 0), self.handler())
        self.thread = threading.Thread(target=self.server.serve_forever, args=(0.02,), daemon=True)  # shutdown waits so long
        self.thread.start()

    def url(self, path):
        return f"http://127.0.0.1:{self.server.server_port}{path}"

    def close(self):
        self.stalled.clear()
        self.server.shutdown()
        self.server.server_close()
        self.thread.join()

    def changed(self, path, data):
        self.files[path] = data
        self.versions[path] += 1

    def bytes_sent(self):
        return sum(last - first + 1 for _, first, last in self.asked)

    def handler(owner):
        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def log_message(self, *arguments):
                pass

            def answer(self, status, body=b"", **headers):
                self.send_response(status)
                for name, value in headers.items():
                    self.send_header(name.replace("_", "-"), value)
                self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def break_off(self, head, body):
                """Sends half of an answer."""
                owner.cut -= 1
                self.close_connection = True
                self.wfile.write(f"HTTP/1.1 {head}\r\nContent-Length: {len(body)}\r\n\r\n".encode() + body[: len(body) // 2])

            def redirect(self, place):
                self.close_connection = True
                self.send_response(302)
                self.send_header("Location", place)
                self.end_headers()
                with contextlib.suppress(OSError):  # the client may close the connection before the end
                    for _ in range(1024):
                        self.wfile.write(bytes(1 << 16))
                        owner.wasted += 1 << 16

            def do_GET(self):
                path = self.path.partition("?")[0]
                while owner.stalled.is_set():
                    time.sleep(0.01)
                owner.headers = dict(self.headers)
                if path in owner.moved:
                    return self.redirect(owner.moved[path])
                with owner.lock:
                    if any(self.headers.get(name) != text for name, text in owner.needs.items()):
                        return self.answer(401)
                    if owner.failures > 0:
                        owner.failures -= 1
                        return self.answer(503)
                    if path in owner.forbidden:
                        return self.answer(403)
                    data = owner.files.get(path)
                    if data is None:
                        return self.answer(404)
                    tag = f'"{owner.versions[path]}"'
                    found = re.fullmatch(r"bytes=(\d+)-(\d+)", self.headers.get("Range", ""))
                    same = self.headers.get("If-Range", tag) == tag  # a weak tag never matches
                    headers = {"ETag": f"W/{tag}" if owner.weak else tag} if owner.tags else {}
                    if owner.dated is not None:
                        headers["Last_Modified"] = owner.dated
                    if owner.coding is not None:
                        headers["Content_Encoding"] = owner.coding
                    if not found or not owner.ranges or not same:
                        if owner.cut > 0:
                            return self.break_off("200 OK", data)
                        return self.answer(200, data, **headers)
                    first, last = int(found[1]), len(data) - 1 if owner.beyond else min(int(found[2]), len(data) - 1)
                    if first >= len(data):
                        return self.answer(416)
                    if owner.cut > 0:
                        said = f"bytes {first}-{last}/{len(data)}"
                        return self.break_off(f"206 Partial Content\r\nContent-Range: {said}", data[first : last + 1])
                    owner.asked.append((path, first, last))
                return self.answer(206, data[first : last + 1], Content_Range=f"bytes {first}-{last}/{len(data)}", **headers)

        return Handler
