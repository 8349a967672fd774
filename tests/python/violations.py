"""Draws a map of `creepage check --map` at one time: where on the bar the contact conditions are violated.

    python tests/python/violations.py MAP.vtkhdf OUT.png [FIELD] [TIME]

FIELD is a point array of the map (default law_error); TIME in seconds (default: the last). Faces with a node
where the field has no value stay grey. In ParaView open the file as it is and colour by the same arrays.
"""

import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.tri import Triangulation

BAR = 1


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    field = sys.argv[3] if len(sys.argv) > 3 else "law_error"
    grid = h5py.File(sys.argv[1], "r")["VTKHDF"]
    times = grid["Steps/Values"][:]
    wanted = float(sys.argv[4]) if len(sys.argv) > 4 else times[-1]
    step = int(np.abs(times - wanted).argmin())
    points = 1e3 * grid["Points"][:]
    count = len(points)
    values = grid["PointData/" + field][step * count : (step + 1) * count]
    faces = grid["Connectivity"][:].reshape(-1, 4)
    faces = faces[grid["CellData/body"][: len(faces)] == BAR]
    known = faces[np.isfinite(values[faces]).all(axis=1)]
    if len(known) == 0:
        sys.exit(f"{field} has no value on a face of the bar at {times[step]} s")

    figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
    axes.add_collection(PolyCollection(points[faces, :2], facecolor="0.9", edgecolor="0.7", linewidth=0.5))
    halves = np.concatenate([known[:, [0, 1, 2]], known[:, [0, 2, 3]]])
    x, y = points[:, 0], points[:, 1]
    # a node without a value is in no triangle
    shades = axes.tripcolor(Triangulation(x, y, halves), np.nan_to_num(values), shading="gouraud", cmap="viridis")
    shades.set_clim(values[known].min(), values[known].max())
    axes.add_collection(PolyCollection(points[known, :2], facecolor="none", edgecolor="0.5", linewidth=0.5))
    attributes = grid["PointData/" + field].attrs
    unit = attributes["units"] if attributes["units"] != "1" else "-"
    figure.colorbar(shades, label=f"{field} ({unit})", shrink=0.8)
    axes.set_title(f"{attributes['description']}, t = {1e3 * times[step]:.4f} ms", fontsize=10)
    middle = points[known].mean(axis=(0, 1))
    reach = 1.4 * np.abs(points[known, :2] - middle[:2]).max()
    axes.set_xlim(middle[0] - reach, middle[0] + reach)
    axes.set_ylim(middle[1] - 0.7 * reach, middle[1] + 0.7 * reach)
    axes.set_aspect("equal")
    axes.set_xlabel("x (mm)")
    axes.set_ylabel("y (mm)")
    figure.savefig(sys.argv[2], dpi=150)


if __name__ == "__main__":
    main()
