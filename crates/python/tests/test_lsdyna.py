"""Results of LS-DYNA: a run that goes through binout files and its keyword file comes back as it was."""

import json
import re
import shutil
import sys

import creepage
import h5py
import numpy as np
import pytest
from creepage import _from_command, _lsdyna

import binout
import foreign
from conftest import RECORDED, computed, resolved, values

pytest.importorskip("lasso.dyna.lsda_py3")
# the first record is that of the preload: it has no shear, which digits cannot tell from a little
ROLLING = (1e-6, 1.0)
SECOND = 3


@pytest.fixture(scope="module")
def imported(there):
    run, deck, begins = there
    binout.write(run, deck, deck.parent, begins=begins)
    return creepage.from_lsdyna(deck.parent, out=deck.parent.parent / "imported")


def order_of(there):
    """The nodes of the run in the order of their numbers in the deck."""
    return np.argsort(binout.labels(*there[:2]))


def test_tractions_and_motion_come_back_to_the_digits_of_the_deck(there, imported):
    run, order = there[0], order_of(there)
    assert np.allclose(imported.contact.times, run.contact.times, rtol=0, atol=1e-15)
    assert np.allclose(imported.contact.points, run.contact.points[order], rtol=0, atol=1e-11)
    assert np.allclose(imported.contact["area"][:], run.contact["area"][:][order], rtol=1e-8)
    for record in range(len(run.contact.times)):
        pressure, shear = resolved(run, record)
        most = pressure.max()
        assert np.allclose(imported.contact["pressure"][record], pressure[order], rtol=0, atol=1e-8 * most)
        assert np.allclose(imported.contact["shear"][record], shear[order], rtol=0, atol=1e-8 * most)
        for name in ("velocity", "displacement"):
            assert np.allclose(imported.contact[name][record], run.contact[name][record][order], rtol=1e-14, atol=1e-18)


def test_the_check_of_an_imported_run_is_that_of_the_run(there, imported, tmp_path):
    run = there[0]
    shutil.copy(run.path / "contact.vtkhdf", tmp_path)
    for name in ("case.toml", "mesh.inp"):
        shutil.copy(imported.path / name, tmp_path)
    count = len(run.contact.points)
    with h5py.File(tmp_path / "contact.vtkhdf", "r+") as file:
        file.attrs["case_hash"] = "imported"
        for record in range(len(run.contact.times)):
            rows = slice(record * count, (record + 1) * count)
            for name, of in zip(("pressure", "shear"), resolved(run, record)):
                file["VTKHDF/PointData"][name][rows] = of
    before, after = (values(one.check(window=ROLLING)) for one in (creepage.Run(tmp_path), imported))
    shared = {key: value for key, value in after.items() if value is not None and before.get(key) is not None}
    # slip between the bodies is found from positions and velocities; the run's own at a node that does not penetrate
    # is that of the nodes which load it
    exact = [
        key for key in shared if key[1] == "pair" or key[0] in ("tension", "cone", "law_error", "violating_fraction")
    ]
    assert {"law_error", "direction", "wrong_direction", "dissipation", "adhesion_slip", "violating_fraction",
            "law_scatter", "tension", "cone"} == {key[0] for key in exact}  # fmt: skip
    for key in exact:
        assert shared[key] == pytest.approx(before[key], rel=1e-8, abs=1e-10), key
    # what nobody recorded is not judged
    for name in ("penetration", "mu_error", "violating_fraction_slip_state"):
        assert imported.check(window=ROLLING)["metrics"][name]["value"] is None


def test_slip_is_that_of_the_run_at_nodes_that_penetrate(there, imported):
    run, order = there[0], order_of(there)
    own = run.contact["pass_pressure"][1:][:, order] > 0
    slip = run.contact["slip_velocity"][1:][:, order]
    off = np.linalg.norm(imported.contact["slip_velocity"][1:] - slip, axis=2)
    # the surfaces of the run are curved, those of the deck flat: the projection lies elsewhere
    assert np.max(off[own]) < 1e-2 * np.max(np.linalg.norm(slip, axis=2))
    assert np.median(off[own]) < 1e-4 * np.max(np.linalg.norm(slip, axis=2))


def test_other_files_orders_and_missing_states_change_nothing_else(there, imported, tmp_path):
    run, deck, begins = there
    order = np.random.default_rng(SECOND).permutation(len(run.contact.points))
    binout.write(run, deck, tmp_path, begins=begins, order=order, files=3, skip=[7])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["binout0000", "binout0000%001", "binout0000%002"]
    out = tmp_path / "out"
    document = _lsdyna.imported(tmp_path, deck, out, {"unit": "mm-ton-s"}, {})
    assert (document["unmatched"], document["records"]) == (1, len(run.contact.times) - 1)
    kept = np.delete(np.arange(len(run.contact.times)), 7)
    found = creepage.Run(out).contact
    for name in ("pressure", "shear", "velocity", "displacement"):
        assert np.array_equal(found[name][:], imported.contact[name][:][kept]), name
    # a projection begins where that of the state before ended
    assert np.allclose(found["slip_velocity"][:], imported.contact["slip_velocity"][:][kept], rtol=0, atol=1e-9)


def test_forces_on_the_other_body_are_turned_over(there, imported, tmp_path):
    run, deck, begins = there
    binout.write(run, deck, tmp_path, begins=begins, turned=["master_1"])
    document = _lsdyna.imported(tmp_path, deck, tmp_path / "out", {"unit": "mm-ton-s"}, {})
    assert document["notes"][1:] == ["the forces of ncforc/master_1 pull: they were taken as those on the other body"]
    assert np.array_equal(creepage.Run(tmp_path / "out").contact["shear"][:], imported.contact["shear"][:])


def test_half_a_model_becomes_the_whole(tmp_path):
    run, deck, begins = computed(tmp_path, {**RECORDED, "mesh.symmetry": "half", "output.contact_interval": 5e-6})
    binout.write(run, deck, deck.parent, begins=begins)
    whole = creepage.from_lsdyna(deck.parent, out=tmp_path / "imported").contact
    assert len(whole.points) == len(run.contact.points)
    for mine, theirs in [(whole.disk, run.contact.disk), (whole.bar, run.contact.bar)]:
        order = [np.argmin(np.linalg.norm(theirs.points - point, axis=1)) for point in mine.points]
        assert np.allclose(mine.points, theirs.points[order], rtol=0, atol=1e-10)
        assert np.allclose(mine["area"][:], theirs["area"][:][order], rtol=1e-8)
        for name in ("velocity", "displacement"):
            assert np.allclose(mine[name][-1], theirs[name][-1][order], rtol=1e-12, atol=1e-18)
        most = theirs["pressure"][-1].max()
        # to what lies between the normals of both surfaces
        assert np.allclose(mine["pressure"][-1], theirs["pressure"][-1][order], rtol=0, atol=5e-3 * most)
        assert np.allclose(mine["shear"][-1], theirs["shear"][-1][order], rtol=0, atol=5e-3 * most)


def test_numbers_of_four_bytes_keep_their_digits(there, imported, tmp_path):
    run, deck, begins = there
    binout.write(run, deck, tmp_path, begins=begins, real="R4")
    single = creepage.from_lsdyna(tmp_path, deck, out=tmp_path / "out")
    assert len(single.contact.times) == len(run.contact.times)
    # at an edge between faces the slip velocity jumps by the gap over their length
    for name, close in [("pressure", 1e-6), ("shear", 1e-6), ("velocity", 1e-7), ("slip_velocity", 1e-3)]:
        off = np.abs(single.contact[name][:] - imported.contact[name][:]).max()
        assert 0 < off < close * np.abs(imported.contact[name][:]).max(), name
    mine, theirs = (values(one.check(window=ROLLING))["law_error", "pair", "before"] for one in (single, imported))
    assert mine == pytest.approx(theirs, rel=1e-3)


def test_d3plot_stands_in_for_nodout_at_its_own_times_and_digits(there, imported, tmp_path):
    run, deck, begins = there
    binout.write(run, deck, tmp_path, begins=begins, without=["nodout"])
    foreign.d3plot(run, deck, tmp_path, begins, every=5)
    document = _lsdyna.imported(tmp_path, deck, tmp_path / "out", {"unit": "mm-ton-s"}, {})
    kept = np.arange(0, len(run.contact.times), 5)
    assert (document["records"], document["unmatched"]) == (len(kept), len(run.contact.times) - len(kept))
    interval = np.diff(run.contact.times[kept]).max()
    assert f"one state in {interval:.3g} of" in document["notes"][0]
    found = creepage.Run(tmp_path / "out").contact
    # 16 mm in four bytes leave 2e-6 mm, over faces of 0.8 mm
    for name, close in [("pressure", 1e-5), ("shear", 1e-5), ("velocity", 1e-7)]:
        off = np.abs(found[name][:] - imported.contact[name][:][kept]).max()
        assert 0 < off < close * np.abs(imported.contact[name][:]).max(), name


def test_without_contact_forces_nothing_is_judged(there, capsys, tmp_path):
    run, deck, begins = there
    foreign.d3plot(run, deck, tmp_path, begins)
    (tmp_path / "intfor").write_bytes(b"")
    line = " ".join(refused(capsys, tmp_path, "--deck", deck, "--out", tmp_path / "out").split())
    for said in ["no binout; d3plot has no contact forces", "intfor cannot be read by lasso-python", "DATABASE_NCFORC"]:
        assert said in line, line
    binout.write(run, deck, tmp_path, begins=begins, without=["nodout"])
    (tmp_path / "d3plot").write_bytes((tmp_path / "d3plot").read_bytes()[:1000])
    assert "d3plot is damaged" in refused(capsys, tmp_path, "--deck", deck, "--out", tmp_path / "out")


def refused(capsys, *words):
    """What the command says on standard error where it ends with 2."""
    assert _from_command.main(["from-lsdyna", *map(str, words)]) == 2
    return capsys.readouterr().err


def test_a_damaged_or_incomplete_binout_is_refused_by_name(there, capsys, tmp_path):
    run, deck, begins = there
    loaded = int(np.argmax(run.contact["pressure"][-1]))
    number = binout.labels(run, deck)[loaded]
    for name, written, said in [
        ("no-forces", {"without": ["ncforc"]}, "no ncforc;.*DATABASE_NCFORC.*SPR = MPR = 1"),
        ("no-motion", {"without": ["nodout"]}, "no nodout;.*DATABASE_NODOUT.*DATABASE_HISTORY_NODE_SET"),
        ("no-node", {"without": [loaded]}, f"nodout lacks node {number}.*DATABASE_HISTORY_NODE_SET"),
        ("no-time", {"skip": range(len(run.contact.times))}, "ncforc/.* is empty.*DATABASE_NCFORC"),
        ("cut", {}, "binout0000 is damaged or cut short"),
        ("changed", {}, "binout0000 is damaged or cut short"),
    ]:
        folder = tmp_path / name
        binout.write(run, deck, folder, begins=begins, **written)
        whole = (folder / "binout0000").read_bytes()
        if name == "cut":
            (folder / "binout0000").write_bytes(whole[: len(whole) // 2])
        if name == "changed":
            (folder / "binout0000").write_bytes(whole[:4] + b"\7\7\7" + whole[7:])
        line = refused(capsys, folder, "--deck", deck, "--out", folder / "out")
        assert re.search(said, " ".join(line.split())), line
        assert not (folder / "out" / "contact.vtkhdf").exists()
    assert "holds no binout" in refused(capsys, deck.parent.parent / "run", "--out", tmp_path / "out")
    assert "keyword file" in refused(capsys, tmp_path / "no-node", "--out", tmp_path / "out")


def test_sides_that_the_contact_does_not_have_are_refused(there, imported, capsys, tmp_path):
    deck = there[1]
    words = (deck.parent, "--out", tmp_path / "out")
    assert "a contact with side 7" in refused(capsys, *words, "--wheel", 7)
    assert "invalid value 'slip_speed'" in refused(capsys, *words, "--scale", "slip_speed")
    assert "mm-lb-s" in refused(capsys, *words, "--unit", "mm-lb-s")
    assert "is there already" in refused(capsys, deck.parent, "--out", imported.path)
    assert not (tmp_path / "out").exists()


def test_the_contact_of_any_model_is_judged_by_its_own_friction(there, imported, capsys, tmp_path):
    deck = there[1]
    other = deck.read_text().replace("*MAT_ELASTIC\n", "*MAT_PLASTIC_KINEMATIC\n")
    (tmp_path / "other.k").write_text(re.sub(r"(\*CONTACT_AUTOMATIC_SURFACE_TO_SURFACE)\n", r"\1_ID\n1\n", other))
    out = tmp_path / "out"
    words = [deck.parent, "--deck", tmp_path / "other.k", "--wheel", 11, "--scale", "slip_speed=0.15556", "--out", out]
    assert _from_command.main(["from-lsdyna", *map(str, words), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert "MAT_PLASTIC_KINEMATIC" in document["notes"][0] and document["records"] == len(imported.contact.times)
    found = creepage.Run(out)
    assert found.case["friction"] == {"law": "coulomb", "static": 0.3}
    assert np.array_equal(found.contact["shear"][:], imported.contact["shear"][:])
    assert found.check()["metrics"]["law_error"]["value"] > 0
    # sides the other way round
    turned = creepage.from_lsdyna(deck.parent, deck, out=tmp_path / "turned", rail=11)
    assert len(turned.contact.disk.points) == len(imported.contact.bar.points)


def test_without_lasso_a_line_says_what_to_install(there, capsys, monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "lasso.dyna.lsda_py3", None)
    line = refused(capsys, there[1].parent, "--out", tmp_path / "out")
    assert 'pip install "creepage[lsdyna]"' in line
