"""Statistics of slip and traction at the probes of one or more runs, from every step.

    python tests/python/probes.py RUNDIR [RUNDIR ...]

Per probe, over the trailing half of its passage through the patch (pressure above 0.2 GPa): mean,
standard deviation and largest magnitude of the slip velocity along x, mean and standard deviation
of |shear_x|/pressure, standard deviation of the mu that the algorithm used, and the fraction of
steps in which the shear along x points *with* the slip.
"""

import pathlib
import sys

import h5py
import numpy as np


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print("run              probe  steps   slip mean    sd     max   ratio mean    sd   mu sd  wrong way")
    for run in map(pathlib.Path, sys.argv[1:]):
        with h5py.File(run / "probes.h5", "r") as file:
            for k in range(sum(name.endswith("_mu") for name in file)):
                read = lambda name: file[f"probe{k}_{name}"][:]
                pressure = read("pressure")
                inside = np.flatnonzero(pressure > 0.2e9)
                rear = inside[len(inside) // 2 :]
                slip, shear = read("slip_velocity_x")[rear], read("shear_x")[rear]
                ratio, mu = np.abs(shear) / pressure[rear], read("mu")[rear]
                print(
                    f"{run.name:16} {k:5} {len(rear):6}  {slip.mean():9.3f} {slip.std():6.3f} "
                    f"{np.abs(slip).max():6.2f}  {ratio.mean():9.3f} {ratio.std():6.3f} "
                    f"{mu.std():6.3f}  {np.mean(shear * slip > 0):9.3f}"
                )


if __name__ == "__main__":
    main()
