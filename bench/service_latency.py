#!/usr/bin/env python3
"""How long `weir watch` takes to answer.

    bench/service_latency.py [WEIR]     default: build/release/weir

1. 50 clients ask for the status and the latest jobs, one request after the other, while conversions run.
2. /healthz is asked every 5 ms while 5,000 quarantined jobs are tried again, on a disk whose every flush takes 10 ms (a
   library put before the system's, built with cc).

Prints the 50th and 99th percentile and the largest time of each, in ms. Exit code 1 where the 99th percentile of the first is
300 ms or more, or the largest of the second 50 ms or more: figures of an idle machine of two cores.
"""

import http.client
import json
import os
import subprocess
import sys
import tempfile
import threading
import time

CLIENTS, SECONDS, JOBS = 50, 10, 5000
SLOW_FLUSH = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <time.h>
static int slow(const char* name, int file) {
  struct timespec ten_ms = {0, 10000000};
  nanosleep(&ten_ms, 0);
  return ((int (*)(int))dlsym(RTLD_NEXT, name))(file);
}
int fsync(int file) { return slow("fsync", file); }
int fdatasync(int file) { return slow("fdatasync", file); }
"""


class Service:
    """A `weir watch` over DIRECTORY/in."""

    def __init__(self, weir, directory, environment=None):
        os.makedirs(f"{directory}/in", exist_ok=True)
        with open(f"{directory}/weir.toml", "w") as file:
            file.write('[service]\nlisten = "127.0.0.1:0"\nport_file = "port"\nlog = "log"\njobs = 2\nthreads = 1\n'
                       '[[watch]]\ndirectory = "in"\noutput = "out"\nsettle = 0.2\nthumbnails = false\n')
        self.process = subprocess.Popen([weir, "watch", f"{directory}/weir.toml"], env=environment)
        while not os.path.exists(f"{directory}/port"):
            time.sleep(0.02)
        self.port = int(open(f"{directory}/port").read())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()

    def connect(self):
        return http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)

    def ask(self, target, method="GET", connection=None):
        connection = connection or self.connect()
        connection.request(method, target, headers={"X-Weir": "bench"})
        answer = connection.getresponse()
        body = answer.read()
        if answer.status != 200:
            raise RuntimeError(f"{target}: {answer.status}")
        return body

    def count(self, state):
        return json.loads(self.ask(f"/api/jobs?state={state}&limit=1"))["total"]

    def wait_for(self, state, count):
        while self.count(state) != count:
            time.sleep(0.1)


def figures(what, seconds):
    times = sorted(1000 * s for s in seconds)
    p50, p99, most = times[len(times) // 2], times[len(times) * 99 // 100], times[-1]
    print(f"{what}: {len(times)} requests, p50 {p50:.1f} ms, p99 {p99:.1f} ms, largest {most:.1f} ms")
    return p99, most


def while_converting(weir, directory):
    sample = f"{directory}/cloud_192x192x192_float32.raw"
    subprocess.run([weir, "sample", "cloud", "--dims", "192,192,192", "-o", sample, "--progress", "never"], check=True)
    with Service(weir, directory) as service:
        for i in range(400):  # more than are converted meanwhile
            os.link(sample, f"{directory}/in/v{i}_192x192x192_float32.raw")
        while service.count("done") < 2:
            time.sleep(0.1)
        taken, end = [], time.monotonic() + SECONDS

        def client():
            connection, own = service.connect(), []
            while time.monotonic() < end:
                for target in ("/api/status", "/api/jobs?state=done&limit=12"):
                    begin = time.monotonic()
                    service.ask(target, connection=connection)
                    own.append(time.monotonic() - begin)
            taken.extend(own)

        clients = [threading.Thread(target=client) for _ in range(CLIENTS)]
        for thread in clients:
            thread.start()
        for thread in clients:
            thread.join()
        if service.count("waiting") == 0:
            raise RuntimeError("nothing was left to convert")
        return figures(f"{CLIENTS} clients while 2 conversions run", taken)[0]


def while_retrying(weir, directory):
    with open(f"{directory}/slow.c", "w") as file:
        file.write(SLOW_FLUSH)
    subprocess.run(["cc", "-shared", "-fPIC", "-o", f"{directory}/slow.so", f"{directory}/slow.c", "-ldl"], check=True)
    os.makedirs(f"{directory}/in")
    for i in range(JOBS):
        with open(f"{directory}/in/cut{i}_16x16x16_uint8.raw", "wb") as file:
            file.write(b"cut")
    with Service(weir, directory, {**os.environ, "LD_PRELOAD": f"{directory}/slow.so"}) as service:
        service.wait_for("quarantined", JOBS)
        over, taken = threading.Event(), []

        def look():
            connection = service.connect()
            while not over.is_set():
                begin = time.monotonic()
                service.ask("/healthz", connection=connection)
                taken.append(time.monotonic() - begin)
                time.sleep(0.005)

        looking = threading.Thread(target=look)
        looking.start()
        time.sleep(0.2)
        begin = time.monotonic()
        retried = json.loads(service.ask("/api/retry-failed", "POST"))["retried"]
        answered = time.monotonic() - begin
        service.wait_for("quarantined", JOBS)
        over.set()
        looking.join()
        print(f"{retried} jobs tried again: answered after {1000 * answered:.0f} ms, all looked at after "
              f"{time.monotonic() - begin:.1f} s")
        return figures("/healthz meanwhile", taken)[1]


def main():
    weir = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "build/release/weir")
    with tempfile.TemporaryDirectory(dir=os.environ.get("TMPDIR", "/var/tmp")) as one:
        p99 = while_converting(weir, one)
    with tempfile.TemporaryDirectory(dir=os.environ.get("TMPDIR", "/var/tmp")) as two:
        most = while_retrying(weir, two)
    sys.exit(0 if p99 < 300 and most < 50 else 1)


main()
