# SPDX-License-Identifier: Apache-2.0
"""eye.py -- renders small scenes for the checks of this folder, and sums up what is seen."""
import os
import subprocess

from exr import Frame


class Eye:
    """One camera's frames; a scene that is refused ends the check."""

    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder

    def frame(self, scene, *options):
        scene.write(os.path.join(self.folder, "scene.gltf"))
        done = subprocess.run([self.program, "render", "scene.gltf", "-o", "frame.exr",
                               *options, "--quiet"], cwd=self.folder, capture_output=True,
                              text=True, check=False)
        assert done.returncode == 0, done.stderr
        return Frame(os.path.join(self.folder, "frame.exr"))

    def mean(self, scene, spp, *options):
        """Mean luminance of a small frame, cd/m2."""
        return mean(luminances(self.frame(scene, "--size", "8x8", "--spp", str(spp), *options)))


def luminances(frame):
    """Of the pixels, row by row, cd/m2."""
    return [0.2126 * r + 0.7152 * g + 0.0722 * b
            for r, g, b in zip(*(frame.channels[c] for c in "RGB"))]


def mean(values):
    return sum(values) / len(values)
