# SPDX-License-Identifier: MIT
"""Errors as the user meets them: one line on stderr, exit code 2."""

import argparse
import sys


class PictureError(Exception):
    """Something the user can put right; the message is one line."""


class OneLineParser(argparse.ArgumentParser):
    def error(self, message):
        raise PictureError(f"{message} (see --help)")


def needs_package(package, missing):
    """Ends the script where an import failed, with the Debian package that has it."""
    print(f"error: {missing}: apt-get install {package}", file=sys.stderr)
    sys.exit(2)


def exit_code_of(run):
    """Runs `run(arguments)` on the command line; the exit code, any PictureError told in one line."""
    try:
        run(sys.argv[1:])
    except PictureError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    return 0
