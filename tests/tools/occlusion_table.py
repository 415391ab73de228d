#!/usr/bin/env python3
"""How tracks pass through occlusions: runs scenarios in which objects are hidden on many seeds, sums the figures of `slammot eval`
(docs/evaluation.md, Occlusions) and prints a table, a row for each scenario.

    tests/tools/occlusion_table.py                                   # occluded_car, bus_stop, far_crossing, crowd, seeds 1 to 20
    tests/tools/occlusion_table.py --scenario crowd --seeds 1-5,8 --config 'tracking { formations: true }'
    tests/tools/occlusion_table.py --write                           # puts the table into docs/results.md

The evaluations stay in OUTPUT/SCENARIO-SEED/evaluation.json. Exit code: 0 all runs ended, 1 one did not, 2 the program is missing.
"""

import json
import math
import sys

from tables import evaluated_run, parser_of_scenarios, replaced_between, table_of_scenarios

SCENARIOS = ("occluded_car", "bus_stop", "far_crossing", "crowd")
WANTED = {"occluded_car": 0.95, "bus_stop": 0.90, "far_crossing": 0.90, "crowd": 0.75}  # share of identities kept up to 5 s
UP_TO_S = 5.0
RANGE_M = 100.0  # an object that was tracked before is near enough; crossing cars are hidden 57 m away
BEGIN = "<!-- occlusions: written by tests/tools/occlusion_table.py --write -->"
END = "<!-- end of occlusions -->"


def evaluated(scenario, seed, options):
    """The figures of one run; None if it fails, with the reason on stderr."""
    folder = evaluated_run(options, scenario, seed, kept=("evaluation.json", "settings.textproto"), evaluate=["--range", RANGE_M])
    return json.loads((folder / "evaluation.json").read_text()) if folder else None


def summed(evaluations):
    """Figures of several runs in one: counts added, errors weighted with their samples."""
    parts = [figures["occlusion"] for figures in evaluations]
    bands = []
    for same in zip(*(part["by_length"] for part in parts)):
        counts = {name: sum(band[name] for band in same) for name in ("occlusions", "identity_kept", "hidden_rows", "covered_rows")}
        bands.append({"from_s": same[0]["from_s"], "to_s": same[0]["to_s"], **counts})
    nees = [part["position_nees"] for part in parts if part["position_nees"]]
    errors = [part["position_m"] for part in parts if part["position_m"]]
    samples, rows = sum(one["samples"] for one in nees), sum(one["count"] for one in errors)
    return {"bands": bands,
            "nees": sum(one["mean"] * one["samples"] for one in nees) / samples if samples else None,
            "samples": samples,
            "rmse_m": math.sqrt(sum(one["rmse"] ** 2 * one["count"] for one in errors) / rows) if rows else None,
            "inside": sum(part["inside_share"] * part["position_nees"]["samples"] for part in parts if part["position_nees"]) / samples
            if samples else None,
            "at": {name: sum(part["occluded_rows"][name] for part in parts) for name in ("at_own_object", "at_other_object", "at_nothing")},
            "gaps": {name: sum(part["published_gaps"][name] for part in parts) for name in ("gaps_on_object", "gaps_in_view")}}


def share(part, whole):
    return f"{100.0 * part / whole:.0f} %" if whole else "-"


def row(scenario, runs, figures):
    up_to_limit = [band for band in figures["bands"] if band["to_s"] <= UP_TO_S]
    kept, occlusions = (sum(band[name] for band in up_to_limit) for name in ("identity_kept", "occlusions"))
    covered, hidden = (sum(band[name] for band in up_to_limit) for name in ("covered_rows", "hidden_rows"))
    at = figures["at"]
    number = lambda value, form: "-" if value is None else f"{value:{form}}"
    return [f"`{scenario}`", str(runs), *(f"{band['identity_kept']} of {band['occlusions']}" for band in figures["bands"]),
            f"{share(kept, occlusions)}", share(WANTED[scenario], 1.0) if scenario in WANTED else "", share(covered, hidden),
            number(figures["rmse_m"], ".2f"), f"{number(figures['nees'], '.2f')} ({figures['samples']})", number(figures["inside"], ".2f"),
            f"{at['at_own_object']} / {at['at_other_object']} / {at['at_nothing']}", f"{figures['gaps']['gaps_on_object']} / {figures['gaps']['gaps_in_view']}"]


def table(results):
    """results: {scenario: evaluations}."""
    sums = {scenario: (len(evaluations), summed(evaluations)) for scenario, evaluations in results.items() if evaluations}
    lengths = [f"{band['from_s']:g}-{band['to_s']:g} s" for _, figures in sums.values() for band in figures["bands"]][:4]
    titles = ["scenario", "runs", *(f"identity kept, {length}" for length in lengths), f"kept up to {UP_TO_S:g} s", "wanted",
              "hidden rows covered", "RMSE hidden (m)", "NEES hidden (samples)", "inside 95 %", "occluded rows at own object / another / none",
              "gaps on one object / in view"]
    lines = ["| " + " | ".join(titles) + " |", "|" + "---|" * len(titles)]
    lines += ["| " + " | ".join(row(scenario, runs, figures)) + " |" for scenario, (runs, figures) in sums.items()]
    return "\n".join(lines)


def page_with(page, text):
    """The page with the text between its markers."""
    return replaced_between(BEGIN, END, page, text)


def main(arguments):
    parser = parser_of_scenarios(__doc__, SCENARIOS, seeds="1-20", output="out/occlusion")
    return table_of_scenarios(parser.parse_args(arguments), evaluated, table, page_with)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
