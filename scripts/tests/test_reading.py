"""What cannot be read is refused with a message that says what to do; what is missing is left out."""

import csv
import json
import math
import re

import h5py
import numpy as np
import pytest
import synthetic

from boxwood.results import reader, words
from boxwood_results import findings, run


def test_reads_what_was_written(full):
    results = run.read(full)
    assert results.rounds == 15 and len(results.jobs) == 45
    cell = next(c for c in results.cells if c.name == "uniform/n1000-s1/pairs/binned_sah.wide8.self_pairs/f32/tbb-2")
    assert (cell.label, cell.family, cell.ours, cell.job.where.threads) == ("binned_sah.wide8", "binned_sah", True, 2)
    assert cell.status == "exact" and cell.counters["box_tests"] == 41000
    assert cell.has("build") and cell.total == "build+query"
    assert cell.median("build") < cell.median(run.TOTAL) < 1.1 * (cell.median("build") + cell.median("query"))
    assert 0 < results.noise_floor < 0.05


def test_an_executor_is_named_where_a_job_has_several(tmp_path):
    made = synthetic.Maker(2)
    for contender in ("median.wide8", "median.binary"):
        made.cell("uniform", 500, "pairs", contender, synthetic.PAIR_CONTENDERS[contender], 1)
    for row in made.rows["cells"][1:]:
        row["executor"] = "openmp"
    results = run.read(made.write(tmp_path / "a.h5"))
    assert [cell.label for cell in results.cells] == ["median.wide8 serial", "median.binary openmp"]


def test_numbers_are_as_the_program_writes_them():
    with open(synthetic.ROOT / "scripts/tests/numbers.csv", newline="") as table:
        rows = list(csv.DictReader(table))
    assert {row["kind"] for row in rows} == {"time", "ratio", "interval"}
    for row in rows:
        text = getattr(words, row["kind"] + "_text")(*map(float, row["numbers"].split()))
        assert text == row["text"], row


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
    won, times, *over = tree.together.split()
    assert won == "wins" and abs(float(times.rstrip("x")) - 10 / 3) < 0.1 and over == ["over", "Embree"]


def test_a_wrong_cell_is_never_ranked(full):
    results = run.read(full)
    wrong = next(c for c in results.cells if c.job.scene == "bars" and c.label == "bullet.dbvt")
    assert wrong.status == "wrong" and wrong.timed
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
    with pytest.raises(AssertionError, match='column checks.status holds the unknown word "a_word_of'):
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


def flipped(sealed):
    """Damages the compressed samples: the seal tells, and where there is none their checksum."""

    def make(path):
        synthetic.small().write(path)
        with h5py.File(path) as file:
            offset = file["samples"].id.get_chunk_info(0).byte_offset
        data = bytearray(path.read_bytes())
        data[offset + 20] ^= 0xFF
        path.write_bytes(data if sealed else data[:-16])

    return make


def dropped(*names):
    return lambda path: synthetic.small().write(path, drop=names)


def edited(table, column, value, row=0, made=None):
    """What is not true any more after one value was changed."""

    def make(path):
        (made or synthetic.full(2)).write(path)
        with h5py.File(path, "a") as file:
            rows = file[table][:]
            rows[column][row] = value
            file[table][:] = rows

    return make


def without_minor_version(*tables):
    """A file that does not say its minor version, and lacks these tables."""

    def make(path):
        synthetic.small().write(path)
        with h5py.File(path, "a") as file:
            del file.attrs["schema_minor"]
            for name in tables:
                del file[name]

    return make


def test_a_file_without_a_minor_version_is_taken_for_the_newest(tmp_path):
    path = tmp_path / "a.h5"
    without_minor_version()(path)
    assert len(run.read(path).source["device_gains"]) == 0
    assert synthetic.answer("show", path).returncode == 0


def as_group(name):
    def make(path):
        synthetic.small().write(path)
        with h5py.File(path, "a") as file:
            del file[name]
            file.create_group(name)

    return make


@pytest.mark.parametrize("make", [as_group("samples"), broken_header(schema_major="two"), lambda path: path.mkdir()])
def test_odd_files_are_refused_in_one_way(tmp_path, make):
    path = tmp_path / "odd.h5"
    make(path)
    with pytest.raises(reader.BadFile, match="cannot read result file"):
        reader.load(path)


DERIVES = "bad.h5 --out NEW.h5` derives it"
ELSE = "use another copy, or measure again"
@pytest.mark.parametrize(
    "make, said",
    [
        (lambda path: None, "no such file"),
        (lambda path: path.write_text("not hdf5, and too long to be but a seal"), "not a readable HDF5 file"),
        (lambda path: path.write_bytes(b""), "the file is empty"),
        (cut(0.5), "not a readable HDF5 file"),
        (cut(0.98), "not a readable HDF5 file"),
        (flipped(True), "it is damaged: its content is not what was written (checksum); use another copy"),
        (flipped(False), "table samples: "),
        (broken_header(format="else"), "not a Boxwood result file"),
        (broken_header(schema_major=np.uint32(1)), "it is of schema 1, and this program reads schema 2; measure again"),
        (broken_header(complete=np.uint32(0)), "it is incomplete: its writer did not finish"),
        (dropped("samples"), f"table samples is missing; {ELSE}"),
        (dropped("compare"), f"table compare is missing; `boxwood merge "),
        (dropped("stage_costs"), DERIVES),
        (dropped("samples.phase"), f"column samples.phase is missing; {ELSE}"),
        *((dropped(column), DERIVES) for column in sorted(reader.DERIVED_COLUMNS)),
        (dropped("medians.times_limit"), DERIVES),
        (without_minor_version("device_gains"), DERIVES),
        (edited("compare", "verdict", b"quicker"), f'column compare.verdict holds the unknown word "quicker"; {ELSE}'),
        (edited("compare", "reason", b"moody"), f'column compare.reason holds the unknown word "moody"; {ELSE}'),
        (edited("compare", "family", b"foes"), f'column compare.family holds the unknown word "foes"; {ELSE}'),
        (edited("samples", "wall_ns", -5.5, 3), f"column samples.wall_ns holds -5.5 in row 3, which is no time; {ELSE}"),
        (edited("samples", "wall_ns", math.inf), f"column samples.wall_ns holds inf in row 0, which is no time; {ELSE}"),
        (edited("samples", "phase", b"tea"), f'column samples.phase holds the unknown word "tea"; {ELSE}'),
        (edited("cells", "status", b"maybe"), f'column cells.status holds the unknown word "maybe"; {ELSE}'),
        (edited("findings", "topic", b"gossip"), f'column findings.topic holds the unknown word "gossip"; {ELSE}'),
        (edited("compare", "cell_a", 9999), f"column compare.cell_a holds 9999, which no row of cells has; {ELSE}"),
        (edited("samples", "cell_id", 9999), f"column samples.cell_id holds 9999, which no row of cells has; {ELSE}"),
        (edited("samples", "shard_id", 2**32 - 1), "column samples.shard_id holds 4294967295, which no row of shards has"),
        (edited("cells", "scene_id", 9999), f"column cells.scene_id holds 9999, which no row of scenes has; {ELSE}"),
        (edited("cells", "variant_id", 9999), f"column cells.variant_id holds 9999, which no row of variants has; {ELSE}"),
        (edited("findings", "ours", 9999), f"column findings.ours holds 9999, which no row of cells has; {ELSE}"),
        (edited("cells", "cell_id", 3), f"column cells.cell_id holds 3, which stands there twice; {ELSE}"),
    ],
)
def test_bad_files_are_refused_as_the_program_refuses_them(tmp_path, script, make, said):
    path = tmp_path / "bad.h5"
    make(path)
    with pytest.raises(reader.BadFile) as refusal:
        run.read(path)
    message = str(refusal.value)
    assert said in message and message.startswith(f"cannot read result file '{path}': ") and "\n" not in message
    program = synthetic.answer("show", path)
    assert program.returncode == 2 and program.stderr.startswith("boxwood: error: cannot read result file ")
    if "HDF5" not in said and "no such file" not in said and said != "table samples: ":  # where HDF5 words the cause
        assert program.stderr.strip() == f"boxwood: error: {message}"


def test_words_and_ids_are_those_of_the_program():
    """The lists of results/words.h and results/schema.h."""
    words_h, schema_h = ((synthetic.ROOT / "results" / name).read_text() for name in ("words.h", "schema.h"))
    listed = {enum: tuple(re.findall(r'"([^"]*)"', body))
              for enum, body in re.findall(r"struct Words<(\w+)> \{(.*?)\};", words_h, re.S)}
    known = dict(Phase=words.PHASES, Status=words.STATUSES, Verdict=words.VERDICTS, Reason=words.REASONS,
                 Family=words.FAMILIES, Topic=words.TOPICS)
    assert {enum: tuple(these) for enum, these in known.items()} == listed
    assert dict(re.findall(r'\{"(\w+)", "(\w+)"\}', schema_h)) == reader.REFERENCES


@pytest.fixture
def changed(tmp_path):
    """A file in which somebody made a loss into a win."""
    path = tmp_path / "changed.h5"
    edited("compare", "verdict", b"faster", 3, synthetic.small(9))(path)
    return path


def test_every_reader_warns_of_a_changed_file(tmp_path, script, changed):
    before = synthetic.small(9).write(tmp_path / "before.h5")
    warning = f"warning: '{changed}' was changed after it was written (its seal is gone): what it says need not be what was measured"
    for arguments in (("show", changed), ("compare", before, changed), ("compare", changed, before),
                      ("merge", changed, "--out", tmp_path / "m.h5")):
        assert synthetic.answer(*arguments).stderr == f"boxwood: {warning}\n", arguments
    out = tmp_path / "changed.html"
    assert script("report", changed, "--out", out).stderr == f"report: {warning}\n"
    assert "Warning: " in out.read_text() and "need not be what was measured" in out.read_text()
    assert script("plot", changed, "--figure", "forest", "--format", "png", "--out", tmp_path).stderr == f"plot: {warning}\n"


def test_a_file_as_it_was_written_is_not_warned_of(tmp_path, script, full):
    assert run.read(full).changed == "" and synthetic.answer("show", full).stderr == ""
    assert script("plot", full, "--figure", "forest", "--format", "png", "--out", tmp_path).stderr == ""


@pytest.mark.parametrize("command", ["plot", "report"])
def test_the_commands_say_so_and_write_nothing(tmp_path, script, command):
    cut(0.5)(tmp_path / "bad.h5")
    done = script(command, tmp_path / "bad.h5")
    assert done.returncode == 2 and done.stderr.startswith(f"{command}: ") and "Traceback" not in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["bad.h5"]
