#!/usr/bin/env python3
"""Writes a copy of a recorded drive as it was not driven: COPY.log, and its truth for the scans that are left.

PREFIX is a CARMEN log (FLASER or ROBOTLASER1, ODOM lines beside them) or its path without .log or .rawodom.log, plain or .gz. Truth
beside it is PREFIX.tum or PREFIX.reference.txt; of the copy there are COPY.reference.txt, which counts scans, and COPY.tum,
COPY.objects.csv, COPY.walls.csv where PREFIX has them. Alterations may be combined; they are applied in the order of the help. The same
seed gives the same bytes. Seconds count from the first scan; where stamps do not advance, time is made from the way (0.5 m/s).
"""

import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import alterations as alter
import carmen_drive
import ways

STAMPS = {"zero": alter.stamps_zero, "index": alter.stamps_index, "seconds": alter.stamps_seconds, "milliseconds": alter.stamps_milliseconds,
          "hour": alter.stamps_jump, "backwards": alter.stamps_backwards}


def flag(name, alteration, text):
    return name, {"action": "store_true", "help": text}, lambda drive, value, options: alteration(drive)


def one(name, kind, unit, alteration, text):
    return name, {"type": kind, "metavar": unit, "help": text}, lambda drive, value, options: alteration(drive, value)


def some(name, units, alteration, text):
    return name, {"type": float, "nargs": len(units), "metavar": units, "help": text}, lambda drive, value, options: alteration(drive, *value)


def drawn(name, unit, alteration, text):
    return name, {"type": float, "metavar": unit, "help": text}, lambda drive, value, options: alteration(drive, value, options.seed)


# Option, how argparse takes it, and what it does: (drive, value, options) -> drive.
ALTERATIONS = (
    ("--way", {"choices": sorted(ways.BY_NAME), "metavar": "NAME", "action": "append", "help": "one of --ways with its standard strength"},
     lambda drive, names, options: applied(names, drive, options.seed)),
    ("--cut", {"type": float, "nargs": 2, "metavar": ("FROM", "TO"), "help": "carried away: the scans between are missing, the wheels stand meanwhile"},
     lambda drive, value, options: alter.cut(drive, *value, options.no_time_passes)),
    flag("--halves-swapped", alter.halves_swapped, "the second half, then the first with odometry begun anew"),
    one("--odometry-late", float, "S", alter.late, "odometry of S seconds before (S < 0: after)"),
    one("--clocks-drift", float, "S", alter.clocks_drift, "odometry is late by more and more, by S seconds at the end"),
    one("--headings-late", float, "S", alter.headings_late, "headings of S seconds before with the positions"),
    one("--way-scale", float, "X", alter.way_scaled, "way by the wheels"),
    one("--turn-scale", float, "X", alter.turns_scaled, "turns by the wheels"),
    flag("--turns-mirrored", lambda drive: alter.turns_scaled(drive, -1.0), "turns with the wrong sign"),
    one("--yaw-bias", float, "RADPS", alter.yaw_bias, "so much too much turn"),
    drawn("--turn-noise", "RAD", alter.turns_noisy, "of the turns by the wheels, one sigma after a second"),
    some("--ticks", ("METRES", "TRACK"), alter.counted, "two wheels TRACK apart are counted in ticks of so many metres"),
    some("--frozen", ("FROM", "TO"), alter.frozen, "the wheels stand while the vehicle goes on"),
    some("--slip", ("FROM", "TO", "MPS"), alter.slipped, "extra speed by the wheels"),
    some("--jump", ("METRES", "AT"), alter.jumped, "the odometry's pose jumps"),
    some("--missing", ("FROM", "TO"), alter.missing, "no ODOM lines, scans repeat the last pose"),
    some("--standing-wheels", ("FOR", "EVERY"), alter.standing, "the wheels stand for a moment again and again"),
    one("--second-source", float, "X", alter.second_source, "ODOM lines count another way than the scans' poses"),
    one("--held-odometry", float, "S", alter.held, "odometry comes once in so many seconds"),
    one("--anew", int, "TIMES", alter.begun_anew, "odometry begins anew at zero"),
    some("--zero-poses", ("EVERY", "IN-A-ROW"), alter.zero_poses, "of each so many poses by the wheels so many are zero"),
    ("--spikes", {"type": float, "nargs": 3, "metavar": ("EVERY", "METRES", "DEGREES"), "help": "of each so many poses by the wheels one is elsewhere"},
     lambda drive, value, options: alter.spikes(drive, *value, options.seed)),
    some("--old-poses", ("EVERY", "AGO"), alter.old_poses, "of each so many poses by the wheels one is that of so many records before"),
    some("--another-point", ("AHEAD", "LEFT"), alter.of_another_point, "odometry of another point of the vehicle, unsaid"),
    flag("--no-odometry", alter.no_odometry, "all poses zero"),
    flag("--swapped-axes", alter.axes_swapped, "x and y of the odometry swapped"),
    flag("--odometry-millimetres", lambda drive: alter.odometry_scaled(drive, 1000.0), "positions by the wheels in millimetres"),
    flag("--backwards", alter.mounted_backwards, "mounted backwards; said where the format can"),
    flag("--twice", alter.recorded_twice, "each line again"),
    flag("--compass-headings", alter.headings_of_a_compass, "headings by the wheels clockwise from north"),
    flag("--headings-in-degrees", alter.headings_in_degrees, "of all poses"),
    one("--every", int, "N", alter.every_nth, "every Nth scan only"),
    one("--field-of-view", float, "DEGREES", alter.field_of_view, "the beams in the middle"),
    one("--every-beam", int, "N", alter.every_nth_beam, "every Nth beam only"),
    one("--range", float, "METRES", alter.no_farther, "echoes from farther away are missing"),
    drawn("--dropouts", "SHARE", alter.dropouts, "beams without an echo"),
    drawn("--noise", "SIGMA", alter.noise, "of the ranges, in metres"),
    drawn("--false-echoes", "SHARE", alter.false_echoes, "beams that end somewhere on their way"),
    drawn("--rain", "SHARE", alter.rain, "beams that meet a drop"),
    flag("--beams-reversed", alter.beams_reversed, "the last beam first, unsaid"),
    one("--scanner-turned", float, "DEGREES", alter.scanner_turned, "to the left, unsaid"),
    ("--own-body", {"action": "store_true", "help": "a fifth of the beams sees the vehicle"},
     lambda drive, value, options: alter.own_body(drive, options.seed)),
    one("--blind-ahead", float, "DEGREES", alter.blind_ahead, "no echo in the middle of the view"),
    ("--walks-ahead", {"action": "store_true", "help": "somebody walks 1.2 m ahead all the way"},
     lambda drive, value, options: alter.walks_ahead(drive, options.seed)),
    some("--hung", ("FROM", "TO"), alter.hung, "the scanner repeats its last readings"),
    flag("--upside-down", alter.upside_down, "the scanner hangs, unsaid"),
    one("--nan-every", int, "N", alter.nan_in_every_nth, "no number in every Nth scan"),
    ("--no-echo", {"choices": ("0", "inf", "nan"), "help": "how no echo is written"},
     lambda drive, value, options: alter.no_echo_as(drive, value)),
    flag("--millimetres", lambda drive: alter.ranges_scaled(drive, 1000.0), "ranges"),
    ("--another-order", {"type": int, "metavar": "N", "help": "each N scans in any order"},
     lambda drive, value, options: alter.in_another_order(drive, value, options.seed)),
    one("--stamp-batches", int, "N", alter.scan_stamps_of_batches, "scans come N at a time and are stamped then"),
    drawn("--stamp-noise", "SIGMA", alter.scan_stamps_noisy, "of the scans' stamps, in seconds"),
    ("--stamps", {"choices": sorted(STAMPS), "help": "all 0; counting scans; whole seconds; milliseconds; an hour later from the middle on; backwards"},
     lambda drive, value, options: STAMPS[value](drive)),
)


def applied(names, drive, seed):
    for name in names:
        drive = ways.BY_NAME[name].apply(drive, seed)
    return drive


def value_of(options, name):
    return getattr(options, name.lstrip("-").replace("-", "_"))


def list_of_ways():
    columns = max(map(len, ways.BY_NAME))
    lines = [f"  {way.name:{columns}}  {way.text}" for way in ways.STANDARD]
    further = [f"  {way.name:{columns}}  {way.text}" for way in ways.FURTHER]
    return "\n".join(["the standard ways (25: one of the two short ranges, by the surroundings)", *lines, "further ways", *further])


def parse_options(arguments):
    if "--ways" in arguments:
        print(list_of_ways())
        sys.exit(0)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("prefix", metavar="PREFIX")
    parser.add_argument("copy", metavar="COPY")
    for name, how, _ in ALTERATIONS:
        parser.add_argument(name, **how)
    parser.add_argument("--no-time-passes", action="store_true", help="with --cut: stamps go on after it as if there were none")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--gz", action="store_true", help="write COPY.log.gz")
    parser.add_argument("--ways", action="store_true", help="list the ways and end")
    options = parser.parse_args(arguments)
    if not any(value_of(options, name) for name, _, _ in ALTERATIONS):
        parser.error("one alteration at least is needed")
    return options


def altered(drive, options):
    for name, _, alteration in ALTERATIONS:
        value = value_of(options, name)
        if value is not None and value is not False:
            drive = alteration(drive, value, options)
    return drive


def main(arguments):
    options = parse_options(arguments)
    drive = carmen_drive.read_drive(options.prefix)
    carmen_drive.write_drive(drive, altered(drive, options), options.prefix, options.copy, options.gz)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except OSError as fault:
        sys.exit(f"{fault.filename}: {fault.strerror}")
    except ValueError as fault:
        sys.exit(str(fault))
