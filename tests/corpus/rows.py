"""Drives, rows (a drive altered in one way, with one setting) and the named sets of rows."""

import dataclasses
import os
import pathlib
import tomllib

import carmen_drive
import ways

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parents[1]
STAMP_WAYS = ("stamps-zero", "stamps-index", "stamps-seconds")
QUICK_WAYS = ("way-1.3", "noise-5cm")
TOO_LITTLE_SEEN = ("range-8m",)  # in a street
SIMULATED_SCENARIOS = ("block", "office", "demo")
THREE_SEEDS = (11, 12, 13)
INDOOR_SCENARIOS = ("office", "corridor")
RANGE_NOISES_M = tuple(0.0288 + index * (0.0312 - 0.0288) / 7 for index in range(8))


@dataclasses.dataclass(frozen=True)
class Drive:
    name: str
    prefix: str = ""       # of the log; empty: it is simulated from the scenario
    scenario: str = ""
    seed: int = 0
    indoors: bool = True
    simulated: bool = False  # has objects
    ate_m: float = None
    best_ate_m: float = None
    quick_ate_m: float = None

    def is_present(self):
        if not self.prefix:
            return True
        try:
            carmen_drive.log_of(self.prefix)
        except FileNotFoundError:
            return False
        return True


@dataclasses.dataclass(frozen=True)
class Row:
    drive: Drive
    way: str = ""          # "": as it was driven
    config: str = ""       # text of a --config file
    variant: str = ""      # names the config
    is_base: bool = False  # only there for others to be compared with

    def name(self):
        return "-".join(filter(None, (self.drive.name, self.way, self.variant)))

    def base(self):
        return Row(self.drive).name()


def data_folder(given):
    return pathlib.Path(given or os.environ.get("SLAMMOT_DATA") or ROOT.parent / "shared" / "data")


def read_drives(path, data):
    with open(path, "rb") as file:
        entries = tomllib.load(file)["drive"]
    known = {field.name for field in dataclasses.fields(Drive)}
    drives = []
    for entry in entries:
        values = {key: value for key, value in entry.items() if key in known}
        drives.append(Drive(prefix=str(data / entry["log"]), **values))
    return drives


def simulated(scenario, seed):
    return Drive(f"{scenario}-{seed}", scenario=scenario, seed=seed, indoors=scenario in INDOOR_SCENARIOS, simulated=True)


def real(drives):
    return [drive for drive in drives if not drive.simulated]


def named(drives, names):
    return [drive for drive in drives if drive.name in names]


def altered(drives, names_of):
    """Each drive as it was driven, to compare with, and in each of its ways."""
    return [row for drive in drives for row in
            (Row(drive, is_base=True), *(Row(drive, way) for way in names_of(drive)))]


def standard_ways(drive):
    return ways.standard_names(drive.indoors)


def indoor_three(drives):
    return named(drives, ("intel", "aces", "freiburg-101"))


def quick_simulated():
    return [dataclasses.replace(simulated("block", 12), quick_ate_m=0.06)]


def recorded_simulated(drives):
    return [drive for drive in drives if drive.simulated]


def seeds_of(scenarios, seeds):
    return [simulated(scenario, seed) for scenario in scenarios for seed in seeds]


def mean_of_8(drives):
    return [Row(drive, config=f"tracking {{ range_noise_m: {noise_m:.6f} }}\n", variant=f"noise{index}")
            for drive in recorded_simulated(drives) for index, noise_m in enumerate(RANGE_NOISES_M)]


SETS = {
    "real": lambda drives: [Row(drive) for drive in real(drives)],
    "real-stamps": lambda drives: altered(real(drives), lambda drive: STAMP_WAYS),
    "real-no-odometry": lambda drives: altered(real(drives), lambda drive: ("none",)),
    "indoor-ways": lambda drives: altered(indoor_three(drives), standard_ways),
    "simulated-ways": lambda drives: altered(recorded_simulated(drives) + seeds_of(SIMULATED_SCENARIOS, THREE_SEEDS), standard_ways),
    "mean-of-8": mean_of_8,
    "seeds": lambda drives: [Row(drive) for drive in seeds_of(("city", "quiet", "block"), range(201, 221))],
    "no-odometry-nees": lambda drives: [Row(drive, "none") for drive in
                                        recorded_simulated(drives) + seeds_of(("block", "office"), THREE_SEEDS)],
    "look-alike": lambda drives: [Row(drive, way) for drive in seeds_of(("office", "corridor"), range(301, 309)) + seeds_of(("block",), range(301, 305))
                                  for way in ("", "range-5m")],
    "quick": lambda drives: altered(indoor_three(drives), lambda drive: QUICK_WAYS),
    "quick-ways": lambda drives: altered(quick_simulated(), lambda drive: [way for way in standard_ways(drive) if way not in TOO_LITTLE_SEEN]),
    "ways": lambda drives: altered(drives, standard_ways),  # for --ways
}
QUICK_SETS = ("quick", "quick-ways")  # for ctest, with limits of their own
SETS_OF_WANTED = [name for name in SETS if name not in (*QUICK_SETS, "ways")]
