"""The built-in page in a real browser: draws, answers keys and clicks, reconnects.

Usage: page_test.py SLAMMOT [--pictures FOLDER]. Skipped (77) where Chromium or websockets is missing.
"""

import argparse
import asyncio
import sys
from pathlib import Path

try:
    from browser import find_chromium, open_page
except ImportError as fault:
    print(f"skipped: {fault}; Debian's python3-websockets is needed")
    sys.exit(77)

from live import Live

IS_LIVE = "window.slammot && slammot.state() === 'live'"


def check(condition, what):
    if not condition:
        sys.exit(f"failed: {what}")
    print(f"ok: {what}")


async def comes_alive(page, live, view=""):
    await page.go(f"http://localhost:{live.port}/{view}")
    check(await page.comes_to(IS_LIVE), "the page shows the drive")


async def test_controls(page):
    await page.key("t")
    check(await page.value("slammot.camera.wantedTilt > 0"), "T tilts the view")
    await page.key("f")
    check(not await page.value("slammot.camera.follows"), "F frees the camera")
    check(await page.comes_to("location.hash.includes('f=0') && location.hash.includes('x=')"), "the address keeps the view")
    theme = await page.value("slammot.options.theme")
    await page.key("d")
    check(await page.value("document.documentElement.dataset.theme") != theme, "D changes the theme")
    for key in "tfd":
        await page.key(key)


async def test_selection(page):
    check(await page.comes_to("slammot.world.confirmedCount > 0"), "there are tracks")
    await asyncio.sleep(1)
    at = await page.value(
        "(() => { const t = [...slammot.world.tracks.values()].find(t => t.confirmed); const c = slammot.camera;"
        "const p = c.project(...slammot.world.positionOf(t), t.height / 2, c.lastMatrix); return p; })()")
    if not (at and 0 < at[0] < 1280 and 60 < at[1] < 740):
        return print("no track is in the picture: the click is not tried")
    await page.click(*at)
    check(await page.comes_to("slammot.options.selected !== null && !document.getElementById('details').hidden", 5),
          "a click on a track shows what is known about it")


async def test_lanes(page):
    check(await page.comes_to("slammot.world.lanes.length > 0", 60), "there are lanes or walkways")
    strips = ("(() => { const { options, scene, camera } = slammot; const before = options.layers.lanes; options.layers.lanes = %s;"
              "scene.draw(camera, options, 0); options.layers.lanes = before; return scene.shapes.lines.count; })()")
    hidden, shown, lanes = [await page.value(script) for script in (strips % 0, strips % 1, "slammot.world.lanes.length")]
    check(shown >= hidden + 2 * lanes, f"{lanes} pieces of lanes and walkways are drawn, and can be hidden")
    check(await page.value("document.querySelector('[data-layer=lanes]') !== null"), "they are a layer")
    simplified = await page.value("import('./geometry.js').then((geometry) => geometry.simplified([0, 0, 1, 0.1, 2, 0, 4, 3, 6, 0.1, 9, 0], 0.2))")
    check(simplified == [0, 0, 2, 0, 4, 3, 6, 0.1, 9, 0], "long lines are as fine as they can be seen, with both ends")


async def test_disconnection(page):
    before = await page.value("slammot.connection.receivedBytes")
    await page.value("slammot.connection.socket.close()")
    check(await page.comes_to("slammot.state() === 'lost'", 5), "a lost connection is said")
    check(await page.comes_to(f"{IS_LIVE} && slammot.connection.receivedBytes > {before}", 10), "the page reconnects by itself")


async def take_pictures(page, live, folder):
    views = {"live_top_dark": "#q=1&c=dark&d=95", "live_tilted_dark": "#q=1&c=dark&d=60&t=0.95", "live_top_light": "#q=1&c=light&d=95",
             "live_map_dark": "#q=1&c=dark&d=420&l=graph:0.8"}
    for name, view in views.items():
        await page.go("about:blank")
        await comes_alive(page, live, view)
        await asyncio.sleep(8)
        await page.picture(Path(folder) / f"{name}.png")


async def main(options):
    with Live(options.slammot, scenario="city" if options.pictures else "block") as live:
        live.wait_until_ready()
        async with open_page() as page:
            if options.pictures:
                await asyncio.sleep(options.after)
                await take_pictures(page, live, options.pictures)
            else:
                await comes_alive(page, live, "#c=dark")
                await test_controls(page)
                await test_selection(page)
                await test_lanes(page)
                await test_disconnection(page)
            check(not [fault for fault in page.faults if "ERR_CONNECTION" not in fault], f"no errors {page.faults[:3]}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("slammot")
    parser.add_argument("--pictures", help="folder for pictures of each view, in place of the tests")
    parser.add_argument("--after", type=float, default=60, help="seconds of the drive before the pictures")
    if find_chromium() is None:
        print("skipped: Debian's chromium is needed")
        sys.exit(77)
    asyncio.run(main(parser.parse_args()))
