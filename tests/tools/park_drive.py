#!/usr/bin/env python3
"""A car in a park: trunks, no walls, wheels that count turns too large. Writes PREFIX.log (CARMEN, ROBOTLASER1) and PREFIX.tum.

The way is closed, with bends to both sides, some 300 m a lap. About 17 % of the beams have an echo. Drawn by random.Random(seed).
"""

import argparse
import bisect
import math
import random
import sys

from carmen_drive import NO_ECHO_M, compound

BEAMS = 361
STEP_RAD = math.pi / (BEAMS - 1)
RANGE_M = 40.0
RANGE_NOISE_M = 0.02
LASER_AHEAD_M = 1.5
FIRST_STAMP_S = 1000.0
LAP_POINTS = 4000
TRUNKS = 220


def place(angle):
    radius_m = 45 + 10 * math.sin(3 * angle) + 4 * math.sin(5 * angle + 1)
    return radius_m * math.cos(angle), 0.8 * radius_m * math.sin(angle)


def lap():
    """Places along the way, and how far each is."""
    places = [place(2 * math.pi * i / LAP_POINTS) for i in range(LAP_POINTS + 1)]
    way_m = [0.0]
    for a, b in zip(places, places[1:]):
        way_m.append(way_m[-1] + math.dist(a, b))
    return places, way_m


def poses(laps, step_m):
    places, way_m = lap()

    def at(distance_m):
        i = min(bisect.bisect_right(way_m, distance_m % way_m[-1]), LAP_POINTS) - 1
        share = (distance_m % way_m[-1] - way_m[i]) / (way_m[i + 1] - way_m[i])
        return [a + share * (b - a) for a, b in zip(places[i], places[i + 1])]

    for k in range(int(laps * way_m[-1] / step_m)):
        x_m, y_m = at(k * step_m)
        ahead, behind = at(k * step_m + 0.2), at(k * step_m - 0.2)
        yield x_m, y_m, math.atan2(ahead[1] - behind[1], ahead[0] - behind[0])


def trunks(draw):
    """(x, y, radius) in metres, none within 3 m of the way."""
    places = lap()[0][::10]
    found = []
    while len(found) < TRUNKS:
        x_m, y_m = draw.uniform(-80, 80), draw.uniform(-70, 70)
        if min(math.dist((x_m, y_m), other) for other in places) > 3.0:
            found.append((x_m, y_m, draw.uniform(0.12, 0.45)))
    return found


def scan(circles, laser, draw):
    ranges_m = [math.inf] * BEAMS
    for x_m, y_m, radius_m in circles:
        ahead_m, left_m = x_m - laser[0], y_m - laser[1]
        distance_m = math.hypot(ahead_m, left_m)
        if distance_m > RANGE_M + radius_m:
            continue
        bearing_rad = math.remainder(math.atan2(left_m, ahead_m) - laser[2], 2 * math.pi) + 0.5 * math.pi
        half_rad = math.asin(radius_m / distance_m)
        first, last = math.ceil((bearing_rad - half_rad) / STEP_RAD), math.floor((bearing_rad + half_rad) / STEP_RAD)
        for beam in range(max(first, 0), min(last, BEAMS - 1) + 1):
            off_rad = beam * STEP_RAD - bearing_rad
            half_chord_m = math.sqrt(max(radius_m**2 - (distance_m * math.sin(off_rad)) ** 2, 0.0))
            ranges_m[beam] = min(ranges_m[beam], distance_m * math.cos(off_rad) - half_chord_m)
    noisy = (range_m + draw.gauss(0.0, RANGE_NOISE_M) for range_m in ranges_m)
    return [range_m if range_m < RANGE_M else NO_ECHO_M for range_m in noisy]


def arc(way_m, turn_rad):
    """The step along its chord, which leaves at half the turn."""
    return way_m * math.cos(0.5 * turn_rad), way_m * math.sin(0.5 * turn_rad), turn_rad


def of_laser(pose):
    return compound(pose, (LASER_AHEAD_M, 0.0, 0.0))


def write(prefix, options):
    draw = random.Random(options.seed)
    circles = trunks(draw)
    wheels, before = (0.0, 0.0, 0.0), None
    with open(f"{prefix}.log", "w", encoding="ascii") as log, open(f"{prefix}.tum", "w", encoding="ascii") as truth:
        log.write(f"PARAM robot_frontlaser_offset {LASER_AHEAD_M}\nPARAM robot_width 1.8\nPARAM robot_length 4.2\n")
        for i, pose in enumerate(poses(options.laps, options.speed / options.rate)):
            since_start_s = i / options.rate
            if before:
                turn_rad = math.remainder(pose[2] - before[2], 2 * math.pi)
                scatter_rad = draw.gauss(0.0, options.scatter * math.sqrt(abs(turn_rad)))
                way_m = math.dist(before[:2], pose[:2]) * (1.0 + draw.gauss(0.0, 0.02))
                wheels = compound(wheels, arc(way_m, options.turn_factor * turn_rad + scatter_rad))
            before = pose
            laser, by_wheels = of_laser(pose), of_laser(wheels)
            numbers = " ".join(f"{range_m:.2f}" for range_m in scan(circles, laser, draw))
            log.write(f"ROBOTLASER1 0 {-0.5 * math.pi:.6f} {math.pi:.6f} {STEP_RAD:.6f} {NO_ECHO_M} 0.01 0 {BEAMS} {numbers} 0 "
                      + " ".join(f"{value:.5f}" for value in (*by_wheels, *wheels))
                      + f" 0 0 0 0 0 {FIRST_STAMP_S + since_start_s:.4f} park {since_start_s:.4f}\n")
            truth.write(f"{FIRST_STAMP_S + since_start_s:.6f} {pose[0]:.5f} {pose[1]:.5f} 0 0 0 {math.sin(0.5 * pose[2]):.9f} {math.cos(0.5 * pose[2]):.9f}\n")


def main(words):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("prefix", metavar="PREFIX")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--laps", type=float, default=4)
    parser.add_argument("--speed", type=float, default=5.0, help="m/s [5]")
    parser.add_argument("--rate", type=float, default=12.5, help="scans a second [12.5]")
    parser.add_argument("--turn-factor", type=float, default=1.06, help="turns by wheels over true ones [1.06]")
    parser.add_argument("--scatter", type=float, default=0.006, help="one sigma of what wheels add in a turn of one radian [rad, 0.006]")
    options = parser.parse_args(words)
    write(options.prefix, options)


if __name__ == "__main__":
    main(sys.argv[1:])
