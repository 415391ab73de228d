#!/usr/bin/env python3
"""Services divided over two computers: a cut, loss, delay and reordering, clocks apart and jumping, an interface that disappears.

A computer is a network namespace (bad_link.py). One runs ingest, map_store and loop_closing, the other localization, detection,
tracking and collision_warning, on the bus of deploy/dds/vehicle.xml. Skipped where namespaces are not there.
"""

import contextlib
import os
import re
import shutil
import struct
import subprocess
import tempfile
import threading
import time
from pathlib import Path

import bad_link
import chaos
import drives

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
FIRST = ["ingest", "map-store", "loop-closing"]
SECOND = ["localization", "detection", "tracking", "collision-warning"]
SCANS_HZ = 37.5
MEETS_WITHIN_S = 1.0


class Watch:
    """When samples of a topic arrived on a computer, and the values of one field."""

    def __init__(self, computer, slammot, topic, field, environment):
        self.seen = []  # (monotonic time, value)
        pattern = re.compile(rf"^{field}: (.*)$")
        self.process = computer.start([slammot, "echo", topic], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=environment)

        def read():
            for line in self.process.stdout:
                match = pattern.match(line)
                if match:
                    self.seen.append((time.monotonic(), match.group(1).strip('"')))

        threading.Thread(target=read, daemon=True).start()

    def since(self, begin, end=float("inf")):
        return [(when, value) for when, value in list(self.seen) if begin <= when <= end]

    def first_after(self, begin, value=None):
        """Seconds from `begin` to the first sample (with this value)."""
        return next((when - begin for when, seen in list(self.seen) if when >= begin and value in (None, seen)), None)

    def end(self):
        self.process.terminate()
        self.process.wait(10)


class Drive:
    """All services on two computers, restarted when they end as their units do, and watches on both sides."""

    def __init__(self, programs, log, domain, work, clock_offset_s=0.0, environment=None):
        self.programs, self.log, self.domain, self.work = programs.resolve(), log, domain, work
        self.slammot = self.programs / "slammot"
        mark = os.getpid()
        self.first = bad_link.Computer(f"slammot-a-{mark}", "10.77.30.1")
        self.second = bad_link.Computer(f"slammot-b-{mark}", "10.77.30.2")
        for computer in (self.first, self.second):
            computer.plug()
        self.link = bad_link.BadLink(self.first, self.second)
        self.clock = work / "clock"  # Offset of the second computer's, for set_clock.c.
        self.clock_library = compiled(HERE / "set_clock.c", work)
        self.environment = {**os.environ, **(environment or {}), "SLAMMOT_DOMAIN": str(domain), "SLAMMOT_INTERFACE": bad_link.INTERFACE}
        if "CYCLONEDDS_URI" not in (environment or {}):
            self.environment["CYCLONEDDS_URI"] = f"file://{ROOT}/deploy/dds/vehicle.xml"
        self.has_clock = clock_offset_s is not None
        if self.has_clock:
            self.set_clock(clock_offset_s)
        self.restarts = {name: 0 for name in FIRST + SECOND}
        self.processes, self.watches = {}, []
        self.is_running = True
        for name in [*SECOND, *FIRST[1:], FIRST[0]]:
            self.start(name)
        self.keeper = threading.Thread(target=self.keep_running, daemon=True)
        self.keeper.start()

    def set_clock(self, offset_s):
        """In place: the processes have the file in their memory."""
        with open(self.clock, "r+b" if self.clock.exists() else "wb") as file:
            file.write(struct.pack("<q", int(offset_s * 1e9)))

    def environment_of(self, computer):
        if computer is self.first or not self.has_clock:
            return self.environment
        return {**self.environment, "LD_PRELOAD": str(self.clock_library), "SLAMMOT_TEST_CLOCK": str(self.clock)}

    def start(self, name):
        computer = self.first if name in FIRST else self.second
        command = [self.programs / f"slammot-{name}", "--profile", "urban", "--state-dir", self.work / computer.name]
        if name == "ingest":
            command += ["--input", self.log, "--linger"]
        with open(self.work / f"{name}.log", "ab") as log:
            environment = {**self.environment_of(computer), "SLAMMOT_IDENTITY": name}
            self.processes[name] = computer.start(command, stdout=log, stderr=log, env=environment)

    def keep_running(self):
        while self.is_running:
            for name, process in list(self.processes.items()):
                if process.poll() is not None:
                    self.restarts[name] += 1
                    time.sleep(0.1)
                    self.start(name)
            time.sleep(0.02)

    def watch(self, computer, topic, field):
        watch = Watch(computer, self.slammot, topic, field, self.environment)
        self.watches.append(watch)
        return watch

    def ask(self, computer, *arguments):
        done = subprocess.run(["ip", "netns", "exec", computer.name, self.slammot, *arguments], capture_output=True, text=True,
                              env=self.environment, timeout=30, check=False)
        return done.stdout

    def end(self):
        self.is_running = False
        self.keeper.join()
        for watch in self.watches:
            watch.end()
        for process in self.processes.values():
            process.terminate()
        for process in self.processes.values():
            try:
                process.wait(5)
            except subprocess.TimeoutExpired:
                process.kill()
        self.link.stop()
        self.first.remove()
        self.second.remove()


def compiled(source, folder):
    library = folder / f"{source.stem}.so"
    subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-o", library, source, "-ldl"], check=True)
    return library


def wait_for(condition, what, within_s):
    end = time.monotonic() + within_s
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"not within {within_s} s: {what}")
        time.sleep(0.05)


def counter_of(text, name):
    return sum(int(total) for total in re.findall(rf"\b{name} (\d+)", text))


class Observed:
    """Watches of a drive that runs."""

    def __init__(self, drive):
        self.drive = drive
        wait_for(lambda: "scan_labels" in drive.ask(drive.first, "list"), "labels on the bus", 30)
        self.labels = drive.watch(drive.first, "slammot/scan_labels", "sequence_number")
        self.beats_on_first = drive.watch(drive.first, "slammot/heartbeat", "service_name")
        self.beats_on_second = drive.watch(drive.second, "slammot/heartbeat", "service_name")
        wait_for(lambda: len(self.labels.seen) > 75, "labels on the other computer", 30)

    def meeting_s(self, begin, patience_s=15):
        """Seconds from `begin` until labels come, and every service is heard on the other computer; by name."""
        wanted = [(self.beats_on_first, name.replace("-", "_")) for name in SECOND]
        wanted += [(self.beats_on_second, name.replace("-", "_")) for name in FIRST]

        def times():
            found = {name: watch.first_after(begin, name) for watch, name in wanted}
            found["labels"] = self.labels.first_after(begin)
            return found

        with contextlib.suppress(AssertionError):
            wait_for(lambda: None not in times().values(), "meeting", patience_s)
        return times()


def result(drive, case, wanted, figure, fault):
    restarts = sum(drive.restarts.values())
    return chaos.row(case, wanted, figure + (f"; {restarts} restarts so far" if restarts else "") + (f"; {fault}" if fault else ""), not fault,
                     sound=not fault or (fault.startswith("late") and "None" not in fault))


def judge_meeting(times):
    late = {name: time_s for name, time_s in times.items() if time_s is None or time_s > MEETS_WITHIN_S}
    return f"late: {late}" if late else ""


def cut(observed, cut_s):
    drive = observed.drive
    before = drive.ask(drive.second, "top", "--once")
    begin = time.monotonic()
    drive.link.conditions = bad_link.Conditions(is_cut=True)
    time.sleep(cut_s - 2)
    complaints = drive.ask(drive.second, "health") + drive.ask(drive.first, "health")
    time.sleep(max(0.0, begin + cut_s - time.monotonic()))
    healed = time.monotonic()
    drive.link.conditions = bad_link.Conditions()
    times = observed.meeting_s(healed)
    time.sleep(5)
    after = drive.ask(drive.second, "top", "--once")
    missed = counter_of(after, "missed_laser_scan") - counter_of(before, "missed_laser_scan")
    late = len(observed.labels.since(healed)) - (time.monotonic() - healed) * SCANS_HZ  # what the source kept is answered after the cut
    expected = cut_s * SCANS_HZ
    fault = judge_meeting(times)
    if "no slammot/laser_scan for" not in complaints:
        fault = "health does not name the missing scans"
    if not 0.8 * expected < missed + late < 1.2 * expected:
        fault = fault or f"counted {missed} and answered {late:.0f} of {expected:.0f} scans"
    worst = max(times.items(), key=lambda item: item[1] or 99)
    return result(drive, f"cut of {cut_s:.0f} s between two computers", f"all meet within {MEETS_WITHIN_S:.0f} s, lost scans counted",
                  f"labels again after {times['labels'] or -1:.2f} s, the last service ({worst[0]}) after {worst[1] or -1:.2f} s; "
                  f"of {expected:.0f} scans {missed} counted as missed, {late:.0f} answered late", fault)


def bad_conditions(observed, name, conditions, time_s=20, least=0.97):
    drive = observed.drive
    before = drive.ask(drive.second, "top", "--once") + drive.ask(drive.first, "top", "--once")
    drive.link.conditions = conditions
    begin = time.monotonic()
    lost = drive.link.lost
    time.sleep(time_s)
    answered = len(observed.labels.since(begin, begin + time_s)) / (time_s * SCANS_HZ)
    after = drive.ask(drive.second, "top", "--once") + drive.ask(drive.first, "top", "--once")
    missed = counter_of(after, "missed_laser_scan") - counter_of(before, "missed_laser_scan")
    drive.link.conditions = bad_link.Conditions()
    fault = "" if answered >= least else f"only {answered:.3f} of the scans are answered"
    return result(drive, f"{name}, between two computers", f"at least {least} of the scans answered",
                  f"{answered:.3f} answered on the other computer, {drive.link.lost - lost} packets lost, {missed} missed scans counted", fault)


def clock_jump(observed, offset_s):
    drive = observed.drive
    begin = time.monotonic()
    drive.set_clock(offset_s)
    time.sleep(8)
    moments = [begin, *(when for when, _ in observed.labels.since(begin)), time.monotonic()]
    gap_s = max(b - a for a, b in zip(moments, moments[1:]))
    fault = judge_meeting(observed.meeting_s(time.monotonic())) or ("" if gap_s < MEETS_WITHIN_S else "labels stop")
    return result(drive, f"clock of one computer jumps to {offset_s:+.0f} s", f"labels go on within {MEETS_WITHIN_S:.0f} s",
                  f"longest gap of labels {gap_s:.2f} s", fault)


def unplug(observed):
    drive = observed.drive
    drive.second.unplug()
    time.sleep(5)
    drive.second.plug()
    back = time.monotonic()
    times = observed_again_s(drive, back)
    fault = judge_meeting(times)
    worst = max(times.items(), key=lambda item: item[1] or 99)
    return result(drive, "interface of one computer gone for 5 s", f"all meet within {MEETS_WITHIN_S:.0f} s",
                  f"labels again after {times['labels'] or -1:.2f} s, the last service ({worst[0]}) after {worst[1] or -1:.2f} s", fault)


def observed_again_s(drive, begin):
    """The watches on the first computer only: those on the other one share its fate."""
    labels = next(watch for watch in drive.watches if watch.process.args[-1] == "slammot/scan_labels")
    beats = next(watch for watch in drive.watches if watch.process.args[-1] == "slammot/heartbeat")
    wanted = {name.replace("-", "_"): beats for name in SECOND}

    def times():
        found = {name: watch.first_after(begin, name) for name, watch in wanted.items()}
        found["labels"] = labels.first_after(begin)
        return found

    with contextlib.suppress(AssertionError):
        wait_for(lambda: None not in times().values(), "meeting", 15)
    return times()


def cases(options):
    missing = bad_link.is_possible() or ("" if shutil.which("cc") else "needs a C compiler")
    if missing:
        chaos.skip(missing)
    with tempfile.TemporaryDirectory(prefix="slammot-hosts-") as folder:
        work = Path(folder)
        drive = Drive(options.bin, log_for(options, work), options.domain, work, clock_offset_s=0.05)
        try:
            observed = Observed(drive)
            yield cut(observed, 20.0)
            yield bad_conditions(observed, "5 % loss, clocks 50 ms apart", bad_link.Conditions(loss=0.05))
            yield bad_conditions(observed, "packets 20 to 40 ms late, in another order", bad_link.Conditions(delay_s=0.02, jitter_s=0.02))
            yield clock_jump(observed, 3600.0)
            yield clock_jump(observed, -3600.0)
            yield unplug(observed)
        finally:
            drive.end()
            if options.keep:
                shutil.copytree(work, "out/hosts_case", dirs_exist_ok=True)


def log_for(options, work):
    """Five minutes of driving."""
    if options.input:
        return options.input.resolve()
    subprocess.run([options.bin / "slammot", "simulate", "block", "--output", work], check=True, stdout=subprocess.DEVNULL)
    return drives.to_and_fro(work / "block.log", work / "long.log", 300 * 38)


if __name__ == "__main__":
    chaos.main(cases)
