"""Tries the wheel as its user does: installed in a clean environment from a folder of wheels, with no other index, it runs
the reference case ``quick`` in an empty folder; prints its size and the seconds.

    python tests/python/check_wheel.py creepage-....whl
"""

import json
import shutil
import subprocess
import sys
import tempfile
import time
import venv
from pathlib import Path

import numpy

LARGEST = 8_000_000  # bytes of the wheel


def call(*words, **options):
    subprocess.run([str(word) for word in words], check=True, **options)


def command(wheels: Path, environment: Path) -> list:
    """The words that run ``creepage`` from a folder of wheels."""
    index = ["--no-index", "--find-links", wheels]
    if uvx := shutil.which("uvx"):
        return [uvx, "--isolated", *index, "creepage"]
    venv.create(environment)
    bin = environment / ("Scripts" if sys.platform == "win32" else "bin")
    # the pip of this environment installs into the other one, which has none
    call(sys.executable, "-m", "pip", "--python", bin / "python", "install", "--quiet", *index, "creepage")
    return [bin / "creepage"]


wheel = Path(sys.argv[1])
size = wheel.stat().st_size
if size > LARGEST:
    sys.exit(f"{wheel.name}: {size} bytes, more than {LARGEST}")
with tempfile.TemporaryDirectory() as scratch:
    wheels, empty = Path(scratch) / "wheels", Path(scratch) / "empty"
    wheels.mkdir(), empty.mkdir()
    shutil.copy(wheel, wheels)
    download = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
    call(*download, "--dest", wheels, f"numpy=={numpy.__version__}")
    begun = time.monotonic()
    creepage = command(wheels, Path(scratch) / "environment")
    call(*creepage, "--quiet", "run", "quick", cwd=empty)
    seconds = time.monotonic() - begun
    summary = json.loads((empty / "runs" / "quick" / "summary.json").read_text(encoding="utf-8"))
    assert summary["status"] == "completed", summary["status"]
print(f"{wheel.name}: {size / 1e6:.2f} MB, {seconds:.0f} s from download to the first result")
