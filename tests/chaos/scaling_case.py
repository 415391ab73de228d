#!/usr/bin/env python3
"""Eight vehicles at their scanners' rate on one machine, each in a DDS domain of its own: in a common one each process receives all vehicles' scans."""

import contextlib
import time

import chaos

VEHICLES, SHORT_S, FULL_S = 8, 40, 600
P99_MS = 50.0


def start(options, stack, drive, domain):
    services = stack.enter_context(chaos.Services(options, domain))
    services.start_all([*chaos.KEEPERS, *chaos.PROCESSORS], "--profile", "urban")
    observer = services.observe()
    services.start("ingest", "--input", drive, "--profile", "urban", "--linger")
    return observer


def cases(options):
    seconds = FULL_S if options.full else SHORT_S
    with contextlib.ExitStack() as stack:
        drive = options.input or stack.enter_context(chaos.Services(options)).simulate("city" if options.full else "block")
        observers = [start(options, stack, drive, options.domain + number) for number in range(VEHICLES)]
        chaos.wait_until(lambda: all(observer.vehicle("vehicle")["tracked"] > 0 for observer in observers), "tracks of all vehicles", 120)
        began_s = max(observer.last()["time_s"] for observer in observers)
        time.sleep(seconds)
        seen = [observer.vehicle("vehicle") for observer in observers]
        of_each = [chaos.summary(observer.latencies_ms("vehicle", from_s=began_s)) for observer in observers]
        dropped = sum(observer.counter("ingest", "dropped_scans") for observer in observers)
        all_ms = chaos.summary([one for observer in observers for one in observer.latencies_ms("vehicle", from_s=began_s)])
    unanswered = sum(one["unanswered"] for one in seen)
    after_begin_s = [round(at_ns * 1e-9 - began_s, 2) for one in seen for at_ns in one["unanswered_ns"]]
    worst_p99_ms = max(one["p99"] for one in of_each)
    figure = f"{all_ms['count']} scans: {unanswered} without tracks, {dropped} dropped; p50 {all_ms['p50']:.1f}, p99 {all_ms['p99']:.1f} " \
             f"(of the slowest vehicle {worst_p99_ms:.1f}), worst {all_ms['worst']:.0f} ms ({chaos.load()})"
    yield chaos.row(f"{VEHICLES} vehicles at 37.5 Hz, one domain each, {seconds} s", f"no drops, p99 {P99_MS:.0f} ms", figure,
                    unanswered == 0 and dropped == 0 and all_ms["p99"] <= P99_MS, sound=all(one["count"] > 0 for one in of_each), of_each=of_each, unanswered=unanswered, unanswered_after_begin_s=after_begin_s, dropped=dropped)


if __name__ == "__main__":
    chaos.main(cases)
