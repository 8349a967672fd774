"""A wheel on a rail by finite elements and by half-spaces: forces in the plane of contact.

    python tests/python/wheel_rail.py OUT.json HALF-SPACES ELEMENTS

Both are sweeps over disk.lateral. The forces of elements, along y and z, are turned by the
angle of the plane of contact that `creepage mesh` prints.
"""

import json
import math
import pathlib
import subprocess
import sys


def rows(name, sweep, plane):
    for run in json.loads((sweep / "sweep.json").read_text())["runs"]:
        if run["status"] != "completed":
            continue
        lateral = run["parameters"]["disk.lateral"]
        contact = run["summary"]["contact"]
        angle = plane(sweep / run["run"])
        y, z = contact["lateral_force"], contact["normal_force"]
        normal = z * math.cos(angle) - y * math.sin(angle)
        yield {
            "bodies": name,
            "lateral": lateral,
            "peak_pressure": contact["peak_pressure"],
            "area": contact["patch_area"],
            "normal": normal,
            "longitudinal": contact["tangential_force"] / normal,
            "across": (y * math.cos(angle) + z * math.sin(angle)) / normal,
        }


def angle_of(run):
    command = ["creepage", "mesh", "--json", str(run / "case.toml")]
    out = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return json.loads(out)["position"]["plane_angle"]


def main(table, half_spaces, elements):
    # results of half-spaces are those in the plane of contact
    found = [*rows("half-spaces", pathlib.Path(half_spaces), lambda run: 0.0)]
    found += rows("elements", pathlib.Path(elements), angle_of)
    found.sort(key=lambda row: (row["lateral"], row["bodies"] == "elements"))
    pathlib.Path(table).write_text(json.dumps(found, indent=1))
    for row in found:
        print(json.dumps(row))


if __name__ == "__main__":
    main(*sys.argv[1:])
