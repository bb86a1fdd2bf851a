"""Streams of a mechanism's motion over LCM."""

import ctypes as c
import dataclasses

from . import structs
from .library import Handle, call, call_plain, encoded


@dataclasses.dataclass(frozen=True)
class Statistics:
    published: int  # states taken from the program
    sent: int  # that went out
    dropped: int  # that were overtaken by newer ones (network only)
    failed: int  # that LCM could not send


class Stream(Handle):
    """An open stream. url: "udpm://239.255.76.67:7667?ttl=0", "file:///path?mode=w", "memq://"; None: LCM's default.
    name: channels are KOPPEL_<NAME>_STATE and so on; None: the scene's. period [s]: least time between two states.
    It is closed by close(), at the end of a `with` block, or with the object."""

    _destroy = ("koppel_stream_close", None)

    def __init__(self, mechanism, url=None, name=None, period=0.0):
        options = structs.StreamOptions(url=encoded(url), name=encoded(name), period=period)
        out = c.c_void_p()
        call("koppel_stream_open", mechanism.handle, options, out)
        super().__init__(out.value)

    def publish(self, state, report=None):
        """Hands over a state, and how it was closed. Never waits for the network; a file may push back."""
        struct = None if report is None else report.to_struct()
        call_plain("koppel_stream_publish", self.handle, state.handle, state.work.handle, struct)

    def event(self, time, text, severity="note"):
        """Sends a line of text."""
        call_plain("koppel_stream_event", self.handle, time, structs.SEVERITIES.index(severity), text.encode("utf-8"))

    def close(self):
        """Sends what is waiting, closes, and returns the Statistics. Error: a log is incomplete."""
        statistics = structs.StreamStatistics()
        pointer = self.handle
        self._finalizer.detach()
        call_plain("koppel_stream_close", pointer, statistics)
        return Statistics(statistics.published, statistics.sent, statistics.dropped, statistics.failed)

    def free(self):
        if self._finalizer.alive:
            self.close()
