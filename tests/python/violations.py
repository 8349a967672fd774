"""Draws a map of `creepage check --map` at one time: which nodes violate the contact conditions.

    python tests/python/violations.py MAP.vtkhdf OUT.png [FIELD] [TIME]

FIELD is a point array of the map (default law_error); TIME in seconds (default: the last). Works
with pyvista; in ParaView open the file as it is and colour by the same arrays.
"""

import sys

import numpy as np
import pyvista
from vtkmodules.vtkIOHDF import vtkHDFReader


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    field = sys.argv[3] if len(sys.argv) > 3 else "law_error"
    reader = vtkHDFReader()
    reader.SetFileName(sys.argv[1])
    reader.UpdateInformation()
    times = np.array(reader.GetOutputInformation(0).Get(reader.GetExecutive().TIME_STEPS()))
    wanted = float(sys.argv[4]) if len(sys.argv) > 4 else times[-1]
    step = int(np.abs(times - wanted).argmin())
    reader.SetStep(step)
    reader.Update()
    grid = pyvista.wrap(reader.GetOutput())
    bar = grid.extract_cells(np.flatnonzero(grid.cell_data["body"] == 1))
    values = bar.point_data[field]
    touched = bar.points[np.isfinite(values)]
    plotter = pyvista.Plotter(off_screen=True, window_size=(1000, 750))
    title = f"{field} at {times[step] * 1e3:.4f} ms"
    bars = {"title": title, "color": "black", "vertical": False, "position_x": 0.2, "width": 0.6}
    plotter.add_mesh(bar, scalars=field, cmap="viridis", nan_color="#dddddd", lighting=False, show_edges=True,
                     edge_color="#888888", scalar_bar_args=bars)
    plotter.set_background("white")
    plotter.view_xy()
    plotter.camera.focal_point = (*touched.mean(axis=0)[:2], 0)
    plotter.camera.position = (*touched.mean(axis=0)[:2], 1)
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = 0.0135
    plotter.screenshot(sys.argv[2])


if __name__ == "__main__":
    main()
