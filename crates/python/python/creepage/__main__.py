"""The command line: ``python -m creepage run CASE``."""

import signal
import sys

from . import _creepage, _from_command, _render_command


def main() -> None:
    """Run the command line and end with its exit code."""
    for command in (_render_command, _from_command):
        words = command.taken(sys.argv[1:])
        if words is not None:
            sys.exit(command.main(words))
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        # Python's own would raise KeyboardInterrupt after the program has ended in order
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_creepage.main(["creepage", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
