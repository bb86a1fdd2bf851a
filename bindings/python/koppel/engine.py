"""Engines read scenes; scenes become mechanisms."""

import ctypes as c

from . import structs
from .error import Error, Finding
from .library import Handle, call, call_plain, encoded, library
from .mechanism import Mechanism


class _Diagnostics(Handle):
    _destroy = ("koppel_diagnostics_destroy",)

    def __init__(self):
        out = c.c_void_p()
        call_plain("koppel_diagnostics_create", out)
        super().__init__(out.value)

    def findings(self):
        result = []
        for index in range(library().koppel_diagnostics_count(self.handle)):
            struct = structs.Error()
            call_plain("koppel_diagnostics_get", self.handle, index, struct)
            result.append(Finding.from_struct(struct))
        return result


def _build(function, *arguments):
    """Calls a function that writes findings and a handle; returns the handle and the findings."""
    out = c.c_void_p()
    with _Diagnostics() as diagnostics:
        try:
            call(function, *arguments, diagnostics.handle, out)
        except Error as error:
            raise Error(error.status, error.finding, diagnostics.findings()) from None
        return out.value, diagnostics.findings()


class Engine(Handle):
    """Plugins and what they need. plugin_path: folders, separated by ':', that are searched for plugins;
    standard_plugins: a folder with the standard ones as shared objects. None: as the environment says."""

    _destroy = ("koppel_engine_destroy",)

    def __init__(self, plugin_path=None, standard_plugins=None):
        options = structs.EngineOptions(plugin_path=encoded(plugin_path), standard_plugins=encoded(standard_plugins))
        out = c.c_void_p()
        call("koppel_engine_create", *structs.ABI, options, out)
        super().__init__(out.value)

    def load_plugin(self, path):
        """Loads a plugin now instead of when a scene names it."""
        call("koppel_engine_load_plugin", self.handle, encoded(path))

    def read(self, path):
        """The Scene in a file. Error: with all findings."""
        return Scene(*_build("koppel_scene_from_file", self.handle, encoded(path)))

    def read_text(self, text, directory=None):
        """The Scene in a text. directory: what relative file names in it refer to; None: they are errors."""
        data = text.encode("utf-8")
        return Scene(*_build("koppel_scene_from_text", self.handle, data, len(data), encoded(directory)))

    def load(self, path):
        """The Mechanism of a scene file: read and compile."""
        with self.read(path) as scene:
            return scene.compile()


class Scene(Handle):
    """A checked description. warnings: findings (warnings and notes) that were no errors."""

    _destroy = ("koppel_scene_destroy",)

    def __init__(self, pointer, warnings):
        super().__init__(pointer)
        self.warnings = warnings

    def compile(self):
        """The Mechanism; its warnings are those of the scene and of compiling."""
        pointer, warnings = _build("koppel_mechanism_compile", self.handle)
        return Mechanism(pointer, self.warnings + warnings)


def load(path):
    """The Mechanism of a scene file, with an engine of its own."""
    with Engine() as engine:
        return engine.load(path)
