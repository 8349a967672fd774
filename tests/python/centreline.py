"""Pressure, shear and slip along y = 0 on the bar at three output times of one or more runs.

    python tests/python/centreline.py OUT.png RUNDIR [RUNDIR ...]

Top: pressure, shear traction and the bound mu p of the coefficient that the algorithm used.
Middle: slip velocity of the bar relative to the disk along x, over the step before.
Bottom: |shear|/pressure. Positions are relative to the centre of the patch (patch_x of history.h5), as in creepage plot; rolling is to the right.
"""

import pathlib
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

COLOURS = ("tab:blue", "tab:orange", "tab:green")


def centre_rows(points, cells, body):
    """Rows of the bar's points on y = 0, from rear to front."""
    bar = np.unique(cells[body == 1])
    y = np.abs(points[bar, 1])
    line = bar[y <= y.min() + 1e-9]
    return line[np.argsort(points[line, 0])]


def draw(axes, run):
    grid = h5py.File(run / "contact.vtkhdf", "r")["VTKHDF"]
    history = h5py.File(run / "history.h5", "r")
    points = grid["Points"][:]
    cells = grid["Connectivity"][:].reshape(-1, 4)
    body = grid["CellData/body"][:][: len(cells)]
    rows = centre_rows(points, cells, body)
    count = len(points)
    steps = int(grid["Steps"].attrs["NSteps"])
    for colour, step in zip(COLOURS, range(max(steps - 3, 0), steps)):
        time = grid["Steps/Values"][step]
        centre = np.interp(time, history["time"][:], history["hub_x"][:] + history["patch_x"][:])
        field = lambda name: grid["PointData/" + name][step * count : (step + 1) * count][rows]
        pressure, shear = field("pressure"), np.linalg.norm(field("shear"), axis=1)
        bound, slip = field("mu") * pressure, field("slip_velocity")[:, 0]
        touch = pressure > 0
        x = (points[rows, 0] - centre)[touch] * 1e3
        label = f"t = {time * 1e6:.1f} µs"
        axes[0].plot(x, pressure[touch] / 1e6, color="0.4", lw=1)
        axes[0].plot(x, shear[touch] / 1e6, color=colour, marker=".", label=label)
        axes[0].plot(x, bound[touch] / 1e6, color=colour, ls=":", lw=1)
        axes[1].plot(x, slip[touch], color=colour, marker=".")
        axes[2].plot(x, (shear / np.where(touch, pressure, 1))[touch], color=colour, marker=".")
    axes[0].set_title(run.name)
    axes[0].set_ylabel("pressure (grey), shear,\nbound µp (dotted) (MPa)")
    axes[0].legend(fontsize=8)
    axes[1].set_ylabel("slip velocity of the bar, x (m/s)")
    axes[2].set_ylabel("shear / pressure")
    axes[2].set_ylim(0, 0.6)
    axes[2].set_xlabel("x from the patch's centre (mm)")


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    out, runs = sys.argv[1], [pathlib.Path(r) for r in sys.argv[2:]]
    figure, axes = plt.subplots(
        3, len(runs), figsize=(5.5 * len(runs), 9), sharex="col", squeeze=False
    )
    for column, run in zip(axes.T, runs):
        draw(column, run)
    figure.tight_layout()
    figure.savefig(out, dpi=110)


if __name__ == "__main__":
    main()
