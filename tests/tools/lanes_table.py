#!/usr/bin/env python3
"""Lanes, cycle lanes and walkways against the ways of true movers: runs scenarios on many seeds, sums the lengths of `slammot eval`
(docs/evaluation.md, Lanes and walkways) and prints a table, a row for each scenario and kind.

    tests/tools/lanes_table.py                                   # city, quiet, block, crowd, seeds 901 to 905
    tests/tools/lanes_table.py --scenario crowd --seeds 1-5,8
    tests/tools/lanes_table.py --write                           # puts the table into docs/results.md

The evaluations stay in OUTPUT/SCENARIO-SEED/evaluation.json; `--again` takes those that are there. Exit code: 0 all runs ended, 1 one did not,
2 the program is missing.
"""

import json
import pathlib
import sys

from tables import evaluated_run, parser_of_scenarios, replaced_between, table_of_scenarios

SCENARIOS = ("city", "quiet", "block", "crowd")
KINDS = {"lane": "lanes", "cycle_lane": "cycle lanes", "walkway": "walkways"}
BEGIN = "<!-- lanes: written by tests/tools/lanes_table.py --write -->"
END = "<!-- end of lanes -->"
LENGTHS = ("travelled_in_view_m", "found_m", "length_m", "true_m")


def evaluated(scenario, seed, options):
    """The figures of one run; None if it fails, with the reason on stderr."""
    folder = pathlib.Path(options.output) / f"{scenario}-{seed}"
    if not (options.again and (folder / "evaluation.json").exists()):
        folder = evaluated_run(options, scenario, seed, kept=("evaluation.json", "lanes.geojson"), run=("--quiet", "--no-report"))
    return json.loads((folder / "evaluation.json").read_text()) if folder else None


def summed(evaluations, part, kind):
    """Lengths of several runs added."""
    return {name: sum(figures["ways"][part][kind][name] for figures in evaluations) for name in LENGTHS}


def share(part, whole):
    return f"{100.0 * part / whole:.0f} %" if whole else "-"


def row(scenario, evaluations, kind):
    every, confident = (summed(evaluations, part, kind) for part in ("all", "confident"))
    recall = lambda sums: share(sums["found_m"], sums["travelled_in_view_m"])
    precision = lambda sums: share(sums["true_m"], sums["length_m"])
    a_run = lambda length_m: f"{length_m / len(evaluations):.0f}"
    return [f"`{scenario}`", str(len(evaluations)), KINDS[kind], a_run(every["travelled_in_view_m"]), a_run(every["length_m"]), recall(every),
            precision(every), a_run(confident["length_m"]), recall(confident), precision(confident)]


def table(results):
    """results: {scenario: evaluations}."""
    titles = ["scenario", "runs", "kind", "travelled in view (m)", "found (m)", "recall", "precision", "of confidence 0.6 (m)", "recall", "precision"]
    lines = ["| " + " | ".join(titles) + " |", "|" + "---|" * len(titles)]
    lines += ["| " + " | ".join(row(scenario, evaluations, kind)) + " |" for scenario, evaluations in results.items() if evaluations for kind in KINDS]
    return "\n".join(lines)


def page_with(page, text):
    """The page with the text between its markers."""
    return replaced_between(BEGIN, END, page, text)


def main(arguments):
    parser = parser_of_scenarios(__doc__, SCENARIOS, seeds="901-905", output="out/lanes")
    parser.add_argument("--again", action="store_true", help="take the evaluations that are there")
    return table_of_scenarios(parser.parse_args(arguments), evaluated, table, page_with)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
