#!/usr/bin/env python3
"""More scans than the services can process, and a service that is stopped."""

import time

import chaos
import drives

SPEED_BEFORE, SHORT_S, FULL_S = "1", 12, 60
LONGEST_MS = 300.0  # waiting in ingest, then in the services
NORMAL_WITHIN_S, NORMAL_MS = 2.0, 10.0
OVERLOAD = 10.0


def overload(options, seconds):
    """Ten times what the services process: the speed follows from the rate at which they answer."""
    with chaos.Services(options) as services:
        recorded = options.input or services.simulate("block")
        drive = drives.to_and_fro(recorded, services.folder / "long.log.gz", scans=int((seconds + 30) * 6000))
        services.start_all([*chaos.KEEPERS, *chaos.PROCESSORS], "--profile", "urban")
        observer = services.observe(period_s=0.2)
        services.start("ingest", "--input", drive, "--speed", SPEED_BEFORE, "--profile", "urban", "--linger")
        chaos.wait_until(lambda: observer.vehicle("vehicle")["tracked"] > 100, "tracks", 60)
        before = chaos.summary(observer.latencies_ms("vehicle")[-75:])
        memory_before = memory_mb(services)
        served_hz, offered_hz = drive_at(services, observer, 30, 3)
        services.command("ingest", "set_speed", f"{30 * max(1.0, OVERLOAD * served_hz / offered_hz):.0f}")
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
             f"memory {memory_before:.0f} to {memory_after:.0f} MB ({chaos.load()})"
    passed = during["worst"] <= LONGEST_MS and dropped > 0 and after["p99"] <= max(NORMAL_MS, 2 * before["p99"])
    return chaos.row(f"overload for {seconds} s", f"{OVERLOAD:.0f} x: latency bounded ({LONGEST_MS:.0f} ms), drops counted, normal within {NORMAL_WITHIN_S:.0f} s", figure,
                     passed, during=during, after=after, before=before, dropped=dropped, unanswered=unanswered, served_hz=served_hz,
                     offered_hz=offered_hz)


def drive_at(services, observer, speed, seconds):
    services.command("ingest", "set_speed", str(speed))
    return rates(observer, seconds)


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
    total_kb = 0
    for process in services.running.values():
        with open(f"/proc/{process.pid}/status", encoding="utf-8") as status:
            total_kb += next(int(line.split()[1]) for line in status if line.startswith("VmRSS"))
    return total_kb / 1024


def stopped_tracking(options, seconds):
    """SIGSTOP of tracking: SLAM goes on at full rate, and says that it is degraded; afterwards tracking does."""
    with chaos.Services(options) as services:
        drive = options.input or services.simulate("block")
        services.start_all([*chaos.KEEPERS, *chaos.PROCESSORS], "--profile", "urban")
        observer = services.observe(period_s=0.2)
        services.start("ingest", "--input", drive, "--profile", "urban", "--linger")
        chaos.wait_until(lambda: observer.vehicle("vehicle")["tracked"] > 100, "tracks", 60)
        services.pause("tracking")
        began_s = observer.last()["time_s"]
        time.sleep(seconds)
        ended_s = observer.last()["time_s"]
        explanation = observer.status("localization")["explanation"]
        services.go_on("tracking")
        time.sleep(NORMAL_WITHIN_S + 2.0)
        localized = chaos.summary(observer.latencies_ms("vehicle", "localized", began_s, ended_s))
        expected = 37.5 * (ended_s - began_s)
        after = chaos.summary(observer.latencies_ms("vehicle", from_s=ended_s + NORMAL_WITHIN_S))
        dropped = observer.counter("ingest", "dropped_scans")
    figure = f"{localized['count'] / expected:.1%} of scans localized meanwhile, p99 {localized['p99']:.1f} ms; {dropped} dropped; \"{explanation}\"; " \
             f"afterwards p99 scan to tracks {after['p99']:.1f} ms ({chaos.load()})"
    passed = localized["count"] >= 0.97 * expected and explanation and after["count"] > 30 and after["p99"] <= NORMAL_MS
    return chaos.row(f"tracking stopped (SIGSTOP) for {seconds} s", "localization goes on and is degraded; normal 2 s after", figure, passed,
                     localized=localized, after=after, dropped=dropped)


def cases(options):
    yield overload(options, FULL_S if options.full else SHORT_S)
    yield stopped_tracking(options, 10 if options.full else 5)


if __name__ == "__main__":
    chaos.main(cases)
