"""World against its own answers about pairs, and against plain numpy where that is easy."""

import itertools
import threading

import numpy as np
import pytest

import boxwood as bw
from test_mesh_pairs import at, turned
from test_meshes import CUBE, FACES


def random_world(seed, n=40, **options):
    random = np.random.default_rng(seed)
    mesh = bw.Mesh(CUBE - 0.5, FACES)
    shapes = [mesh, bw.Shape.solid(CUBE, FACES), bw.Shape.sphere(0.4), bw.Shape.box((0.5, 0.8, 0.6)),
              bw.Shape.capsule(0.2, 0.6), bw.Shape.cylinder(0.3, 0.5), bw.Shape.cone(0.4, 0.8),
              bw.Shape.ellipsoid((0.3, 0.5, 0.4)), bw.Shape.hull(random.standard_normal((12, 3)) * 0.3),
              bw.Shape.points(random.random((30, 3)), 0.1), bw.Shape.height_field(random.random((4, 5)), 0.3, 0.3)]
    world = bw.World(**options)
    for i in range(n):
        pose = turned(seed * 1000 + i)
        pose[:3, 3] = random.random(3) * 3
        world.insert(shapes[i % len(shapes)], pose, name=f"body {i}", margin=0.05 * (i % 3))
    return world


def poses_to(world, seed):
    random = np.random.default_rng(seed)
    poses = np.array([world.pose(int(body)) for body in world.bodies()])
    poses[:, :3, 3] += random.random((len(poses), 3)) - 0.5
    return poses


@pytest.mark.parametrize("threads", [1, 2])
def test_against_all_pairs(threads):
    world = random_world(1, threads=threads)
    world.insert(bw.Shape.half_space((0, 0, 1), 0.1), name="floor")
    for a, b in [(0, 1), ("body 3", "floor"), (7, 8)]:
        world.allow(a, b, "adjacent", "seen by eye")
    pairs = [(a, b) for a, b in itertools.combinations(range(len(world)), 2) if world.may_meet(a, b)]
    assert len(pairs) == 41 * 40 // 2 - 3 and world.allowed(1, 0) == "adjacent" and world.allowed(1, 2) is None
    distances = [world.distance(a, b) for a, b in pairs]
    touching = [pair for pair in pairs if world.collides(*pair)]
    assert [tuple(pair) for pair in world.collisions().tolist()] == touching and len(touching) > 20
    assert world.any_collision() in touching
    near = [pair for pair, d in zip(pairs, distances) if d.lo <= 0.1]
    assert [tuple(pair) for pair in world.within(0.1).tolist()] == near
    found = world.distances(0.1)
    assert found.bodies.tolist() == world.within(0.1).tolist() and (found.lo <= found.hi).all()
    assert set(near) <= {tuple(pair) for pair in world.candidates(0.1).tolist()}
    assert world.collisions_of("body 5").tolist() == sorted({a + b - 5 for a, b in touching if 5 in (a, b)})
    contacts = world.contacts(max_contacts=2)
    assert {tuple(pair) for pair in contacts.bodies.tolist()} == set(touching)
    assert np.allclose(np.linalg.norm(contacts.normals, axis=1), 1) and (contacts.depths > -1e-9).all()
    assert world.least_distance().distance == 0
    assert [world.are_within(*pair, 0.1) for pair in pairs] == [d.lo <= 0.1 for d in distances]
    assert world.candidates_of(5, 0.1).tolist() == sorted({a + b - 5 for a, b in world.candidates(0.1).tolist() if 5 in (a, b)})
    of_9 = [d.distance for pair, d in zip(pairs, distances) if 9 in pair]
    assert world.least_distance_of("body 9").distance == pytest.approx(max(min(of_9), 0), abs=1e-12)
    between = world.contacts_between(*touching[0], max_contacts=2)
    of_pair = (contacts.bodies == touching[0]).all(axis=1)
    assert np.allclose(between.depths, contacts.depths[of_pair]) and between.bodies.tolist() == [list(touching[0])] * len(between.depths)


def test_a_signed_distance_goes_below_zero():
    world = bw.World()
    ball = world.insert(bw.Shape.sphere(0.5), at(3))
    box = world.insert(bw.Shape.box((2, 2, 2)), at(1.75))
    deep = world.signed_distance(box, ball)
    assert deep.distance == pytest.approx(-0.25) and deep.lo <= deep.distance <= deep.hi
    solids = [world.insert(bw.Shape.solid(2 * CUBE, FACES), at(x)) for x in (10, 11.5)]
    found = world.signed_distance(*solids, tolerance=0.01)
    assert found.hi - found.lo <= 0.0101 and world.distance(*solids).distance == 0 and found.distance < -0.1
    probe = world.insert(bw.Shape.sphere(0.5), at(12, 1, 1))  # about the middle of a face of the first
    mixed, back = (world.signed_distance(*pair, tolerance=0.01) for pair in ((solids[0], probe), (probe, solids[0])))
    assert mixed.lo <= -0.5 <= mixed.hi and mixed.hi - mixed.lo <= 0.0101
    assert back.lo <= mixed.hi and mixed.lo <= back.hi
    shell = world.insert(bw.Mesh(CUBE, FACES))
    with pytest.raises(ValueError, match="a surface has no inside"):
        world.signed_distance(box, shell)


def test_a_world_says_what_it_did():
    world = random_world(4, is_timed=True)
    plan = world.plan()
    assert len(plan) > 4 and any(stage.is_required for stage in plan) and all(stage.why for stage in plan)
    world.collisions()
    ledger = world.ledger()
    assert [row.stage for row in ledger] == [stage.stage for stage in plan]
    busy = [row for row in ledger if row.calls]
    assert busy and sum(row.ns for row in busy) > 0 and max(row.items for row in busy) > 0
    world.clear_ledger()
    assert not any(row.calls for row in world.ledger())


def test_spheres_against_numpy():
    random = np.random.default_rng(2)
    centres, radii, margins = random.random((60, 3)) * 10, random.random(60) * 0.3 + 0.1, random.random(60) * 0.2
    world = bw.World()
    for centre, radius, margin in zip(centres, radii, margins):
        world.insert(bw.Shape.sphere(radius), at(*centre), margin=margin)
    a, b = np.triu_indices(60, 1)
    gaps = np.linalg.norm(centres[a] - centres[b], axis=1) - (radii + margins)[a] - (radii + margins)[b]
    assert world.collisions().tolist() == np.column_stack([a, b])[gaps <= 0].tolist()
    assert world.within(0.5).tolist() == np.column_stack([a, b])[gaps <= 0.5].tolist()
    world.remove(0)
    centres = np.delete(centres, 0, 0)
    poses = np.array([at(*centre) for centre in centres * 4])
    world.set_poses(world.bodies(), poses)
    assert np.allclose(world.pose(5), poses[4])
    reach = (radii + margins)[1:]
    a, b = np.triu_indices(59, 1)
    gaps = np.linalg.norm(4 * (centres[a] - centres[b]), axis=1) - reach[a] - reach[b]
    nearest = world.least_distance()
    assert nearest.distance == pytest.approx(gaps.min()) and (nearest.body_a, nearest.body_b) == (a[gaps.argmin()] + 1, b[gaps.argmin()] + 1)
    assert world.least_distance(gaps.min() * 0.99) is None
    rough = world.least_distance(relative=0.5, absolute=0.01)
    assert rough.lo <= gaps.min() + 1e-9 and gaps.min() - 1e-9 <= rough.distance <= rough.hi
    with pytest.raises(ValueError, match="relative"):
        world.least_distance_of(5, relative=1)


def test_first_contacts():
    world = bw.World()
    plate = world.insert(bw.Mesh(CUBE * (4, 4, 0.001) - (2, 2, 0), FACES), name="plate")
    ball = world.insert(bw.Shape.sphere(0.5), at(0.1, 0.2, 5), name="ball", margin=0.25)
    found = world.first_contacts([ball], [at(0.1, 0.2, -5)])
    assert found.bodies.tolist() == [[plate, ball]] and found.is_certain.all()
    assert found.t_hit[0] == pytest.approx((5 - 0.751) / 10, abs=1e-6) and found.t_free[0] <= found.t_hit[0]
    world.allow("plate", "ball")
    assert len(world.first_contacts([ball], [at(0.1, 0.2, -5)], "screw").t_hit) == 0


def test_many_threads_ask_one_world():
    world, again = random_world(3), random_world(3)
    expected = world.collisions().tolist()
    found = []
    threads = [threading.Thread(target=lambda: found.append(again.collisions().tolist())) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected] * 4


def test_meshes_share_their_tree():
    shape = bw.Shape.surface(CUBE, FACES)
    world = bw.World()
    for i in range(5):
        world.insert(shape, at(3 * i))
    assert not shape.is_built and len(world.collisions()) == 0 and not shape.is_built
    world.set_pose(1, at(0.5))
    assert world.collisions().tolist() == [[0, 1]] and shape.is_built and "surface" in repr(shape)


def test_what_is_wrong_is_said():
    world = bw.World()
    cube = world.insert(bw.Mesh(CUBE, FACES), name="cube", group=2, mask=4)
    assert cube in world and 5 not in world and "cube" in world and "ball" not in world
    assert len(world) == 1 and "1" in repr(world) and world.find("cube") == cube
    for call, words in ((lambda: world.insert(bw.Shape.sphere(-1)), "sphere"),
                        (lambda: world.insert(bw.Shape.sphere(1), name="cube"), "two bodies"),
                        (lambda: world.insert(bw.Shape.sphere(1), np.diag([2, 2, 2, 1])), "rigid"),
                        (lambda: world.pose(7), "body 7"), (lambda: world.pose("cub"), "did you mean 'cube'"),
                        (lambda: world.within(-1), "tolerance"), (lambda: world.allow(0, 0), "itself"),
                        (lambda: world.allow(0, 0, "because"), "because"),
                        (lambda: world.set_poses([0], np.zeros((2, 4, 4))), "row 0"),
                        (lambda: world.set_poses([0, 0], [np.eye(4)]), "2 bodies and 1 poses"),
                        (lambda: world.first_contacts([0], [np.eye(4)], "bent"), "bent"),
                        (lambda: bw.Shape.solid(CUBE, FACES[1:]), "solid"), (lambda: bw.Shape.box((1, 2)), "three"),
                        (lambda: bw.Shape.height_field(np.zeros((1, 5))), "2 rows"),
                        (lambda: bw.World(threads=0), "threads")):
        with pytest.raises(ValueError, match=words):
            call()
    with pytest.raises(TypeError, match="Shape or boxwood.Mesh"):
        world.insert(3)
    with pytest.raises(TypeError):
        world.pose(1.5)
    world.clear()
    assert len(world) == 0 and world.any_collision() is None and world.least_distance() is None
