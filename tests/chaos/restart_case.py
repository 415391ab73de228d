#!/usr/bin/env python3
"""Services end in every other way, alone and all at once: who goes on, and how soon a killed one is back at work."""

import time

import chaos
import drives
import timeline as lines

SHORT, FULL = 3, 20  # kills of each service
LONGEST_S, LONGEST_ALL_S, FARTHEST_M = 1.0, 2.0, 0.2
ALL = [*chaos.KEEPERS, *chaos.PROCESSORS]


class Drive:
    """All services of one vehicle and a recorded drive at the recorded speed; what consumers get; the same drive undisturbed."""

    def __init__(self, services, options, seconds=60, scenario="block"):
        self.services, self.options = services, options
        recorded = options.input or services.simulate(scenario)
        self.log = drives.to_and_fro(recorded, services.folder / "long.log.gz", scans=int(37.5 * seconds))
        services.slammot("run", "--input", self.log, "--output", services.folder / "run", "--profile", "urban", stdout=-3, stderr=-3)
        self.tracks = lines.read_tracks(services.folder / "run/tracks.csv")
        self.poses = lines.read_poses(services.folder / "run/online_covariance.csv")
        self.watch = lines.Timeline(options, services)
        self.observer = services.observe(period_s=0.2)

    def begin(self):
        self.start(*ALL)
        self.services.start("ingest", "--input", self.log, "--profile", "urban", "--linger")
        chaos.wait_until(lambda: self.watch.count("tracks") > 200, "tracks", 60)

    def start(self, *services):
        self.services.start_all(services, "--profile", "urban")

    def stamp_us(self):
        return self.watch.lines["pose"][-1][1] // 1000

    def maps(self):
        return {pose[3] for pose in self.watch.poses().values()}

    def off_m(self, from_us, seconds=1.5):
        return lines.farthest_m(self.watch.poses(), self.poses, from_us, from_us + seconds * 1e6)

    def counter(self, service, name):
        return self.observer.counter(service, name)

    def explanation(self, service):
        status = self.observer.status(service)
        return status["explanation"] if status else ""


def killed_and_restarted(options, count):
    """kill -9 of each service, restarted at once."""
    with chaos.Services(options) as services:
        drive = Drive(services, options, seconds=7 * count + 30)
        drive.begin()
        silences = {one: [] for one in lines.OUTPUT}
        off_m = []
        for _ in range(count):
            for victim, kind in lines.OUTPUT.items():
                stamp_us, at_ns = drive.stamp_us(), time.time_ns()
                services.kill(victim)
                drive.start(victim)
                time.sleep(2.2)
                silences[victim].append(drive.watch.longest_silence_ms(kind, at_ns - 30_000_000, at_ns + 2 * lines.NS) / 1000)
                if victim == "localization":
                    off_m.append(drive.off_m(stamp_us))
        maps = drive.maps()
        drive.watch.end()
    worst = {victim: max(seconds) for victim, seconds in silences.items()}
    figure = ", ".join(f"{victim} p50 {chaos.percentile(silences[victim], 0.5):.2f}, worst {worst[victim]:.2f} s" for victim in worst) + \
        f"; poses at most {max(off_m):.3f} m from the undisturbed run; {len(maps)} map ({count} kills each, {chaos.load()})"
    passed = max(worst.values()) <= LONGEST_S and max(off_m) <= FARTHEST_M and len(maps) == 1
    return chaos.row("killed (-9) and restarted at once", f"back at work within {LONGEST_S:.0f} s; pose within {FARTHEST_M} m", figure, passed,
                     sound=len(maps) == 1, silences_s=silences, off_m=off_m)


def everything_at_once(options):
    with chaos.Services(options) as services:
        drive = Drive(services, options)
        drive.begin()
        chaos.wait_until(lambda: len(drive.watch.lines["tracks"][-1][2]) > 1, "confirmed tracks", 40)
        stamp_us, at_ns = drive.stamp_us(), time.time_ns()
        for service in [*ALL, "ingest"]:
            services.kill(service)
        drive.start(*ALL)
        services.start("ingest", "--input", drive.log, "--profile", "urban", "--linger")
        chaos.wait_until(lambda: drive.stamp_us() > stamp_us + 2_000_000, "the drive to go on", 60)
        silence_s = drive.watch.longest_silence_ms("tracks", at_ns, time.time_ns()) / 1000
        off_m, maps = drive.off_m(stamp_us), drive.maps()
        kept, total = lines.ids_kept(drive.tracks, drive.watch.tracks(), [stamp_us])
        drive.watch.end()
    figure = f"goes on after {silence_s:.1f} s in {len(maps)} map; poses at most {off_m:.3f} m from the undisturbed run; " \
             f"{kept} of {total} tracks under their ids ({chaos.load()})"
    return chaos.row("all services and ingest killed (-9) and restarted at once", f"continues the drive within {LONGEST_ALL_S:.0f} s", figure,
                     silence_s <= LONGEST_ALL_S and len(maps) == 1 and off_m <= FARTHEST_M and kept >= 0.95 * total,
                     sound=len(maps) == 1)


def without(options, victims, expected_trouble):
    """The others go on; `expected_trouble`: services that must be degraded, with words of their explanation."""
    with chaos.Services(options) as services:
        drive = Drive(services, options)
        drive.begin()
        at_ns, stamp_us = time.time_ns(), drive.stamp_us()
        for victim in victims:
            services.kill(victim)
        time.sleep(5.0)
        silence_ms = drive.watch.longest_silence_ms("pose", at_ns, at_ns + 5 * lines.NS)
        troubles = {service: drive.explanation(service) for service in ["localization", "detection", "tracking"]}
        rate = len(drive.watch.between("pose", at_ns + lines.NS, at_ns + 5 * lines.NS)) / 4
        off_m = drive.off_m(stamp_us, 5.0)
        drive.watch.end()
    told = all(words in troubles[service] for service, words in expected_trouble.items())
    quiet = all(not troubles[service] for service in troubles if service not in expected_trouble and service not in victims)
    figure = f"{rate:.1f} poses a second, longest silence {silence_ms:.0f} ms, at most {off_m:.3f} m from the undisturbed run; " + \
        ("; ".join(f'{service}: "{words}"' for service, words in troubles.items() if words and service not in victims) or "nobody degraded")
    wanted = "SLAM goes on, degraded" if expected_trouble else "nobody else notices"
    return chaos.row(f"without {' and '.join(victims)} for 5 s", wanted, f"{figure} ({chaos.load()})",
                     rate > 35 and silence_ms < 1000 and off_m < 0.5 and told and quiet, sound=told and quiet, troubles=troubles)


def spoiled(options, name, spoil, words):
    """localization and tracking are killed, their state is spoiled: they begin anew, say why, and work."""
    with chaos.Services(options) as services:
        drive = Drive(services, options)
        drive.begin()
        for victim in ["localization", "tracking"]:
            services.kill(victim)
        for file in [*(services.folder / "state").glob("*.checkpoint"), *(services.folder / "state").glob("*.journal")]:
            spoil(file)
        at_ns = time.time_ns()
        drive.start("localization", "tracking")
        time.sleep(3.0)
        poses = len(drive.watch.between("pose", at_ns + 2 * lines.NS, at_ns + 3 * lines.NS))
        logs = [services.log_of(victim).read_text(encoding="utf-8") for victim in ["localization", "tracking"]]
        alive = all(services.running[victim, "vehicle", "main"].poll() is None for victim in ["localization", "tracking"])
        drive.watch.end()
    told = all(any(one in log for one in words) for log in logs)
    return chaos.row(f"state file {name}", "begins anew, says why", f"{'both work' if alive else 'a service ended'}, {poses} poses in a second; "
                     f"{'both say why' if told else 'not both say why'} ({chaos.load()})", alive and poses > 30 and told, sound=alive and told)


def cut(file):
    content = file.read_bytes()
    file.write_bytes(content[:len(content) // 2])


def of_another_version(file):
    content = bytearray(file.read_bytes())
    content[7] ^= 0xff  # of the mark of the file
    file.write_bytes(bytes(content))


def stopped(options):
    """SIGTERM of localization and tracking, restarted: the drive goes on where it was."""
    with chaos.Services(options) as services:
        drive = Drive(services, options)
        drive.begin()
        stamp_us = drive.stamp_us()
        codes, took_s = [], []
        for victim in ["localization", "tracking", "detection"]:
            began = time.monotonic()
            codes.append(services.stop(victim))
            took_s.append(time.monotonic() - began)
            drive.start(victim)
        time.sleep(3.0)
        maps, off_m = drive.maps(), drive.off_m(stamp_us, 4.0)
        drive.watch.end()
    figure = f"exit codes {codes}, ended within {max(took_s):.2f} s, {len(maps)} map, poses at most {off_m:.3f} m from the undisturbed run ({chaos.load()})"
    return chaos.row("SIGTERM and started again", "exit code 0, the drive goes on", figure, codes == [0, 0, 0] and len(maps) == 1 and off_m <= FARTHEST_M,
                     sound=codes == [0, 0, 0] and len(maps) == 1)


def cases(options):
    yield killed_and_restarted(options, FULL if options.full else SHORT)
    yield everything_at_once(options)
    yield without(options, ["detection", "tracking"], {"localization": "no slammot/segmented_scan"})
    yield without(options, ["tracking"], {"localization": "no slammot/tracked_objects"})
    yield without(options, ["loop-closing"], {})
    yield spoiled(options, "cut", cut, ["not used", "damaged", "begins"])
    yield spoiled(options, "of another version", of_another_version, ["not used", "damaged", "begins"])
    yield stopped(options)


if __name__ == "__main__":
    chaos.main(cases)
