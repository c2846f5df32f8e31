"""Real sweeps, where the program is built: others can read their files, and no kill loses them."""

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import h5py
import numpy as np
import pytest

from boxwood_results import findings, run

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("BOXWOOD_BUILD", ROOT / "build" / "release")) / "boxwood"
pytestmark = pytest.mark.skipif(not PROGRAM.exists(), reason=f"{PROGRAM} is not built")
SWEEP = """
rounds = 2
min_time_ms = 0.2
seed = 1

[[cells]]
scene = "uniform"
n = 200
task = "pairs"
builders = ["median", "binned_sah"]
peers = "all"
"""


def sweep(*arguments):
    command = [PROGRAM, "sweep", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120)


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    file = tmp_path_factory.mktemp("sweep") / "tiny.toml"
    file.write_text(SWEEP)
    return file


@pytest.fixture(scope="module")
def swept(config):
    out = config.with_name("tiny.h5")
    done = sweep("--config", config, "--out", out)
    assert done.returncode == 0, done.stderr
    return out


def test_a_result_file_opens_with_h5py(swept):
    with h5py.File(swept, "r") as file:
        assert file.attrs["format"] == "boxwood-results" and file.attrs["complete"] == 1
        samples = file["samples"][:]
        assert set(samples["round"]) == {0, 1} and set(samples["phase"]) == {b"build", b"query"}
        assert np.isfinite(samples["wall_ns"]).all() and (samples["wall_ns"] > 0).all()
        assert b"wrong" not in set(file["checks"]["status"])
        assert file["samples"].fletcher32 and file["samples"].shuffle
        assert json.loads(file["samples"].attrs["units"])["wall_ns"] == "ns"


def test_a_result_file_opens_with_pandas(swept):
    pandas = pytest.importorskip("pandas", reason="python3-pandas is not installed: scripts/setup does that")
    pytest.importorskip("tables", reason="python3-tables is not installed: scripts/setup does that")
    frame = pandas.read_hdf(swept, "samples")
    with h5py.File(swept, "r") as file:
        assert len(frame) == len(file["samples"])
        assert (frame["wall_ns"].to_numpy() == file["samples"]["wall_ns"]).all()


def test_a_result_file_opens_with_h5dump(swept):
    command = ["h5dump", "-d", "/samples", swept]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and '"wall_ns"' in done.stdout


def test_these_scripts_read_it(swept, script, tmp_path):
    results = run.read(swept)
    assert results.rounds == 2 and results.noise_floor != results.noise_floor
    assert [f.topic for f in results.findings] == [findings.RACE] and results.findings[0].ours.status == "exact"
    assert results.findings[0].certainty == "too few rounds"
    assert script("report", swept, "--out", tmp_path / "r.html").returncode == 0


def rounds_there(out):
    return len(list(out.parent.glob(f"{out.name}.shards/*/round-*.h5")))


def stopped_sweep(config, out, signal_number, rounds):
    """Starts a long sweep, sends it and its children the signal in the middle of a round after
    `rounds` of them, and gives its exit code and what it said."""
    command = [PROGRAM, "sweep", "--config", config, "--out", out, "--rounds", "1000", "--wait", "0s"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True) as process:
        deadline = time.monotonic() + 60
        while rounds_there(out) < rounds and time.monotonic() < deadline:
            time.sleep(0.005)
        os.killpg(process.pid, signal_number)
        said = process.communicate(timeout=60)[1]
    return process.returncode, said


def test_a_killed_sweep_goes_on_from_its_finished_rounds(config, tmp_path):
    out = tmp_path / "killed.h5"
    code, _ = stopped_sweep(config, out, signal.SIGKILL, rounds=3)
    there = rounds_there(out)
    assert code == -signal.SIGKILL and 3 <= there < 1000 and not out.exists()

    done = sweep("--config", config, "--out", out, "--rounds", there + 2, "--wait", "0s")
    assert done.returncode == 0, done.stderr
    assert f"{there} rounds are there from an earlier start; 2 to go" in done.stderr
    assert run.read(out).rounds == there + 2
    assert rounds_there(out) == 0


def test_an_interrupted_sweep_keeps_its_rounds(config, tmp_path):
    out = tmp_path / "interrupted.h5"
    code, said = stopped_sweep(config, out, signal.SIGINT, rounds=2)
    assert code == 130 and "interrupted" in said
    assert 2 <= run.read(out).rounds < 1000
