"""A whole run in one call."""

import numpy

from .engine import load
from .mechanism import Mechanism
from .state import State


def run(scene, times=None):
    """Moves a mechanism through times [s] (None: as the scene proposes) and returns what it records.

    scene: a Mechanism, or the path of a scene file. Returns a dict of arrays, all of the length of times: "time",
    "residual", and every recorded column under its name. Error: from the first step that fails.
    """
    mechanism = scene if isinstance(scene, Mechanism) else load(scene)
    if times is None:
        times = numpy.linspace(0.0, mechanism.duration, mechanism.steps + 1)
    times = numpy.asarray(times, dtype=numpy.float64)
    residual, table = numpy.empty(times.size), numpy.empty((times.size, mechanism.sizes.records))
    with State(mechanism) as state:
        for step, time in enumerate(times):
            residual[step] = state.move(time).residual
            table[step] = state.records()
    return dict(zip(mechanism.records, table.T)) | {"time": times, "residual": residual}
