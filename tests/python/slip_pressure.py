"""Does a pulse of slip change the pressure?

    python slip_pressure.py OUT.json SWEEP

SWEEP is the folder of cases/verdict/slip-pulse.toml: pairs of runs with and without the pulse, for each mesh. Differences of slip
velocity, pressure and shear are taken on the surface of the bar, within 2 mm and 4 us of the middle of the pulse. Pressure under a
pulse that is symmetric is not, so that its rms is compared, not its slope over slip.
"""

import json
import pathlib
import sys
import tomllib

import h5py
import numpy as np

PLACE, AROUND = 50.4e-3, 2e-3
TIME, WITHIN = 1.402e-3, 4e-6


def rms(values):
    return float(np.sqrt(np.mean(values**2)))


def fields(run):
    """Slip velocity and shear along x, and pressure, of each point in each record about the pulse."""
    with h5py.File(run / "contact.vtkhdf") as file:
        grid = file["VTKHDF"]
        count, steps = len(grid["Points"]), grid["Steps"]
        faces = grid["Connectivity"][:].reshape(-1, 4)
        bar = np.unique(faces[grid["CellData/body"][: len(faces)] == 1])
        bar = bar[np.abs(grid["Points"][:, 0][bar] - PLACE) < AROUND]
        times = steps["Values"][:]
        records = np.flatnonzero(np.abs(times - TIME) < WITHIN)

        def read(name):
            begins = steps["PointDataOffsets"][name][:]
            return np.array([grid["PointData"][name][begins[k] : begins[k] + count][bar] for k in records])

        return read("slip_velocity")[..., 0], read("pressure"), read("shear")[..., 0]


def main(out, sweep):
    sweep = pathlib.Path(sweep)
    pairs = {}
    for run in json.loads((sweep / "sweep.json").read_text())["runs"]:
        pairs.setdefault(run["parameters"]["mesh.zone.size"], []).append(sweep / run["run"])
    rows = []
    for size, (without, pulse) in pairs.items():
        material = tomllib.loads((pulse / "case.toml").read_text())["material"]
        modulus = material["young"] / (2 + 2 * material["poisson"])
        impedance = 0.5 * np.sqrt(modulus * material["density"])
        slip, pressure, shear = (b - a for a, b in zip(fields(without), fields(pulse)))
        largest = {"slip": slip, "pressure": pressure, "shear": shear}
        rows.append(
            {
                "size": size,
                **{name: float(np.abs(values).max()) for name, values in largest.items()},
                "over_shear": rms(pressure) / rms(shear),
                "over_radiation": rms(pressure) / (impedance * rms(slip)),
            }
        )
    pathlib.Path(out).write_text(json.dumps(rows, indent=1))


main(*sys.argv[1:])
