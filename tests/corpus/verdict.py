"""What a row must reach, and what a set must."""

import math
import statistics

import ways
from figures import difference
from rows import QUICK_SETS

SCAN_MS = 20.0
CLOSING_MS = 200.0
SECONDS_A_SCAN = 0.0015
SECONDS = 1.0
ALTERED_ATE = 2.0
ALTERED_STAMPS_ATE = 1.5
ALTERED_TIME = 2.0
ALTERED_TIME_S = 0.5   # start and end of a process scatter by so much
AS_GOOD = 1.1
LEAST_HOTA = 0.9
QUICK_ALTERED_ATE = 2.0
NEES_BAND = {"seeds": (2.7, 3.3), "no-odometry-nees": (2.0, 6.0), "quick-ways": (1.5, 8.0)}
HONEST_NEES = (2.0, 6.0)


def is_known(value):
    return value is not None and math.isfinite(value)


def ate_limit(set_name, row, base):
    """Metres, or None: no limit."""
    drive = row.drive
    if set_name in QUICK_SETS:
        return (QUICK_ALTERED_ATE if row.way else 1.0) * drive.quick_ate_m
    if not row.way:
        return drive.ate_m if set_name == "real" else None
    if base is None or not is_known(base.ate_m):
        return None
    if set_name == "real-stamps":
        return ALTERED_STAMPS_ATE * base.ate_m
    if set_name == "real-no-odometry":
        return max(AS_GOOD * base.ate_m, drive.ate_m or 0.0)
    return ALTERED_ATE * base.ate_m if set_name in ("indoor-ways", "simulated-ways", "ways") else None


def seconds_limit(set_name, row, base, outcome):
    if set_name == "real" or (set_name in ("real-stamps", "real-no-odometry") and not row.is_base):
        return SECONDS_A_SCAN * outcome.scans + SECONDS
    if row.way and base is not None and base.seconds() is not None and set_name in ("indoor-ways", "simulated-ways", "ways"):
        return ALTERED_TIME * base.seconds() + ALTERED_TIME_S
    return None


def misses_ate(set_name, row, base, outcome):
    limit_m = ate_limit(set_name, row, base)
    return limit_m is not None and not (is_known(outcome.ate_m) and round(outcome.ate_m, 3) <= round(limit_m, 3))


def is_within_covariance(set_name, row, base, outcome):
    """Whether a row over its limit of the ATE is as wanted all the same: the way takes information about the pose away, the published
    covariance says by how much (NEES of relative poses), and no two places became one."""
    way = ways.BY_NAME.get(row.way)
    if set_name != "simulated-ways" or outcome.state != "ended" or way is None or not way.takes_information:
        return False
    nees = outcome.figures.get("nees")
    return misses_ate(set_name, row, base, outcome) and is_known(outcome.ate_m) and not outcome.joined and \
        is_known(nees) and HONEST_NEES[0] <= nees <= HONEST_NEES[1]


def faults(set_name, row, base, outcome):
    """Each limit that the row misses, in words. Rows to compare with have none, except where their set says so."""
    if outcome.state != "ended":
        return [outcome.detail]
    found = [outcome.detail] if outcome.detail else []
    if misses_ate(set_name, row, base, outcome) and not is_within_covariance(set_name, row, base, outcome):
        if not (set_name == "real-no-odometry" and outcome.says_lost):
            found.append(f"ATE over {ate_limit(set_name, row, base):.3f} m")
    limit_s = seconds_limit(set_name, row, base, outcome)
    if limit_s is not None and outcome.seconds() > limit_s:
        found.append(f"over {limit_s:.1f} s")
    if set_name == "real":
        if is_known(outcome.scan_ms) and outcome.scan_ms > SCAN_MS:
            found.append(f"a scan over {SCAN_MS:.0f} ms")
        if is_known(outcome.closing_ms) and outcome.closing_ms > CLOSING_MS:
            found.append(f"a closing over {CLOSING_MS:.0f} ms")
    if set_name == "simulated-ways" and row.way and base is not None:
        hota, hota_of_base = outcome.figures.get("hota"), base.figures.get("hota")
        if hota_of_base and not (hota is not None and hota >= LEAST_HOTA * hota_of_base):
            found.append(f"HOTA under {LEAST_HOTA * hota_of_base:.3f}")
    if set_name in ("simulated-ways", "look-alike") and outcome.joined:
        found.append(f"{outcome.joined} pairs of places falsely joined")
    if set_name in ("no-odometry-nees", "quick-ways"):
        nees = outcome.figures.get("nees")
        low, high = NEES_BAND[set_name]
        if not (nees is not None and low <= nees <= high):
            found.append(f"NEES outside {low:g} to {high:g}")
    return found


def mean(values):
    values = [value for value in values if is_known(value)]
    return statistics.fmean(values) if values else math.nan


def with_error(values):
    values = [value for value in values if is_known(value)]
    if len(values) < 2:
        return f"{mean(values):.3f}"
    return f"{mean(values):.3f} ± {statistics.stdev(values) / math.sqrt(len(values)):.3f}"


def paired(now, before):
    """Mean difference with its standard error; NaN and infinity where there are not two pairs."""
    pairs = [(b, a) for a, b in zip(now, before) if is_known(a) and is_known(b)]
    if len(pairs) < 2:
        return math.nan, math.inf
    return difference(*zip(*pairs))


def by_drive(results):
    groups = {}
    for row, outcome, before in results:
        groups.setdefault(row.drive.scenario or row.drive.name, []).append((row, outcome, before))
    return groups


def summary(set_name, results, missed):
    """Sentences on the whole set, and whether one of them says that it fails. results: (row, outcome, outcome of the other binary)."""
    sentences, fails = [], False
    judged = [row for row, _, _ in results if not row.is_base or set_name in QUICK_SETS]
    as_wanted = [row for row in judged if not missed[row.name()]]
    of_row = {row.name(): outcome for row, outcome, _ in results}
    by_covariance = sum(is_within_covariance(set_name, row, of_row.get(row.base()), of_row[row.name()]) for row in as_wanted)
    sentences.append(f"{len(as_wanted)} of {len(judged)} rows as wanted" + (f", {by_covariance} of them by their covariance" if by_covariance else ""))
    if set_name == "real-no-odometry":
        bases = {row.name(): outcome for row, outcome, _ in results if row.is_base}
        rows = [(row, outcome) for row, outcome, _ in results if row.way]
        good = sum(is_known(outcome.ate_m) and outcome.state == "ended" and outcome.ate_m <= (ate_limit(set_name, row, bases.get(row.base())) or 0.0)
                   for row, outcome in rows)
        wanted = min(len(rows), math.ceil(len(rows) * 5 / 7))
        sentences.append(f"as good as with odometry on {good} of {len(rows)}, wanted {wanted}")
        fails = good < wanted
    if set_name == "mean-of-8":
        for name, group in by_drive(results).items():
            ate, drift = ([outcome.ate_m for _, outcome, _ in group], [outcome.figures.get("online_drift_m") for _, outcome, _ in group])
            hota = [outcome.figures.get("hota") for _, outcome, _ in group]
            sentences.append(f"{name}: ATE {with_error(ate)} m (wanted 0.045), drift of online.tum over 100 m {with_error(drift)} m (wanted 0.040), "
                             f"HOTA {with_error(hota)}")
            fails = fails or not (round(mean(ate), 3) <= 0.045 and round(mean(drift), 3) <= 0.040)
    if set_name == "seeds":
        for name, group in by_drive(results).items():
            nees = mean(outcome.figures.get("nees") for _, outcome, _ in group)
            low, high = NEES_BAND[set_name]
            sentences.append(f"{name}: ATE {with_error([outcome.ate_m for _, outcome, _ in group])} m, "
                             + ", ".join(f"{label} {with_error([outcome.figures.get(key) for _, outcome, _ in group])}"
                                         for label, key in (("HOTA", "hota"), ("IDF1", "idf1"), ("velocity", "velocity_mps")))
                             + f", NEES {nees:.2f} (wanted {low:g} to {high:g})")
            fails = fails or not low <= nees <= high
    if set_name == "look-alike":
        sentences.append(f"{sum(outcome.look_alike or 0 for _, outcome, _ in results)} pairs of places that look alike (wanted 200), "
                         f"{sum(outcome.joined or 0 for _, outcome, _ in results)} falsely joined (wanted 0)")
    if any(before is not None for _, _, before in results):
        groups = by_drive(results) if set_name in ("seeds", "mean-of-8") else {"all": results}
        for name, group in groups.items():
            more, worse = paired_summary(name, group)
            sentences += more
            fails = fails or (worse and set_name in ("seeds", "mean-of-8"))
    return sentences, fails


def paired_summary(name, results):
    """Differences to the other binary; worse is what is worse by more than two standard errors."""
    sentences, is_worse = [], False
    for label, figure, sign in (("ATE [m]", lambda outcome: outcome.ate_m, 1), ("seconds", lambda outcome: outcome.seconds(), 1),
                                ("HOTA", lambda outcome: outcome.figures.get("hota"), -1), ("IDF1", lambda outcome: outcome.figures.get("idf1"), -1),
                                ("velocity [m/s]", lambda outcome: outcome.figures.get("velocity_mps"), 1)):
        pairs = [(figure(outcome), figure(before)) for _, outcome, before in results if before is not None]
        change, error = paired([pair[0] for pair in pairs], [pair[1] for pair in pairs])
        if math.isfinite(change):
            worse = sign * change > 2 * error
            sentences.append(f"{name} against the other binary: {label} {change:+.4f} ± {error:.4f}" + (" (worse)" if worse else ""))
            is_worse = is_worse or worse
    return sentences, is_worse
