"""Results of CalculiX, OpenRadioss, code_aster and of tables: a run comes back from their files as it was."""

import json
import re
import runpy
import sys
from types import SimpleNamespace as Object

import creepage
import numpy as np
import pytest
from creepage import _foreign, _from_command

import foreign
from conftest import ROOT, resolved

# what the digits of the files leave: of the largest traction, of the largest slip velocity
EXACT, SIX = (1e-9, 1e-9), (2e-4, 2e-3)
LAW = ("--friction", "0.3", "--scale", "slip_speed=0.15556", "--scale", "dt=1e-7")


@pytest.fixture(scope="module")
def contact(there):
    return foreign.Contact(there[0])


def command(*words):
    """The exit code of a command."""
    return _from_command.main([str(word) for word in words])


def imported(*words, capsys):
    """What a command prints, and its run."""
    assert command(*words, "--json") == 0
    document = json.loads(capsys.readouterr().out)
    return document, creepage.Run(document["run"])


def same(found, contact, order, digits, bodies=(0, 1)):
    """Whether a run is that of ``contact``, whose nodes ``order`` are its nodes, to digits of tractions and slip."""
    # at the edge of what was recorded a part of the tributary area is missing
    inner = np.bincount(contact.faces.ravel())[order] == 4
    run, kept = contact.run, np.isin(contact.body[order], bodies) & inner
    assert np.allclose(found.contact.times, contact.times, rtol=1e-5, atol=1e-15)
    assert np.allclose(found.contact["area"][:][inner], run.contact["area"][:][order][inner], rtol=digits[0])
    for record in range(1, len(contact.times)):
        pressure, shear = resolved(run, record)
        most = pressure.max()
        for name, of in [("pressure", pressure), ("shear", shear)]:
            off = np.abs(found.contact[name][record] - of[order])[kept].max()
            assert off < digits[0] * most, (name, record)
        moved = found.contact["velocity"][record] - run.contact["velocity"][record][order]
        assert np.abs(moved).max() < 1e-5 * np.abs(run.contact["velocity"][record]).max()
    # the surfaces of the run are curved, those of the bricks flat: the projection lies elsewhere
    own = kept & (run.contact["pass_pressure"][1:][:, order] > 0)
    slip = run.contact["slip_velocity"][1:][:, order]
    off = np.linalg.norm(found.contact["slip_velocity"][1:] - slip, axis=2)[own]
    assert np.median(off) < (1e-4 + digits[1]) * np.linalg.norm(slip, axis=2).max()


def test_tables_come_back_exactly_and_are_judged(contact, tmp_path, capsys):
    foreign.tables(contact, tmp_path)
    document, found = imported("from-tables", tmp_path, *LAW, "--out", tmp_path / "out", capsys=capsys)
    assert document["notes"] == [] and document["records"] == len(contact.times)
    same(found, contact, np.arange(len(contact.ids)), EXACT)
    assert found.case["friction"] == {"law": "coulomb", "static": 0.3}
    assert found.check()["metrics"]["law_error"]["value"] > 0


def test_the_frd_of_calculix_comes_back_to_its_six_digits(contact, tmp_path, capsys):
    foreign.calculix(contact, tmp_path)
    words = (tmp_path / "job.frd", "--sets", tmp_path / "job.inp", "--wheel", "tread", "--rail", "TOP")
    document, found = imported("from-calculix", *words, *LAW, "--out", tmp_path / "out", capsys=capsys)
    same(found, contact, np.arange(len(contact.ids)), SIX, bodies=[1])
    # the independent surface has no contact stresses
    assert document["notes"] == ["there are no forces of the wheel: its side of the contact is not judged"]
    assert not found.contact.disk["pressure"][:].any()
    assert found.check()["metrics"]["law_error"]["value"] > 0


def test_med_files_of_code_aster_come_back_exactly(contact, tmp_path, capsys):
    foreign.aster(contact, tmp_path / "job.med")
    words = (tmp_path / "job.med", "--wheel", "TREAD", "--rail", "TOP", *LAW)
    document, found = imported("from-aster", *words, "--out", tmp_path / "out", capsys=capsys)
    same(found, contact, np.arange(len(contact.ids)), EXACT, bodies=[0])
    assert "no forces of the rail" in document["notes"][0]


def test_animation_files_of_openradioss_come_back_to_their_six_digits(there, contact, tmp_path, capsys):
    _, deck, begins = there
    foreign.openradioss(contact, deck, tmp_path, begins)
    document, found = imported("from-openradioss", tmp_path, "--deck", deck, "--out", tmp_path / "out", capsys=capsys)
    assert document["notes"] == ["case.toml is the case of the deck, as of import-k"]
    same(found, contact, np.argsort(foreign.binout.labels(contact.run, deck)), SIX)


def test_what_a_file_lacks_is_named(there, contact, tmp_path, capsys):
    foreign.calculix(contact, tmp_path)
    foreign.tables(contact, tmp_path)
    foreign.aster(contact, tmp_path / "job.med")
    foreign.openradioss(contact, there[1], tmp_path, there[2])
    frd, inp, values, vtk = (tmp_path / name for name in ("job.frd", "job.inp", "values.csv", "deckA001.vtk"))
    whole = {file: file.read_text() for file in (frd, inp, values, vtk)}
    sets = ("--sets", inp, "--wheel", "TREAD", "--rail", "TOP")
    calculix, tables = ("from-calculix", frd, *sets), ("from-tables", tmp_path)
    radioss = ("from-openradioss", tmp_path, "--deck", there[1])
    for words, file, change, said in [
        (calculix, frd, lambda text: text.replace("VELO", "NDTE"), r"no VELO.*in a step of \*DYNAMIC"),
        (calculix, frd, lambda text: text.replace("CONTACT", "CELS   "), r"no CONTACT.*\*CONTACT FILE"),
        (calculix, frd, lambda text: text[: text.rindex(" -3")], "cut short"),
        (calculix, frd, lambda text: text.replace("E+", "E?"), "damaged"),
        (calculix, inp, lambda text: text.replace("Top", "Bottom"), "no set TOP; it has: BOTTOM, TREAD"),
        (tables, values, lambda text: text.replace("force_z", "fz"), "no column force_z"),
        (tables, values, lambda text: text.rstrip().rsplit("\n", 1)[0], "other nodes at"),
        (radioss, vtk, lambda text: text.replace("Contact_Forces", "Forces"), "/ANIM/VECT/CONT"),
        (radioss, vtk, lambda text: text[: len(text) // 2], "cut short"),
        (("from-aster", tmp_path / "job.med", "--wheel", "A", "--rail", "TOP"), vtk, str, "no set A; it has: TOP, TREAD"),
        (("from-aster", frd, "--wheel", "A", "--rail", "TOP"), frd, str, "cannot be read"),
        ((*tables, "--friction", "a"), values, str, "STATIC,DYNAMIC,DECAY"),
        ((*tables, "--unit", "mm-lb-s"), values, str, "mm-lb-s"),
    ]:
        file.write_text(change(whole[file]))
        assert command(*words, "--out", tmp_path / "out") == 2, words
        line = " ".join(capsys.readouterr().err.split())
        assert re.search(said, line), line
        file.write_text(whole[file])
    assert not (tmp_path / "out").exists()


def test_faces_look_outwards_whatever_the_order_of_the_corners():
    points = np.array([[x, y, z] for z in (0.0, 1, 2) for y in (0.0, 1) for x in (0.0, 1)])
    bricks = np.array([[0, 1, 3, 2, 4, 5, 7, 6], [4, 6, 7, 5, 8, 10, 11, 9]])
    faces = _foreign.skin(points, bricks, np.ones(12, bool))
    assert len(faces) == 10
    corners = points[faces]
    across = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    assert (np.sum(across * (corners.mean(axis=1) - (0.5, 0.5, 1)), axis=1) > 0).all()
    assert np.allclose(sum(_foreign.tributary(points, face[None]) for face in faces).sum(), 10)


def test_the_script_for_abaqus_writes_the_tables(contact, tmp_path, capsys, monkeypatch):
    """Against stand-ins for the objects of an output database, as Abaqus's reference describes them."""
    count, bodies = len(contact.ids), contact.body[contact.faces[:, 0]]
    every = np.vstack([contact.points, contact.inner])
    nodes = [Object(label=n + 1, coordinates=x.astype("f4")) for n, x in enumerate(every)]
    elements = [Object(instanceNames=["WHOLE"] * 8, connectivity=[n + 1 for n in brick]) for brick in contact.bricks]
    surface = {
        name: Object(elements=[[e for e, of in zip(elements, bodies) if of == body]], faces=[["FACE2"] * count])
        for body, name in enumerate(("TREAD", "TOP"))
    }

    def field(values):
        whole = Object(name="WHOLE")
        return Object(
            values=[Object(instance=whole, nodeLabel=n + 1, precision=2, dataDouble=x) for n, x in enumerate(values)]
        )

    frames = []
    for record, time in enumerate(contact.times):
        moved, velocity = contact.motion(record)
        force = contact.force(record)
        fields = {"U": moved, "V": velocity, "CPRESS   TREAD/TOP": force}
        fields |= {"CNORMF   TREAD/TOP": force * (0, 0, 1), "CSHEARF  TREAD/TOP": force * (1, 1, 0)}
        frames.append(Object(frameValue=time, fieldOutputs={name: field(rows) for name, rows in fields.items()}))
    assembly = Object(instances={"WHOLE": Object(nodes=nodes)}, surfaces=surface)
    odb = Object(steps={"roll": Object(totalTime=0.0, frames=frames)}, rootAssembly=assembly)
    monkeypatch.setitem(sys.modules, "odbAccess", Object(openOdb=lambda path, readOnly: odb))
    monkeypatch.setitem(sys.modules, "abaqusConstants", Object(DOUBLE_PRECISION=2))
    monkeypatch.setattr(sys, "argv", ["abaqus.py", "job.odb", "TREAD", "TOP"])
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(ROOT / "crates" / "python" / "examples" / "abaqus.py"))
    _, found = imported("from-tables", tmp_path, *LAW, "--out", tmp_path / "out", capsys=capsys)
    # coordinates have four bytes
    same(found, contact, np.arange(count), (1e-5, 1e-3))
