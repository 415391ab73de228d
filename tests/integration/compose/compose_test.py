#!/usr/bin/env python3
"""The services in containers give what one process gives, also when containers die on the way.

Usage: compose_test.py SOURCE_ROOT SLAMMOT_EXECUTABLE WORK_FOLDER. Exit code 77: no Docker engine runs here.
Makes the image (deploy/image) unless it is up to date, uses a network and a project name of its own, and removes its
containers, volumes and network whatever happens.
"""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from trajectory import aligned_rmse_m, read_tum

SKIPPED = 77
WHOLE_TEST_S = 780  # Under ctest's limit, so that there is time to clean up.
ONE_DRIVE_S = 240
PROJECT_PREFIX = "slammottest"


def run(*command, check=True, env=None, cwd=None, timeout=120, stderr=False):
    """Standard output (and error, if wanted) of a command; with check, a failure of it ends the test."""
    done = subprocess.run(command, capture_output=True, text=True, env=env, cwd=cwd, timeout=timeout, check=False)
    if check and done.returncode != 0:
        raise AssertionError(f"{' '.join(command)} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return (done.stdout + done.stderr if stderr else done.stdout).strip()


def wait_until(condition, what, within_s):
    deadline = time.monotonic() + within_s
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError(f"not within {within_s:.0f} s: {what}")
        time.sleep(0.2)


def engine_runs():
    try:
        subprocess.run(["docker", "info"], capture_output=True, timeout=20, check=True)
        return shutil.which("docker-compose") is not None or compose_command() is not None
    except (OSError, subprocess.SubprocessError):
        return False


def compose_command():
    if shutil.which("docker-compose"):
        return ["docker-compose"]
    plugin = subprocess.run(["docker", "compose", "version"], capture_output=True, check=False)
    return ["docker", "compose"] if plugin.returncode == 0 else None


def remove_leftovers():
    """Of earlier runs of this test that were cut off."""
    for kind, listing in (("container", ["ps", "-aq"]), ("volume", ["volume", "ls", "-q"]), ("network", ["network", "ls", "-q"])):
        names = run("docker", *listing, "--filter", f"name={PROJECT_PREFIX}").split()
        force = [] if kind == "network" else ["-f"]
        for name in names:
            run("docker", kind, "rm", *force, name, check=False)


class Containers:
    """One replay of a drive through the containers, from 'up' to the end of the collector."""

    def __init__(self, root, output, drive, speed):
        self.root = root
        self.output = output
        self.project = f"{PROJECT_PREFIX}{os.getpid()}"
        ids = (os.getuid(), os.getgid()) if os.getuid() else (10001, 10001)
        shutil.rmtree(output, ignore_errors=True)
        output.mkdir(parents=True)
        os.chown(output, *ids)
        self.env = dict(os.environ, SLAMMOT_INPUT=str(drive), SLAMMOT_OUTPUT=str(output), SLAMMOT_SPEED=str(speed),
                        SLAMMOT_SUBNET=run(str(root / "deploy/free-subnet")), SLAMMOT_UID=str(ids[0]),
                        SLAMMOT_GID=str(ids[1]))

    def compose(self, *arguments, check=True):
        return run(*compose_command(), "-p", self.project, *arguments, check=check, env=self.env, cwd=self.root)

    def __enter__(self):
        self.compose("up", "-d")
        return self

    def __exit__(self, fault, *_):
        if fault:
            print(self.compose("logs", "--no-color", "--tail=40", check=False))
        self.compose("down", "-v", "--remove-orphans", "-t", "2", check=False)

    def container(self, service):
        return self.compose("ps", "-q", service)

    def state(self, service):
        return json.loads(run("docker", "inspect", "--format", "{{json .State}}", self.container(service)))

    def restarts(self, service):
        return int(run("docker", "inspect", "--format", "{{.RestartCount}}", self.container(service)))

    def crash(self, service):
        """Ends the service's process as a fault in it would; the engine's restart policy has to bring it back."""
        run("docker", "exec", self.container(service), "sh", "-c", "kill -9 -1", check=False)
        wait_until(lambda: self.restarts(service) > 0 and self.state(service)["Running"], f"{service} is restarted", 30)

    def kill_and_start(self, service):
        """The engine takes 'docker kill' for the operator's wish and restarts nothing: the operator does."""
        run("docker", "kill", "-s", "KILL", self.container(service))
        run("docker", "start", self.container(service))

    def wait_for_outputs(self):
        code = run("docker", "wait", self.container("collector"), timeout=ONE_DRIVE_S)
        assert code == "0", f"the collector ended with {code}"

    def wait_until_driving(self, seconds):
        """Until ingest has been playing for so long; the drive must not be over by then."""
        wait_until(lambda: "plays" in run("docker", "logs", self.container("ingest"), stderr=True), "ingest plays", 60)
        began = time.monotonic()
        wait_until(lambda: time.monotonic() - began >= seconds, "the drive goes on", seconds + 10)
        assert self.state("collector")["Running"], "the drive was over before anything could die"


def confirmed_tracks(folder):
    rows = (folder / "tracks.csv").read_text(encoding="utf-8").splitlines()[1:]
    return len({row.split(",")[1] for row in rows})


def submaps(folder):
    lines = (folder / "graph.g2o").read_text(encoding="utf-8").splitlines()
    return sum(line.startswith("VERTEX_SE2 ") for line in lines)


def ate_m(folder, truth):
    return aligned_rmse_m(read_tum(folder / "trajectory.tum"), truth)


def check_same_drive(containers, reference, truth, ate_factor):
    """Same scans, same submaps, and an error no larger than that of one process by a factor, or 5 cm."""
    assert len(read_tum(containers / "trajectory.tum")) == len(read_tum(reference / "trajectory.tum")), "scans are missing"
    assert submaps(containers) == submaps(reference), f"{submaps(containers)} submaps, one process has {submaps(reference)}"
    ate, expected = ate_m(containers, truth), ate_m(reference, truth)
    print(f"  ATE {ate:.3f} m, one process {expected:.3f} m; {confirmed_tracks(containers)} tracks, "
          f"one process {confirmed_tracks(reference)}")
    assert ate <= max(expected * ate_factor, expected + 0.05), f"ATE {ate:.3f} m"


def check_same_tracks(containers, reference):
    tracks, expected = confirmed_tracks(containers), confirmed_tracks(reference)
    assert abs(tracks - expected) <= 0.05 * expected, f"{tracks} confirmed tracks, one process has {expected}"


def test_containers_agree_with_one_process(root, work, drive, truth, reference):
    print("containers, undisturbed, as fast as they go")
    with Containers(root, work / "undisturbed", drive, "max") as containers:
        containers.wait_for_outputs()
        check_same_drive(work / "undisturbed", reference, truth, ate_factor=1.0)
        check_same_tracks(work / "undisturbed", reference)
        print("the same drive again, with every service still running")
        for output in (work / "undisturbed").iterdir():
            output.unlink()
        containers.compose("up", "-d")
        containers.wait_for_outputs()
        check_same_drive(work / "undisturbed", reference, truth, ate_factor=1.0)
        check_same_tracks(work / "undisturbed", reference)


def test_containers_may_die(root, work, drive, truth, reference):
    print("containers as fast as they go; localization crashes, map_store is killed and started")
    with Containers(root, work / "disturbed", drive, "max") as containers:
        containers.wait_until_driving(0.5)
        containers.crash("localization")
        containers.kill_and_start("map_store")
        containers.wait_for_outputs()
    check_same_drive(work / "disturbed", reference, truth, ate_factor=1.2)


def test_the_collector_may_die(root, work, drive, truth, reference):
    # The bus keeps 200 scans, 2.7 s at this speed; scans beyond that have the pose between.
    print("containers at twice the recorded speed; the collector crashes")
    with Containers(root, work / "collector_disturbed", drive, "2") as containers:
        containers.wait_until_driving(10)
        containers.crash("collector")
        containers.wait_for_outputs()
    check_same_drive(work / "collector_disturbed", reference, truth, ate_factor=1.2)


def main(root, slammot, work):
    if not engine_runs():
        print("skipped: no Docker engine with Compose runs here")
        return SKIPPED
    signal.signal(signal.SIGALRM, lambda *_: (_ for _ in ()).throw(AssertionError(f"not done in {WHOLE_TEST_S} s")))
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    signal.alarm(WHOLE_TEST_S)
    remove_leftovers()
    run(str(root / "deploy/image"), timeout=WHOLE_TEST_S)
    work.mkdir(parents=True, exist_ok=True)
    drive, truth = root / "out/drive/block.log", read_tum(root / "out/drive/block.tum")
    reference = work / "one_process"
    run(slammot, "run", "--input", str(drive), "--output", str(reference), "--profile", "urban")
    test_containers_agree_with_one_process(root, work, drive, truth, reference)
    test_containers_may_die(root, work, drive, truth, reference)
    test_the_collector_may_die(root, work, drive, truth, reference)
    print("the containers do what one process does")
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), sys.argv[2], Path(sys.argv[3]).resolve()))
