#!/usr/bin/env python3
"""Wrong neighbours: a stray source of scans, second instances, a shared state directory, and a full disk."""

import subprocess
import time

import chaos
import drives
import timeline as lines

LONGEST_S = 1.0
DEGRADED, IN_USE = 3, 4  # exit codes of `slammot health` and of a refused service
VICTIMS = ["localization", "detection", "tracking"]


def begin(services, options, seconds=40):
    log = drives.to_and_fro(options.input or services.simulate("block"), services.folder / "long.log.gz", scans=int(37.5 * seconds))
    watch = lines.Timeline(options, services)
    observer = services.observe(period_s=0.2)
    services.start_all([*chaos.KEEPERS, *VICTIMS], "--profile", "urban")
    services.start("ingest", "--input", log, "--profile", "urban", "--linger")
    chaos.wait_until(lambda: watch.count("tracks") > 200, "tracks", 60)
    return log, watch, observer


def health(services, *names):
    """Exit code and words of `slammot health`."""
    done = subprocess.run([services.options.bin / "slammot", "health", *names], env=services.environment, stdout=subprocess.PIPE, text=True,
                          check=False)
    return done.returncode, done.stdout


def of_one_drive(watch, from_ns, to_ns):
    """Longest silence of poses [s], and the maps that they name."""
    maps = {rest[3] for _, _, rest in watch.between("pose", from_ns, to_ns)}
    return watch.longest_silence_ms("pose", from_ns, to_ns) / 1000, maps


def stray_source(options):
    """Another process sends scans of the same scanner and vehicle, of another drive."""
    with chaos.Services(options) as services:
        log, watch, _ = begin(services, options)
        before = {rest[3] for _, _, rest in list(watch.lines["pose"])[-10:]}
        at_ns = time.time_ns()
        services.start("ingest", "--input", log, "--profile", "urban", instance="stray", state_dir=services.folder / "elsewhere")
        time.sleep(4.0)
        code, words = health(services)
        services.kill("ingest", instance="stray")
        time.sleep(1.0)
        silence_s, maps = of_one_drive(watch, at_ns, time.time_ns())
        watch.end()
    causes = [line for line in words.splitlines() if "second writer" in line or "another drive" in line]
    figure = f"longest silence {silence_s:.2f} s, {len(maps | before)} map; health exits {code}: \"{causes[0] if causes else words.strip()}\" ({chaos.load()})"
    return chaos.row("a second source sends another drive", f"the drive that goes on wins within {LONGEST_S:.0f} s; cause in health, exit code {DEGRADED}",
                     figure, silence_s <= LONGEST_S and maps == before and code == DEGRADED and causes,
                     sound=maps == before and code == DEGRADED and causes)


def second_instances(options, shares_state):
    with chaos.Services(options) as services:
        _, watch, _ = begin(services, options)
        before = {rest[3] for _, _, rest in list(watch.lines["pose"])[-10:]}
        at_ns = time.time_ns()
        others = {victim: services.start(victim, "--profile", "urban", instance="second",
                                         state_dir=services.folder / ("state" if shares_state else "elsewhere")) for victim in VICTIMS}
        chaos.wait_until(lambda: all(watch.stands_by(victim, process.pid) for victim, process in others.items()), "standbys", 10)
        time.sleep(2.0)
        code, words = health(services)
        silence_s, maps = of_one_drive(watch, at_ns, time.time_ns())
        overlaps = sum(watch.overlapping_leaders(victim) for victim in VICTIMS)
        still = all(process.poll() is None and watch.stands_by(victim, process.pid) for victim, process in others.items())
        watch.end()
    standing = sum("stands by" in line for line in words.splitlines())
    figure = f"{standing} of {len(others)} stand by, health exits {code}; longest silence of poses {silence_s:.2f} s, {len(maps | before)} map; " \
             f"{overlaps} times two leaders ({chaos.load()})"
    return chaos.row(f"second instances, {'shared' if shares_state else 'own'} state directory", "they stand by; one leader", figure,
                     still and standing == len(others) and code == 0 and silence_s <= LONGEST_S and maps == before and overlaps == 0,
                     sound=standing == len(others) and maps == before and overlaps == 0)


def second_without_bus(options):
    """A second instance that does not hear the first one, with its state directory: the lock keeps it out."""
    with chaos.Services(options) as services:
        _, watch, _ = begin(services, options)
        deaf = dict(services.environment, CYCLONEDDS_URI=chaos.BUS.format("elsewhere"))
        others = {}
        for victim in ["localization", "tracking", "map-store"]:
            command = [options.bin / f"slammot-{victim}", "--vehicle", "vehicle", "--state-dir", services.folder / "state", "--profile", "urban"]
            others[victim] = subprocess.Popen(command, env=deaf, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        time.sleep(4.0)
        codes = {victim: process.poll() for victim, process in others.items()}
        alive = all(services.running[victim, "vehicle", "main"].poll() is None for victim in others)
        for process in others.values():
            process.kill()
        words = {victim: process.communicate()[1] for victim, process in others.items()}
        watch.end()
    told = sum("is in use by process" in text for text in words.values())
    figure = f"{told} of {len(others)} say that the state is in use, with its process; exit codes {codes}; the first ones {'go on' if alive else 'ended'} ({chaos.load()})"
    return chaos.row("second instances on another bus, shared state directory", f"state is locked: stand by, or exit code {IN_USE}", figure,
                     alive and told == len(others) and codes["map-store"] == IN_USE)


def full_disk(options):
    """A state directory of 100 kB: localization and tracking go on, degraded, and recover when there is room."""
    with chaos.Services(options) as services:
        state = services.folder / "full"
        state.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=100k", "tmpfs", state], check=False, stderr=subprocess.DEVNULL).returncode != 0:
            chaos.skip("no right to mount a small file system")
        try:
            return without_room(options, services, state)
        finally:
            for victim in ["localization", "tracking"]:
                services.kill(victim)
            subprocess.run(["umount", state], check=True)


def without_room(options, services, state):
    log = drives.to_and_fro(options.input or services.simulate("block"), services.folder / "long.log.gz", scans=int(37.5 * 40))
    watch = lines.Timeline(options, services)
    services.start_all([*chaos.KEEPERS, "detection"], "--profile", "urban")
    for victim in ["localization", "tracking"]:
        services.start(victim, "--profile", "urban", state_dir=state)
    services.start("ingest", "--input", log, "--profile", "urban", "--linger")
    chaos.wait_until(lambda: watch.count("tracks") > 200, "tracks", 60)
    code, words = health(services, "localization", "tracking")
    subprocess.run(["mount", "-o", "remount,size=64m", state], check=True)
    time.sleep(3.0)
    code_after, words_after = health(services, "localization", "tracking")
    watch.end()
    causes = [line.replace(str(state), "DIR") for line in words.splitlines() if "No space left" in line]
    remains = "" if code_after == 0 else f", {words_after.strip()}"
    figure = f"poses and tracks go on; health exits {code}: \"{causes[0] if causes else words.strip()}\"; with room again: {code_after}{remains} ({chaos.load()})"
    return chaos.row("no room to checkpoint", f"degraded, cause in health, exit code {DEGRADED}; recovers", figure,
                     code == DEGRADED and len(causes) >= 1 and code_after == 0, after=words_after)


def cases(options):
    yield stray_source(options)
    yield second_instances(options, shares_state=True)
    yield second_instances(options, shares_state=False)
    yield second_without_bus(options)
    yield full_disk(options)


if __name__ == "__main__":
    chaos.main(cases)
