#!/usr/bin/env python3
"""How well the boxes of vehicles fit: runs a scenario on many seeds, pools the rows of `slammot eval --boxes` (docs/evaluation.md, boxes of
vehicles) and prints a table: all rows, by class, by distance, by the share of the outline seen.

    tests/tools/extent_table.py                                   # city_varied, seeds 401 to 408
    tests/tools/extent_table.py --scenario city --seeds 1-5,8 --config 'tracking { ... }'
    tests/tools/extent_table.py --write                           # puts the table into docs/results.md
    tests/tools/extent_table.py --worst 12                        # also the objects with the most rows in the lowest tenth of IoU
    tests/tools/extent_table.py --read                            # of the rows that earlier runs left in OUTPUT

The rows stay in OUTPUT/SCENARIO-SEED/vehicle_boxes.csv. Exit code: 0 all runs ended, 1 one did not, 2 the program is missing.
"""

import argparse
import collections
import concurrent.futures
import csv
import math
import pathlib
import sys

from tables import evaluated_run, replaced_between, seeds_in

ROOT = pathlib.Path(__file__).resolve().parents[2]
BEGIN = "<!-- extents: written by tests/tools/extent_table.py --write -->"
END = "<!-- end of extents -->"
KEPT = ("vehicle_boxes.csv", "evaluation.json", "settings.textproto")
TEXTS = ("class", "object", "track")
DISTANCES_M = (0, 10, 20, 30, 40, 50)
OUTLINE_SHARES = (0.0, 0.2, 0.4, 0.6, 1.01)
WANTED = ["wanted", "", ">= .95", ">= .85", "<= 0.50", "<= 2.0", "<= 0.30"]


def rows_in(path, seed):
    """The rows of one run, numbers as numbers."""
    with open(path, newline="") as lines:
        return [{"seed": seed, **{name: text if name in TEXTS else float(text) for name, text in row.items()}} for row in csv.DictReader(lines)]


def evaluated(seed, options):
    """The rows of one run; None if it fails, with the reason on stderr."""
    folder = pathlib.Path(options.output) / f"{options.scenario}-{seed}"
    if not options.read:
        folder = evaluated_run(options, options.scenario, seed, kept=None if options.keep else KEPT, run=["--no-report"], evaluate=["--boxes"])
    return rows_in(folder / "vehicle_boxes.csv", seed) if folder else None


def quantile(values, part):
    """Linear between neighbours."""
    ascending = sorted(values)
    at = part * (len(ascending) - 1)
    low = int(at)
    high = min(low + 1, len(ascending) - 1)
    return ascending[low] + (at - low) * (ascending[high] - ascending[low])


def line(name, rows):
    iou = [row["iou"] for row in rows]
    centre_m = [math.hypot(row["ahead_m"], row["left_m"]) for row in rows]
    heading_deg = [math.degrees(abs(row["turned_rad"])) for row in rows]
    velocity_mps = math.sqrt(sum(row["velocity_error_mps"] ** 2 for row in rows) / len(rows))
    return [name, str(len(rows)), f"{quantile(iou, 0.5):.3f}", f"{quantile(iou, 0.1):.3f}", f"{quantile(centre_m, 0.95):.2f}",
            f"{quantile(heading_deg, 0.95):.1f}", f"{velocity_mps:.2f}"]


def lines_by(rows, key, bounds, form):
    for low, high in zip(bounds, bounds[1:]):
        inside = [row for row in rows if low <= row[key] < high]
        if inside:
            yield line(form(low, min(high, 1.0) if high == OUTLINE_SHARES[-1] else high), inside)


def table(rows):
    lines = [line("all", rows), WANTED]
    lines += [line(name, [row for row in rows if row["class"] == name]) for name in sorted({row["class"] for row in rows})]
    lines += lines_by(rows, "distance_m", DISTANCES_M, lambda low, high: f"{low} to {high} m away")
    lines += lines_by(rows, "outline_seen", OUTLINE_SHARES, lambda low, high: f"outline seen {100 * low:.0f} to {100 * high:.0f} %")
    titles = ["vehicles", "rows", "IoU median", "lowest tenth", "centre, 95 % (m)", "heading, 95 % (deg)", "velocity RMSE (m/s)"]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [titles, ["---"] * len(titles), *lines])


def worst(rows, most):
    """The objects with the most rows in the lowest tenth of IoU."""
    limit = quantile([row["iou"] for row in rows], 0.1)
    counts = collections.defaultdict(list)
    for row in rows:
        if row["iou"] < limit:
            counts[row["seed"], row["object"], row["track"]].append(row)
    mean = lambda of, key: sum(row[key] for row in of) / len(of)
    for (seed, item, track), bad in sorted(counts.items(), key=lambda pair: -len(pair[1]))[:most]:
        yield (f"seed {seed} object {item} track {track} {bad[0]['class']}: {len(bad)} rows from {bad[0]['stamp_s']:.1f} to {bad[-1]['stamp_s']:.1f} s, "
               f"{mean(bad, 'distance_m'):.0f} m away, seen {mean(bad, 'outline_seen'):.2f}, {mean(bad, 'points'):.0f} echoes, IoU {mean(bad, 'iou'):.2f}, "
               f"{bad[0]['true_length_m']:.1f} x {bad[0]['true_width_m']:.1f} m as {mean(bad, 'length_m'):.1f} x {mean(bad, 'width_m'):.1f} m, "
               f"off {mean(bad, 'ahead_m'):.2f} ahead {mean(bad, 'left_m'):.2f} left {math.degrees(mean(bad, 'turned_rad')):.1f} deg, "
               f"velocity {mean(bad, 'velocity_error_mps'):.2f} m/s")


def options_of(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default=str(ROOT / "build/release/bin/slammot"))
    parser.add_argument("--scenario", default="city_varied")
    parser.add_argument("--seeds", type=seeds_in, default=seeds_in("401-408"), metavar="401-408,412")
    parser.add_argument("--config", default="", metavar="TEXT", help="settings as in a file for --config [the defaults]")
    parser.add_argument("--output", default=str(ROOT / "out/extent"), metavar="DIR")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--worst", type=int, default=0, metavar="N", help="also print the N objects with the most bad rows")
    parser.add_argument("--read", action="store_true", help="run nothing, read the rows in OUTPUT")
    parser.add_argument("--keep", action="store_true", help="keep all files of the runs")
    parser.add_argument("--write", action="store_true", help="put the table into docs/results.md")
    return parser.parse_args(arguments)


def main(arguments):
    options = options_of(arguments)
    if not options.read and not pathlib.Path(options.binary).exists():
        print(f"extent_table: {options.binary} is missing", file=sys.stderr)
        return 2
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(lambda seed: evaluated(seed, options), options.seeds))
    rows = [row for result in results if result for row in result]
    if not rows:
        print("extent_table: no row of a vehicle", file=sys.stderr)
        return 1
    text = table(rows)
    print(text)
    for described in worst(rows, options.worst):
        print(described)
    if options.write:
        page = ROOT / "docs/results.md"
        page.write_text(replaced_between(BEGIN, END, page.read_text(), text))
    return 1 if None in results else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
