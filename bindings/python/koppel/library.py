"""Finds libkoppel.so, declares its functions, and holds what all handles share."""

import ctypes as c
import ctypes.util
import functools
import os
import pathlib
import weakref

import numpy

from . import structs
from .error import Error

_HANDLE = c.c_void_p
_OUT = c.POINTER(c.c_void_p)
_NUMBERS = c.POINTER(c.c_double)
_ERROR = c.POINTER(structs.Error)
_TEXT = (c.c_char_p, c.c_size_t, c.POINTER(c.c_size_t))

# The arguments of every function that is used here; all return a status except where _RESULTS says otherwise.
_ARGUMENTS = {
    "koppel_library_version": (),
    "koppel_explain_code": (c.c_char_p, *_TEXT),
    "koppel_engine_create": (c.c_uint32, c.c_uint32, c.POINTER(structs.EngineOptions), _OUT, _ERROR),
    "koppel_engine_destroy": (_HANDLE,),
    "koppel_engine_load_plugin": (_HANDLE, c.c_char_p, _ERROR),
    "koppel_diagnostics_create": (_OUT,),
    "koppel_diagnostics_destroy": (_HANDLE,),
    "koppel_diagnostics_count": (_HANDLE,),
    "koppel_diagnostics_get": (_HANDLE, c.c_size_t, _ERROR),
    "koppel_scene_from_file": (_HANDLE, c.c_char_p, _HANDLE, _OUT, _ERROR),
    "koppel_scene_from_text": (_HANDLE, c.c_char_p, c.c_size_t, c.c_char_p, _HANDLE, _OUT, _ERROR),
    "koppel_scene_destroy": (_HANDLE,),
    "koppel_mechanism_compile": (_HANDLE, _HANDLE, _OUT, _ERROR),
    "koppel_mechanism_destroy": (_HANDLE,),
    "koppel_mechanism_sizes": (_HANDLE, c.POINTER(structs.Sizes)),
    "koppel_mechanism_settings": (_HANDLE, c.POINTER(structs.Settings)),
    "koppel_mechanism_name": (_HANDLE, c.c_int32, c.c_size_t, *_TEXT),
    "koppel_mechanism_unit": (_HANDLE, c.c_int32, c.c_size_t, *_TEXT),
    "koppel_mechanism_find": (_HANDLE, c.c_int32, c.c_char_p, c.POINTER(c.c_size_t), _ERROR),
    "koppel_mechanism_explain": (_HANDLE, *_TEXT),
    "koppel_state_create": (_HANDLE, _OUT),
    "koppel_state_destroy": (_HANDLE,),
    "koppel_state_copy": (_HANDLE, _HANDLE),
    "koppel_state_get": (_HANDLE, c.c_int32, _NUMBERS, c.c_size_t),
    "koppel_state_set": (_HANDLE, c.c_int32, _NUMBERS, c.c_size_t),
    "koppel_state_set_time": (_HANDLE, c.c_double, _ERROR),
    "koppel_state_time": (_HANDLE,),
    "koppel_state_set_input": (_HANDLE, c.c_size_t, c.c_double, c.c_double, c.c_double),
    "koppel_work_create": (_HANDLE, _OUT),
    "koppel_work_destroy": (_HANDLE,),
    "koppel_close": (_HANDLE, _HANDLE, c.POINTER(structs.CloseOptions), c.POINTER(structs.Report), _ERROR),
    "koppel_velocities": (_HANDLE, _HANDLE, _ERROR),
    "koppel_accelerations": (_HANDLE, _HANDLE, _ERROR),
    "koppel_move": (_HANDLE, _HANDLE, c.c_double, c.POINTER(structs.Report), _ERROR),
    "koppel_analyse": (_HANDLE, _HANDLE, c.POINTER(structs.Analysis), _ERROR),
    "koppel_find_freedoms": (_HANDLE, _HANDLE, c.POINTER(structs.Freedoms), _ERROR),
    "koppel_explain_freedoms": (_HANDLE, _HANDLE, *_TEXT),
    "koppel_flow_explain": (_HANDLE, c.c_int32, *_TEXT),
    "koppel_modes_find": (_HANDLE, _HANDLE, c.POINTER(structs.ModesOptions), _OUT, _ERROR),
    "koppel_modes_destroy": (_HANDLE,),
    "koppel_modes_summarise": (_HANDLE, c.POINTER(structs.ModesSummary)),
    "koppel_modes_why": (_HANDLE, *_TEXT),
    "koppel_modes_get": (_HANDLE, c.c_size_t, c.POINTER(structs.Mode)),
    "koppel_modes_id": (_HANDLE, c.c_size_t, *_TEXT),
    "koppel_modes_take": (_HANDLE, c.c_size_t, _HANDLE),
    "koppel_simulation_create": (_HANDLE, c.POINTER(structs.SimulationOptions), _OUT, _ERROR),
    "koppel_simulation_destroy": (_HANDLE,),
    "koppel_simulation_advance": (_HANDLE, c.c_double, _HANDLE, _ERROR),
    "koppel_simulation_watch": (_HANDLE, c.c_double, _HANDLE, c.POINTER(structs.Crossing), _ERROR),
    "koppel_simulation_summarise": (_HANDLE, c.POINTER(structs.SimulationSummary)),
    "koppel_equilibrium_find": (_HANDLE, c.POINTER(structs.EquilibriumOptions), _OUT, _ERROR),
    "koppel_equilibrium_destroy": (_HANDLE,),
    "koppel_equilibrium_summarise": (_HANDLE, c.POINTER(structs.EquilibriumSummary)),
    "koppel_equilibrium_why": (_HANDLE, *_TEXT),
    "koppel_equilibrium_take": (_HANDLE, _HANDLE),
    "koppel_equilibrium_independent": (_HANDLE, c.POINTER(c.c_uint32), c.c_size_t),
    "koppel_equilibrium_stiffness": (_HANDLE, _NUMBERS, _NUMBERS, c.c_size_t),
    "koppel_equilibrium_direction": (_HANDLE, c.c_size_t, _NUMBERS, _NUMBERS, c.c_size_t),
    "koppel_linearise": (_HANDLE, c.POINTER(structs.LinearisationOptions), _OUT, _ERROR),
    "koppel_linearisation_destroy": (_HANDLE,),
    "koppel_linearisation_summarise": (_HANDLE, c.POINTER(structs.LinearisationSummary)),
    "koppel_linearisation_name": (_HANDLE, c.c_int32, c.c_size_t, *_TEXT),
    "koppel_linearisation_matrix": (_HANDLE, c.c_int32, _NUMBERS, _NUMBERS, c.c_size_t),
    "koppel_linearisation_mode": (_HANDLE, c.c_size_t, c.POINTER(structs.Eigenmode), _NUMBERS, _NUMBERS, c.c_size_t),
    "koppel_tree_create": (_HANDLE, _OUT, _ERROR),
    "koppel_tree_destroy": (_HANDLE,),
    "koppel_tree_inverse_dynamics": (_HANDLE, c.c_size_t, *[_NUMBERS] * 4, _ERROR),
    "koppel_tree_forward_dynamics": (_HANDLE, c.c_size_t, *[_NUMBERS] * 4, _ERROR),
    "koppel_tree_mass_matrix": (_HANDLE, c.c_size_t, *[_NUMBERS] * 2, _ERROR),
    "koppel_tree_energy": (_HANDLE, c.c_size_t, *[_NUMBERS] * 4, _ERROR),
    "koppel_tree_momentum": (_HANDLE, c.c_size_t, *[_NUMBERS] * 6, _ERROR),
    "koppel_tree_inverse_dynamics_derivatives": (_HANDLE, c.c_size_t, *[_NUMBERS] * 5, _ERROR),
    "koppel_tree_forward_dynamics_derivatives": (_HANDLE, c.c_size_t, *[_NUMBERS] * 6, _ERROR),
    "koppel_poses": (_HANDLE, _HANDLE, c.c_int32, _NUMBERS, c.c_size_t),
    "koppel_twists": (_HANDLE, _HANDLE, c.c_int32, _NUMBERS, c.c_size_t),
    "koppel_frame_accelerations": (_HANDLE, _HANDLE, c.c_int32, _NUMBERS, c.c_size_t),
    "koppel_jacobian": (_HANDLE, _HANDLE, c.c_int32, c.c_size_t, _NUMBERS, _NUMBERS, c.c_size_t),
    "koppel_reactions": (_HANDLE, _HANDLE, _NUMBERS, c.c_size_t, _NUMBERS, c.c_size_t, c.POINTER(c.c_uint8), _ERROR),
    "koppel_records": (_HANDLE, _HANDLE, _NUMBERS, c.c_size_t),
    "koppel_stream_open": (_HANDLE, c.POINTER(structs.StreamOptions), _OUT, _ERROR),
    "koppel_stream_publish": (_HANDLE, _HANDLE, _HANDLE, c.POINTER(structs.Report)),
    "koppel_stream_event": (_HANDLE, c.c_double, c.c_int32, c.c_char_p),
    "koppel_stream_close": (_HANDLE, c.POINTER(structs.StreamStatistics)),
}
_RESULTS = {
    "koppel_library_version": structs.Version, "koppel_diagnostics_count": c.c_size_t, "koppel_state_time": c.c_double,
    "koppel_engine_destroy": None, "koppel_diagnostics_destroy": None, "koppel_scene_destroy": None,
    "koppel_mechanism_destroy": None, "koppel_state_destroy": None, "koppel_work_destroy": None,
    "koppel_modes_destroy": None, "koppel_simulation_destroy": None, "koppel_equilibrium_destroy": None,
    "koppel_linearisation_destroy": None, "koppel_tree_destroy": None,
}


def candidates():
    """Where the library is looked for, in this order: $KOPPEL_LIBRARY alone if it is set; beside the package, in the
    build folder of the repository that the package lies in, where the system keeps libraries."""
    if os.environ.get("KOPPEL_LIBRARY"):
        yield os.environ["KOPPEL_LIBRARY"]
        return
    package = pathlib.Path(__file__).resolve().parent
    for file in (package / "libkoppel.so", package.parents[2] / "build" / "lib" / "libkoppel.so"):
        if file.exists():
            yield str(file)
    yield ctypes.util.find_library("koppel") or "libkoppel.so.0"


@functools.lru_cache(maxsize=None)
def library():
    """The loaded library. ImportError: it is nowhere, or is no libkoppel."""
    faults = []
    for file in candidates():
        try:
            loaded = c.CDLL(file)
            for name, arguments in _ARGUMENTS.items():
                function = getattr(loaded, name)
                function.argtypes, function.restype = arguments, _RESULTS.get(name, c.c_int32)
            return loaded
        except (OSError, AttributeError) as fault:
            faults.append(f"{file}: {fault}")
    advice = "libkoppel.so was not found; build koppel, or set KOPPEL_LIBRARY to the file"
    raise ImportError("\n".join([advice, *faults]))


def call(name, *arguments):
    """Calls a function that ends with an error argument and returns its status; Error if that is below 0."""
    error = structs.Error()
    status = getattr(library(), name)(*arguments, error)
    if status < 0:
        raise Error.from_struct(error, status)
    return status


def call_plain(name, *arguments):
    """Calls a function without error argument, likewise."""
    status = getattr(library(), name)(*arguments)
    if status < 0:
        raise Error(status, message=f"{name}: {structs.STATUSES.get(status, status)}")
    return status


def text(name, *arguments):
    """The text that a function writes."""
    needed = c.c_size_t()
    call_plain(name, *arguments, None, 0, needed)
    buffer = c.create_string_buffer(needed.value)
    call_plain(name, *arguments, buffer, needed.value, None)
    return buffer.value.decode("utf-8", errors="replace")


def encoded(value):
    """A text or path as the library takes it; None stays None."""
    return None if value is None else os.fsencode(value)


def pointer(array):
    return array.ctypes.data_as(_NUMBERS)


def numbers(*shape):
    """Room for numbers that the library writes."""
    return numpy.empty(shape, dtype=numpy.float64)


class Handle:
    """Owns a handle of the library. It is freed by free(), at the end of a `with` block, or with the object; a handle
    keeps alive what it needs, so the order does not matter."""

    _destroy = ()  # name of the function that frees it, and its arguments after the handle

    def __init__(self, pointer_value):
        function, *more = self._destroy
        self._pointer = pointer_value
        self._finalizer = weakref.finalize(self, getattr(library(), function), pointer_value, *more)

    @property
    def handle(self):
        """The pointer, to be passed to the library. ValueError: it was freed."""
        if not self._finalizer.alive:
            raise ValueError(f"this {type(self).__name__} was freed")
        return self._pointer

    def free(self):
        """Frees it now; again is fine."""
        self._finalizer()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.free()
