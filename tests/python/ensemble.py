"""Do runs on one grid differ as grids do? Ensembles whose members differ in load and step.

    python tests/python/ensemble.py OUT.json SWEEP...

A row for each law and grid: means over the members with half their 95 % confidence interval (Student), the share of slip that
fluctuates in a band fixed in space and in one fixed in elements, and the differences of `creepage compare` in |s|: of the first
member from each other one on this grid, and of each member from the same member on the next grid.
"""

import json
import pathlib
import subprocess
import sys

import numpy as np

MEMBERS = ("load.normal", "time.factor")
SIZE = "mesh.zone.size"
STUDENT = {2: 12.71, 3: 4.303, 4: 3.182, 5: 2.776, 6: 2.571, 7: 2.447, 8: 2.365}
STATISTICS = ("mean", "fluctuation", "fluctuating_share", "fluctuating_share_of_elements", "largest")


def grids(sweep):
    """The completed runs by law, grid (coarse to fine) and member."""
    found = {}
    for run in json.loads((sweep / "sweep.json").read_text())["runs"]:
        parameters = run["parameters"]
        law = tuple((k, v) for k, v in parameters.items() if k not in (*MEMBERS, SIZE))
        member = tuple(parameters[key] for key in MEMBERS if key in parameters)
        if run["status"] == "completed":
            found.setdefault(law, {}).setdefault(parameters[SIZE], {})[member] = run
    return {law: dict(sorted(of.items(), reverse=True)) for law, of in found.items()}


def differences(sweep, pairs):
    """[place and time, means] of |s| for each pair of runs."""
    runs = [str(sweep / run["run"]) for pair in pairs for run in pair]
    out = subprocess.run(["creepage", "compare", "--json", *runs], check=True, capture_output=True, text=True)
    every_other = json.loads(out.stdout)["differences"][::2]
    return np.array([[d["slip"]["place_and_time"], d["slip"]["means"]] for d in every_other])


def interval(values):
    """Mean and half of its 95 % confidence interval."""
    values = np.array(values)
    return [float(values.mean()), float(STUDENT[len(values)] * values.std(ddof=1) / np.sqrt(len(values)))]


def mean(pairs):
    return dict(zip(("mean", "of_means"), map(float, pairs.mean(axis=0))))


def main(table, *sweeps):
    rows = []
    for sweep in map(pathlib.Path, sweeps):
        for law, of in grids(sweep).items():
            sizes = list(of)
            for i, (size, members) in enumerate(of.items()):
                runs = list(members.values())
                zones = [run["check"]["slip_zone"] for run in runs]
                row = {"law": dict(law), "size": size, "members": len(runs)}
                row["traction"] = interval([run["summary"]["contact"]["traction_coefficient"] for run in runs])
                row |= {name: interval([zone[name]["value"] for zone in zones]) for name in STATISTICS}
                row["on_one_grid"] = mean(differences(sweep, [(runs[0], run) for run in runs[1:]]))
                finer = of[sizes[i + 1]] if i + 1 < len(sizes) else {}
                pairs = [(run, finer[member]) for member, run in members.items() if member in finer]
                if pairs:
                    row["to_next"] = mean(differences(sweep, pairs))
                rows.append(row)
    pathlib.Path(table).write_text(json.dumps(rows, indent=1))
    for row in rows:
        print(json.dumps(row))


if __name__ == "__main__":
    main(*sys.argv[1:])
