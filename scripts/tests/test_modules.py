"""The rules for modules hold here, and the check sees each kind of breach."""

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def check(root):
    done = subprocess.run(
        [ROOT / "scripts" / "check_modules", root], capture_output=True, text=True, timeout=60
    )
    return done.returncode, done.stdout


def test_this_checkout_is_in_order():
    code, said = check(ROOT)
    assert code == 0, said


def plant(root, name, text):
    file = root / name
    file.parent.mkdir(parents=True, exist_ok=True)
    (file.parent / "README.md").write_text("# A module\n")
    file.write_text(text)


@pytest.mark.parametrize(
    "name, text, expected",
    [
        ("trees/a.h", '#pragma once\n#include "scenes/scene.h"\n', "trees/a.h:2: trees/ must not"),
        ("scenes/a.cpp", '#include "trees/tree.h"\n', "scenes/a.cpp:1: scenes/ must not"),
        ("kernels/a.h", "#  include <trees/tree.h>\n", "kernels/a.h:1: kernels/ must not"),
        ("results/a.h", '#include "bench/tasks/contender.h"\n', "results/a.h:1: results/ must not"),
        ("bench/a.cpp", "#include <hdf5.h>\n", "only results/ includes HDF5"),
        ("kernels/a.h", '#include "kernels/oracle/oracle.h"\n', "a.h:1: only tests and bench/ include the oracle"),
        ("trees/a.h", '#include "kernels/oracle/nearest.h"\n', "a.h:1: only tests and bench/ include the oracle"),
        ("bench/a.cpp", '#include "trees/layouts/detail/wide.h"\n', "bench/a.cpp:1: detail/ is for trees/ alone"),
        ("trees/a.h", "#include <cuda_runtime.h>\n", "a.h:1: only .cu files include CUDA's headers"),
        ("trees/a.cuh", "#include <cub/cub.cuh>\n", "a.cuh:1: only .cu files include CUDA's headers"),
        ("trees/a.cpp", '#include "trees/cuda/launch.h"\n', "a.cpp:1: only device code includes trees/cuda/"),
        ("kernels/a.cu", '#include "trees/tree.h"\n', "kernels/a.cu:1: kernels/ must not"),
        ("bench/a.h", "#include <CLI/CLI.hpp>\n", "a.h:1: only bench/commands/ includes CLI11"),
        ("trees/a.h", '#include "kernels/testing/thinned.h"\n', "a.h:1: only tests include what is in"),
        ("trees/mesh_utils.h", "", "'mesh_utils' says nothing"),
        ("scripts/pyflakes-4.1.0-py2.py3-none-any.whl", "PK", "any.whl: no kind of file that a module holds"),
        ("bench/boxwood", "ELF", "bench/boxwood: no kind of file that a module holds"),
        ("trees/a.h", "\nvoid walk_tree();\n", "a.h:2: 'walk' has a name of its own here: traversal"),
        ("bench/a.cpp", "// NaN is passed over.\n", "a.cpp:1: 'passed over' has a name of its own here: skipped"),
        ("bench/a.h", "enum class Told {};\n", "a.h:1: 'Told' has a name of its own here: reported"),
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
    plant(tmp_path, "trees/c.cpp", '#include "trees/layouts/detail/wide.h"\n')
    plant(tmp_path, "trees/testing/d.h", '#include "kernels/testing/thinned.h"\n')
    plant(tmp_path, "bench/commands/e.cpp", "#include <CLI/CLI.hpp>\n")
    needs_oracle = '#include "kernels/oracle/oracle.h"\n'
    for file in ("kernels/oracle/a.cpp", "kernels/b_test.cpp", "kernels/testing/pairs.h",
                 "bench/b.cpp", "trees/b_test.cpp"):
        plant(tmp_path, file, needs_oracle)
    plant(tmp_path, "bench/fuzz/corpus/urdf/one.link", "")
    plant(tmp_path, "scripts/Snakefile", "")
    plant(tmp_path, "trees/f.cpp", "// sidewalks are not told apart at a boardwalk\n")
    plant(tmp_path, "scripts/run", "#!/bin/sh\n")
    plant(tmp_path, "build/utils.h", '#include "scenes/scene.h"\n')
    assert check(tmp_path)[0] == 0


def test_a_crowded_folder_is_found(tmp_path):
    for number in range(41):
        plant(tmp_path, f"trees/layouts/layout{number}.h", "")
    plant(tmp_path, "trees/a.h", "")
    (tmp_path / "trees" / "layouts" / "README.md").unlink()
    code, said = check(tmp_path)
    assert code == 1 and "trees/layouts: 41 files; at most 40" in said
    assert said.count("\n") == 2, said


def test_a_missing_readme_is_found(tmp_path):
    (tmp_path / "trees").mkdir()
    code, said = check(tmp_path)
    assert code == 1 and "trees/README.md: missing" in said
