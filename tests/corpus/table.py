"""The table of a set of rows, as markdown, and its place in a page."""

import math
import re

import verdict
from rows import QUICK_SETS


def metres(value):
    if value is None:
        return ""
    if not math.isfinite(value):
        return "-"
    return f"{value:.3f}" if value < 1 else f"{value:.2f}" if value < 10 else f"{value:.0f}"


def short(value, form=".1f"):
    return "" if value is None or not math.isfinite(value) else f"{value:{form}}"


def ate(outcome):
    """None of what did not end: it would be that of the drive's beginning."""
    return metres(outcome.ate_m) if outcome.state == "ended" else outcome.state


def seconds(outcome):
    return f"> {outcome.wall_s:.0f}" if outcome.state == "timeout" else short(outcome.seconds())


def where(outcome):
    if not outcome.first_off:
        return ""
    scan, off_m, off_rad = outcome.first_off
    share = f", {100 * outcome.off_share:.0f} % of the scans off by a metre" if outcome.off_share else ""
    return f"first off at scan {scan} ({off_m:.2f} m, {off_rad:.2f} rad){share}"


def found(set_name, outcome, row, base, faults):
    parts = list(faults)
    within_covariance = verdict.is_within_covariance(set_name, row, base, outcome)
    if within_covariance:
        parts.append(f"ATE over {verdict.ate_limit(set_name, row, base):.3f} m, as its covariance says")
    if (faults or within_covariance) and where(outcome):
        parts.append(where(outcome))
    if outcome.says_lost:
        parts.append("says lost")
    if outcome.says_way is False:
        parts.append("does not say so")
    if outcome.state == "ended" and outcome.localized is not None and outcome.localized < outcome.scans:
        parts.append(f"{outcome.scans - outcome.localized} of {outcome.scans} scans not localized")
    return "; ".join(parts)


def columns(set_name, has_figures, has_other):
    """(title, cell of (row, outcome, other binary's outcome, base, faults))."""
    chosen = [("drive", lambda r, o, b, base, f: r.drive.name), ("altered", lambda r, o, b, base, f: r.way or r.variant)]
    chosen.append(("ATE (m)", lambda r, o, b, base, f: ate(o)))
    if has_other:
        chosen.append(("ATE, other", lambda r, o, b, base, f: "" if b is None else ate(b)))
    chosen.append(("wanted", lambda r, o, b, base, f: metres(verdict.ate_limit(set_name, r, base))))
    if set_name == "real":
        chosen.append(("best", lambda r, o, b, base, f: metres(r.drive.best_ate_m)))
    chosen.append(("drift over 10 m", lambda r, o, b, base, f: metres(o.drift_m) if o.state == "ended" else ""))
    chosen.append(("s", lambda r, o, b, base, f: seconds(o)))
    if has_other:
        chosen.append(("s, other", lambda r, o, b, base, f: "" if b is None else seconds(b)))
    chosen.append(("wanted", lambda r, o, b, base, f: short(verdict.seconds_limit(set_name, r, base, o))))
    chosen.append(("MB", lambda r, o, b, base, f: short(o.peak_mb, ".0f")))
    chosen.append(("scan, most ms", lambda r, o, b, base, f: short(o.scan_ms, ".0f")))
    chosen.append(("closing, most ms", lambda r, o, b, base, f: short(o.closing_ms, ".0f")))
    if has_figures:
        chosen.append(("HOTA", lambda r, o, b, base, f: short(o.figures.get("hota"), ".3f")))
        if has_other:
            chosen.append(("HOTA, other", lambda r, o, b, base, f: "" if b is None else short(b.figures.get("hota"), ".3f")))
        chosen.append(("IDF1", lambda r, o, b, base, f: short(o.figures.get("idf1"), ".3f")))
        chosen.append(("NEES", lambda r, o, b, base, f: short(o.figures.get("nees"), ".2f")))
    if set_name == "look-alike":
        chosen.append(("look alike", lambda r, o, b, base, f: str(o.look_alike or 0)))
        chosen.append(("falsely joined", lambda r, o, b, base, f: "" if o.joined is None else str(o.joined)))
    chosen.append(("as wanted", lambda r, o, b, base, f: "no" if f else "" if r.is_base and set_name not in QUICK_SETS else "yes"))
    chosen.append(("what was found", lambda r, o, b, base, f: found(set_name, o, r, base, f)))
    return chosen


def text(set_name, results, faults):
    """results: (row, outcome, other binary's outcome or None); faults: by the row's name."""
    bases = {row.name(): outcome for row, outcome, _ in results if not row.way}
    has_figures = any(outcome.figures for _, outcome, _ in results)
    has_other = any(before is not None for _, _, before in results)
    chosen = columns(set_name, has_figures, has_other)
    lines = ["| " + " | ".join(title for title, _ in chosen) + " |", "|" + "---|" * len(chosen)]
    for row, outcome, before in results:
        cells = [cell(row, outcome, before, bases.get(row.base()), faults[row.name()]).replace("|", "/") for _, cell in chosen]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def markers(set_name):
    return f"<!-- corpus {set_name}: written by tests/corpus/run --set {set_name} --write -->", f"<!-- end of corpus {set_name} -->"


def page_with(page, set_name, section):
    """The page with what stands between the set's markers replaced; where it has none, they are put at the end of its section on the
    corpus, or of the page."""
    begin, end = markers(set_name)
    block = f"{begin}\n{section.strip()}\n{end}"
    pattern = re.compile(re.escape(f"<!-- corpus {set_name}:") + r".*?" + re.escape(end), re.DOTALL)
    if pattern.search(page):
        return pattern.sub(lambda match: block, page, count=1)
    heading = re.search(r"^## The corpus$", page, re.MULTILINE)
    if not heading:
        return page.rstrip() + f"\n\n## The corpus\n\n{block}\n"
    following = re.search(r"^## ", page[heading.end():], re.MULTILINE)
    at = heading.end() + following.start() if following else len(page)
    return page[:at].rstrip() + f"\n\n{block}\n" + (f"\n{page[at:]}" if following else "")
