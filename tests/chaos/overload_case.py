#!/usr/bin/env python3
"""More scans than the services can process, and a service that is stopped."""

import contextlib
import threading
import time

import chaos
import drives

SPEED_BEFORE, SHORT_S, FULL_S = "1", 12, 60
LONGEST_MS = 300.0  # waiting in ingest, then in the services
NORMAL_WITHIN_S, NORMAL_MS = 2.0, 10.0
OVERLOAD, SPEED = 10.0, 30
SHARE, PERIOD_S = 0.1, 0.05  # of the processor that the services get during the overload
RATE_HZ = 37.5


def overload(options, seconds):
    """Thirty times the recorded rate, for services that get a tenth of the processor: reading a log any faster costs a core."""
    with chaos.Services(options) as services:
        recorded = options.input or services.simulate("block")
        drive = drives.to_and_fro(recorded, services.folder / "long.log.gz", scans=int((seconds + 5) * RATE_HZ * SPEED))
        services.start_all([*chaos.KEEPERS, *chaos.PROCESSORS], "--profile", "urban")
        observer = services.observe(period_s=0.2)
        services.start("ingest", "--input", drive, "--speed", SPEED_BEFORE, "--profile", "urban", "--linger")
        chaos.wait_until(lambda: observer.vehicle("vehicle")["tracked"] > 100, "tracks", 60)
        before = chaos.summary(observer.latencies_ms("vehicle")[-75:])
        memory_before = memory_mb(services)
        services.command("ingest", "set_speed", str(SPEED))
        with slowed(services):
            began_s = observer.last()["time_s"]
            served_hz, offered_hz = rates(observer, seconds)
            ended_s = observer.last()["time_s"]
        services.command("ingest", "set_speed", SPEED_BEFORE)
        time.sleep(NORMAL_WITHIN_S + 4.0)
        during = chaos.summary(observer.latencies_ms("vehicle", from_s=began_s, to_s=ended_s))
        after = chaos.summary(observer.latencies_ms("vehicle", from_s=ended_s + NORMAL_WITHIN_S))
        dropped = observer.counter("ingest", "dropped_scans")
        unanswered = observer.vehicle("vehicle")["unanswered"]
        memory_after = memory_mb(services)
    figure = f"{offered_hz:.0f} Hz offered, {served_hz:.0f} Hz served ({offered_hz / served_hz:.1f} x): latency p99 {during['p99']:.0f}, worst {during['worst']:.0f} ms, " \
             f"{dropped} dropped at ingest, {unanswered} lost later; {NORMAL_WITHIN_S:.0f} s after: p99 {after['p99']:.1f} ms (before {before['p99']:.1f}); " \
             f"memory {', '.join(f'{name} {memory_before[name]:.0f} to {memory_after[name]:.0f}' for name in memory_after)} MB ({chaos.load()})"
    passed = during["worst"] <= LONGEST_MS and dropped > 0 and offered_hz >= OVERLOAD * served_hz and after["p99"] <= max(NORMAL_MS, 2 * before["p99"])
    return chaos.row(f"overload for {seconds} s", f"{OVERLOAD:.0f} x: latency bounded ({LONGEST_MS:.0f} ms), drops counted, normal within {NORMAL_WITHIN_S:.0f} s", figure,
                     passed, sound=dropped > 0 and after["count"] > 0, during=during, after=after, before=before, dropped=dropped, unanswered=unanswered, served_hz=served_hz,
                     offered_hz=offered_hz)


@contextlib.contextmanager
def slowed(services):
    """Stops the services of a scan most of the time."""
    ended = threading.Event()
    def stop_and_go():
        while not ended.is_set():
            for service in chaos.PROCESSORS:
                services.pause(service)
            time.sleep((1.0 - SHARE) * PERIOD_S)
            for service in chaos.PROCESSORS:
                services.go_on(service)
            time.sleep(SHARE * PERIOD_S)
    thread = threading.Thread(target=stop_and_go)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def rates(observer, seconds):
    """Rates of scans with tracks, and of scans sent or dropped."""
    def totals():
        return (observer.vehicle("vehicle")["tracked"], observer.counter("ingest", "scans") + observer.counter("ingest", "dropped_scans"),
                observer.status("ingest")["stamp_ns"] * 1e-9, observer.last()["time_s"])
    tracked, offered, ingest_s, time_s = totals()
    time.sleep(seconds)
    tracked_after, offered_after, ingest_after_s, time_after_s = totals()
    return (tracked_after - tracked) / (time_after_s - time_s), (offered_after - offered) / max(0.1, ingest_after_s - ingest_s)


def memory_mb(services):
    """By service; map_store and loop_closing keep the map, which grows with the way."""
    found = {}
    for name in ["ingest", *chaos.PROCESSORS]:
        with open(f"/proc/{services.running[name, 'vehicle', 'main'].pid}/status", encoding="utf-8") as status:
            found[name] = next(int(line.split()[1]) for line in status if line.startswith("VmRSS")) / 1024
    return found


def stopped_tracking(options, seconds):
    """SIGSTOP of tracking: SLAM goes on at full rate, and says that it is degraded; afterwards tracking does."""
    with chaos.Services(options) as services:
        drive = options.input or services.simulate("block")
        services.start_all([*chaos.KEEPERS, *chaos.PROCESSORS], "--profile", "urban")
        observer = services.observe(period_s=0.2)
        services.start("ingest", "--input", drive, "--profile", "urban", "--linger")
        chaos.wait_until(lambda: observer.vehicle("vehicle")["tracked"] > 100, "tracks", 60)
        before = chaos.summary(observer.latencies_ms("vehicle")[-75:])
        services.pause("tracking")
        began_s = observer.last()["time_s"]
        time.sleep(seconds)
        ended_s = observer.last()["time_s"]
        explanation = observer.status("localization")["explanation"]
        services.go_on("tracking")
        chaos.wait_until(lambda: observer.latencies_ms("vehicle", from_s=ended_s), "tracks of the process that goes on")
        returned_s = observer.last()["time_s"] - ended_s
        time.sleep(max(0.0, NORMAL_WITHIN_S - returned_s) + 2.0)
        localized = chaos.summary(observer.latencies_ms("vehicle", "localized", began_s, ended_s))
        expected = RATE_HZ * (ended_s - began_s)
        after = chaos.summary(observer.latencies_ms("vehicle", from_s=ended_s + max(NORMAL_WITHIN_S, returned_s)))
        dropped = observer.counter("ingest", "dropped_scans")
    figure = f"{localized['count'] / expected:.1%} of scans localized meanwhile, p99 {localized['p99']:.1f} ms; {dropped} dropped; \"{explanation}\"; " \
             f"tracks again after {returned_s:.1f} s, then p99 scan to tracks {after['p99']:.1f} ms (before {before['p99']:.1f}) ({chaos.load()})"
    passed = localized["count"] >= 0.97 * expected and explanation and after["count"] > 30 and returned_s <= NORMAL_WITHIN_S and \
        after["p99"] <= max(NORMAL_MS, 2 * before["p99"])
    return chaos.row(f"tracking stopped (SIGSTOP) for {seconds} s", "localization goes on and is degraded; normal 2 s after", figure, passed,
                     sound=explanation and after["count"] > 0, localized=localized, after=after, dropped=dropped)


def cases(options):
    yield overload(options, FULL_S if options.full else SHORT_S)
    yield stopped_tracking(options, 10 if options.full else 5)


if __name__ == "__main__":
    chaos.main(cases)
