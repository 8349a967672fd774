#!/usr/bin/env python3
"""A disk and a bar by Gmsh, of another topology than Creepage's own meshes.

The disk's side (x, z) and the bar's section (y, z) are meshed with unstructured quadrangles, fine
where contact passes, and drawn out to hexahedra: the disk along y, the bar along x. The two meshes
do not match: where contact passes, elements of the bar are 8/9 as long as those of the disk. Lengths in
metres; the disk touches the bar at the origin.

    pip install gmsh
    python3 meshes/disk_on_bar.py disk-on-bar-2mm.msh
    python3 meshes/disk_on_bar.py --small meshes/small.msh

convert.py then made meshes/disk-on-bar-2mm.vtu of the first, a fifth of its size.
"""

import argparse
import sys
from math import asin, cos, pi, sin, sqrt

import gmsh

REFERENCE = dict(radius=0.46, hub=0.10, disk_width=0.06,
                 length=0.24, bar_width=0.06, height=0.07, crown=0.30, start=-0.09,
                 size=2e-3, bar_size=0.08 / 45, zone_start=-0.010, zone_length=0.08, zone_width=0.02, depth=0.008,
                 slope=0.30, coarsest=0.05)
SMALL = dict(radius=0.1, hub=0.05, disk_width=0.02,
             length=0.1, bar_width=0.02, height=0.02, crown=0.30, start=-0.05,
             size=2e-3, bar_size=2e-3, zone_start=-0.012, zone_length=0.024, zone_width=0.008, depth=0.004,
             slope=0.5, coarsest=0.02)


def graded(fine, rest, size, slope, coarsest):
    """Cell sizes: `fine` in cells of `size`, then growing ones over `rest`."""
    cells = [size] * round(fine / size)
    outer, h = [], size
    while sum(outer) < rest:
        h = min(h * (1 + slope), coarsest)
        outer.append(h)
    if len(outer) > 1 and sum(outer) - rest > 0.5 * outer[-1]:
        outer.pop()
    if outer:
        scale = rest / sum(outer)
        outer = [scale * h for h in outer]
    return cells, outer


def layers(before, fine, after):
    """Numbers of elements and relative heights of an extrusion, cell by cell."""
    cells = before[::-1] + fine + after
    total, height, heights = sum(cells), 0.0, []
    for h in cells:
        height += h
        heights.append(height / total)
    heights[-1] = 1.0
    return [1] * len(cells), heights


def field(curves, p):
    """Element size by the distance to the curves of contact."""
    distance = gmsh.model.mesh.field.add("Distance")
    gmsh.model.mesh.field.setNumbers(distance, "CurvesList", curves)
    gmsh.model.mesh.field.setNumber(distance, "Sampling", 400)
    threshold = gmsh.model.mesh.field.add("Threshold")
    reach = (p["coarsest"] - p["size"]) / p["slope"]
    for name, value in [("InField", distance), ("SizeMin", p["size"]), ("DistMin", p["depth"]),
                        ("SizeMax", p["coarsest"]), ("DistMax", p["depth"] + reach)]:
        gmsh.model.mesh.field.setNumber(threshold, name, value)
    return threshold


def disk(p):
    """The disk's side, drawn out; its contact arc, volume, tread and hub."""
    geo, radius, hub = gmsh.model.geo, p["radius"], p["hub"]
    left = -0.5 * p["disk_width"]
    centre = geo.addPoint(0, left, radius)
    start, end = p["zone_start"] / radius, (p["zone_start"] + p["zone_length"]) / radius
    turn = 2 * pi - (end - start)
    angles = [start, end] + [end + turn * k / 4 for k in (1, 2, 3)]
    at = lambda r, a: geo.addPoint(r * sin(a), left, radius - r * cos(a))
    outer = [at(radius, a) for a in angles]
    inner = [at(hub, pi / 2 * k) for k in range(4)]
    arcs = lambda points: [geo.addCircleArc(a, centre, b)
                           for a, b in zip(points, points[1:] + points[:1])]
    tread, core = arcs(outer), arcs(inner)
    contact = tread[0]
    geo.mesh.setTransfiniteCurve(contact, 1 + round(p["zone_length"] / p["size"]))
    side = geo.addPlaneSurface([geo.addCurveLoop(tread), geo.addCurveLoop(core)])
    geo.mesh.setRecombine(2, side)
    fine, rest = graded(0.5 * p["zone_width"], 0.5 * (p["disk_width"] - p["zone_width"]),
                        p["size"], p["slope"], p["coarsest"])
    numbers, heights = layers(rest, 2 * fine, rest)
    made = geo.extrude([(2, side)], 0, p["disk_width"], 0, numbers, heights, recombine=True)
    sides = [tag for dimension, tag in made[2:]]
    return contact, made[1][1], sides[:len(tread)], sides[len(tread):]


def bar(p):
    """The bar's section, drawn out; its contact arcs, volume, top and bottom."""
    geo, crown = gmsh.model.geo, p["crown"]
    x, half, zone = p["start"], 0.5 * p["bar_width"], 0.5 * p["zone_width"]
    sag = lambda y: crown - sqrt(crown * crown - y * y)
    centre = geo.addPoint(x, 0, -crown)
    top = [geo.addPoint(x, y, -sag(y)) for y in (half, zone, -zone, -half)]
    low = [geo.addPoint(x, y, -p["height"]) for y in (-half, half)]
    arcs = [geo.addCircleArc(a, centre, b) for a, b in zip(top, top[1:])]
    walls = [geo.addLine(a, b) for a, b in [(top[-1], low[0]), (low[0], low[1]), (low[1], top[0])]]
    # an even number of elements: there are nodes on y = 0
    count = 2 * round(crown * asin(zone / crown) / p["size"])
    geo.mesh.setTransfiniteCurve(arcs[1], 1 + count)
    section = geo.addPlaneSurface([geo.addCurveLoop(arcs + walls)])
    geo.mesh.setRecombine(2, section)
    before, after = p["zone_start"] - p["start"], p["start"] + p["length"] - p["zone_start"]
    fine, ahead = graded(p["zone_length"], after - p["zone_length"],
                         p["size"], p["slope"], p["coarsest"])
    _, behind = graded(0.0, before, p["size"], p["slope"], p["coarsest"])
    numbers, heights = layers(behind, fine, ahead)
    made = geo.extrude([(2, section)], p["length"], 0, 0, numbers, heights, recombine=True)
    sides = [tag for dimension, tag in made[2:]]
    return arcs[1], made[1][1], sides[:len(arcs)], [sides[len(arcs) + 1]]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", nargs="+", help="files to write: .msh, .inp")
    parser.add_argument("--small", action="store_true", help="a small disk, for tests")
    parser.add_argument("--size", type=float, help="element size where contact passes (m)")
    parser.add_argument("--matching", action="store_true",
                        help="elements of the bar as long as those of the disk where contact passes")
    parser.add_argument("--msh", type=float, default=4.1, help="version of .msh: 4.1 or 2.2")
    args = parser.parse_args()
    p = dict(SMALL if args.small else REFERENCE)
    if args.size:
        p["bar_size"] *= args.size / p["size"]
        p["size"] = args.size
    if args.matching:
        p["bar_size"] = p["size"]

    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    for name, value in [("Mesh.Algorithm", 6),
                        ("Mesh.MeshSizeExtendFromBoundary", 0), ("Mesh.MeshSizeFromPoints", 0),
                        ("Mesh.MeshSizeFromCurvature", 0), ("Mesh.Smoothing", 20),
                        ("Mesh.MshFileVersion", args.msh), ("Mesh.SaveGroupsOfNodes", 1)]:
        gmsh.option.setNumber(name, value)
    arc, wheel, tread, hub = disk(p)
    crest, rail, top, clamp = bar(dict(p, size=p["bar_size"]))
    gmsh.model.geo.synchronize()
    least = gmsh.model.mesh.field.add("Min")
    gmsh.model.mesh.field.setNumbers(least, "FieldsList", [field([arc], p), field([crest], p)])
    gmsh.model.mesh.field.setAsBackgroundMesh(least)
    for dimension, tags, name in [(3, [wheel], "disk"), (3, [rail], "bar"), (2, tread, "tread"),
                                  (2, hub, "hub"), (2, top, "top"), (2, clamp, "clamp")]:
        group = gmsh.model.addPhysicalGroup(dimension, tags)
        gmsh.model.setPhysicalName(dimension, group, name)
    # Blossom, which may leave triangles over; if it does, quadrangles by subdivision
    for recombination in (1, 3):
        gmsh.option.setNumber("Mesh.RecombinationAlgorithm", recombination)
        gmsh.model.mesh.clear()
        gmsh.model.mesh.generate(3)
        kinds, elements, _ = gmsh.model.mesh.getElements(3)
        if list(kinds) == [5]:
            break
    else:
        sys.exit("there are cells other than hexahedra: choose another --size")
    # to the nanometre, which makes the file a third shorter
    tags, points, _ = gmsh.model.mesh.getNodes()
    for tag, i in zip(tags, range(0, len(points), 3)):
        gmsh.model.mesh.setNode(tag, [round(x, 9) + 0.0 for x in points[i:i + 3]], [])
    worst = min(gmsh.model.mesh.getElementQualities(elements[0], "minSJ"))
    print(f"{len(elements[0])} hexahedra, {len(tags)} nodes, least scaled Jacobian {worst:.3f}")
    for file in args.file:
        gmsh.write(file)
    gmsh.finalize()


if __name__ == "__main__":
    main()
