#!/usr/bin/env python3
"""Reads the tree's include lines and refuses what the layout forbids (docs/architecture.md, "Rings").

System headers are visible to every file, so the compiler does not keep a clock out of an estimator or the bus out
of a matcher; this does. Usage: structure.py [ROOT]. Prints one line a fault and exits 1 when there is any.
"""

import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ALGORITHM_FOLDERS = {"geometry", "sensing", "flow", "memory", "work", "grids", "matching", "filters", "association", "graphs",
                     "simulation", "streets", "metrics", "city_model", "traffic", "stages"}
# Their own code is pure; ingest and map_store do nothing but carry data, so they are shell throughout.
ALGORITHM_SERVICES = {"localization", "detection", "tracking", "loop_closing", "collision_warning"}
# Where a service joins the rings.
JOINING_FILE = re.compile(r"(_service(_[a-z]+)?|_fields)\.(hpp|cpp)$|(^|/)main\.cpp$")
COMPOSER = "services/slammot"
PROGRAMS = ("services/", "examples/")

BUS_FOLDERS = {"common/dds", "common/wire"}
BUS_TESTS = ("tests/unit/common/dds/", "tests/unit/common/wire/", "tests/integration/", "tests/fuzz/")
BUS_HEADER = re.compile(r"^(dds/|ddsc/|idl/).*\.h$|^dds/")

PURE_STANDARD_HEADERS = {
    "algorithm", "any", "array", "bit", "bitset", "cassert", "cfloat", "charconv", "climits", "cmath", "compare",
    "complex", "concepts", "cstddef", "cstdint", "cstdlib", "cstring", "deque", "exception", "expected", "format",
    "forward_list", "functional", "initializer_list", "iterator", "limits", "list", "map", "memory", "new", "numbers",
    "numeric", "optional", "ostream", "queue", "random", "ranges", "ratio", "set", "span", "sstream", "stack",
    "stdexcept", "string", "string_view", "tuple", "type_traits", "typeinfo", "unordered_map", "unordered_set",
    "utility", "valarray", "variant", "vector", "version", "iosfwd"}
IMPURE_CALLS = re.compile(r"\b(std::random_device|std::chrono::\w+_clock|std::(?:this_thread|jthread|thread|cout|cerr)"
                          r"|getenv\s*\(|printf\s*\(|(?<![\w.>:])s?rand\s*\(|std::time\s*\()")

SOMEONES_PATH = re.compile(r"(?<![\w.$}\-])/(?:home|Users|work|tmp)/\w")
MAIN_LINES = 30


@dataclass(frozen=True)
class Source:
    path: str  # From the root, with '/'.
    text: str

    @property
    def folder(self):
        return self.path.rsplit("/", 1)[0]

    def includes(self):
        """(line number, header, quoted) of each include line."""
        for number, line in enumerate(self.text.splitlines(), 1):
            match = re.match(r'\s*#\s*include\s*([<"])([^>"]+)[>"]', line)
            if match:
                yield number, match.group(2), match.group(1) == '"'


def without_comments(code):
    """The same number of lines with comments blanked."""
    blank = lambda match: re.sub(r"[^\n]", " ", match.group(0))
    return re.sub(r"//[^\n]*|/\*.*?\*/", blank, code, flags=re.S)


def is_algorithm(path):
    parts = path.split("/")
    if parts[0] == "common":
        return parts[1] in ALGORITHM_FOLDERS
    if JOINING_FILE.search(path):
        return False
    return parts[0] == "examples" or (parts[0] == "services" and parts[1] in ALGORITHM_SERVICES)


def fault_of_algorithm_include(source, header, quoted):
    if quoted:
        if header.startswith(PROGRAMS):
            own = program_of(header) == program_of(source.path)
            return None if own and is_algorithm(header) else "the algorithm ring includes a service's shell"
        return None if is_algorithm(header) else "the algorithm ring includes the shell ring"
    if header.startswith("Eigen/") or header in PURE_STANDARD_HEADERS:
        return None
    if header.startswith("ceres/"):
        return None if source.path.startswith("common/graphs/") else "a solver outside common/graphs"
    return "not for the algorithm ring: standard values and algorithms, Eigen and (in graphs) Ceres only"


def program_of(path):
    """services/tracking of services/tracking/tracker.hpp."""
    return "/".join(path.split("/")[:2])


def fault_of_program_include(source, header):
    """header: of a service or of an example."""
    if source.path.startswith("common/"):
        return "common includes a service" if header.startswith("services/") else "common includes an example"
    if source.path.startswith(PROGRAMS) and program_of(source.path) not in (program_of(header), COMPOSER):
        return "a service or an example includes another one"
    return None


def sees_the_bus(source):
    return source.folder in BUS_FOLDERS or source.path.startswith(BUS_TESTS)


def fault_of_include(source, header, quoted, root):
    if header.startswith(PROGRAMS):
        fault = fault_of_program_include(source, header)
        if fault:
            return fault
    generated = quoted and header.endswith(".h") and not header.endswith(".pb.h")
    if (BUS_HEADER.match(header) or generated) and not sees_the_bus(source):
        return "the bus' C API outside common/dds and common/wire"
    if quoted and header.endswith(".hpp") and not (root / header).is_file():
        return "not a file of this tree: includes are written from its top"
    if is_algorithm(source.path):
        return fault_of_algorithm_include(source, header, quoted)
    return None


def include_faults(source, root):
    for number, header, quoted in source.includes():
        fault = fault_of_include(source, header, quoted, root)
        if fault:
            yield f"{source.path}:{number}: {fault}: {header}"


def impurity_faults(source):
    if not is_algorithm(source.path):
        return
    for number, line in enumerate(without_comments(source.text).splitlines(), 1):
        match = IMPURE_CALLS.search(line)
        if match:
            yield f"{source.path}:{number}: hidden randomness, clock, thread or output in the algorithm ring: {match.group(0)}"


def main_faults(source):
    lines = len(source.text.splitlines())
    if re.fullmatch(r"(services|examples)/\w+/main\.cpp", source.path) and lines >= MAIN_LINES:
        yield f"{source.path}:1: {lines} lines; a main that tests do not share stays under {MAIN_LINES}"


def idl_faults(source):
    code = without_comments(source.text)
    for match in re.finditer(r"((?:@\w+(?:\([^)]*\))?\s*)*)\b(struct|union)\s+(\w+)([^{;]*)\{([^}]*)", code):
        annotations, kind, name, _, body = match.groups()
        number = code.count("\n", 0, match.start(2)) + 1
        if not re.search(r"@(final|appendable|mutable)\b", annotations):
            yield f"{source.path}:{number}: {kind} {name} has no explicit extensibility (@final or @appendable)"
        if "@key" in body and not re.match(r"\s*@key\s+string<32>\s+vehicle_id\s*;", body):
            yield f"{source.path}:{number}: {name} is keyed, so its first member is '@key string<32> vehicle_id'"


def path_faults(source):
    for number, line in enumerate(source.text.splitlines(), 1):
        match = SOMEONES_PATH.search(line)
        if match:
            yield f"{source.path}:{number}: an absolute path of somebody's machine: {line.strip()[:80]}"


def link_faults(source, root):
    """Links of a page to files of this tree lead somewhere."""
    for number, line in enumerate(source.text.splitlines(), 1):
        for target in re.findall(r"\]\(([^)#\s]+)", line):
            if ":" not in target and not (root / source.path).parent.joinpath(target).exists():
                yield f"{source.path}:{number}: a link to nothing: {target}"


def ring_faults(source):
    """The libraries that CMake builds and installs as the algorithm ring are those that are checked as such here."""
    listed = re.search(r"# The algorithm ring.*\nforeach\(folder ([^)]+)\)", source.text)
    if not listed:
        yield f"{source.path}: the list of the algorithm ring is not found"
    elif set(listed.group(1).split()) != ALGORITHM_FOLDERS:
        different = sorted(set(listed.group(1).split()) ^ ALGORITHM_FOLDERS)
        yield f"{source.path}: not the algorithm ring of tests/structure: {', '.join(different)}"


def tree_faults(sources, root):
    programs = {program_of(source.path) for source in sources if re.fullmatch(r"(services|examples)/\w+/.+", source.path)}
    for program in sorted(programs):
        if not (root / program / "README.md").is_file():
            yield f"{program}: has no README.md"
    for source in sources:
        if source.path.startswith("tests/unit/") and source.path.endswith("_test.cpp"):
            mirrored = "/".join(source.path.split("/")[2:4])  # Below it a test may have folders of its own.
            if not (root / mirrored).is_dir():
                yield f"{source.path}:1: tests/unit mirrors the code, and there is no folder {mirrored}"


def faults_of(sources, root):
    """Every fault of the given sources, as 'path:line: what'."""
    for source in sources:
        if source.path.endswith((".hpp", ".cpp")):
            yield from include_faults(source, root)
            yield from impurity_faults(source)
            yield from main_faults(source)
        if source.path.endswith(".idl"):
            yield from idl_faults(source)
        if source.path.endswith(".md"):
            yield from link_faults(source, root)
        if source.path == "common/CMakeLists.txt":
            yield from ring_faults(source)
        yield from path_faults(source)
    yield from tree_faults(sources, root)


def tracked_sources(root):
    """Text files that git tracks or would (not ignored); outside of a checkout, all files but build and out."""
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            capture_output=True, check=False)
    if listed.returncode == 0:
        names = sorted(filter(None, listed.stdout.decode().split("\0")))
    else:
        names = sorted(str(path.relative_to(root)) for path in root.rglob("*")
                       if path.relative_to(root).parts[0] not in ("build", "out", ".git"))
    for name in names:
        path = root / name
        if path.is_file():
            try:
                yield Source(name, path.read_text(encoding="utf-8"))
            except UnicodeDecodeError:
                continue  # A picture or another binary.


def main(arguments):
    root = Path(arguments[1] if len(arguments) > 1 else Path(__file__).parents[2]).resolve()
    sources = list(tracked_sources(root))
    faults = list(faults_of(sources, root))
    for fault in faults:
        print(fault)
    print(f"{len(sources)} files read, {len(faults)} faults")
    return 1 if faults or not sources else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
