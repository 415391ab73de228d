#!/usr/bin/env python3
"""Random services of a `slammot bench` are killed (-9) while it drives, and restarted by it: nothing may be lost."""

import json
import os
import pathlib
import random
import subprocess
import tempfile
import time
import types

import chaos
import drives
import timeline as lines

SERVICES = ["ingest", "localization", "detection", "tracking", "loop-closing", "map-store"]
SHORT_S, FULL_S = 60, 600
KILLS_PER_S = 1 / 3.0  # 200 in 10 minutes
LEAST_HOTA_SHARE, MOST_ATE_SHARE, KEPT = 0.98, 1.10, 0.95
FIRST_KILL_S = 6.0  # afterwards there are tracks


def children_of(process):
    """Names by process number, from /proc."""
    found = {}
    for status in pathlib.Path("/proc").glob("[0-9]*/status"):
        try:
            fields = dict(line.split(":\t", 1) for line in status.read_text(encoding="utf-8").splitlines() if ":\t" in line)
            if int(fields["PPid"]) == process:
                found[int(fields["Pid"])] = (status.parent / "cmdline").read_text(encoding="utf-8").split("\0")[0].rsplit("/", 1)[-1]
        except (OSError, KeyError):
            pass  # it has just ended
    return found


def kill_at_random(bench, rng, count):
    """Kills count services at random times, each service as often as the others, in random order; ends with the bench. Names of the killed and
    times [ns]."""
    killed, due = [], []
    time.sleep(FIRST_KILL_S)
    while len(killed) < count and bench.poll() is None:
        time.sleep(rng.expovariate(KILLS_PER_S))
        alive = {pid: name for pid, name in children_of(bench.pid).items() if name.startswith("slammot-")}
        if not alive or bench.poll() is not None:
            continue
        due = due or rng.sample(SERVICES, len(SERVICES))
        name = f"slammot-{due.pop()}"
        pid = next((pid for pid, other in alive.items() if other == name), None)
        if pid is None:
            continue  # it is being restarted
        try:
            subprocess.run(["kill", "-9", str(pid)], check=True, stderr=subprocess.DEVNULL)
        except subprocess.CalledProcessError:
            continue  # it has just ended
        killed.append((alive[pid].removeprefix("slammot-"), time.time_ns()))
    return killed


def evaluation(options, folder, truth):
    subprocess.run([options.bin / "slammot", "eval", "--result", folder, "--truth", truth], stdout=subprocess.DEVNULL, check=True)
    return json.loads((folder / "evaluation.json").read_text(encoding="utf-8"))


def figures_of(options, folder, truth):
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    figures = evaluation(options, folder, truth)
    return {"hota": figures["tracking"]["hota"]["hota"], "idf1": figures["tracking"]["identity"]["f1"],
            "ate_m": figures["trajectory"]["ate_m"]["rmse"],
            "submaps": report["counters"]["localization"]["submaps"],
            "scans": len((folder / "online.tum").read_text(encoding="utf-8").splitlines())}


def watch_of(options, bench):
    """What consumers of the bench get, on its closed bus."""
    environment = dict(os.environ, CYCLONEDDS_URI=chaos.BUS.format(f"slammot-bench-{bench.pid}"))
    return lines.Timeline(options, types.SimpleNamespace(domain=options.domain, environment=environment), vehicle="bench")


def kept_ids(folder, watch, killed):
    """By tracks.csv of both runs; a kill is at the newest scan that was localized then."""
    poses = list(watch.lines["pose"])
    stamps = [max((stamp for received, stamp, _ in poses if received <= at_ns), default=0) // 1000 for _, at_ns in killed]
    return lines.ids_kept(lines.read_tracks(folder / "run/tracks.csv"), lines.read_tracks(folder / "killed/tracks.csv"), stamps)


def cases(options):
    seconds = FULL_S if options.full else SHORT_S
    with tempfile.TemporaryDirectory(prefix="slammot-chaos-") as name:
        folder = pathlib.Path(name)
        slammot = options.bin / "slammot"
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "check": True}
        subprocess.run([slammot, "simulate", drives.scenario_of(folder, "demo", seconds), "--output", folder], **quiet)
        log, truth = folder / "drive.log", folder / "drive"
        subprocess.run([slammot, "run", "--input", log, "--output", folder / "run", "--profile", "urban"], **quiet)
        bench = subprocess.Popen([slammot, "bench", "--input", log, "--output", folder / "killed", "--profile", "urban", "--speed", "1",
                                  "--domain", str(options.domain)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        watch = watch_of(options, bench)
        count = int(KILLS_PER_S * seconds)
        killed = kill_at_random(bench, random.Random(7), count)
        words, _ = bench.communicate(timeout=seconds + 240)
        watch.end()
        if bench.returncode != 0:
            yield chaos.row(f"{len(killed)} random kills (-9) in {seconds} s", "run completes", f"ended with {bench.returncode}: {words[-300:]}", False)
            return
        undisturbed, disturbed = figures_of(options, folder / "run", truth), figures_of(options, folder / "killed", truth)
        kept, total = kept_ids(folder, watch, killed)
    names = ", ".join(f"{sum(name == one for name, _ in killed)} {one}" for one in SERVICES)
    figure = f"completes; {disturbed['scans']} of {undisturbed['scans']} scans, {disturbed['submaps']} of {undisturbed['submaps']} submaps; " \
             f"ATE {disturbed['ate_m']:.3f} m (undisturbed {undisturbed['ate_m']:.3f}); HOTA {disturbed['hota']:.3f} ({undisturbed['hota']:.3f}), " \
             f"IDF1 {disturbed['idf1']:.3f} ({undisturbed['idf1']:.3f}); ids alive through a kill: {kept} of {total} kept; {names} ({chaos.load()})"
    was_disturbed = len(killed) >= 0.5 * count
    passed = was_disturbed and disturbed["ate_m"] <= MOST_ATE_SHARE * undisturbed["ate_m"] and disturbed["hota"] >= LEAST_HOTA_SHARE * undisturbed["hota"] and \
        disturbed["submaps"] >= undisturbed["submaps"] and kept >= KEPT * total
    yield chaos.row(f"{len(killed)} random kills (-9) in {seconds} s of driving",
                    "run completes, ATE within 10 %, no submap lost, ids kept 95 %, HOTA 98 % of undisturbed", figure, passed,
                    sound=was_disturbed and disturbed["scans"] >= 0.95 * undisturbed["scans"] and disturbed["submaps"] >= undisturbed["submaps"],
                    undisturbed=undisturbed, disturbed=disturbed, kept=kept, total=total, killed=killed)


if __name__ == "__main__":
    chaos.main(cases)
