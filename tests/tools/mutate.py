#!/usr/bin/env python3
"""Breaks the code in small ways and sees whether the tests notice: a mutant that passes them all shows what they do not check.

Draws mutants (mutants.py) of the parts asked for, and for each builds the unit tests that cover the part and runs them. All of it happens
in a copy of the tree, WORK/tree, with a build folder of its own; the checkout is only read. Each verdict is appended to WORK/results.jsonl
at once: the same command goes on after an interruption, and takes up the mutants that are new or whose lines changed. The same seed draws
the same mutants, and more of them with a larger --count.

  tests/tools/mutate.py                                     two mutants of each part
  tests/tools/mutate.py --part detection --count 10         ten of one part
  tests/tools/mutate.py --again survived                    those that survived once more, after tests were added
  tests/tools/mutate.py --replay car_ahead --count 5        a scenario too, for those that the unit tests let pass
  tests/tools/mutate.py --list --count 5 | --report         what would be tried; what was found
"""

import argparse
import collections
import contextlib
import dataclasses
import fcntl
import fnmatch
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import mutants

ROOT = pathlib.Path(__file__).resolve().parents[2]
LEAST_LIMIT_S = 30.0
BUILD_LIMIT_S = 1800.0


@dataclasses.dataclass(frozen=True)
class Part:
    name: str
    folder: str
    tests: tuple  # unit test programs, the likeliest to notice first


PARTS = (
    Part("detection", "services/detection", ("unit_detection",)),
    Part("tracking", "services/tracking", ("unit_tracking",)),
    Part("localization", "services/localization", ("unit_localization",)),
    Part("loop_closing", "services/loop_closing", ("unit_loop_closing",)),
    Part("matching", "common/matching", ("unit_matching", "unit_localization")),
    Part("filters", "common/filters", ("unit_filters", "unit_tracking")),
    Part("association", "common/association", ("unit_association",)),
)

# Tables of settings, and shells that have tests on the bus.
LEFT_OUT = ("*_fields.cpp", "*_fields.hpp", "*_service.cpp", "*_service.hpp", "*/main.cpp")

CAUGHT, SURVIVED, NO_CODE = "caught", "survived", "does not compile"


def sources_of(part, root):
    """{path: text} of the part's files that are mutated."""
    files = sorted(path for path in (root / part.folder).rglob("*") if path.suffix in (".cpp", ".hpp"))
    names = {path.relative_to(root).as_posix(): path for path in files}
    return {name: path.read_text() for name, path in names.items() if not any(fnmatch.fnmatch(name, left_out) for left_out in LEFT_OUT)}


def drawn(parts, root, count, seed, pattern="*", only=("*",)):
    """[(part, mutant)]: `count` of each part, of the files like `pattern`, the parts in turns; of these, those with ids like one of `only`."""
    piles = []
    for part in parts:
        files = {path: text for path, text in sources_of(part, root).items() if fnmatch.fnmatch(path, pattern)}
        piles.append([(part, mutant) for mutant in mutants.drawn(files, f"{seed} {part.name}")[:count]])
    return [(part, mutant) for part, mutant in mutants.in_turns(piles) if any(fnmatch.fnmatch(mutant.id, one) for one in only)]


class Results:
    """Verdicts by the id of the mutant, kept in a file to which each is appended; the last one counts."""

    def __init__(self, path):
        self.path = path
        self.rows = {}
        if path.exists():
            for line in path.read_text().splitlines():
                try:
                    row = json.loads(line)
                except ValueError:
                    continue  # cut off when the run was interrupted
                self.rows[row["id"]] = row

    def add(self, row):
        self.path.parent.mkdir(parents=True, exist_ok=True)
        is_cut_off = self.path.exists() and not self.path.read_bytes().endswith(b"\n")
        with self.path.open("a") as file:
            file.write(("\n" if is_cut_off else "") + json.dumps(row) + "\n")
        self.rows[row["id"]] = row


@contextlib.contextmanager
def alone_in(folder):
    """Two runs would build each other's mutants."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise RuntimeError(f"another run is at work in {folder}") from None
        yield


def copy_tree(root, tree):
    """Makes `tree` what git knows of `root` as it is now. Files that are the same keep their times: they are not built again."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=root, check=True, capture_output=True).stdout
    names = {name for name in listed.decode().split("\0") if name and (root / name).is_file()}
    for name in names:
        source, target = root / name, tree / name
        if target.is_file() and target.read_bytes() == source.read_bytes():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        target.unlink(missing_ok=True)
        shutil.copyfile(source, target)
        target.chmod(source.stat().st_mode)
    for folder in ("build", "out"):
        (tree / folder).mkdir(parents=True, exist_ok=True)
    kept = {tree / name for name in names}
    for path in [path for path in tree.rglob("*") if path.is_file() and path.relative_to(tree).parts[0] not in ("build", "out")]:
        if path not in kept:
            path.unlink()


def run_limited(command, limit_s, **options):
    """(exit code, output); the code is None where the limit ended the command and what it had started."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", start_new_session=True, **options)
    try:
        output, _ = process.communicate(timeout=limit_s)
        return process.returncode, output
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        output, _ = process.communicate()
        return None, output
    except BaseException:
        os.killpg(process.pid, signal.SIGKILL)
        raise


def failure_of(code, output):
    """What noticed, in a few words; None where the tests passed."""
    if code == 0:
        return None
    if code is None:
        return "time limit"
    failed = re.search(r"^\[  FAILED  \] ([\w/.]+)", output, re.MULTILINE)
    if failed:
        return failed.group(1)
    return f"signal {-code}" if code < 0 else f"exit code {code}"


class Workshop:
    """The copy of the tree in which mutants are built and tested."""

    def __init__(self, tree, jobs, limit_factor=5.0):
        self.tree = tree
        self.jobs = jobs
        self.limit_factor = limit_factor
        self.usual_s = {}

    def shell(self, command, limit_s=BUILD_LIMIT_S):
        return run_limited(["bash", "-c", f"set -e; source deploy/common.sh; {command}"], limit_s, cwd=self.tree)

    def configure(self):
        code, output = self.shell("configure_preset release")
        if code != 0:
            raise RuntimeError(f"the copy does not configure:\n{output[-2000:]}")

    def build(self, target, keeps_objects):
        """Mutants are kept out of the compiler's cache, where what they are made of is found."""
        cache = "" if keeps_objects else "export CCACHE_READONLY=1; "
        return self.shell(f"{cache}ninja -C build/release -j{self.jobs} {target}")

    def run(self, test):
        limit_s = max(LEAST_LIMIT_S, self.limit_factor * self.usual_s.get(test, BUILD_LIMIT_S))
        return run_limited([str(self.tree / "build/release/bin" / test), "--gtest_fail_fast", "--gtest_brief=1"], limit_s, cwd=self.tree / "build/release")

    def replay(self, scenario, keeps_objects=False):
        """What noticed, in a few words; None where the scenario is as good as it was."""
        code, output = self.build("slammot", keeps_objects)
        if code != 0:
            return f"exit code {code} of the build"
        command = [sys.executable, "tests/replay/replay_test.py", "build/release/bin/slammot", scenario]
        code, _ = run_limited(command, 600.0, cwd=self.tree)
        return None if code == 0 else f"replay of {scenario}" + ("" if code else ", time limit")

    def prepare(self, tests, scenarios=()):
        """Builds and runs the tests as they are: what fails without a fault cannot tell of one."""
        for test in tests:
            code, output = self.build(test, keeps_objects=True)
            if code != 0:
                raise RuntimeError(f"{test} does not build:\n{output[-2000:]}")
            begin = time.monotonic()
            fault = failure_of(*self.run(test))
            self.usual_s[test] = time.monotonic() - begin
            if fault:
                raise RuntimeError(f"{test} fails without a mutant: {fault}")
        for scenario in scenarios:
            fault = self.replay(scenario, keeps_objects=True)
            if fault:
                raise RuntimeError(f"{fault} fails without a mutant")

    def verdict(self, mutant, tests, scenarios=()):
        """(verdict, what noticed). The file is as it was afterwards, and newer than what was built of the mutant."""
        path = self.tree / mutant.path
        original = path.read_text()
        path.write_text(mutant.applied(original))
        try:
            for test in tests:
                code, output = self.build(test, keeps_objects=False)
                if code != 0:
                    return NO_CODE, next((line for line in output.splitlines() if "error" in line), "build time limit" if code is None else "")[:200]
                noticed = failure_of(*self.run(test))
                if noticed:
                    return CAUGHT, f"{test}: {noticed}"
            for scenario in scenarios:
                noticed = self.replay(scenario)
                if noticed:
                    return CAUGHT, noticed
            return SURVIVED, ""
        finally:
            path.write_text(original)


def tried(draws, results, workshop, scenarios, again, say=print):
    """Gives a verdict on each mutant that has none yet, or has one of `again`."""
    for part, mutant in draws:
        known = results.rows.get(mutant.id)
        if known and known["verdict"] not in again:
            continue
        begin = time.monotonic()
        verdict, noticed = workshop.verdict(mutant, part.tests, scenarios)
        results.add({"id": mutant.id, "part": part.name, "path": mutant.path, "line": mutant.line, "operator": mutant.operator,
                     "was": mutant.whole_line.strip(), "is": mutant.mutated_line().strip(), "verdict": verdict, "noticed": noticed,
                     "took_s": round(time.monotonic() - begin, 1)})
        say(f"{verdict:16} {mutant.path}:{mutant.line} {mutant.operator} {noticed}", flush=True)


def table(rows):
    """Verdicts by part; the share is of those that compile."""
    counts = collections.defaultdict(collections.Counter)
    for row in rows:
        counts[row["part"]][row["verdict"]] += 1
        counts["all"][row["verdict"]] += 1
    order = [part.name for part in PARTS if part.name in counts] + ["all"] * ("all" in counts)
    lines = [f"{'part':14}{'caught':>8}{'survived':>10}{'no code':>9}{'caught of those that compile':>30}"]
    for name in order:
        caught, survived, no_code = (counts[name][verdict] for verdict in (CAUGHT, SURVIVED, NO_CODE))
        share = f"{100.0 * caught / (caught + survived):.0f} %" if caught + survived else "-"
        lines.append(f"{name:14}{caught:8}{survived:10}{no_code:9}{share:>30}")
    return "\n".join(lines)


def survivors(rows):
    return "\n".join(f"{row['path']}:{row['line']} {row['operator']}\n  - {row['was']}\n  + {row['is']}" for row in rows if row["verdict"] == SURVIVED)


def report(draws, results):
    rows = [results.rows[mutant.id] for _, mutant in draws if mutant.id in results.rows]
    left = survivors(rows)
    print(table(rows) + (f"\n\nsurvivors\n{left}" if left else ""))


def parse_options(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--part", action="append", choices=[part.name for part in PARTS], help="all when none is given")
    parser.add_argument("--file", metavar="PATTERN", default="*", help="only files like this, e.g. '*/imm.cpp'")
    parser.add_argument("--only", metavar="PATTERN", action="append", help="of those drawn, the ones with an id like this (file:line:column:operator:...)")
    parser.add_argument("--count", type=int, default=2, help="mutants of each part")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="of the compiler")
    parser.add_argument("--replay", action="append", default=[], metavar="SCENARIO", help="also run this scenario's replay test")
    parser.add_argument("--again", action="append", default=[], choices=(CAUGHT, SURVIVED, NO_CODE), help="try those with this verdict again")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "out/mutation", help="folder of the copy and of the results")
    parser.add_argument("--list", action="store_true", help="print the mutants and end")
    parser.add_argument("--report", action="store_true", help="print what is known of them and end")
    options = parser.parse_args(arguments)
    if options.count < 1 or options.jobs < 1:
        parser.error("--count and --jobs are 1 at least")
    return options


def main(arguments):
    options = parse_options(arguments)
    parts = [part for part in PARTS if not options.part or part.name in options.part]
    draws = drawn(parts, ROOT, options.count, options.seed, options.file, options.only or ("*",))
    if options.list:
        for part, mutant in draws:
            print(f"{part.name:13} {mutant.path}:{mutant.line} {mutant.operator}\n  - {mutant.whole_line.strip()}\n  + {mutant.mutated_line().strip()}")
        return 0
    results = Results(options.work / "results.jsonl")
    if not options.report:
        with alone_in(options.work):
            workshop = Workshop(options.work / "tree", options.jobs)
            copy_tree(ROOT, workshop.tree)
            workshop.configure()
            workshop.prepare(dict.fromkeys(test for part in parts for test in part.tests), options.replay)
            tried(draws, results, workshop, options.replay, options.again)
    report(draws, results)
    return 0


def interrupt(*_):
    raise KeyboardInterrupt


if __name__ == "__main__":
    for name in (signal.SIGINT, signal.SIGTERM):  # the first is ignored by what a shell started in the background
        signal.signal(name, interrupt)
    try:
        sys.exit(main(sys.argv[1:]))
    except (RuntimeError, subprocess.CalledProcessError) as fault:
        sys.exit(str(fault))
    except KeyboardInterrupt:
        sys.exit("interrupted; the same command goes on")
