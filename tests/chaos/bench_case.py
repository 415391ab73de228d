#!/usr/bin/env python3
"""A drive through the services as fast as they answer, beside the same drive in one process: time and bytes of the results."""

import filecmp
import time

import chaos

MOST_TIMES = 2.0
WITH_TIMES = {"report.json", "report.html", "settings.textproto"}  # what was measured, or how


def timed(services, command, drive, *arguments):
    began = time.monotonic()
    services.slammot(command, "--input", drive, "--output", services.folder / command, "--no-report", "--quiet", *arguments)
    return time.monotonic() - began


def cases(options):
    with chaos.Services(options) as services:
        drive = options.input or services.simulate("city" if options.full else "block")
        run_s = min(timed(services, "run", drive) for _ in range(2))
        bench_s = min(timed(services, "bench", drive, "--speed", "max", "--domain", services.domain) for _ in range(2))
        results = sorted(path.relative_to(services.folder / "run") for path in (services.folder / "run").rglob("*")
                         if path.is_file() and path.name not in WITH_TIMES)
        _, other, missing = filecmp.cmpfiles(services.folder / "run", services.folder / "bench", results, shallow=False)
    figure = f"run {run_s:.1f} s, bench {bench_s:.1f} s: {bench_s / run_s:.1f} x; of {len(results)} files {len(other)} differ, {len(missing)} are missing " \
             f"({chaos.load()})"
    yield chaos.row(f"bench --speed max beside run, {drive.name}", f"{MOST_TIMES:.0f} x the time, same bytes", figure,
                    bench_s <= MOST_TIMES * run_s and not other and not missing, sound=not missing, run_s=run_s, bench_s=bench_s,
                    differing=[str(path) for path in other + missing])


if __name__ == "__main__":
    chaos.main(cases)
