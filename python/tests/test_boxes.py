"""Bvh against numpy, pair by pair."""

import copy
import os
import pickle
import platform
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import boxwood as bw

ENVIRONMENT = {**os.environ, "PYTHONPATH": str(Path(bw.__path__[-1]).parent)}


def boxes_of(n, seed=1, dtype=np.float32, size=0.05):
    random = np.random.default_rng(seed)
    low = random.random((n, 3)).astype(dtype)
    return np.hstack([low, low + (size * random.random((n, 3))).astype(dtype)])


def overlap(a, b):
    """(len(a), len(b)): which share a point."""
    return ((a[:, None, :3] <= b[None, :, 3:]) & (b[None, :, :3] <= a[:, None, 3:])).all(axis=2)


def listed(items):
    return [list(items.items[a:b]) for a, b in zip(items.offsets[:-1], items.offsets[1:])]


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("options", [{}, {"builder": "binned_sah", "layout": "wide8", "threads": 2}])
class TestAgainstNumpy:
    def test_pairs(self, dtype, options):
        boxes = boxes_of(500, dtype=dtype, size=0.1)
        bvh = bw.Bvh(boxes, **options)
        expected = np.argwhere(np.triu(overlap(boxes, boxes), 1))
        found = bvh.pairs()
        assert found.dtype == np.uint32 and found.shape == (len(expected), 2) and len(expected) > 20
        assert {*map(tuple, found)} == {*map(tuple, expected)}
        assert bvh.pair_count() == len(expected)
        assert len(bvh) == 500 and bvh.dtype == dtype and bvh.nbytes > 500 * 24

    def test_pairs_with_another(self, dtype, options):
        a, b = boxes_of(300, 1, dtype), boxes_of(200, 2, dtype)
        found = bw.Bvh(a, **options).pairs(bw.Bvh(b, **options))
        assert {*map(tuple, found)} == {*map(tuple, np.argwhere(overlap(a, b)))}
        assert bw.Bvh(a, **options).pair_count(bw.Bvh(b, **options)) == len(found)

    def test_regions_and_points(self, dtype, options):
        boxes, regions = boxes_of(400, dtype=dtype), boxes_of(50, 3, dtype, 0.2)
        bvh = bw.Bvh(boxes, **options)
        assert listed(bvh.overlapping(regions)) == [list(np.flatnonzero(row)) for row in overlap(regions, boxes)]
        points = np.vstack([boxes[:20, 3:], regions[:, :3]])  # corners are in their boxes
        around = overlap(np.hstack([points, points]), boxes)
        assert listed(bvh.containing(points)) == [list(np.flatnonzero(row)) for row in around]
        assert all(i in found for i, found in enumerate(listed(bvh.containing(points))[:20]))

    def test_nearest(self, dtype, options):
        boxes, points = boxes_of(300, dtype=dtype), boxes_of(40, 4, dtype)[:, :3]
        low, high, at = boxes[None, :, :3].astype(float), boxes[None, :, 3:].astype(float), points[:, None].astype(float)
        distances = np.sqrt((np.maximum(np.maximum(low - at, at - high), 0) ** 2).sum(axis=2))
        found = bw.Bvh(boxes, **options).nearest(points, k=5)
        assert found.items.shape == found.distances.shape == (40, 5)
        np.testing.assert_allclose(found.distances, np.sort(distances, axis=1)[:, :5], rtol=1e-12)
        np.testing.assert_allclose(np.take_along_axis(distances, found.items, axis=1), found.distances, rtol=1e-12)

    def test_update(self, dtype, options):
        boxes = boxes_of(300, dtype=dtype)
        bvh = bw.Bvh(boxes, **options)
        boxes[7] += 0.1
        with pytest.raises(ValueError, match="item 7 .* not listed"):
            bvh.update(boxes, moved=[3])
        bvh.update(boxes, moved=np.array([7]))
        expected = {*map(tuple, np.argwhere(np.triu(overlap(boxes, boxes), 1)))}
        assert {*map(tuple, bvh.pairs())} == expected
        bvh.update(boxes[:100])
        assert len(bvh) == 100


def test_a_touch_counts_and_doubles_are_exact():
    boxes = np.array([[0, 0, 0, 1, 1, 1], [1, 1, 1, 2, 2, 2], [np.nextafter(2, 3), 0, 0, 3, 3, 3]])
    assert bw.Bvh(boxes).pairs().tolist() == [[0, 1]]


def test_every_way_to_give_boxes():
    boxes = boxes_of(100)
    expected = bw.Bvh(boxes).pairs().tolist()
    wide = np.zeros((100, 12), np.float32)
    wide[:, ::2] = boxes
    flipped = np.asfortranarray(boxes)
    swapped = boxes.astype(">f4")
    unaligned = np.frombuffer(b"x" + boxes.tobytes(), np.uint8)[1:].view(np.float32).reshape(100, 6)
    read_only = boxes.copy()
    read_only.flags.writeable = False
    assert not unaligned.flags.aligned
    for given in (wide[:, ::2], flipped, swapped, boxes.tolist(), boxes.astype(np.float64), memoryview(boxes),
                  unaligned, read_only, boxes[::-1][::-1], boxes.view(np.recarray), list(boxes),
                  (boxes[:, :3], boxes[:, 3:]), (boxes[:, :3].tolist(), boxes[:, 3:])):
        assert sorted(bw.Bvh(given).pairs().tolist()) == sorted(expected)
    assert bw.Bvh(np.array([[0, 0, 0, 2, 2, 2], [1, 1, 1, 3, 3, 3]])).pairs().tolist() == [[0, 1]]  # integers
    assert bw.Bvh([]).pairs().shape == (0, 2) and bw.Bvh(np.empty((0, 6))).nearest([[0, 0, 0]]).items.tolist() == [[-1]]


@pytest.mark.parametrize("given, message", [
    (np.zeros((4, 5)), r"boxes: .*\(n, 6\).*\(4, 5\)"),
    (np.zeros(6), r"\(6,\)"),
    ((np.zeros((4, 3)),), r"\(mins, maxs\)"),
    ((np.zeros((4, 3)), np.zeros((5, 3))), "4 mins and 5 maxs"),
    ([[0, 0, 0, 1, 1, float("nan")]], "box 0: "),
    ([[0, 0, 0, 1, 1, 1], [0, 0, 0, -1, 1, 1]], "box 1: "),
    ([np.zeros((4, 3)), np.ones((4, 3))], r"as a tuple, \(mins, maxs\)"),
])
def test_bad_boxes_are_refused(given, message):
    with pytest.raises(ValueError, match=message):
        bw.Bvh(given)


def test_denormals_are_kept_whatever_another_module_has_set():
    """As a library built by -ffast-math leaves the thread."""
    code = ("import ctypes, numpy as np, boxwood as bw\n"
            "env = (ctypes.c_uint32 * 8)()\n"
            "libm = ctypes.CDLL('libm.so.6')\n"
            "libm.fegetenv(env); env[7] |= 0x8040; libm.fesetenv(env)\n"  # MXCSR of glibc's fenv_t on x86-64
            "boxes = np.array([[1e-40] * 3 + [2e-40] * 3, [2e-40] * 3 + [3e-40] * 3])\n"
            "print(bw.Bvh(boxes).nearest([[2e-40] * 3], k=2).items.tolist())")
    if platform.machine() != "x86_64":
        pytest.skip("it sets MXCSR, which is a register of x86-64")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=ENVIRONMENT, check=True)
    assert done.stdout.strip() == "[[0, 1]]"


def test_names_are_listed_and_copies_refused():
    assert "binned_sah" in bw.builders() and "wide8" in bw.layouts() and all(bw.layouts().values())
    for made in (bw.Bvh([]), bw.World(), bw.MeshBvh(np.zeros((0, 3)), np.zeros((0, 3), int)),
                 bw.Shape.sphere(1)):
        for twice in (copy.copy, copy.deepcopy, pickle.dumps):
            with pytest.raises(TypeError, match="is neither copied nor pickled: keep the arrays"):
                twice(made)


def test_other_bad_input_is_refused():
    with pytest.raises(TypeError, match="real numbers"):
        bw.Bvh([["a"] * 6])
    for ragged in ([[0, 0, 0, 1, 1, 1], [0, 0, 0]], [[0] * 6, 7]):
        with pytest.raises((TypeError, ValueError), match="boxes: "):
            bw.Bvh(ragged)
    for nothing in (None, object(), {}, "boxes"):
        with pytest.raises(TypeError, match="boxes: real numbers"):
            bw.Bvh(nothing)
    with pytest.raises(TypeError, match="boxes: a masked array is not taken"):
        bw.Bvh(np.ma.masked_array(np.zeros((2, 6)), mask=[[True] * 6, [False] * 6]))
    with pytest.raises(TypeError, match="complex"):
        bw.Bvh(np.zeros((3, 6), complex))
    for options, message in (({"builder": "binned_sha"}, "binned_sah"), ({"layout": "wide9"}, "wide"),
                             ({"threads": 0}, "threads: 1 to 1024"), ({"threads": -1}, "threads: 1 to 1024")):
        with pytest.raises(ValueError, match=message):
            bw.Bvh([], **options)
    bvh = bw.Bvh(boxes_of(10))
    with pytest.raises(ValueError, match="points: row 1 has a NaN"):
        bvh.containing([[0, 0, 0], [0, np.nan, 0]])
    with pytest.raises(ValueError, match="boxes: row 0 has a NaN"):
        bvh.overlapping([[0, 0, 0, 1, 1, np.nan]])
    with pytest.raises(ValueError, match="at least 1"):
        bvh.nearest([[0, 0, 0]], k=0)
    with pytest.raises(ValueError, match="at least 1"):
        bvh.nearest([[0, 0, 0]], k=-1)
    for held in (bvh, bw.Bvh(boxes_of(10, dtype=np.float64))):
        for k in (2**31, 2**62):  # 4 times the latter is 0 in 64 bits
            with pytest.raises(ValueError, match=r"more than 2\^32 answers; there are 10 items"):
                held.nearest(np.zeros((4, 3)), k=k)
        assert held.nearest(np.empty((0, 3)), k=4).items.shape == (0, 4)
        assert (held.nearest([[0, 0, 0]], k=100).items[0] >= 0).sum() == 10
    with pytest.raises(ValueError, match="another dtype"):
        bvh.pairs(bw.Bvh(boxes_of(10, dtype=np.float64)))
    with pytest.raises(ValueError, match="different layouts|same layout|two trees"):
        bvh.pairs(bw.Bvh(boxes_of(10), layout="wide8"))
    with pytest.raises(ValueError, match="moved: row 0 names 99"):
        bvh.update(boxes_of(10), moved=[99])
    with pytest.raises(TypeError, match="integers"):
        bvh.update(boxes_of(10), moved=[1.5])
    with pytest.raises(ValueError, match="row 0 is float64 for a tree of float32"):
        bvh.update(boxes_of(10, dtype=np.float64))
    bvh.update(boxes_of(10).astype(np.float64))  # which float32 holds
    bvh.update([[0, 0, 0, 1, 1, 1], [0.5, 0.5, 0.5, 2, 2, 2]])
    assert bvh.pairs().tolist() == [[0, 1]]
    assert bvh.overlapping([[1, 0, 0, 0, 1, 1]]).items.size == 0  # min > max: nothing


def test_answers_are_handed_over_and_outlive_the_tree():
    bvh = bw.Bvh(boxes_of(2000, size=0.2))
    pairs = bvh.pairs()
    assert not pairs.flags.owndata and pairs.base is not None
    kept = pairs[::7].copy()
    view = pairs[::7]
    del bvh, pairs
    junk = [np.full(100_000, 7) for _ in range(20)]
    assert (view == kept).all() and junk


@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_that_fit_are_not_copied(order):
    """Reading 48 MB where they lie takes no 48 MB more; the same in another order does."""
    code = rf"""if True:
        import re
        import numpy as np
        import boxwood as bw
        def peak():  # of this program; ru_maxrss may be that of who started it
            return int(re.search(r"VmHWM:\s*([0-9]+) kB", open("/proc/self/status").read())[1])
        boxes = np.ones((2_000_000, 6), np.float32, order={order!r})
        boxes[-1, 5] = np.nan
        bvh = bw.Bvh(np.zeros((1, 6), np.float32))
        bvh.overlapping(boxes[:10])
        before = peak()
        try:
            bvh.overlapping(boxes)
        except ValueError as error:
            assert "row 1999999 has a NaN" in str(error)
            print(peak() - before)
        """
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=ENVIRONMENT, check=True)
    grown = int(done.stdout)
    assert grown < 20_000 if order == "C" else grown > 20_000


def test_the_gil_is_released():
    """While one thread finds pairs, another counts."""
    bvh = bw.Bvh(boxes_of(300_000, size=0.06))
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0)

    counter = threading.Thread(target=count)
    counter.start()
    before = counted[0]
    start = time.perf_counter()
    for _ in range(3):
        bvh.pair_count()
    took, during = time.perf_counter() - start, counted[0] - before
    done.set()
    counter.join()
    assert took > 0.02, "too quick to tell"
    assert during > 20


def test_a_numpy_that_pybind11_does_not_know_is_refused():
    code = "import numpy; numpy.__version__ = '2.0.0'; import boxwood; boxwood.Bvh([])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=ENVIRONMENT)
    if bw._compiled()._pybind11_version >= (2, 12):
        assert done.returncode == 0, done.stderr
    else:
        assert "ImportError" in done.stderr and "does not know numpy 2.0.0" in done.stderr, done.stderr
