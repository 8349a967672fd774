"""Short runs that the tests share, and the sample of the tests that the continuous integration takes."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import creepage
import numpy as np
import pytest

import binout

ROOT = Path(__file__).resolve().parents[3]
SMALL = ROOT / "tests" / "small.toml"
# a few hundred steps
SHORT = {"time.roll": 1.2e-3, "output.fields_interval": 5e-6}
# with enough records to be judged as another program's
RECORDED = {"time.roll": 2e-3, "output.contact_interval": 2e-6}


@pytest.fixture(scope="session")
def small(tmp_path_factory):
    return creepage.run(SMALL, tmp_path_factory.mktemp("runs") / "small", threads=1, **SHORT)


def pytest_collection_modifyitems(items):
    """With CREEPAGE_SAMPLE=K/N every Nth test from the Kth on, and all of the modules that make no run of their own."""
    first, step = map(int, os.environ.get("CREEPAGE_SAMPLE", "0/1").split("/"))
    short = ["test_results", "test_stubs"]
    items[:] = [item for n, item in enumerate(items) if n % step == first or item.module.__name__ in short]


@pytest.fixture(scope="session")
def there(tmp_path_factory):
    """A run, its deck in the folder in which another program would have computed it, and when it rolls there."""
    return computed(tmp_path_factory.mktemp("lsdyna"), RECORDED)


def computed(folder, keys):
    run = creepage.run(SMALL, folder / "run", threads=1, **keys)
    sets = [word for key, value in keys.items() for word in ("--set", f"{key}={json.dumps(value)}")]
    deck = folder / "there" / "deck.k"
    deck.parent.mkdir()
    subprocess.run([sys.executable, "-m", "creepage", "export-k", SMALL, *sets, "--out", deck, "-q"], check=True)
    begins = re.search(r"START_TIME\n\$.*\n *(\S+)", deck.read_text())
    return run, deck, float(begins[1])


def resolved(run, record):
    """Pressure and shear of the run along the normals of its nodes, of which forces of nodes alone know."""
    pressure, shear = (run.contact[name][record] for name in ("pressure", "shear"))
    normal = binout.normals(run, run.contact["displacement"][record])
    along = np.sum(shear * normal, axis=1)
    return pressure - along, shear - along[:, None] * normal


def values(check):
    """Every measure by its name, the part of the interface and the pairing."""
    found = {}
    for name, metric in check["metrics"].items():
        for side, parts in (metric.get("sides") or {}).items():
            if isinstance(parts, dict):
                of = {None: parts} if "value" in parts else parts
                found |= {(name, side, at): part["value"] for at, part in of.items() if isinstance(part, dict)}
    return found
