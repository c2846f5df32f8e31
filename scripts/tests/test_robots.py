"""The track of robots is measured again with those that are there."""

import shutil
import subprocess

import synthetic
from synthetic import SCRIPTS

from boxwood_results import robots

ROOT = SCRIPTS.parent


def test_robots_that_are_not_there_are_said_to_be_left_out(tmp_path):
    reproduce = [SCRIPTS / "reproduce", "robots", "--robots", tmp_path, "--out", tmp_path / "out"]
    none = subprocess.run([*reproduce, "--publish"], capture_output=True, text=True, timeout=60)
    assert none.returncode == 1 and "with all of its robots or not at all" in none.stderr
    z1 = tmp_path / robots.OTHERS[1]
    z1.parent.mkdir()
    shutil.copy(ROOT / robots.OWN, z1)
    options, missing = robots.options(ROOT, tmp_path)
    assert options == ["--robot", str(ROOT / robots.OWN), "--robot", str(z1)] and missing == [tmp_path / robots.OTHERS[0]]
    said = subprocess.run([*reproduce, "--", "--preset", "debug"], capture_output=True, text=True, timeout=60)  # refused before it sets up
    assert said.returncode == 2 and "debug' is not optimised" in said.stderr
    assert f"{missing[0]} is not there, and is left out; --robots DIR" in said.stderr and "z1.urdf is not" not in said.stderr
    cells = synthetic.answer("sweep", "--config", ROOT / "bench" / "configs" / "robots.toml", "--out", tmp_path / "x.h5", "--dry-run", *options)
    assert "robot_arm/" in cells.stdout and "robot_z1_along/" in cells.stdout and "robot_panda" not in cells.stdout
