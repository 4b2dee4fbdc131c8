#!/usr/bin/env python3
"""How long after a key is pressed the picture of `weir view` is another: bench/view_latency.py [--weir PATH] [--size N]
[--edge N] [--presses N] [--mode MODE]

Makes a cloud of --size^3 voxels (256), serves it, opens its page in headless Chromium with a picture of --edge^2 pixels
(512), and presses an arrow key --presses times (100), each a second after the one before, or later, when that one's picture
is there.
The time is from the key's event in the page to the first picture of the new view on its canvas. Then the key is held, 30
times a second for 5 s, and pictures are counted. Browser and server share the machine's cores. Prints one JSON object.
"""
import argparse
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "tests" / "daemon" / "page"))
from webdriver import Browser  # noqa: E402

PRESS = """
    const [presses, wait] = arguments;
    const frame = document.querySelector('#frame');
    const canvas = document.querySelector('#canvas');
    let last = -1;
    const times = [];
    const moving = [];
    const press = (i) => frame.dispatchEvent(new KeyboardEvent('keydown', {key: i % 2 ? 'ArrowLeft' : 'ArrowUp', bubbles: true,
                                                                           cancelable: true}));
    return new Promise((done) => {
        let started = null;
        canvas.addEventListener('drawn', ({detail}) => {
            if (started !== null && detail.view > last) {
                times.push(performance.now() - started);
                moving.push([detail.width, detail.height]);
                started = null;
            }
            last = Math.max(last, detail.view);
        });
        const next = (i) => {
            if (started !== null) { setTimeout(() => next(i), 50); return; }
            if (i === presses) { done({times, moving}); return; }
            started = performance.now();
            press(i);
            setTimeout(() => next(i + 1), wait);
        };
        setTimeout(() => next(0), wait);
    })"""

HOLD = """
    const frame = document.querySelector('#frame');
    let pictures = 0;
    document.querySelector('#canvas').addEventListener('drawn', () => ++pictures);
    return new Promise((done) => {
        const started = performance.now();
        const timer = setInterval(() => frame.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft', bubbles: true,
                                                                                      cancelable: true})), 1000 / 30);
        setTimeout(() => {
            clearInterval(timer);
            done(pictures / (performance.now() - started) * 1000);
        }, 5000);
    })"""


def share(values, part):
    return sorted(values)[min(len(values) - 1, int(len(values) * part))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--weir", default=str(ROOT / "build" / "release" / "weir"))
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--edge", type=int, default=512)
    parser.add_argument("--presses", type=int, default=100)
    parser.add_argument("--mode", default="dvr", choices=["dvr", "path", "iso", "mip"])
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        n = given.size
        raw = os.path.join(folder, f"cloud_{n}x{n}x{n}_float32.raw")
        volume = os.path.join(folder, "cloud.nvdb")
        subprocess.run([given.weir, "sample", "cloud", "--dims", f"{n},{n},{n}", "-o", raw, "--quiet"], check=True)
        subprocess.run([given.weir, "convert", raw, "-o", volume, "--rate", "8", "--quiet"], check=True)
        os.remove(raw)
        server = subprocess.Popen([given.weir, "view", volume], stdout=subprocess.PIPE, text=True)
        try:
            url = server.stdout.readline().strip()
            with Browser(1200, 900) as browser:
                browser.set_width(1200, 900)
                browser.open(f"{url}#m={given.mode}")
                browser.wait("the page is filled", lambda: browser.visible("#main"))
                browser.script(f"""
                    const frame = document.querySelector('#frame');
                    frame.style.minHeight = 0;
                    frame.style.width = frame.style.height = '{given.edge}px';""")
                browser.wait("the picture", lambda: (browser.text("#quality") or "").startswith(
                    f"{given.edge} \u00d7 {given.edge}"), 60)
                browser.ask("POST", "/timeouts", {"script": 50_000})
                result = {"times": [], "moving": []}
                for first in range(0, given.presses, 20):
                    some = browser.script(PRESS, min(20, given.presses - first), 1000)
                    result = {key: values + some[key] for key, values in result.items()}
                held = browser.script(HOLD)
        finally:
            server.send_signal(signal.SIGINT)
            server.wait()
    times = result["times"]
    print(json.dumps({"presses": len(times), "median_ms": round(share(times, 0.5), 1), "p90_ms": round(share(times, 0.9), 1),
                      "max_ms": round(max(times), 1), "pictures_per_s_held": round(held, 1),
                      "median_size": sorted(result["moving"])[len(times) // 2], "cores": os.cpu_count(),
                      "load": os.getloadavg()[0]}))


if __name__ == "__main__":
    main()
