"""What the cases of this folder share: a set of services on a closed bus, an observer of it, and rows of the table.

A case is a file NAME_case.py with a function cases(options) that yields rows; it ends with chaos.main(cases).
"""

import argparse
import json
import os
import pathlib
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROCESSORS = ["localization", "detection", "tracking"]  # what a scan passes
KEEPERS = ["map-store", "loop-closing"]
BUS = """<CycloneDDS><Domain Id="any"><General><Interfaces><NetworkInterface name="lo"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>120</MaxAutoParticipantIndex>
<Peers><Peer Address="127.0.0.1"/></Peers><Tag>{0}</Tag></Discovery></Domain></CycloneDDS>"""


def parse(arguments=None):
    parser = argparse.ArgumentParser(description=sys.modules["__main__"].__doc__)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/release/bin", help="folder of slammot and its services")
    parser.add_argument("--observer", type=pathlib.Path, default=ROOT / "build/release/tests/chaos_observer")
    parser.add_argument("--domain", type=int, default=100, help="DDS domain; its bus is on loopback, and closed by a tag")
    parser.add_argument("--full", action="store_true", help="as long as the figure is wanted for, instead of a minute")
    parser.add_argument("--hours", type=float, help="length of the drive of endurance_case")
    parser.add_argument("--sound", action="store_true", help="fail only for what does not depend on the speed of this computer")
    parser.add_argument("--json", action="store_true", help="rows as JSON, one a line")
    parser.add_argument("--input", type=pathlib.Path, help="drive in place of a simulated one")
    parser.add_argument("--keep", action="store_true", help="keep the folder with logs")
    return parser.parse_args(arguments)


def row(case, wanted, figure, passed, sound=None, **details):
    """A row of the table: what was wanted, what was measured, and whether that is enough. Details are numbers for other programs.

    sound: whether what does not depend on the speed of the computer is as it must be; default: passed."""
    return {"case": case, "wanted": wanted, "figure": figure, "passed": bool(passed), "sound": bool(passed if sound is None else sound),
            "details": details}


def main(cases):
    """Runs the cases, prints their rows, and ends with 0 if all passed (with --sound: are sound), 77 if one cannot run here."""
    options = parse()
    passed = True
    for one in cases(options):
        passed = passed and one["sound" if options.sound else "passed"]
        if options.json:
            print(json.dumps(one), flush=True)
        else:
            print(f"{'passed' if one['passed'] else 'FAILED'}  {one['case']}: {one['figure']}  (wanted: {one['wanted']})", flush=True)
    sys.exit(0 if passed else 1)


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def percentile(values, share):
    """As of the services: the smallest value that at least this share does not exceed."""
    ordered = sorted(values)
    return ordered[max(0, min(len(ordered) - 1, int(share * len(ordered) + 0.999999) - 1))] if ordered else float("nan")


def summary(values):
    return {"count": len(values), "p50": percentile(values, 0.5), "p99": percentile(values, 0.99), "worst": max(values, default=float("nan")),
            "mean": statistics.fmean(values) if values else float("nan")}


def load():
    """Of this computer, for beside a figure."""
    return f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"


def wait_until(condition, what, within_s=30.0):
    end = time.monotonic() + within_s
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            raise AssertionError(f"waited {within_s} s in vain for {what}")
        time.sleep(0.02)


class Observer:
    """Lines of chaos_observer, as they come."""

    def __init__(self, program, environment, period_s=1.0, stages=False):
        command = [program, "--period", str(period_s)] + (["--stages"] if stages else [])
        self.process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True)
        self.lines = []
        self.thread = threading.Thread(target=self._read, daemon=True)
        self.thread.start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.append(json.loads(line))

    def last(self):
        return self.lines[-1] if self.lines else {"vehicles": {}, "services": [], "time_s": 0.0}

    def vehicle(self, name):
        return self.last()["vehicles"].get(name, {"scans": 0, "tracked": 0, "unanswered": 0, "unanswered_ns": [], "pending": 0, "pose": None, "tracks": []})

    def status(self, service, vehicle="vehicle", instance="main"):
        """The newest status of a service; None before the first. service as on the bus: map_store."""
        found = [one for one in self.last()["services"] if (one["service"], one["vehicle"], one["instance"]) == (service, vehicle, instance)]
        return max(found, key=lambda one: one["stamp_ns"], default=None)

    def counter(self, service, name, **which):
        status = self.status(service, **which)
        return status["counters"].get(name, 0) if status else 0

    def latencies_ms(self, vehicle, stage="tracked", from_s=0.0, to_s=float("inf")):
        """Publication of a scan to reception of the stage's answer, of the lines of this time (system clock)."""
        return [one for line in list(self.lines) if from_s <= line["time_s"] <= to_s
                for one in line["vehicles"].get(vehicle, {}).get("latencies_ms", {}).get(stage, [])]

    def end(self):
        self.process.terminate()
        self.process.wait()
        self.thread.join()


class Services:
    """Services of one or several vehicles on a bus of their own. Ends all of them, and removes their files, at the end of a with block."""

    def __init__(self, options, domain=None):
        self.options = options
        self._folder = tempfile.TemporaryDirectory(prefix="slammot-chaos-")
        self.folder = pathlib.Path(self._folder.name)
        self.domain = options.domain if domain is None else domain
        self.environment = dict(os.environ, SLAMMOT_DOMAIN=str(self.domain), CYCLONEDDS_URI=BUS.format(f"chaos-{os.getpid()}"))
        self.running = {}  # by (service, vehicle, instance)
        self.observers = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for key in list(self.running):
            self.kill(*key)
        for observer in self.observers:
            observer.end()
        if self.options.keep:
            print(f"logs: {self.folder}", file=sys.stderr)
            self._folder._finalizer.detach()
        else:
            self._folder.cleanup()

    def start(self, service, *arguments, vehicle="vehicle", instance="main", state_dir=None):
        command = [self.options.bin / f"slammot-{service}", "--vehicle", vehicle, "--instance", instance,
                   "--state-dir", state_dir or self.folder / "state", *map(str, arguments)]
        with open(self.log_of(service, vehicle, instance), "a", encoding="utf-8") as log:
            process = subprocess.Popen(command, env=self.environment, stdout=log, stderr=log)
        self.running[service, vehicle, instance] = process
        return process

    def start_all(self, services, *arguments, vehicle="vehicle"):
        for service in services:
            self.start(service, *arguments, vehicle=vehicle)

    def log_of(self, service, vehicle="vehicle", instance="main"):
        return self.folder / f"{vehicle}-{service}-{instance}.log"

    def signal(self, number, service, vehicle="vehicle", instance="main"):
        self.running[service, vehicle, instance].send_signal(number)

    def pause(self, service, **which):
        self.signal(signal.SIGSTOP, service, **which)

    def go_on(self, service, **which):
        self.signal(signal.SIGCONT, service, **which)

    def kill(self, service, vehicle="vehicle", instance="main"):
        """kill -9, as a crash."""
        process = self.running.pop((service, vehicle, instance))
        process.kill()
        process.wait()

    def stop(self, service, vehicle="vehicle", instance="main", within_s=10):
        """SIGTERM; returns the exit code."""
        process = self.running.pop((service, vehicle, instance))
        process.terminate()
        return process.wait(timeout=within_s)

    def observe(self, period_s=1.0, stages=False):
        self.observers.append(Observer(self.options.observer, self.environment, period_s, stages))
        return self.observers[-1]

    def command(self, service, verb, argument="", vehicle="vehicle"):
        """Sends a command to a service and returns its answer."""
        done = subprocess.run([self.options.observer, "--send", vehicle, service, verb, argument], env=self.environment, capture_output=True,
                              text=True, timeout=30, check=True)
        return done.stdout.strip()

    def simulate(self, scenario, *arguments):
        """Path of the log of a simulated drive."""
        subprocess.run([self.options.bin / "slammot", "simulate", scenario, "--output", self.folder, *arguments], check=True,
                       stdout=subprocess.DEVNULL)
        return self.folder / f"{pathlib.Path(scenario).stem}.log"

    def slammot(self, *arguments, **settings):
        return subprocess.run([self.options.bin / "slammot", *map(str, arguments)], env=self.environment, check=True, **settings)
