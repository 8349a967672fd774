#!/usr/bin/env python3
"""The same mesh in other formats, by meshio: MSH 2.2, Abaqus, VTU with its sets as arrays of 0 and 1;
and a whole model for LS-DYNA (mm, ton, s).

    pip install meshio
    python3 meshes/convert.py meshes/small.msh meshes/small-2.2.msh meshes/small.inp meshes/small.vtu
    python3 meshes/convert.py meshes/small.msh meshes/small.k
"""

import sys

import meshio
import numpy as np

CARDS = """*CONTROL_TERMINATION
$   ENDTIM
 {end:>9}
*CONTROL_TIMESTEP
$   DTINIT    TSSFAC
       0.0      0.67
*CONTROL_CONTACT
$   SLSFAC
       1.0
*CONTROL_ENERGY
         2         2         2         2
*SECTION_SOLID
$    SECID    ELFORM
         1         1
*MAT_ELASTIC
$      MID        RO         E        PR
         1    7.8e-9   2.1e+05       0.3
*HOURGLASS
$     HGID       IHQ        QM       IBQ        Q1        Q2
         1         4      0.05         1       1.5      0.06
*PART
disk
         1         1         1         0         1
*PART
bar
         2         1         1         0         1
*CONTACT_SURFACE_TO_SURFACE
$     SSID      MSID     SSTYP     MSTYP
       101       102         0         0
$       FS        FD        DC        VC       VDC
       0.5      0.32    0.0060       0.0      10.0
$      SFS       SFM
       1.0       1.0
*CONSTRAINED_NODAL_RIGID_BODY
$      PID       CID      NSID
         3         0         1
*BOUNDARY_SPC_SET
$     NSID       CID      DOFX      DOFY      DOFZ
         2         0         1         1         1
*LOAD_NODE_SET
$     NSID       DOF      LCID        SF
         1         3         1 {force:>9}
*DEFINE_CURVE
         1
                 0.0                 1.0
                 1.0                 1.0
*INITIAL_VELOCITY_GENERATION
$       ID      STYP     OMEGA        VX
         1         2    160.32   16000.0
$       XC        YC        ZC        NX        NY        NZ
       0.0       0.0     100.0       0.0       1.0       0.0
"""


def keyword_file(target, mesh, sets):
    """A disk on a bar as LS-DYNA takes it; lengths in mm."""
    rows = lambda numbers, width: "".join(f"{n:{width}d}" for n in numbers) + "\n"
    nodes = lambda name: sorted({int(n) + 1 for c, m in zip(mesh.cells, sets[name])
                                 for n in c.data[m].ravel()})
    hub = nodes("hub")
    with open(target, "w") as file:
        file.write("*KEYWORD\n*TITLE\na small disk on a bar\n")
        file.write(CARDS.format(end="2.5e-4", force=f"{-2000 / len(hub):.5f}"))
        file.write("*NODE\n")
        for i, (x, y, z) in enumerate(1e3 * mesh.points):
            file.write(f"{i + 1:8d}{x:16.6f}{y:16.6f}{z:16.6f}\n")
        file.write("*ELEMENT_SOLID\n")
        number = 0
        for part, name in ((1, "disk"), (2, "bar")):
            for cells, mask in zip(mesh.cells, sets[name]):
                for corners in cells.data[mask]:
                    number += 1
                    file.write(rows([number, part, *(corners + 1)], 8))
        for number, name in ((1, "hub"), (2, "clamp")):
            members = nodes(name)
            file.write(f"*SET_NODE_LIST\n{number:10d}\n")
            for i in range(0, len(members), 8):
                file.write(rows(members[i:i + 8], 10))
        for number, name in ((101, "tread"), (102, "top")):
            file.write(f"*SET_SEGMENT\n{number:10d}\n")
            for cells, mask in zip(mesh.cells, sets[name]):
                for corners in cells.data[mask]:
                    file.write(rows(corners + 1, 10))
        file.write("*END\n")


source, *targets = sys.argv[1:]
mesh = meshio.read(source)
groups = mesh.cell_data["gmsh:physical"]
sets = {name: [(group == tag) & (cells.dim == dimension) for cells, group in zip(mesh.cells, groups)]
        for name, (tag, dimension) in mesh.field_data.items()}
for target in targets:
    if target.endswith(".k"):
        keyword_file(target, mesh, sets)
    elif target.endswith(".vtu"):
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
