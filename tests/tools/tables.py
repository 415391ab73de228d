"""What commands share that write tables of results into a page."""

import argparse
import concurrent.futures
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def seeds_in(text):
    """The numbers of "1-3,7"."""
    seeds = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        seeds.extend(range(int(first), int(last or first) + 1))
    return seeds


def replaced_between(begin, end, page, text):
    """The page with the text between these two lines."""
    if begin not in page or end not in page:
        raise SystemExit(f"the page lacks the lines {begin} and {end}")
    return re.sub(re.escape(begin) + r".*?" + re.escape(end), lambda _: f"{begin}\n{text}\n{end}", page, count=1, flags=re.DOTALL)


def evaluated_run(options, scenario, seed, kept, run=(), evaluate=()):
    """The folder OUTPUT/SCENARIO-SEED after `slammot run` and `slammot eval` with these arguments besides, with the kept files only (None: all);
    None if one of them fails, with the reason on stderr. options: binary, output, config (text of settings)."""
    folder = pathlib.Path(options.output) / f"{scenario}-{seed}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    run = [options.binary, "run", "--scenario", scenario, "--seed", seed, "--output", folder, *run]
    if options.config:
        (folder / "settings.textproto").write_text(options.config)
        run += ["--config", folder / "settings.textproto"]
    for command in (run, [options.binary, "eval", "--result", folder, "--truth", folder / "truth", *evaluate]):
        ended = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if ended.returncode != 0:
            print(f"{scenario}, seed {seed}: exit code {ended.returncode}: {ended.stderr.strip()}", file=sys.stderr)
            return None
    for path in folder.iterdir():
        if kept is not None and path.name not in kept:
            path.unlink()
    return folder


def parser_of_scenarios(about, scenarios, seeds, output):
    """Options of a command that runs these scenarios on these seeds, unless told otherwise."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default=str(ROOT / "build/release/bin/slammot"))
    parser.add_argument("--scenario", nargs="+", default=list(scenarios))
    parser.add_argument("--seeds", type=seeds_in, default=seeds_in(seeds), metavar=seeds)
    parser.add_argument("--config", default="", metavar="TEXT", help="settings as in a file for --config [the defaults]")
    parser.add_argument("--output", default=str(ROOT / output), metavar="DIR")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--write", action="store_true", help="put the table into docs/results.md")
    return parser


def table_of_scenarios(options, evaluated, table, page_with):
    """Prints table({scenario: figures of each run}), where evaluated(scenario, seed, options) gives the figures or None, and puts it into the
    page if wanted. Returns the exit code: 0 all runs ended, 1 one did not, 2 the program is missing."""
    if not pathlib.Path(options.binary).exists():
        print(f"{pathlib.Path(sys.argv[0]).stem}: {options.binary} is missing", file=sys.stderr)
        return 2
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        runs = {scenario: [pool.submit(evaluated, scenario, seed, options) for seed in options.seeds] for scenario in options.scenario}
        results = {scenario: [run.result() for run in of_scenario] for scenario, of_scenario in runs.items()}
    text = table({scenario: [figures for figures in all_figures if figures] for scenario, all_figures in results.items()})
    print(text)
    if options.write:
        page = ROOT / "docs/results.md"
        page.write_text(page_with(page.read_text(), text))
    return 1 if any(figures is None for all_figures in results.values() for figures in all_figures) else 0
