"""The other commands."""

import subprocess
import sys

import creepage
import pytest

from conftest import SMALL


def test_a_mesh_is_counted(tmp_path):
    found = creepage.mesh(SMALL, tmp_path / "mesh.vtu", mesh={"zone": {"size": 1.6e-3}})
    assert found["elements"] > 0 and {body["name"] for body in found["bodies"]} == {"disk", "bar"}
    assert (tmp_path / "mesh.vtu").is_file()


def test_the_schema_knows_the_keys():
    assert "friction" in creepage.schema()["properties"]


def test_the_slider_has_the_first_row_of_table_2():
    found = creepage.slider(method="implicit", mass=0.01, damping=0.04, dt=1e-4, t_end=1.0)
    assert found["method"] == "implicit" and found["steps"] == 10_000
    with pytest.raises(creepage.CaseError, match="mass"):
        creepage.slider(mass=-1.0)


def test_a_verification_problem_is_beside_its_reference():
    names = [problem["name"] for problem in creepage.verify(list=True)["problems"]]
    found = creepage.verify("patch", quick=True) if "patch" in names else creepage.verify(names[0], quick=True)
    assert found["pass"] and found["results"][0]["source"]
    with pytest.raises(creepage.CaseError, match="no verification problem"):
        creepage.verify("no-such-problem")


def test_a_sweep_runs_in_processes_of_its_own(tmp_path):
    (tmp_path / "base.toml").write_text(f'extends = "{SMALL}"\n[time]\nroll = 0.2e-3\n')
    sweep = tmp_path / "sweep.toml"
    sweep.write_text('base = "base.toml"\n[[axis]]\nkey = "friction.static"\nvalues = [0.1, 0.3]\n')
    heard = []
    found = creepage.sweep(sweep, tmp_path / "out", jobs=1, progress=heard.append)
    assert [run["status"] for run in found["runs"]] == ["completed"] * 2
    assert heard[-1]["completed"] == 2
    assert [run["parameters"]["friction.static"] for run in found["runs"]] == [0.1, 0.3]
    assert creepage.Run(tmp_path / "out" / found["runs"][1]["run"]).case["friction"]["static"] == 0.3
    words = [sys.executable, "-m", "creepage", "sweep", sweep, "--out", tmp_path / "again", "--quiet"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_warnings_of_a_case_are_python_warnings(tmp_path):
    with pytest.warns(UserWarning, match="time.factor"):
        creepage.mesh(SMALL, time={"factor": 1.5})
