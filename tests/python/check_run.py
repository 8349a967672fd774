#!/usr/bin/env python3
"""Opens the files of a run with libhdf5 (h5py) and with VTK and checks what is in them.

Usage: check_run.py RUNDIR [--partial]

Prints what it saw. Ends with 1 where something is missing, misshapen or not finite. With
--partial the run may be unfinished or killed: files need not hold a step, and datasets may be one
snapshot longer than the count of complete steps.
"""

import argparse
import sys
from pathlib import Path

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOHDF import vtkHDFReader

ROOT_ATTRIBUTES = ("creepage_version", "case_hash", "created")
FIELDS = {
    "cell": {"required": {"body": 1}, "optional": {"stress": 6}},
    "point": {"required": {"displacement": 3, "deformation": 3, "velocity": 3}, "optional": {}},
}
CONTACT = {
    "cell": {"required": {"body": 1}, "optional": {}},
    "point": {
        "required": {
            "pressure": 1,
            "shear": 3,
            "slip_velocity": 3,
            "slip": 3,
            "mu": 1,
            "state": 1,
            "gap": 1,
            "area": 1,
            "velocity": 3,
        },
        "optional": {"displacement": 3, "pass_pressure": 1},
    },
}
VTK_HEXAHEDRON, VTK_QUAD = 12, 9

failures = []


def expect(condition, message):
    if not condition:
        failures.append(message)
        print(f"  FAILED: {message}")
    return bool(condition)


def check_attributes(file):
    for name in ROOT_ATTRIBUTES:
        value = file.attrs.get(name)
        expect(isinstance(value, str) and value, f"{file.filename}: root attribute {name}: {value!r}")

    def has_units(name, item):
        if isinstance(item, h5py.Dataset):
            units = item.attrs.get("units")
            expect(isinstance(units, str) and units, f"{file.filename}: {name}: units {units!r}")

    file.visititems(has_units)


def check_h5py_grid(path, cell_type, partial):
    """The layout as libhdf5 sees it; returns (steps, points, cells, times)."""
    with h5py.File(path, "r", locking=False) as file:
        check_attributes(file)
        grid = file["VTKHDF"]
        expect(grid.attrs["Type"] == b"UnstructuredGrid", f"{path}: type {grid.attrs['Type']!r}")
        expect(list(grid.attrs["Version"]) == [2, 2], f"{path}: version {grid.attrs['Version']}")
        points, cells = int(grid["NumberOfPoints"][0]), int(grid["NumberOfCells"][0])
        steps = int(grid["Steps"].attrs["NSteps"])
        times = grid["Steps/Values"][:steps]
        expect(grid["Points"].shape == (points, 3), f"{path}: Points {grid['Points'].shape}")
        expect(np.isfinite(grid["Points"][:]).all(), f"{path}: Points are not finite")
        expect(set(grid["Types"][:]) == {cell_type}, f"{path}: cell types {set(grid['Types'][:])}")
        connectivity = grid["Connectivity"][:]
        expect(
            len(connectivity) == grid["NumberOfConnectivityIds"][0] == grid["Offsets"][-1],
            f"{path}: connectivity and offsets disagree",
        )
        expect(connectivity.min() >= 0 and connectivity.max() < points, f"{path}: point indices")
        expect(len(times) == steps and (np.diff(times) > 0).all(), f"{path}: times {times}")
        for group, count in (("PointData", points), ("CellData", cells)):
            for name, data in grid[group].items():
                offsets = grid[f"Steps/{group}Offsets/{name}"][:steps]
                constant = data.maxshape[0] is not None
                wanted = np.zeros(steps) if constant else np.arange(steps) * count
                expect((offsets == wanted).all(), f"{path}: offsets of {name}: {offsets}")
                rows = count if constant else steps * count
                spare = count if partial and not constant else 0
                expect(rows <= len(data) <= rows + spare, f"{path}: {name} has {len(data)} rows")
                # Reading everything proves that each chunk decompresses.
                expect(np.isfinite(data[:rows]).all(), f"{path}: {name} is not finite")
                if not constant:
                    expect(count % data.chunks[0] == 0, f"{path}: {name}: chunk {data.chunks[0]}")
    return steps, points, cells, times


def check_vtk_grid(path, layout, steps, points, cells, times):
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    expect(reader.GetNumberOfSteps() == steps, f"{path}: VTK sees {reader.GetNumberOfSteps()} steps")
    for step in sorted({0, steps // 2, steps - 1}):
        reader.SetStep(step)
        reader.Update()
        grid = reader.GetOutput()
        expect(grid.GetNumberOfPoints() == points, f"{path}: VTK points {grid.GetNumberOfPoints()}")
        expect(grid.GetNumberOfCells() == cells, f"{path}: VTK cells {grid.GetNumberOfCells()}")
        expect(reader.GetTimeValue() == times[step], f"{path}: VTK time {reader.GetTimeValue()}")
        seen = []
        for kind, data, count in (
            ("point", grid.GetPointData(), points),
            ("cell", grid.GetCellData(), cells),
        ):
            names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
            for name, components in (layout[kind]["required"] | layout[kind]["optional"]).items():
                if name not in names:
                    expect(name not in layout[kind]["required"], f"{path}: VTK has no {name}")
                    continue
                array = vtk_to_numpy(data.GetArray(name))
                wanted = (count,) if components == 1 else (count, components)
                expect(array.shape == wanted, f"{path}: VTK shape of {name}: {array.shape}")
                check_same(path, kind, name, step, array)
                size = np.abs(array) if components != 3 else np.linalg.norm(array, axis=1)
                seen.append(f"{name} {size.max():.4g}")
        print(f"  step {step}, t = {times[step]:.6g} s, largest: {', '.join(seen)}")


def check_same(path, kind, name, step, array):
    """VTK and libhdf5 must see the same numbers at the same step."""
    with h5py.File(path, "r", locking=False) as file:
        data = file[f"VTKHDF/{'PointData' if kind == 'point' else 'CellData'}/{name}"]
        first = 0 if data.maxshape[0] is not None else step * len(array)
        same = np.array_equal(data[first : first + len(array)], array)
    expect(same, f"{path}: step {step}: VTK and h5py read different {name}")


def check_grid(path, layout, cell_type, partial):
    if not expect(path.exists(), f"{path} is missing"):
        return
    steps, points, cells, times = check_h5py_grid(path, cell_type, partial)
    print(f"{path.name}: {points} points, {cells} cells, {steps} steps")
    if expect(steps > 0 or partial, f"{path}: no steps") and steps > 0:
        check_vtk_grid(path, layout, steps, points, cells, times)


def check_history(path, partial):
    if not expect(path.exists(), f"{path} is missing"):
        return
    with h5py.File(path, "r", locking=False) as file:
        check_attributes(file)
        rows = int(file.attrs["rows"])
        expect(rows > 0 or partial, f"{path}: no rows")
        expect("time" in file, f"{path}: no column `time`")
        for name, data in file.items():
            expect(data.ndim == 1, f"{path}: {name} has shape {data.shape}")
            expect(len(data) >= rows if partial else len(data) == rows, f"{path}: {name}: {len(data)}")
            expect(np.isfinite(data[:rows]).all(), f"{path}: {name} is not finite")
        if "time" in file:
            expect((np.diff(file["time"][:rows]) > 0).all(), f"{path}: time does not increase")
        columns = [f"{name} [{data.attrs['units']}]" for name, data in file.items()]
        print(f"{path.name}: {rows} rows of {', '.join(columns)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path, help="folder of the run")
    parser.add_argument("--partial", action="store_true", help="the run may have been killed")
    arguments = parser.parse_args()
    check_grid(arguments.run / "fields.vtkhdf", FIELDS, VTK_HEXAHEDRON, arguments.partial)
    check_grid(arguments.run / "contact.vtkhdf", CONTACT, VTK_QUAD, arguments.partial)
    check_history(arguments.run / "history.h5", arguments.partial)
    print(f"{len(failures)} failures" if failures else "all good")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
