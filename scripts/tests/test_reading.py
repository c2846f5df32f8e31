"""What cannot be read is refused with a message that says what to do; what is missing is left out."""

import math

import h5py
import numpy as np
import pytest
import synthetic

from boxwood_results import findings, reader, run, stats


def test_reads_what_was_written(full):
    results = run.read(full)
    assert results.rounds == 15 and len(results.jobs) == 19
    cell = next(c for c in results.cells if c.name == "uniform/n1000-s1/pairs/binned_sah.wide8.self_pairs/f32/tbb-2")
    assert (cell.label, cell.family, cell.ours, cell.job.threads) == ("binned_sah.wide8 tbb", "binned_sah", True, 2)
    assert cell.status == "exact" and cell.counters["box_tests"] == 41000
    one = cell.rounds("build")[3] + cell.rounds("query")[3]
    assert cell.rounds(run.TOTAL)[3] == one
    assert 0 < results.noise_floor < 0.05


def test_the_twin_is_no_sample_of_its_cell(full):
    twin = [c for c in run.read(full).cells if c.twin]
    assert len(twin) == 1 and len(twin[0].rounds("query")) == 15 and len(twin[0].twin["query"]) == 15
    assert twin[0].rounds("query") != twin[0].twin["query"]


def test_findings_know_what_was_put_in(full):
    found = {str(f.job): f for f in findings.findings(run.read(full))}
    uniform = found["uniform 100,000 · pairs · 1 thread"]
    assert uniform.ours.label == "median.wide8"  # 62 + 128 ns per item, against 130 + 95
    peer = next(p for p in uniform.peers if p.label == "fcl.dynamic_aabb_tree")
    assert uniform.quickest.label == "binned_sah.wide8"
    comparison = uniform.against(peer, "query")
    assert comparison.ratio.lo < 1500 / 95 * 1.02 and comparison.ratio.hi > 1500 / 95 * 0.98
    assert comparison.verdict == stats.FASTER
    cgal = next(p for p in uniform.peers if p.library == "cgal")
    assert uniform.against(cgal, "query") is None and uniform.against(cgal, run.TOTAL) is not None
    rays = found["mesh_stanford_bunny_primary 69,451 · rays_closest · 1 thread"]
    assert {c.verdict for c in rays.comparisons} == {stats.SLOWER}


def test_builders_alone_have_no_query(full):
    tree = next(f for f in findings.findings(run.read(full)) if f.job.task == "tree")
    assert tree.ours.label == "lbvh" and tree.quickest is None
    assert [c.phase for c in tree.comparisons] == [run.TOTAL]
    assert abs(tree.comparisons[0].ratio.mid / (100 / 30) - 1) < 0.05


def test_a_wrong_cell_is_never_ranked(full):
    bars = next(f for f in findings.findings(run.read(full)) if str(f.job) == "bars 100,000 · pairs · 1 thread")
    assert [c.label for c in bars.wrong] == ["bullet.dbvt"]
    assert "bullet" not in {p.library for p in bars.peers}


@pytest.mark.parametrize("status", ["wrong", "a_word_of_the_future"])
def test_our_own_wrong_cell_is_never_ranked(tmp_path, status):
    made = synthetic.Maker(9)
    spec = synthetic.PAIR_CONTENDERS
    made.cell("uniform", 1000, "pairs", "median.wide8", spec["median.wide8"], 1, status=status)
    made.cell("uniform", 1000, "pairs", "fcl.dynamic_aabb_tree", spec["fcl.dynamic_aabb_tree"], 1)
    finding = findings.findings(run.read(made.write(tmp_path / "a.h5")))[0]
    assert finding.ours is None and not finding.comparisons and len(finding.wrong) == 1


def test_an_answer_that_changed_between_rounds_is_wrong(tmp_path):
    made = synthetic.small(rounds=3)
    made.rows["samples"][1]["flags"] = run.WRONG_ANSWER
    cells = run.read(made.write(tmp_path / "a.h5")).cells
    assert [c.status for c in cells].count("wrong") == 1


def test_nan_samples_are_left_out_and_counted(tmp_path):
    made = synthetic.small(rounds=9)
    for row in made.rows["samples"][:4]:
        row["wall_ns"] = math.nan
    results = run.read(made.write(tmp_path / "a.h5"))
    assert results.missing_samples == 4
    assert all(math.isfinite(t) for c in results.cells for phase in c.times.values() for t in phase.values())
    assert min(len(c.rounds("query")) for c in results.cells if c.job.task != "tree") == 5


def test_one_round_claims_nothing(small):
    results = run.read(small)
    assert math.isnan(results.noise_floor)
    verdicts = {c.verdict for f in findings.findings(results) for c in f.comparisons}
    assert verdicts == {stats.CANNOT_TELL}


def test_no_optional_tables(tmp_path):
    results = run.read(synthetic.small().write(tmp_path / "a.h5", drop=("counters", "trees", "frames", "effects")))
    assert results.cells[0].tree is None and results.cells[0].counters == {}


def broken_header(**attrs):
    return lambda path: synthetic.small().write(path, attrs=attrs)


def cut(keep):
    def make(path):
        data = synthetic.small().write(path).read_bytes()
        path.write_bytes(data[: int(len(data) * keep)])

    return make


def flipped(path):
    """Damages the compressed samples; their checksum tells."""
    synthetic.small().write(path)
    with h5py.File(path) as file:
        offset = file["samples"].id.get_chunk_info(0).byte_offset
    data = bytearray(path.read_bytes())
    data[offset + 20] ^= 0xFF
    path.write_bytes(data)


def without_column(path):
    synthetic.small().write(path)
    with h5py.File(path, "a") as file:
        rows = file["samples"][:]
        del file["samples"]
        file["samples"] = rows[[name for name in rows.dtype.names if name != "phase"]]


@pytest.mark.parametrize(
    "make, said",
    [
        (lambda path: None, "no such file"),
        (lambda path: path.write_text("not hdf5"), "cannot be read as HDF5"),
        (lambda path: path.write_bytes(b""), "cannot be read as HDF5"),
        (cut(0.5), "cannot be read as HDF5"),
        (cut(0.98), "cannot be read as HDF5"),
        (flipped, "table 'samples' is damaged"),
        (broken_header(format="else"), "not a Boxwood result file"),
        (broken_header(schema_major=np.uint32(2)), "schema version 2, and these scripts read version 1"),
        (broken_header(complete=np.uint32(0)), "incomplete"),
        (lambda path: synthetic.small().write(path, drop=("samples",)), "table 'samples' is missing"),
        (without_column, "table 'samples' has no column 'phase'"),
    ],
)
def test_bad_files_are_refused(tmp_path, script, make, said):
    path = tmp_path / "bad.h5"
    make(path)
    with pytest.raises(reader.BadFile) as refusal:
        run.read(path)
    assert said in str(refusal.value) and "bad.h5" in str(refusal.value)


@pytest.mark.parametrize("command", ["summary", "plot", "report"])
def test_the_commands_say_so_and_write_nothing(tmp_path, script, command):
    cut(0.5)(tmp_path / "bad.h5")
    done = script(command, tmp_path / "bad.h5")
    assert done.returncode == 2 and done.stderr.startswith(f"{command}: ") and "Traceback" not in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["bad.h5"]
