#!/usr/bin/env python3
"""How fast `weir view` answers several viewers at once: bench/view_clients.py FILE.nvdb [--weir PATH] [--clients N]
[--mode MODE] [--edge N] [--seconds N] [-- MORE OPTIONS OF weir view]

Serves FILE, and connects --clients viewers (10), each with a camera of its own and pictures of --edge^2 pixels (512), by the
messages of docs/view.md; nothing beyond Python's standard library. First one viewer alone turns 20 times, each time after a
second of rest: the time from the message to the first picture of the new view. Then all turn without rest for --seconds (10),
each as soon as it has a picture: pictures a second of each. Pictures are received, not decoded. Prints one JSON object.
"""
import argparse
import base64
import json
import os
import pathlib
import select
import signal
import socket
import statistics
import struct
import subprocess
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10


class Viewer:
    """One WebSocket connection (RFC 6455) that turns its own camera."""

    def __init__(self, port, options, azimuth):
        self.options = options
        self.azimuth = azimuth
        self.view = 0
        self.socket = socket.create_connection(("127.0.0.1", port))
        self.file = self.socket.makefile("rb")
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                            f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n".encode())
        status = self.file.readline()
        if b" 101 " not in status:
            raise OSError(f"weir view answers {status.decode().strip()}")
        while self.file.readline() not in (b"\r\n", b""):
            pass

    def send(self, message, opcode=TEXT):
        payload = message if isinstance(message, bytes) else json.dumps(message).encode()
        length = len(payload)
        head = bytes([0x80 | opcode]) + (bytes([0x80 | length]) if length < 126 else
                                         bytes([0x80 | 126]) + struct.pack(">H", length))
        mask = os.urandom(4)
        self.socket.sendall(head + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(payload)))

    def receive(self):
        """Returns the next message: opcode and bytes."""
        whole = b""
        while True:
            first, second = self.file.read(2)
            length = second & 127
            if length == 126:
                length, = struct.unpack(">H", self.file.read(2))
            elif length == 127:
                length, = struct.unpack(">Q", self.file.read(8))
            payload = self.file.read(length)
            opcode = first & 15
            if opcode == PING:
                self.send(payload, PONG)
            elif opcode == CLOSE:
                raise OSError("weir view has closed the connection")
            elif opcode != PONG:
                whole += payload
                kind = opcode or kind
                if first & 128:
                    return kind, whole

    def turn(self, moving):
        """Asks for another view. Returns when the view's first picture has arrived."""
        self.view += 1
        self.azimuth += 3
        self.send({"type": "view", "id": self.view, "width": self.options.edge, "height": self.options.edge, "step": 0,
                   "moving": moving,
                   "scene": f'mode = "{self.options.mode}"\n[camera]\nframe = "volume"\nazimuth = {self.azimuth % 360}\n'})
        while self.picture() < self.view:
            pass

    def picture(self):
        """Receives one picture. Returns the picture's view."""
        while True:
            kind, message = self.receive()
            if kind == BINARY:
                length, = struct.unpack("<I", message[:4])
                header = json.loads(message[4:4 + length])
                self.send({"type": "shown", "frame": header["frame"]})
                return header["view"]

    def rest(self, seconds):
        """Turns, and lets the view be refined."""
        self.turn(moving=False)
        self.refine(seconds)

    def refine(self, seconds):
        """Receives the pictures that arrive within that time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if select.select([self.socket], [], [], 0.05)[0]:
                self.picture()


def latency(viewer):
    seconds = []
    for _ in range(20):
        viewer.rest(1)
        begun = time.monotonic()
        viewer.turn(moving=True)
        seconds.append(1000 * (time.monotonic() - begun))
    return seconds


def rates(viewers, seconds):
    """Returns the pictures per second of each client while all clients turn."""
    counts = [0] * len(viewers)
    end = time.monotonic() + seconds

    def run(i):
        while time.monotonic() < end:
            viewers[i].turn(moving=True)
            counts[i] += 1

    threads = [threading.Thread(target=run, args=(i,)) for i in range(len(viewers))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return [count / seconds for count in counts]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("--weir", default=str(ROOT / "build/release/weir"))
    parser.add_argument("--clients", type=int, default=10)
    parser.add_argument("--mode", default="dvr")
    parser.add_argument("--edge", type=int, default=512)
    parser.add_argument("--seconds", type=float, default=10)
    at = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    options = parser.parse_args(sys.argv[1:at])
    server = subprocess.Popen([options.weir, "view", options.file, "--listen", "127.0.0.1:0", "--viewers", str(options.clients),
                               *sys.argv[at + 1:]],
                              stdout=subprocess.PIPE, text=True)
    try:
        line = server.stdout.readline()
        if "http://127.0.0.1:" not in line:
            sys.exit(f"weir view says no address: {line!r}")
        port = int(line.split("http://127.0.0.1:")[1].split("/")[0].strip())
        first = Viewer(port, options, 0)
        first.turn(moving=True)
        alone = latency(first)
        viewers = [first] + [Viewer(port, options, 36 * i) for i in range(1, options.clients)]
        each = rates(viewers, options.seconds)
        print(json.dumps({"file": options.file, "mode": options.mode, "edge": options.edge, "clients": options.clients,
                          "latency_ms": {"median": round(statistics.median(alone), 1), "worst": round(max(alone), 1)},
                          "pictures_per_s": {"least": round(min(each), 1), "mean": round(statistics.mean(each), 1),
                                             "most": round(max(each), 1)}}))
    finally:
        server.send_signal(signal.SIGINT)
        server.wait()


if __name__ == "__main__":
    main()
