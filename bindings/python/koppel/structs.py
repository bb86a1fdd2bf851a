"""The structs and constants of koppel.h, as ctypes sees them."""

import ctypes as c

ABI = (0, 1)  # major and minor version of the header that this file was written after

OK = 0
REDUNDANT, BRANCH_CHANGED, NEAR_SINGULAR, LIMIT_EXCEEDED, CHANGE_POINT = 1, 2, 4, 8, 16
STATUSES = {
    -1: "retry with a smaller step", -2: "invalid argument", -3: "invalid scene", -4: "not closed", -5: "singular",
    -6: "a plugin failed", -7: "version", -8: "input or output failed", -9: "no memory", -10: "internal",
}
SEVERITIES = ("note", "warning", "error")
KINDS = {name: number for number, name in enumerate(
    ("body", "frame", "joint", "coordinate", "rate", "input", "record", "equation", "scene",
     "watch"), start=1)}
Q, V, A = 1, 2, 3
VERDICTS = ("open", "closed", "not found", "retry", "limit", "unreachable")
SOLVERS = ("none", "newton", "ceres", "flow")
METHODS = ("auto", "newton", "ceres", "flow")
FLOWS = ("text", "dot")
DRIVES = ("held", "moving")
SEARCHES = ("settle", "nearest")
COURSES = ("unsteady", "steady", "resting")


class Version(c.Structure):
    _fields_ = [("major", c.c_uint32), ("minor", c.c_uint32), ("patch", c.c_uint32)]


class Sized(c.Structure):
    """A struct that may grow: it starts with its size."""

    def __init__(self, **values):
        super().__init__(struct_size=c.sizeof(type(self)), **values)


class Error(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("status", c.c_int32), ("severity", c.c_int32), ("line", c.c_int32),
                ("column", c.c_int32), ("length", c.c_int32), ("code", c.c_char * 8), ("file", c.c_char * 512),
                ("source_line", c.c_char * 512), ("element", c.c_char * 128), ("message", c.c_char * 512),
                ("advice", c.c_char * 512)]


class EngineOptions(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("plugin_path", c.c_char_p), ("standard_plugins", c.c_char_p),
                ("log", c.CFUNCTYPE(None, c.c_void_p, c.c_int32, c.c_char_p)), ("log_context", c.c_void_p),
                ("log_level", c.c_int32)]


class Sizes(Sized):
    _fields_ = [(name, c.c_uint32) for name in (
        "struct_size", "bodies", "joints", "frames", "coordinates", "rates", "inputs", "records", "loops",
        "constraints", "equations", "unknowns", "watches")]


class Settings(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("steps", c.c_uint32), ("duration", c.c_double), ("length", c.c_double),
                ("gravity", c.c_double * 3), ("hash", c.c_uint64)]


class Report(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("verdict", c.c_int32), ("solver", c.c_int32),
                ("iterations", c.c_uint32), ("rank", c.c_uint32), ("equations", c.c_uint32),
                ("unknowns", c.c_uint32), ("residual", c.c_double), ("condition", c.c_double),
                ("coordinate_error", c.c_double), ("change_points", c.c_uint32), ("limit_input", c.c_int32),
                ("change_point_time", c.c_double), ("limit_time", c.c_double), ("limit_value", c.c_double),
                ("drive_instead", c.c_int32), ("limits", c.c_uint32), ("pace", c.c_double)]


class CloseOptions(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("method", c.c_int32), ("max_iterations", c.c_uint32),
                ("tolerance", c.c_double)]


class Analysis(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("mobility_count", c.c_int32), ("mobility_rank", c.c_int32),
                ("rank", c.c_uint32), ("equations", c.c_uint32), ("tree_rates", c.c_uint32),
                ("largest_singular_value", c.c_double), ("last_singular_value", c.c_double), ("gap", c.c_double)]


class Freedoms(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("mobility_by_kind", c.c_int32), ("mobility_here", c.c_int32),
                ("mobility_nearby", c.c_int32), ("redundant_here", c.c_uint32), ("redundant_nearby", c.c_uint32),
                ("planar_loops", c.c_uint32), ("spherical_loops", c.c_uint32), ("isolated", c.c_uint32),
                ("indeterminate", c.c_uint32), ("shaky", c.c_int32)]


PROGRESS = c.CFUNCTYPE(c.c_int32, c.c_size_t, c.c_double, c.c_void_p)


class ModesOptions(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("all_twins", c.c_int32), ("most", c.c_uint64), ("restarts", c.c_uint64),
                ("progress", PROGRESS), ("user", c.c_void_p)]


class ModesSummary(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("complete", c.c_int32), ("count", c.c_uint64), ("twins", c.c_uint64),
                ("missed_by", c.c_double)]


class Mode(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("limit", c.c_int32), ("residual", c.c_double)]


class SimulationOptions(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("reserved", c.c_uint32), ("tolerance", c.c_double), ("step", c.c_double),
                ("end", c.c_double), ("integrator", c.c_char_p),
                ("formulation", c.c_char_p)]


class SimulationSummary(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("freedoms", c.c_uint32), ("switches", c.c_uint32),
                ("reserved", c.c_uint32), ("steps", c.c_uint64), ("rejected", c.c_uint64), ("evaluations", c.c_uint64),
                ("energy", c.c_double), ("energy_error", c.c_double), ("energy_size", c.c_double),
                ("position_drift", c.c_double), ("velocity_drift", c.c_double), ("start_change", c.c_double),
                ("tolerance", c.c_double), ("step", c.c_double), ("stiff", c.c_int32), ("events", c.c_uint32)]


class Crossing(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("watch", c.c_uint32), ("time", c.c_double), ("rising", c.c_int32),
                ("stop", c.c_int32)]


NO_WATCH = 0xFFFFFFFF


class EquilibriumOptions(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("drives", c.c_int32), ("search", c.c_int32), ("max_iterations", c.c_uint32)]


class EquilibriumSummary(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("found", c.c_int32), ("freedoms", c.c_uint32), ("iterations", c.c_uint32),
                ("stable", c.c_uint32), ("unstable", c.c_uint32), ("indifferent", c.c_uint32),
                ("circulatory", c.c_int32), ("states_held", c.c_int32), ("worst", c.c_uint32),
                ("moved_most", c.c_uint32), ("reserved", c.c_uint32),
                *((name, c.c_double) for name in ("residual", "force", "force_scale", "coordinate_error", "energy",
                                                  "moved", "unrest", "stiffness_error"))]


class LinearisationOptions(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("drives", c.c_int32), ("equilibrium", c.c_void_p),
                ("efforts", c.POINTER(c.c_uint32)), ("effort_count", c.c_size_t)]


class LinearisationSummary(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("course", c.c_int32), ("freedoms", c.c_uint32), ("states", c.c_uint32),
                ("inputs", c.c_uint32), ("outputs", c.c_uint32), ("drift", c.c_double)]


class Eigenmode(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("reserved", c.c_uint32), ("real", c.c_double), ("imaginary", c.c_double),
                ("error", c.c_double)]


class StreamOptions(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("url", c.c_char_p), ("name", c.c_char_p), ("period", c.c_double)]


class StreamStatistics(Sized):
    _fields_ = [("struct_size", c.c_uint32), ("reserved", c.c_uint32), ("published", c.c_uint64),
                ("sent", c.c_uint64), ("dropped", c.c_uint64), ("failed", c.c_uint64)]
