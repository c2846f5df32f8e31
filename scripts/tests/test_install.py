"""What is installed is enough for programs elsewhere: trees/examples/ is built against it, and README.md quotes it."""

import fcntl
import json
import os
import re
import subprocess

import pytest
from test_boxwood import PROGRAM, ROOT

BUILD = PROGRAM.parent
EXAMPLES = ROOT / "trees/examples"


def run(*command, **options):
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, timeout=500, **options)
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


@pytest.fixture(scope="session")
def installed(tmp_path_factory):
    """Where Boxwood is installed."""
    cache = BUILD / "CMakeCache.txt"
    if not cache.exists() or not (BUILD / "install/cmake_install.cmake").exists():
        pytest.skip(f"{BUILD} is not built")
    if not re.search(r"^BOXWOOD_SANITIZE:STRING=$", cache.read_text(), re.M):
        pytest.skip(f"{BUILD} is built with sanitizers, which nobody installs: another build is tested")
    prefix = tmp_path_factory.mktemp("installed")
    with open(BUILD / "install/one_at_a_time", "w") as lock:  # of the workers of pytest-xdist
        fcntl.flock(lock, fcntl.LOCK_EX)
        run("cmake", "--install", BUILD, "--prefix", prefix.name, cwd=prefix.parent)  # as README names it: by a relative path
    return prefix


def test_examples_run(installed, tmp_path):
    run("cmake", "-S", EXAMPLES, "-B", tmp_path, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={installed}",
        "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wold-style-cast -Werror")  # fmt: skip
    run("cmake", "--build", tmp_path)
    tested = run("ctest", "--test-dir", tmp_path, "--output-on-failure")
    has_fcl = not re.search(r"^fcl_DIR:PATH=.*NOTFOUND$", (tmp_path / "CMakeCache.txt").read_text(), re.M)
    built = [example for example in EXAMPLES.glob("*.cpp") if has_fcl or not example.name.startswith("fcl_")]
    assert f"100% tests passed, 0 tests failed out of {2 * len(built)}" in tested


def test_pkg_config_finds_it(installed, tmp_path):
    (folder,) = installed.glob("lib*/**/pkgconfig")
    environment = {**os.environ, "PKG_CONFIG_PATH": str(folder)}
    flags = run("pkg-config", "--cflags", "--libs", "boxwood", env=environment).split()
    program = tmp_path / "pairs"
    run("g++", "-std=c++20", EXAMPLES / "pairs.cpp", "-o", program, *flags)
    assert run(program) == "0,1\n"


def test_every_header_that_is_included_is_installed(installed):
    headers = installed / "include/boxwood"
    files = list(headers.rglob("*.h"))
    assert len(files) > 100
    missing = {
        f"{file.relative_to(headers)} includes {name}"
        for file in files
        for name in re.findall(r'^#include "([^"]+)"', file.read_text(), re.M)
        if not (headers / name).exists()
    }
    assert not missing
    assert not [file for file in files if {"testing", "oracle", "cuda"} & set(file.parts)]


BY_FETCH_CONTENT = f"""include(FetchContent)
FetchContent_Declare(boxwood SOURCE_DIR {ROOT})
FetchContent_MakeAvailable(boxwood)
"""


@pytest.mark.parametrize("inclusion", [f"add_subdirectory({ROOT} boxwood)\n", BY_FETCH_CONTENT],
                         ids=["add_subdirectory", "FetchContent"])  # fmt: skip
def test_as_a_part_of_another_project(tmp_path, inclusion):
    """No bench, no tests, no device code, optimised whatever the project says, and nobody gets our flags."""
    (tmp_path / "main.cpp").write_text(
        "#include <boxwood/trees/bvh.h>\n#include <boxwood/boxwood.h>\nint main() { return boxwood::Bvh().empty() ? 0 : 1; }\n"
    )
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(other LANGUAGES CXX)\nset(CMAKE_EXPORT_COMPILE_COMMANDS ON)\n"
        f"{inclusion}add_executable(other main.cpp)\n"
        "target_link_libraries(other PRIVATE boxwood::boxwood boxwood::trees boxwood::kernels)\n"
    )
    run("cmake", "-S", tmp_path, "-B", tmp_path / "build", "-G", "Ninja")
    cache = (tmp_path / "build/CMakeCache.txt").read_text()
    for part in ("BENCH", "TESTS"):
        assert re.search(rf"^BOXWOOD_BUILD_{part}:BOOL=OFF$", cache, re.M)
    commands = {entry["file"]: entry["command"] for entry in json.loads((tmp_path / "build/compile_commands.json").read_text())}
    own = commands[str(tmp_path / "main.cpp")]
    assert "-std=" in own and not re.search(r"-W\w|-f(?!PI)", own)
    assert "-ffp-contract=off" in commands[str(ROOT / "trees/bvh.cpp")] and " -O2 " in commands[str(ROOT / "trees/bvh.cpp")]
    assert not [file for file in commands if file.endswith((".cu", ".c"))]
    run("ninja", "-C", tmp_path / "build", "CMakeFiles/other.dir/main.cpp.o")  # the same paths as once installed


def test_examples_are_quoted_from_their_files():
    page = (EXAMPLES / "README.md").read_text()
    examples = sorted(EXAMPLES.glob("*.cpp"))
    assert len(examples) > 6 and not [path.name for path in examples if f"```cpp\n{path.read_text()}```" not in page]
    assert f"```cpp\n{(EXAMPLES / 'pairs.cpp').read_text()}```" in (ROOT / "README.md").read_text()
