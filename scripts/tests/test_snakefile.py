"""The Snakefile: rounds as jobs give the cells and answers of the sweep that is run in one go."""

import shutil
import subprocess

import h5py
import pytest
from synthetic import SCRIPTS
from synthetic import PROGRAM

SNAKEMAKE = shutil.which("snakemake")
pytestmark = [pytest.mark.skipif(not SNAKEMAKE, reason="snakemake is not installed (apt-get install snakemake)"),
              pytest.mark.skipif(not PROGRAM.exists(), reason=f"{PROGRAM} is not built")]
SWEEP = """
rounds = 2
min_time_ms = 0.2
seed = 1
[[cells]]
scene = "uniform"
n = 200
task = "pairs"
builders = ["median", "hilbert"]
peers = "all"
"""


def snakemake(folder, *settings):
    return subprocess.run(
        [SNAKEMAKE, "-s", SCRIPTS / "Snakefile", "--cores", "2", "--directory", folder, "--config", f"program={PROGRAM}", *settings],
        capture_output=True, text=True, timeout=120)


def answers(path):
    """{cell: (class, status, hash of the answer, number of answers)} and the rounds of each cell."""
    with h5py.File(path) as file:
        cells = {row["cell_id"]: row for row in file["cells"][:]}
        checks = {row["cell_id"]: row for row in file["checks"][:]}
        rounds = {}
        for row in file["samples"][:]:
            rounds.setdefault(cells[row["cell_id"]]["name"], set()).add(int(row["round"]))
        return {cell["name"]: (cell["class"], cell["status"], checks[key]["result_hash"], checks[key]["n_got"])
                for key, cell in cells.items()}, rounds


def test_two_jobs_give_the_cells_and_answers_of_one_sweep(tmp_path):
    sweep = tmp_path / "tiny.toml"
    sweep.write_text(SWEEP)
    whole = subprocess.run([PROGRAM, "sweep", "--config", sweep, "--out", tmp_path / "whole.h5"], capture_output=True, timeout=60)
    assert whole.returncode == 0
    done = snakemake(tmp_path, f"sweep={sweep}", "shards=2", f"out={tmp_path / 'out'}", "together=true")
    assert done.returncode == 0, done.stderr[-3000:]
    assert answers(tmp_path / "out" / "tiny.h5") == answers(tmp_path / "whole.h5")
    known, rounds = answers(tmp_path / "whole.h5")
    assert len(known) > 2 and all(found == {0, 1} for found in rounds.values())
    (report,) = (tmp_path / "out" / "reports").glob("tiny-*.html")
    assert "Main findings" in report.read_text()


def test_bad_input_is_said(tmp_path):
    done = snakemake(tmp_path, "sweep=nowhere.toml")
    assert done.returncode != 0 and "no sweep file" in done.stderr and "nowhere.toml" in done.stderr
