#!/usr/bin/env python3
"""What recording everything of one vehicle costs: `slammot record` beside the whole pipeline at the recorded rate.

Usage: recorder_cost.py SLAMMOT [--seconds 30] [--scenario block] [--compression zstd]

Prints the share of a core, messages, lost messages and the size."""

import argparse
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("slammot")
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--scenario", default="block")
    parser.add_argument("--compression", default="zstd")
    arguments = parser.parse_args()
    bus = f"recorder-cost-{os.getpid()}"
    live = subprocess.Popen([arguments.slammot, "live", "--scenario", arguments.scenario, "--port", "0", "--bus", bus], stdout=subprocess.DEVNULL)
    try:
        time.sleep(5)  # all services run
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "all.mcap"
            recording = subprocess.Popen([arguments.slammot, "record", "--output", str(path), "--duration", str(arguments.seconds), "--compression", arguments.compression, "--bus", bus],
                                         stdout=subprocess.PIPE, text=True)
            said = recording.stdout.read()
            _, _, usage = os.wait4(recording.pid, 0)
            share = (usage.ru_utime + usage.ru_stime) / arguments.seconds
            messages, dropped = re.search(r"(\d+) messages of \d+ topics, (\d+) dropped", said).groups()
            print(f"{100 * share:.2f} % of a core, {int(messages) / arguments.seconds:.0f} messages/s, {dropped} dropped, "
                  f"{path.stat().st_size / arguments.seconds / 1e6:.2f} MB/s, {usage.ru_maxrss / 1024:.0f} MB of memory")
            print(subprocess.run([arguments.slammot, "bag", "info", str(path)], capture_output=True, text=True, check=True).stdout)
    finally:
        live.send_signal(signal.SIGTERM)
        live.wait(20)


if __name__ == "__main__":
    main()
