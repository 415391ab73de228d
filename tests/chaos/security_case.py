#!/usr/bin/env python3
"""A secured bus: intruders see nothing and inject nothing, and encryption costs little.

Starts the services on loopback with identities of `slammot keys`, then processes without identity, with one of another authority,
an expired one, a revoked one, and one for another topic, each of which tries to read and to send scans of the same vehicle. Then
measures scan published -> tracks received, plain and secured in turns. Skipped where openssl or the plugins are not there.
"""

import os
import shutil
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import chaos
import drives
import recorded_latency

ROOT = Path(__file__).resolve().parents[2]
PLUGINS = next(iter(sorted(Path("/usr/lib").glob("*/libddsc0debian"))), None)
SERVICES = ["map-store", "loop-closing", "localization", "detection", "tracking"]
PLAIN = f"file://{ROOT}/deploy/dds/one_computer.xml"
SECURED = f"{PLAIN},file://{ROOT}/deploy/dds/security.xml"


class Bus:
    """The services on one bus, plain or secured by a folder of keys."""

    def __init__(self, slammot, log, domain, work, keys=None):
        self.slammot, self.log, self.work, self.keys = slammot, log, work, keys
        self.environment = {**os.environ, "SLAMMOT_DOMAIN": str(domain), "CYCLONEDDS_URI": SECURED if keys else PLAIN,
                            "SLAMMOT_KEYS": str(keys), "SLAMMOT_SECURITY_PLUGINS": str(PLUGINS)}
        self.work.mkdir()
        self.processes = {name: self.start(name) for name in SERVICES}
        self.processes["ingest"] = self.start("ingest", "--input", log, "--linger")

    def start(self, name, *arguments, identity=None, environment=None, log=None):
        command = [self.slammot.with_name(f"slammot-{name}"), "--profile", "urban", "--state-dir", self.work / (log or name), *arguments]
        with open(self.work / f"{log or name}.log", "wb") as file:
            return subprocess.Popen(command, stdout=file, stderr=file,
                                    env={**(environment or self.environment), "SLAMMOT_IDENTITY": identity or name})

    def ask(self, *arguments, environment=None, timeout=15):
        done = subprocess.run([self.slammot, *arguments], capture_output=True, text=True, check=False, timeout=timeout,
                              env=environment or {**self.environment, "SLAMMOT_IDENTITY": "tools"})
        return done.returncode, done.stdout + done.stderr

    def wait_until_tracking(self):
        end = time.monotonic() + 40
        while self.ask("health", "tracking")[0] != 0:
            if time.monotonic() > end:
                raise AssertionError("tracking does not run: " + self.ask("health")[1])
            time.sleep(0.3)

    def end(self):
        for process in self.processes.values():
            process.terminate()
        for process in self.processes.values():
            try:
                process.wait(5)
            except subprocess.TimeoutExpired:
                process.kill()


def make_keys(slammot, folder):
    """Keys of the services; `before` is a copy from before a revocation."""
    def keys(*arguments):
        subprocess.run([slammot, "keys", *arguments], check=True, stdout=subprocess.DEVNULL)

    keys("init", folder)
    keys("issue", folder)
    keys("issue", folder, "gnss", "--publish", "slammot/gnss_fix")
    keys("issue", folder, "thief", "--publish", "slammot/*", "--subscribe", "slammot/*")
    keys("issue", folder, "expired", "--publish", "slammot/*", "--subscribe", "slammot/*")
    subprocess.run(["openssl", "ca", "-batch", "-notext", "-config", "ca/openssl.cnf", "-in", "ca/expired.csr.pem", "-out", "expired.cert.pem",
                    "-startdate", "20200101000000Z", "-enddate", "20200201000000Z"], cwd=folder, check=True, capture_output=True)
    before = folder.with_name("before")
    shutil.copytree(folder, before)
    keys("revoke", folder, "thief")
    other = folder.with_name("other")
    keys("init", other)
    keys("issue", other, "ingest", "tools")
    return before, other


def loss_figures(bus):
    """What localization counts of scans that are not of its source."""
    text = bus.ask("top", "--once")[1]
    return [word for word in ("foreign", "stray", "scans_of_earlier_drives") if word in text]


def reads_a_sample(bus, topic, environment):
    try:
        code, text = bus.ask("echo", topic, "-n", "1", environment=environment, timeout=3)
    except subprocess.TimeoutExpired:
        return False
    return code == 0 and "vehicle_id" in text


def try_to_intrude(bus, name, environment, identity):
    """What an intruder reads, and what its scans do: both should be nothing."""
    environment = {**environment, "SLAMMOT_IDENTITY": identity}
    sees = [what for what in ("tracked_objects", "heartbeat", "laser_scan") if reads_a_sample(bus, what, environment)]
    injector = bus.start("ingest", "--input", bus.log, "--linger", "--instance", "intruder", identity=identity, environment=environment, log=name)
    time.sleep(4)
    ended = injector.poll()
    injector.terminate()
    injector.wait(10)
    words = (bus.work / f"{name}.log").read_text().strip().splitlines()
    injects = loss_figures(bus)
    refused = f"does not start (exit code {ended}): {words[-1][:110] if words else ''}" if ended is not None else "starts, meets nobody"
    return sees, injects, refused


def intruders(bus, keys, before, other):
    cases = {
        "without identity": ({**bus.environment, "CYCLONEDDS_URI": PLAIN}, "none"),
        "with one of another authority": ({**bus.environment, "SLAMMOT_KEYS": str(other)}, "ingest"),
        "with an expired one": (bus.environment, "expired"),
        "with a revoked one": (bus.environment, "thief"),
        "with a revoked one and an old list": ({**bus.environment, "SLAMMOT_KEYS": str(before)}, "thief"),
        "with one for another topic": (bus.environment, "gnss"),
    }
    tools = {**bus.environment, "SLAMMOT_IDENTITY": "tools"}
    assert all(reads_a_sample(bus, topic, tools) for topic in ("tracked_objects", "heartbeat", "laser_scan")), "with an identity all is seen"
    for number, (name, (environment, identity)) in enumerate(cases.items()):
        sees, injects, refused = try_to_intrude(bus, f"intruder{number}", environment, identity)
        fault = f"; sees {sees}, injects {injects}" if sees or injects else ""
        yield chaos.row(f"secured bus: intruder {name}", "sees nothing, injects nothing", refused + fault, not fault)
    code, health = bus.ask("health", "tracking", "localization")
    yield chaos.row("secured bus: services beside intruders", "run", "; ".join(health.strip().splitlines()), code == 0)


def measured_ms(slammot, log, domain, work, keys, seconds=20):
    bus = Bus(slammot, log, domain, work, keys)
    try:
        bus.wait_until_tracking()
        time.sleep(3)
        recording = work / "recording.mcap"
        subprocess.run([slammot, "record", "--output", recording, "--topics", "slammot/laser_scan,slammot/tracked_objects", "--compression", "none",
                        "--duration", str(seconds)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                       env={**bus.environment, "SLAMMOT_IDENTITY": "recorder"}, timeout=seconds + 30)
        values = recorded_latency.latencies_ms(recording)
        assert len(values) > seconds * 20, f"only {len(values)} results recorded"
        return statistics.median(values), values[int(0.99 * len(values))]
    finally:
        bus.end()


def cost(slammot, log, domain, folder, keys, pairs):
    ratios, figures = [], []
    for pair in range(pairs):
        plain = measured_ms(slammot, log, domain, folder / f"plain{pair}", None)
        secured = measured_ms(slammot, log, domain + 1, folder / f"secured{pair}", keys)
        ratios.append(secured[0] / plain[0])
        figures.append((plain, secured))
    ratio = statistics.median(ratios)
    plain_ms, secured_ms = (statistics.median(pair[i][0] for pair in figures) for i in (0, 1))
    p99 = [statistics.median(pair[i][1] for pair in figures) for i in (0, 1)]
    return chaos.row(f"secured bus: scan published to tracks received, {pairs} pairs", "p50 <= 1.5 x plain",
                     f"p50 {secured_ms:.2f} ms against {plain_ms:.2f} ms, ratio {ratio:.2f} ({min(ratios):.2f} to {max(ratios):.2f}); "
                     f"p99 {p99[1]:.2f} and {p99[0]:.2f} ms; {chaos.load()}", ratio <= 1.5,
                     sound=plain_ms > 0.0 and secured_ms > 0.0)


def cases(options):
    if not shutil.which("openssl") or PLUGINS is None:
        chaos.skip("needs openssl and the security plugins of libddsc0debian")
    slammot = options.bin.resolve() / "slammot"
    with tempfile.TemporaryDirectory(prefix="slammot-security-") as name:
        folder = Path(name)
        log = options.input.resolve() if options.input else long_drive(slammot, folder)
        keys = folder / "keys"
        before, other = make_keys(slammot, keys)
        bus = Bus(slammot, log, options.domain, folder / "services", keys)
        try:
            bus.wait_until_tracking()
            yield from intruders(bus, keys, before, other)
        finally:
            bus.end()
        yield cost(slammot, log, options.domain, folder, keys, 7 if options.full else 2)


def long_drive(slammot, folder):
    subprocess.run([slammot, "simulate", "block", "--output", folder], check=True, stdout=subprocess.DEVNULL)
    return drives.to_and_fro(folder / "block.log", folder / "long.log", 300 * 38)


if __name__ == "__main__":
    chaos.main(cases)
