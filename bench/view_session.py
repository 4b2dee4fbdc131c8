#!/usr/bin/env python3
"""Whether a long session of `weir view` keeps its memory and descriptors: bench/view_session.py [--weir PATH] [--minutes N]
[--size N] [--steps N] [--edge N] [--every SECONDS] [-- MORE OPTIONS OF weir view]

Makes a series of --steps clouds (4) of --size^3 voxels (96), serves it, and repeats for --minutes (20) what people do:
three come, turn, scrub through the steps, edit colours, opacity and mode, ask for values, let the picture be refined
for a second, and leave: by a close, by a connection that breaks, or in the middle of a picture. In between somebody
sends garbage to the socket, opens connections that say nothing, and a step is replaced by another file. A thread of its
own looks every --every seconds (30) at the server's resident bytes, those of no file among them, and its open
descriptors. Prints a line a look; at the end one JSON object with the medians of the second and of the last quarter of
the looks, which are the same where nothing leaks.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import shutil
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import threading
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parent))
from view_clients import ROOT, Viewer  # noqa: E402

MODES = ("dvr", "mip", "iso")
MAPS = ("viridis", "gray", "inferno")


class Person(Viewer):
    """A viewer that also does other things than turning."""

    def __init__(self, port, options, chance):
        super().__init__(port, options, chance.randrange(360))
        self.chance = chance
        self.step = 0
        self.look = {"mode": "dvr", "volume": ""}

    def show(self, moving):
        self.view += 1
        scene = (f'mode = "{self.look["mode"]}"\n[camera]\nframe = "volume"\nazimuth = {self.azimuth % 360}\n'
                 f'[volume]\n{self.look["volume"]}')
        self.send({"type": "view", "id": self.view, "width": self.options.edge, "height": self.options.edge,
                   "step": self.step, "moving": moving, "scene": scene})
        while self.picture() < self.view:
            pass

    def visit(self):
        for _ in range(10):
            self.azimuth += 3
            self.show(moving=True)
        for self.step in range(self.options.steps):
            self.show(moving=True)
        for _ in range(5):
            high = round(self.chance.uniform(0.2, 1), 3)
            self.look = {"mode": self.chance.choice(MODES),
                         "volume": f'colormap = "{self.chance.choice(MAPS)}"\nopacity = [[0, 0], [1, {high}]]\n'}
            self.show(moving=True)
            self.send({"type": "probe", "id": self.view, "x": 0.5, "y": 0.5})
        self.show(moving=False)
        self.refine(1)

    def leave(self):
        way = self.chance.randrange(3)
        if way == 0:
            self.send(b"\x03\xe8", 8)
        elif way == 1:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")  # breaks: a reset
        else:
            self.azimuth += 90
            self.send({"type": "view", "id": self.view + 1, "width": self.options.edge, "height": self.options.edge,
                       "step": 0, "moving": False, "scene": 'mode = "path"\n'})
        self.file.close()
        self.socket.close()


def misbehave(port, chance):
    with socket.create_connection(("127.0.0.1", port)) as one:
        one.sendall(chance.randbytes(200))
    with socket.create_connection(("127.0.0.1", port)):
        pass  # says nothing


def used(process):
    """Returns resident bytes, the anonymous part of them, and the number of descriptors."""
    with open(f"/proc/{process}/status", encoding="ascii") as file:
        fields = dict(line.split(":", 1) for line in file)
    kib = lambda name: int(fields[name].split()[0])
    return kib("VmRSS") << 10, kib("RssAnon") << 10, len(os.listdir(f"/proc/{process}/fd"))


def make(weir, folder, size, seed, name):
    raw = os.path.join(folder, f"c_{size}x{size}x{size}_float32.raw")
    subprocess.run([weir, "sample", "cloud", "--dims", f"{size},{size},{size}", "--seed", str(seed), "-o", raw, "--quiet",
                    "--overwrite"], check=True)
    subprocess.run([weir, "convert", raw, "-o", os.path.join(folder, name), "--encoding", "packed", "--rate", "8", "--quiet"],
                   check=True)
    os.remove(raw)


def replace(folder, steps, chance):
    """A step becomes what another one was made as, by a rename."""
    copy = os.path.join(folder, "copy")
    shutil.copy(os.path.join(folder, f"spare_{chance.randrange(2)}.nvdb"), copy)
    os.rename(copy, os.path.join(folder, "s", f"s_{chance.randrange(steps)}.nvdb"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--weir", default=str(ROOT / "build/release/weir"))
    parser.add_argument("--minutes", type=float, default=20)
    parser.add_argument("--size", type=int, default=96)
    parser.add_argument("--steps", type=int, default=4)
    parser.add_argument("--edge", type=int, default=256)
    parser.add_argument("--every", type=float, default=30)
    at = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    options = parser.parse_args(sys.argv[1:at])
    chance = random.Random(1)
    with tempfile.TemporaryDirectory() as folder:
        os.mkdir(os.path.join(folder, "s"))
        for step in range(options.steps):
            make(options.weir, folder, options.size, step, f"s/s_{step}.nvdb")
        for spare in range(2):
            make(options.weir, folder, options.size, 100 + spare, f"spare_{spare}.nvdb")
        server = subprocess.Popen([options.weir, "view", os.path.join(folder, "s"), "--listen", "127.0.0.1:0",
                                   *sys.argv[at + 1:]], stdout=subprocess.PIPE, text=True)
        looks = []
        over = threading.Event()

        def watch():
            begun = time.monotonic()
            while not over.wait(options.every):
                resident, anonymous, descriptors = used(server.pid)
                looks.append((resident, anonymous, descriptors))
                print(f"{time.monotonic() - begun:7.0f} s  {resident / 2**20:7.1f} MiB resident  {anonymous / 2**20:7.1f} MiB "
                      f"of no file  {descriptors} descriptors  {visits} visits", flush=True)

        visits = 0
        watcher = threading.Thread(target=watch)
        try:
            port = int(server.stdout.readline().rsplit(":", 1)[1].strip(" /\n"))
            watcher.start()
            end = time.monotonic() + 60 * options.minutes
            while time.monotonic() < end:
                people = [Person(port, options, chance) for _ in range(3)]
                # All visit at once: the server drops a viewer that answers no ping because it waits for another one.
                with concurrent.futures.ThreadPoolExecutor(len(people)) as pool:
                    list(pool.map(Person.visit, people))
                misbehave(port, chance)
                replace(folder, options.steps, chance)
                for person in people:
                    person.leave()
                visits += len(people)
        finally:
            over.set()
            if watcher.is_alive():
                watcher.join()
            server.send_signal(signal.SIGINT)
            ended = server.wait()
    quarter = max(1, len(looks) // 4)
    median = lambda part, i: statistics.median(look[i] for look in part) if part else None
    early, late = looks[quarter:2 * quarter], looks[-quarter:]
    print(json.dumps({"minutes": options.minutes, "visits": visits, "exit_code": ended, "looks": len(looks),
                      **{name: {"early": median(early, i), "late": median(late, i), "most": max((l[i] for l in looks), default=None)}
                         for i, name in enumerate(("resident_bytes", "anonymous_bytes", "descriptors"))}}))


if __name__ == "__main__":
    main()
