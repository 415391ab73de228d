#!/usr/bin/env python3
"""Three scanners on one vehicle over the services: fused as in one process, and one that falls silent half-way."""

import filecmp
import json
import subprocess

import chaos

SCANNERS = ["ROBOTLASER1", "ROBOTLASER2", "ROBOTLASER3"]
RESULTS = ["trajectory.tum", "online.tum", "tracks.csv"]
MOST_WORSE = 1.5


def take(services, command, drive, name, *arguments):
    output = services.folder / name
    services.slammot(command, "--input", drive, "--profile", "urban", "--output", output, "--no-report", "--quiet", *arguments)
    services.slammot("eval", "--result", output, "--truth", drive.parent / "three_scanners", stdout=subprocess.DEVNULL)
    evaluation = json.loads((output / "evaluation.json").read_text(encoding="utf-8"))
    counters = json.loads((output / "report.json").read_text(encoding="utf-8"))["counters"]["localization"]
    return {"ate_m": evaluation["trajectory"]["ate_m"]["rmse"], "hota": evaluation["tracking"]["hota"]["hota"], "astray": counters["astray"],
            "folder": output}


def without_second_half_of(scanner, drive):
    lines = drive.read_text(encoding="utf-8").splitlines(keepends=True)
    silent = drive.with_name(f"without_{scanner}.log")
    silent.write_text("".join(line for i, line in enumerate(lines) if i < len(lines) // 2 or not line.startswith(scanner + " ")), encoding="utf-8")
    return silent


def cases(options):
    with chaos.Services(options) as services:
        drive = services.simulate("three_scanners")
        bench = ["--domain", str(services.domain), "--speed", "max"]
        run = take(services, "run", drive, "run")
        fused = take(services, "bench", drive, "bench", *bench)
        alone = {scanner: take(services, "run", drive, f"alone_{scanner}", "--scanners", scanner) for scanner in SCANNERS}
        same = [name for name in RESULTS if filecmp.cmp(run["folder"] / name, fused["folder"] / name, shallow=False)]
        best = max(alone.values(), key=lambda one: one["hota"])
        yield chaos.row("three scanners on one vehicle, over the services", "fused; run = bench",
                        f"HOTA {fused['hota']:.3f}, ATE {fused['ate_m']:.3f} m (best single scanner {best['hota']:.3f}, {best['ate_m']:.3f} m); "
                        f"same bytes as run: {', '.join(same) or 'none'}",
                        len(same) == len(RESULTS) and fused["hota"] > best["hota"], sound=fused["hota"] > best["hota"], hota=fused["hota"], ate_m=fused["ate_m"], run_hota=run["hota"])
        silent = SCANNERS if options.full else SCANNERS[:1]
        rest = {scanner: take(services, "bench", without_second_half_of(scanner, drive), f"without_{scanner}", *bench) for scanner in silent}
        worst_m = max(one["ate_m"] for one in rest.values())
        yield chaos.row(f"one of three scanners falls silent half-way ({', '.join(silent)})", "goes on",
                        f"ATE at most {worst_m:.3f} m (all three {fused['ate_m']:.3f}), HOTA at least {min(one['hota'] for one in rest.values()):.3f}, "
                        f"astray {sum(one['astray'] for one in rest.values())}",
                        worst_m <= max(0.05, MOST_WORSE * fused["ate_m"]) and not any(one["astray"] for one in rest.values()), worst_m=worst_m)


if __name__ == "__main__":
    chaos.main(cases)
