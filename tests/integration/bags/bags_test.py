#!/usr/bin/env python3
"""A drive as a bag of ROS, written by PyPI's `rosbags` in every form and compression, gives the same results as its CARMEN
log, byte by byte; bags that are cut or damaged give what can be read of them and one line. Exit code 77 where `rosbags` cannot be
installed."""

import argparse
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77
LOG_IS_CUT = 3
SCANS = 150
RESULTS = ("online.tum", "trajectory.tum", "tracks.csv", "map.pgm", "moving.pgm", "graph.g2o")


def enter_environment(venv: pathlib.Path):
    """Goes on in an environment that has `rosbags`. Exits as skipped where that cannot be made."""
    python = venv / "bin" / "python"
    if pathlib.Path(sys.prefix).resolve() == venv.resolve():
        return
    has_rosbags = [str(python), "-c", "import rosbags, numpy"]
    if not python.exists() or subprocess.run(has_rosbags, capture_output=True, check=False).returncode != 0:
        steps = (
            [sys.executable, "-m", "venv", str(venv)],
            [str(venv / "bin" / "pip"), "install", "--quiet", "--disable-pip-version-check", "--retries", "1", "rosbags"],
        )
        for step in steps:
            made = subprocess.run(step, capture_output=True, text=True, check=False)
            if made.returncode != 0:
                reason = (made.stderr + made.stdout).strip().splitlines()[-1:]
                print("skipped: rosbags (PyPI) cannot be installed:", *reason)
                sys.exit(SKIPPED)
    sys.exit(subprocess.run([str(python), *sys.argv], check=False).returncode)


class Test:
    def __init__(self, slammot: str, folder: pathlib.Path):
        self.slammot = slammot
        self.folder = folder
        self.faults = []

    def check(self, is_right: bool, fault: str):
        if not is_right:
            self.faults.append(fault)

    def run(self, log: pathlib.Path, name: str):
        """What the process said, and the folder of its results."""
        output = self.folder / ("results-" + name)
        done = subprocess.run([self.slammot, "run", "--input", str(log), "--output", str(output)], capture_output=True, text=True, check=False)
        return done, output

    def simulated_log(self, scenario: str) -> str:
        """The first scans of a simulated drive."""
        made = self.folder / scenario
        subprocess.run([self.slammot, "simulate", scenario, "--output", str(made)], capture_output=True, check=True)
        lines = []
        scans = 0
        with open(made / (scenario + ".log"), encoding="utf-8") as log:
            for line in log:
                lines.append(line)
                scans += "LASER" in line[:11]
                if scans == SCANS:
                    break
        return "".join(lines)

    def compare(self, log_text: str, name: str):
        """Every form of bag against the log."""
        import carmen_to_bag

        log = self.folder / (name + ".log")
        log.write_text(log_text, encoding="utf-8")
        done, expected = self.run(log, name + "-carmen")
        self.check(done.returncode == 0, f"{name}: {done.stderr}")
        for form in carmen_to_bag.FORMS:
            for odometry in ("topic", "transforms"):
                bag = self.folder / f"{name}-{form}-{odometry}{'.bag' if form.startswith('bag') else ''}"
                carmen_to_bag.write_bag(log_text, bag, form, odometry)
                done, results = self.run(bag, bag.name)
                self.check(done.returncode == 0, f"{bag.name}: exit code {done.returncode}, {done.stderr}")
                for result in RESULTS:
                    is_same = (results / result).exists() and (results / result).read_bytes() == (expected / result).read_bytes()
                    self.check(is_same, f"{bag.name}: {result} is not that of the CARMEN log")

    def damage(self, name: str):
        """Bags that are cut in the middle, and that have a few bytes changed: what is before is used, and one line says so."""
        for form, inside in (("bag-lz4", ""), ("mcap-chunks", "*.mcap"), ("db3", "*.db3")):
            path = self.folder / f"{name}-{form}-topic{'.bag' if form.startswith('bag') else ''}"
            path = next(path.glob(inside)) if inside else path
            whole = path.read_bytes()
            damaged = bytearray(whole)
            damaged[len(whole) // 2:len(whole) // 2 + 40] = bytes(40)
            for what, content in (("cut", whole[:len(whole) // 2]), ("damaged", bytes(damaged))):
                bag = self.folder / f"{what}-{path.name}"
                bag.write_bytes(content)
                done, results = self.run(bag, bag.name)
                self.check(done.returncode in (0, 1, LOG_IS_CUT), f"{bag.name}: exit code {done.returncode}")
                self.check(len(done.stderr.strip().splitlines()) <= 1, f"{bag.name} says more than one line: {done.stderr}")
                self.check(done.returncode == 0 or "cut off or damaged" in done.stderr, f"{bag.name}: {done.stderr}")
                if done.returncode != 1:
                    self.check((results / "trajectory.tum").exists(), f"{bag.name}: no results")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--slammot", required=True, help="the program")
    parser.add_argument("--venv", required=True, type=pathlib.Path, help="folder in which rosbags is installed")
    arguments = parser.parse_args()
    enter_environment(arguments.venv)
    with tempfile.TemporaryDirectory() as folder:
        test = Test(arguments.slammot, pathlib.Path(folder))
        for scenario in ("block", "office"):
            test.compare(test.simulated_log(scenario), scenario)
        test.damage("block")
        for fault in test.faults:
            print("FAULT:", fault)
        print(f"{len(test.faults)} faults")
        return 1 if test.faults else 0


if __name__ == "__main__":
    sys.exit(main())
