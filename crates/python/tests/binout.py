"""A run as LS-DYNA would have recorded it: binout with ``ncforc`` and ``nodout``, by the writer of lasso-python."""

import numpy as np

# of the keyword files of `creepage export-k`
DISK, BAR = 0, 1
# mm-ton-s
LENGTH, FORCE = 1e-3, 1.0


def labels(run, deck):
    """The numbers that the nodes of a run's contact have in its deck, 0 of a mirror image; of two in one place the
    disk's comes first."""
    at, inside = {}, False
    for line in deck.read_text().splitlines():
        if line.startswith("*"):
            inside = line == "*NODE"
        elif inside and not line.startswith("$"):
            place = tuple(round(float(line[8 + 16 * i : 24 + 16 * i]), 6) + 0.0 for i in range(3))
            at.setdefault(place, []).append(int(line[:8]))
    places = (tuple(round(float(x), 6) + 0.0 for x in point / LENGTH) for point in run.contact.points)
    return np.array([at.get(place, [0])[-1 if body else 0] for place, body in zip(places, bodies(run))])


def bodies(run):
    """The body of each node."""
    return np.repeat([DISK, BAR], [len(run.contact.disk.points), len(run.contact.bar.points)])


def normals(run, displacement):
    """Unit normals of the nodes: the means of those that the displaced faces around them have at these corners."""
    points, faces = run.contact.points + displacement, run.contact.cells
    normal = np.zeros_like(points)
    for corner in range(4):
        here, ahead, behind = (points[faces[:, (corner + k) % 4]] for k in (0, 1, 3))
        across = np.cross(ahead - here, behind - here)
        np.add.at(normal, faces[:, corner], across / np.linalg.norm(across, axis=1)[:, None])
    return normal / np.linalg.norm(normal, axis=1)[:, None]


def forces(run, record, half):
    """Contact forces of the nodes (N): the pressure along the normal, and the shear. A half bears half of those on its
    plane, and a part across it, which the other half cancels."""
    contact = run.contact
    normal = normals(run, contact["displacement"][record])
    traction = contact["shear"][record] - contact["pressure"][record][:, None] * normal
    force = contact["area"][:][:, None] * traction
    if half:
        plane = np.abs(contact.points[:, 1]) < 1e-12
        force[plane] *= 0.5
        force[plane, 1] = 0.1 * force[plane, 2]
    return force


def write(run, deck, folder, *, begins, real="R8", order=None, files=1, without=(), skip=(), turned=()):
    """Writes ``binout0000`` and so on.

    Args:
        begins: time of the deck at which the run begins (s).
        real: type of the numbers, R4 or R8; times of nodout are always R8, as of LS-DYNA.
        order: the order of the nodes, as indices.
        files: in how many files, which LS-DYNA calls binout0000, binout0000%001 ...
        without: databases and nodes (by their index) that are left out.
        skip: records that ncforc lacks.
        turned: sides whose forces are those on the other body.
    """
    from lasso.dyna.lsda_py3 import Lsda

    contact, ids, body = run.contact, labels(run, deck), bodies(run)
    order = np.arange(len(ids)) if order is None else np.asarray(order)
    order = order[ids[order] > 0]
    shown = order[~np.isin(order, [node for node in without if not isinstance(node, str)])]
    folder.mkdir(parents=True, exist_ok=True)
    file = Lsda(str(folder / "binout0000"), "w")
    number = getattr(Lsda, real)

    def put(path, kind, **arrays):
        file.cd(path, 1)
        for name, array in arrays.items():
            file.write(name, kind, np.asarray(array).tolist())

    def axes(name, rows):
        return {f"{axis}_{name}": rows[:, i] for i, axis in enumerate("xyz")}

    sides = {"slave_1": order[body[order] == DISK], "master_1": order[body[order] == BAR]}
    for record, time in enumerate(contact.times + begins):
        if files > 1 and record and record % -(-len(contact.times) // files) == 0:
            file.nextfile()
        if not record and "nodout" not in without:
            put("/nodout/metadata", Lsda.I4, ids=ids[shown])
        if "nodout" not in without:
            displacement, velocity = (contact[name][record][shown] / LENGTH for name in ("displacement", "velocity"))
            moved = contact.points[shown] / LENGTH + displacement
            motion = axes("displacement", displacement) | axes("velocity", velocity) | axes("coordinate", moved)
            put(f"/nodout/d{record + 1:06d}", number, **motion)
            put(f"/nodout/d{record + 1:06d}", Lsda.R8, time=[time])
        if "ncforc" in without:
            continue
        force = forces(run, record, not ids.all()) / FORCE
        for name, rows in sides.items():
            sense = -1 if name in turned else 1
            if not record:
                put(f"/ncforc/{name}/metadata", Lsda.I4, ids=ids[rows])
            if record not in skip:
                put(f"/ncforc/{name}/d{record + 1:06d}", number, time=[time], **axes("force", sense * force[rows]))
    file.close()
