#!/usr/bin/env python3
"""Takes a shipped scenario through the pipeline, judges it with slammot eval, and compares with what it was worth before.

usage: replay_test.py SLAMMOT SCENARIO           the test: nothing is worse than golden.json says by more than its tolerance,
                                                 and what wanted.json holds to be reached is reached
       replay_test.py SLAMMOT SCENARIO --update  writes the scenario's figures of today into golden.json

golden.json says how good it is, which may be bad; wanted.json says how good it should be. What is wanted and not reached is a known
failure: the test says so and passes. Once it is reached the test fails until wanted.json says so too, and from then on it holds it.
"""

import dataclasses
import json
import math
import pathlib
import subprocess
import sys
import tempfile

GOLDEN = pathlib.Path(__file__).with_name("golden.json")
WANTED = pathlib.Path(__file__).with_name("wanted.json")


@dataclasses.dataclass(frozen=True)
class Figure:
    """Where it is in evaluation.json and how much worse it may be: the larger of the two, the second as a share of the golden one.

    A run with the same program gives the same bytes, so that a tolerance is for what does not matter, not for chance.
    """
    path: tuple
    more_is_better: bool
    absolute: float
    relative: float
    of_objects: bool = False  # undefined where no object counts

    def loss(self, golden, now):
        return golden - now if self.more_is_better else now - golden

    def excess(self, golden, now):
        return self.loss(golden, now) - max(self.absolute, self.relative * abs(golden))


class Consistency(Figure):
    """A mean of squared errors normalized by the covariance and its degrees of freedom: 1 is right, half as bad as twice.

    From too unsure to too sure, or back, counts from 1 on.
    """

    def loss(self, golden, now):
        before, after = (math.log(max(value, 1e-9)) for value in (golden, now))
        return abs(after) - (abs(before) if before * after > 0 else 0.0)

    def excess(self, golden, now):
        return self.loss(golden, now) - self.absolute


def of_objects(*path, more_is_better=True, absolute=0.0, relative=0.0):
    return Figure(("tracking", *path), more_is_better, absolute, relative, of_objects=True)


FIGURES = {
    "ate_m": Figure(("trajectory", "ate_m", "rmse"), False, 0.002, 0.15),
    "online_ate_m": Figure(("online_trajectory", "ate_m", "rmse"), False, 0.002, 0.15),
    "drift_over_10_m_m": Figure(("online_trajectory", "over", "10_m", "drift_m", "rmse"), False, 0.001, 0.15),
    "drift_over_10_m_rad": Figure(("online_trajectory", "over", "10_m", "drift_rad", "rmse"), False, 0.0001, 0.15),
    "pose_nees_per_degree": Consistency(("relative_pose_nees",), False, 0.2, 0.0),
    "hota": of_objects("hota", "hota", absolute=0.02),
    "mota": of_objects("clear_mot", "mota", absolute=0.02),
    "recall": of_objects("clear_mot", "recall", absolute=0.02),
    "precision": of_objects("clear_mot", "precision", absolute=0.015),
    "idf1": of_objects("identity", "f1", absolute=0.025),
    "switches": of_objects("clear_mot", "switches", more_is_better=False, relative=0.15),
    "centre_m": of_objects("all", "centre_m", "rmse", more_is_better=False, absolute=0.01, relative=0.15),
    "velocity_mps": of_objects("all", "velocity_mps", "rmse", more_is_better=False, absolute=0.02, relative=0.15),
    "position_nees_per_degree": Consistency(("tracking", "all", "position_nees"), False, 0.25, 0.0, of_objects=True),
    # These are there where no object counts, too: the one thing that tracking can then do wrong.
    "false_rows": Figure(("tracking", "clear_mot", "false_positives"), False, 0.0, 0.3),
    "tracks": Figure(("tracking", "tracks"), False, 0.0, 0.1),
    "map_precision": Figure(("map", "precision"), True, 0.01, 0.0),
    "map_recall": Figure(("map", "recall"), True, 0.01, 0.0),
}
DIGITS = 5


def value_at(evaluation, path):
    for name in path:
        evaluation = evaluation.get(name) if isinstance(evaluation, dict) else None
    if isinstance(evaluation, dict):
        return evaluation["mean"] / evaluation["degrees_of_freedom"] if evaluation.get("samples") else None
    return evaluation


def figures_of(evaluation):
    """Figures by name; one that the scenario does not have (nobody else moves, a short way) is left out."""
    has_objects = (value_at(evaluation, ("tracking", "objects")) or 0) > 0
    figures = {name: value_at(evaluation, figure.path) for name, figure in FIGURES.items() if has_objects or not figure.of_objects}
    return {name: round(value, DIGITS) for name, value in figures.items() if value is not None}


def evaluate(slammot, scenario):
    with tempfile.TemporaryDirectory(prefix="slammot-replay-") as folder:
        subprocess.run([slammot, "run", "--scenario", scenario, "--output", folder], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([slammot, "eval", "--result", folder, "--truth", f"{folder}/truth"], check=True, stdout=subprocess.DEVNULL)
        return figures_of(json.loads((pathlib.Path(folder) / "evaluation.json").read_text()))


def compare(golden, now):
    """(lines to print, names of the figures that are worse than their tolerance allows, or that only one side has)."""
    lines, faults = [], sorted(set(golden) ^ set(now))
    for name in sorted(golden):
        is_worse = name in now and FIGURES[name].excess(golden[name], now[name]) > 0
        lines.append(f"{name:25} {golden[name]:10.4f} -> {now.get(name, math.nan):10.4f}" + ("  worse than its tolerance" if is_worse else ""))
        if is_worse:
            faults.append(name)
    return lines, faults


def compare_with_wanted(wanted, now):
    """(lines, faults) of {figure: {"at_most" or "at_least": value, "is_reached": bool, "why": text}}."""
    lines, faults = [], []
    for name, goal in sorted(wanted.items()):
        is_reached = name in now and (now[name] <= goal["at_most"] if "at_most" in goal else now[name] >= goal["at_least"])
        bound = " ".join(f"{word.replace('_', ' ')} {goal[word]}" for word in ("at_most", "at_least") if word in goal)
        said = f"{name}: wanted {bound}, is {now.get(name)}"
        if is_reached == goal["is_reached"]:
            lines.append(said + ("" if is_reached else f"; known failure: {goal['why']}"))
        else:
            lines.append(said + ("; no known failure any more: set is_reached in wanted.json" if is_reached else "; it was reached before"))
            faults.append(f"wanted {name}")
    return lines, faults


def main(arguments):
    slammot, scenario, *options = arguments[1:]
    golden = json.loads(GOLDEN.read_text()) if GOLDEN.exists() else {}
    now = evaluate(slammot, scenario)
    if "--update" in options:
        golden[scenario] = now
        GOLDEN.write_text(json.dumps(golden, indent=1, sort_keys=True) + "\n")
        return 0
    if scenario not in golden:
        print(f"{scenario} has no golden figures: replay_test.py SLAMMOT {scenario} --update writes them")
        return 1
    lines, faults = compare(golden[scenario], now)
    wanted_lines, wanted_faults = compare_with_wanted(json.loads(WANTED.read_text()).get(scenario, {}), now)
    faults += wanted_faults
    print("\n".join(lines + wanted_lines))
    print(f"{scenario}: " + (f"worse, or missing: {', '.join(faults)}" if faults else "as good as it was"))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
