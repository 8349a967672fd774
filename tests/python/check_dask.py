#!/usr/bin/env python3
"""Runs a small sweep through the Dask driver on a local cluster and compares its results with
those of `creepage sweep`.

Usage: check_dask.py CREEPAGE PROJECT_FOLDER

Ends with 1 where a number differs that should not. Needs dask.distributed.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SWEEP = """
base = "small.toml"
[[axis]]
key = "friction.static"
values = [0.1, 0.2, 0.3]
[[axis]]
key = "time.factor"
values = [0.5, 1.6]
"""


def results(folder):
    sweep = json.loads((folder / "sweep.json").read_text())
    for run in sweep["runs"]:
        for name in sweep["not_repeated"]:
            del run["summary"][name]
    return sweep


def main():
    creepage, project = (str(Path(argument).resolve()) for argument in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        case = (Path(project) / "tests/small.toml").read_text()
        (folder / "small.toml").write_text(case.replace("roll = 0.008", "roll = 0.0005"))
        (folder / "sweep.toml").write_text(SWEEP)

        def sweep(*arguments):
            words = [creepage, "--quiet", "sweep", "sweep.toml", *arguments]
            return subprocess.run(words, cwd=folder, check=False).returncode

        # Half of the runs are unstable: code 1.
        assert sweep("--out", "here") == 1
        assert sweep("--out", "there", "--plan", "runs.sh") == 0
        driver = Path(project) / "cases/sweeps/dask_sweep.py"
        dask = subprocess.run(
            [sys.executable, str(driver), "runs.sh", "--workers", "2"],
            cwd=folder,
            env={**os.environ, "CREEPAGE": creepage},
            capture_output=True,
            text=True,
            check=False,
        )
        print(dask.stdout, dask.stderr[-400:])
        assert dask.returncode == 1, "a failed run must be told"
        assert dask.stdout.count("ended with 0") == 3 and dask.stdout.count("ended with 3") == 3
        assert sweep("--out", "there", "--collect") == 1
        here, there = results(folder / "here"), results(folder / "there")
        statuses = [run["status"] for run in there["runs"]]
        assert statuses == ["completed", "failed"] * 3, statuses
        same = here == there
        print("the same" if same else "DIFFERENT", "numbers from both")
        sys.exit(0 if same else 1)


if __name__ == "__main__":
    main()
