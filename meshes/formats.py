#!/usr/bin/env python3
"""A disk of 96 hexahedra on a bar of 32 with six sets, in every form in which meshio and Gmsh write meshes.

    pip install meshio gmsh
    python3 meshes/formats.py meshes/formats
"""

import pathlib
import sys

import gmsh
import meshio
import numpy as np


def grid(points):
    """Nodes and hexahedra of an array of points; the last of the first index is followed by the first if both meet."""
    n, closed = list(points.shape[:3]), np.allclose(points[0], points[-1])
    number = np.arange(np.prod(n)).reshape(n)
    if closed:
        number = number[:-1]
        number = np.concatenate([number, number[:1]])
        n[0] -= 1
    corner = lambda i, j, k: number[i:number.shape[0] - 1 + i, j:n[1] - 1 + j, k:n[2] - 1 + k].ravel()
    order = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    return points[:n[0]].reshape(-1, 3), np.stack([corner(*c) for c in order], axis=1), number


def quads(number):
    """Quadrangles of a sheet of node numbers."""
    return np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)


def model():
    """Points, cells and the block of cells of each set."""
    angle, radius, across = np.meshgrid(np.linspace(0, 2 * np.pi, 25), [0.05, 0.075, 0.1],
                                        [-0.01, 0, 0.01], indexing="ij")
    ring = np.stack([radius * np.sin(angle), across, 0.1 - radius * np.cos(angle)], axis=-1).round(12)
    x, y, z = np.meshgrid(np.linspace(-0.05, 0.05, 9), [-0.01, 0, 0.01], [-0.02, -0.01, 0], indexing="ij")
    disk, wheel, rings = grid(ring)
    bar, rail, layers = grid(np.stack([x, y, z], axis=-1))
    first = len(disk)
    blocks = {"disk": ("hexahedron", wheel), "bar": ("hexahedron", rail + first),
              "tread": ("quad", quads(rings[:, -1])), "hub": ("quad", quads(rings[:, 0])),
              "top": ("quad", quads(layers[:, :, -1]) + first), "clamp": ("quad", quads(layers[:, :, 0]) + first)}
    return np.concatenate([disk, bar]), blocks


def in_cells(points, blocks):
    """A mesh whose six sets are sets of cells."""
    sets = {name: [np.arange(len(cells)) if other == name else np.array([], int)
                   for other, (_, cells) in blocks.items()] for name in blocks}
    return meshio.Mesh(points, list(blocks.values()), cell_sets=sets)


def in_points(points, blocks):
    """A mesh of hexahedra alone, whose hub, tread, top and clamp are sets of points."""
    bodies = [blocks[name] for name in ("disk", "bar")]
    sets = {name: [np.arange(len(cells)) if other == name else np.array([], int)
                   for other, (_, cells) in zip(("disk", "bar"), bodies)] for name in ("disk", "bar")}
    nodes = {name: np.unique(blocks[name][1]) for name in ("hub", "tread", "top", "clamp")}
    return meshio.Mesh(points, bodies, cell_sets=sets, point_sets=nodes)


def in_groups(points, blocks):
    """A mesh whose six sets are physical groups of Gmsh."""
    dimension = {"hexahedron": 3, "quad": 2}
    tags = [np.full(len(cells), 1 + i) for i, (_, cells) in enumerate(blocks.values())]
    names = {name: np.array([1 + i, dimension[kind]]) for i, (name, (kind, _)) in enumerate(blocks.items())}
    entity = np.zeros((len(points), 2), int)
    for i, (kind, cells) in enumerate(blocks.values()):
        entity[np.unique(cells)] = dimension[kind], 1 + i
    return meshio.Mesh(points, list(blocks.values()), point_data={"gmsh:dim_tags": entity},
                       cell_data={"gmsh:physical": tags, "gmsh:geometrical": [t.copy() for t in tags]},
                       field_data=names)


def main():
    out = pathlib.Path(sys.argv[1])
    out.mkdir(exist_ok=True)
    points, blocks = model()
    # meshio changes what it writes to VTU
    in_cells(points, blocks).write(out / "cells.vtu")
    in_points(points, blocks).write(out / "points.vtu")
    in_groups(points, blocks).write(out / "groups.vtu")
    in_cells(points, blocks).write(out / "cells.inp")
    in_points(points, blocks).write(out / "points.inp")
    for version in ("4.1", "2.2"):
        for form in ("text", "binary"):
            mesh = in_groups(points, blocks)
            meshio.gmsh.write(out / f"{form}-{version}.msh", mesh, fmt_version=version, binary=form == "binary")
    # sets that are no physical groups are not written
    meshio.gmsh.write(out / "no-sets.msh", in_cells(points, blocks), fmt_version="2.2", binary=True)
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.merge(str(out / "text-4.1.msh"))
    gmsh.option.setNumber("Mesh.Binary", 1)
    for version in (4.1, 2.2):
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.write(str(out / f"gmsh-{version}.msh"))
    gmsh.finalize()


if __name__ == "__main__":
    main()
