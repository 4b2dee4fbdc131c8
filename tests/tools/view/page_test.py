"""page_test.py CASE DIRECTORY WEIR ARGUMENT...: runs one test of the page of `WEIR view ARGUMENT...` in headless
Chromium. Writes screenshots to WEIR_PAGE_SCREENSHOTS if that is set. Exits with 0 if the test passes."""

import base64
import json
import math
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "daemon" / "page"))
from webdriver import Browser  # noqa: E402

case, directory, weir = sys.argv[1:4]
arguments = sys.argv[4:]
pictures = os.environ.get("WEIR_PAGE_SCREENSHOTS")


def equal(found, expected):
    assert found == expected, f"found {found!r}, expected {expected!r}"


def picture(browser, name):
    if pictures:
        browser.screenshot(os.path.join(pictures, name + ".png"))


class Server:
    def __enter__(self):
        self.process = subprocess.Popen([weir, "view", *arguments], stdout=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/", self.url), self.url
        return self.url

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        equal(self.process.wait(20), 0)


def watch_frames(browser):
    """Collects in window.drawn the headers of all pictures that the page draws."""
    browser.script("""
        window.drawn = [];
        document.querySelector('#canvas').addEventListener('drawn', (event) => window.drawn.push(event.detail))""")


def frames(browser):
    return browser.script("return window.drawn")


def converged(browser):
    return browser.wait("the picture is done", lambda: (browser.text("#quality") or "").endswith(", done"), 60)


def loaded(browser, url):
    browser.open(url)
    browser.wait("the page is filled", lambda: browser.visible("#main"))
    converged(browser)


def canvas_bytes(browser):
    return browser.script("return document.querySelector('#canvas').toDataURL('image/png')")


def pixels(browser):
    """Returns the pixels of the whole canvas as one flat list of bytes: r, g, b, a of each pixel."""
    return browser.script("""
        const canvas = document.querySelector('#canvas');
        return [...canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data]""")


def drag(browser, selector, dx, dy, steps=8):
    browser.script("""
        const [selector, dx, dy, steps] = arguments;
        const target = document.querySelector(selector);
        const box = target.getBoundingClientRect();
        const [x, y] = [box.left + box.width / 2, box.top + box.height / 2];
        const send = (type, i) => target.dispatchEvent(new PointerEvent(type, {
            bubbles: true, cancelable: true, pointerId: 1, pointerType: 'mouse', button: 0, buttons: 1,
            clientX: x + dx * i / steps, clientY: y + dy * i / steps}));
        target.setPointerCapture = document.querySelector('#frame').setPointerCapture = () => {};
        for (const field of document.querySelectorAll('.curve-field')) field.setPointerCapture = () => {};
        send('pointerdown', 0);
        return new Promise((done) => {
            let i = 0;
            const next = () => {
                if (++i > steps) { send('pointerup', steps); done(); return; }
                send('pointermove', i);
                setTimeout(next, 40);
            };
            next();
        })""", selector, dx, dy, steps)


def state(browser):
    """Returns the URL's parameters."""
    browser.script("return new Promise(done => setTimeout(done, 500))")
    text = browser.script("return location.hash.slice(1)")
    return dict(part.split("=") for part in text.split("&") if part)


def scene_of(browser):
    """Returns the scene that the page saves."""
    return browser.script("""
        return new Promise((done) => {
            const made = URL.createObjectURL;
            URL.createObjectURL = (blob) => { blob.text().then(done); return made(blob); };
            document.querySelector('#save-scene').click();
            URL.createObjectURL = made;
        })""")


def no_overflow(browser):
    wide = browser.script("""
        return [...document.querySelectorAll('body *')].filter(e => e.checkVisibility() && !e.closest('.frame, .handles'))
            .filter(e => e.getBoundingClientRect().right > document.documentElement.clientWidth + 0.5)
            .map(e => e.tagName + '#' + e.id + '.' + e.className)""")
    equal(wide, [])


def turns_and_refines(browser, url):
    loaded(browser, url)
    equal(browser.text("#link"), "connected")
    watch_frames(browser)
    before = canvas_bytes(browser)
    drag(browser, "#frame", 120, 40)
    browser.wait("a moving picture", lambda: any(f["moving"] for f in frames(browser)))
    converged(browser)
    assert canvas_bytes(browser) != before, "the picture is the same"
    drawn = frames(browser)
    moving = [f for f in drawn if f["moving"]]
    equal({f["format"] for f in moving}, {os.environ["WEIR_MOVING_FORMAT"]})
    equal(drawn[-1]["format"], "png")
    equal((drawn[-1]["samples"], drawn[-1]["of"]), (16, 16))
    now = state(browser)
    equal((now["az"], now["el"]), ("353", "34"))
    # The link shows the same view.
    seen = canvas_bytes(browser)
    link = browser.script("return location.href")
    browser.open("about:blank")
    loaded(browser, link)
    equal(state(browser), now)
    same = canvas_bytes(browser)
    equal(len(same) > 1000 and same == seen, True)
    equal(browser.complaints(), [])
    # A screen with several hundred frames per second asks the server for about as many views as a screen with 60.
    views = browser.script("""
        window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 1);
        let views = 0;
        const sent = WebSocket.prototype.send;
        WebSocket.prototype.send = function(text) {
            views += JSON.parse(text).type === 'view';
            sent.call(this, text);
        };
        const begun = performance.now();
        return new Promise((done) => {
            const turn = () => {
                if (performance.now() - begun > 600) { done(views); return; }
                document.querySelector('#frame').dispatchEvent(new WheelEvent('wheel', {cancelable: true, deltaY: 1}));
                setTimeout(turn, 1);
            };
            turn();
        })""")
    assert 1 <= views <= 52, f"{views} views in 0.6 s"


def works_with_keys(browser, url):
    loaded(browser, url)
    browser.script("document.querySelector('#frame').focus()")
    browser.press("LEFT", "UP", "+")
    equal(state(browser), {"az": "30", "el": "25", "z": "1.15"})
    browser.press("0")
    equal(state(browser), {})
    browser.press("4")
    equal(state(browser), {"m": "mip"})
    converged(browser)
    browser.press("3")
    equal(browser.visible("#iso-field"), True)
    converged(browser)
    # They work after a click on a control, too, but for what a field takes.
    browser.script("document.querySelector('#convert-panel').open = true")
    for control in ("#reset-camera", "#log", "#colormap", "#convert-panel summary", "#rate", "#frame"):
        browser.script("document.querySelector(arguments[0]).focus()", control)
        browser.press("4")
        equal((control, state(browser)["m"]), (control, "iso" if control in ("#colormap", "#rate") else "mip"))
        browser.press("3")
    controls = {"button", "slider", "spinbutton", "checkbox", "radio", "combobox", "application", "progressbar", "textbox"}
    for panel in ("light-panel", "box-panel", "convert-panel"):
        browser.script("document.getElementById(arguments[0]).open = true", panel)
    named = [(node["role"]["value"], node["name"]["value"]) for node in browser.devtools("Accessibility.getFullAXTree")["nodes"]
             if not node["ignored"] and node["role"]["value"] in controls]
    assert len(named) > 30, named
    equal([role for role, name in named if not name], [])
    focus = "const e = document.activeElement; return e.id || e.name || e.className"
    seen = []
    browser.script("document.activeElement.blur()")
    for _ in range(60):
        browser.press("TAB")
        seen.append(browser.script(focus))
        if seen[-1] not in ("", "frame"):
            shown = browser.script("""const e = document.activeElement;
                const marked = e.name === 'mode' ? e.nextElementSibling : e;
                return getComputedStyle(marked).outlineStyle""")
            equal((seen[-1], shown), (seen[-1], "solid" if seen[-1] else shown))
        if {"frame", "show-command"} <= set(seen):
            break
    for wanted in ["frame", "mode", "undo", "handle", "colormap", "iso", "light-az", "reset-box", "save-picture", "save-scene",
                   "budget", "rate", "encoding", "show-command"]:
        assert wanted in seen, f"{wanted} is not reached: {seen}"


def edits_the_transfer_function(browser, url):
    loaded(browser, url)
    assert browser.script("return document.querySelector('.bars').getAttribute('d').length") > 100
    before = canvas_bytes(browser)
    points = browser.script("return document.querySelectorAll('.handle').length")
    assert points >= 2, points
    drag(browser, ".handle:last-child", -60, 50)
    assert "o" in state(browser), state(browser)
    converged(browser)
    assert canvas_bytes(browser) != before, "the picture is the same"
    # A click adds a point, Delete removes the point, then everything is undone.
    drag(browser, ".curve-field", -20, -30, 2)
    equal(browser.script("return document.querySelectorAll('.handle').length"), points + 1)
    browser.press("DELETE")
    equal(browser.script("return document.querySelectorAll('.handle').length"), points)
    browser.script("delete document.querySelector('.curve-field').setPointerCapture")  # that drag() put there
    browser.double_click(".handle:nth-child(2)")
    equal(browser.script("return document.querySelectorAll('.handle').length"), points - 1)
    for _ in range(6):
        browser.script("document.querySelector('#undo').click()")
    equal(state(browser), {})
    converged(browser)
    equal(canvas_bytes(browser) == before, True)
    browser.script("document.querySelector('#redo').click()")
    assert "o" in state(browser), state(browser)


def shows_the_opacity_of_the_range(browser, url):
    """Where the address says another range, and no opacity: as the picture has it."""
    drawn = lambda: [tuple(map(float, point.split(","))) for point in
                     browser.script("return document.querySelector('.line').getAttribute('points')").split(" ")]
    lowest = 150 - 9  # of the drawing, at opacity 0
    loaded(browser, url)
    equal((drawn()[0][1], drawn()[-1][1]), (lowest, 9))
    loaded(browser, url + "#r=-2,1")  # the background, 0, is two thirds of the way up
    points = drawn()
    equal((points[0][1], points[-1][1]), (9, round(lowest - 132 * ((0.5 - 0.06) / 0.94) ** 1.5, 2)))
    middle = 9 + 2 / 3 * (320 - 18)
    equal({y for x, y in points if abs(x - middle) < 10}, {lowest})
    assert "opacity" not in scene_of(browser), scene_of(browser)
    browser.script("document.querySelector('#convert-panel').open = true")
    saved = scene_of(browser)
    assert "range = [-2, 1]\nopacity = [[0, 1], " in saved, saved
    # The picture uses the curve that is shown.
    by_default = pixels(browser)
    curve = browser.script("""
        return import('./page/panels.js').then(({curve_of}) =>
            curve_of({range: [-2, 1]}, {range: [0, 1], background: 0, opacity: Array(33).fill(0)}))""")
    browser.open("about:blank")
    loaded(browser, f"{url}#r=-2,1&o=" + ",".join(f"{x:.6f}_{y:.6f}" for x, y in curve))
    by_curve = pixels(browser)
    difference = math.sqrt(sum((a - b) ** 2 for a, b in zip(by_default, by_curve)) / len(by_curve))
    assert difference < 5, f"root mean square difference {difference:.2f} of 255"
    # Of one value nothing is seen beyond an end where the background lies.
    opacity = lambda *arguments: browser.script("""
        return import('./page/look.js').then((look) => look.start_opacity(...arguments))""".replace(
            "...arguments", json.dumps(list(arguments))[1:-1]))
    equal([opacity(0, [3, 3], 1), opacity(1, [3, 3], 1), opacity(1, [3, 3], 4)], [0, 0.5, 0])
    equal([opacity(0, [-2, 1], None), opacity(1, [-2, 1], None)], [0, 1])  # a background that is no number: the lowest


def takes_extreme_values(browser, url):
    loaded(browser, url + "#el=90&d=1e%2B20&iso=-2e-30&m=iso")
    scene = scene_of(browser)
    assert "density = 1e+20\n" in scene, scene
    assert "iso = -2e-30\n" in scene, scene
    equal(browser.visible("#banner"), False)
    browser.script("document.querySelector('#frame').focus()")
    browser.press("UP", "UP")
    equal(state(browser)["el"], "89.9")
    browser.press(*["DOWN"] * 40)
    equal(state(browser)["el"], "-89.9")
    converged(browser)
    equal(browser.visible("#banner"), False)
    # The URL keeps all digits of positions and values.
    exact = {"m": "iso", "at": "1000000000.125,-2,3e-7", "r": "0.123456789,16777217", "iso": "1.23456789012"}
    browser.script("location.hash = arguments[0]", "&".join(f"{key}={value}" for key, value in exact.items()))
    equal(state(browser), exact)


def touch(browser, kind, *points):
    """Sends the browser a touch of the screen with a finger at each (x, y) of the window."""
    browser.devtools("Input.dispatchTouchEvent", type=kind,
                     touchPoints=[{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)])


def slide(browser, *fingers):
    """Moves each finger from its first point to its second point."""
    at = lambda share: [(a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share) for a, b in fingers]
    touch(browser, "touchStart", *at(0))
    for i in range(1, 6):
        touch(browser, "touchMove", *at(i / 5))
    touch(browser, "touchEnd")


def works_by_touch(browser, url):
    browser.set_width(390, 560)
    browser.devtools("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=5)
    loaded(browser, url)
    left, top, width, height = browser.script("""
        const box = document.querySelector('#frame').getBoundingClientRect();
        return [box.left, box.top, box.width, box.height]""")
    x, y = left + width / 2, top + height / 2
    slide(browser, ((x, y), (x + 60, y + 20)))
    turned = state(browser)
    equal((turned["az"], turned["el"]), ("14", "27"))  # 0.35 degrees a pixel
    equal(browser.text("#value"), "")  # that was no tap
    equal(browser.visible(".for-touch"), True)
    slide(browser, ((x - 30, y), (x - 60, y)), ((x + 30, y), (x + 60, y)))
    pinched = state(browser)
    equal({**pinched, "at": ""}, {**turned, "z": "2", "at": ""})
    slide(browser, ((x - 30, y), (x - 30, y + 40)), ((x + 30, y), (x + 30, y + 40)))
    panned = state(browser)
    equal(panned["z"], "2")
    before, after = ([float(v) for v in place["at"].split(",")] for place in (pinched, panned))
    assert after[2] > before[2] + 1, f"the volume follows the fingers down: {before}, {after}"
    equal(browser.script("return scrollY"), 0)
    browser.press("0")
    converged(browser)
    touch(browser, "touchStart", (x, y))
    touch(browser, "touchEnd")
    text = browser.wait("the value at a tap", lambda: browser.text("#value"))
    assert " at " in text, text
    # Drags a point of the opacity curve.
    handle = browser.script("""
        document.querySelector('.handle:last-child').scrollIntoView({block: 'center'});
        const box = document.querySelector('.handle:last-child').getBoundingClientRect();
        return [box.left + box.width / 2, box.top + box.height / 2]""")
    slide(browser, (handle, (handle[0] - 40, handle[1] + 30)))
    assert "o" in state(browser), state(browser)


def tells_values(browser, url):
    loaded(browser, url)
    description = browser.text("#picture-text")
    assert re.fullmatch(r"Volume of a\.nvdb, 64 \u00d7 64 \u00d7 64 voxels with values from 0 to [\d.]+, seen from 35\u00b0 around and "
                        r"20\u00b0 above, 1 times, PSNR [\d.]+ dB, largest error [\d.e-]+\.", description), description
    browser.script("document.querySelector('#frame').focus()")
    browser.press("ENTER")
    text = browser.wait("the value in the middle", lambda: browser.text("#value"))
    assert re.match(r"-?[\d.e-]+ \u00b1 [\d.e-]+ at \d+, \d+, \d+", text), text
    browser.press(*["+"] * 12, "LEFT")
    equal(browser.text("#value"), "")
    browser.script("""
        const frame = document.querySelector('#frame');
        const box = frame.getBoundingClientRect();
        frame.dispatchEvent(new PointerEvent('pointermove', {bubbles: true, pointerType: 'mouse', pointerId: 1,
            clientX: box.left + box.width / 2, clientY: box.top + box.height / 2}))""")
    text = browser.wait("a value", lambda: browser.text("#value"))
    assert re.match(r"-?[\d.e-]+ \u00b1 [\d.e-]+ at \d+, \d+, \d+", text), text
    written = lambda name, *values: browser.script("""
        const [name, values] = arguments;
        return import('./page/format.js').then((format) => values.map((value) => format[name](...value)))""", name, values)
    # Numbers of a float32 are the doubles that it is.
    equal(written("exact", [12666], [1236], [1013.2000122070312], [1013.4000244140625], [0.10000000149011612], [-3.4028234663852886e38],
                  [1.401298464324817e-45], [0], [1e8], ["inf"], [None]),
          ["12666", "1236", "1013.2", "1013.4", "0.1", "-3.4028235e38", "1e-45", "0", "1e8", "inf", "\u2013"])
    equal(written("place", [1240, 1], [0.30000000000000004, 0.1], [1 / 3, 1 / 3], [1000000.05, 0.1], [1e-17, 0.1]),
          ["1240", "0.3", "0.33333", "1000000.05", "0"])
    equal(written("within", [1999, 1999], [0, 1999], [1013.2000122070312, 0.2], [0.12345678, 0.12345678], [5, 0]),
          ["1999", "0", "1013.2", "0.12346", "5"])
    equal(written("bound", [0.36543], [0.365], [9.996], [0.000099991], [0], [None]),
          ["0.366", "0.365", "10", "1e-4", "0", "\u2013"])
    of = lambda answer, facts: browser.script("""
        return import('./page/certificate.js').then((certificate) => certificate.value_text(...arguments[0]))""",
        [{"found": True, **answer}, facts])
    equal(of({"value": 12666, "voxel": [1236, 63, 32], "world": [1236, 63, 32]},
             {"certificate": {"lossless": True}, "voxel_size": [1, 1, 1]}), "12666, exact at 1236, 63, 32")
    equal(of({"value": 1013.2000122070312, "against": 1013.4000244140625, "voxel": [1236, 0, 0], "world": [1236.0001, 0, 0]},
             {"certificate": {"lossless": False, "max_abs": 0.01001}, "voxel_size": [0.001, 1, 1]}),
          "1013.2 \u00b1 0.0101, other file 1013.4 at 1236, 0, 0 (world 1236.0001, 0, 0)")


def scrubs_a_series(browser, url):
    loaded(browser, url)
    equal(browser.text("#step-name"), "1 of 3: s_1.nvdb")
    before = canvas_bytes(browser)
    browser.script("""
        const slider = document.querySelector('#step');
        slider.value = 2;
        slider.dispatchEvent(new Event('input'));
        slider.dispatchEvent(new Event('change'))""")
    equal(browser.text("#step-name"), "3 of 3: s_3.nvdb")
    converged(browser)
    equal(browser.text("#file-name"), "s_3.nvdb")
    equal(browser.text("#title"), "s_*.nvdb: s_3.nvdb")
    equal(browser.script("return document.title"), "s_3.nvdb \u2013 weir view")
    browser.wait("its facts", lambda: not browser.script("return document.querySelector('#certificate.awaited')"))
    assert canvas_bytes(browser) != before, "the picture is the same"
    equal(state(browser), {"f": "s_3.nvdb"})
    browser.script("document.activeElement.blur()")
    watch_frames(browser)
    browser.press("SPACE")
    browser.wait("it plays", lambda: len({f["step"] for f in frames(browser)}) == 3)
    browser.press("SPACE")
    picture(browser, "series")
    # Keys go on after a click on a control; Space presses a button, once.
    browser.click("#play")
    equal(browser.text("#play"), "Stop")
    browser.press("SPACE")
    equal(browser.text("#play"), "Play")
    browser.script("""
        const slider = document.querySelector('#step');
        slider.focus();
        slider.value = 2;
        slider.dispatchEvent(new Event('change'))""")
    browser.press("[")
    equal(browser.text("#step-name"), "2 of 3: s_2.nvdb")
    browser.press("]")
    equal(browser.text("#step-name"), "3 of 3: s_3.nvdb")


def tells_steps_of_one_base_name_apart(browser, url):
    loaded(browser, url)
    equal(browser.text("#step-name"), "1 of 3: runA/out.nvdb")
    browser.press("]")
    converged(browser)
    equal(browser.text("#step-name"), "2 of 3: runB/out.nvdb")
    equal(state(browser), {"f": "runB%2Fout.nvdb"})
    browser.wait("its facts", lambda: not browser.script("return document.querySelector('#certificate.awaited')"))
    equal(browser.text("#render-command").split()[:3], ["weir", "render", "runB/out.nvdb"])
    link = browser.script("return location.href")
    browser.open("about:blank")
    loaded(browser, link)
    equal(browser.text("#step-name"), "2 of 3: runB/out.nvdb")
    equal(browser.text("#file-name"), "runB/out.nvdb")


def shows_steps_that_come(browser, url):
    steps = pathlib.Path(arguments[0]).parent
    come = lambda name: os.rename(steps / f"later_{name}", steps / name)
    browser.set_width(390, 500)  # a small picture, soon done
    loaded(browser, url)
    equal(browser.visible("#steps"), False)
    come("s_2.nvdb")
    browser.wait("a second step", lambda: browser.text("#step-name") == "1 of 2: s_1.nvdb")
    equal(browser.text("#step-news"), "new step")
    equal(browser.text("#file-name"), "s_1.nvdb")
    picture(browser, "new-step")
    no_overflow(browser)
    before = canvas_bytes(browser)
    browser.click("#follow")
    browser.wait("it is shown", lambda: browser.text("#step-name") == "2 of 2: s_2.nvdb")
    equal((browser.text("#title"), browser.text("#file-name")), ("s_2.nvdb", "s_2.nvdb"))
    equal(browser.text("#step-news"), "")
    converged(browser)
    assert canvas_bytes(browser) != before, "the picture is the same"
    come("s_0.nvdb")  # an older one does not move what is shown
    browser.wait("a third step", lambda: browser.text("#step-name") == "3 of 3: s_2.nvdb")
    come("s_3.nvdb")
    browser.wait("it follows", lambda: browser.text("#step-name") == "4 of 4: s_3.nvdb")
    browser.wait("its facts", lambda: browser.text("#file-name") == "s_3.nvdb")
    browser.script("document.activeElement.blur()")
    browser.press("[")
    equal(browser.text("#step-name"), "3 of 4: s_2.nvdb")
    equal(browser.script("return document.querySelector('#follow').checked"), False)
    os.remove(steps / "s_2.nvdb")
    browser.wait("that it is gone", lambda: browser.text("#banner") == "s_2.nvdb is no longer there.")
    equal(browser.text("#step-name"), "no longer there: s_2.nvdb")
    browser.press("]")
    equal(browser.text("#step-name"), "1 of 3: s_0.nvdb")
    converged(browser)
    equal(browser.visible("#banner"), False)
    equal(browser.complaints(), [])
    # A link to a step that comes later.
    browser.open("about:blank")
    loaded(browser, url + "#f=s_4.nvdb")
    equal(browser.text("#step-name"), "2 of 3: s_1.nvdb")
    come("s_4.nvdb")
    browser.wait("the step of the link", lambda: browser.text("#step-name") == "4 of 4: s_4.nvdb")
    os.remove(steps / "s_4.nvdb")
    browser.wait("that it is gone", lambda: browser.text("#step-name") == "no longer there: s_4.nvdb")
    browser.press("[")
    equal(browser.text("#step-name"), "3 of 3: s_3.nvdb")
    # If only one step is left, playing stops and the step's picture is refined.
    browser.press("SPACE")
    browser.wait("it plays", lambda: browser.text("#play") == "Stop")
    for name in ("s_1.nvdb", "s_3.nvdb"):
        os.remove(steps / name)
    browser.wait("one step is left", lambda: not browser.visible("#steps"))
    equal(browser.script("return document.querySelector('#play').textContent"), "Play")
    converged(browser)
    equal(browser.text("#file-name"), "s_0.nvdb")
    # A page that is opened now begins there, not at the step that was the first.
    browser.open("about:blank")
    loaded(browser, url)
    equal((browser.text("#file-name"), browser.visible("#banner")), ("s_0.nvdb", False))


def compares_two_files(browser, url):
    loaded(browser, url)
    browser.click("#compare")
    converged(browser)
    equal(browser.text("#side-left"), "a.nvdb")
    equal(browser.text("#side-right"), "b.nvdb")
    whole = pixels(browser)
    browser.script("document.querySelector('#divider').focus()")
    browser.press(*["RIGHT"] * 25)
    equal(state(browser), {"s": "1"})
    converged(browser)
    assert pixels(browser) != whole, "both sides show one file"
    browser.press(*["LEFT"] * 25)
    converged(browser)
    picture(browser, "compare")
    text = lambda of_other: browser.script("""
        const answer = {found: true, value: 1.5, voxel: [1, 2, 3], world: [1, 2, 3], ...arguments[0]};
        return import('./page/certificate.js').then((certificate) => certificate.value_text(answer, {}))""", of_other)
    equal(text({"against": 1.25, "outside": False}), "1.5, other file 1.25 at 1, 2, 3")
    equal(text({"against": None, "outside": True}), "1.5, outside the other file at 1, 2, 3")
    equal(text({"against": None, "outside": False}), "1.5, other file \u2013 at 1, 2, 3")
    equal(text({}), "1.5 at 1, 2, 3")


def converts(browser, url):
    loaded(browser, url)
    assert "opacity" not in scene_of(browser), scene_of(browser)
    browser.script("document.querySelector('#convert-panel').open = true")
    command = browser.wait("the command", lambda: browser.text("#convert-command"))
    assert command.startswith("weir convert ") and command.endswith(" --scene scene.toml"), command
    equal(browser.visible("#run-convert"), False)
    equal(browser.text("#convert-size"), "131\u202f072 bytes, whatever the scene.")

    def forecast():
        def known():
            text = browser.text("#convert-forecast") or ""
            return text if text.startswith("Expected: ") else None
        return browser.wait("a forecast", known, 60)  # of a process that gives way to all others

    of_rate = forecast()
    told = re.fullmatch(r"Expected: 128\.0 KiB, PSNR of what is shown ([\d.]+) dB, of all voxels ([\d.]+) dB, largest error [\d.e-]+, in about [\d.]+ s\.", of_rate)
    assert told, of_rate
    asked = browser.script("""
        return new Promise((done) => {
            const sent = WebSocket.prototype.send;
            WebSocket.prototype.send = function(text) { done(JSON.parse(text).scene); sent.call(this, text); };
            document.querySelector('#show-command').click();
            WebSocket.prototype.send = sent;
        })""")
    scene = os.path.join(directory, "scene.toml")
    saved = scene_of(browser)
    equal(saved.partition("[volume]")[2], asked.partition("[volume]")[2])
    with open(scene, "w", encoding="utf-8") as file:
        file.write(saved)
    words = [scene if word == "scene.toml" else word for word in command.split()]
    subprocess.run([weir, *words[1:], "--quiet"], check=True)
    with open(words[words.index("-o") + 1] + ".json", encoding="utf-8") as file:
        made = json.load(file)
    equal((told[1], told[2]), tuple(f"{made[of]['psnr_db']:.1f}" for of in ("visible", "error")))
    # Of a size for an error; another look is tried out anew.
    browser.script("""
        const budget = document.querySelector('#budget');
        budget.value = 'psnr';
        budget.dispatchEvent(new Event('change'))""")
    equal((browser.visible("#rate"), browser.visible("#psnr")), (False, True))
    of_psnr = forecast()
    assert of_psnr != of_rate and "KiB, PSNR of what is shown 50." in of_psnr, of_psnr
    assert " --psnr 50 " in browser.text("#convert-command"), browser.text("#convert-command")
    for handle in (2, 3):  # without opacity, so that values below the fourth point are hidden and cost fewer bytes
        drag(browser, f".handle:nth-child({handle})", 80, 120)
    kib = lambda text: float(re.match(r"Expected: ([\d.]+) KiB, ", text)[1])
    browser.wait("a forecast of fewer bytes", lambda: kib(forecast()) < kib(of_psnr) - 1, 60)
    # A large volume is known by a sample.
    browser.script("""
        const parse = JSON.parse;
        JSON.parse = (text) => {
            const message = parse(text);
            if (message.type !== 'forecast') return message;
            return {...message, exact: false, share: 0.2441, max_abs: null, total_s: 28.4,
                    bytes: {value: 2163642, low: 2100000, high: 2200000, exact: false},
                    psnr_db: {value: 28.22, low: null, high: null},
                    visible: {lossless: false, psnr_db: {value: 50.06, low: 49.5, high: 51}, share: 0.136}};
        }""")
    browser.click("#show-command")
    browser.wait("the estimate", lambda: browser.text("#convert-forecast") ==
                 "Expected: about 2.1 MiB (2.0 MiB to 2.1 MiB), PSNR of what is shown about 50.1 dB (49.5 dB to 51.0 dB), of all "
                 "voxels about 28.2 dB, in about 28 s: estimated by a sample of 24 % of the voxels.", 60)
    # A figure that is not finite comes as null.
    browser.script("""
        const known = JSON.parse;
        JSON.parse = (text) => {
            const message = known(text);
            if (message.type === 'forecast') message.visible.psnr_db.value = null;
            return message;
        }""")
    browser.click("#show-command")
    browser.wait("the estimate without it", lambda: browser.text("#convert-forecast") ==
                 "Expected: about 2.1 MiB (2.0 MiB to 2.1 MiB), PSNR of all voxels about 28.2 dB, in about 28 s: estimated by a "
                 "sample of 24 % of the voxels.", 60)
    # An amount that the server would refuse leaves nothing of an earlier question.
    for amount, why in (("250", "from 1 to 200"), ("", "from 1 to 200")):
        browser.script("""
            const psnr = document.querySelector('#psnr');
            psnr.value = arguments[0];
            psnr.dispatchEvent(new Event('change'))""", amount)
        equal(browser.text("#convert-note"), f"The PSNR is a number {why}.")
        equal((browser.text("#convert-forecast"), browser.visible("#convert-command")), ("", False))
    browser.script("""
        const psnr = document.querySelector('#psnr');
        psnr.value = 50;
        psnr.dispatchEvent(new Event('change'))""")
    browser.wait("the command", lambda: browser.text("#convert-command"))
    # Without its source there is nothing to convert.
    source = pathlib.Path(command.split()[2])
    source.rename(source.with_suffix(".gone"))
    browser.click("#show-command")
    note = browser.wait("why not", lambda: "is not the source of" in (browser.text("#convert-note") or "") and
                        browser.text("#convert-note"))
    with open(arguments[0] + ".json", encoding="utf-8") as file:
        mtime = json.load(file)["source"]["mtime"]
    equal(note, f"{source}: is not the source of {arguments[0]}, which had 1048576 bytes as of {mtime}; put it there, or convert "
                "it again from where it is")
    equal((browser.text("#convert-forecast"), browser.text("#convert-size"), browser.visible("#convert-command")), ("", "", False))
    equal(browser.visible("#banner"), False)


def asks_again(browser, url):
    """Replaces the server: window.asked collects the page's requests, and window.tell sends answers."""
    loaded(browser, url)
    browser.script("""
        window.asked = [];
        const sent = WebSocket.prototype.send;
        WebSocket.prototype.send = function(text) {
            window.socket = this;
            const message = JSON.parse(text);
            if (message.type === 'convert') window.asked.push(message);
            else sent.call(this, text);
        };
        window.tell = (message) => socket.dispatchEvent(new MessageEvent('message', {data: JSON.stringify(message)}));
        document.querySelector('#convert-panel').open = true""")
    asked = lambda number: browser.wait(f"question {number}", lambda: len(browser.script("return asked")) == number and
                                        browser.script("return asked.at(-1)"))
    tell = lambda message: browser.script("tell(arguments[0])", message)
    shown = lambda: tuple(browser.text(f"#convert-{part}") or "" for part in ("command", "note", "forecast"))
    of = lambda question, state, message="": {"type": "conversion", "id": question["id"], "command": f"weir {question['id']}",
                                              "bytes": 1, "state": state, "message": message}
    first = asked(1)
    equal((first["step"], first["run"]), (0, False))
    tell(of(first, "shown"))
    # A run leaves the forecast that is on its way alone, and its states are its own.
    browser.click("#run-convert")
    run = asked(2)
    equal(run["run"], True)
    tell(of(run, "running"))
    tell({"type": "forecast", "id": first["id"], "state": "failed", "message": "for a test"})
    equal(shown(), (f"weir {run['id']}", "running", "No forecast: for a test."))
    browser.click("#show-command")
    newest = asked(3)
    tell(of(newest, "shown"))
    equal(shown(), (f"weir {newest['id']}", "running", "Being tried out \u2026"))
    equal(browser.script("return document.querySelector('#run-convert').disabled"), True)
    tell(of(run, "done", "a_scene.nvdb"))
    equal(shown(), (f"weir {newest['id']}", "done: a_scene.nvdb", "Being tried out \u2026"))
    equal(browser.script("return document.querySelector('#run-convert').disabled"), False)
    # Values of the series that are others ask again, and so does a connection that comes back.
    browser.script("""
        tell({type: 'steps', steps: ['a.nvdb'], order: [0], range: [-1, 7], background: 0, opacity: [0, 1]})""")
    assert "range = [-1, 7]" in asked(4)["scene"]
    # That of a preview is drawn from its source.
    browser.script("""
        const fetched = window.fetch;
        window.fetch = async (...request) => {
            const state = await (await fetched(...request)).json();
            const preview = {preview_of: 'r.h5', render_input: 'r.h5 --volume dense --dataset=/a'};
            return new Response(JSON.stringify({...state, ...preview}));
        };
        socket.close()""")
    asked(5)
    equal(browser.text("#render-command").split()[:7],
          ["weir", "render", "r.h5", "--volume", "dense", "--dataset=/a", "-o"])
    equal(browser.text("#render-title"), "This view of the source itself")


def shows_values_that_are_not_finite(browser, url):
    loaded(browser, url)
    browser.wait("the certificate", lambda: "Values" in (browser.text("#certificate") or ""))
    assert "0 to inf" in browser.text("#certificate"), browser.text("#certificate")
    equal(browser.complaints(), [])


def saved_scene_gives_the_same_picture(browser, url):
    loaded(browser, url)
    drag(browser, "#frame", 70, -20)
    drag(browser, ".handle:last-child", -40, 30)
    browser.script("""
        const slider = document.querySelector('[aria-label="x from"]');
        slider.value = 12;
        slider.dispatchEvent(new Event('input'));
        slider.dispatchEvent(new Event('change'))""")
    state(browser)
    converged(browser)
    width, height = browser.script("const c = document.querySelector('#canvas'); return [c.width, c.height]")
    seen = pixels(browser)
    scene = os.path.join(directory, "scene.toml")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(scene_of(browser))
    command = browser.text("#render-command").split()
    equal(command[command.index("--size") + 1], f"{width}x{height}")
    image = os.path.join(directory, "scene.png")
    subprocess.run([weir, "render", arguments[0], "-o", image, "--scene", scene, "--size", f"{width}x{height}", "--spp", "16",
                    "--quiet", "--overwrite"], check=True)
    browser.open("about:blank")
    browser.open(url)  # a page of this origin may draw the picture

    with open(image, "rb") as file:
        data = base64.b64encode(file.read()).decode()
    rendered = browser.script("""
        const image = new Image();
        const bytes = Uint8Array.from(atob(arguments[0]), (c) => c.charCodeAt(0));
        image.src = URL.createObjectURL(new Blob([bytes], {type: 'image/png'}));
        return image.decode().then(() => {
            const canvas = new OffscreenCanvas(image.width, image.height);
            const context = canvas.getContext('2d');
            context.drawImage(image, 0, 0);
            return [...context.getImageData(0, 0, image.width, image.height).data];
        })""", data)
    equal(len(rendered), len(seen))
    difference = math.sqrt(sum((a - b) ** 2 for a, b in zip(rendered, seen)) / len(seen))
    spread = max(seen[1::4]) - min(seen[1::4])
    assert spread > 100, f"an empty picture: {spread}"
    assert difference < 2.5, f"root mean square difference {difference:.2f} of 255"


def fits_windows(browser, url):
    for width, height in ((1440, 900), (800, 1000), (390, 844)):
        browser.set_width(width, height)
        loaded(browser, url)
        no_overflow(browser)
        equal(browser.script("return document.documentElement.scrollWidth"), width)
        picture(browser, f"view-{width}")
    small = browser.script("""
        return [...document.querySelectorAll('button, select, .modes span')].filter(e => e.checkVisibility())
            .filter(e => e.getBoundingClientRect().height < 43.5).map(e => e.id || e.innerText)""")
    equal(small, [])
    browser.prefer("dark")
    browser.set_width(1440, 900)
    loaded(browser, url + "#m=iso")
    for panel in ("light-panel", "box-panel", "convert-panel"):
        browser.script("document.getElementById(arguments[0]).open = true", panel)
    browser.wait("the command", lambda: browser.text("#convert-command"))
    no_overflow(browser)
    picture(browser, "view-dark-iso")


def asks_for_the_token(browser, url):
    browser.open(url)
    browser.wait("the login", lambda: browser.visible("#login"))
    enter = lambda text: browser.script("""
        document.querySelector('#token').value = arguments[0];
        document.querySelector('#login button').click()""", text)
    enter("wrong")
    browser.wait("the refusal", lambda: "token" in (browser.text("#login-error") or ""))
    enter("secret ")  # as a paste may bring it
    browser.wait("the page is filled", lambda: browser.visible("#main"))
    converged(browser)


def says_when_the_server_is_gone(browser, url):
    loaded(browser, url + "?job=3")
    # Behind weir watch, which answers for a viewer that is not there.
    browser.script("""
        window.state = 'starting';
        window.real_fetch = window.fetch;
        window.fetch = async () => new Response(JSON.stringify({error: 'no', state: window.state}), {status: 503})""")
    server.process.send_signal(signal.SIGINT)
    browser.wait("it waits", lambda: browser.text("#other-series-note") == "The viewer is being started.")
    equal(browser.text("#link"), "starting")
    equal((browser.visible("#take-back"), browser.visible("#banner")), (False, False))
    browser.script("window.state = 'none'")
    browser.wait("it offers one", lambda: browser.text("#other-series-note") == "No viewer runs for this page now.")
    equal((browser.visible("#take-back"), browser.text("#banner")), (True, "no"))
    browser.script("window.fetch = window.real_fetch")
    browser.wait("it says so", lambda: browser.text("#link") == "not connected")
    browser.wait("and why", lambda: browser.text("#banner") == "The server does not answer; it may have ended.")
    # Whoever tries again by hand takes the place of what waits to try again.
    asked = browser.script("""
        let asked = 0;
        window.fetch = (...request) => { ++asked; return window.real_fetch(...request); };
        const login = document.querySelector('#login');
        for (let i = 0; i < 4; ++i) login.dispatchEvent(new Event('submit', {cancelable: true}));
        return new Promise((done) => setTimeout(() => done(asked), 2200))""")
    assert 4 <= asked <= 6, f"{asked} requests, four of them by hand"


def of_process(pid, name):
    """Returns the text of a file in /proc; empty if the process has ended."""
    try:
        return pathlib.Path(f"/proc/{pid}/{name}").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""


def descendants(pid):
    children = [int(child) for child in of_process(pid, f"task/{pid}/children").split()]
    return children + [one for child in children for one in descendants(child)]


def processes_of(browser):
    """Returns the browser's processes. The browser is not a child of its driver, so its profile identifies it."""
    running = [int(entry.name) for entry in pathlib.Path("/proc").iterdir() if entry.name.isdigit()]
    own = [pid for pid in running if browser.profile.name in of_process(pid, "cmdline")]
    return {*own, *(one for pid in own for one in descendants(pid))}


def kill(browser):
    """Kills a browser as a crash would: no connection is closed properly."""
    own = processes_of(browser)
    assert own, "no process has this profile"
    for pid in own:
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:  # the process ended with its parent
            pass
    browser.driver.kill()
    browser.driver.wait()
    browser.wait("it is gone", lambda: not processes_of(browser))
    browser.profile.cleanup()


def sockets_of_server():
    def target(entry):
        try:
            return os.readlink(entry)
        except FileNotFoundError:  # closed meanwhile
            return ""

    return sum(target(entry).startswith("socket:") for entry in pathlib.Path(f"/proc/{server.process.pid}/fd").iterdir())


def stays_while_others_break(browser, url):
    loaded(browser, url)
    before = sockets_of_server()
    killed = Browser(1200, 480)
    loaded(killed, url)
    drag(killed, "#frame", 40, 0, 2)
    kill(killed)
    place = ("127.0.0.1", int(url.rstrip("/").rpartition(":")[2]))
    upgrade = (f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{place[1]}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
               "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
               "Sec-WebSocket-Protocol: weir.view\r\n\r\n").encode()
    broken = []
    for sent in (b"", b"GET / HT", os.urandom(3000), upgrade, upgrade + os.urandom(3000), upgrade[:60]):
        broken.append(socket.create_connection(place))
        broken[-1].sendall(sent)  # and nothing more: half open, or garbage
    watch_frames(browser)
    seen = canvas_bytes(browser)
    drag(browser, "#frame", 120, 40)
    browser.wait("a moving picture", lambda: any(f["moving"] for f in frames(browser)))
    converged(browser)
    assert canvas_bytes(browser) != seen, "the picture is the same"
    equal(browser.text("#link"), "connected")
    equal(browser.visible("#banner"), False)
    for connection in broken:
        connection.close()
    # The browser may keep one or two more for its next requests; those above are eight or more.
    browser.wait("their connections are gone", lambda: sockets_of_server() <= before + 2, 60)
    equal(browser.text("#link"), "connected")
    equal(browser.complaints(), [])


server = Server()
with server as address, Browser(1200, 900) as opened:
    if not pictures:
        opened.set_width(1200, 480)  # a small picture, soon done
    globals()[case](opened, address)
