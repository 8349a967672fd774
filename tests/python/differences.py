"""How far the slip and the shear of runs along the centre line differ, one run from the next.

    python tests/python/differences.py [--plot FILE.png] RUN RUN ...

Takes the records of 1.40 to 1.45 ms (docs/verdict.md), the bar's nodes nearest y = 0 with y > 0, and a grid that
moves with the disk (-7 to 7 mm). Prints per run the largest slip speed, its mean, and the mean over the grid of its
standard deviation in time; then for successive runs the rms difference over the rms of the second: of the slip speed
and the shear at the last record, and of their means in time. --plot draws the slip speed at the last record.
"""

import argparse
import tomllib
from pathlib import Path

import h5py
import numpy as np

GRID = np.linspace(-7e-3, 7e-3, 141)
FROM, TO = 1.40e-3, 1.45e-3


def profiles(run):
    """Slip speed (m/s) and shear (Pa) on GRID, one row per record."""
    speed = tomllib.loads((run / "case.toml").read_text())["drive"]["speed"]
    with h5py.File(run / "contact.vtkhdf") as file:
        root = file["VTKHDF"]
        steps, data = root["Steps"], root["PointData"]
        points = root["Points"][:]
        side = points[:, 1][points[:, 1] > 0].min()
        line = np.abs(points[:, 2]) < 1e-9
        line &= np.abs(points[:, 1] - side) < 1e-9
        slip, shear = [], []
        for k, time in enumerate(steps["Values"][:]):
            if not FROM - 1e-12 <= time <= TO + 1e-12:
                continue

            def field(name):
                begin = steps["PointDataOffsets"][name][k]
                return data[name][begin : begin + len(points)][line]

            x = points[line, 0] + field("displacement")[:, 0] - speed * time
            order = np.argsort(x)
            for name, rows in (("slip_velocity", slip), ("shear", shear)):
                size = np.linalg.norm(field(name), axis=1)
                rows.append(np.interp(GRID, x[order], size[order]))
    return np.array(slip), np.array(shear)


def differs(a, b):
    return np.sqrt(((a - b) ** 2).mean() / (b**2).mean())


def draw(path, runs, found):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 3.2), layout="constrained")
    colours = pyplot.get_cmap("viridis")(np.linspace(0, 0.85, len(runs)))
    for run, (slip, _), colour in zip(runs, found, colours):
        axes.plot(1e3 * GRID, slip[-1], color=colour, label=run.name)
    axes.set(xlabel="x from the disk's axis (mm)", ylabel="slip speed (m/s)")
    axes.set_yscale("symlog", linthresh=0.1)
    axes.legend(frameon=False)
    figure.savefig(path, dpi=150)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("runs", nargs="+", type=Path)
    parser.add_argument("--plot", type=Path)
    options = parser.parse_args()
    runs = options.runs
    found = [profiles(run) for run in runs]
    if options.plot:
        draw(options.plot, runs, found)
    for run, (slip, _) in zip(runs, found):
        deviation = slip.std(axis=0).mean()
        print(f"{run.name}: |s| up to {slip.max():.3f}, mean {slip.mean():.4f}, sd in time {deviation:.4f} m/s")
    for (first, a), (second, b) in zip(zip(runs, found), list(zip(runs, found))[1:]):
        rows = [differs(a[i][-1], b[i][-1]) for i in (0, 1)]
        rows += [differs(a[i].mean(axis=0), b[i].mean(axis=0)) for i in (0, 1)]
        print(
            f"{first.name} -> {second.name}: last |s| {rows[0]:.2f}, shear {rows[1]:.3f};"
            f" mean |s| {rows[2]:.2f}, shear {rows[3]:.3f}"
        )


if __name__ == "__main__":
    main()
