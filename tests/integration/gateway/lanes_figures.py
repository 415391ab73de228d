"""Lanes and walkways that the services publish, against lanes.geojson of the same drive: `slammot bench` with a gateway beside it.

Usage: lanes_figures.py SLAMMOT [--scenario city] [--speed 1] [--map FOLDER] --output FOLDER. Prints the figures of `slammot eval` for both, and
what it cost map_store to find them. The published ones are kept as FOLDER/published/lanes.geojson.
"""

import argparse
import asyncio
import json
import os
import shutil
import signal
import subprocess
from pathlib import Path

import websockets
from live import free_port

PROPERTIES = ("kind", "line", "speed", "speed_spread", "width", "tracks", "confidence")
TOPICS = ("/slammot/ways", "/slammot/health")


async def follow(port, last):
    """Keeps the last message of each topic."""
    while True:
        try:
            async with websockets.connect(f"ws://127.0.0.1:{port}/", subprotocols=["foxglove.websocket.v1"], max_size=None) as viewer:
                await viewer.recv()
                topics = {channel["id"]: channel["topic"] for channel in json.loads(await viewer.recv())["channels"]}
                wanted = [{"id": id, "channelId": id} for id, topic in topics.items() if topic in TOPICS]
                await viewer.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))
                async for message in viewer:
                    if isinstance(message, bytes):
                        take(topics[int.from_bytes(message[1:5], "little")], json.loads(message[13:]), last)
        except OSError:
            await asyncio.sleep(0.5)


def take(topic, message, last):
    if topic == "/slammot/ways":
        last["ways"] = message["ways"]
        last["publications"] = last.get("publications", 0) + 1
    for service in message.get("services", []):
        if service["service"] == "map_store" and service.get("latencies"):
            last["latencies"] = service["latencies"]


def geojson(ways):
    features = [{"type": "Feature", "properties": {name: way[name] for name in PROPERTIES},
                 "geometry": {"type": "LineString", "coordinates": list(zip(way["points"][::2], way["points"][1::2]))}} for way in ways]
    return json.dumps({"type": "FeatureCollection", "frame": "map", "unit": "m", "features": features})


async def drive(options, bus):
    """Returns what was published last."""
    port, last = free_port(), {}
    program = Path(options.slammot)
    gateway = subprocess.Popen([program.with_name("slammot-gateway"), "--vehicle", "bench", "--port", str(port), *bus], stderr=subprocess.DEVNULL)
    more = ["--map", options.map] if options.map else []
    bench = await asyncio.create_subprocess_exec(program, "bench", "--scenario", options.scenario, "--speed", options.speed, "--output",
                                                 options.output, "--store-map", "--no-report", "--quiet", *more, *bus)
    viewer = asyncio.create_task(follow(port, last))
    code = await bench.wait()
    viewer.cancel()
    gateway.send_signal(signal.SIGTERM)
    gateway.wait(20)
    if code != 0:
        raise SystemExit(f"slammot bench: exit code {code}")
    return last


def figures(options, folder):
    subprocess.run([options.slammot, "eval", "--result", folder, "--truth", Path(options.output) / "truth"], check=True, stdout=subprocess.DEVNULL)
    ways = json.loads((Path(folder) / "evaluation.json").read_text())["ways"]
    for kind, of_all in ways["all"].items():
        sure = ways["confident"][kind]
        print(f"  {kind:10} recall {of_all['recall']:.3f}  precision {of_all['precision']:.3f}  {of_all['length_m']:5.0f} m;  from confidence "
              f"{ways['least_confidence']} on {sure['recall']:.3f}  {sure['precision']:.3f}  {sure['length_m']:5.0f} m")


def main(options):
    last = asyncio.run(drive(options, ["--bus", f"lanes-{os.getpid()}", "--domain", str(os.getpid() % 200)]))
    published = Path(options.output) / "published"
    shutil.copytree(options.output, published, ignore=lambda folder, names: [name for name in names if name.startswith(("published", "truth"))],
                    dirs_exist_ok=True)
    (published / "lanes.geojson").write_text(geojson(last["ways"]))
    print("lanes.geojson")
    figures(options, options.output)
    print(f"published, {len(last['ways'])} pieces, {last['publications']} times")
    figures(options, published)
    for latency in last.get("latencies", []):
        print(f"  {latency['stage']}: {latency['calls']} calls, p50 {latency['p50_ms']:.1f} ms, highest {latency['highest_ms']:.1f} ms")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("slammot")
    parser.add_argument("--scenario", default="city")
    parser.add_argument("--speed", default="1")
    parser.add_argument("--map", help="stored map in which the drive continues")
    parser.add_argument("--output", required=True)
    main(parser.parse_args())
