"""Trees of axis-aligned boxes (BVH) and exact triangle kernels for numpy arrays.

    import boxwood as bw
    bvh = bw.Bvh(boxes)                              # (n, 6) or (mins, maxs)
    bvh.pairs()                                      # (m, 2): which overlap
    mesh = bw.MeshBvh(vertices, faces)
    hits = mesh.closest_hits(origins, directions)    # t, triangle, u, v

boxwood.results reads the result files of the command `boxwood`, boxwood.trimesh
casts rays for trimesh.
"""

import importlib

from ._answers import (BodyContacts, BodyDistance, BodyDistances, ClosestPoints, Contacts, Distances, FirstContacts, Hits,
                       Items, MeshDistance, Nearest)

__all__ = ["BodyContacts", "BodyDistance", "BodyDistances", "Bvh", "ClosestPoints", "Contacts", "Distances",
           "FirstContacts", "Hits", "Items", "Mesh", "MeshBvh", "MeshDistance", "Nearest", "Shape", "World", "results",
           "triangle_distances", "triangles_intersect"]

_CORE = {"Bvh", "Mesh", "MeshBvh", "Shape", "World", "triangle_distances", "triangles_intersect", "__version__"}


def __getattr__(name):
    # Each when it is asked for: results needs h5py, and is read where the rest was not built.
    if name in _CORE:
        return getattr(importlib.import_module("boxwood._core"), name)
    if name in ("results", "trimesh"):
        return importlib.import_module(f"boxwood.{name}")
    raise AttributeError(f"module 'boxwood' has no attribute '{name}'")


def __dir__():
    return sorted({*globals(), *__all__})
