#!/usr/bin/env python3
"""A day of driving, flat out: memory, handles, threads and keys of each service stay as they are after the first hour, and so does its speed.

The short form drives for minutes and extrapolates: what grows must grow by less in a day than what is allowed.
"""

import os
import time

import chaos
import drives

RATE_HZ = 37.5
HOURS_FULL, SHORT_S = 24.0, 100
WARM_UP_SHARE = 0.35  # of the drive; the first hour of a day is less
MOST_GROWTH = {"memory_mb_an_hour": 2.0, "handles_an_hour": 0.2, "threads_an_hour": 0.05}
MOST_SLOWER = 0.25


def resources(pid):
    with open(f"/proc/{pid}/status", encoding="utf-8") as status:
        fields = dict(line.split(":", 1) for line in status)
    return {"memory_mb": int(fields["VmRSS"].split()[0]) / 1024, "threads": int(fields["Threads"]), "handles": len(os.listdir(f"/proc/{pid}/fd"))}


def slope(points):
    """Least-squares slope of (x, y)."""
    mean_x, mean_y = (sum(point[i] for point in points) / len(points) for i in (0, 1))
    spread = sum((x - mean_x) ** 2 for x, _ in points)
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / spread if spread > 0 else 0.0


def watch(services, observer, scans, longest_s):
    """Samples of all services over simulated hours, until the drive ends or its time is over."""
    samples, end = [], time.monotonic() + longest_s
    while time.monotonic() < end and services.running["ingest", "vehicle", "main"].poll() is None:
        tracked = observer.vehicle("vehicle")["tracked"]
        of_each = {service: resources(process.pid) for (service, *_), process in services.running.items() if process.poll() is None}
        samples.append({"hours": tracked / RATE_HZ / 3600, "time_s": time.monotonic(), "services": of_each})
        if tracked >= scans:
            break
        time.sleep(1.0)
    return samples


def cases(options):
    scans = int(HOURS_FULL * 3600 * RATE_HZ) if options.full else 10**6
    with chaos.Services(options) as services:
        recorded = options.input or services.simulate("block")
        drive = drives.to_and_fro(recorded, services.folder / "long.log.gz", min(scans, 60000 if not options.full else scans))
        services.start_all([*chaos.KEEPERS, *chaos.PROCESSORS], "--profile", "urban")
        observer = services.observe(period_s=1.0)
        services.start("ingest", "--input", drive, "--speed", "max", "--profile", "urban", "--linger")
        chaos.wait_until(lambda: observer.vehicle("vehicle")["tracked"] > 100, "tracks", 120)
        samples = watch(services, observer, scans, 48 * 3600 if options.full else SHORT_S)
    settled = [one for one in samples if one["hours"] >= WARM_UP_SHARE * samples[-1]["hours"]]
    worst, figures = {}, {}
    for service in settled[-1]["services"]:
        for what in ["memory_mb", "handles", "threads"]:
            grown = slope([(one["hours"], one["services"][service][what]) for one in settled if service in one["services"]])
            figures[f"{service} {what}"] = grown
            if grown > worst.get(what, ("", 0.0))[1]:
                worst[what] = (service, grown)
    half = len(settled) // 2
    def speed(part):
        return (part[-1]["hours"] - part[0]["hours"]) * 3600 / (part[-1]["time_s"] - part[0]["time_s"])
    slower = 1.0 - speed(settled[half:]) / speed(settled[:half])
    texts = [f"{what.replace('_mb', '')} {worst[what][1]:+.2f} {'MB ' if 'mb' in what else ''}an hour ({worst[what][0]})" if what in worst
             else f"{what.replace('_mb', '')} flat" for what in ["memory_mb", "handles", "threads"]]
    passed = slower <= MOST_SLOWER and all(worst.get(what, ("", 0.0))[1] <= MOST_GROWTH[f"{what}_an_hour"] for what in ["memory_mb", "handles", "threads"])
    yield chaos.row(f"{samples[-1]['hours']:.1f} h of driving at {speed(settled):.0f} x", "memory, handles, threads flat, no slowing",
                    f"{'; '.join(texts)}; speed {-slower:+.0%} from the first half to the second ({chaos.load()})", passed, slopes=figures, slower=slower)


if __name__ == "__main__":
    chaos.main(cases)
