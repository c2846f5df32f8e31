"""What queries return: named tuples of arrays."""

from typing import NamedTuple

import numpy as np


class Items(NamedTuple):
    """The items of query i are items[offsets[i]:offsets[i + 1]]."""

    offsets: np.ndarray  # (n + 1,) uint64
    items: np.ndarray  # (m,) uint32


class Nearest(NamedTuple):
    """The k nearest items of each query; -1 and infinity where there are fewer."""

    items: np.ndarray  # (n, k) int32
    distances: np.ndarray  # (n, k) float64


class Hits(NamedTuple):
    """Where rays meet triangles; a miss has triangle -1 and an infinite t."""

    t: np.ndarray  # (n,) float32
    triangle: np.ndarray  # (n,) int32
    u: np.ndarray  # (n,) float32
    v: np.ndarray  # (n,) float32


class ClosestPoints(NamedTuple):
    """The nearest point of a mesh to each query; -1 and infinity of an empty mesh."""

    points: np.ndarray  # (n, 3) float32
    triangle: np.ndarray  # (n,) int32
    distance: np.ndarray  # (n,) float64


class Distances(NamedTuple):
    """Distances, and the certain interval around each."""

    distance: np.ndarray  # (n,) float64
    lo: np.ndarray  # (n,) float64
    hi: np.ndarray  # (n,) float64


class MeshDistance(NamedTuple):
    """How far two meshes are apart: the true distance is between lo and hi; -1 where one is empty."""

    distance: float
    lo: float
    hi: float
    point_a: np.ndarray  # (3,) float64, in world coordinates
    point_b: np.ndarray  # (3,) float64
    triangle_a: int
    triangle_b: int


class Contacts(NamedTuple):
    """Where two meshes touch, the deepest first."""

    points: np.ndarray  # (n, 3) float64, in world coordinates
    normals: np.ndarray  # (n, 3) float64, of length 1
    depths: np.ndarray  # (n,) float64
    triangles: np.ndarray  # (n, 2) uint32
