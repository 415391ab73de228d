#!/usr/bin/env python3
"""A leader with a warm standby is killed, stopped, or hangs: the standby takes over. Leases are 200 ms."""

import itertools
import time

import chaos
import drives
import timeline as lines

SHORT, FULL = 4, 100  # takeovers of each service and kind
LONGEST_MS = {"kill": 300, "stop": 50, "hang": 300}
LARGEST_JUMP_M = 0.2
KEPT = 0.95


class Standbys:
    """The services of one vehicle; one of them has a standby, always."""

    def __init__(self, services, victim, watch):
        self.services, self.victim, self.watch = services, victim, watch
        self.names = (f"copy{number}" for number in itertools.count(1))
        self.leader, self.standby = next(self.names), None
        services.start(victim, "--profile", "urban", instance=self.leader)

    def process(self, instance):
        return self.services.running[self.victim, "vehicle", instance]

    def add_standby(self):
        self.standby = next(self.names)
        pid = self.services.start(self.victim, "--profile", "urban", instance=self.standby).pid
        chaos.wait_until(lambda: self.watch.stands_by(self.victim, pid), f"a standby of {self.victim}")
        time.sleep(0.5)

    def disturb(self, kind):
        """Returns the time by the system clock [ns]."""
        process = self.process(self.leader)
        now_ns = time.time_ns()
        if kind == "kill":
            process.kill()
        elif kind == "stop":
            process.terminate()
        else:
            self.services.pause(self.victim, instance=self.leader)
        successor = self.process(self.standby).pid
        chaos.wait_until(lambda: self.watch.leads(self.victim, successor), f"the standby of {self.victim}", 5)
        process.wait(timeout=5)
        del self.services.running[self.victim, "vehicle", self.leader]
        self.leader, self.standby = self.standby, None
        return now_ns


def disturbances(options, victim, kinds, count):
    """Of each kind: [(gap ms, when by the data's clock us)]; and what consumers got."""
    with chaos.Services(options) as services:
        drive = options.input or services.simulate("block")
        rounds = count * len(kinds)
        long = drives.to_and_fro(drive, services.folder / "long.log.gz", scans=int((rounds * 3 + 30) * 37.5))
        services.slammot("run", "--input", long, "--output", services.folder / "run", "--profile", "urban", stdout=-3, stderr=-3)
        watch = lines.Timeline(options, services)
        services.start_all([one for one in [*chaos.KEEPERS, *chaos.PROCESSORS] if one != victim], "--profile", "urban")
        standbys = Standbys(services, victim, watch)
        services.start("ingest", "--input", long, "--profile", "urban", "--linger")
        chaos.wait_until(lambda: watch.count("tracks") > 300, "tracks", 60)
        found = {kind: [] for kind in kinds}
        for kind in kinds * count:
            standbys.add_standby()
            at_ns = standbys.disturb(kind)
            time.sleep(1.2)
            gap_ms = watch.longest_silence_ms(lines.OUTPUT[victim], at_ns - 30_000_000, at_ns + lines.NS)
            stamp_us = max((stamp for received, stamp, _ in list(watch.lines["pose"]) if received <= at_ns), default=0) // 1000
            found[kind].append((gap_ms, stamp_us))
        time.sleep(1.0)
        watch.end()
        run = services.folder / "run"
        return found, watch, lines.read_tracks(run / "tracks.csv"), lines.read_poses(run / "online_covariance.csv")


def rows_of(options, victim, count):
    kinds = list(LONGEST_MS)
    found, watch, tracks, poses = disturbances(options, victim, kinds, count)
    overlaps = watch.overlapping_leaders(victim)
    for kind, takeovers in found.items():
        gaps = chaos.summary([gap for gap, _ in takeovers])
        in_time = sum(gap <= LONGEST_MS[kind] for gap, _ in takeovers)
        stamps = [stamp for _, stamp in takeovers]
        kept, total = lines.ids_kept(tracks, watch.tracks(), stamps)
        off_m = max(lines.farthest_m(watch.poses(), poses, stamp, stamp + 1_500_000) for stamp in stamps)
        maps = len({pose[3] for pose in watch.poses().values()})
        figure = f"gap p50 {gaps['p50']:.0f}, worst {gaps['worst']:.0f} ms; {in_time} of {len(takeovers)} in time; ids {kept} of {total} kept; " \
                 f"poses at most {off_m:.3f} m from the undisturbed run; {maps} map; {overlaps} times two leaders ({chaos.load()})"
        passed = in_time == len(takeovers) and kept >= KEPT * total and off_m <= LARGEST_JUMP_M and maps == 1 and overlaps == 0
        yield chaos.row(f"standby of {victim}: leader {'killed (-9)' if kind == 'kill' else 'stopped (SIGTERM)' if kind == 'stop' else 'hangs (SIGSTOP)'}",
                        f"gap at most {LONGEST_MS[kind]} ms, {len(takeovers)} of {len(takeovers)}; ids kept, pose within {LARGEST_JUMP_M} m, never two leaders",
                        figure, passed, sound=overlaps == 0 and maps == 1, gaps_ms=[gap for gap, _ in takeovers], kept=kept, total=total, off_m=off_m)


def cases(options):
    for victim in ["tracking", "localization", "detection"]:
        yield from rows_of(options, victim, FULL if options.full else SHORT)


if __name__ == "__main__":
    chaos.main(cases)
