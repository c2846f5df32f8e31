"""Rays of trimesh, cast by boxwood: mesh.ray = boxwood.trimesh.RayMeshIntersector(mesh)."""

import numpy as np

from . import MeshBvh


FARTHEST = 2.0**126  # of an origin, from the middle of the mesh


def _largest(vectors):
    """Of each the largest of its absolute coordinates; NaN if one is."""
    x, y, z = np.abs(vectors.T)
    return np.maximum(np.maximum(x, y), z)


def _rows(name, given):
    """Of shape (n, 3), in float64; also from (3,), or nothing at all."""
    rows = np.asarray(given, dtype=np.float64)
    if rows.shape == (3,) or rows.size == 0:
        rows = rows.reshape(-1, 3)
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise ValueError(f"{name}: the shape (n, 3) is wanted, not {rows.shape}")
    return rows


class RayMeshIntersector:
    """The interface of trimesh.ray.ray_pyembree.RayMeshIntersector.

    mesh: a trimesh.Trimesh. The tree is made when it is first asked, and again once the mesh has
    changed. Coordinates are held in float32, measured from the middle of the mesh; places of hits
    come from the triangles' own corners, in float64. A ray with a NaN, an infinity, no direction or
    an origin of 2^126 or more meets nothing. Rays are of shape (n, 3), or (3,) for one; others
    raise ValueError.
    threads: how many a query may use.
    """

    def __init__(self, mesh, threads=1):
        self.mesh = mesh
        self.threads = threads
        self._made_of = None

    def __repr__(self):
        return f"<boxwood.trimesh.RayMeshIntersector of {len(self.mesh.faces)} triangles>"

    def __getstate__(self):
        """Copies and pickles make the tree again."""
        return {"mesh": self.mesh, "threads": self.threads, "_made_of": None}

    def _tree(self):
        made_of = hash(self.mesh), self.threads
        if self._made_of != made_of:
            self._middle = self.mesh.bounds.mean(axis=0) if len(self.mesh.faces) else np.zeros(3)
            self._bvh = MeshBvh(self.mesh.vertices - self._middle, self.mesh.faces, threads=self.threads)
            self._made_of = made_of
        return self._bvh

    def _cast(self, how, ray_origins, ray_directions):
        """The answer about the rays that are any, and which these are."""
        origins = _rows("ray_origins", ray_origins)
        directions = _rows("ray_directions", ray_directions)
        if len(origins) != len(directions):
            raise ValueError(f"there are {len(origins)} ray_origins and {len(directions)} ray_directions")
        tree = self._tree()
        origins = origins - self._middle
        length = _largest(directions)
        good = (length > 0) & (length < np.inf) & (_largest(origins) < FARTHEST)
        rays = np.flatnonzero(good)
        if len(rays) < len(origins):
            origins, directions, length = origins[rays], directions[rays], length[rays]
        if len(rays) and not 1e-3 < length.min() <= length.max() < 1e3:
            directions = directions / length[:, None]  # for float32 to hold it, and t
        return getattr(tree, how)(origins, directions), rays, len(good)

    def _places(self, triangle, u, v):
        corners = self.mesh.vertices[self.mesh.faces[triangle]].view(np.ndarray)
        u, v = np.float64(u)[:, None], np.float64(v)[:, None]
        return (1 - u - v) * corners[:, 0] + u * corners[:, 1] + v * corners[:, 2]

    def intersects_location(self, ray_origins, ray_directions, multiple_hits=True):
        """Where rays, shape (n, 3) each, meet the mesh.

        Returns (locations, index_ray, index_tri) of shape (h, 3), (h,), (h,): every hit, or the
        first of each ray.
        """
        index_tri, index_ray, locations = self.intersects_id(ray_origins, ray_directions, multiple_hits,
                                                             max_hits=None, return_locations=True)
        return locations, index_ray, index_tri

    def intersects_id(self, ray_origins, ray_directions, multiple_hits=True, max_hits=100, return_locations=False):
        """Which triangles rays meet: (index_tri, index_ray), and the locations if asked for.

        max_hits: the first so many of each ray; None for all.
        """
        if multiple_hits:
            (offsets, hits), rays, _ = self._cast("all_hits", ray_origins, ray_directions)
            counts = np.diff(offsets.astype(np.int64))
            index_ray = np.repeat(rays, counts)
            nth = np.arange(len(index_ray)) - np.repeat(offsets[:-1].astype(np.int64), counts)
            kept = nth < (np.inf if max_hits is None else max_hits)
        else:
            hits, index_ray, _ = self._cast("closest_hits", ray_origins, ray_directions)
            kept = hits.triangle >= 0
        index_tri = hits.triangle[kept].astype(np.int64)
        index_ray = index_ray[kept]
        if not return_locations:
            return index_tri, index_ray
        return index_tri, index_ray, self._places(index_tri, hits.u[kept], hits.v[kept])

    def intersects_first(self, ray_origins, ray_directions):
        """The triangle that each ray meets first, shape (n,), int64; -1 for none."""
        hits, rays, n = self._cast("closest_hits", ray_origins, ray_directions)
        first = np.full(n, -1, dtype=np.int64)
        first[rays] = hits.triangle
        return first

    def intersects_any(self, ray_origins, ray_directions):
        """Whether each ray meets the mesh, shape (n,), bool."""
        found, rays, n = self._cast("any_hits", ray_origins, ray_directions)
        any_hit = np.zeros(n, dtype=bool)
        any_hit[rays] = found
        return any_hit

    def contains_points(self, points):
        """Whether points, shape (n, 3), are inside the mesh or on it, shape (n,), bool: exactly,
        without a vote of rays, for both as float32 holds them. Points that are not finite are not.
        Raises ValueError for a mesh that is not closed, which has no inside."""
        points = _rows("points", points)
        tree = self._tree()
        inside = np.zeros(len(points), dtype=bool)
        if len(self.mesh.faces):
            low, high = self.mesh.bounds
            room = 1e-6 * np.max(high - low)  # more than float32 rounds by
            near = np.flatnonzero(np.all((points >= low - room) & (points <= high + room), axis=1))
            inside[near] = tree.contains(points[near] - self._middle)
        return inside
