"""Assembly modes: every closed position that a mechanism has for its inputs."""

import ctypes as c
import dataclasses

import numpy

from . import structs
from .library import Handle, call, call_plain, text


@dataclasses.dataclass(frozen=True, eq=False)
class Mode:
    """One closed position. q: (coordinates,), to be given to State.q; residual: greatest equation, metres divided by
    the mechanism's length, radians as they are."""

    id: str  # which solution was taken where there are several: "1.2.1"
    q: numpy.ndarray
    residual: float
    limit: bool  # two modes meet here, or nearly


@dataclasses.dataclass(frozen=True, eq=False)
class Modes:
    """What a search has found; a sequence of Mode. why: how it is known that there are no others, or why it is not."""

    modes: tuple
    complete: bool
    why: str
    twins: int  # how many positions each mode stands for: links that turn over unnoticed
    missed_by: float  # without a mode: how far a condition stays open at best, scaled by the length; 0: not known

    def __len__(self):
        return len(self.modes)

    def __getitem__(self, index):
        return self.modes[index]

    def __iter__(self):
        return iter(self.modes)


class _Found(Handle):
    _destroy = ("koppel_modes_destroy",)

    def mode(self, index, state):
        struct = structs.Mode()
        call_plain("koppel_modes_get", self.handle, index, struct)
        call_plain("koppel_modes_take", self.handle, index, state.handle)
        return Mode(text("koppel_modes_id", self.handle, index), state.q, struct.residual, bool(struct.limit))

    def modes(self, state):
        summary = structs.ModesSummary()
        call_plain("koppel_modes_summarise", self.handle, summary)
        return Modes(tuple(self.mode(index, state) for index in range(summary.count)), bool(summary.complete),
                     text("koppel_modes_why", self.handle), summary.twins, summary.missed_by)


def _callback(progress, failures):
    """progress as the library calls it. What it raises ends the search and waits in `failures`."""

    def called(found, part, _):
        try:
            return 1 if progress(found, part) is False else 0
        except BaseException as failure:  # also a keyboard interrupt
            failures.append(failure)
            return 1

    return structs.PROGRESS(called)


def find(state, most, all_twins, restarts, progress):
    """See State.modes."""
    failures = []
    options = structs.ModesOptions(most=most, all_twins=int(all_twins), restarts=restarts)
    if progress is not None:
        options.progress = _callback(progress, failures)
    out = c.c_void_p()
    call("koppel_modes_find", state.handle, state.work.handle, options, out)
    with _Found(out.value) as found:
        if failures:
            raise failures[0]
        with state.copy() as scratch:
            return found.modes(scratch)
