"""A trajectory drawn over the true one, as SVG."""

import math
from xml.sax.saxutils import escape

WIDTH, HEIGHT, MARGIN, LEGEND = 1000, 800, 30, 70
OFF_M = 1.0


def pieces(poses, wanted):
    """Runs of neighbouring poses for which wanted(index) holds, each with the pose before it."""
    run = []
    for index, pose in enumerate(poses):
        if pose is not None and wanted(index):
            if not run and index and poses[index - 1] is not None:
                run.append(poses[index - 1])
            run.append(pose)
        elif run:
            yield run
            run = []
    if run:
        yield run


class Canvas:
    """Fits what lies between two corners [m] into the picture, y up."""

    def __init__(self, poses):
        known = [pose for pose in poses if pose is not None and all(map(math.isfinite, pose[:2]))] or [(0.0, 0.0)]
        self.left, self.right = (choose(pose[0] for pose in known) for choose in (min, max))
        self.bottom, self.top = (choose(pose[1] for pose in known) for choose in (min, max))
        self.scale = min((WIDTH - 2 * MARGIN) / max(self.right - self.left, 1.0), (HEIGHT - 2 * MARGIN) / max(self.top - self.bottom, 1.0))
        self.parts = []

    def at(self, pose):
        return MARGIN + self.scale * (pose[0] - self.left), LEGEND + MARGIN + self.scale * (self.top - pose[1])

    def line(self, poses, colour, width):
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(self.at, poses))
        self.parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round"/>')

    def mark(self, pose, colour, text):
        x, y = self.at(pose)
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="7" fill="none" stroke="{colour}" stroke-width="2"/>')
        self.text(x + 10, y - 8, text, colour)

    def text(self, x, y, text, colour="black"):
        self.parts.append(f'<text x="{x:.0f}" y="{y:.0f}" font-family="sans-serif" font-size="14" fill="{colour}">{escape(text)}</text>')

    def bar(self):
        length_m = 10.0 ** math.floor(math.log10(max(self.right - self.left, self.top - self.bottom, 1.0) / 2.0))
        y = LEGEND + HEIGHT - 8
        self.parts.append(f'<line x1="{MARGIN}" y1="{y}" x2="{MARGIN + self.scale * length_m:.1f}" y2="{y}" stroke="black" stroke-width="3"/>')
        self.text(MARGIN, y - 6, f"{length_m:g} m")

    def svg(self):
        return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT + LEGEND}">\n'
                f'<rect width="100%" height="100%" fill="white"/>\n' + "\n".join(self.parts) + "\n</svg>\n")


def picture(title, estimated, true, first_off=None):
    """True trajectory grey, the aligned estimate blue, red where it is off by more than a metre."""
    canvas = Canvas(list(true) + [pose for pose in estimated if pose is not None])
    off = [a is not None and b is not None and math.dist(a[:2], b[:2]) > OFF_M for a, b in zip(estimated, true)]
    off += [False] * (len(estimated) - len(off))
    for run in pieces(true, lambda index: True):
        canvas.line(run, "#aaaaaa", 4)
    for run in pieces(estimated, lambda index: not off[index]):
        canvas.line(run, "#1f5fbf", 1.5)
    for run in pieces(estimated, lambda index: off[index]):
        canvas.line(run, "#d02020", 1.5)
    start = next((pose for pose in true if pose is not None), None)
    if start:
        canvas.mark(start, "#208020", "start")
    if first_off is not None and first_off < len(true) and true[first_off] is not None:
        canvas.mark(true[first_off], "#d02020", f"scan {first_off}")
    canvas.text(MARGIN, 24, title)
    canvas.text(MARGIN, 46, "true: grey; estimated, rigidly aligned: blue; off by more than a metre: red")
    canvas.bar()
    return canvas.svg()
