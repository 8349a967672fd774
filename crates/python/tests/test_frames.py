"""Sweeps and runs as data frames and labelled arrays, and as notebooks show them."""

import subprocess
import sys

import creepage
import h5py
import numpy as np
import pytest

from conftest import SMALL

AXES = """
[[axis]]
key = "friction.static"
values = [0.1, 0.3]
[[axis]]
key = "drive.ramp"
values = [1e-6, 2e-6]
"""


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sweep")
    (folder / "base.toml").write_text(f'extends = "{SMALL}"\n[time]\nroll = 0.2e-3\n')
    (folder / "sweep.toml").write_text('base = "base.toml"\n' + AXES)
    creepage.sweep(folder / "sweep.toml", folder / "out", jobs=1)
    return creepage.Sweep(folder / "out")


def test_a_sweep_is_a_sequence_of_its_runs(swept):
    assert len(swept) == 4 and swept.parameters == ["friction.static", "drive.ramp"]
    assert [run.case["drive"]["ramp"] for run in swept] == [1e-6, 2e-6, 1e-6, 2e-6]
    assert swept[swept.names[-1]].path == swept[-1].path
    with pytest.raises(KeyError, match=swept.names[0]):
        swept["no such run"]
    with pytest.raises(creepage.CaseError, match="no sweep"):
        creepage.Sweep(swept[0].path)
    for of in (creepage.Sweep, creepage.Run):
        with pytest.raises(creepage.CaseError, match="gone: there is no such folder"):
            of(swept.path / "gone")


def test_a_sweep_becomes_a_frame_with_units_whose_rows_open_their_runs(swept):
    pandas = pytest.importorskip("pandas")
    frame = swept.to_pandas()
    assert list(frame.index) == swept.names
    units = frame.attrs["units"]
    assert (units["normal_force"], units["drive.ramp"], units["friction.static"]) == ("N", "s", "1")
    numbers = frame.select_dtypes("number").columns
    assert "normal_force" in numbers and "status" not in numbers
    for name in numbers:
        assert units[name], f"{name} has no unit"
    # the numbers of sweep.csv and of the runs
    table = pandas.read_csv(swept.path / "sweep.csv").set_index("name")
    assert np.array_equal(frame["normal_force"], table["normal_force"])
    assert list(frame.columns[:-1]) == list(table.columns)
    for _, row in frame.iterrows():
        assert row["run"].summary["contact"]["normal_force"] == row["normal_force"]


def test_a_sweep_becomes_a_dataset_over_its_parameters(swept):
    pytest.importorskip("xarray")
    data = swept.to_xarray()
    assert data["normal_force"].dims == ("friction.static", "drive.ramp")
    assert data["normal_force"].attrs["units"] == "N" and data["drive.ramp"].attrs["units"] == "s"
    one = data.sel({"friction.static": 0.3, "drive.ramp": 2e-6})
    run = swept[str(one["run"].item())]
    assert run.case["friction"]["static"] == 0.3
    assert run.summary["contact"]["normal_force"] == one["normal_force"].item()


def test_histories_and_contact_become_datasets_with_units(small):
    pytest.importorskip("xarray")
    history = small.to_xarray()
    assert history["normal_force"].attrs == {"units": "N", "long_name": "force of the bar on the disk, z"}
    assert np.array_equal(history["normal_force"], small.history["normal_force"])
    assert history["time"].attrs["units"] == "s"
    times = small.contact.times
    window = slice(float(times[1]), float(times[3]))
    contact = small.to_xarray("contact", fields=["pressure", "shear", "area"], side="bar", records=window)
    assert contact["shear"].dims == ("time", "node", "component") and contact["shear"].attrs["units"] == "Pa"
    assert np.array_equal(contact["pressure"], small.contact.bar["pressure"][1:4])
    assert np.array_equal(contact["z"], small.contact.bar.points[:, 2])
    assert contact["area"].dims == ("node",)
    fields = small.to_xarray("fields", records=slice(-1, None))
    assert fields["stress"].dims == ("time", "cell", "tensor") and fields["displacement"].shape[0] == 1
    with pytest.raises(ValueError, match="history"):
        small.to_xarray("probes")


def test_a_missing_package_is_told_with_the_extra_that_installs_it(small, swept, monkeypatch):
    for package, call in (
        ("pandas", swept.to_pandas),
        ("pandas", small.history.to_pandas),
        ("xarray", swept.to_xarray),
        ("xarray", small.to_xarray),
        ("pyvista", small.to_pyvista),
    ):
        monkeypatch.setitem(sys.modules, package, None)
        with pytest.raises(ImportError, match=rf"creepage\[{package}\]"):
            call()


def test_notebooks_show_numbers_with_units(small, swept):
    case = small.case
    assert case.units["drive.speed"] == "m/s" and isinstance(case, dict)
    assert "<td>drive.speed</td><td>38.89</td><td>m/s</td>" in case._repr_html_()
    assert "contact.normal_force" in small._repr_html_() and "<td>N</td>" in small._repr_html_()
    assert swept.names[2] in swept._repr_html_() and "normal_force N" in swept._repr_html_()
    assert "&lt;b&gt;" in creepage.Case(name="<b>")._repr_html_()


def test_the_version_is_that_of_the_program(small):
    words = [sys.executable, "-m", "creepage", "--version"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.stdout.split()[-1] == creepage.__version__ == small.summary["creepage_version"]


def test_a_second_process_reads_the_history_of_a_run_under_way(tmp_path):
    words = [sys.executable, "-m", "creepage", "run", SMALL, "--out", tmp_path / "run", "--threads", "1"]
    words += ["--set", "drive.speed=0.5", "--set", "output.history_interval=500", "--quiet"]
    under_way = subprocess.Popen(words)
    try:
        rows = 0
        while rows == 0:
            assert under_way.poll() is None, "the run ended before it was read"
            try:
                with h5py.File(tmp_path / "run" / "history.h5", swmr=True) as file:
                    rows = file.attrs["rows"]
                    assert file["normal_force"].attrs["units"] == "N" and len(file["time"]) >= rows
            except OSError:  # not there yet, or just being extended
                pass
        # long before a block of rows is full
        assert rows < 64
    finally:
        under_way.terminate()
        under_way.wait()
