"""The page that a run writes, in a real browser: plays, seeks, shows a track; and the comparison of two results.

Usage: report_test.py SLAMMOT [--pictures FOLDER]. Skipped (77) where Chromium or websockets is missing.
"""

import argparse
import asyncio
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "gateway"))
try:
    from browser import find_chromium, open_page
except ImportError as fault:
    print(f"skipped: {fault}; Debian's python3-websockets is needed")
    sys.exit(77)

MOST_SECONDS_TO_SEEK = 1.0
BUSIEST = "(() => { const c = slammotReport.timeline.counts; return slammotReport.recording.is.time[c.indexOf(Math.max(...c))]; })()"


def check(condition, what):
    if not condition:
        sys.exit(f"failed: {what}")
    print(f"ok: {what}")


async def opens(page, file, name="window.slammotReport"):
    await page.go(f"file://{file}")
    check(await page.comes_to(f"{name} && slammotReport.scene.map.parts.length === 1"), f"{file.name} opens without a server, with its map")


async def test_lanes(page):
    lanes = await page.value("slammotReport.recording.header.lanes.length")
    strips = "(() => { const p = slammotReport; p.options.layers.lanes = %s; p.scene.draw(p.camera, p.options, 0); return p.scene.shapes.lines.count; })()"
    hidden, shown = [await page.value(strips % opacity) for opacity in (0, 0.7)]
    check(lanes > 0 and shown >= hidden + 2 * lanes, f"{lanes} lanes and walkways are drawn, and can be hidden")


async def test_time(page):
    duration = await page.value("slammotReport.recording.duration")
    elapsed_ms = await page.value(
        "(() => { const begin = performance.now(); for (let i = 0; i < 20; ++i) slammotReport.seek(slammotReport.recording.duration * i / 20);"
        " return performance.now() - begin; })()")
    check(elapsed_ms / 20 < MOST_SECONDS_TO_SEEK * 1000, f"any moment of {duration:.0f} s is found within {MOST_SECONDS_TO_SEEK:.0f} s")
    await page.value("slammotReport.seek(0)")
    await page.value("document.getElementById('play').click()")
    check(await page.comes_to("slammotReport.replay.time > 0.3", 10), "it plays")
    await page.value("document.getElementById('play').click()")
    check(not await page.value("slammotReport.isPlaying"), "it pauses")
    before = await page.value("slammotReport.replay.time")
    await page.value("document.getElementById('forward').click()")
    check(abs(await page.value("slammotReport.replay.time") - before - 0.2) < 1e-3, "it steps")
    box = await page.value("(() => { const r = document.getElementById('timeline').getBoundingClientRect(); return [r.left, r.top, r.width, r.height]; })()")
    await page.click(box[0] + box[2] / 2, box[1] + box[3] / 2)
    check(abs(await page.value("slammotReport.replay.time") - duration / 2) < duration / 50, "a click on the bar of time goes there")


async def test_track(page):
    await page.value(f"slammotReport.seek({BUSIEST})")
    await asyncio.sleep(1.5)  # the camera follows smoothly
    labels = "[...document.querySelectorAll('#labels p')].filter(l => l.style.visibility !== 'hidden' && l.getBoundingClientRect().width > 0).length"
    check(await page.value(labels) > 0, "tracks have labels")
    at = await page.value(
        "(() => { const p = slammotReport, c = p.camera; return [...p.replay.tracks.values()].map(t => c.project(...t.position, t.height / 2, c.lastMatrix))"
        ".find(([x, y]) => x > 40 && x < 1000 && y > 80 && y < 500); })()")
    if at is None:
        return print("no track is in the picture: the click is not tried")
    await page.click(*at)
    check(await page.value("!document.getElementById('details').hidden"), "a click on a track shows its identity, class and plots")
    check(await page.value("document.querySelectorAll('#details canvas').length") == 2, "speed and existence are plotted")


async def test_comparison(page, file):
    await page.go(f"file://{file}")
    check(await page.comes_to("window.length === 2 && [...document.querySelectorAll('iframe')].every(f => f.contentWindow.slammotReport)"), "two results stand side by side")
    await page.value("(() => { const p = frames[0].contentWindow.slammotReport; p.leads = true; p.seek(2); })()")
    check(await page.comes_to("frames[1].contentWindow.slammotReport.replay.time === 2", 10), "both show the same moment")


def slammot(program, *words):
    subprocess.run([program, *map(str, words)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


async def take_pictures(page, folder):
    views = {"report_dark": ("dark", 0.95)}
    for name, (theme, tilt) in views.items():
        await page.value(f"(() => {{ const p = slammotReport; p.options.theme = '{theme}'; p.applyTheme(); p.camera.wantedTilt = {tilt}; p.camera.distance = 60;"
                         f" p.seek({BUSIEST}); }})()")
        await asyncio.sleep(3)
        await page.picture(Path(folder) / f"{name}.png")


async def main(options):
    with tempfile.TemporaryDirectory() as folder:
        result = Path(folder) / "drive"
        slammot(options.slammot, "run", "--scenario", "city" if options.pictures else "block", "--output", result)
        async with open_page() as page:
            await opens(page, result / "report.html")
            if options.pictures:
                return await take_pictures(page, options.pictures)
            await test_lanes(page)
            await test_time(page)
            await test_track(page)
            slammot(options.slammot, "report", result, result, "--output", Path(folder) / "comparison.html")
            await test_comparison(page, Path(folder) / "comparison.html")
            check(not page.faults, f"no errors {page.faults[:3]}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("slammot")
    parser.add_argument("--pictures", help="folder for pictures of the page, in place of the tests")
    if find_chromium() is None:
        print("skipped: Debian's chromium is needed")
        sys.exit(77)
    asyncio.run(main(parser.parse_args()))
