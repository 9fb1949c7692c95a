# SPDX-License-Identifier: MIT
"""Draws without a screen: Debian's VTK knows X windows only, so the script starts itself again under xvfb-run."""

import os
import shutil
import sys

from picture_error import PictureError

_MARK = "APSL_PICTURES_UNDER_XVFB"


def ensure_display():
    """Returns with something to draw on, or does not return: the process is replaced by one under xvfb-run."""
    import vtkmodules.vtkRenderingOpenGL2 as opengl

    if os.environ.get(_MARK) or hasattr(opengl, "vtkEGLRenderWindow") or hasattr(opengl, "vtkOSOpenGLRenderWindow"):
        return
    # A virtual screen is preferred to DISPLAY: the picture is then the same everywhere, and a DISPLAY
    # that cannot be reached would end the process inside VTK without a word of ours.
    if shutil.which("xvfb-run") and shutil.which("xauth"):
        os.environ[_MARK] = "1"
        sys.stdout.flush()
        sys.stderr.flush()
        os.execvp("xvfb-run", ["xvfb-run", "-a", sys.executable, *sys.argv])
    if not os.environ.get("DISPLAY"):
        raise PictureError("no display to draw on: apt-get install xvfb xauth, or set DISPLAY")
