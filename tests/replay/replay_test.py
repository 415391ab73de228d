#!/usr/bin/env python3
"""Takes a shipped scenario through the pipeline, judges it with slammot eval, and compares with what it was worth before.

usage: replay_test.py SLAMMOT SCENARIO           the test: nothing is worse than golden.json says by more than its tolerance
       replay_test.py SLAMMOT SCENARIO --update  writes the scenario's figures of today into golden.json
"""

import json
import pathlib
import subprocess
import sys
import tempfile

GOLDEN = pathlib.Path(__file__).with_name("golden.json")

# Where the figure is in evaluation.json, whether more is better, and how much worse it may be: absolute, and relative to the golden one.
FIGURES = {
    "ate_m": (("trajectory", "ate_m", "rmse"), False, 0.03, 0.25),
    "online_ate_m": (("online_trajectory", "ate_m", "rmse"), False, 0.03, 0.25),
    "drift_over_10_m_m": (("online_trajectory", "over", "10_m", "drift_m", "rmse"), False, 0.01, 0.25),
    "hota": (("tracking", "hota", "hota"), True, 0.05, 0.0),
    "mota": (("tracking", "clear_mot", "mota"), True, 0.10, 0.0),
    "recall": (("tracking", "clear_mot", "recall"), True, 0.07, 0.0),
    "precision": (("tracking", "clear_mot", "precision"), True, 0.06, 0.0),
    "idf1": (("tracking", "identity", "f1"), True, 0.07, 0.0),
    "map_precision": (("map", "precision"), True, 0.03, 0.0),
    "map_recall": (("map", "recall"), True, 0.05, 0.0),
}


def figure(evaluation, path):
    for name in path:
        evaluation = evaluation.get(name) if isinstance(evaluation, dict) else None
    return evaluation


def evaluate(slammot, scenario):
    """Figures by name; one that the scenario does not have (nobody else moves, a short way) is left out."""
    with tempfile.TemporaryDirectory(prefix="slammot-replay-") as folder:
        subprocess.run([slammot, "run", "--scenario", scenario, "--output", folder], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([slammot, "eval", "--result", folder, "--truth", f"{folder}/truth"], check=True, stdout=subprocess.DEVNULL)
        evaluation = json.loads((pathlib.Path(folder) / "evaluation.json").read_text())
    figures = {name: figure(evaluation, path) for name, (path, *_) in FIGURES.items()}
    return {name: round(value, 4) for name, value in figures.items() if value is not None}


def worse(name, golden, now):
    """By how much the figure is worse than its tolerance allows; negative: it is not."""
    _, more_is_better, absolute, relative = FIGURES[name]
    loss = golden - now if more_is_better else now - golden
    return loss - max(absolute, relative * abs(golden))


def compare(golden, now):
    faults = sorted(set(golden) ^ set(now))
    for name in golden:
        excess = worse(name, golden[name], now.get(name, golden[name]))
        print(f"{name:20} {golden[name]:9.4f} -> {now.get(name, float('nan')):9.4f}" + ("  worse than its tolerance" if excess > 0 else ""))
        if excess > 0:
            faults.append(name)
    return faults


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
    faults = compare(golden[scenario], now)
    print(f"{scenario}: " + (f"worse, or missing: {', '.join(faults)}" if faults else "as good as it was"))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
