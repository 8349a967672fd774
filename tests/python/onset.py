"""Where slip begins to fluctuate by itself: the runs of a sweep over the memory of friction.

    python tests/python/onset.py SWEEP OUT.png OUT.json

Runs that differ in friction.memory.distance, or friction.distance of rate and state, alone form a line. Left: the fluctuating
share of slip over Gamma; right: over the distance of memory by the one from which rolling is stable (numbers.stable_memory). The
onset is the distance at which the share is 0.3, between two runs along its logarithm. OUT.json: for each line its parameters,
onset (m), gamma and ratio there.
"""

import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

MEMORY = ("friction.memory.distance", "friction.distance")
SHARE = 0.3
MARKERS = "osD^v<>PX*hdp"


def lines(sweep):
    """The runs by their other parameters: distances (m), shares, and the numbers of the first run."""
    runs = json.loads((sweep / "sweep.json").read_text())["runs"]
    groups = {}
    for run in (run for run in runs if run["status"] == "completed"):
        others = tuple((key, value) for key, value in run["parameters"].items() if key not in MEMORY)
        (distance,) = (run["parameters"][key] for key in MEMORY if key in run["parameters"])
        share = run["check"]["slip_zone"]["fluctuating_share"]["value"]
        numbers = run["summary"]["numbers"]
        groups.setdefault(others, []).append((distance, share, numbers))
    for others, members in groups.items():
        members.sort(key=lambda member: member[0])
        distance, share, numbers = zip(*members)
        yield dict(others), np.array(distance), np.array(share), numbers[0]


def onset(distance, share):
    """The longest memory (m) at which the share crosses SHARE; None where it does not."""
    for i in range(len(share) - 2, -1, -1):
        if share[i] >= SHARE > share[i + 1]:
            part = (share[i] - SHARE) / (share[i] - share[i + 1])
            return float(distance[i] ** (1 - part) * distance[i + 1] ** part)
    return None


def main(sweep, picture, table):
    found = list(lines(pathlib.Path(sweep)))
    keys = list(found[0][0])
    nominal = {key: max({p[key] for p, *_ in found}, key=[p[key] for p, *_ in found].count) for key in keys}
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2), sharey=True)
    rows = []
    colours = plt.get_cmap("tab20").colors
    for (parameters, distance, share, numbers), colour, marker in zip(found, colours, MARKERS):
        named = {key: value if isinstance(value, str) else f"{value:g}" for key, value in parameters.items()}
        changed = [f"{key} = {value}" for key, value in named.items() if parameters[key] != nominal[key]]
        label = ", ".join(changed) or "the reference"
        # rate and state have no nucleation length of this kind
        gamma = (numbers["gamma"] or np.nan) * distance[0] / distance
        stable = numbers["stable_memory"]
        for axes, x in ((left, gamma), (right, distance / stable)):
            axes.semilogx(x, share, marker=marker, color=colour, lw=1, ms=5, label=label)
        at = onset(distance, share)
        rows.append({
            "name": label,
            "onset": at,
            "gamma": at and numbers["gamma"] and numbers["gamma"] * distance[0] / at,
            "stable_memory": stable,
            "ratio": at and at / stable,
        })
    left.set_xlabel("zone of slip over nucleation length, $\\Gamma$")
    right.set_xlabel("memory over that from which rolling is stable")
    left.set_ylabel("fluctuating share of slip")
    right.axvline(1.0, color="black", lw=0.8, ls="--")
    for axes, ticks in ((left, (1, 2, 4, 8)), (right, (0.3, 0.5, 1, 2, 4))):
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.minorticks_off()
        axes.grid(alpha=0.3)
    right.legend(fontsize=7, loc="upper right")
    figure.tight_layout()
    figure.savefig(picture, dpi=110)
    pathlib.Path(table).write_text(json.dumps(rows, indent=1))
    for row in rows:
        print(*row.values(), sep="\t")


if __name__ == "__main__":
    main(*sys.argv[1:4])
