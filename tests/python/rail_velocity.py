"""How well does twice the velocity of the bar's surface stand for the slip, |s| = 2 |v_x|?

Vollebregt (2017) draws the bound mu(|s|) p_n of the papers' Figure 4 with this assumption, since the papers give no slip.

    python rail_velocity.py RUN [MILLIMETRES]

RUN is the folder of a run with falling friction, Eq (8). The nodes are those of the bar on y = 0 with more than 2 % of the largest
pressure, over the last 20 mm of rolling.
"""

import sys
import tomllib
from pathlib import Path

import h5py
import numpy as np

run = Path(sys.argv[1])
rolled = 1e-3 * float(sys.argv[2]) if len(sys.argv) > 2 else 0.020
case = tomllib.loads((run / "case.toml").read_text())
law, speed = case["friction"], case["drive"]["speed"]


def mu(slip):
    """Eq (8)."""
    return law["dynamic"] + (law["static"] - law["dynamic"]) * np.exp(-law["decay"] * slip)


def rms(values):
    return np.sqrt(np.mean(values**2))


with h5py.File(run / "contact.vtkhdf") as file:
    grid = file["VTKHDF"]
    data, offsets, times = grid["PointData"], grid["Steps/PointDataOffsets"], grid["Steps/Values"][:]
    count, points = len(grid["Points"]), grid["Points"][:]
    faces = grid["Connectivity"][:].reshape(-1, 4)
    bar = np.unique(faces[grid["CellData/body"][: len(faces)] == 1])
    bar = bar[np.abs(points[bar, 1]) < 1e-6]
    slip, twice = [], []
    for k in np.flatnonzero(times > times[-1] - rolled / speed):

        def read(name):
            begin = offsets[name][k]
            return data[name][begin : begin + count][bar]

        pressure = read("pressure")
        touches = pressure > 0.02 * pressure.max()
        slip.append(np.linalg.norm(read("slip_velocity")[touches], axis=1))
        twice.append(2 * np.abs(read("velocity")[touches, 0]))
slip, twice = np.concatenate(slip), np.concatenate(twice)

print(f"{len(slip)} values")
print(f"rms of |s|            {rms(slip):.3f} m/s")
print(f"rms of 2 |v_x|        {rms(twice):.3f} m/s")
print(f"rms of the difference {rms(slip - twice):.3f} m/s")
print(f"correlation           {np.corrcoef(slip, twice)[0, 1]:.2f}")
print(f"mean of mu(|s|)       {mu(slip).mean():.3f}, standard deviation {mu(slip).std():.3f}")
print(f"mean of mu(2 |v_x|)   {mu(twice).mean():.3f}, standard deviation {mu(twice).std():.3f}")
