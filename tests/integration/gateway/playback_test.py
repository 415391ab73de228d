"""A recorded drive under the gateway: any second is shown within a second of asking for it; the page plays, pauses, steps and seeks; and
it comes back by itself when the gateway was killed.

Usage: playback_test.py SLAMMOT [--recording FILE] [--scenario block] [--pictures FOLDER]. Skipped (77) where Chromium or websockets is missing.
"""

import argparse
import asyncio
import json
import pathlib
import random
import struct
import sys
import tempfile
import time

try:
    import websockets
    from browser import find_chromium, open_page
except ImportError as fault:
    print(f"skipped: {fault}; Debian's python3-websockets is needed")
    sys.exit(77)

from recorded import Recorded, recording_of

MOST_SECONDS_TO_SEEK = 1.0
BEGINS_S = 2.0  # a recording begins before its drive
ENDS_S = 3.0  # and ends after it
APART_S = 3.0  # places to seek for
STREAM_NS = 3_000_000_000  # of the drive: poses that were on their way when a seek began are no later than this
MOST_SECONDS_TO_RECONNECT = 2.0
MARGIN_S = 1.0  # a page that polls, on a machine that does other things


def check(condition, what):
    if not condition:
        sys.exit(f"failed: {what}")
    print(f"ok: {what}", flush=True)


class Viewer:
    """Subscribes to the pose and calls services."""

    def __init__(self, port):
        self.address = f"ws://127.0.0.1:{port}/"
        self.number = 0

    async def __aenter__(self):
        self.socket = await websockets.connect(self.address, subprotocols=["foxglove.websocket.v1"], max_size=None)
        json.loads(await self.socket.recv())
        channels = json.loads(await self.socket.recv())["channels"]
        self.services = {service["name"]: service["id"] for service in json.loads(await self.socket.recv())["services"]}
        self.topics = {channel["id"]: channel["topic"] for channel in channels}
        await self.subscribe({"/slammot/pose", "/slammot/health"})
        return self

    async def __aexit__(self, *_):
        await self.socket.close()

    async def subscribe(self, topics):
        wanted = [{"id": id, "channelId": id} for id, topic in self.topics.items() if topic in topics]
        await self.socket.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))

    async def call(self, name, **request):
        self.number += 1
        await self.socket.send(struct.pack("<BIII", 2, self.services[name], self.number, 4) + b"json" + json.dumps(request).encode())
        return self.number

    async def messages(self, within_s=20):
        """("topic", message) of data, ("done", call) and ("failed", text) of answers."""
        end = time.monotonic() + within_s
        while time.monotonic() < end:
            data = await asyncio.wait_for(self.socket.recv(), max(0.1, end - time.monotonic()))
            if isinstance(data, str):
                message = json.loads(data)
                if message["op"] == "serviceCallFailure":
                    yield "failed", message["message"]
            elif data[0] == 3:
                yield "done", struct.unpack_from("<I", data, 5)[0]
            else:
                yield self.topics[struct.unpack_from("<I", data, 1)[0]], json.loads(data[13:])

    async def pose_elsewhere(self, last_ns):
        """Stamp of the first pose that does not go on from that one, as those do that were on their way."""
        message = await self.first("/slammot/pose", lambda pose: not 0 <= int(pose["stamp_ns"]) - last_ns < STREAM_NS)
        return int(message["stamp_ns"])

    async def first(self, wanted, is_it=lambda message: True):
        async for topic, message in self.messages():
            if topic == wanted and is_it(message):
                return message
        raise TimeoutError(wanted)


def places_in(duration_s):
    """The last moment first, while nothing of the map is known, and then any."""
    random_number = random.Random(5)
    first_s, last_s = min(BEGINS_S, 0.3 * duration_s), max(duration_s - ENDS_S, 0.7 * duration_s)
    places = [last_s, first_s]
    while len(places) < 12:
        place_s = random_number.uniform(first_s, last_s)
        if abs(place_s - places[-1]) > min(APART_S, 0.2 * duration_s):
            places.append(place_s)
    return places


async def test_seeking(recorded):
    async with Viewer(recorded.port) as viewer:
        def player(health):
            return next((s["counters"] for s in health["services"] if s["service"] == "player" and "duration_ms" in s.get("counters", {})), None)
        duration_s = player(await viewer.first("/slammot/health", player))["duration_ms"] / 1000

        async def seek(seconds, last_ns):
            """Seconds until a pose of that place, and its stamp."""
            begin = time.monotonic()
            number = await viewer.call("/player/seek", seconds=seconds)
            await viewer.first("done", lambda answered: answered == number)
            stamp_ns = await viewer.pose_elsewhere(last_ns)
            return time.monotonic() - begin, stamp_ns

        last_ns = int((await viewer.first("/slammot/pose"))["stamp_ns"])
        longest, found = (0.0, 0.0), []
        for seconds in places_in(duration_s):
            took_s, last_ns = await seek(seconds, last_ns)
            found.append((seconds, last_ns))
            longest = max(longest, (took_s, seconds))
        check(longest[0] < MOST_SECONDS_TO_SEEK,
              f"any moment of {duration_s:.0f} s is shown within {MOST_SECONDS_TO_SEEK:.0f} s: {longest[0]:.2f} s at most, at {longest[1]:.1f} s")
        check([stamp for _, stamp in sorted(found)] == sorted(stamp for _, stamp in found), "later moments have later scans")
        await viewer.call("/player/speed", speed=0)
        check("speed takes" in await viewer.first("failed"), "a speed that is none is refused with what is expected")
        await viewer.call("/map/save")
        check("no answer from localization" in await viewer.first("failed"), "a call of a service that is not there is told")


async def test_page(page, recorded, pictures):
    await page.go(f"http://localhost:{recorded.port}/#c=dark")
    check(await page.comes_to("window.slammot && slammot.state() === 'live' && !document.getElementById('playback').hidden"), "the page shows the recording and its time")
    await page.value("slammot.playback.seek(slammot.playback.known.duration * 0.6)")
    await asyncio.sleep(3)
    if pictures:
        await page.picture(pathlib.Path(pictures) / "playback_dark.png")
    await page.key(" ")
    check(await page.comes_to("slammot.playback.known.isPaused && slammot.state() === 'stale'", 10), "space pauses, and the page says that nothing comes")
    stamp = await page.value("slammot.world.pose.stamp_ns")
    await page.key(".")
    check(await page.comes_to(f"slammot.world.pose.stamp_ns !== '{stamp}'", 10), "a step shows the next scans")
    await page.key(" ")
    check(await page.comes_to("slammot.state() === 'live'", 10), "space goes on")


async def test_reconnection(page, recorded):
    recorded.kill_gateway()
    check(await page.comes_to("slammot.state() === 'lost'", 10), "a gateway that was killed is told")
    recorded.start_gateway()
    end = time.monotonic() + 20
    while time.monotonic() < end:
        try:
            if recorded.get("/healthz")[0] == 200:
                break
        except OSError:
            await asyncio.sleep(0.02)
    begin = time.monotonic()
    check(await page.comes_to("slammot.connection.socket.readyState === 1", 20), "the page reconnects by itself")
    took = time.monotonic() - begin
    check(took < MOST_SECONDS_TO_RECONNECT + MARGIN_S, f"within {MOST_SECONDS_TO_RECONNECT:.0f} s: {took:.2f} s")
    check(await page.comes_to("slammot.state() === 'live'", 20), "the drive goes on")


async def main(options):
    with tempfile.TemporaryDirectory() as folder:
        with Recorded(options.slammot, recording_of(options, folder)) as recorded:
            recorded.wait_until_ready()
            await test_seeking(recorded)
            async with open_page() as page:
                await test_page(page, recorded, options.pictures)
                await test_reconnection(page, recorded)
                check(not [fault for fault in page.faults if "ERR_CONNECTION" not in fault], f"no errors {page.faults[:3]}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("slammot")
    parser.add_argument("--recording", type=pathlib.Path)
    parser.add_argument("--scenario", default="block")
    parser.add_argument("--pictures", help="folder for a picture of the page")
    if find_chromium() is None:
        print("skipped: Debian's chromium is needed")
        sys.exit(77)
    asyncio.run(main(parser.parse_args()))
