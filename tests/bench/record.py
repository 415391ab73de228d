#!/usr/bin/env python3
"""Runs the benchmarks and adds their times to a history, so that a change can be held against the ones before it.

usage: record.py SLAMMOT_BENCH HISTORY.csv COMMIT [SLAMMOT_BENCH COMMIT ...] [--filter REGEX]

With several programs each benchmark is run by all of them in turn, so that the same neighbours disturb each: compare
rows of one sitting, not of two. The time is the least of five repetitions' CPU times, which a busy machine disturbs least.
"""

import argparse
import csv
import datetime
import json
import pathlib
import subprocess

COLUMNS = ["measured_at", "cpu", "commit", "benchmark", "cpu_us"]
PER_MICROSECOND = {"ns": 1e-3, "us": 1.0, "ms": 1e3, "s": 1e6}
REPETITIONS = 5


def cpu_name():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown"


def names_of(program, pattern):
    listed = subprocess.run([program, "--benchmark_list_tests", f"--benchmark_filter={pattern}"], check=True, capture_output=True, text=True)
    return listed.stdout.split()


def least_cpu_us(program, name):
    """Least CPU time of one iteration; None where the program does not have the benchmark."""
    done = subprocess.run([program, f"--benchmark_filter=^{name}$", f"--benchmark_repetitions={REPETITIONS}", "--benchmark_min_time=0.1",
                           "--benchmark_format=json"], check=True, capture_output=True, text=True)
    if not done.stdout.strip():
        return None
    runs = [run for run in json.loads(done.stdout)["benchmarks"] if run["run_type"] == "iteration"]
    return min((run["cpu_time"] * PER_MICROSECOND[run["time_unit"]] for run in runs), default=None)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("history", type=pathlib.Path)
    parser.add_argument("commit")
    parser.add_argument("more", nargs="*", help="further pairs of PROGRAM COMMIT")
    parser.add_argument("--filter", default=".")
    options = parser.parse_args()
    if len(options.more) % 2:
        parser.error("further programs come with their commits")
    versions = [(options.program, options.commit), *zip(options.more[::2], options.more[1::2])]
    measured_at = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%MZ")
    is_new = not options.history.exists()
    with options.history.open("a", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        if is_new:
            rows.writerow(COLUMNS)
        for name in names_of(options.program, options.filter):
            times = [(commit, least_cpu_us(program, name)) for program, commit in versions]
            for commit, cpu_us in times:
                if cpu_us is not None:
                    rows.writerow([measured_at, cpu_name(), commit, name, f"{cpu_us:.2f}"])
            print(f"{name:44}" + "".join(f" {cpu_us:10.2f} us ({commit})" for commit, cpu_us in times if cpu_us is not None), flush=True)


if __name__ == "__main__":
    main()
