"""The Python of README.md and python/README.md runs and says what it says."""

import re
from pathlib import Path

import boxwood as bw
import numpy as np

ROOT = Path(__file__).resolve().parents[2]


def test_the_root_readme():
    (example,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.S)
    names = {}
    exec(example, names)
    assert names["pairs"].shape[1] == 2 and len(names["pairs"]) > 0
    assert names["near"].distances.shape == (10, 3) and (names["near"].distances[:, 0] == 0).all()
    assert names["hits"].triangle.tolist() == [3] and abs(names["hits"].t[0] - 4.4) < 1e-6
    assert names["inside"].tolist() == [True, False]


def test_the_readme_of_the_module():
    (example,) = re.findall(r"```python\n(.*?)```", (ROOT / "python" / "README.md").read_text(), re.S)
    example = "\n".join(line for line in example.splitlines() if "results" not in line)
    boxes = np.random.default_rng(1).random((50, 3))
    boxes = np.hstack([boxes, boxes + 0.2])
    cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
             [1, 5, 7], [1, 7, 3]]
    given = {"boxes": boxes, "regions": boxes, "points": boxes[:, :3], "moved_boxes": boxes + 1, "vertices": cube, "faces": faces,
             "pose": np.eye(4), "cup_pose": np.eye(4), "origins": cube - 5, "directions": np.ones((8, 3)), "a": np.zeros((2, 3, 3)), "b": np.ones((2, 3, 3))}
    exec(example, given)
    assert isinstance(given["mesh"], bw.MeshBvh)
