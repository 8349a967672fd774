#!/usr/bin/env python3
"""Draws the last step of a run: the disk on the bar, and the contact from near, side by side.

Usage: render.py RUNDIR OUT.png [--width PIXELS]

Colours show the von Mises stress where the run holds stresses, else the speed. Of half a model (y >= 0)
the mirror image is drawn too. Works without a
display: VTK then draws through EGL, which needs a system library (Debian and Ubuntu:
`apt-get install libegl1 libgl1-mesa-dri`).
"""

import argparse
from pathlib import Path

import h5py
import numpy as np
import pyvista
from matplotlib.colors import LinearSegmentedColormap
from vtkmodules.vtkIOHDF import vtkHDFReader

DISK = 0
# From the light grey of unstressed steel to yellow: dark enough to see anywhere, text stays legible.
COLOURS = ["#dfe3e8", "#9dc3e6", "#3f7fc1", "#5b3fa0", "#b5305f", "#f0592b", "#ffc425"]


def last_step(path):
    """The grid and time of the last step, and the cells' names (pyvista's reader knows no time)."""
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    steps = reader.GetNumberOfSteps()
    if steps == 0:
        raise SystemExit(f"{path} holds no step yet")
    reader.SetStep(steps - 1)
    reader.Update()
    return pyvista.wrap(reader.GetOutput()), reader.GetTimeValue()


def von_mises(stress):
    xx, yy, zz, xy, yz, xz = stress.T
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.sqrt(0.5 * normal + 3.0 * (xy**2 + yz**2 + xz**2))


def coloured(grid):
    """The deformed grid with the array to show; returns it with the array's name and title."""
    grid.points = grid.points + grid.point_data["displacement"]
    if "stress" in grid.cell_data:
        grid.cell_data["shown"] = von_mises(grid.cell_data["stress"]) / 1e6
        grid = grid.cell_data_to_point_data(pass_cell_data=True)
        return grid, "von Mises stress (MPa)"
    grid.point_data["shown"] = np.linalg.norm(grid.point_data["velocity"], axis=1)
    return grid, "speed (m/s)"


def whole(grid, path):
    """The grid with its mirror image where the run modelled the half y >= 0."""
    with h5py.File(path, "r") as file:
        half = file.attrs.get("symmetry") == "half"
    return grid.merge(grid.reflect((0.0, 1.0, 0.0))) if half else grid


def contact_point(grid):
    """Where the disk's lowest node is, at the level of the bar's top."""
    disk = grid.extract_cells(grid.cell_data["body"] == DISK)
    low = disk.points[:, 2] < disk.points[:, 2].min() + 1e-3 * disk.length
    return np.array([disk.points[low, 0].mean(), 0.0, disk.points[:, 2].min()]), disk


def draw(grid, title, time, out, width):
    centre, disk = contact_point(grid)
    radius = (disk.bounds[5] - disk.bounds[4]) / 2
    plotter = pyvista.Plotter(
        off_screen=True, shape=(1, 2), window_size=(width, width // 2), border=False
    )
    top = float(np.percentile(grid.point_data["shown"], 99.99))
    look = {
        "scalars": "shown",
        "preference": "point",
        "cmap": LinearSegmentedColormap.from_list("steel", COLOURS, N=256),
        "clim": (0.0, top if top > 0.0 else 1.0),
        "show_scalar_bar": False,
        "smooth_shading": False,
    }
    # Whole elements behind the middle plane: a cut through them would draw triangles.
    lateral = grid.cell_centers().points[:, 1]
    half = grid.extract_cells(lateral > 0.0)

    plotter.subplot(0, 0)
    surface = grid.extract_surface(algorithm="dataset_surface")
    plotter.add_mesh(surface, ambient=0.25, **look)
    edges = surface.extract_feature_edges(feature_angle=40.0)
    plotter.add_mesh(edges, color="#404850", line_width=1.5)
    plotter.add_text(f"t = {1e3 * time:.3g} ms", font_size=11, color="black")
    plotter.camera_position = [centre + [0.35, -1.0, 0.3], centre, (0, 0, 1)]
    plotter.reset_camera(bounds=grid.bounds)
    plotter.camera.zoom(1.35)

    plotter.subplot(0, 1)
    skin = half.extract_surface(algorithm="dataset_surface")
    plotter.add_mesh(
        skin, show_edges=True, edge_color="black", edge_opacity=0.3, ambient=0.4, **look
    )
    plotter.add_text(f"{title}, elements with y > 0", font_size=11, color="black")
    plotter.add_scalar_bar(
        title=" ",  # it would run into the labels
        mapper=plotter.mapper,
        color="black",
        vertical=False,
        position_x=0.2,
        position_y=0.03,
        width=0.6,
        height=0.08,
        n_labels=4,
        fmt="%.3g",
        label_font_size=width // 100,
    )
    near = 0.1 * radius
    plotter.camera_position = [centre + near * np.array([0.25, -3.6, 0.7]), centre, (0, 0, 1)]

    plotter.set_background("white")
    plotter.screenshot(str(out))
    plotter.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path, help="folder of the run")
    parser.add_argument("out", type=Path, help="picture to write (PNG)")
    parser.add_argument("--width", type=int, default=1600)
    arguments = parser.parse_args()
    fields = arguments.run / "fields.vtkhdf"
    grid, time = last_step(fields)
    grid, title = coloured(grid)
    grid = whole(grid, fields)
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    draw(grid, title, time, arguments.out, arguments.width)
    print(f"{arguments.out}: {title} at t = {time:.6g} s, {grid.n_cells} cells")


if __name__ == "__main__":
    main()
