"""Runs: the command line's own, by another door."""

import json
import signal
import subprocess
import sys
import time

import creepage
import h5py
import numpy as np
import pytest

from conftest import SHORT, SMALL
from creepage._case import unfolded
from creepage._progress import Bar

SETS = [f"--set={key}={value}" for key, value in SHORT.items()]


def command_line(*words):
    return subprocess.run(
        [sys.executable, "-m", "creepage", *map(str, words)], capture_output=True, text=True
    )


def datasets(path):
    """Every dataset of a file."""
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, x: found.update({name: x[()]}) if isinstance(x, h5py.Dataset) else None)
    return found


def assert_same_bits(a, b):
    for name in ("fields.vtkhdf", "contact.vtkhdf", "history.h5"):
        ours, theirs = datasets(a / name), datasets(b / name)
        assert ours.keys() == theirs.keys()
        for key, values in ours.items():
            assert values.tobytes() == theirs[key].tobytes(), f"{name}: {key}"


def test_a_run_from_python_has_the_bits_and_the_case_of_the_command_line(small, tmp_path):
    done = command_line("run", SMALL, *SETS, "--out", tmp_path / "run", "--threads", 2, "--json")
    assert done.returncode == 0, done.stderr
    assert_same_bits(small.path, tmp_path / "run")
    assert (small.path / "case.toml").read_text() == (tmp_path / "run" / "case.toml").read_text()
    theirs = json.loads(done.stdout)
    assert theirs["contact"] == small.summary["contact"]


def test_a_case_may_be_a_dict_with_sections_or_dotted_keys(small, tmp_path):
    case = {
        "name": "small",
        "extends": str(SMALL),
        "title": small.case["title"],
        "time.roll": np.float64(1.2e-3),
        "output": {"fields_interval": 5e-6},
    }
    run = creepage.run(case, tmp_path / "run", mesh={"zone": {"size": 0.8e-3}})
    assert run.case == small.case
    assert_same_bits(small.path, run.path)


def test_sections_and_dotted_keys_of_a_dict_merge_at_every_depth():
    section = {"zone": {"size": 1e-3, "width": 0.01}, "growth": 1.3}
    over = {"mesh": section, "mesh.zone.size": 2e-3}
    under = {"mesh.zone.size": 1e-3, "mesh.zone.list": [1, 2], "mesh": {**section, "zone.list": [3]}}
    whole = {"zone": {"size": 2e-3, "width": 0.01}, "growth": 1.3}
    assert unfolded(over) == {"mesh": whole}
    assert unfolded(under) == {"mesh": {**whole, "zone": {"size": 1e-3, "width": 0.01, "list": [3]}}}
    assert over["mesh"] is section and section["zone"]["size"] == 1e-3


def test_bad_input_has_the_message_of_the_command_line(tmp_path):
    with pytest.raises(creepage.CaseError) as caught:
        creepage.run(SMALL, tmp_path / "run", **{"mesh.zone.size": -1.0})
    said = command_line("run", SMALL, "--set", "mesh.zone.size=-1.0", "--out", tmp_path / "run")
    assert said.returncode == caught.value.code == 2
    assert str(caught.value).strip() == said.stderr.strip()
    assert "mesh.zone.size" in caught.value.message and caught.value.help
    assert isinstance(caught.value, ValueError)


def test_a_run_is_not_replaced_unasked(small):
    with pytest.raises(creepage.CaseError, match="already holds a run"):
        creepage.run(SMALL, small.path, **SHORT)


def test_a_blow_up_ends_with_its_diagnosis_and_readable_results(tmp_path):
    with pytest.raises(creepage.RunError, match="time.factor") as caught:
        creepage.run(SMALL, tmp_path / "run", time={"factor": 1.9}, output={"history_interval": 1})
    assert caught.value.code == 3
    assert caught.value.run.summary["status"] == "failed"
    assert caught.value.run.contact["pressure"][0].max() > 0


def test_progress_is_told_by_stages(tmp_path):
    heard = []
    creepage.run(SMALL, tmp_path / "run", progress=heard.append, **SHORT)
    stages = [told["stage"] for told in heard]
    assert stages[0] == "mesh" and stages[-1] == "roll"
    rolled = [told["step"] for told in heard if told["stage"] == "roll"]
    assert rolled == sorted(rolled) and heard[-1]["end_time"] == pytest.approx(1.2e-3 / 38.89)


def test_a_bar_that_is_no_terminal_s_is_drawn_about_twenty_times(capsys):
    pytest.importorskip("tqdm")
    bar = Bar()
    bar.bar.mininterval = 0.0  # as in a run of hours
    for step in range(1001):
        bar({"stage": "roll", "step": step, "steps": 1000, "time": 0.0, "normal_force": 0.0})
    bar.close()
    assert 15 < capsys.readouterr().err.count("\r") < 30


def test_what_progress_raises_ends_the_run_in_order(tmp_path):
    def enough(told):
        if told["stage"] == "roll":
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        creepage.run(SMALL, tmp_path / "run", progress=enough, **SHORT)
    assert creepage.Run(tmp_path / "run").summary["status"] == "interrupted"


INTERRUPT = """
import os, signal, sys, creepage
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it
def told(progress):
    if progress["stage"] == "roll":
        os.kill(os.getpid(), signal.SIGINT)
case, out, *_ = sys.argv[1:]
try:
    creepage.run(case, out, progress=told, **{"time.roll": 4e-3})
except KeyboardInterrupt as caught:
    print(caught.code, caught.run.summary["status"], (caught.run.path / "checkpoint.h5").exists())
"""


def test_ctrl_c_ends_the_command_line_in_order_and_raises_nothing(tmp_path):
    out = tmp_path / "run"
    words = ["run", SMALL, "--out", out, "--threads", "1", "--set", "drive.speed=0.5"]
    under_way = subprocess.Popen(
        [sys.executable, "-m", "creepage", *map(str, words)],
        stderr=subprocess.PIPE,
        text=True,
        # a shell's background jobs ignore it
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    while not (out / "history.h5").exists():
        assert under_way.poll() is None, under_way.stderr.read()
        time.sleep(0.02)
    under_way.send_signal(signal.SIGINT)
    said = under_way.communicate()[1]
    assert under_way.returncode == 130 and "KeyboardInterrupt" not in said, said
    assert creepage.Run(out).summary["status"] == "interrupted"


def test_ctrl_c_raises_after_a_checkpoint_and_the_run_goes_on_to_the_same_bits(tmp_path):
    # long enough that the signal meets the run before its end
    length = {"time.roll": 4e-3}
    out = tmp_path / "run"
    done = subprocess.run(
        [sys.executable, "-c", INTERRUPT, SMALL, out], capture_output=True, text=True
    )
    assert done.stdout.split() == ["130", "interrupted", "True"], done.stderr
    run = creepage.run(SMALL, out, resume=True, **length)
    assert run.summary["status"] == "completed"
    undisturbed = creepage.run(SMALL, tmp_path / "undisturbed", **length)
    assert_same_bits(undisturbed.path, run.path)
