"""Runs drives with several settings of one program and compares the figures in pairs."""

import concurrent.futures
import dataclasses
import hashlib
import json
import math
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tools"))

from figures import at, difference

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Title, digits, path in evaluation.json, and whether more is better (None: neither).
FIGURES = (
    ("HOTA", 4, ("tracking", "hota", "hota"), True),
    ("IDF1", 4, ("tracking", "identity", "f1"), True),
    ("MOTA", 4, ("tracking", "clear_mot", "mota"), True),
    ("recall", 4, ("tracking", "clear_mot", "recall"), True),
    ("precision", 4, ("tracking", "clear_mot", "precision"), True),
    ("switches", 1, ("tracking", "clear_mot", "switches"), False),
    ("velocity RMSE (m/s)", 4, ("tracking", "all", "velocity_mps", "rmse"), False),
    ("other car: velocity RMSE (m/s)", 4, ("other_car", "velocity_mps", "rmse"), False),
    ("other car: scans", 0, ("other_car", "matched_scans"), True),
    ("other car: false a scan", 3, ("other_car", "false_moving_tracks_a_scan"), False),
    ("tracking, median (ms)", 4, ("median_ms",), False),
)


@dataclasses.dataclass(frozen=True)
class Drive:
    group: str        # figures are means over the drives of a group
    name: str
    inputs: tuple     # arguments of slammot run
    judge: tuple      # arguments of slammot eval after --result; None: the truth that the simulation writes
    settings: str = ""  # that the drive needs


def simulated(scenario, seed):
    return Drive(scenario, f"{scenario}-{seed}", ("--scenario", scenario, "--seed", str(seed)), None)


def recorded(data):
    """Recorded drives with objects in their truth."""
    legs = data / "leg_tracker" / "general_tracking_moving_1"
    known = [
        *(Drive(f"recorded {name}", f"recorded-{name}", ("--input", str(data / "city" / f"{name}.log.gz")), ("--truth", str(data / "city" / name)))
          for name in ("city", "quiet")),
        Drive("recorded leg_tracker", "recorded-leg_tracker", ("--input", str(legs)),
              ("--truth", str(legs), "--gate", "0.75", "--bearings", "-38.5", "53.5"), "ingest { fallback_laser_heading_rad: 0.725 }"),
        *(Drive(f"recorded {name}", f"recorded-{name}",
                ("--profile", "model_cars", "--input", str(data / "datmo_carmen" / f"{name}.log.gz")), ("--truth", str(data / "datmo_carmen" / name)))
          for name in ("overtakes", "parallel")),
    ]
    return [drive for drive in known if any(pathlib.Path(word).exists() for word in drive.inputs if "/" in word)]


def folder_of(options, name):
    """Of the finished runs with these settings; another program has others."""
    program = hashlib.sha1(pathlib.Path(options.binary).read_bytes()).hexdigest()[:8]
    return pathlib.Path(options.output) / program / name


def figures_of(drive, settings, runs_folder, binary):
    """Figures of one run, by title; kept in a file, so that an interrupted comparison goes on. None where it failed."""
    kept = runs_folder / f"{drive.name}.json"
    if kept.exists():
        return json.loads(kept.read_text())
    folder = runs_folder / drive.name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    config = folder / "settings-of-comparison.textproto"
    config.write_text(f"{drive.settings}\n{settings}\n")
    with open(folder / "output.txt", "w", encoding="utf-8") as log:
        def call(*arguments):
            return subprocess.run([str(binary), *map(str, arguments)], stdout=log, stderr=subprocess.STDOUT, check=False).returncode == 0
        judge = drive.judge or ("--truth", folder / "truth")
        if not call("run", *drive.inputs, "--config", config, "--output", folder) or not call("eval", "--result", folder, *judge):
            return None
    evaluation = json.loads((folder / "evaluation.json").read_text())
    report = json.loads((folder / "report.json").read_text())
    evaluation["median_ms"] = at(report, ("measured", "stage_latency", "tracking", "p50_ms"))
    figures = {title: at(evaluation, path) for title, _, path, _ in FIGURES}
    kept.write_text(json.dumps(figures))
    shutil.rmtree(folder)
    return figures


def pairs_of(runs, title):
    """(before, after) of the drives that have the figure in both."""
    values = [(a[title], b[title]) for a, b in runs if a and b and a.get(title) is not None and b.get(title) is not None]
    return [a for a, _ in values], [b for _, b in values]


def row(group, runs):
    cells = [group, str(sum(1 for a, b in runs if a and b))]
    for title, digits, _, _ in FIGURES:
        before, after = pairs_of(runs, title)
        if not before:
            cells.append("")
            continue
        change, error = difference(before, after)
        scatter = "" if math.isnan(error) else f" ± {error:.{digits}f}"
        cells.append(f"{statistics.mean(before):.{digits}f} / {statistics.mean(after):.{digits}f} ({change:+.{digits}f}{scatter})")
    return "| " + " | ".join(cells) + " |"


def table(runs_of_group):
    head = ["drives", "n", *(title for title, *_ in FIGURES)]
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head), *(row(group, runs) for group, runs in runs_of_group.items())])


def compare(drives, before, after, options):
    """Runs of each group: pairs of figures. before, after: (name, settings)."""
    sides = [(settings, folder_of(options, name)) for name, settings in (before, after)]
    end = time.monotonic() + options.minutes * 60.0 if options.minutes else math.inf

    def run(drive):
        if time.monotonic() > end:
            return None
        return tuple(figures_of(drive, settings, folder, options.binary) for settings, folder in sides)

    runs_of_group = {}
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for drive, pair in zip(drives, pool.map(run, drives)):
            if pair is None:
                continue
            runs_of_group.setdefault(drive.group, []).append(pair)
            if None in pair:
                print(f"FAILS: {drive.name}; see {options.output}", flush=True)
    return runs_of_group


def add_options(parser, seeds):
    parser.add_argument("--scenario", nargs="*", default=["city", "quiet", "block", "all_round", "surrounded", "office", "crowd"], help="[%(default)s]")
    parser.add_argument("--seeds", default=seeds, metavar="A-B", help="of each scenario [%(default)s]")
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path(os.environ.get("SLAMMOT_DATA") or ROOT.parent / "shared" / "data"),
                        help="recorded drives; skipped where absent [%(default)s]")
    parser.add_argument("--without-recorded", action="store_true")
    parser.add_argument("--minutes", type=float, help="begin no further drive after so many minutes; the next call goes on")
    parser.add_argument("--jobs", type=int, default=1, help="drives at a time [%(default)s]")
    parser.add_argument("--binary", type=pathlib.Path, default=ROOT / "build/release/bin/slammot")
    parser.add_argument("--output", default="out/ablation", help="finished runs are kept here and not run again [%(default)s]")


def drives_of(options):
    """Recorded ones first, then one seed of each scenario after the other, so that an interrupted comparison has some of all."""
    first, _, last = options.seeds.partition("-")
    seeds = range(int(first), int(last or first) + 1)
    return [*([] if options.without_recorded else recorded(options.data)), *(simulated(name, seed) for seed in seeds for name in options.scenario)]
