"""One short run that the tests share."""

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
