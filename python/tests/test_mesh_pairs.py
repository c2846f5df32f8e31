"""Mesh against the triangle kernels, pair by pair."""

import numpy as np
import pytest

import boxwood as bw
from test_meshes import CUBE, FACES, soup


def at(x=0, y=0, z=0):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def turned(seed):
    q, r = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    q *= np.sign(np.diag(r))
    pose = np.eye(4)
    pose[:3, :3] = q if np.linalg.det(q) > 0 else -q
    pose[:3, 3] = 0.4, -0.1, 0.2
    return pose


@pytest.mark.parametrize("seed", range(4))
def test_pairs_against_all_triangles(seed):
    vertices, faces = soup(60, seed)
    others, other_faces = soup(50, seed + 10)
    pose = turned(seed)
    mesh, other = bw.Mesh(vertices, faces), bw.Mesh(others, other_faces)
    a = vertices[faces].astype(float)
    b = others[other_faces].astype(float) @ pose[:3, :3].T + pose[:3, 3]
    i, j = (index.ravel() for index in np.meshgrid(np.arange(60), np.arange(50), indexing="ij"))
    touch = bw.triangles_intersect(a[i], b[j])
    found = mesh.touching(other, other_pose=pose)
    assert {tuple(pair) for pair in found.tolist()} == {(int(p), int(q)) for p, q in zip(i[touch], j[touch])}
    assert mesh.collides(other, other_pose=pose) == touch.any()
    pose[:3, 3] += 3, 1, 0
    b = b + np.array([3, 1, 0])
    least = bw.triangle_distances(a[i], b[j])
    answer = mesh.distance(other, other_pose=pose)
    assert answer.lo <= least.hi.min() * (1 + 1e-12) and least.lo.min() <= answer.hi * (1 + 1e-12)
    assert np.linalg.norm(answer.point_b - answer.point_a) == pytest.approx(answer.distance)
    assert mesh.within(other, answer.hi * 1.001, other_pose=pose) and not mesh.within(other, answer.lo * 0.999, other_pose=pose)
    loose = mesh.distance(other, other_pose=pose, relative=0.5)
    assert answer.lo <= loose.hi and loose.hi * 0.5 <= loose.lo * (1 + 1e-9)


def test_poses_of_both_move_the_answer():
    cube = bw.Mesh(CUBE, FACES)
    assert len(cube) == 12 and cube.nbytes > 0 and "12" in repr(cube)
    answer = cube.distance(cube, at(10), at(13))
    assert answer.distance == 2 and answer.point_a[0] == 11 and answer.point_b[0] == 13
    assert cube.collides(cube, at(1), at(2)) and not cube.collides(cube, at(1), at(2.000001))
    contacts = cube.contacts(cube, None, at(0.9), max_contacts=4)
    assert contacts.points.shape == contacts.normals.shape == (4, 3) and contacts.triangles.shape == (4, 2)
    assert (contacts.depths >= 0).all() and np.allclose(np.linalg.norm(contacts.normals, axis=1), 1)


def test_a_shape_is_the_other():
    cube, ball = bw.Mesh(CUBE, FACES), bw.Shape.sphere(0.5)
    far = cube.distance(ball, other_pose=at(4, 0.5, 0.5))
    assert far.lo <= 2.5 <= far.hi and far.distance == pytest.approx(2.5) and far.triangle_a >= 0 and far.triangle_b == -1
    assert np.allclose(far.point_a, [1, 0.5, 0.5]) and np.allclose(far.point_b, [3.5, 0.5, 0.5])
    assert not cube.collides(ball, other_pose=at(4)) and cube.collides(ball, at(3), at(4.4, 0.5, 0.5))
    assert cube.within(ball, 2.51, other_pose=at(4, 0.5, 0.5)) and not cube.within(ball, 2.49, other_pose=at(4, 0.5, 0.5))
    pairs = cube.touching(ball, other_pose=at(1.25, 0.3, 0.6))
    assert len(pairs) and (pairs[:, 1] == 0).all() and (np.diff(pairs[:, 0].astype(int)) > 0).all()
    contacts = cube.contacts(ball, other_pose=at(1.25, 0.3, 0.6))
    assert sorted(contacts.triangles[:, 0].tolist()) == pairs[:, 0].tolist()
    assert contacts.depths[0] == pytest.approx(0.25) and np.allclose(contacts.normals[0], [1, 0, 0])
    # Solid: a mesh inside touches it.
    assert cube.collides(bw.Shape.box([9, 9, 9])) and not cube.collides(bw.Mesh(np.asarray(CUBE, float) * 9 - 4, FACES))
    assert cube.collides(bw.Shape.hull(np.asarray(CUBE, float) + [1, 0, 0]))
    for wrong in (bw.Shape.surface(CUBE, FACES), bw.World(), None):
        with pytest.raises(TypeError, match="boxwood.Shape"):
            cube.collides(wrong)


def test_what_is_wrong_is_said():
    cube = bw.Mesh(CUBE, FACES)
    for pose, words in ((np.eye(3), "shape"), (2 * np.eye(4), "last row"), (np.diag([2, 2, 2, 1]), "rigid"),
                        (np.full((4, 4), np.nan), "last row")):
        with pytest.raises(ValueError, match=words):
            cube.collides(cube, pose)
    with pytest.raises(ValueError, match="tolerance"):
        cube.within(cube, -1)
    with pytest.raises(ValueError, match="finite"):
        bw.Mesh(CUBE * np.nan, FACES)
    empty = bw.Mesh(np.zeros((0, 3)), np.zeros((0, 3), int))
    answer = cube.distance(empty)
    assert not cube.collides(empty) and answer.triangle_a == -1 and answer.distance == np.inf


def test_meshes_on_their_way_meet_where_they_are_near():
    cube = bw.Mesh(CUBE, FACES)
    met = cube.first_contact(cube, to=at(4), other_pose=at(3))
    assert met.is_certain and met.t_free <= 0.5 <= met.t_hit + 1e-9 and met.t_hit - met.t_free < 1e-6
    assert met.triangle_a >= 0 and met.triangle_b >= 0
    assert not cube.within(cube, 1e-3, at(4 * met.t_free * 0.999), at(3)) and cube.within(cube, 1e-6, at(4 * met.t_hit), at(3))
    both = cube.first_contact(cube, at(2), at(1), None, at(3))
    assert both.t_free <= 0.5 <= both.t_hit + 1e-9
    assert cube.first_contact(cube, to=at(0, 9), other_pose=at(3)) is None
    early = cube.first_contact(cube, to=at(4), other_pose=at(3), tolerance=0.5)
    assert 0.375 - 1e-9 <= early.t_hit <= met.t_hit and cube.within(cube, 0.5, at(4 * early.t_hit), at(3))
    assert cube.first_contact(cube, to=at(8), other_pose=at(3, 1.125)) is None
    aside = cube.first_contact(cube, to=at(8), other_pose=at(3, 1.125), tolerance=0.25)
    assert aside.is_certain and cube.within(cube, 0.25, at(8 * aside.t_hit), at(3, 1.125))
    with pytest.raises(ValueError, match="tolerance"):
        cube.first_contact(cube, tolerance=-1)
    # A plate of no thickness, flown at by a step that is far longer than the cube.
    plate = bw.Mesh([[50, -9, -9], [50, 9, -9], [50, 0, 18]], [[0, 1, 2]])
    through = cube.first_contact(plate, to=at(1000))
    assert through.is_certain and through.t_hit == pytest.approx(0.049, abs=1e-6)
    turn = np.diag([-1.0, -1.0, 1.0, 1.0])  # half a turn about z
    assert cube.first_contact(cube, to=turn, other_pose=at(-0.5, -3)) is None
    assert cube.first_contact(cube, to=turn, other_pose=at(-0.9, -0.9), path="screw") is not None
    with pytest.raises(ValueError, match="path"):
        cube.first_contact(cube, to=at(4), path="bent")
    with pytest.raises(ValueError, match="to: "):
        cube.first_contact(cube, to=2 * np.eye(4))


def test_a_mesh_and_a_shape_on_their_way_meet():
    cube, ball = bw.Mesh(CUBE, FACES), bw.Shape.sphere(0.5)
    met = cube.first_contact(ball, to=at(4), other_pose=at(3))
    assert met.is_certain and met.t_free <= 0.375 + 1e-9 and met.t_hit == pytest.approx(0.375, abs=1e-6)
    assert met.triangle_a >= 0 and met.triangle_b == -1
    assert cube.first_contact(ball, to=at(0, 9), other_pose=at(3)) is None
    floor = bw.Shape.half_space([0, 0, 1], -2)
    sunk = np.eye(4)
    sunk[2, 3] = -3
    assert cube.first_contact(floor, to=sunk).t_hit == pytest.approx(2 / 3, abs=1e-6)
    with pytest.raises(TypeError, match="other"):
        cube.first_contact(bw.Shape.points([[0, 0, 0]], 0.1), to=at(4))


def test_a_search_may_start_somewhere_and_end_early():
    vertices, faces = soup(200, 3)
    mesh, pose = bw.Mesh(vertices, faces), turned(5)
    pose[:3, 3] += 6
    cold = mesh.distance(mesh, other_pose=pose)
    warm = mesh.distance(mesh, other_pose=pose, start=(cold.triangle_a, cold.triangle_b))
    assert warm.lo <= cold.hi and cold.lo <= warm.hi
    beyond = mesh.distance(mesh, other_pose=pose, limit=cold.lo / 2)
    assert beyond.lo >= cold.lo / 2 and beyond.hi == np.inf and beyond.triangle_a == -1
    assert mesh.distance(mesh, other_pose=pose, limit=cold.hi * 2).triangle_a >= 0
    for start in ((200, 0), (0, -1)):
        with pytest.raises(ValueError, match="start"):
            mesh.distance(mesh, start=start)
    with pytest.raises(TypeError, match="start"):
        mesh.distance(bw.Shape.sphere(1), start=(0, 0))
    beside = at(0.05)
    assert len(mesh.touching(mesh, other_pose=beside)) > 5 and len(mesh.touching(mesh, other_pose=beside, max_pairs=5)) == 5
    assert len(mesh.touching(bw.Shape.box([9, 9, 9]), max_pairs=7)) == 7
