"""Trajectories in TUM form and how far two of them lie apart."""

import math


def read_tum(path):
    """[(stamp in s, x in m, y in m)] in the file's order."""
    rows = []
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.strip() and not line.startswith("#"):
                stamp, x, y = line.split()[:3]
                rows.append((float(stamp), float(x), float(y)))
    return rows


def pairs_by_stamp(estimate, truth, within_s=0.001):
    """((x, y), (x, y)) of the rows whose stamps agree."""
    known = {round(stamp / within_s): (x, y) for stamp, x, y in truth}
    found = []
    for stamp, x, y in estimate:
        key = round(stamp / within_s)
        match = next((known[k] for k in (key, key - 1, key + 1) if k in known), None)
        if match:
            found.append(((x, y), match))
    return found


def aligned_rmse_m(estimate, truth):
    """Root mean square distance after the rigid alignment (rotation and shift, no scale) that makes it least."""
    pairs = pairs_by_stamp(estimate, truth)
    if not pairs:
        raise ValueError("no stamps in common")
    count = len(pairs)
    mean_e = [sum(e[i] for e, _ in pairs) / count for i in (0, 1)]
    mean_t = [sum(t[i] for _, t in pairs) / count for i in (0, 1)]
    dot = cross = 0.0
    for (ex, ey), (tx, ty) in pairs:
        ex, ey, tx, ty = ex - mean_e[0], ey - mean_e[1], tx - mean_t[0], ty - mean_t[1]
        dot += ex * tx + ey * ty
        cross += ex * ty - ey * tx
    angle = math.atan2(cross, dot)
    c, s = math.cos(angle), math.sin(angle)
    total = 0.0
    for (ex, ey), (tx, ty) in pairs:
        ex, ey, tx, ty = ex - mean_e[0], ey - mean_e[1], tx - mean_t[0], ty - mean_t[1]
        total += (c * ex - s * ey - tx) ** 2 + (s * ex + c * ey - ty) ** 2
    return math.sqrt(total / count)
