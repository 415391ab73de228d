#!/usr/bin/env python3
"""What an IMU is worth: simulates drives with one, alters their odometry (tests/tools/ways.py), runs each with the lines IMU and without
them, and prints the ATE of both, means over seeds.

    tests/tools/imu_table.py                     # city and office, seeds 1 to 3
    tests/tools/imu_table.py --scenario block --seeds 1-8 --ways turns-1.15 none
    tests/tools/imu_table.py --write             # puts the table into docs/results.md

Exit code: 0 done, 1 the mean over all drives is worse with the IMU, 2 the program is missing.
"""

import argparse
import json
import pathlib
import shutil
import statistics
import subprocess
import sys

from tables import replaced_between, seeds_in

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOOLS = ROOT / "tests/tools"
WAYS = ("as-driven", "turns-1.15", "turns-slipping", "turns-mirrored", "yaw-bias", "slip-6s", "none")
IMU = "imu { rate_hz: 100 }\n"
BEGIN = "<!-- imu: written by tests/tools/imu_table.py --write -->"
END = "<!-- end of imu -->"


def called(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True)


def simulated(scenario, seed, options):
    """Prefix of a drive with an IMU."""
    folder = options.output / f"{scenario}-{seed}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    text = (ROOT / f"deploy/scenarios/{scenario}.textproto").read_text()
    (folder / "drive.textproto").write_text(text + "\n" + IMU)
    called(options.binary, "simulate", folder / "drive.textproto", "--seed", seed, "--output", folder)
    return folder / "drive"


def altered(drive, way):
    """Prefix of the copy with altered odometry."""
    copy = drive.parent / way
    if way == "as-driven":
        for path in drive.parent.glob("drive.*"):
            if path.suffix != ".textproto":
                shutil.copy(path, copy.parent / (way + path.name.removeprefix("drive")))
    else:
        called(sys.executable, TOOLS / "alter_drive.py", drive, copy, "--way", way)
    return copy


def ate_m(copy, has_imu, options):
    log = copy.parent / f"{copy.name}.log"
    if not has_imu:
        lines = log.read_text().splitlines(keepends=True)
        log = copy.parent / f"{copy.name}-without.log"
        log.write_text("".join(line for line in lines if not line.startswith("IMU ")))
    output = copy.parent / f"{copy.name}-{'with' if has_imu else 'without'}"
    called(options.binary, "run", "--input", log, "--output", output, "--quiet", "--no-report")
    called(options.binary, "eval", "--result", output, "--truth", copy)
    found = json.loads((output / "evaluation.json").read_text())["trajectory"]["ate_m"]["rmse"]
    shutil.rmtree(output)
    return found


def table(options):
    """Rows of the table, and the mean ATE of all drives without and with the IMU."""
    rows = ["| drive | odometry | ATE without IMU (m) | ATE with IMU (m) |", "|---|---|---|---|"]
    everything = ([], [])
    for scenario in options.scenario:
        by_way = {way: ([], []) for way in options.ways}
        for seed in options.seeds:
            drive = simulated(scenario, seed, options)
            for way in options.ways:
                copy = altered(drive, way)
                for sums, has_imu in zip(by_way[way], (False, True)):
                    sums.append(ate_m(copy, has_imu, options))
                print(scenario, seed, way, *(f"{sums[-1]:.3f}" for sums in by_way[way]), file=sys.stderr, flush=True)
            shutil.rmtree(drive.parent)
        for way, sums in by_way.items():
            rows.append(f"| `{scenario}` | {way} | {statistics.fmean(sums[0]):.3f} | {statistics.fmean(sums[1]):.3f} |")
            for whole, part in zip(everything, sums):
                whole.extend(part)
    means = tuple(statistics.fmean(whole) for whole in everything)
    rows.append(f"| all | | {means[0]:.3f} | {means[1]:.3f} |")
    return rows, means


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenario", nargs="*", default=["city", "office"])
    parser.add_argument("--seeds", type=seeds_in, default=seeds_in("1-3"), metavar="1-3,7")
    parser.add_argument("--ways", nargs="*", default=WAYS)
    parser.add_argument("--write", action="store_true", help="into docs/results.md")
    parser.add_argument("--binary", type=pathlib.Path, default=ROOT / "build/release/bin/slammot")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "out/imu")
    options = parser.parse_args()
    if not options.binary.exists():
        print(f"imu_table: {options.binary} is missing", file=sys.stderr)
        return 2
    rows, (without, with_imu) = table(options)
    print("\n".join(rows))
    if options.write:
        page = ROOT / "docs/results.md"
        page.write_text(replaced_between(BEGIN, END, page.read_text(), "\n".join(rows)))
    return 0 if with_imu <= without else 1


if __name__ == "__main__":
    sys.exit(main())
