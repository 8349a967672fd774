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
STUDENT = {2: 12.71, 4: 3.182, 8: 2.365}
STATISTICS = ("mean", "fluctuation", "fluctuating_share", "fluctuating_share_of_elements", "largest")


def grids(sweep):
    """The completed runs by law and grid, coarse to fine; members in the order of the sweep."""
    found = {}
    for run in json.loads((sweep / "sweep.json").read_text())["runs"]:
        law = tuple((k, v) for k, v in run["parameters"].items() if k not in (*MEMBERS, SIZE))
        if run["status"] == "completed":
            found.setdefault(law, {}).setdefault(run["parameters"][SIZE], []).append(run)
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


def main(table, *sweeps):
    rows = []
    for sweep in map(pathlib.Path, sweeps):
        for law, of in grids(sweep).items():
            sizes = list(of)
            for i, (size, runs) in enumerate(of.items()):
                zones = [run["check"]["slip_zone"] for run in runs]
                row = {"law": dict(law), "size": size, "members": len(runs)}
                row["traction"] = interval([run["summary"]["contact"]["traction_coefficient"] for run in runs])
                row |= {name: interval([zone[name]["value"] for zone in zones]) for name in STATISTICS}
                on_one = differences(sweep, [(runs[0], run) for run in runs[1:]])
                row["on_one_grid"] = dict(zip(("mean", "most", "of_means"), (*on_one.mean(0)[:1], *on_one.max(0)[:1], on_one.mean(0)[1])))
                if i + 1 < len(sizes):
                    to_next = differences(sweep, list(zip(runs, of[sizes[i + 1]])))
                    row["to_next"] = {"mean": to_next.mean(0)[0], "of_means": to_next.mean(0)[1]}
                rows.append(row)
    pathlib.Path(table).write_text(json.dumps(rows, indent=1))
    for row in rows:
        print(json.dumps(row))


if __name__ == "__main__":
    main(*sys.argv[1:])
