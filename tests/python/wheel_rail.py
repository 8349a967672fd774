"""A wheel on a rail by finite elements and by half-spaces: forces in the plane of contact.

    python tests/python/wheel_rail.py OUT.json HALF-SPACES ELEMENTS

Both are sweeps over disk.lateral. The forces of elements, along y and z, are turned by the
angle of the plane of contact; those of half-spaces lie in it.
"""

import json
import math
import pathlib
import sys


def rows(name, sweep, turned):
    for run in json.loads((sweep / "sweep.json").read_text())["runs"]:
        if run["status"] != "completed":
            continue
        lateral = run["parameters"]["disk.lateral"]
        contact = run["summary"]["contact"]
        angle = run["summary"]["position"]["plane_angle"] if turned else 0.0
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


def main(table, half_spaces, elements):
    found = [*rows("half-spaces", pathlib.Path(half_spaces), False)]
    found += rows("elements", pathlib.Path(elements), True)
    found.sort(key=lambda row: (row["lateral"], row["bodies"] == "elements"))
    pathlib.Path(table).write_text(json.dumps(found, indent=1))
    for row in found:
        print(json.dumps(row))


if __name__ == "__main__":
    main(*sys.argv[1:])
