"""MeshBvh and the triangle kernels against plain numpy, and trimesh where it is installed."""

import copy
import pickle

import numpy as np
import pytest

import boxwood as bw

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
FACES = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6],
                  [0, 6, 4], [1, 5, 7], [1, 7, 3]])


def soup(n, seed=1):
    random = np.random.default_rng(seed)
    vertices = (random.random((n, 1, 3)) + 0.2 * random.standard_normal((n, 3, 3))).reshape(-1, 3).astype(np.float32)
    return vertices, np.arange(3 * n).reshape(n, 3)


def moller(origin, direction, triangles):
    """Of one ray: t of each triangle, infinity where it misses."""
    a, b, c = (triangles[:, i].astype(float) for i in range(3))
    p = np.cross(direction, c - a)
    det = ((b - a) * p).sum(1)
    u = ((origin - a) * p).sum(1) / det
    q = np.cross(origin - a, b - a)
    v = (q @ direction) / det
    t = ((c - a) * q).sum(1) / det
    return np.where((u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0), t, np.inf)


@pytest.mark.parametrize("threads", [1, 2])
def test_rays_against_numpy(threads):
    vertices, faces = soup(300)
    random = np.random.default_rng(2)
    origins = random.random((200, 3)).astype(np.float32)
    directions = random.standard_normal((200, 3)).astype(np.float32)
    mesh = bw.MeshBvh(vertices, faces, threads=threads)
    hits = mesh.closest_hits(origins, directions)
    offsets, every = mesh.all_hits(origins, directions)
    times = np.array([moller(o, d, vertices[faces]) for o, d in zip(origins.astype(float), directions.astype(float))])
    assert 20 < np.isfinite(times).any(axis=1).sum()
    np.testing.assert_allclose(hits.t, times.min(axis=1), rtol=1e-4)
    assert ((hits.triangle < 0) == np.isinf(hits.t)).all()
    assert (mesh.any_hits(origins, directions) == (hits.triangle >= 0)).all()
    assert (np.diff(offsets.astype(int)) == np.isfinite(times).sum(axis=1)).mean() > 0.99
    hit = hits.triangle >= 0
    corners = vertices[faces[hits.triangle[hit]]].astype(float)
    u, v = hits.u[hit, None].astype(float), hits.v[hit, None].astype(float)
    np.testing.assert_allclose((1 - u - v) * corners[:, 0] + u * corners[:, 1] + v * corners[:, 2],
                               origins[hit] + hits.t[hit, None] * directions[hit], atol=2e-5)
    assert len(every.t) == offsets[-1]
    limited = mesh.closest_hits(origins, directions, t_max=np.where(hit, hits.t / 2, 1).astype(np.float32))
    assert (limited.triangle[hit] < 0).all()


def test_nearest_points_and_sides_of_a_cube():
    mesh = bw.MeshBvh(CUBE, FACES)
    assert mesh.is_closed and mesh.open_edges == 0 and len(mesh) == 12
    grid = np.stack(np.meshgrid(*[np.arange(-1, 2.25, 0.25)] * 3, indexing="ij"), -1).reshape(-1, 3)
    outside = np.linalg.norm(np.maximum(np.maximum(-grid, grid - 1), 0), axis=1)
    within = np.minimum(grid, 1 - grid).min(axis=1)
    np.testing.assert_array_equal(mesh.contains(grid), within >= 0)
    np.testing.assert_allclose(mesh.signed_distance(grid), np.where(within >= 0, -within, outside), atol=1e-7)
    closest = mesh.closest_points(grid)
    np.testing.assert_allclose(closest.distance, np.where(within >= 0, within, outside), atol=1e-7)
    np.testing.assert_allclose(np.linalg.norm(closest.points - grid, axis=1), closest.distance, atol=1e-6)
    mesh.update(CUBE + 10)
    assert mesh.contains([[10.5, 10.5, 10.5], [0.5, 0.5, 0.5]]).tolist() == [True, False]


def test_bad_meshes_and_rays_are_refused():
    for vertices, faces, message in ((CUBE[:, :2], FACES, r"vertices: .*\(n, 3\)"), (CUBE, FACES[:, :2], r"faces: .*\(n, 3\)"),
                                     (CUBE, [[0, 1, 8]], "faces: row 0 names 8, but there are 8"),
                                     (CUBE, [[0, 1, 2], [0, -1, 2]], "faces: row 1 names -1"),
                                     (np.full((3, 3), np.nan), [[0, 1, 2]], "vertices: row 0, of face 0, has a NaN"),
                                     (2.0**125 * CUBE * 2, FACES, r"vertices: row 1, of face 0, .*2\^126")):
        with pytest.raises(ValueError, match=message):
            bw.MeshBvh(vertices, faces)
    with pytest.raises(TypeError, match="integers"):
        bw.MeshBvh(CUBE, FACES.astype(float))
    with pytest.raises(ValueError, match="unknown kernel 'watertigt'; did you mean 'watertight'"):
        bw.MeshBvh(CUBE, FACES, kernel="watertigt")
    bw.MeshBvh(np.vstack([CUBE, [[np.nan, 0, 0]]]), FACES)  # of no face
    mesh = bw.MeshBvh(CUBE, FACES)
    with pytest.raises(ValueError, match="vertices: row 0, of face 0"):
        mesh.update(CUBE - [np.inf, 0, 0])
    with pytest.raises(ValueError, match="8 vertices, 7 are given"):
        mesh.update(CUBE[:-1])
    assert mesh.contains([[0.5, 0.5, 0.5]])[0]  # as before
    mesh = bw.MeshBvh(CUBE, FACES[:-1])
    with pytest.raises(ValueError, match="not closed.* 3 of its edges"):
        mesh.contains([[0.5, 0.5, 0.5]])
    one = [[0.0, 0, 0]]
    for origins, directions, options, message in (
            (one, [[0, 0, 0]], {}, "directions: row 0 is zero"), (one, [[0, np.nan, 1]], {}, "directions: row 0 has a NaN"),
            ([[np.inf, 0, 0]], [[1, 0, 0]], {}, "origins: row 0"), (one * 2, [[1, 0, 0]], {}, "2 origins and 1 directions"),
            (one, [[1, 0, 0]], {"t_min": -1}, "0 <= t_min"), (one, [[1, 0, 0]], {"t_max": [1, 2]}, "one for each of the 1")):
        with pytest.raises(ValueError, match=message):
            mesh.closest_hits(origins, directions, **options)


def test_triangles_exactly():
    random = np.random.default_rng(3)
    a = random.integers(-3, 4, (3000, 3, 3)).astype(float)
    b = random.integers(-3, 4, (3000, 3, 3)).astype(float)
    for threads in (1, 2):
        meets = bw.triangles_intersect(a, b, threads=threads)
        distances = bw.triangle_distances(a, b, threads=threads)
        assert meets.dtype == bool and 100 < meets.sum() < 2900
        np.testing.assert_array_equal(meets, distances.lo == 0)  # another kernel, and another way
        assert (distances.lo <= distances.distance).all() and (distances.distance <= distances.hi).all()
    corners = np.linalg.norm(a[:, :, None] - b[:, None], axis=3).min(axis=(1, 2))
    assert (distances.lo <= corners * (1 + 1e-12)).all()
    with pytest.raises(ValueError, match="a has 2 triangles, b has 3"):
        bw.triangles_intersect(a[:2], b[:3])
    with pytest.raises(ValueError, match="b: row 1 has a NaN"):
        bw.triangle_distances(a[:2], np.full((2, 3, 3), 0.0) + [[[0]], [[np.nan]]])
    assert bw.triangles_intersect([], []).shape == (0,)


def rays_of_trimesh(trimesh):
    """Its ways to cast rays: without Embree, and with it where embreex is installed."""
    from trimesh.ray import has_embree, ray_pyembree, ray_triangle

    return [ray_triangle.RayMeshIntersector] + [ray_pyembree.RayMeshIntersector] * bool(has_embree)


def test_trimesh_interface():
    trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed (pip install trimesh rtree embreex)")
    pytest.importorskip("rtree", reason="trimesh casts rays by rtree, which is not installed (pip install rtree)")
    from boxwood.trimesh import RayMeshIntersector

    mesh = trimesh.creation.icosphere(subdivisions=3)
    mesh.apply_translation([100, 0, 0])
    ours = RayMeshIntersector(mesh)
    random = np.random.default_rng(5)
    origins = mesh.bounds.mean(axis=0) + 1.5 * random.standard_normal((300, 3))
    directions = random.standard_normal((300, 3))
    points = mesh.bounds.mean(axis=0) + random.standard_normal((300, 3))
    for theirs in (kind(mesh) for kind in rays_of_trimesh(trimesh)):
        np.testing.assert_array_equal(ours.intersects_any(origins, directions), theirs.intersects_any(origins, directions))
        np.testing.assert_array_equal(ours.intersects_first(origins, directions), theirs.intersects_first(origins, directions))
        for multiple in (True, False):
            places, rays, triangles = ours.intersects_location(origins, directions, multiple_hits=multiple)
            expected, of_rays, of_triangles = theirs.intersects_location(origins, directions, multiple_hits=multiple)
            order, by = np.lexsort((triangles, rays)), np.lexsort((of_triangles, of_rays))
            np.testing.assert_array_equal(rays[order], of_rays[by])
            np.testing.assert_array_equal(triangles[order], of_triangles[by])
            np.testing.assert_allclose(places[order], expected[by], atol=1e-5)
            again = ours.intersects_id(origins, directions, multiple_hits=multiple)
            assert (again[0] == triangles).all() and (again[1] == rays).all()
        np.testing.assert_array_equal(ours.contains_points(points), theirs.contains_points(points))


def test_trimesh_takes_it_as_its_own():
    trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed (pip install trimesh)")
    from boxwood.trimesh import RayMeshIntersector

    mesh = trimesh.creation.icosphere(subdivisions=2)
    mesh.apply_translation([100, 0, 0])
    mesh.ray = RayMeshIntersector(mesh)
    assert mesh.contains([[100, 0, 0], [0, 0, 0]]).tolist() == [True, False]
    assert mesh.ray.intersects_first([[100, 0, 9], [np.nan, 0, 0]], [[0, 0, -1], [0, 0, 1]]).tolist()[1] == -1
    for copied in (copy.copy(mesh.ray), copy.deepcopy(mesh.ray), pickle.loads(pickle.dumps(mesh.ray))):
        assert copied.intersects_any([[100, 0, 9], [0, 0, 9]], [[0, 0, -1]] * 2).tolist() == [True, False]
    assert mesh.ray.intersects_first(np.empty((0, 3)), np.empty((0, 3))).shape == (0,)
    odd = np.array([[0, 0, -1e-300], [0, 0, 0], [0, 0, -1e300], [np.nan, 0, -1], [np.inf, 0, 0], [0, 0, -1]])
    assert mesh.ray.intersects_any([[100, 0, 9]] * 6, odd).tolist() == [True, False, True, False, False, True]
    assert mesh.ray.intersects_id([[100.1, 0, 9]] * 6, odd)[1].tolist() == [0, 0, 2, 2, 5, 5]
    for shape in ((3, 4), (2, 6), (2, 3, 1)):
        with pytest.raises(ValueError, match=r"ray_origins: the shape \(n, 3\) is wanted"):
            mesh.ray.intersects_any(np.zeros(shape), np.ones(shape))
    assert mesh.ray.contains_points([[np.nan, 0, 0], [1e39, 0, 0], [100, 0, 0]]).tolist() == [False, False, True]
    with pytest.raises(ValueError, match="2 ray_origins and 1 ray_directions"):
        mesh.ray.intersects_any([[0, 0, 0]] * 2, [[0, 0, 1]])
    mesh.apply_translation([0, 50, 0])
    assert mesh.ray.intersects_any([[100, 0, 9], [100, 50, 9]], [[0, 0, -1]] * 2).tolist() == [False, True]
    plates = [trimesh.Trimesh([[0, 0, z], [1, 0, z], [0, 1, z]], [[0, 1, 2]]) for z in range(150)]
    through = RayMeshIntersector(trimesh.util.concatenate(plates))
    assert len(through.intersects_location([[0.2, 0.2, -1]], [[0, 0, 1]])[0]) == 150
    assert len(through.intersects_id([[0.2, 0.2, -1]], [[0, 0, 1]], max_hits=20)[0]) == 20
    nothing = RayMeshIntersector(trimesh.Trimesh())
    assert nothing.intersects_any([[0, 0, 9]], [[0, 0, -1]]).tolist() == [False]
    assert nothing.intersects_id([[0, 0, 9]], [[0, 0, -1]])[0].shape == (0,)
