"""page_test.py URL CASE [DIRECTORY]: one test of the page at URL in headless Chromium, against the service of
tests/daemon/page_test.cpp. Screenshots go into DIRECTORY, where one is given. Exits with 0 where all holds."""

import json
import os
import sys

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
    """What the page made the service do."""
    with DIRECT.open(url + "/api/jobs/9999") as answer:
        return json.load(answer)["reason"].split(", ")


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
    equal(browser.text("#queue-age"), "waiting, the oldest for 62 s, 1 more not complete yet")
    equal(browser.text("#done"), "24")
    equal(browser.text("#totals"), "done; since start 12.0 GiB in, 1.5 GiB out")
    equal(browser.text("#broken"), "2")
    equal(browser.texts("#running .name"), ["density_26_512x512x512_float32.raw", "density_27_512x512x512_float32.raw"])
    equal(browser.texts("#running .step"), ["convert", "verify"])
    equal(browser.script("return [...document.querySelectorAll('#running progress')].map(p => p.position)"), [0.62, -1])
    equal(browser.texts("#running .fact")[0], "62 %, 4.1 s, source 512.0 MiB")
    equal(len(browser.texts("#queue li")), 10)
    equal(browser.text("#queue-more"), "and 5 more")
    assert browser.texts("#queue .fact")[0].startswith("512.0 MiB, attempt 2 in "), browser.texts("#queue .fact")[0]
    equal([text for text in browser.texts("#queue .reason") if text],
          ["/scratch/run42/density_25_512x512x512_float32.raw: read: Resource temporarily unavailable"])
    equal(len(browser.texts("#results .card")), 12)
    equal(browser.text("#results .card .name"), "density_24_512x512x512_float32.nvdb")
    equal(browser.text("#results .card .fact"), "64.0 MiB, rate 8")
    equal(browser.texts("#results .card .quality")[:5],
          ["PSNR 53.7 dB", "PSNR 53.6 dB", "PSNR 53.5 dB", "PSNR 53.4 dB", "lossless"])
    equal(browser.script("return document.querySelectorAll('#results img').length"), 12)
    equal(browser.texts("#watches .lead"),
          ["/scratch/run42 \u2192 /scratch/run42/nvdb", "/archive/ct \u2192 /archive/ct/nvdb"])
    equal(browser.texts("#watches .fact"), ["inotify, 24 done, 1 overflow", "poll, 0 done"])
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
    equal(caption(), "density_1_512x512x512_float32.nvdb")  # by number, not by letter
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
    browser.script("""
        const choice = document.querySelector('#series-watch');
        choice.value = '/archive/ct';
        choice.dispatchEvent(new Event('change'))""")
    browser.wait("no series there", lambda: browser.visible("#series-empty"))
    equal(browser.visible("#series"), False)


def works_with_the_keyboard(browser):
    browser.open(url)
    loaded(browser)
    focus = "const e = document.activeElement; return e.id || e.className + ' ' + e.innerText"
    seen = []
    browser.press("TAB")
    while not browser.script("return document.activeElement === document.body"):  # until once round
        seen.append(browser.script(focus))
        outlined = browser.script("return getComputedStyle(document.activeElement).outlineStyle")
        equal((seen[-1], outlined), (seen[-1], "solid"))
        browser.press("TAB")
    for wanted in ["pause", "name density_26_512x512x512_float32.raw", "retry-all",
                   "name density_9_512x512x512_float32.raw", "series-watch", "series-play", "series-slider",
                   "name density_24_512x512x512_float32.nvdb", "name density_25_512x512x512_float32.raw"]:
        assert wanted in seen, f"{wanted} is not reached: {seen}"
    # The lists are drawn anew under the focus, which stays.
    browser.script("document.querySelector('#problems .name').focus()")
    browser.script("return new Promise(done => setTimeout(done, 2500))")
    equal(browser.script(focus), "name density_9_512x512x512_float32.raw")
    browser.press("ENTER")
    browser.wait("the job", lambda: browser.visible("#job"))
    equal(browser.text("#job-title"), "Job 101: density_9_512x512x512_float32.raw")
    facts = browser.texts("#job-facts dd")
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
          "/archive/ct/patient <b>7.nrrd: line 5: sizes: 512 512: 3 numbers are needed, found 2")
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


def shows_an_empty_service(browser):
    browser.open(url)
    loaded(browser)
    equal(browser.text("#running"), "Nothing is being converted.")
    equal(browser.text("#queue"), "The queue is empty.")
    equal(browser.text("#results"), "Nothing has been converted yet. What is finished shows up here.")
    equal(browser.text("#series-empty"), "Nothing was rendered for this watch yet.")
    equal(browser.visible("#series"), False)
    equal(browser.visible("#problems-section"), False)
    equal(browser.text("#throughput"), "0 B/s")
    picture(browser, "empty")


def shows_what_is_wrong(browser):
    browser.open(url)
    loaded(browser)
    equal(browser.text("#state"), "paused")
    equal(browser.text("#banner"),
          "Paused: /scratch has 1.2 GiB free and 4.0 GiB are needed. "
          "/archive/ct is not watched: it is not there; it is looked for every second.")
    equal(browser.texts("#watches .fact")[1], "down, 0 done")
    picture(browser, "trouble")


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
    browser.complaints()  # refused connections, as they should be


def asks_for_the_token(browser):
    browser.open(url)
    browser.wait("the form", lambda: browser.visible("#login"))
    equal(browser.visible("#main"), False)
    picture(browser, "token")
    browser.script("document.querySelector('#token').focus()")
    browser.press("guess", "ENTER")
    browser.wait("a refusal", lambda: browser.text("#login-error") == "This is not the token.")
    browser.press("secret", "ENTER")
    loaded(browser)
    equal(browser.visible("#login"), False)
    browser.wait("pictures, too", lambda: browser.script(
        "return document.querySelector('#results img')?.src.startsWith('blob:')"))
    browser.wait("the series, too", lambda: browser.script("return !!document.querySelector('#series-picture img')"))
    browser.complaints()  # 401, as it should be
    browser.open(url)  # the tab remembers it
    loaded(browser)


with Browser() as chromium:
    globals()[case](chromium)
    equal(chromium.complaints(), [])
