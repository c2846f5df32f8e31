"""The short forms of scripts/endure; that of its frames is bench/stages/endurance_test.cpp."""

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("BOXWOOD_BUILD", ROOT / "build" / "release"))
built = pytest.mark.skipif(not (BUILD / "boxwood").exists(), reason=f"{BUILD / 'boxwood'} is not built")


def test_help_says_what_there_is(script):
    done = script("endure", "--help")
    assert done.returncode == 0 and "Example: scripts/endure kill" in done.stdout
    assert all(name in done.stdout for name in ("kill", "two", "frames", "tsan"))
    assert script("endure", "nix").returncode == 2


@built
@pytest.mark.parametrize("name, times, said", [("kill", 4, "4 kills -9"), ("two", 1, "1 times two sweeps")])
def test_a_short_form(script, name, times, said):
    done = script("endure", name, "--times", times)
    assert done.returncode == 0 and said in done.stdout, done.stdout + done.stderr


@pytest.mark.parametrize("said, code", [("[  PASSED  ] 0 tests.", 1), ("[  PASSED  ] 1 test.", 0),
                                        ("[  SKIPPED ] Endurance.X\n[  PASSED  ] 0 tests.", 1)])
def test_frames_fail_where_no_test_ran(script, tmp_path, monkeypatch, said, code):
    test = tmp_path / "bench" / "boxwood_bench_test"
    test.parent.mkdir()
    test.write_text(f"#!/bin/sh\necho '{said}'\n")
    test.chmod(0o755)
    monkeypatch.setenv("BOXWOOD_BUILD", str(tmp_path))
    done = script("endure", "frames")
    assert done.returncode == code, done.stdout + done.stderr
