#!/usr/bin/env python3
"""Installs, runs, upgrades and purges the Debian packages in a bare Debian root that systemd boots in a container.

Usage: bare_root.py [--root TAR] OLD_DEBS NEW_DEBS DRIVE_LOG, folders of deploy/debs; needs root, mmdebstrap and systemd-nspawn.
--root keeps the bare root in a file, to begin faster the next time. Prints a table of what was done; ends with 1 at the first fault.
"""

import argparse
import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SKIPPED = 77
UNITS = ["localization", "detection", "tracking", "collision-warning", "loop-closing", "map-store", "gateway"]
ROLES_AND_TOOLS = ["slammot-common", "slammot-sensors", "slammot-estimation", "slammot-closing", "slammot-view", "slammot-tools", "slammot"]


def say(what, figure):
    print(f"| {what} | {figure} |", flush=True)


def run(*command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout.strip()


def seconds_until(condition, what, within_s):
    begin = time.monotonic()
    while not condition():
        if time.monotonic() - begin > within_s:
            raise AssertionError(f"not within {within_s} s: {what}")
        time.sleep(0.02)
    return time.monotonic() - begin


def make_root(folder, tar):
    if tar and tar.exists():
        run("tar", "-C", folder, "-xf", tar)
        return
    settings = folder.parent / "99host"
    settings.write_text("".join(line + "\n" for line in run("apt-config", "dump").splitlines()
                                if line.startswith(("Acquire::http", "Acquire::https", "Acquire::Check-"))))
    sources = [path for path in ("/etc/apt/sources.list.d/debian.sources", "/etc/apt/sources.list") if os.path.exists(path)][:1]
    run("mmdebstrap", "--quiet", "--variant=minbase", "--include=systemd,systemd-sysv,dbus",
        f"--customize-hook=copy-in {settings} /etc/apt/apt.conf.d", "bookworm", folder, *sources)
    if tar:
        run("tar", "-C", folder, "-cf", tar, ".")


class Container:
    """systemd in a bare root. Its network is a loopback of its own."""

    def __init__(self, root):
        self.root = root
        self.log = open(root.parent / "boot.log", "wb")
        self.process = subprocess.Popen(
            ["systemd-nspawn", "--quiet", "-D", root, "--register=no", "--keep-unit", "--private-network", "--boot"],
            stdin=subprocess.DEVNULL, stdout=self.log, stderr=self.log, start_new_session=True)
        self.leader = None

    def find_leader(self):
        children = Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children").read_text().split()
        self.leader = children[0] if children else None
        return self.leader is not None

    def call(self, *command, check=True):
        inside = ["nsenter", "-t", self.leader, "-m", "-u", "-i", "-n", "-p", "-C", *command]
        if check:
            return run(*inside)
        return subprocess.run(inside, capture_output=True, text=True, check=False)

    def is_up(self):
        return self.find_leader() and self.call("systemctl", "is-system-running", check=False).stdout.strip() in ("running", "degraded")

    def property_of(self, service, name):
        return self.call("systemctl", "show", "--value", "-p", name, f"slammot@{service}.service")

    def is_active(self, service):
        return self.property_of(service, "ActiveState") == "active"

    def main_process(self, service):
        return self.property_of(service, "MainPID")

    def end(self):
        if self.leader:
            with contextlib.suppress(ProcessLookupError):
                os.kill(int(self.leader), signal.SIGRTMIN + 3)  # systemd halts
        try:
            self.process.wait(30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.log.close()


def apt(root, *arguments):
    """Outside of the container's network, which is closed; maintainer scripts see systemd if it runs there."""
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive", "LC_ALL": "C"}
    return run("chroot", root, "apt-get", "-q", "-y", "--no-install-recommends", *arguments, env=environment)


def names_of(root, folder, target):
    shutil.copytree(folder, root / target.lstrip("/"), dirs_exist_ok=True)
    return [f"{target}/{deb.name}" for deb in sorted(folder.glob("*.deb")) if not deb.name.startswith("slammot-dev")]


def install(root, debs):
    begin = time.monotonic()
    apt(root, "update")
    names = names_of(root, debs, "/root/old")
    apt(root, "install", *names)
    say("install of all packages with what they need", f"{time.monotonic() - begin:.0f} s")
    for folder in ("/etc/slammot", "/var/lib/slammot", "/usr/lib/slammot"):
        assert (root / folder.lstrip("/")).is_dir(), folder
    say("user, state folder, configuration", "there")


def start(container, drive):
    shutil.copy(drive, container.root / "var/lib/slammot/drive.log")
    seconds_until(container.is_up, "boot", 60)
    container.call("chmod", "644", "/var/lib/slammot/drive.log")
    container.call("systemctl", "enable", "slammot.target")
    begin = time.monotonic()
    container.call("systemctl", "start", "slammot.target")
    seconds_until(lambda: all(container.is_active(unit) for unit in UNITS), "all units active", 30)
    say(f"`systemctl start slammot.target`: {len(UNITS)} services ready", f"{time.monotonic() - begin:.1f} s")
    container.call("systemctl", "start", "slammot@ingest.service")
    seconds_until(lambda: container.call("slammot", "health", "localization", check=False).returncode == 0, "localization runs", 30)
    say("drive played by slammot@ingest: `slammot health localization`", "running")


def restart(container):
    for name, sign, limit_s in (("kill -9", "KILL", 2), ("kill -STOP (watchdog 5 s)", "STOP", 10)):
        before = container.main_process("tracking")
        container.call("systemctl", "kill", "--kill-whom=main", f"--signal={sign}", "slammot@tracking.service")
        back_s = seconds_until(lambda: container.is_active("tracking") and container.main_process("tracking") not in ("0", before),
                               f"tracking back after {name}", limit_s)
        say(f"tracking ready again after {name}", f"{back_s:.2f} s")


def slow_down_a_crash_loop(container):
    """A drop-in makes the service end at once."""
    folder = container.root / "etc/systemd/system/slammot@detection.service.d"
    folder.mkdir(parents=True)
    (folder / "test.conf").write_text("[Service]\nExecStart=\nExecStart=/bin/false\n")
    container.call("systemctl", "daemon-reload")
    container.call("systemctl", "restart", "--no-block", "slammot@detection.service")
    before = int(container.property_of("detection", "NRestarts"))
    time.sleep(10)
    starts = int(container.property_of("detection", "NRestarts")) - before
    assert 3 <= starts <= 10, f"{starts} restarts in 10 s"
    shutil.rmtree(folder)
    container.call("systemctl", "daemon-reload")
    container.call("systemctl", "restart", "slammot@detection.service")
    say("restarts of a service that ends at once, in its first 10 s", starts)


def upgrade(container, debs):
    neighbours = ["map-store", "loop-closing", "gateway"]
    before = {unit: container.main_process(unit) for unit in UNITS}
    names = [name for name in names_of(container.root, debs, "/root/new") if "slammot-estimation" in name or "slammot-common" in name]
    container.call("env", "DEBIAN_FRONTEND=noninteractive", "dpkg", "-i", *names)
    seconds_until(lambda: all(container.is_active(unit) for unit in UNITS), "all units active after the upgrade", 30)
    after = {unit: container.main_process(unit) for unit in UNITS}
    assert all(after[unit] == before[unit] for unit in neighbours), "an upgrade of estimation restarts its neighbours"
    assert all(after[unit] != before[unit] for unit in ("localization", "tracking")), "an upgrade does not restart its services"
    seconds_until(lambda: container.call("slammot", "health", "localization", "tracking", "map_store", check=False).returncode == 0,
                  "health after the upgrade", 30)
    say("upgrade of slammot-estimation", "its services restarted, 3 neighbours ran on, all healthy")


def configuration_is_kept(container):
    file = container.root / "etc/slammot/slammot.env"
    text = file.read_text() + "# changed by hand\n"
    file.write_text(text)
    container.call("dpkg", "--force-confdef", "--force-confold", "-i", *[f"/root/new/{deb.name}" for deb in (container.root / "root/new").glob("slammot-common*.deb")])
    assert file.read_text() == text
    say("changed /etc/slammot/slammot.env after an upgrade", "kept")


def purge(container):
    container.call("env", "DEBIAN_FRONTEND=noninteractive", "dpkg", "--purge", *reversed(ROLES_AND_TOOLS))
    left = container.call("sh", "-c", "find / -xdev -path '*slammot*' -not -path '/root/*' -not -path '/proc/*' -not -path '/var/log/*'")
    assert not left, f"left behind:\n{left}"
    users = container.call("sh", "-c", "getent passwd slammot; getent group slammot; pgrep -l slammot; true") \
        if (container.root / "usr/bin/pgrep").exists() else container.call("sh", "-c", "getent passwd slammot; getent group slammot; true")
    assert not users, users
    processes = container.call("sh", "-c", "grep -l slammot /proc/[0-9]*/comm 2>/dev/null; true")
    assert not processes, processes
    say("purge", "no file, user, unit or process left")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--root", type=Path)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("drive", type=Path)
    options = parser.parse_args()
    if os.geteuid() != 0 or not shutil.which("mmdebstrap") or not shutil.which("systemd-nspawn"):
        print("skipped: needs root, mmdebstrap and systemd-nspawn (package systemd-container)")
        return SKIPPED
    with tempfile.TemporaryDirectory(prefix="slammot-root-") as work:
        root = Path(work) / "root"
        root.mkdir()
        make_root(root, options.root)
        print("| what | figure |\n|---|---|")
        install(root, options.old)
        container = Container(root)
        try:
            start(container, options.drive)
            restart(container)
            slow_down_a_crash_loop(container)
            upgrade(container, options.new)
            configuration_is_kept(container)
            purge(container)
        except AssertionError:
            if container.leader:
                print(container.call("journalctl", "-b", "--no-pager", "-n", "60", check=False).stdout)
            raise
        finally:
            container.end()
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except AssertionError as fault:
        print(f"error: {fault}", file=sys.stderr)
        sys.exit(1)
