"""What commands share that write tables of results into a page."""

import pathlib
import re
import shutil
import subprocess
import sys


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
