"""A run as other programs would have recorded it: CalculiX, OpenRadioss, code_aster, LS-DYNA's d3plot, and tables."""

import numpy as np

import binout
from conftest import resolved

# mm-ton-s
LENGTH, STRESS = 1e-3, 1e6


class Contact:
    """The contact of a run in mm, ton and s, with the numbers 1, 2, ... of its nodes, on bricks below its faces."""

    def __init__(self, run):
        self.run, self.times = run, run.contact.times
        self.points, self.faces = run.contact.points / LENGTH, run.contact.cells
        self.body = binout.bodies(run)
        self.ids = np.arange(len(self.points)) + 1
        up = np.where(self.body == binout.DISK, 1.0, -1.0)[:, None]
        self.inner = self.points + up * (0, 0, 1)
        self.bricks = np.hstack([self.faces + len(self.points), self.faces])

    def motion(self, record):
        """Displacements (mm) and velocities (mm/s)."""
        return [self.run.contact[name][record] / LENGTH for name in ("displacement", "velocity")]

    def force(self, record):
        """Contact forces (N)."""
        return binout.forces(self.run, record, half=False)

    def stress(self, record):
        """COPEN, CSLIP1, CSLIP2, CPRESS, CSHEAR1 and CSHEAR2 (MPa) at the nodes of the bar."""
        pressure, shear = resolved(self.run, record)
        normal = -binout.normals(self.run, self.run.contact["displacement"][record])
        first = np.array([1.0, 0, 0]) - normal[:, :1] * normal
        first /= np.linalg.norm(first, axis=1)[:, None]
        along, across = (np.sum(shear * axis, axis=1) for axis in (first, np.cross(normal, first)))
        zero = np.zeros(len(pressure))
        return np.stack([zero, zero, zero, pressure, -along, -across], axis=1) * self.body[:, None] / STRESS


def calculix(contact, folder):
    """``job.frd`` as CalculiX 2.20 writes it, in six digits, and ``job.inp`` with the sets TREAD and TOP."""
    folder.mkdir(parents=True, exist_ok=True)

    def rows(ids, values):
        lines = (f" -1{n:10d}" + "".join(f"{x:12.5E}" for x in row) for n, row in zip(ids, values))
        return [*lines, " -3"]

    every = np.arange(2 * len(contact.ids)) + 1
    lines = ["    1C", f"    2C{len(every):30d}{1:38d}", *rows(every, np.vstack([contact.points, contact.inner]))]
    lines.append(f"    3C{len(contact.bricks):30d}{1:38d}")
    for n, brick in enumerate(contact.bricks + 1):
        lines += [f" -1{n + 1:10d}    1    0    1", " -2" + "".join(f"{node:10d}" for node in brick)]
    lines.append(" -3")
    for record, time in enumerate(contact.times):
        moved, velocity = contact.motion(record)
        for name, values in [("DISP", moved), ("VELO", velocity), ("CONTACT", contact.stress(record))]:
            lines.append(f"  100CL{101 + record:5d}{time:12.5E}{len(every):12d}{'':20}{1:2d}{record + 1:5d}{'':10}{1:2d}")
            lines += [f" -4  {name:8}{values.shape[1]:5d}    1", *rows(contact.ids, values)]
    (folder / "job.frd").write_text("\n".join([*lines, " 9999"]) + "\n")
    sets = []
    for name, body in [("Tread", binout.DISK), ("Top", binout.BAR)]:
        sets += [f"*NSET, NSET={name}", *(f"{n}," for n in contact.ids[contact.body == body])]
    (folder / "job.inp").write_text("\n".join(["*NODE", *sets, "*STEP"]) + "\n")


def openradioss(contact, deck, folder, begins):
    """Animation files in six digits, as ``anim_to_vtk`` writes them: all nodes of the contact, by their numbers in the
    deck."""
    folder.mkdir(parents=True, exist_ok=True)
    ids, count = binout.labels(contact.run, deck), len(contact.ids)

    def rows(values):
        return [" ".join(f"{x:.6g}" for x in row) for row in values]

    for record, time in enumerate(contact.times):
        moved, velocity = contact.motion(record)
        lines = ["# vtk DataFile Version 3.0", "vtk output", "ASCII", "DATASET UNSTRUCTURED_GRID", "FIELD FieldData 2",
                 "TIME 1 1 double", f"{time + begins:.9g}", "CYCLE 1 1 int", "0",
                 f"POINTS {count} float", *rows(contact.points + moved), "", f"POINT_DATA {count}",
                 "SCALARS NODE_ID int 1", "LOOKUP_TABLE default", *map(str, ids)]  # fmt: skip
        for name, values in [("Velocity", velocity), ("Contact_Forces", contact.force(record))]:
            lines += [f"VECTORS {name} float", *rows(values), ""]
        (folder / f"deckA{record + 1:03d}.vtk").write_text("\n".join(lines) + "\n")


def aster(contact, path):
    """A MED file with what the reader needs of it, laid out as by MED's own library, version 4.2: DEPL and VITE, and
    CONT_NOEU at the nodes of the disk alone, by a profile."""
    import h5py

    every, disk = np.vstack([contact.points, contact.inner]), np.flatnonzero(contact.body == binout.DISK)
    with h5py.File(path, "w") as file:
        mesh = file.create_group("ENS_MAA/MESH/-0000000000000000001-0000000000000000001")
        mesh["NOE/COO"] = every.T.ravel()
        mesh["NOE/FAM"] = np.concatenate([contact.body + 2, np.zeros(len(contact.ids), int)])
        # this library's bricks are mirror images of other programs'
        mesh["MAI/HE8/NOD"] = contact.bricks[:, [0, 3, 2, 1, 4, 7, 6, 5]].T.ravel() + 1
        mesh["MAI/HE8/NOD"].attrs["NBR"] = len(contact.bricks)
        for number, name in [(2, b"TREAD"), (3, b"TOP")]:
            family = file.create_group(f"FAS/MESH/NOEUD/Family_{number}")
            family.attrs["NUM"] = number
            family["GRO/NOM"] = np.frombuffer(name.ljust(80, b"\0"), "i1")[None]
        file["PROFILS/DISK/PFL"] = disk + 1
        for name, axes in [("DEPL", "DX DY DZ"), ("VITE", "DX DY DZ"), ("CONT_NOEU", "CONT RX RY RZ")]:
            states = file.create_group(f"CHA/RESU____{name}")
            states.attrs["NOM"] = np.bytes_("".join(f"{axis:16}" for axis in axes.split()))
            for record, time in enumerate(contact.times):
                state = states.create_group(f"{record:020d}{record:020d}")
                state.attrs["PDT"] = time
                if name == "CONT_NOEU":
                    profile, values = "DISK", np.insert(contact.force(record)[disk], 0, 1, axis=1)
                else:
                    profile, values = "MED_NO_PROFILE_INTERNAL", np.zeros_like(every)
                    values[: len(contact.ids)] = contact.motion(record)[name == "VITE"]
                state.create_group("NOE").attrs["PFL"] = np.bytes_(profile)
                state[f"NOE/{profile}/CO"] = values.T.ravel()


def tables(contact, folder):
    """nodes.csv, faces.csv and values.csv, in all digits and in another order of the nodes."""
    folder.mkdir(parents=True, exist_ok=True)

    def write(name, head, rows):
        lines = [",".join(repr(value.item()) for value in row) for row in rows]
        (folder / name).write_text("\n".join([head, *lines]) + "\n")

    order = np.random.default_rng(5).permutation(len(contact.ids))
    write("nodes.csv", "node,x,y,z", ([n, *x] for n, x in zip(contact.ids[order], contact.points[order])))
    sides = contact.body[contact.faces[:, 0]]
    write("faces.csv", "n0,n1,n2,n3,body", np.column_stack([contact.faces + 1, sides]))
    names = [f"{name}_{axis}" for name in ("displacement", "velocity", "force") for axis in "xyz"]
    rows = (
        [time, contact.ids[n], *moved[n], *velocity[n], *force[n]]
        for record, time in enumerate(contact.times)
        for moved, velocity in [contact.motion(record)]
        for force in [contact.force(record)]
        for n in order
    )
    write("values.csv", ",".join(["time", "node", *names]), rows)


def d3plot(run, deck, folder, begins, *, every=1):
    """A d3plot of every so many records, by lasso-python's writer."""
    from lasso.dyna import D3plot

    contact, plot = Contact(run), D3plot()
    ids, count = binout.labels(run, deck), len(run.contact.points)
    records = range(0, len(contact.times), every)
    motion = [contact.motion(record) for record in records]
    plot.arrays = {
        "node_coordinates": contact.points,
        "node_ids": ids,
        "element_solid_node_indexes": np.hstack([contact.faces, contact.faces]),
        "element_solid_part_indexes": np.zeros(len(contact.faces), int),
        "element_solid_ids": np.arange(len(contact.faces)) + 1,
        "node_displacement": np.array([contact.points + moved for moved, _ in motion]),
        "node_velocity": np.array([velocity for _, velocity in motion]),
        "timesteps": contact.times[::every] + begins,
    }
    assert len(ids) == count
    plot.write_d3plot(str(folder / "d3plot"))
