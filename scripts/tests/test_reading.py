"""What cannot be read is refused with a message that says what to do; what is missing is left out."""

import json
import math

import h5py
import numpy as np
import pytest
import synthetic

from boxwood_results import findings, reader, run


def test_reads_what_was_written(full):
    results = run.read(full)
    assert results.rounds == 15 and len(results.jobs) == 19
    cell = next(c for c in results.cells if c.name == "uniform/n1000-s1/pairs/binned_sah.wide8.self_pairs/f32/tbb-2")
    assert (cell.label, cell.family, cell.ours, cell.job.threads) == ("binned_sah.wide8 tbb", "binned_sah", True, 2)
    assert cell.status == "exact" and cell.counters["box_tests"] == 41000
    assert cell.has("build") and cell.total == "build+query"
    assert cell.median("build") < cell.median(run.TOTAL) < 1.1 * (cell.median("build") + cell.median("query"))
    assert 0 < results.noise_floor < 0.05


def test_the_twin_is_no_sample_of_its_cell(full):
    results = run.read(full)
    twin = {int(row["cell_id"]) for row in results.source["samples"] if row["flags"] & run.AA_TWIN}
    assert len(twin) == 1
    cell = next(c for c in results.cells if c.cell_id in twin)
    assert int(cell.medians["query"]["n"]) == 15


def race(results, task, threads=1, scene="uniform", contender_class=""):
    """The finding about the largest size."""
    found = [f for f in results.findings
             if f.topic == findings.RACE and (f.task, f.contender_class, f.threads) == (task, contender_class, threads)
             and f.ours.job.scene == scene]
    return max(found, key=lambda f: f.ours.job.n)


def test_findings_know_what_was_put_in(full):
    results = run.read(full)
    uniform = race(results, "pairs")
    assert uniform.ours.label == "median.wide8"  # 62 + 128 ns per item, against 130 + 95
    assert uniform.ours_alone.label == "binned_sah.wide8"
    assert uniform.ours.job.n == 100000
    alone = next(c for c in results.family(findings.PEERS, "query")
                 if c.b is uniform.ours_alone and c.a.label == "fcl.dynamic_aabb_tree")
    assert alone.gain.lo < 1500 / 95 * 1.02 and alone.gain.hi > 1500 / 95 * 0.98
    assert alone.verdict == "faster" and alone.reason == ""
    cgal = [c for c in results.family(findings.PEERS) if c.a.library == "cgal" and c.b.job.task == "pairs"]
    assert {c.phase for c in cgal} == {"build+query"}  # it has no build of its own
    rays = race(results, "rays_closest", 1, "mesh_stanford_bunny_primary", "batches")
    assert rays.together.startswith("LOSES") and rays.alone.startswith("LOSES")


def test_losses_come_first(full):
    order = [f.together.startswith("LOSES") or f.alone.startswith("LOSES")
             for f in run.read(full).findings if f.topic == findings.RACE]
    assert order == sorted(order, reverse=True) and any(order) and not all(order)


def test_builders_alone_have_no_query(full):
    tree = race(run.read(full), "build")
    assert tree.ours.label == "lbvh" and tree.ours_alone is None and tree.alone == ""
    assert tree.together.startswith("wins 3.3") and tree.together.endswith("over Embree")


def test_a_wrong_cell_is_never_ranked(full):
    results = run.read(full)
    wrong = next(c for c in results.cells if c.job.scene == "bars" and c.label == "bullet.dbvt")
    assert wrong.status == "wrong" and not wrong.ranked
    assert {c.verdict for c in results.comparisons if wrong in (c.a, c.b)} == {"wrong"}
    assert not any(wrong in (f.rival, f.rival_alone) for f in results.findings)


def one_cell_of_each(status):
    made = synthetic.Maker(9)
    spec = synthetic.PAIR_CONTENDERS
    made.cell("uniform", 1000, "pairs", "median.wide8", spec["median.wide8"], 1, status=status)
    made.cell("uniform", 1000, "pairs", "fcl.dynamic_aabb_tree", spec["fcl.dynamic_aabb_tree"], 1)
    return made


def test_our_own_wrong_cell_is_never_ranked(tmp_path):
    results = run.read(one_cell_of_each("wrong").write(tmp_path / "a.h5"))
    assert results.findings == [] and [c.status for c in results.cells] == ["wrong", "exact"]


def test_units_and_meanings_are_json(full):
    with h5py.File(full) as file:
        for name in set(file) - {"text"}:
            for attribute in ("units", "columns"):
                assert set(json.loads(file[name].attrs[attribute])) <= set(file[name].dtype.names), name


def test_a_status_that_nobody_knows_is_refused_by_name(tmp_path):
    with pytest.raises(AssertionError, match='column status holds the unknown word "a_word_of'):
        one_cell_of_each("a_word_of_the_future").write(tmp_path / "a.h5")


def test_an_answer_that_changed_between_rounds_is_wrong(tmp_path):
    made = synthetic.small(rounds=3)
    made.rows["samples"][1]["flags"] = 8
    cells = run.read(made.write(tmp_path / "a.h5")).cells
    assert [c.status for c in cells].count("wrong") == 1


def test_nan_samples_are_left_out_and_counted(tmp_path):
    made = synthetic.small(rounds=9)
    for row in made.rows["samples"][:4]:
        row["wall_ns"] = math.nan
    results = run.read(made.write(tmp_path / "a.h5"))
    assert results.missing_samples == 4
    assert min(int(c.medians["query"]["n"]) for c in results.cells if not c.task.is_build) == 5


def test_one_round_claims_nothing(small):
    results = run.read(small)
    assert math.isnan(results.noise_floor)
    assert {(c.verdict, c.reason) for c in results.comparisons} == {("cannot_tell", "too_few_rounds")}
    assert {f.certainty for f in results.findings} == {"too few rounds"}


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
        (broken_header(schema_major=np.uint32(1)), "of schema 1, and these scripts read schema 2; measure again"),
        (lambda path: synthetic.small().write(path, drop=("compare",)), "table 'compare' is missing"),
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


@pytest.mark.parametrize("command", ["plot", "report"])
def test_the_commands_say_so_and_write_nothing(tmp_path, script, command):
    cut(0.5)(tmp_path / "bad.h5")
    done = script(command, tmp_path / "bad.h5")
    assert done.returncode == 2 and done.stderr.startswith(f"{command}: ") and "Traceback" not in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["bad.h5"]
