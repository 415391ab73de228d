#!/usr/bin/env python3
"""Eight vehicles in one domain at their scanners' rate: localization, detection and tracking of each, and one source each."""

import time

import chaos

VEHICLES, SHORT_S, FULL_S = 8, 40, 600
P99_MS = 50.0


def cases(options):
    seconds = FULL_S if options.full else SHORT_S
    with chaos.Services(options) as services:
        drive = options.input or services.simulate("city" if options.full else "block")
        observer = services.observe()
        vehicles = [f"car{number}" for number in range(1, VEHICLES + 1)]
        for vehicle in vehicles:
            services.start_all([*chaos.KEEPERS, *chaos.PROCESSORS], "--profile", "urban", vehicle=vehicle)
        for vehicle in vehicles:
            services.start("ingest", "--input", drive, "--profile", "urban", "--linger", vehicle=vehicle)
        chaos.wait_until(lambda: all(observer.vehicle(vehicle)["tracked"] > 0 for vehicle in vehicles), "tracks of all vehicles", 120)
        began_s = observer.last()["time_s"]
        time.sleep(seconds)
        seen = {vehicle: observer.vehicle(vehicle) for vehicle in vehicles}
        of_each = {vehicle: chaos.summary(observer.latencies_ms(vehicle, from_s=began_s)) for vehicle in vehicles}
        dropped = sum(observer.counter("ingest", "dropped_scans", vehicle=vehicle) for vehicle in vehicles)
        all_ms = chaos.summary([one for vehicle in vehicles for one in observer.latencies_ms(vehicle, from_s=began_s)])
    unanswered = sum(one["unanswered"] for one in seen.values())
    worst_p99_ms = max(one["p99"] for one in of_each.values())
    figure = f"{all_ms['count']} scans: {unanswered} without tracks, {dropped} dropped; p50 {all_ms['p50']:.1f}, p99 {all_ms['p99']:.1f} " \
             f"(of the slowest vehicle {worst_p99_ms:.1f}), worst {all_ms['worst']:.0f} ms ({chaos.load()})"
    yield chaos.row(f"{VEHICLES} vehicles at 37.5 Hz, {seconds} s", f"no drops, p99 {P99_MS:.0f} ms", figure,
                    unanswered == 0 and dropped == 0 and all_ms["p99"] <= P99_MS, of_each=of_each, unanswered=unanswered, dropped=dropped)


if __name__ == "__main__":
    chaos.main(cases)
