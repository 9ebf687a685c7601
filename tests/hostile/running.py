# SPDX-License-Identifier: Apache-2.0
"""running.py -- programs that a test starts end with it."""


class Running:
    """started: those that may still run; the end of a `with` kills them, whatever a claim or a
    timeout left."""

    def __init__(self):
        self.started = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for running in self.started:
            if running.poll() is None:
                running.kill()
                running.communicate()
