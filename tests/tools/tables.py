"""What commands share that write tables of results into a page."""

import re


def seeds_in(text):
    """The numbers of "1-3,7"."""
    seeds = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        seeds.extend(range(int(first), int(last or first) + 1))
    return seeds


def replaced_between(begin, end, page, text):
    """The page with the text between these two lines."""
    if begin not in page or end not in page:
        raise SystemExit(f"the page lacks the lines {begin} and {end}")
    return re.sub(re.escape(begin) + r".*?" + re.escape(end), lambda _: f"{begin}\n{text}\n{end}", page, count=1, flags=re.DOTALL)
