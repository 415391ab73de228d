"""20 viewers of the gateway, one stalled, one sending random bytes, one coming and going all the time: the pipeline's rate and latency with
and without them; and the gateway's memory.

Each pair is two runs of the same drive, compared scan by scan, since scenes differ more than viewers cost. What two runs without viewers
differ by is the noise.

Usage: load_test.py SLAMMOT --venv FOLDER [--pairs 2] [--seconds 8] [--scenario block]. Skipped (77) where PyPI's `mcap` is missing.
"""

import argparse
import os
import pathlib
import statistics
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "recorder"))
import python_environment
from clients import Crowd
from live import Live

SETTLE_S = 3
MOST_LOST = 0.02
MOST_SLOWER_MS = 1.0  # bounds what a busy machine does, too; figures are in docs/performance.md
LEAST_IN_COMMON = 0.3  # of the scans of two runs, which may begin seconds apart on a busy machine
MOST_MEMORY_MB = 150  # 23 queues of at most 8 MB; only the stalled one fills up


def check(condition, what):
    print(f"{'ok' if condition else 'failed'}: {what}", flush=True)
    if not condition:
        sys.exit(1)


def stamp_of(cdr):
    """Of a sample that begins with two texts and its stamp."""
    is_version_2 = cdr[1] >= 6
    at = 8 if is_version_2 else 4
    for _ in range(2):
        (length,) = struct.unpack_from("<I", cdr, at)
        at = (at + 4 + length + 3) & ~3
    if not is_version_2:
        at = (at - 4 + 7) // 8 * 8 + 4
    return struct.unpack_from("<q", cdr, at)[0]


class Recorded:
    """Latency of each scan from its publication to that of its labels, both as the recorder received them."""

    def __init__(self, path):
        times = {}
        with open(path, "rb") as file:
            for _, channel, message in make_reader(file).iter_messages():
                times.setdefault(channel.topic, {})[stamp_of(message.data)] = message.publish_time
        scans, answers = times["slammot/laser_scan"], times["slammot/scan_labels"]
        self.scans = len(scans)
        self.latency_ms = {stamp: (answers[stamp] - scans[stamp]) * 1e-6 for stamp in scans.keys() & answers.keys()}
        self.p50_ms = statistics.median(self.latency_ms.values())
        self.p99_ms = sorted(self.latency_ms.values())[int(0.99 * (len(self.latency_ms) - 1))]
        self.answered = len(self.latency_ms) / self.scans

    def slower_by_ms(self, other):
        """Median over the scans of both."""
        common = self.latency_ms.keys() & other.latency_ms.keys()
        if len(common) < LEAST_IN_COMMON * self.scans:
            raise RuntimeError(f"only {len(common)} of {self.scans} scans are of both runs")
        return statistics.median(self.latency_ms[stamp] - other.latency_ms[stamp] for stamp in common)

    def __str__(self):
        return f"{self.scans} scans, {100 * self.answered:.1f} % answered, latency p50 {self.p50_ms:.2f} ms, p99 {self.p99_ms:.2f} ms"


def record(options, live, folder, name):
    path = pathlib.Path(folder) / f"{name}.mcap"
    subprocess.run([options.slammot, "record", "--output", path, "--topics", "slammot/laser_scan,slammot/scan_labels", "--duration",
                    str(options.seconds), "--bus", live.bus, "--domain", live.domain], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return Recorded(path)


def memory_mb(process):
    status = pathlib.Path(f"/proc/{process}/status").read_text()
    return int(status.split("VmRSS:")[1].split()[0]) / 1024


def gateway_of(live):
    for child in pathlib.Path(f"/proc/{live.process.pid}/task/{live.process.pid}/children").read_text().split():
        if "slammot-gateway" in pathlib.Path(f"/proc/{child}/cmdline").read_text():
            return child
    raise RuntimeError("there is no gateway")


def metric(live, name):
    lines = live.get("/metrics")[1].decode().splitlines()
    return sum(float(line.split()[-1]) for line in lines if line.startswith(name))


def drive(options, folder, name, has_viewers):
    """The beginning of the drive: what was recorded, and the gateway's memory."""
    with Live(options.slammot, options.scenario) as live:
        live.wait_until_ready()
        gateway = gateway_of(live)
        if not has_viewers:
            time.sleep(SETTLE_S)
            recorded = record(options, live, folder, name)
            print(f"alone:   {recorded}", flush=True)
            return recorded, memory_mb(gateway)
        with Crowd(live.port) as crowd:
            time.sleep(SETTLE_S)
            before, begin = list(crowd.received), time.monotonic()
            recorded = record(options, live, folder, name)
            memory = memory_mb(gateway)
            rate = [(after - earlier) / (time.monotonic() - begin) for after, earlier in zip(crowd.received, before)]
            visits, noise = crowd.visits, crowd.noise
        print(f"20 more: {recorded}; {min(rate) / 1e6:.2f} MB/s each, {visits} visits, {noise} times noise, gateway {memory:.0f} MB; "
              f"dropped messages: {metric(live, 'slammot_gateway_dropped_messages_total'):.0f}", flush=True)
        check(min(rate) > 0 and visits > 10 and noise > 0, "all of them were served, or refused")
        check(live.get("/healthz")[0] == 200, "the gateway serves")
        return recorded, memory


def described(differences):
    mean = statistics.mean(differences)
    error = statistics.stdev(differences) / len(differences) ** 0.5 if len(differences) > 1 else float("nan")
    return f"{mean:+.2f} +- {error:.2f} ms ({', '.join(f'{one:+.2f}' for one in differences)})"


def main(options):
    alone, crowded, memories = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(options.pairs):
            for has_viewers in (False, True) if number % 2 == 0 else (True, False):
                recorded, memory = drive(options, folder, f"{number}{has_viewers}", has_viewers)
                (crowded if has_viewers else alone).append(recorded)
                memories.append(memory)
    more = [b.slower_by_ms(a) for a, b in zip(alone, crowded)]
    print(f"a scan with 20 viewers against the same without: {described(more)}")
    if options.pairs > 1:
        print(f"two runs without them: {described([b.slower_by_ms(a) for a, b in zip(alone, alone[1:])])}")
    check(all(b.answered > a.answered - MOST_LOST for a, b in zip(alone, crowded)), "as many scans are answered as without them")
    check(all(abs(b.scans - a.scans) <= 0.1 * a.scans for a, b in zip(alone, crowded)), "the rate of scans is the same")
    check(statistics.mean(more) < MOST_SLOWER_MS, f"a scan takes less than {MOST_SLOWER_MS} ms more")
    check(max(memories) < MOST_MEMORY_MB, f"the gateway's memory is bounded: at most {max(memories):.0f} MB")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("slammot")
    parser.add_argument("--venv", type=pathlib.Path, required=True)
    parser.add_argument("--pairs", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=8)
    parser.add_argument("--scenario", default="block")
    OPTIONS = parser.parse_args()
    python_environment.enter(OPTIONS.venv)
    from mcap.reader import make_reader
    main(OPTIONS)
