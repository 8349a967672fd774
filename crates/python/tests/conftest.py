"""One short run that the tests share, and the sample of them that the continuous integration takes."""

import os
from pathlib import Path

import creepage
import pytest

ROOT = Path(__file__).resolve().parents[3]
SMALL = ROOT / "tests" / "small.toml"
# a few hundred steps
SHORT = {"time.roll": 1.2e-3, "output.fields_interval": 5e-6}


@pytest.fixture(scope="session")
def small(tmp_path_factory):
    return creepage.run(SMALL, tmp_path_factory.mktemp("runs") / "small", threads=1, **SHORT)


def pytest_collection_modifyitems(items):
    """With CREEPAGE_SAMPLE=K/N every Nth test from the Kth on, and all of the modules that make no run of their own."""
    first, step = map(int, os.environ.get("CREEPAGE_SAMPLE", "0/1").split("/"))
    short = ["test_results", "test_stubs"]
    items[:] = [item for n, item in enumerate(items) if n % step == first or item.module.__name__ in short]
