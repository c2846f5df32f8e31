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


class MeshFirstContact(NamedTuple):
    """When two meshes on their way first touch: not before t_free, and by t_hit if is_certain; -1 without triangles."""

    t_free: float
    t_hit: float
    is_certain: bool
    triangle_a: int
    triangle_b: int


class Contacts(NamedTuple):
    """Where two meshes touch, the deepest first."""

    points: np.ndarray  # (n, 3) float64, in world coordinates
    normals: np.ndarray  # (n, 3) float64, of length 1
    depths: np.ndarray  # (n,) float64
    triangles: np.ndarray  # (n, 2) uint32


class BodyDistance(NamedTuple):
    """How far two bodies are apart, their margins taken in: the true distance is between lo and hi; parts: triangles or
    points, -1 of what has none."""

    body_a: int
    body_b: int
    distance: float
    lo: float
    hi: float
    point_a: np.ndarray  # (3,) float64, in the world, on the shape without its margin
    point_b: np.ndarray  # (3,) float64
    part_a: int
    part_b: int


class BodyDistances(NamedTuple):
    """The same of n pairs."""

    bodies: np.ndarray  # (n, 2) uint32
    distance: np.ndarray  # (n,) float64
    lo: np.ndarray  # (n,) float64
    hi: np.ndarray  # (n,) float64
    points_a: np.ndarray  # (n, 3) float64
    points_b: np.ndarray  # (n, 3) float64
    parts: np.ndarray  # (n, 2) int32


class BodyContacts(NamedTuple):
    """Where bodies meet: by depth * normal the second one has to move for the two parts there only to touch."""

    bodies: np.ndarray  # (n, 2) uint32
    points: np.ndarray  # (n, 3) float64, in the world
    normals: np.ndarray  # (n, 3) float64, of length 1, from the first to the second
    depths: np.ndarray  # (n,) float64
    parts: np.ndarray  # (n, 2) int32


class PlannedStage(NamedTuple):
    """One stage of a world's plan."""

    stage: str
    is_required: bool
    why: str


class LedgerRow(NamedTuple):
    """What one stage did."""

    stage: str
    calls: int
    items: int
    ns: float  # 0 where the world is not timed
    bytes: int  # held now


class FirstContacts(NamedTuple):
    """When bodies on their way first meet: not before t_free, and by t_hit if is_certain."""

    bodies: np.ndarray  # (n, 2) uint32
    t_free: np.ndarray  # (n,) float64
    t_hit: np.ndarray  # (n,) float64
    is_certain: np.ndarray  # (n,) bool
