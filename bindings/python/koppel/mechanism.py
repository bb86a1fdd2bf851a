"""A compiled scene: what there is and what it is called."""

import ctypes as c

from . import structs
from .library import Handle, call, call_plain, text
from .state import State
from .tree import Tree


class Mechanism(Handle):
    """Never changes; may be used by many threads.

    warnings: findings of reading and compiling that were no errors.
    bodies, frames, joints, coordinates, rates, inputs, records, equations: names, in the library's order;
    bodies[0] is the ground.
    sizes: how many of each, and loops, constraints, unknowns. length [m]: what residuals in metres are divided by.
    duration [s], steps: of a run, as the scene proposes. gravity [m/s^2]: 3 numbers.
    """

    _destroy = ("koppel_mechanism_destroy",)

    def __init__(self, pointer, warnings=()):
        super().__init__(pointer)
        self.warnings = list(warnings)
        self.sizes, settings = structs.Sizes(), structs.Settings()
        call_plain("koppel_mechanism_sizes", self.handle, self.sizes)
        call_plain("koppel_mechanism_settings", self.handle, settings)
        self.name, self.title = self.names("scene", 2)
        self.length, self.duration, self.steps = settings.length, settings.duration, settings.steps
        self.gravity, self.hash = tuple(settings.gravity), settings.hash
        self.bodies = self.names("body", self.sizes.bodies)
        self.frames = self.names("frame", self.sizes.frames)
        self.joints = self.names("joint", self.sizes.joints)
        self.coordinates = self.names("coordinate", self.sizes.coordinates)
        self.rates = self.names("rate", self.sizes.rates)
        self.inputs = self.names("input", self.sizes.inputs)
        self.records = self.names("record", self.sizes.records)
        self.equations = self.names("equation", self.sizes.equations)
        self.watches = self.names("watch", self.sizes.watches)

    def names(self, kind, count):
        """The first `count` names of a kind ("body", "frame", ... as in structs.KINDS)."""
        return [text("koppel_mechanism_name", self.handle, structs.KINDS[kind], index) for index in range(count)]

    def unit(self, kind, name):
        """"m", "rad", "m/s", ... of a coordinate, rate, input, record or equation. Error: no such name."""
        return text("koppel_mechanism_unit", self.handle, structs.KINDS[kind], self.index(kind, name))

    def index(self, kind, name):
        """The number of a thing. Error: there is none; its advice proposes the nearest name."""
        index = c.c_size_t()
        call("koppel_mechanism_find", self.handle, structs.KINDS[kind], name.encode("utf-8"), index)
        return index.value

    def explain(self):
        """What was built, how each loop is cut, equations and unknowns: a page of text."""
        return text("koppel_mechanism_explain", self.handle)

    def flow(self, format="text"):
        """In which order and how the coordinates follow from the inputs: a page of text, or a block diagram in the
        language of Graphviz (format "dot")."""
        return text("koppel_flow_explain", self.handle, structs.FLOWS.index(format))

    def state(self):
        """A new State at time 0, not closed yet."""
        return State(self)

    def tree(self):
        """A new Tree: the dynamics of the spanning tree, of many states at once."""
        return Tree(self)
