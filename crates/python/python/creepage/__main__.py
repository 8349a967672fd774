"""The command line: ``python -m creepage run CASE.toml``."""

import sys

from . import _creepage
from ._execute import PROGRAM


def main() -> None:
    """Run the command line and end with its exit code."""
    sys.exit(_creepage.main(["creepage", *sys.argv[1:]], PROGRAM))


if __name__ == "__main__":
    main()
