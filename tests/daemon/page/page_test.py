"""page_test.py URL CASE [DIRECTORY]: runs one test of the page at URL in headless Chromium, with the service of
tests/daemon/http/page_test.cpp. Writes screenshots into DIRECTORY if it is given. Exits with 0 if the test passes."""

import json
import os
import sys
import urllib.request

from webdriver import DIRECT, Browser

url, case = sys.argv[1:3]
pictures = sys.argv[3] if len(sys.argv) > 3 else None


def equal(found, expected):
    assert found == expected, f"found {found!r}, expected {expected!r}"


def picture(browser, name):
    if pictures:
        browser.screenshot(os.path.join(pictures, name + ".png"))


def loaded(browser):
    browser.wait("the page is filled", lambda: browser.visible("#main"))
    browser.wait("pictures are there", lambda: browser.script(
        "return [...document.querySelectorAll('#results .picture')].every(p => p.textContent || p.querySelector('img'))"))


def asked_of_service():
    """Returns the requests that the page sent to the service."""
    with DIRECT.open(url + "/api/jobs/9999") as answer:
        return json.load(answer)["reason"].split(", ")


def tell_service(path):
    """Sends the service a change from another client while the page is open."""
    with DIRECT.open(urllib.request.Request(url + path, b"", {"X-Weir": "test"})) as answer:
        answer.read()


def wait_a_round(browser):
    browser.script("return new Promise(done => setTimeout(done, 2500))")


def choose(browser, selector, value):
    browser.script("""
        const choice = document.querySelector(arguments[0]);
        choice.value = arguments[1];
        choice.dispatchEvent(new Event('change'))""", selector, value)


def search(browser, text):
    browser.script("""
        const field = document.querySelector('#all-text');
        field.value = arguments[0];
        field.dispatchEvent(new Event('input'))""", text)


def no_overflow(browser):
    wide = browser.script("""
        return [...document.querySelectorAll('body *')].filter(e => e.checkVisibility())
            .filter(e => e.getBoundingClientRect().right > document.documentElement.clientWidth + 0.5)
            .map(e => e.tagName + '#' + e.id + '.' + e.className)""")
    equal(wide, [])


def shows_the_service(browser):
    browser.open(url)
    loaded(browser)
    equal(browser.text("#state"), "running")
    equal(browser.text("#throughput"), "141.1 MiB/s")
    equal(browser.text("#waiting"), "15")
    equal(browser.text("#queue-age"), "waiting, 7.5 GiB, the oldest for 62 s, 1 more not taken yet")
    equal(browser.text("#queue-end"), "empty in about 75 s")
    equal(browser.text("#done"), "24")
    equal(browser.text("#totals"), "done; since start 12.0 GiB in, 1.5 GiB out")
    equal(browser.text("#broken"), "2")
    equal(browser.text("#broken-states"), "1 failed, 1 quarantined")
    equal(browser.texts("#running .name"), ["density_26_512x512x512_float32.raw", "density_27_512x512x512_float32.raw"])
    equal(browser.texts("#running .step"), ["convert", "verify"])
    equal(browser.script("return [...document.querySelectorAll('#running progress')].map(p => p.position)"), [0.62, -1])
    equal(browser.texts("#running .fact")[0], "62 %, 4.1 s, source 512.0 MiB")
    equal(len(browser.texts("#queue li")), 10)
    equal(browser.text("#queue-more"), "and 5 more")
    assert browser.texts("#queue .fact")[0].startswith("512.0 MiB, attempt 2 in "), browser.texts("#queue .fact")[0]
    equal([text for text in browser.texts("#queue .reason") if text],
          ["read: Resource temporarily unavailable"])
    equal(len(browser.texts("#results .card")), 12)
    equal(browser.text("#results .card .name"), "density_24_512x512x512_float32.nvdb")
    equal(browser.text("#results .card .fact"), "64.0 MiB, rate 8")
    equal(browser.texts("#results .card .quality")[:5],
          ["PSNR 53.7 dB", "PSNR 53.6 dB", "PSNR 53.5 dB", "PSNR 53.4 dB", "lossless"])
    equal(browser.script("return document.querySelectorAll('#results img').length"), 12)
    equal(browser.texts("#watches .lead"),
          ["/scratch/run42 \u2192 /scratch/run42/nvdb", "/archive/ct \u2192 /archive/ct/nvdb"])
    equal(browser.texts("#watches .fact"), ["inotify, 24 done, 1 not taken yet, 1 overflow", "poll, 0 done"])
    equal(browser.texts("#watches .waiting"), ["15 (7.5 GiB)", "0"])
    equal(browser.texts("#watches dt"), ["Waiting", "Failed", "Quarantined", "Done a minute", "Last result"] * 2)
    equal(browser.texts("#watches .failed"), ["1", "0"])
    equal(browser.texts("#watches .quarantined"), ["0", "1"])
    equal(browser.texts("#watches .rate"), ["11.0", "0.0"])
    last = browser.texts("#watches .last")
    assert last[0].endswith(" s ago") and last[1] == "none yet", last
    equal(browser.script("return document.title"), "weir: 2 running, 15 waiting")
    equal(browser.visible("#banner"), False)
    no_overflow(browser)
    picture(browser, "light")
    browser.prefer("dark")
    ground, text = browser.script("""
        const style = getComputedStyle(document.body);
        return [style.backgroundColor, style.color]""")
    equal([ground, text], ["rgb(15, 21, 24)", "rgb(228, 236, 239)"])
    picture(browser, "dark")


def fits_a_narrow_window(browser):
    for width in (400, 700):
        browser.set_width(width)
        browser.open(url)
        loaded(browser)
        no_overflow(browser)
        equal(browser.script("return document.documentElement.scrollWidth"), width)
        picture(browser, f"narrow-{width}")


def plays_the_series(browser):
    browser.open(url)
    loaded(browser)
    caption = lambda: browser.text("#series-caption strong")
    browser.wait("the newest step", lambda: browser.script("return !!document.querySelector('#series-picture img')"))
    equal(browser.text("#series-place"), "24 of 24")
    equal(caption(), "density_24_512x512x512_float32.nvdb")
    browser.script("document.querySelector('#series-slider').focus()")
    browser.press("LEFT", "LEFT")
    equal(browser.text("#series-place"), "22 of 24")
    equal(caption(), "density_22_512x512x512_float32.nvdb")
    browser.press("HOME")
    equal(caption(), "density_1_512x512x512_float32.nvdb")  # sorted by number, not by letter
    browser.press("RIGHT")
    equal(caption(), "density_2_512x512x512_float32.nvdb")
    shown = lambda: browser.script("return document.querySelector('#series-picture img')?.src")
    browser.wait("its picture", lambda: "/api/jobs/2/thumbnails/0" in shown())
    equal(browser.script("return document.querySelector('#series-slider').getAttribute('aria-valuetext')"),
          "2 of 24: density_2_512x512x512_float32.nvdb")
    browser.press("END", "LEFT")
    browser.click("#series-play")
    equal(browser.text("#series-play"), "Stop")
    browser.wait("it goes round", lambda: browser.text("#series-place") == "3 of 24")
    browser.click("#series-play")
    equal(browser.text("#series-play"), "Play")
    place = browser.text("#series-place")
    browser.script("return new Promise(done => setTimeout(done, 500))")
    equal(browser.text("#series-place"), place)
    choose(browser, "#series-watch", "/archive/ct")
    browser.wait("no series there", lambda: browser.visible("#series-empty"))
    equal(browser.visible("#series"), False)


def works_with_the_keyboard(browser):
    browser.open(url)
    loaded(browser)
    focus = "const e = document.activeElement; return e.id || e.className + ' ' + e.innerText"
    seen = []
    browser.press("TAB")
    while not browser.script("return document.activeElement === document.body"):  # until the focus has gone round once
        seen.append(browser.script(focus))
        outlined = browser.script("return getComputedStyle(document.activeElement).outlineStyle")
        equal((seen[-1], outlined), (seen[-1], "solid"))
        browser.press("TAB")
    for wanted in ["pause", "name density_26_512x512x512_float32.raw", "retry-all",
                   "name density_9_512x512x512_float32.raw", "series-watch", "series-play", "series-slider",
                   "name density_24_512x512x512_float32.nvdb", "name density_25_512x512x512_float32.raw", "all-text",
                   "all-state", "all-watch", "sort Name"]:
        assert wanted in seen, f"{wanted} is not reached: {seen}"
    # The lists are redrawn, and the focus stays.
    browser.script("document.querySelector('#problems .name').focus()")
    wait_a_round(browser)
    equal(browser.script(focus), "name density_9_512x512x512_float32.raw")
    browser.press("ENTER")
    browser.wait("the job", lambda: browser.visible("#job"))
    equal(browser.text("#job-title"), "Job 101: density_9_512x512x512_float32.raw")
    facts = browser.texts("#job-facts dd")
    assert browser.text("#job-facts .path") == "/scratch/run42/density_9_512x512x512_float32.raw", facts
    assert "failed" in facts and "5" in facts, facts
    assert browser.text("#job-log").startswith("09:12:01 info survey: 128 of 512 MiB"), browser.text("#job-log")
    equal([browser.visible("#job-retry"), browser.visible("#job-cancel")], [True, False])
    equal(browser.script("return document.activeElement.id"), "job-close")
    picture(browser, "dialog")
    browser.press("ESCAPE")
    equal(browser.visible("#job"), False)
    equal(browser.script(focus), "name density_9_512x512x512_float32.raw")


def changes_jobs(browser):
    browser.open(url)
    loaded(browser)
    equal(browser.texts("#problems .name"), ["density_9_512x512x512_float32.raw", "patient <b>7.nrrd"])
    equal(browser.texts("#problems .reason")[1],
          "line 5: sizes: 512 512: 3 numbers are needed, found 2")
    browser.click("#problems li:nth-child(2) button:not(.name)")
    browser.wait("one problem less", lambda: len(browser.texts("#problems li")) == 1)
    browser.click("#retry-all")
    browser.wait("no problem", lambda: not browser.visible("#problems-section"))
    browser.click("#running .name")
    browser.wait("the job", lambda: browser.visible("#job"))
    browser.click("#job-cancel")
    browser.wait("cancelled", lambda: "cancelled" in browser.texts("#job-facts dd"))
    browser.click("#job-close")
    browser.click("#pause")
    browser.wait("paused", lambda: browser.text("#state") == "paused")
    equal(browser.text("#pause"), "Resume")
    browser.click("#pause")
    browser.wait("resumed", lambda: browser.text("#state") == "running")
    equal(asked_of_service(), ["retry 102", "retry all", "cancel 226", "pause", "resume"])


def only_views(browser):
    """Tests the page over TCP while the service has a control socket."""
    browser.open(url)
    loaded(browser)
    browser.wait("it is said", lambda: browser.visible("#view-only"))
    equal(browser.text("#view-only"), "View only")
    said = browser.script("return document.querySelector('#view-only').title")
    assert said.startswith("Pause, retry and cancel at unix:/"), said
    equal(browser.script("return [...document.querySelectorAll('.control')].filter(b => b.offsetParent !== null).length"), 0)
    browser.click("#running .name")
    browser.wait("the job", lambda: browser.visible("#job"))
    equal(browser.visible("#job-cancel"), False)
    equal(browser.visible("#job-close"), True)
    browser.click("#job-close")
    picture(browser, "view_only")


def shows_an_empty_service(browser):
    browser.open(url)
    loaded(browser)
    equal(browser.text("#running"), "Nothing is being converted.")
    equal(browser.text("#queue"), "The queue is empty.")
    equal(browser.text("#results"), "Nothing has been converted yet. What is finished shows up here.")
    equal(browser.text("#series-empty"), "Nothing was converted for this watch yet.")
    equal(browser.visible("#series"), False)
    equal(browser.visible("#problems-section"), False)
    equal(browser.visible("#not-taken-section"), False)
    equal(browser.visible("#plots"), False)
    equal(browser.text("#all-place"), "There are no jobs yet.")
    equal(browser.visible("#all-table"), False)
    equal(browser.text("#throughput"), "0 B/s")
    equal(browser.text("#queue-end"), "")
    picture(browser, "empty")


def shows_what_is_wrong(browser):
    browser.open(url)
    loaded(browser)
    equal(browser.text("#state"), "paused")
    equal(browser.text("#banner"),
          "Paused: /scratch has 1.2 GiB free and 4.0 GiB are needed. "
          "/archive/ct is not watched: it is not there; it is looked for every second.")
    equal(browser.texts("#watches .fact")[1], "down, 0 done")
    equal(browser.text("#queue-end"), "empty in about 75 s")
    equal(browser.visible("#results .view") or browser.visible("#series-view"), False)  # viewers are off
    picture(browser, "trouble")


def says_why_there_is_no_viewer(browser):
    browser.open(url)
    loaded(browser)
    browser.click("#results .view")
    browser.wait("that it is taken", lambda: browser.visible("#viewer-force"))
    equal(browser.text("#viewer-title"), "density_24_512x512x512_float32.nvdb")
    equal(browser.text("#viewer-note"),
          "Somebody looks at another series. Whoever does loses it when you open this one.")
    browser.click("#viewer-force")
    browser.wait("the reason", lambda: browser.text("#viewer-note") ==
                 "/scratch/run42/nvdb/density_24.nvdb: cannot open: No such file or directory.")
    equal(browser.visible("#viewer-force"), False)
    browser.click("#viewer-close")
    equal(browser.visible("#viewer"), False)
    asked = asked_of_service()
    assert asked[-1].startswith("force view "), asked
    browser.click("#results .name")
    browser.wait("the job", lambda: browser.visible("#job .view"))
    browser.click("#job .view")
    browser.wait("that it is taken", lambda: browser.visible("#viewer-force"))
    equal(browser.visible("#job"), False)
    refused = browser.complaints()  # Chromium's own lines for the two refused requests
    assert refused and all("423 (Locked)" in text for text in refused), refused


def says_when_the_service_is_gone(browser):
    browser.open(url)
    loaded(browser)
    browser.click("#pause")  # the service of this test ends then
    browser.wait("it is noticed", lambda: browser.text("#state") == "unreachable")
    banner = browser.text("#banner")
    assert banner.startswith("The service does not answer. Its last answer came "), banner
    assert banner.endswith(". Trying again."), banner
    equal(browser.visible("#main"), True)
    equal(browser.visible("#pause"), False)
    picture(browser, "unreachable")
    browser.complaints()  # refused connections, as expected


def asks_for_the_token(browser):
    browser.open(url)
    browser.wait("the form", lambda: browser.visible("#login"))
    equal(browser.visible("#main"), False)
    picture(browser, "token")
    browser.script("document.querySelector('#token').focus()")
    browser.press("guess", "ENTER")
    browser.wait("a refusal", lambda: browser.text("#login-error") == "This is not the token.")
    browser.press(" secret ", "ENTER")  # with blanks, as after a paste
    loaded(browser)
    equal(browser.visible("#login"), False)
    browser.wait("pictures, too", lambda: browser.script(
        "return document.querySelector('#results img')?.src.startsWith('blob:')"))
    browser.wait("the series, too", lambda: browser.script("return !!document.querySelector('#series-picture img')"))
    browser.complaints()  # 401, as expected
    browser.open(url)  # the tab remembers the token
    loaded(browser)


def shows_flow_and_disks(browser):
    browser.open(url)
    loaded(browser)
    equal(browser.texts(".flow dd:not(.bar)"), ["30.0 / min", "276.6 MiB/s", "11.0 / min", "104.9 MiB/s"])
    wide = browser.script("return ['arrived', 'converted'].map(n => document.querySelector(`#${n}-bar`).offsetWidth)")
    assert abs(wide[1] / wide[0] - 11 / 30) < 0.01, wide
    equal(browser.text("#queue-end"), "end not in sight: files arrive faster than they are converted")
    equal(browser.texts("#disks .lead"), ["Disk /scratch", "Disk /archive"])
    equal(browser.texts("#disks .fact"), ["1.2 GiB of 3.6 TiB free", "13.6 TiB of 18.2 TiB free"])
    equal(browser.texts("#disks .fills"),
          ["14.3 MiB/s written, full in about 86 s", "nothing written in the last 10 minutes"])
    held = "no room in /scratch/run42/nvdb, where 1.2 GiB are free; what needs more waits for it"
    equal([text for text in browser.texts("#disks .reason") if text], [f"Jobs wait: {held}"])
    equal(browser.text("#banner"), f"Jobs wait for room on /scratch: {held}.")
    equal([text for text in browser.texts("#running .reason") if text],
          ["nothing done by verify for 75 s: it waits for a device or a file server"])


def groups_problems(browser):
    browser.open(url)
    loaded(browser)
    equal(len(browser.texts("#problems > li")), 4)
    equal(browser.text(".disclosure"), "15 \u00d7 has 100 bytes and should have 512; write it again")
    equal(browser.texts("#problems > li > .name")[1:], ["density_9_512x512x512_float32.raw", "patient <b>7.nrrd"])
    equal(browser.text(".retry-group"), "Retry all 15")
    expanded = lambda: browser.script("return document.querySelector('.disclosure').getAttribute('aria-expanded')")
    equal((expanded(), browser.visible("#problems .inner")), ("false", False))
    browser.script("document.querySelector('.disclosure').focus()")
    browser.press("ENTER")
    browser.wait("its jobs", lambda: len(browser.texts("#problems .inner li")) == 15)
    equal((expanded(), browser.visible("#problems .inner")), ("true", True))
    equal(browser.texts("#problems .inner .name")[:2], ["pressure_1.raw", "pressure_2.raw"])
    equal(browser.text("#problems .inner .reason"), "has 100 bytes and should have 512; write it again")
    equal(browser.text("#problems .more"), "")
    wait_a_round(browser)
    equal((expanded(), browser.script("return document.activeElement.className")), ("true", "disclosure"))
    picture(browser, "problems")
    browser.click("#problems .inner li button:not(.name)")
    browser.wait("one less", lambda: browser.text(".retry-group") == "Retry all 14")
    equal(browser.text(".disclosure"), "14 \u00d7 has 101 bytes and should have 512; write it again")
    focus = browser.script("return document.activeElement.innerText")  # not lost with the removed job
    equal(focus, "Retry")
    browser.script("document.querySelector('.disclosure').focus()")
    browser.press("SPACE")
    browser.wait("closed", lambda: not browser.visible("#problems .inner"))
    browser.click(".retry-group")
    browser.wait("no group", lambda: len(browser.texts("#problems > li")) == 3)
    equal(asked_of_service(), ["retry 401", "retry problem has # bytes and should have #; write it again"])


def lists_all_jobs(browser):
    browser.open(url)
    loaded(browser)
    place = lambda: browser.text("#all-place")
    names = lambda: browser.texts("#all-rows .name")
    equal((place(), len(names())), ("1 to 50 of 79", 50))
    pressed = lambda name: browser.click(f"#all-headers .of-{name} button")
    sorted_as = lambda: browser.script(
        "return [...document.querySelectorAll('#all-headers [aria-sort]')].map(h => h.dataset.sort + ' ' + h.ariaSort)")
    equal(sorted_as(), ["changed descending"])
    pressed("source")
    browser.wait("by name", lambda: names()[0] == "patient <b>7.nrrd")
    equal(sorted_as(), ["source ascending"])
    pressed("bytes")
    pressed("bytes")
    browser.wait("the smallest", lambda: names()[:2] == ["pressure_1.raw", "pressure_2.raw"])
    equal(sorted_as(), ["bytes ascending"])

    browser.script("document.querySelector('#all-next').focus()")
    browser.press("ENTER")
    browser.wait("the next page", lambda: place() == "51 to 79 of 79")
    equal(len(names()), 29)
    equal(browser.script("return document.activeElement.id"), "all-next")
    browser.press("ENTER")  # there is no next page
    wait_a_round(browser)
    equal(place(), "51 to 79 of 79")
    browser.click("#all-previous")
    browser.wait("the first page", lambda: place() == "1 to 50 of 79")

    browser.script("document.querySelector('#all-text').focus()")
    browser.press("PRESSURE")
    browser.wait("what was looked for", lambda: place() == "1 to 18 of 18")
    at = "return [document.activeElement.id, document.activeElement.value, document.activeElement.selectionStart, scrollY]"
    before = browser.script(at)
    equal(before[:3], ["all-text", "PRESSURE", 8])
    wait_a_round(browser)
    equal(browser.script(at), before)
    browser.press("_1.")
    browser.wait("one", lambda: names() == ["pressure_1.raw"])
    equal(browser.texts("#all-rows .reason"), ["has 100 bytes and should have 512; write it again"])
    browser.press("none of this")
    browser.wait("none", lambda: place() == "No job fits.")
    equal(browser.visible("#all-table"), False)
    search(browser, "Marker")
    browser.wait("by its reason", lambda: names() == ["velocity_4.raw"])
    equal(browser.text("#all-rows .state"), "not taken yet")
    search(browser, "")
    choose(browser, "#all-watch", "/archive/ct")
    browser.wait("of one watch", lambda: place() == "1 to 5 of 5")
    choose(browser, "#all-watch", "")
    choose(browser, "#all-state", "cancelled")
    browser.wait("of one state", lambda: names() == ["stopped.raw"])
    tell_service("/api/jobs/241/cancel")
    browser.wait("what changes meanwhile", lambda: len(names()) == 2)
    browser.click("#all-rows .name")
    browser.wait("the job", lambda: browser.visible("#job"))


def shows_why_files_wait(browser):
    browser.open(url)
    loaded(browser)
    equal(browser.texts("#not-taken .name")[1:5], [f"velocity_{i}.raw" for i in range(1, 5)])
    equal(browser.texts("#not-taken .reason")[:5],
          ["it changed a moment ago", "a program has it open for writing", "it changed a moment ago",
           "it has 100 of 512 bytes", "its marker *.done is not there"])
    fact = browser.texts("#not-taken .fact")[1]
    assert fact.startswith("512.0 MiB, found ") and fact.endswith(" min ago"), fact
    equal((len(browser.texts("#not-taken li")), browser.text("#not-taken-more")), (10, "and 4 more"))
    browser.click("#not-taken li:nth-child(2) .name")
    browser.wait("the job", lambda: browser.visible("#job"))
    assert "a program has it open for writing" in browser.texts("#job-facts dd"), browser.texts("#job-facts dd")


def shows_plots(browser):
    browser.open(url)
    loaded(browser)
    browser.wait("plots", lambda: browser.visible("#plots"))
    labels = lambda name: browser.script(
        "return [...document.querySelectorAll(`#plot-${arguments[0]} text`)].map(t => t.textContent)", name)
    lines = lambda name: browser.script("""
        return [...document.querySelectorAll(`#plot-${arguments[0]} .line`)].map(l => l.points.numberOfItems)""", name)
    told = lambda name: browser.text(f"#plot-{name} .value")
    equal(labels("psnr"), ["51", "52", "53", "54", "step", "1", "5", "10", "15", "20", "lossless"])
    equal(labels("error")[:4], ["0.00", "0.01", "0.02", "0.03"])
    equal(lines("psnr"), [11, 7, 4])  # gaps at step 12 (unknown figures) and at step 20 (lossless)
    equal(lines("error"), [11, 12])
    equal(lines("range"), [11, 11, 12, 12])
    equal(browser.script("return document.querySelectorAll('#plot-range .band').length"), 2)
    equal(browser.text("#plot-error .heading .quiet"), "in the data's unit")
    equal(browser.script("return document.querySelector('#plot-psnr-summary').textContent"),
          "PSNR of 24 steps, from 51.4 to 53.7, 1 lossless, 1 unknown")
    equal([told("psnr"), told("error"), told("range")], ["53.7 dB", "0.024", "-0.48 to 2.2"])
    browser.script("document.querySelector('#plot-error .drawing').focus()")
    browser.press("HOME", "RIGHT")
    equal(browser.text("#series-place"), "2 of 24")
    equal([told("psnr"), told("error"), told("range")], ["51.5 dB", "0.002", "-0.04 to 1.1"])
    said = """
        const drawing = document.querySelector('#plot-psnr .drawing');
        return [drawing.ariaValueNow, drawing.ariaValueMax, drawing.ariaValueText]"""
    equal(browser.script(said), ["2", "24", "step 2: 51.5 dB"])
    browser.press("END", "LEFT", "LEFT", "LEFT", "LEFT")
    equal([browser.text("#series-place"), told("psnr"), told("error")], ["20 of 24", "lossless", "0"])
    browser.script("document.querySelector('#series-slider').focus()")
    browser.press("HOME", *["RIGHT"] * 11)
    equal([browser.text("#series-place"), told("psnr"), told("range")], ["12 of 24", "unknown", "unknown"])
    browser.click("#plot-psnr .drawing")  # its middle
    middle = int(browser.text("#series-place").split()[0])
    assert 11 <= middle <= 14, middle
    marks = browser.script("""
        return [...document.querySelectorAll('#plots .mark')].map(mark => {
          const plot = mark.ownerSVGElement.getBoundingClientRect();
          return (mark.getBoundingClientRect().left - plot.left) / plot.width})""")
    assert all(0.4 < at < 0.65 for at in marks), marks
    picture(browser, "plots")
    choose(browser, "#series-watch", "/archive/ct")
    browser.wait("the other series", lambda: browser.text("#series-place") == "4 of 4")
    equal(browser.text("#plot-error .heading .quiet"), "in the data's unit, log scale")
    equal(labels("error"), ["1e-6", "1e-4", "1e-2", "step", "1", "2", "3", "4"])
    picture(browser, "plots-log")


def enlarges_pictures(browser):
    browser.open(url)
    loaded(browser)
    title = lambda: browser.text("#picture-title")
    size = """
        const image = document.querySelector('#picture-frame img');
        const box = image?.getBoundingClientRect();
        return [image?.naturalWidth, image?.naturalHeight, image && getComputedStyle(image).objectFit, box?.height > 300]"""
    browser.script("document.querySelector('#results .picture').focus()")
    browser.press("ENTER")
    browser.wait("it is large", lambda: browser.script(size) == [120, 300, "contain", True])
    equal(title(), "scan_of_the_left_wing_" + "x" * 147 + "_step_4.nvdb")
    equal(browser.texts("#picture-facts span")[:5],
          ["64.0 MiB", "rate 8", "50.0 dB", "largest error 0.05", "values -1000 to 3000"])
    picture(browser, "picture")
    browser.press("RIGHT")
    equal((title(), browser.text("#picture-place")), ("density_24_512x512x512_float32.nvdb", "2 of 12"))
    browser.wait("the next", lambda: browser.script(size) == [256, 192, "contain", True])
    browser.click("#picture-next")
    equal(title(), "density_23_512x512x512_float32.nvdb")
    browser.click("#picture-previous")
    browser.press("LEFT", "LEFT")  # past the first picture to the last
    equal(browser.text("#picture-place"), "12 of 12")
    browser.press("ESCAPE")
    equal(browser.visible("#picture"), False)
    equal(browser.script("return document.activeElement === document.querySelector('#results .picture')"), True)
    browser.click("#series-picture")
    browser.wait("the step", lambda: browser.text("#picture-place") == "24 of 24")
    browser.press("LEFT", "LEFT")
    equal((title(), browser.text("#series-place")), ("density_22_512x512x512_float32.nvdb", "22 of 24"))
    browser.click("#picture-close")
    equal(browser.script("return document.activeElement.id"), "series-picture")
    equal(browser.text("#series-caption strong"), "density_22_512x512x512_float32.nvdb")


def copies_paths(browser):
    browser.devtools("Browser.grantPermissions", permissions=["clipboardReadWrite", "clipboardSanitizedWrite"])
    browser.open(url)
    loaded(browser)
    clipboard = lambda: browser.script("return navigator.clipboard.readText()")
    browser.click("#results li:nth-child(2) .name")
    browser.wait("the job", lambda: browser.visible("#job"))
    browser.click("#job .copy")
    browser.wait("it says so", lambda: browser.text("#job .copy-note") == "copied")
    equal(clipboard(), "/scratch/run42/density_24_512x512x512_float32.raw")
    browser.wait("for a moment", lambda: browser.text("#job .copy-note") == "")
    browser.press("ESCAPE")
    browser.click("#results li:nth-child(2) .picture")
    browser.wait("the picture", lambda: browser.visible("#picture"))
    browser.click("#picture .copy")
    browser.wait("it says so", lambda: browser.text("#picture .copy-note") == "copied")
    equal(clipboard(), "/scratch/run42/nvdb/density_24_512x512x512_float32.nvdb")
    # Without a secure context there is no clipboard.
    browser.script("Object.defineProperty(navigator, 'clipboard', {value: undefined})")
    browser.click("#picture-paths dd:last-child .copy")
    browser.wait("what to do", lambda: browser.text("#picture-paths dd:last-child .copy-note") ==
                 "Select and copy: it is selected now.")
    equal(browser.script("return getSelection().toString()"), "/scratch/run42/density_24_512x512x512_float32.raw")


def clamps_long_names(browser):
    for width in (390, 1200):
        browser.set_width(width)
        browser.open(url)
        loaded(browser)
        search(browser, "_wing_")
        browser.wait("long names", lambda: browser.script(
            "return [...document.querySelectorAll('#all-rows .name')].filter(n => n.title.length > 180).length") == 4)
        lines, cut = browser.script("""
            const names = [...document.querySelectorAll('.name .clamped')].filter(n => n.checkVisibility());
            const lines = names.map(n => Math.round(n.clientHeight / parseFloat(getComputedStyle(n).lineHeight)));
            return [Math.max(...lines), names.filter(n => n.scrollHeight > n.clientHeight + 2).length]""")
        equal((lines, cut), (2, 0))
        shown = browser.text("#results .name")
        assert shown.startswith("scan_of_the_left") and shown.endswith("_step_4.nvdb") and len(shown) == 36, shown
        shown = browser.text("#problems .name")
        assert shown.startswith("pressure_of_the_left_wing_") and shown.endswith("_step_2.raw"), shown
        no_overflow(browser)
        whole = "scan_of_the_left_wing_" + "x" * 147 + "_step_4.raw"
        browser.click("#results .name")
        browser.wait("the job", lambda: browser.visible("#job"))
        equal(browser.text("#job-title"), f"Job 501: {whole}")
        no_overflow(browser)
        picture(browser, f"long-names-{width}")


def has_large_targets(browser):
    small = lambda within: browser.script("""
        return [...document.querySelectorAll(`${arguments[0]} :is(button, input, select, a, [tabindex="0"]:not(pre))`)]
            .filter(e => e.checkVisibility()).map(e => [e, e.getBoundingClientRect()])
            .filter(([e, box]) => box.width < 44 || box.height < 44)
            .map(([e, box]) => `${e.tagName} ${e.id} ${e.getAttribute('class')} ${box.width} x ${box.height}`)""", within)
    browser.set_width(390)
    browser.open(url)
    loaded(browser)
    browser.click(".disclosure")
    browser.wait("its jobs", lambda: browser.visible("#problems .inner"))
    browser.wait("plots", lambda: browser.visible("#plots"))
    equal(small("body"), [])
    no_overflow(browser)
    picture(browser, "narrow-390")
    browser.click("#results .picture")
    browser.wait("the picture", lambda: browser.visible("#picture"))
    equal(small("#picture"), [])
    browser.press("ESCAPE")
    browser.click("#results .name")
    browser.wait("the job", lambda: browser.visible("#job"))
    equal(small("#job"), [])


def waits_for_the_viewer(browser):
    place = url + "/view/?job=1#f=s_2.nvdb&az=3"
    browser.open(place)
    equal(browser.text("p"), "the viewer is being started; ask again in a moment.")
    browser.wait("it asks again",
                 lambda: browser.script("return performance.getEntriesByType('navigation')[0]?.type") == "reload")
    equal(browser.script("return location.href"), place)
    browser.complaints()  # it was refused, as expected


with Browser() as chromium:
    globals()[case](chromium)
    equal(chromium.complaints(), [])
