"""The command `recon`: `python -m recon --help`."""

import sys

from recon import _recon


def main() -> None:
    """Runs the command with the arguments of this process, and ends it with the command's exit code."""
    sys.exit(_recon.main(["recon", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
