#!/usr/bin/env python3
"""A day of driving, flat out: memory, handles, threads and keys of each service stay as they are after the first hour, and so does its speed.

The short form drives for minutes; --hours H for so long. map_store and loop_closing keep of each submap what they need again, which grows with the
way: a row of their own. Within the first hour loop_closing also fills its cache of search pyramids.
"""

import os
import time

import chaos
import drives

RATE_HZ = 37.5
HOURS_FULL, SHORT_S = 24.0, 100
SHORT_SCANS = 60000
FEW = 20
IDLE_S = 30.0  # without tracks: the drive is over
WARM_UP_SHARE = 0.35  # of a short drive
WARM_UP_HOURS = 1.0   # of a long one
MOST_MORE = {"memory_mb": 8.0, "handles": 1, "threads": 1}  # in the second half of what follows the warm-up; a checkpoint being written is a handle
MOST_MB_AN_HOUR = 10.0
MOST_OF_MAP_STORE = 40.0  # MB an hour at any speed and length; resident memory scatters by MB
MOST_SLOWER = 0.25


def resources(pid):
    with open(f"/proc/{pid}/status", encoding="utf-8") as status:
        fields = dict(line.split(":", 1) for line in status)
    return {"memory_mb": int(fields["VmRSS"].split()[0]) / 1024, "threads": int(fields["Threads"]), "handles": len(os.listdir(f"/proc/{pid}/fd"))}


def slope(samples, service, what):
    """Least-squares slope an hour."""
    points = [(one["hours"], one["services"][service][what]) for one in samples if service in one["services"]]
    mean_x, mean_y = (sum(point[i] for point in points) / len(points) for i in (0, 1))
    spread = sum((x - mean_x) ** 2 for x, _ in points)
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / spread if spread > 0 else 0.0


def watch(services, observer, scans, longest_s):
    """Samples of all services over simulated hours, until the drive ends or its time is over."""
    samples, end, most_tracked, advanced_s = [], time.monotonic() + longest_s, 0, time.monotonic()
    while time.monotonic() < end and services.running["ingest", "vehicle", "main"].poll() is None:
        tracked = observer.vehicle("vehicle")["tracked"]
        of_each = {service: resources(process.pid) for (service, *_), process in services.running.items() if process.poll() is None}
        samples.append({"hours": tracked / RATE_HZ / 3600, "time_s": time.monotonic(), "services": of_each})
        if tracked > most_tracked:
            most_tracked, advanced_s = tracked, time.monotonic()
        if tracked >= scans - FEW or time.monotonic() > advanced_s + IDLE_S:  # a service may have left some out
            break
        time.sleep(1.0)
    return samples


def cases(options):
    hours = options.hours or (HOURS_FULL if options.full else None)
    scans = int(hours * 3600 * RATE_HZ) if hours else SHORT_SCANS
    with chaos.Services(options) as services:
        recorded = options.input or services.simulate("block")
        drive = drives.to_and_fro(recorded, services.folder / "long.log.gz", scans)
        services.start_all([*chaos.KEEPERS, *chaos.PROCESSORS], "--profile", "urban")
        observer = services.observe(period_s=1.0)
        services.start("ingest", "--input", drive, "--speed", "max", "--profile", "urban", "--linger")
        chaos.wait_until(lambda: observer.vehicle("vehicle")["tracked"] > 100, "tracks", 120)
        samples = watch(services, observer, scans, 48 * 3600 if hours else SHORT_S)
    settled = [one for one in samples if one["hours"] >= min(WARM_UP_HOURS, WARM_UP_SHARE * samples[-1]["hours"])]
    half = len(settled) // 2
    slower = 1.0 - speed(settled[half:]) / speed(settled[:half])
    grown = {(service, what): growth(settled, service, what) for service in settled[-1]["services"] for what in ["memory_mb", "handles", "threads"]}
    flat = all(more <= MOST_MORE[what] for (service, what), more in grown.items() if service not in chaos.KEEPERS)
    keeps = {service: slope(settled, service, "memory_mb") for service in chaos.KEEPERS}
    yield chaos.row(f"{samples[-1]['hours']:.2f} h of driving at {speed(settled):.0f} x: services of a scan",
                    "memory, handles, threads flat, no slowing", f"second half against the first: {most(grown, 'memory_mb')} MB, {most(grown, 'handles')} handles, "
                    f"{most(grown, 'threads')} threads; speed {-slower:+.0%} ({chaos.load()})", flat and slower <= MOST_SLOWER, sound=flat,
                    growth={f"{service} {what}": more for (service, what), more in grown.items()}, slower=slower)
    yield chaos.row(f"{samples[-1]['hours']:.2f} h of driving: what keeps the map", f"at most {MOST_MB_AN_HOUR:.0f} MB an hour after the first",
                    ", ".join(f"{service} {more:+.0f} MB an hour" for service, more in keeps.items()),
                    all(more <= MOST_MB_AN_HOUR for more in keeps.values()), sound=keeps["map-store"] <= MOST_OF_MAP_STORE, mb_an_hour=keeps)


def speed(part):
    return (part[-1]["hours"] - part[0]["hours"]) * 3600 / (part[-1]["time_s"] - part[0]["time_s"])


def growth(samples, service, what):
    """Of the greatest value in the second half over that in the first."""
    values = [one["services"][service][what] for one in samples if service in one["services"]]
    return max(values[len(values) // 2:]) - max(values[:len(values) // 2])


def most(grown, what):
    service, more = max(((service, more) for (service, kind), more in grown.items() if kind == what and service not in chaos.KEEPERS),
                        key=lambda one: one[1])
    return f"{more:+.1f} ({service})" if what == "memory_mb" else f"{more:+d}"


if __name__ == "__main__":
    chaos.main(cases)
