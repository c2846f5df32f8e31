"""setup, test and sweep: help and bad usage. Nothing is installed, built or measured here."""

import os
import re
import shutil
import subprocess

import pytest
from synthetic import SCRIPTS


@pytest.mark.parametrize("command", ["setup", "test", "sweep", "fuzz", "format"])
def test_help_has_an_example(script, command):
    done = script(command, "--help")
    assert done.returncode == 0 and f"Example: scripts/{command} " in done.stdout and "Exit codes" in done.stdout


@pytest.fixture
def mesh(tmp_path):
    file = tmp_path / "a.obj"
    file.write_text("v 0 0 0\n")
    return file


@pytest.mark.parametrize(
    "arguments, said",
    [
        (("setup", "--nix"), "unknown argument '--nix'"),
        (("setup", "--preset"), "--preset needs a name"),
        (("setup", "--preset", "nix"), "unknown preset 'nix': one of release, debug, tsan, ci, fuzz"),
        (("fuzz",), "give a name: triangle_triangle"),
        (("fuzz", "nix"), "no fuzzer 'nix': one of triangle_triangle"),
        (("fuzz", "box_csv", "1x"), "'1x' is no number of seconds"),
        (("setup", "--for", "nix"), "unknown purpose 'nix': one of sweep, test, fuzz, style"),
        (("test", "nix"), "unknown argument 'nix'"),
        (("test", "--only", "a|b"), "--only 'a|b': give letters, digits and underscores"),
        (("sweep", "--nix"), "unknown argument '--nix'"),
        (("sweep", "--only"), "--only needs a value"),
        (("sweep", "--preset", "debug"), "--preset 'debug' is not optimised: release or ci"),
        (("sweep", "--config", "nix.toml"), "no readable configuration file 'nix.toml'"),
        (("sweep", "--quick", "--config", "x"), "exclude each other"),
        (("sweep", "--config", "{config}", "--mesh", "nix.obj"), "no readable mesh file 'nix.obj'"),
        (("sweep", "--config", "{config}", "--mesh", "{config}"), "the mesh file '{config}' is empty"),
        (("sweep", "--quick", "--mesh", SCRIPTS / "setup"), "is not a mesh file: its name ends in none of"),
        (("sweep", "--quick", "--mesh", SCRIPTS.parent / "CMakeLists.txt"), "is not a mesh file"),
        (("sweep", "--quick", "--boxes", "nix.csv"), "no readable file 'nix.csv' (--boxes)"),
        (("sweep", "--config", "{config}", "--out", "/proc/nix/a.h5"), "the folder '/proc/nix' cannot be made"),
        (("sweep", "--config", "{config}", "--out", "/proc/a.h5"), "the folder '/proc' cannot be written to"),
        (("sweep", "--config={config}", "--out={config}/a.h5"), "cannot be made"),
        (("sweep", "--config", "{config}", "--out", "a.hdf"), "ends in .h5"),
    ],
)
def test_bad_usage_is_reported_before_any_work(script, tmp_path, arguments, said):
    config = tmp_path / "a.toml"
    config.write_text("")
    done = script(*(str(a).format(config=config) for a in arguments), cwd=tmp_path)
    assert done.returncode == 2 and said.format(config=config) in done.stderr, done.stderr
    assert "setup:" not in done.stderr or arguments[0] == "setup"
    assert [p.name for p in tmp_path.iterdir()] == ["a.toml"]


def test_packages_are_listed_once_and_well_formed():
    lines = (SCRIPTS / "packages.txt").read_text().splitlines()
    words = [line.split("#")[0].split() for line in lines]
    packages = [w[0] for w in words if w]
    assert len(packages) == len(set(packages)) > 20
    assert all(re.fullmatch(r"[a-z0-9+.-]+", name) for name in packages)
    assert all(w[1:] in ([], ["peer"], ["figures"], ["test"], ["fuzz"], ["style"]) for w in words if w)


def test_without_apt_the_list_is_said_and_nothing_installed(script, tmp_path):
    """A PATH with no apt-get: setup says what the build needs, and goes on."""
    for tool in ("bash", "dirname", "sed", "awk", "grep", "cat", "env", "mkdir", "mktemp", "rm"):
        os.symlink(f"/usr/bin/{tool}", tmp_path / tool)
    done = script("setup", "--no-build", env={"PATH": str(tmp_path)})
    assert done.returncode == 0 and "not a Debian system" in done.stderr and "libhdf5-dev" in done.stderr


def fake(folder, name, body):
    file = folder / name
    file.write_text(f"#!/bin/bash\n{body}\n")
    file.chmod(0o755)


def tools(folder, dpkg, apt):
    """A PATH whose dpkg-query and apt-get are fakes that log what they are asked."""
    fake(folder, "dpkg-query", dpkg)
    fake(folder, "apt-get", f'echo "apt-get $*" >> {folder}/log\n{apt}')
    fake(folder, "sudo", "exit 1")
    return {"PATH": f"{folder}:/usr/bin:/bin"}


ALL_BUT_HDF5 = 'for p in "${@:4}"; do [[ $p == libhdf5-dev ]] || echo "$p installed"; done'
ALL_BUT_FCL = 'for p in "${@:4}"; do [[ $p == libfcl-dev ]] || echo "$p installed"; done'
root_alone = pytest.mark.skipif(os.geteuid() != 0, reason="as another user setup would call sudo")


def test_nothing_missing_means_no_apt(script, tmp_path):
    env = tools(tmp_path, 'for p in "${@:4}"; do echo "$p installed"; done', "exit 1")
    assert script("setup", "--no-build", env=env).returncode == 0
    assert not (tmp_path / "log").exists()


@root_alone
def test_only_what_is_missing_is_installed(script, tmp_path):
    env = tools(tmp_path, ALL_BUT_HDF5, "exit 0")
    done = script("setup", "--no-build", env=env)
    assert done.returncode == 0 and "installing libhdf5-dev\n" in done.stderr and "packages: done in" in done.stderr
    log = (tmp_path / "log").read_text()
    assert re.search(r" install -y --no-install-recommends libhdf5-dev$", log, re.M)


@root_alone
def test_each_purpose_installs_what_it_needs(script, tmp_path):
    """Nothing is there: what would be installed, in how many calls of apt-get?"""
    env = tools(tmp_path, "true", "exit 0")
    installed = {}
    for purpose in ("sweep", "test", "style"):
        done = script("setup", "--no-build", "--for", purpose, env=env)
        assert done.returncode == 0, done.stderr
        calls = re.findall(r" install -y --no-install-recommends (.*)$", (tmp_path / "log").read_text(), re.M)
        assert len(calls) <= 2, "one call for the build, one for what draws"
        installed[purpose] = set(" ".join(calls).split())
        (tmp_path / "log").unlink()
    tests = {"libgtest-dev", "libgmock-dev", "librapidcheck-dev", "python3-pytest", "python3-pandas", "hdf5-tools"}
    assert tests <= installed["test"] and not tests & installed["sweep"]
    assert {"g++", "libfcl-dev", "python3-matplotlib"} <= installed["sweep"] < installed["test"]
    assert installed["style"] == {"clang-format-14"}


@root_alone
def test_without_a_network_the_command_is_printed(script, tmp_path):
    done = script("setup", "--no-build", env=tools(tmp_path, ALL_BUT_HDF5, "exit 100"))
    assert done.returncode == 2
    assert "apt-get update && apt-get install -y --no-install-recommends libhdf5-dev" in done.stderr


@root_alone
def test_a_peer_that_cannot_be_had_is_no_error(script, tmp_path):
    done = script("setup", "--no-build", env=tools(tmp_path, ALL_BUT_FCL, "exit 100"))
    assert done.returncode == 0 and "going on without the peer package libfcl-dev" in done.stderr


PRESETS = """{"version": 6, "configurePresets": [{"name": "release", "generator": "Ninja",
 "binaryDir": "${sourceDir}/build/${presetName}"}],
 "buildPresets": [{"name": "release", "configurePreset": "release"}],
 "testPresets": [{"name": "release", "configurePreset": "release", "output": {"outputOnFailure": true}}]}"""


@pytest.fixture
def toy(tmp_path):
    """toy(c_test, py_test, build): a checkout with one test of each kind, and scripts/test run in it."""

    def make(*arguments, c_test="true", py_test="pass", build="true"):
        for folder in ("scripts", "python"):
            (tmp_path / folder).mkdir()
        for name in ("setup", "test", "packages.txt", "pytest.ini"):
            shutil.copy2(SCRIPTS / name, tmp_path / "scripts" / name)
        (tmp_path / "CMakePresets.json").write_text(PRESETS)
        (tmp_path / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(toy NONE)\nenable_testing()\n"
            f"add_custom_target(made ALL COMMAND {build})\nadd_test(NAME c_test COMMAND {c_test})\n"
        )
        (tmp_path / "scripts" / "test_toy.py").write_text(f"def test_toy():\n    {py_test}\n")
        fakes = tmp_path / "fakes"
        fakes.mkdir()
        env = tools(fakes, 'for p in "${@:4}"; do echo "$p installed"; done', "exit 1")
        done = subprocess.run(
            [tmp_path / "scripts" / "test", *arguments], env=env, capture_output=True, text=True, timeout=120
        )
        return done.returncode, done.stdout + done.stderr

    return make


def test_test_runs_both_kinds_and_keeps_their_closing_lines(toy):
    code, said = toy()
    assert code == 0, said
    assert "100% tests passed, 0 tests failed out of 1" in said and "1 passed" in said
    assert said.count("test: all C++ and Python tests passed (preset release)") == 1


@pytest.mark.parametrize(
    "nvcc, devices, said_of_it",
    [
        ("", "none: no nvcc", "CUDA: kernels tested on the host model; no nvcc here"),
        ("13.0.88", "none: no driver", "compiled by nvcc 13.0.88 and its PTX checked; no device here"),
        ("13.0.88", "cuda:0  NVIDIA H100", "compiled by nvcc 13.0.88 and its PTX checked; run on NVIDIA H100"),
    ],
)
def test_one_line_says_what_the_device_code_went_through(toy, tmp_path, nvcc, devices, said_of_it):
    build = tmp_path / "build" / "release"
    build.mkdir(parents=True)
    (build / "nvcc_version.txt").write_text(nvcc)
    fake(build, "boxwood", f"echo '{devices}'")
    code, said = toy()
    assert code == 0 and said.count("CUDA:") == 1 and said_of_it in said, said


@pytest.mark.parametrize(
    "failing, said_of_it",
    [({"c_test": "false"}, "FAILED: C++ (CTest)"), ({"py_test": "assert False"}, "FAILED: Python (pytest)")],
)
def test_a_failing_test_of_either_kind_fails(toy, failing, said_of_it):
    code, said = toy(**failing)
    assert code == 1 and said_of_it in said
    assert "tests failed out of 1" in said and ("1 passed" in said or "1 failed" in said)


def test_a_broken_build_fails(toy):
    code, said = toy(build="false")
    assert code == 1 and "the build failed" in said and "all C++ and Python" not in said


def test_a_broken_build_shows_its_last_lines_and_no_others(toy):
    code, said = toy(build="ls the-cause")
    assert code == 1 and "cannot access 'the-cause'" in said and "FAILED: " in said
    assert "Configuring done" not in said and "build/setup.log" in said


def test_the_steps_are_counted(toy):
    code, said = toy()
    assert code == 0, said
    steps = re.findall(r"^\[(\d)/4\] (\w+)", said, re.M)
    assert [step for step, _ in steps] == ["1", "2", "3", "4"], said


@pytest.mark.parametrize("name, ran", [("CTest", "C++"), ("test_TOY", "Python")])
def test_only_runs_the_tests_of_that_name(toy, name, ran):
    code, said = toy("--only", name)
    assert code == 0 and f"test: all tests named '{name}' passed" in said, said
    assert ("out of 1" in said) == (ran == "C++") and ("1 passed" in said) == (ran == "Python")


def test_only_of_no_test_is_bad_usage(toy):
    code, said = toy("--only", "nix")
    assert code == 2 and "no test has such a name" in said


def test_fast_leaves_out_what_was_slow(toy, tmp_path):
    costs = tmp_path / "build" / "release" / "Testing" / "Temporary"
    costs.mkdir(parents=True)
    (costs / "CTestCostData.txt").write_text("a_test 1 0.1\nc_test 3 1.5\n---\n")
    code, said = toy("--fast")
    assert code == 1 and "No tests were found" in said  # c_test was the only one
    assert "1 passed" not in said
