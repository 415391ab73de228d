#!/usr/bin/env python3
"""Draws a simulated drive from its truth files: walls dark, the vehicle's path blue, the paths of moving objects by class.

usage: draw_scenario.py TRUTH_PREFIX PICTURE.png [PIXELS_WIDE]
"""

import csv
import math
import struct
import sys
import zlib

PALETTE = [(255, 255, 255), (60, 60, 60), (150, 150, 150), (60, 130, 70), (40, 90, 220), (215, 60, 40), (230, 150, 30), (150, 60, 170),
           (20, 150, 160)]
COLOUR_OF_SURFACE = {"0": 1, "1": 2, "2": 3}
COLOUR_OF_CLASS = {"car": 5, "truck": 6, "bus": 6, "bicycle": 7, "pedestrian": 8}
VEHICLE = 4


def read(prefix):
    """Lines ((x, y), (x, y), colour) and dots (x, y, colour), metres."""
    with open(prefix + ".walls.csv", newline="") as file:
        walls = [((float(r["ax"]), float(r["ay"])), (float(r["bx"]), float(r["by"])), COLOUR_OF_SURFACE.get(r["class"], 1)) for r in csv.DictReader(file)]
    with open(prefix + ".objects.csv", newline="") as file:
        dots = [(float(r["x"]), float(r["y"]), COLOUR_OF_CLASS[r["class"]]) for r in csv.DictReader(file) if r.get("points") != "0"]
    with open(prefix + ".tum") as file:
        way = [tuple(map(float, line.split()[1:3])) for line in file]
    return walls, dots, way


def draw(walls, dots, way, width):
    margin = 35.0  # m around the way: what it saw
    west, east = min(x for x, _ in way) - margin, max(x for x, _ in way) + margin
    south, north = min(y for _, y in way) - margin, max(y for _, y in way) + margin
    scale = width / (east - west)
    height = int(scale * (north - south)) + 1
    pixels = [bytearray(width) for _ in range(height)]

    def put(x, y, colour, radius=0):
        column, row = int(scale * (x - west)), int(scale * (north - y))
        for r in range(row - radius, row + radius + 1):
            for c in range(column - radius, column + radius + 1):
                if 0 <= r < height and 0 <= c < width:
                    pixels[r][c] = colour

    def line(a, b, colour, radius=0):
        steps = int(1.5 * scale * math.dist(a, b)) + 1
        for i in range(steps + 1):
            put(a[0] + (b[0] - a[0]) * i / steps, a[1] + (b[1] - a[1]) * i / steps, colour, radius)

    for a, b, colour in walls:
        line(a, b, colour)
    for x, y, colour in dots:
        put(x, y, colour)
    for a, b in zip(way, way[1:]):
        line(a, b, VEHICLE, 0)
    put(*way[0], VEHICLE, 3)
    return pixels


def write_png(path, pixels):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", len(pixels[0]), len(pixels), 8, 3, 0, 0, 0)
    rows = b"".join(b"\0" + bytes(row) for row in pixels)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"PLTE", bytes(v for rgb in PALETTE for v in rgb)))
        file.write(chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def main(arguments):
    prefix, picture, *width = arguments[1:]
    write_png(picture, draw(*read(prefix), int(width[0]) if width else 700))


if __name__ == "__main__":
    main(sys.argv)
