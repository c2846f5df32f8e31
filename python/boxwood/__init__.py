"""Trees of axis-aligned boxes (BVH) and exact triangle kernels for numpy arrays.

    import boxwood as bw
    bvh = bw.Bvh(boxes)                              # (n, 6) or (mins, maxs)
    bvh.pairs()                                      # (m, 2): which overlap
    mesh = bw.MeshBvh(vertices, faces)
    hits = mesh.closest_hits(origins, directions)    # t, triangle, u, v

boxwood.results reads the result files of the command `boxwood`, boxwood.trimesh
casts rays for trimesh.
"""

import importlib as _importlib
import sys as _sys

try:
    import numpy as _numpy  # noqa: F401
except ImportError as cause:
    raise ImportError(f"boxwood needs numpy, which {_sys.executable} does not have") from cause

from ._answers import (BodyContacts, BodyDistance, BodyDistances, ClosestPoints, Contacts, Distances, FirstContacts, Hits,
                       Items, LedgerRow, MeshDistance, MeshFirstContact, Nearest, PlannedStage)

__all__ = ["BodyContacts", "BodyDistance", "BodyDistances", "Bvh", "ClosestPoints", "Contacts", "Distances",
           "FirstContacts", "Hits", "Items", "LedgerRow", "Mesh", "MeshBvh", "MeshDistance", "MeshFirstContact", "Nearest",
           "PlannedStage", "Shape", "World",
           "builders", "layouts", "triangle_distances", "triangles_intersect"]

_CORE = {"Bvh", "Mesh", "MeshBvh", "Shape", "World", "builders", "layouts", "triangle_distances", "triangles_intersect",
         "__version__"}


def _compiled():
    try:
        return _importlib.import_module("boxwood._core")
    except ModuleNotFoundError as cause:
        if cause.name != "boxwood._core":
            raise
        raise ImportError(
            f"boxwood's compiled part is not in {__path__[0]} for Python {_sys.version_info.major}.{_sys.version_info.minor} "
            f"({_sys.executable}): build it with `cmake --build build/release --target boxwood_python` for the Python that "
            "cmake found, or `pip install .`") from cause


def __getattr__(name):
    # Each when it is asked for: results needs h5py (pip install 'boxwood[results]'), which is no reason for * to fail, and
    # is read where the rest was not built.
    if name in _CORE:
        return getattr(_compiled(), name)
    if name in ("results", "trimesh"):
        return _importlib.import_module(f"boxwood.{name}")
    raise AttributeError(f"module 'boxwood' has no attribute '{name}'")


def __dir__():
    return sorted({*__all__, "results", "trimesh", "__doc__", "__version__"})
