"""Figures of slammot eval and their differences in pairs."""

import math
import statistics


def at(tree, path):
    """Value at the path of keys; None where there is none."""
    for step in path:
        tree = tree.get(step) if isinstance(tree, dict) else None
    return tree


def difference(before, after):
    """Mean of after - before and its standard error, which is NaN for fewer than two pairs."""
    changes = [b - a for a, b in zip(before, after)]
    error = statistics.stdev(changes) / math.sqrt(len(changes)) if len(changes) > 1 else math.nan
    return statistics.fmean(changes), error
