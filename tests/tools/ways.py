"""The ways in which a drive is altered: names, what they say, and their standard strength."""

import dataclasses
from typing import Callable

import alterations as alter

WINDOW_S = 6.0
OF_ODOMETRY = r"(?m)^(?!log:).*\b(odometry|wheels)\b"
OF_STAMPS = r"\b(stamps?|clock)\b"


@dataclasses.dataclass(frozen=True)
class Way:
    name: str
    text: str
    apply: Callable  # (drive, seed) -> drive
    said: str = ""  # pattern of what a run says of it; "": nothing need be said
    seen: tuple = ()  # options of slammot eval: of objects, those that the scanner can still see
    takes_information: bool = False  # about the pose: no estimator can have it back


def in_window(alteration, *strength):
    return lambda drive, seed: alteration(drive, *alter.moving_window(drive, WINDOW_S), *strength)


STANDARD = (
    Way("stamps-zero", "all stamps 0", lambda drive, seed: alter.stamps_zero(drive), OF_STAMPS),
    Way("stamps-index", "stamps count scans", lambda drive, seed: alter.stamps_index(drive), OF_STAMPS),
    Way("stamps-seconds", "stamps in whole seconds", lambda drive, seed: alter.stamps_seconds(drive), OF_STAMPS),
    Way("third", "every third scan only", lambda drive, seed: alter.every_nth(drive, 3), takes_information=True),
    Way("fifth", "every fifth scan only", lambda drive, seed: alter.every_nth(drive, 5), takes_information=True),
    Way("fov-90", "90 degrees in view", lambda drive, seed: alter.field_of_view(drive, 90.0), seen=("--bearings", "-45", "45"), takes_information=True),
    Way("range-8m", "ranges to 8 m", lambda drive, seed: alter.no_farther(drive, 8.0), seen=("--range", "8"), takes_information=True),
    Way("range-5m", "ranges to 5 m", lambda drive, seed: alter.no_farther(drive, 5.0), seen=("--range", "5"), takes_information=True),
    Way("dropouts-30", "30 % drop-outs", lambda drive, seed: alter.dropouts(drive, 0.30, seed), takes_information=True),
    Way("noise-5cm", "5 cm noise", lambda drive, seed: alter.noise(drive, 0.05, seed), takes_information=True),
    Way("false-5", "5 % false echoes", lambda drive, seed: alter.false_echoes(drive, 0.05, seed)),
    Way("beams-reversed", "beams in reverse order, unsaid", lambda drive, seed: alter.beams_reversed(drive), r"revers|clockwise|mirror|upside"),
    Way("nan-seventh", "NaN in every seventh scan", lambda drive, seed: alter.nan_in_every_nth(drive, 7), r"\bnan\b|not? (a )?number|invalid"),
    Way("millimetres", "ranges in millimetres", lambda drive, seed: alter.ranges_scaled(drive, 1000.0), r"millimet"),
    Way("degrees", "headings in degrees", lambda drive, seed: alter.headings_in_degrees(drive), r"headings?\b.*degrees"),
    Way("way-1.3", "way by the wheels 1.3x", lambda drive, seed: alter.way_scaled(drive, 1.3), OF_ODOMETRY),
    Way("turns-1.15", "turns by the wheels 1.15x", lambda drive, seed: alter.turns_scaled(drive, 1.15), OF_ODOMETRY),
    Way("turns-mirrored", "turns with the wrong sign", lambda drive, seed: alter.turns_scaled(drive, -1.0), OF_ODOMETRY),
    Way("none", "odometry all zero", lambda drive, seed: alter.no_odometry(drive), OF_ODOMETRY, takes_information=True),
    Way("swapped-axes", "x and y of the odometry swapped", lambda drive, seed: alter.axes_swapped(drive), OF_ODOMETRY),
    Way("yaw-bias", "0.01 rad/s too much turn", lambda drive, seed: alter.yaw_bias(drive, 0.01), OF_ODOMETRY),
    Way("frozen-6s", "wheels stand for 6 s of driving", in_window(alter.frozen), OF_ODOMETRY, takes_information=True),
    Way("slip-6s", "1 m/s too much for 6 s", in_window(alter.slipped, 1.0), OF_ODOMETRY),
    Way("jumps-40m", "odometry jumps by 40 m", lambda drive, seed: alter.jumped(drive, 40.0, alter.moving_window(drive, WINDOW_S)[0]), OF_ODOMETRY),
    Way("late-0.3s", "odometry 0.3 s late", lambda drive, seed: alter.late(drive, 0.3), OF_ODOMETRY),
    Way("missing-6s", "no odometry for 6 s", in_window(alter.missing), OF_ODOMETRY, takes_information=True),
)
FURTHER = (
    Way("stamps-noisy", "5 ms of noise on the stamps of scans", lambda drive, seed: alter.scan_stamps_noisy(drive, 0.005, seed), r"stamps of scans are noisy"),
    Way("another-order", "each five scans in any order", lambda drive, seed: alter.in_another_order(drive, 5, seed), r"logged in another order|out of order"),
    Way("stamps-batches", "scans come four at a time and are stamped then", lambda drive, seed: alter.scan_stamps_of_batches(drive, 4), r"stamps of scans are noisy|stamps do not advance"),
    Way("stamps-milliseconds", "stamps in milliseconds", lambda drive, seed: alter.stamps_milliseconds(drive), OF_STAMPS),
    Way("stamps-hour", "stamps jump by an hour in the middle", lambda drive, seed: alter.stamps_jump(drive), OF_STAMPS),
    Way("stamps-backwards", "stamps run backwards", lambda drive, seed: alter.stamps_backwards(drive), OF_STAMPS),
    Way("fov-60", "60 degrees in view", lambda drive, seed: alter.field_of_view(drive, 60.0), seen=("--bearings", "-30", "30"), takes_information=True),
    Way("rain", "drops on 5 % of the beams", lambda drive, seed: alter.rain(drive, 0.05, seed)),
    Way("no-echo-zero", "no echo written as 0", lambda drive, seed: alter.no_echo_as(drive, "0.000")),
    Way("no-echo-inf", "no echo written as inf", lambda drive, seed: alter.no_echo_as(drive, "inf")),
    Way("no-echo-nan", "no echo written as nan", lambda drive, seed: alter.no_echo_as(drive, "nan")),
    Way("upside-down", "scanner upside down, unsaid", lambda drive, seed: alter.upside_down(drive), r"revers|clockwise|mirror|upside"),
    Way("backwards", "scanner mounted backwards", lambda drive, seed: alter.mounted_backwards(drive)),
    Way("driven-backwards", "the drive from its end to its start (a sweep runs backwards, too)", lambda drive, seed: alter.driven_backwards(drive)),
    Way("beams-half", "every second beam", lambda drive, seed: alter.every_nth_beam(drive, 2), takes_information=True),
    Way("beams-quarter", "every fourth beam", lambda drive, seed: alter.every_nth_beam(drive, 4), takes_information=True),
    Way("odometry-millimetres", "odometry in millimetres", lambda drive, seed: alter.odometry_scaled(drive, 1000.0), r"millimet"),
    Way("twice", "each line recorded twice", lambda drive, seed: alter.recorded_twice(drive), r"recorded again"),
    Way("compass-headings", "headings clockwise from north", lambda drive, seed: alter.headings_of_a_compass(drive), OF_ODOMETRY),
    Way("turns-slipping", "turns by the wheels 0.6x to 1.4x, another every 2 s", lambda drive, seed: alter.turns_slipping(drive, 0.4, seed), OF_ODOMETRY),
    Way("standing-wheels", "wheels stand for 1 s every 20 s", lambda drive, seed: alter.standing(drive, 1.0, 20.0), OF_ODOMETRY, takes_information=True),
    Way("held-1s", "odometry comes once a second", lambda drive, seed: alter.held(drive, 1.0), takes_information=True),
    Way("begun-anew", "odometry begins anew at zero six times", lambda drive, seed: alter.begun_anew(drive, 6)),
    Way("halves-swapped", "two drives in one log: the second half, then the first, for which odometry begins anew", lambda drive, seed: alter.halves_swapped(drive), r"new part of the map"),
    Way("another-point", "odometry of a point 1 m ahead, unsaid", lambda drive, seed: alter.of_another_point(drive, 1.0, 0.0)),
    Way("turned-5", "scanner turned by 5 degrees, unsaid", lambda drive, seed: alter.scanner_turned(drive, 5.0), r"mounted turned"),
    Way("own-body", "a fifth of the beams sees the vehicle", lambda drive, seed: alter.own_body(drive, seed), r"vehicle itself"),
    Way("blind-ahead", "no echo over 36 degrees in the middle of the view", lambda drive, seed: alter.blind_ahead(drive, 36.0), takes_information=True),
    Way("walks-ahead", "somebody walks 1.2 m ahead all the way", lambda drive, seed: alter.walks_ahead(drive, seed), takes_information=True),
    Way("hung-6s", "scanner repeats its readings for 6 s", in_window(alter.hung), r"repeat the readings", takes_information=True),
    Way("second-source", "ODOM lines count 1.1x the way", lambda drive, seed: alter.second_source(drive, 1.1), OF_ODOMETRY),
)
BY_NAME = {way.name: way for way in STANDARD + FURTHER}
ONLY_OUTDOORS, ONLY_INDOORS = "range-8m", "range-5m"


def standard_names(indoors):
    """The 25 ways: the short range is 5 m indoors and 8 m outdoors."""
    left_out = ONLY_OUTDOORS if indoors else ONLY_INDOORS
    return [way.name for way in STANDARD if way.name != left_out]
