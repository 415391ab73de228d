#!/usr/bin/env python3
"""Drives with a vertical scanner over several seeds: accuracy of the 2.5-D model by the truth, a row each.

    tests/tools/model_table.py                       # vertical_scanner, seeds 5, 21 and 22
    tests/tools/model_table.py --seeds 1-10
    tests/tools/model_table.py --write               # puts the table into docs/results.md

Exit code: 0 done, 2 the program is missing.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

from tables import replaced_between, seeds_in

ROOT = pathlib.Path(__file__).resolve().parents[2]
BEGIN = "<!-- city model: written by tests/tools/model_table.py --write -->"
END = "<!-- end of city model -->"
TITLES = ["seed", "points", "distance to true surfaces, median / 95 % (m)", "beyond 1 m",
          "top of walls: facades, median error / 95 % / bias (m)", "echoes of movers left, share of the points"]


def figures_of(binary, scenario, seed):
    """What `slammot model` writes."""
    with tempfile.TemporaryDirectory(prefix="slammot-model-") as folder:
        result = pathlib.Path(folder) / str(seed)
        subprocess.run([binary, "run", "--scenario", scenario, "--seed", str(seed), "--output", result, "--quiet", "--no-report"], check=True)
        subprocess.run([binary, "model", "--result", result, "--truth", result / "truth"], check=True, stdout=subprocess.DEVNULL)
        return json.loads((result / "model.json").read_text())


def row(seed, figures):
    accuracy = figures["accuracy"]
    return [str(seed), f"{figures['points']:,}", f"{accuracy['point_distance_median_m']:.3f} / {accuracy['point_distance_p95_m']:.3f}",
            f"{100 * accuracy['astray_share']:.2f} %",
            f"{accuracy['wall_facades']}, {accuracy['wall_top_error_median_m']:.2f} / {accuracy['wall_top_error_p95_m']:.2f} / "
            f"{accuracy['wall_top_bias_m']:.2f}", f"{100 * accuracy['residue_share']:.3f} %"]


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default=str(ROOT / "build/release/bin/slammot"))
    parser.add_argument("--seeds", type=seeds_in, default=seeds_in("5,21-22"), metavar="5,21-22")
    parser.add_argument("--scenario", default="vertical_scanner")
    parser.add_argument("--write", action="store_true", help="put the table into docs/results.md")
    options = parser.parse_args(arguments)
    if not pathlib.Path(options.binary).exists():
        print(f"model_table: {options.binary} is missing", file=sys.stderr)
        return 2
    lines = [TITLES, ["---"] * len(TITLES)]
    lines += [row(seed, figures_of(options.binary, options.scenario, seed)) for seed in options.seeds]
    text = "\n".join("| " + " | ".join(cells) + " |" for cells in lines)
    print(text)
    if options.write:
        page = ROOT / "docs/results.md"
        page.write_text(replaced_between(BEGIN, END, page.read_text(), text))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
