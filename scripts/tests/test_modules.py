"""The house rules hold here, and the check sees each kind of breach."""

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def check(root):
    done = subprocess.run(
        [ROOT / "scripts" / "check_rooms", root], capture_output=True, text=True, timeout=60
    )
    return done.returncode, done.stdout


def test_this_house_is_in_order():
    code, said = check(ROOT)
    assert code == 0, said


def plant(root, name, text):
    file = root / name
    file.parent.mkdir(parents=True, exist_ok=True)
    (file.parent / "README.md").write_text("# A room\n")
    file.write_text(text)


@pytest.mark.parametrize(
    "name, text, expected",
    [
        ("trees/a.h", '#pragma once\n#include "scenes/scene.h"\n', "trees/a.h:2: trees/ must not"),
        ("scenes/a.cpp", '#include "trees/tree.h"\n', "scenes/a.cpp:1: scenes/ must not"),
        ("kernels/a.h", "#  include <trees/tree.h>\n", "kernels/a.h:1: kernels/ must not"),
        ("results/a.h", '#include "bench/tasks/contender.h"\n', "results/a.h:1: results/ must not"),
        ("bench/a.cpp", "#include <hdf5.h>\n", "only results/ includes HDF5"),
        ("kernels/a.h", '#include "kernels/oracle/oracle.h"\n', "a.h:1: only tests and bench/ task"),
        ("trees/a.h", '#include "kernels/oracle/nearest.h"\n', "a.h:1: only tests and bench/ task"),
        ("trees/mesh_utils.h", "", "'mesh_utils' says nothing"),
        ("trees/a.cpp", "//\n" * 451, "451 lines; at most 450"),
        ("trees/README.md", "line\n" * 41, "41 lines; at most 40"),
    ],
)
def test_a_planted_breach_is_found(tmp_path, name, text, expected):
    plant(tmp_path, name, text)
    code, said = check(tmp_path)
    assert code == 1
    assert expected in said
    assert said.count("\n") == 2, said  # the breach and the closing line, nothing else


def test_what_is_allowed_passes(tmp_path):
    plant(tmp_path, "bench/a.cpp", '#include "trees/tree.h"\n#include "results/results.h"\n')
    plant(tmp_path, "results/a.cpp", "#include <hdf5.h>\n")
    plant(tmp_path, "trees/a.h", '#include "kernels/primitives/aabb.h"\n#include <vector>\n')
    asks_oracle = '#include "kernels/oracle/oracle.h"\n'
    for file in ("kernels/oracle/a.cpp", "kernels/b_test.cpp", "kernels/pairs_for_test.h",
                 "bench/b.cpp", "trees/b_test.cpp"):
        plant(tmp_path, file, asks_oracle)
    plant(tmp_path, "build/utils.h", '#include "scenes/scene.h"\n')
    assert check(tmp_path)[0] == 0


def test_a_missing_readme_is_found(tmp_path):
    (tmp_path / "trees").mkdir()
    code, said = check(tmp_path)
    assert code == 1 and "trees/README.md: missing" in said
