"""The command `trimtab`, which the package installs: `trimtab help` or `python -m trimtab help`."""

from __future__ import annotations

import signal
import sys

from ._trimtab import command


def main() -> int:
    """Runs the command with the arguments of the process and gives its exit code."""
    # Ctrl-C ends the command at once, as it does a program without an interpreter.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(["trimtab", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
