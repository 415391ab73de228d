"""One short drive: GNSS with multipath and a compass near iron do not make the trajectory worse; with an open sky the map knows where it
is; the drive is found in the street graph."""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import drives

DURATION_S = 75.0


def main():
    slammot = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        drive = drives.simulate(slammot, 4, pathlib.Path(folder), DURATION_S)
        without, disturbed = drives.run(slammot, drive, "without"), drives.run(slammot, drive, "both")
        assert drives.georeference_of(without) is None, "without sensors the report tells a place"
        without_m, with_m = drives.ate_m(drive, without), drives.ate_m(drive, disturbed)
        assert with_m <= without_m + 0.005, f"ATE {with_m:.3f} m with GNSS and compass, {without_m:.3f} m without"
        clear = drives.run(slammot, drive, "clean")
        place = drives.georeference_of(clear)
        first = drives.poses_of(disturbed / "trajectory.tum")[0]
        true = next(pose for pose in drive.truth if abs(pose[0] - first[0]) < 1e-5)
        found = drives.placed(place["origin_latitude_deg"], place["origin_longitude_deg"], place["x_from_east_rad"], first[1:3])
        assert math.dist(found, true[1:3]) < 8.0, f"the map's origin is {math.dist(found, true[1:3]):.1f} m off"
        assert "geo_origin: [" in (disturbed / "map.yaml").read_text(encoding="utf-8")
        output = pathlib.Path(folder) / "streets"
        subprocess.run([slammot, "run", "--input", drives.altered(drive, "both"), "--quiet", "--no-report", "--output", output, "--streets",
                        drives.streets_of(slammot, drive)], check=True)
        streets = json.loads((output / "report.json").read_text(encoding="utf-8"))["streets"]
        assert streets["verdict"] == "located", streets["conclusion"]
        best = streets["places"][0]
        at = drives.placed(best["map_origin_latitude_deg"], best["map_origin_longitude_deg"], best["x_from_east_rad"], first[1:3])
        assert math.dist(at, true[1:3]) < 10.0, f"found {math.dist(at, true[1:3]):.1f} m off"
        print(f"ATE {without_m:.3f} m without, {with_m:.3f} m with; {place['conclusion']}; streets: {streets['conclusion']}")


if __name__ == "__main__":
    main()
