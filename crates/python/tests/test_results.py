"""Results as NumPy arrays, frames and meshes."""

import json
import subprocess
import sys

import creepage
import h5py
import numpy as np
import pytest


@pytest.fixture(scope="module")
def pressure(small):
    """Pressure as h5py reads it, one row per record."""
    with h5py.File(small.path / "contact.vtkhdf") as file:
        return file["VTKHDF/PointData/pressure"][()].reshape(small.contact.steps, -1)


def test_a_field_is_what_h5py_reads(small, pressure):
    field = small.contact["pressure"]
    assert field.shape == pressure.shape and field.units == "Pa"
    for index in (0, -1, np.s_[1:3], np.s_[::2], np.s_[::-1], np.s_[-2:, 3], np.s_[[0, 2]], np.s_[2, 1:4]):
        assert np.array_equal(field[index], pressure[index]), index
    assert np.array_equal(field, pressure)
    assert field[5:2].shape == (0, pressure.shape[1])
    with pytest.raises(IndexError):
        field[len(field)]


def test_records_are_chosen_by_time(small, pressure):
    times = small.contact.times
    field = small.contact["pressure"]
    assert np.array_equal(field.at(times[2] + 1e-9), pressure[2])
    assert np.array_equal(field.window(times[1], times[3]), pressure[1:4])
    assert np.array_equal(field[times[1] : times[3]], pressure[1:4])
    assert np.array_equal(field.window(None, times[0]), pressure[:1])


def test_the_sides_part_the_nodes_of_the_contact(small, pressure):
    disk, bar = small.contact.disk, small.contact.bar
    assert len(disk.points) + len(bar.points) == len(small.contact.points)
    both = np.concatenate([disk["pressure"][-1], bar["pressure"][-1]])
    assert np.array_equal(both, pressure[-1])
    assert bar["shear"].shape == (small.contact.steps, len(bar.points), 3)
    assert bar.points[bar.quads].shape == (len(bar.quads), 4, 3)
    # the bar lies below, and its centre line runs forward
    line = bar.points[bar.line()]
    assert np.all(np.diff(line[:, 0]) > 0) and np.allclose(line[:, 1], 0.0)
    assert bar["area"].shape == (len(bar.points),) and bar["area"][:].sum() > 0


def test_the_history_is_a_mapping_of_arrays(small):
    history = small.history
    assert history["time"].shape == history["normal_force"].shape
    assert history.units["normal_force"] == "N"
    with pytest.raises(KeyError, match="normal_force"):
        history["normal force"]


def test_the_history_becomes_a_frame(small):
    pytest.importorskip("pandas")
    frame = small.history.to_pandas()
    assert frame.index.name == "time" and frame.attrs["units"]["creepage"] == "1"
    assert np.array_equal(frame["normal_force"], small.history["normal_force"])


def test_a_record_becomes_a_pyvista_grid(small):
    pytest.importorskip("pyvista")
    fields = small.to_pyvista()
    assert fields.n_cells == small.summary["elements"]
    assert np.array_equal(fields.point_data["displacement"], small.fields["displacement"][-1])
    assert fields.cell_data["stress"].shape == (fields.n_cells, 6)
    contact = small.to_pyvista(0, what="contact")
    assert np.array_equal(contact["pressure"], small.contact["pressure"][0])
    # bricks and faces that are not inside out
    assert fields.compute_cell_sizes()["Volume"].min() > 0


def test_a_check_is_the_document_of_the_command_line(small):
    found = small.check(limits={"law_error": 1e-9})
    words = [sys.executable, "-m", "creepage", "check", small.path, "--limit", "law_error=1e-9", "--json"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert found == json.loads(done.stdout) and done.returncode == 1
    assert not found["pass"]
    with pytest.raises(creepage.LimitError, match="law_error") as caught:
        small.check(limits={"law_error": 1e-9}, strict=True)
    assert caught.value.code == 1
    with pytest.raises(creepage.LimitError) as caught:
        small.check(limits={"law_error_let_slip": 1e-30}, strict=True)
    assert "law_error_slip_state" in str(caught.value) and "law_error_let_slip" not in str(caught.value)
    with pytest.raises(creepage.CaseError, match="no_such_measure"):
        small.check(limits={"no_such_measure": 1.0})


def test_figures_and_the_page_are_written(small, tmp_path):
    figures = small.figures(tmp_path, format=["svg", "pdf"])
    assert figures and all(file.stat().st_size > 0 for files in figures.values() for file in files)
    page = small.report(tmp_path / "page.html")
    assert page.read_text().lstrip().lower().startswith("<!doctype html")


def test_a_folder_without_a_run_is_refused(tmp_path):
    with pytest.raises(creepage.CaseError, match="no run"):
        creepage.Run(tmp_path)


def test_every_dataset_of_a_run_is_declared_with_its_units(small):
    layout = creepage.layout()
    for file, records in (("fields.vtkhdf", small.fields), ("contact.vtkhdf", small.contact)):
        declared = {name: units for name, units, *_ in layout[file]}
        assert {name: field.units for name, field in records.items()}.items() <= declared.items()
    declared = [(name, units) for name, units, *_ in layout["history.h5"]]
    assert sorted(declared) == sorted(small.history.units.items())


def test_the_stress_below_the_patch_stands_beside_that_of_half_spaces(small):
    profiles = small.stress_profile()
    assert list(profiles) == ["disk", "bar"]
    bar = profiles["bar"]
    assert bar["depth"].ndim == 1 and (np.diff(bar["depth"]) > 0).all() and bar["time"] == small.fields.times[-1]
    for source in ("elements", "half_space", "hertz"):
        assert {values.shape for values in bar[source].values()} == {bar["depth"].shape}
    inside = bar["depth"] < 2 * bar["half_length"]
    away = np.abs(bar["elements"]["zz"] - bar["half_space"]["zz"])[inside]
    assert away.max() < 0.15 * bar["peak_pressure"]
