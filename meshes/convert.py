#!/usr/bin/env python3
"""The same mesh in other formats, by meshio: MSH 2.2, Abaqus, VTU with its sets as arrays of 0 and 1.

    pip install meshio
    python3 meshes/convert.py meshes/small.msh meshes/small-2.2.msh meshes/small.inp meshes/small.vtu
"""

import sys

import meshio
import numpy as np

source, *targets = sys.argv[1:]
mesh = meshio.read(source)
groups = mesh.cell_data["gmsh:physical"]
sets = {name: [(group == tag) & (cells.dim == dimension) for cells, group in zip(mesh.cells, groups)]
        for name, (tag, dimension) in mesh.field_data.items()}
for target in targets:
    if target.endswith(".vtu"):
        masks = {name: [m.astype(np.uint8) for m in masks] for name, masks in sets.items()}
        meshio.Mesh(mesh.points, mesh.cells, cell_data=masks).write(target)
    elif target.endswith(".inp"):
        ids = {name: [np.flatnonzero(m) for m in masks] for name, masks in sets.items()}
        meshio.abaqus.write(target, meshio.Mesh(mesh.points, mesh.cells, cell_sets=ids),
                            float_fmt=".12g")
    else:
        data = {key: mesh.cell_data[key] for key in ("gmsh:physical", "gmsh:geometrical")}
        meshio.gmsh.write(target, meshio.Mesh(mesh.points, mesh.cells, cell_data=data,
                                              field_data=mesh.field_data),
                          fmt_version="2.2", binary=False, float_fmt=".12g")
