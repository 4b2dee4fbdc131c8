"""viewer_test.py URL SOURCES TOKEN: View on the page of a real service at URL, which converts what comes into SOURCES, in
headless Chromium. Screenshots go to WEIR_PAGE_SCREENSHOTS, where that is set. Exits with 0 where all holds."""

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
    page.complaints()  # of requests before the token was given

    if not pictures:
        page.set_width(390, 500)  # a small picture, soon done
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

    # The simulation goes on.
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

    # Back, and to another step of the same series: the same viewer.
    page.click("#service")
    page.wait("the service's page", lambda: page.visible("#results .card .view"))
    page.click("#results .card:nth-child(2) .view")
    page.wait("the viewer's page", lambda: page.script("return location.pathname") == "/view/")
    page.wait("the first step", lambda: page.text("#step-name") == "1 of 2: s_1_24x20x16_uint8.nvdb", 30)
    converged(page)
    equal(page.complaints(), [])
