"""The page with the map of a whole drive: frames a second, bytes a second, time to the first picture, and memory over time.

Usage: page_load_test.py SLAMMOT [--recording FILE] [--scenario block] [--minutes 2] [--speed 1] [--from S]. `--recording` names a long drive,
such as the 5 km of the scenario demo; --speed is chosen so that it plays as it was driven. Skipped (77) where Chromium or websockets is
missing. The rate of frames is judged on a machine that does nothing else (--strict).
"""

import argparse
import asyncio
import os
import pathlib
import sys
import tempfile
import time

try:
    from browser import find_chromium, open_page
except ImportError as fault:
    print(f"skipped: {fault}; Debian's python3-websockets is needed")
    sys.exit(77)

from recorded import Recorded, recording_of

LEAST_FRAMES_PER_S = 30
MOST_BYTES_PER_S = 2e6
MOST_SECONDS_TO_PICTURE = 2.0
MOST_GROWTH_MB = 20
SETTLE_S = 10
VISITS = 3
SAMPLE_S = 15


def check(condition, what):
    if not condition:
        sys.exit(f"failed: {what}")
    print(f"ok: {what}", flush=True)


async def used_memory_mb(page):
    await page.call("HeapProfiler.collectGarbage")
    return (await page.call("Runtime.getHeapUsage"))["usedSize"] / 1e6


async def sample(page, seconds):
    """{frames a second, bytes a second}"""
    state = "[performance.now(), slammot.frames(), slammot.connection.receivedBytes]"
    before = await page.value(state)
    await asyncio.sleep(seconds)
    after = await page.value(state)
    span_s = (after[0] - before[0]) / 1000
    return (after[1] - before[1]) / span_s, (after[2] - before[2]) / span_s


async def first_picture(page, recorded):
    """Seconds to the first picture with pose and map, and until all submaps are there."""
    begin = time.monotonic()
    await page.go(f"http://localhost:{recorded.port}/#c=dark&d=420&l=graph:0.8")
    check(await page.comes_to("window.slammot && slammot.world.pose && [...slammot.map.submaps.values()].some(s => s.texture)"), "the page shows the map")
    picture_s = time.monotonic() - begin
    check(await page.comes_to("[...slammot.map.submaps.values()].every(s => s.texture)"), "all submaps are there")
    return picture_s, time.monotonic() - begin


async def main(options):
    with tempfile.TemporaryDirectory() as folder:
        recording = recording_of(options, folder)
        with Recorded(options.slammot, recording, "--speed", options.speed, "--from", options.from_s, "--loop") as recorded:
            recorded.wait_until_ready()
            visits = []
            for _ in range(VISITS - 1):
                async with open_page() as page:
                    visits.append((await first_picture(page, recorded))[0])
            async with open_page() as page:
                picture_s, complete_s = await first_picture(page, recorded)
                visits.append(picture_s)
                count = await page.value("slammot.map.submaps.size")
                driven = await page.value("slammot.world.drivenLength")
                print(f"first picture after {picture_s:.2f} s, all {count} submaps after {complete_s:.2f} s, {driven:.0f} m driven")
                await asyncio.sleep(SETTLE_S)
                rows, end = [], time.monotonic() + 60 * options.minutes
                while time.monotonic() < end or len(rows) < 2:
                    frames, data = await sample(page, SAMPLE_S)
                    rows.append((frames, data, await used_memory_mb(page)))
                    load = os.getloadavg()[0]
                    print(f"{frames:.1f} frames/s, {data / 1e6:.2f} MB/s, heap {rows[-1][2]:.1f} MB, load {load:.1f}", flush=True)
                check(not page.faults, f"no errors {page.faults[:3]}")
        check(max(row[1] for row in rows) < MOST_BYTES_PER_S, "at most 2 MB/s")
        growth = rows[-1][2] - rows[len(rows) // 2][2]
        check(growth < MOST_GROWTH_MB, f"memory does not grow: {growth:+.1f} MB in the second half")
        if options.strict:
            texts = ", ".join(f"{visit_s:.2f}" for visit_s in visits)
            check(sorted(visits)[VISITS // 2] < MOST_SECONDS_TO_PICTURE, f"first picture within 2 s, by the median of browsers just started: {texts} s")
            check(sorted(row[0] for row in rows)[len(rows) // 2] >= LEAST_FRAMES_PER_S, "at least 30 frames/s")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("slammot")
    parser.add_argument("--recording", type=pathlib.Path)
    parser.add_argument("--scenario", default="block")
    parser.add_argument("--minutes", type=float, default=0.5)
    parser.add_argument("--speed", default="1")
    parser.add_argument("--from", dest="from_s", default="0")
    parser.add_argument("--strict", action="store_true", help="judge frames and time to the first picture, too")
    if find_chromium() is None:
        print("skipped: Debian's chromium is needed")
        sys.exit(77)
    asyncio.run(main(parser.parse_args()))
