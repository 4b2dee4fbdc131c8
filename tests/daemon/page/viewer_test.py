"""viewer_test.py URL SOURCES TOKEN: tests View on the page of a real service at URL, which converts files in SOURCES,
in headless Chromium. Writes screenshots to WEIR_PAGE_SCREENSHOTS if that is set. Exits with 0 if the test passes."""

import os
import pathlib
import sys

from webdriver import Browser

url, sources, token = sys.argv[1:4]
pictures = os.environ.get("WEIR_PAGE_SCREENSHOTS")


def equal(found, expected):
    assert found == expected, f"found {found!r}, expected {expected!r}"


def picture(browser, name):
    if pictures:
        browser.screenshot(os.path.join(pictures, name + ".png"))


def canvas(browser):
    return browser.script("return document.querySelector('#canvas').toDataURL('image/png')")


def converged(browser):
    browser.wait("the picture is done", lambda: (browser.text("#quality") or "").endswith(", done"), 60)


with Browser(1200, 900) as page:
    page.open(url)
    page.wait("the login", lambda: page.visible("#login"))
    page.script("""
        document.querySelector('#token').value = arguments[0];
        document.querySelector('#login button').click()""", token)
    page.wait("a result", lambda: page.visible("#results .card .view"), 60)
    page.wait("its picture", lambda: page.visible("#results .card img"), 60)
    equal(page.visible("#series-view"), True)
    picture(page, "service-view-button")
    page.complaints()  # about requests before the token was given

    if not pictures:
        page.set_width(390, 500)  # a small picture is finished sooner
    page.click("#results .card .view")
    page.wait("the viewer's page", lambda: page.script("return location.pathname") == "/view/", 60)
    page.wait("it is filled", lambda: page.visible("#main"))
    converged(page)
    equal(page.text("#link"), "connected")
    equal(page.text("#file-name"), "s_1_24x20x16_uint8.nvdb")
    equal(page.visible("#steps"), False)
    shades = page.script("""
        const canvas = document.querySelector('#canvas');
        const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
        return new Set(data).size""")
    assert shades > 50, f"an empty picture: {shades} values"

    # The forecast of a conversion for the scene, within the viewer's share of the service's memory.
    page.script("""
        document.querySelector('#convert-panel').open = true;
        const budget = document.querySelector('#budget');
        budget.value = 'psnr';
        budget.dispatchEvent(new Event('change'))""")
    forecast = page.wait("a forecast", lambda: not (page.text("#convert-forecast") or "Being").startswith("Being") and
                         page.text("#convert-forecast"), 60)
    assert forecast.startswith("Expected: "), forecast
    page.script("document.querySelector('#convert-panel').open = false")

    # The simulation writes another step.
    data = bytes(i * 7 % 251 for i in range(24 * 20 * 16))
    hidden = pathlib.Path(sources, ".s_2")
    hidden.write_bytes(data)
    hidden.rename(pathlib.Path(sources, "s_2_24x20x16_uint8.raw"))
    page.wait("its step", lambda: page.text("#step-name") == "1 of 2: s_1_24x20x16_uint8.nvdb", 60)
    equal(page.text("#step-news"), "new step")
    before = canvas(page)
    page.click("#follow")
    page.wait("it is shown", lambda: page.text("#step-name") == "2 of 2: s_2_24x20x16_uint8.nvdb")
    converged(page)
    assert canvas(page) != before, "the picture is the same"
    picture(page, "service-viewer")
    equal(page.complaints(), [])

    # Back, and to another step of the same series: the viewer stays the same.
    page.click("#service")
    page.wait("the service's page", lambda: page.visible("#results .card .view"))
    page.click("#results .card:nth-child(2) .view")
    page.wait("the viewer's page", lambda: page.script("return location.pathname") == "/view/")
    page.wait("the first step", lambda: page.text("#step-name") == "1 of 2: s_1_24x20x16_uint8.nvdb", 30)
    converged(page)
    equal(page.complaints(), [])

    # Somebody else opens another file: this page says so, keeps its picture and its name, and gets the viewer back.
    def ask(target):
        return page.script("""
            return fetch(arguments[0], {method: arguments[0].includes('/view?') ? 'POST' : 'GET',
                                        headers: {'X-Weir': 'page', Authorization: `Bearer ${arguments[1]}`}})
                .then((response) => response.json())""", target, token)

    def done():
        return {pathlib.Path(job["source"]).name: job for job in ask("/api/jobs?state=done")["jobs"]}

    other = "t_24x20x16_uint8"
    hidden.write_bytes(bytes(251 - byte for byte in data))
    hidden.rename(pathlib.Path(sources, other + ".raw"))
    page.wait("its job", lambda: other + ".raw" in done(), 60)
    before = canvas(page)
    taken = ask(f"/api/jobs/{done()[other + '.raw']['id']}/view?force=1")
    equal(taken["file"].rpartition("/")[2], other + ".nvdb")
    page.wait("the notice", lambda: page.text("#other-series-note") ==
              f"The viewer now shows another file, {other}.nvdb. This page is of s_1_24x20x16_uint8.nvdb.", 60)
    equal(page.text("#link"), "another file")
    equal(page.text("#file-name"), "s_1_24x20x16_uint8.nvdb")
    equal(page.script("return document.title"), "s_1_24x20x16_uint8.nvdb \u2013 weir view")
    equal(canvas(page) == before, True)
    picture(page, "service-other-file")
    page.complaints()  # about requests while there was no viewer
    page.click("#take-back")
    page.wait("that it is being opened by somebody", lambda: "loses it" in page.text("#other-series-note"))
    equal(page.text("#take-back"), "Take it all the same")
    page.complaints()
    page.click("#take-back")
    page.wait("it is back", lambda: page.text("#link") == "connected", 60)
    equal(page.visible("#other-series"), False)
    converged(page)
    equal(page.text("#file-name"), "s_1_24x20x16_uint8.nvdb")
    equal(canvas(page) == before, True)
