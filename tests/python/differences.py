"""How far the slip and the shear of runs along the centre line differ, one run from the next.

    python tests/python/differences.py [--plot FILE.png] [--json] RUN RUN ...

Takes 1.401 to 1.449 ms (docs/verdict.md), the bar's nodes on y = 0 or nearest it with y > 0, and a grid that moves with the
disk (-7 to 7 mm); records are interpolated to 97 instants. Prints per run the largest slip speed, its mean, the mean over
the grid of its standard deviation in time, and the share of its rms that fluctuates; and how much of the slip
alternates from node to node, over the whole patch: the rms of (s1 - s2 + s3 - s4)/4 over the faces in contact, over the
rms of s at their nodes. It is the amplitude of the hourglass mode of the elements below. Then for successive runs the rms difference over the rms of the second: over place and time, and of the means in time. --plot draws
the slip speed: mean in time, and a band of one standard deviation. --json prints the same numbers as one JSON document.
"""

import argparse
import json
import tomllib
from pathlib import Path

import h5py
import numpy as np

GRID = np.linspace(-7e-3, 7e-3, 141)
TIMES = np.linspace(1.401e-3, 1.449e-3, 97)
MARGIN = 1e-6


def profiles(run):
    """Slip speed (m/s) and shear (Pa), one row per time of TIMES, one column per point of GRID."""
    speed = tomllib.loads((run / "case.toml").read_text())["drive"]["speed"]
    with h5py.File(run / "contact.vtkhdf") as file:
        root = file["VTKHDF"]
        steps, data = root["Steps"], root["PointData"]
        points = root["Points"][:]
        side = points[:, 1][points[:, 1] > -1e-9].min()
        line = np.abs(points[:, 2]) < 1e-9
        line &= np.abs(points[:, 1] - side) < 1e-9
        times, slip, shear = [], [], []
        for k, time in enumerate(steps["Values"][:]):
            if not TIMES[0] - MARGIN <= time <= TIMES[-1] + MARGIN:
                continue

            def field(name):
                begin = steps["PointDataOffsets"][name][k]
                return data[name][begin : begin + len(points)][line]

            times.append(time)
            x = points[line, 0] + field("displacement")[:, 0] - speed * time
            order = np.argsort(x)
            for name, rows in (("slip_velocity", slip), ("shear", shear)):
                size = np.linalg.norm(field(name), axis=1)
                rows.append(np.interp(GRID, x[order], size[order]))
    return [
        np.stack([np.interp(TIMES, times, column) for column in np.array(rows).T], axis=1)
        for rows in (slip, shear)
    ]


def rms(values):
    return np.sqrt((values**2).mean())


def alternating(run):
    """Amplitude of slip that alternates from node to node over all slip, on the side where the conditions are enforced."""
    with h5py.File(run / "contact.vtkhdf") as file:
        root = file["VTKHDF"]
        steps, data = root["Steps"], root["PointData"]
        side = file.attrs.get("enforced_on", "disk")
        side = side.decode() if isinstance(side, bytes) else side
        faces = root["Connectivity"][:].reshape(-1, 4)
        faces = faces[root["CellData"]["body"][: len(faces)].ravel() == ["disk", "bar"].index(side)]
        nodes = len(root["Points"])
        squares = np.zeros(2)
        for k, time in enumerate(steps["Values"][:]):
            if not TIMES[0] - MARGIN <= time <= TIMES[-1] + MARGIN:
                continue
            begin = steps["PointDataOffsets"]["slip_velocity"][k]
            slip = data["slip_velocity"][begin : begin + nodes][faces]
            touching = (data["state"][begin : begin + nodes].ravel()[faces] > 0).all(axis=1)
            signs = np.array([1.0, -1.0, 1.0, -1.0])[:, None]
            mode = (slip[touching] * signs).sum(axis=1) / 4
            squares += (mode**2).sum(), (slip[touching] ** 2).sum() / 4
    return np.sqrt(squares[0] / squares[1])


def draw(path, runs, found):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 3.2), layout="constrained")
    colours = pyplot.get_cmap("viridis")(np.linspace(0, 0.85, len(runs)))
    for run, (slip, _), colour in zip(runs, found, colours):
        mean, deviation = slip.mean(axis=0), slip.std(axis=0)
        axes.plot(1e3 * GRID, mean, color=colour, label=run.name)
        low = np.maximum(mean - deviation, 0)
        axes.fill_between(1e3 * GRID, low, mean + deviation, color=colour, alpha=0.2, linewidth=0)
    axes.set(xlabel="x from the disk's axis (mm)", ylabel="slip speed (m/s)", ylim=(0, None))
    axes.legend(frameon=False)
    figure.savefig(path, dpi=150)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("runs", nargs="+", type=Path)
    parser.add_argument("--plot", type=Path)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    runs = options.runs
    found = [profiles(run) for run in runs]
    if options.plot:
        draw(options.plot, runs, found)
    statistics = [dict(run=run.name, **of_run(run, slip)) for run, (slip, _) in zip(runs, found)]
    for i in range(len(runs) - 1):
        statistics[i]["next"] = dict(run=runs[i + 1].name, **of_pair(found[i], found[i + 1]))
    if options.json:
        print(json.dumps(statistics, indent=2))
        return
    for one in statistics:
        print(
            f"{one['run']}: |s| up to {one['largest']:.2f}, mean {one['mean']:.4f}, sd in time"
            f" {one['deviation']:.4f} m/s, fluctuating share {one['share']:.2f}, alternating"
            f" {one['alternating']:.2f}"
        )
    for one in statistics[:-1]:
        next = one["next"]
        print(
            f"{one['run']} -> {next['run']}: |s| {next['slip']:.2f}, shear {next['shear']:.3f};"
            f" means in time: |s| {next['mean_slip']:.2f}, shear {next['mean_shear']:.3f}"
        )


def of_run(run, slip):
    """Statistics of a run's slip speed (m/s)."""
    return {
        "largest": float(slip.max()),
        "mean": float(slip.mean()),
        "deviation": float(slip.std(axis=0).mean()),
        "share": float(rms(slip - slip.mean(axis=0)) / rms(slip)),
        "alternating": float(alternating(run)),
    }


def of_pair(one, other):
    """By how much two runs differ, over the rms of the second."""
    both = list(zip(one, other))
    local = [rms(a - b) / rms(b) for a, b in both]
    means = [rms(a.mean(axis=0) - b.mean(axis=0)) / rms(b.mean(axis=0)) for a, b in both]
    names = ("slip", "shear", "mean_slip", "mean_shear")
    return {name: float(value) for name, value in zip(names, local + means)}


if __name__ == "__main__":
    main()
