"""Meshes of other programs."""

import creepage
import numpy as np
import pytest

from conftest import ROOT

meshio = pytest.importorskip("meshio")


def two_bricks():
    """A brick on a brick, with sets of every kind that meshio knows."""
    cube = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    points = np.concatenate([cube, cube - [0, 0, 1]]) * 1e-3
    return meshio.Mesh(
        points,
        [("hexahedron", [range(8), range(8, 16)]), ("quad", [[0, 3, 2, 1]]), ("line", [[0, 1]])],
        point_sets={"hub": [4, 5, 6, 7], "top": [12, 13, 14, 15], "low": [8, 9, 10, 11]},
        cell_sets={"disk": [[0], [], []], "tread": [[], [0], []]},
    )


def written(path):
    found = meshio.read(path)
    return found, found.point_data, found.cell_data


def test_sets_of_a_mesh_become_arrays_of_zeros_and_ones(tmp_path):
    keys = creepage.mesh.from_meshio(
        two_bricks(), {"bar": [1], "clamp": "low"}, out=tmp_path / "mesh.vtu", unit="mm"
    )
    assert keys == {"file": str(tmp_path / "mesh.vtu"), "unit": "mm"}
    found, points, cells = written(keys["file"])
    assert np.array_equal(found.points, two_bricks().points)
    assert [(block.type, len(block.data)) for block in found.cells] == [("hexahedron", 2), ("quad", 1)]
    assert [list(part) for part in cells["disk"]] == [[1, 0], [0]]
    assert [list(part) for part in cells["bar"]] == [[0, 1], [0]]
    assert [list(part) for part in cells["tread"]] == [[0, 0], [1]]
    assert list(np.flatnonzero(points["clamp"])) == [8, 9, 10, 11]


def test_a_written_mesh_reads_as_itself(tmp_path):
    first = creepage.mesh.from_meshio(two_bricks(), {"bar": [1], "clamp": "low"}, out=tmp_path / "a.vtu")
    again = creepage.mesh.from_meshio(first["file"], out=tmp_path / "b.vtu")
    (one, *ours), (other, *theirs) = written(first["file"]), written(again["file"])
    assert np.array_equal(one.points, other.points)
    for data, same in zip(ours, theirs):
        for name in same:
            assert np.array_equal(np.hstack(data[name]), np.hstack(same[name])), name


def test_what_cannot_be_a_mesh_is_refused_by_name(tmp_path):
    out = tmp_path / "mesh.vtu"
    mesh = two_bricks()
    for sets, said in [
        ({}, "no set bar, clamp; it has: disk, hub, low, top, tread"),
        ({"bar": "rail"}, "bar = 'rail'.*it has"),
        ({"rail": "bar"}, "it may have disk, bar"),
        ({"clamp": [16]}, "has the index 16; there are 16"),
        ({"clamp": [0, -1]}, "has the index -1"),
        ({"clamp": [0.5]}, "float64 numbers"),
        ({"clamp": np.ones(3, bool)}, r"shape \(3,\)"),
    ]:
        with pytest.raises(creepage.CaseError, match=said):
            creepage.mesh.from_meshio(mesh, sets, out=out)
    tets = meshio.Mesh(mesh.points, [("tetra", [[0, 1, 2, 4]]), *mesh.cells])
    with pytest.raises(creepage.CaseError, match="1 cells of the type tetra"):
        creepage.mesh.from_meshio(tets, out=out)
    with pytest.raises(creepage.CaseError, match="meshio cannot read"):
        creepage.mesh.from_meshio(tmp_path / "none.msh", out=out)
    assert not out.exists()


def test_sets_that_an_abaqus_file_continues_are_whole(tmp_path):
    file = tmp_path / "mesh.inp"
    mesh = two_bricks()
    nodes = [f"{i}, {x!r}, {y!r}, {z!r}" for i, (x, y, z) in enumerate(mesh.points.tolist(), 1)]
    bricks = ["1, 1, 2, 3, 4, 5, 6, 7, 8", "2, 9, 10, 11, 12, 13, 14, 15, 16"]
    sets = ["*ELSET, ELSET=disk", "1,", "*ELSET, ELSET=bar", "2,", "*NSET, NSET=low", "9, 10", "*NSET, NSET=low", "11, 12"]
    lines = ["*HEADING", "two bricks", "*NODE", *nodes, "*ELEMENT, TYPE=C3D8", *bricks, *sets]
    file.write_text("\n".join(lines) + "\n")
    names = {name: "low" for name in ("hub", "tread", "top", "clamp")}
    keys = creepage.mesh.from_meshio(file, names, out=tmp_path / "mesh.vtu")
    found, points, cells = written(keys["file"])
    assert np.array_equal(found.points, mesh.points)
    assert list(np.flatnonzero(points["clamp"])) == [8, 9, 10, 11]
    assert [list(part) for part in cells["bar"]] == [[0, 1]]


def test_sets_of_an_abaqus_file_are_whole_however_they_are_given(tmp_path):
    mesh = two_bricks()
    nodes = [f"{i}, {x!r}, {y!r}, {z!r}" for i, (x, y, z) in enumerate(mesh.points.tolist(), 1)]
    (tmp_path / "nodes.inc").write_text("\n".join(["*Node, Nset=ALL", *nodes]) + "\n")
    lines = [
        *["*HEADING", "two bricks", "*INCLUDE, INPUT=nodes.inc", "*ELSET, ELSET=disk, GENERATE", "1, 1"],
        # the first brick goes on in a second line
        *["*Element, Type=C3D8, Elset=both", "1, 1, 2, 3, 4,", "5, 6, 7, 8"],
        *["*Element, Type=C3D8, Elset=Both", "2, 9, 10, 11, 12, 13, 14, 15, 16"],
        *["*NSET, NSET=low, GENERATE", "9, 10", "** a remark", "11, 12, 1"],
        *["*NSET, NSET=hub, GENERATE", "1, 3, 2"],
        *["*NSET, NSET=Hub", "5, low,", "*ELSET, ELSET=bar", "BOTH"],
    ]
    file = tmp_path / "mesh.inp"
    file.write_text("\n".join(lines) + "\n")
    names = {"tread": "low", "top": "ALL", "clamp": "low"}
    keys = creepage.mesh.from_meshio(file, names, out=tmp_path / "mesh.vtu")
    _, points, cells = written(keys["file"])
    assert list(np.flatnonzero(points["clamp"])) == [8, 9, 10, 11]
    assert list(np.flatnonzero(points["hub"])) == [0, 2, 4, 8, 9, 10, 11]
    assert points["top"].all()
    assert [list(part) for part in cells["disk"]] == [[1, 0]]
    assert [list(part) for part in cells["bar"]] == [[1, 1]]


def test_only_files_of_this_package_are_replaced(tmp_path):
    sets = {"bar": [1], "clamp": "low"}
    theirs, ours = tmp_path / "theirs.vtu", tmp_path / "ours.vtu"
    two_bricks().write(theirs)
    before = theirs.read_bytes()
    for mesh in (two_bricks(), theirs):
        with pytest.raises(creepage.CaseError, match="did not write it|is what is read"):
            creepage.mesh.from_meshio(mesh, sets, out=theirs)
    assert theirs.read_bytes() == before
    for _ in range(2):
        creepage.mesh.from_meshio(two_bricks(), sets, out=ours)
    with pytest.raises(creepage.CaseError, match="is what is read"):
        creepage.mesh.from_meshio(ours, out=ours)


SMALL = ROOT / "meshes" / "small.msh"
# what the small mesh is of
OF_SMALL = {
    "disk": {"radius": 0.1, "hub_radius": 0.05, "width": 0.02},
    "bar": {"length": 0.1, "width": 0.02, "height": 0.02, "start": -0.05},
    "load": {"normal": 2e3},
    "drive": {"speed": 16.0, "creepage": 2e-3, "ramp": 1e-4},
    "friction": {"static": 0.5},
    "time": {"roll": 4e-4},
    "mesh": {"zone": {"size": 2e-3, "length": 0.024, "width": 0.008, "depth": 0.004, "start": -0.012}},
}


@pytest.mark.parametrize("other", ["small.msh", "small-2.2.msh", "small.inp", "small.vtu"])
def test_a_mesh_through_meshio_is_to_the_bit_that_of_a_file_read_natively(tmp_path, other):
    through = creepage.mesh.from_meshio(SMALL.with_name(other), out=tmp_path / "through.vtu")
    for name, keys in (("file", {"file": str(SMALL)}), ("meshio", through)):
        creepage.mesh(OF_SMALL, tmp_path / f"{name}.vtu", mesh=keys)
    assert (tmp_path / "file.vtu").read_bytes() == (tmp_path / "meshio.vtu").read_bytes()


def small_sets():
    """The small mesh, and its sets as masks of the cells of each block."""
    mesh = meshio.read(SMALL.with_suffix(".vtu"))
    return mesh, {name: [part == 1 for part in parts] for name, parts in mesh.cell_data.items()}


def with_families(path):
    """Sets as groups of the families of a MED file: the cells of a family are in the same sets."""
    mesh, sets = small_sets()
    codes = [sum((1 << k) * part for k, part in enumerate(parts)) for parts in zip(*sets.values())]
    groups = {-int(code): [n for k, n in enumerate(sets) if code >> k & 1] for code in np.unique(np.hstack(codes))}
    made = meshio.Mesh(mesh.points, mesh.cells, cell_data={"cell_tags": [-part for part in codes]})
    made.cell_tags = groups
    made.write(path)


def with_arrays(path):
    """Sets as arrays of zeros and ones."""
    mesh, _ = small_sets()
    mesh.write(path)


def with_blocks(path):
    """Sets of nodes, and bodies as element blocks of an Exodus file."""
    mesh, sets = small_sets()
    quads, bricks = (block.data for block in mesh.cells)
    bodies = [("hexahedron", bricks[sets[name][1]]) for name in ("disk", "bar")]
    nodes = {name: np.unique(quads[sets[name][0]]) for name in ("hub", "tread", "top", "clamp")}
    meshio.Mesh(mesh.points, bodies, point_sets=nodes).write(path)
    # meshio numbers the blocks and names none
    with pytest.importorskip("netCDF4").Dataset(path, "a") as file:
        file.createVariable("eb_names", "S1", ("num_el_blk", "len_string"))[0, :4] = list("disk")
    return {"bar": "1"}


@pytest.mark.parametrize(
    "name, write", [("m.med", with_families), ("m.XDMF", with_arrays), ("m.exo", with_blocks)]
)
def test_a_case_reads_a_file_of_meshio_to_the_bit_as_one_that_it_reads_itself(tmp_path, name, write):
    sets = write(tmp_path / name) or {}
    creepage.mesh(OF_SMALL, tmp_path / "own.vtu", mesh={"file": str(SMALL)})
    creepage.mesh(OF_SMALL, tmp_path / "meshio.vtu", mesh={"file": str(tmp_path / name), "sets": sets})
    assert (tmp_path / "own.vtu").read_bytes() == (tmp_path / "meshio.vtu").read_bytes()


def test_sets_that_have_numbers_alone_go_by_them(tmp_path):
    mesh, sets = small_sets()
    numbers = [sum((k + 1) * part for k, part in enumerate(parts)) for parts in zip(*sets.values())]
    made = meshio.Mesh(mesh.points, mesh.cells, cell_data={"nastran:ref": numbers})
    meshio.nastran.write(tmp_path / "m.bdf", made, point_format="fixed-large")
    names = {name: str(k + 1) for k, name in enumerate(sets)}
    found = creepage.mesh(OF_SMALL, mesh={"file": str(tmp_path / "m.bdf"), "sets": names})
    assert found["bodies"] == creepage.mesh(OF_SMALL, mesh={"file": str(SMALL)})["bodies"]


def test_files_of_meshio_are_refused_by_their_names_with_what_to_do(tmp_path, monkeypatch):
    def refused(name, said, help, sets={}):
        with pytest.raises(creepage.CaseError) as error:
            creepage.mesh(OF_SMALL, mesh={"file": str(tmp_path / name), "sets": sets})
        assert name in error.value.message and said in error.value.message, error.value.message
        assert help in error.value.help

    with_families(tmp_path / "m.med")
    refused("m.med", "no set `axle`", "mesh.sets.hub", {"hub": "axle"})
    (tmp_path / "cut.med").write_bytes((tmp_path / "m.med").read_bytes()[:5000])
    refused("cut.med", "meshio cannot read it: Unable", "write the file anew")
    (tmp_path / "no.avs").write_text("no mesh")
    refused("no.avs", "meshio cannot read it", "write the file anew")
    meshio.Mesh(np.eye(4, 3), [("tetra", [[0, 1, 2, 3]])]).write(tmp_path / "tets.vtk")
    refused("tets.vtk", "element 0 is a tetrahedron", "linear hexahedra")
    # a package that cannot be imported is one that is missing
    (tmp_path / "h5py.py").write_text("raise ImportError(name='h5py')")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    refused("m.med", "h5py is needed", "pip install 'creepage[mesh]'")
    (tmp_path / "meshio.py").write_text("raise ImportError(name='meshio')")
    refused("m.med", "meshio is needed", "pip install 'creepage[mesh]'")


def test_every_ending_that_is_read_through_meshio_is_one_of_meshio(tmp_path):
    with pytest.raises(creepage.CaseError, match="for meshio, in one of") as error:
        creepage.mesh(OF_SMALL, mesh={"file": str(tmp_path / "m.foo")})
    endings = error.value.message.split("in one of ")[1].split(", ")
    assert set(endings) <= set(meshio.extension_to_filetypes) and ".med" in endings
