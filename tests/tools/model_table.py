#!/usr/bin/env python3
"""Drives with a vertical scanner over several seeds: accuracy of the 2.5-D model by the truth, one row each.

usage: model_table.py SLAMMOT [--seeds FIRST-LAST] [--scenario NAME]
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

COLUMNS = ["point_distance_median_m", "point_distance_p95_m", "astray_share", "wall_top_error_median_m", "wall_top_error_p95_m",
           "wall_top_bias_m", "residue_share"]


def figures_of(slammot, scenario, seed, folder):
    result = folder / str(seed)
    subprocess.run([slammot, "run", "--scenario", scenario, "--seed", str(seed), "--output", result, "--quiet", "--no-report"], check=True)
    subprocess.run([slammot, "model", "--result", result, "--truth", result / "truth"], check=True, stdout=subprocess.DEVNULL)
    return json.loads((result / "model.json").read_text())


def row(name, values):
    texts = [f"{values[0]:.3f}", f"{values[1]:.3f}", f"{100 * values[2]:.2f} %", f"{values[3]:.2f}", f"{values[4]:.2f}", f"{values[5]:+.2f}",
             f"{100 * values[6]:.3f} %"]
    return f"| {name} | " + " | ".join(texts) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("slammot")
    parser.add_argument("--seeds", default="1-10")
    parser.add_argument("--scenario", default="vertical_scanner")
    options = parser.parse_args()
    first, last = map(int, options.seeds.split("-"))
    print("| seed | distance, median (m) | 95 % (m) | beyond 1 m | top of walls, median error (m) | 95 % (m) | bias (m) | echoes of movers |")
    print("|---|---|---|---|---|---|---|---|")
    rows = []
    for seed in range(first, last + 1):
        with tempfile.TemporaryDirectory(prefix="slammot-model-") as folder:
            accuracy = figures_of(options.slammot, options.scenario, seed, pathlib.Path(folder))["accuracy"]
        rows.append([accuracy[column] for column in COLUMNS])
        print(row(seed, rows[-1]), flush=True)
    print(row("median", [statistics.median(column) for column in zip(*rows)]))
    print(row("worst", [max(column, key=abs) for column in zip(*rows)]))


if __name__ == "__main__":
    main()
