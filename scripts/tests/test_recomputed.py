"""What is published follows from what was measured: by another language, and by the program of today."""

import math

import h5py
import numpy as np
import pytest
import synthetic
from synthetic import file_of

from boxwood_results import published, recomputed, rederived, verdicts


def edited(file, table, column, change):
    """Changes a column as somebody would who wants another result, and seals the file again."""
    with h5py.File(file, "a") as tables:
        rows = tables[table][:]
        rows[column] = change(rows[column])
        tables[table][:] = rows
    synthetic.seal(file)


@pytest.mark.parametrize("table, column, change, problem", [
    ("samples", "wall_ns", lambda ns: 3 * ns, "not the median of its samples"),
    ("medians", "median_ns", lambda ns: 1.01 * ns, "not the median of its samples"),
    ("compare", "ratio", lambda ratio: 2 * ratio, "not the ratio of its samples"),
    ("compare", "ci_hi", lambda hi: 0.999 * hi, "its samples are"),
    ("compare", "floor", lambda floor: 1000 + 0 * floor, "not the noise floor of the samples"),
    ("compare", "n_pairs", lambda n: n - 1, "not as many rounds as its samples"),
    ("checks", "missing", lambda missing: missing + 1, "what was counted says otherwise"),
    ("kernels", "ns", lambda ns: 1.01 * ns, "not the time of its samples"),
    ("kernels", "wrong", lambda wrong: wrong + 1, "not as many wrong as were counted"),
    ("kernel_costs", "ns", lambda ns: 1.01 * ns, "not the mean of its families"),
    ("kernel_costs", "maybe", lambda maybe: maybe + 1, "not the sums of its families"),
    ("kernel_costs", "on_front", lambda front: 1 + 0 * front, "on the front, though"),
    ("kernel_costs", "on_front", lambda front: 0 * front, "it is not on the front"),
    ("effect_costs", "without_ns", lambda ns: 1.01 * ns, "not the medians of its samples"),
    ("effect_costs", "ci_lo", lambda lo: 0.99 * lo, "not the ratio of its comparison"),
    ("device_gains", "end_to_end_ns", lambda ns: 1.01 * ns, "end_to_end_ns is not the median of its samples"),
    ("device_gains", "ratio", lambda ratio: 1.01 * ratio, "not the ratio of its comparison")])
def test_numbers_that_do_not_follow_from_the_samples_are_said(root, table, column, change, problem):
    file = file_of(root, "pairs", synthetic.full(wrong=False))
    published.freeze(root)
    published.write(root)
    assert published.problems(root) == []
    edited(file, table, column, change)
    published.write(root)
    (said,) = published.problems(root)
    assert "do not follow from its samples" in said and problem in said


def calling(verdict, reason):
    def change(rows):
        rows["verdict"], rows["reason"] = verdict, reason

    return change


def with_the_widest_interval(rows):
    """Of which a loss is none: it crosses 1."""
    calling(b"cannot_tell", b"crosses_1")(rows)
    rows["ci_lo"], rows["ci_hi"] = 0.5, 2


@pytest.mark.parametrize("change", [
    *(calling(b"cannot_tell", reason) for reason in (b"too_noisy", b"below_the_floor", b"too_few_rounds", b"crosses_1", b"memory_layout", b"unchecked", b"")),
    *(calling(verdict, b"") for verdict in (b"faster", b"same", b"wrong", b"")),
    with_the_widest_interval])
def test_a_loss_that_is_hidden_is_said(root, change):
    file = file_of(root, "pairs", synthetic.full(wrong=False))
    with h5py.File(file, "a") as tables:
        rows = tables["compare"][:]
        lost = rows["verdict"] == b"slower"
        assert lost.any()
        changed = rows[lost]
        change(changed)
        rows[lost] = changed
        tables["compare"][:] = rows
    found = [line for line in recomputed.differences(published.read(file).source) if line.startswith("/compare")]
    assert len(found) == lost.sum() and all("its samples are slower" in line for line in found)


def with_other(column, value):
    def change(rows):
        rows[column][rows["verdict"] == b"slower"] = value
        return rows

    return change


def with_other_statuses(rows):
    rows["status"] = b"wrong"
    return rows


def with_other_trust(rows):
    rows["trust"] = b"noise floor 0.1 %"
    return rows


@pytest.mark.parametrize("table, change", [
    ("compare", lambda rows: rows[rows["verdict"] != b"slower"]),
    ("compare", lambda rows: np.concatenate([rows, rows[rows["verdict"] == b"faster"]])),
    ("compare", with_other("class", b"another")),
    ("compare", with_other("family", b"ours")),
    ("compare", with_other("delta", 1000)),
    ("compare", with_other("words", b"wins 2.00x over FCL")),
    ("cells", with_other_statuses),
    ("findings", lambda rows: rows[: len(rows) // 2]),
    ("findings", lambda rows: rows[::-1]),
    ("health", with_other_trust),
    ("medians", lambda rows: rows[1:])])
def test_what_is_left_out_or_called_otherwise_is_said(root, table, change):
    file = file_of(root, "pairs", synthetic.full(wrong=False))
    assert rederived.differences(file, published.read(file).source) == []
    with h5py.File(file, "a") as tables:
        rows, attrs = change(tables[table][:]), dict(tables[table].attrs)
        del tables[table]
        tables.create_dataset(table, data=rows, chunks=True).attrs.update(attrs)
    synthetic.seal(file)
    assert any("do not follow from its samples" in line for line in published.faults(file, published.read(file)))
    assert any(line.startswith(f"/{table}, ") for line in rederived.differences(file, published.read(file).source))


@pytest.mark.skipif(not synthetic.PROGRAM.exists(), reason=f"{synthetic.PROGRAM} is not built")
def test_files_are_derived_again_by_the_program_under_test():
    assert rederived.program() == synthetic.PROGRAM


def test_without_a_program_no_file_is_derived_again(root, monkeypatch):
    monkeypatch.setenv("BOXWOOD_BUILD", str(root))
    assert rederived.program() is None and rederived.differences(root / "none.h5", None) == []


@pytest.mark.parametrize("status, verdict, reason, ratio", [(b"wrong", b"wrong", b"", math.nan), (b"unchecked", b"cannot_tell", b"unchecked", 0)])
def test_what_is_wrong_or_unchecked_is_not_judged(root, status, verdict, reason, ratio):
    file = file_of(root, "pairs", synthetic.full(wrong=False))
    source = published.read(file).source
    of = source["cells"]["cell_id"][0]
    assert of in source["compare"]["cell_b"]
    with h5py.File(file, "a") as tables:
        cells = tables["cells"][:]
        cells["status"][cells["cell_id"] == of] = status
        tables["cells"][:] = cells

    def found():
        return [line for line in recomputed.differences(published.read(file).source) if line.startswith("/compare")]

    rows = (source["compare"]["cell_a"] == of) | (source["compare"]["cell_b"] == of)
    assert sum(f"cell {of} against" in line or f"against {of}," in line for line in found()) == rows.sum()
    with h5py.File(file, "a") as tables:
        changed = tables["compare"][:]
        changed["verdict"][rows], changed["reason"][rows] = verdict, reason
        changed["ratio"][rows] += ratio
        tables["compare"][:] = changed
    named = [line for line in found() if f"cell {of} against" in line or f"against {of}," in line]
    assert not [line for line in named if "it is called" in line or "not the ratio" in line]


def test_a_verdict_is_that_of_its_samples():
    def of(logs, level=0.05, floor=0.0, inputs=()):
        return verdicts.ruling(logs, inputs or [0] * len(logs), level, floor, 0.05)[:2]

    slower = [math.log(1.2 + 0.01 * i) for i in range(10)]
    assert of(slower) == ("slower", "") and of([-log for log in slower]) == ("faster", "")
    assert of(slower[:8]) == ("cannot_tell", "too_few_rounds")
    assert of(slower, 2 / 2**10) == ("slower", "") and of(slower, 1.9 / 2**10) == ("cannot_tell", "too_few_rounds")
    assert of(slower, floor=0.19) == ("slower", "")  # all of the interval, from 1.21 on, is beyond it
    assert of(slower, floor=0.22) == ("cannot_tell", "too_noisy") and of([0.5 * log for log in slower], floor=0.15) == ("cannot_tell", "below_the_floor")
    assert of([0.001 * log for log in slower]) == ("same", "") and of([0.001 * log for log in slower], floor=0.06) == ("cannot_tell", "below_the_floor")
    assert of([*slower[:8], -0.2, -0.2]) == ("cannot_tell", "crosses_1")
    assert of([*slower[:7], -0.2, -0.2, -0.2], inputs=[0] * 7 + [1] * 3) == ("cannot_tell", "crosses_1")


def test_the_level_of_a_family_is_that_of_its_claims():
    assert verdicts.sign_test([1.0] * 10) == 2 / 2**10 and verdicts.sign_test([1.0] * 9 + [-1.0]) == 22 / 2**10
    assert verdicts.sign_test([0.0] + [1.0] * 9) == 2 / 2**9
    assert verdicts.level_of([0.001, 0.5, 0.9, 1], 0.05) == 0.05 / 4 and verdicts.level_of([0.001, 0.02, 0.9, 1], 0.05) == 0.05 / 2
    assert verdicts.level_of([0.5, 0.9], 0.05) == 0.05 / 2


def test_intervals_are_those_of_the_median_and_hold_every_input():
    assert verdicts.narrowest(5) == 0 and [verdicts.narrowest(n) for n in (6, 9, 12, 15, 20, 30)] == [1, 2, 3, 4, 6, 10]
    logs, inputs = [float(i) for i in range(15)], [i // 3 for i in range(15)]
    assert verdicts.interval(logs, [0] * 15) == pytest.approx((math.exp(3), math.exp(11)))
    assert verdicts.interval(logs, inputs) == pytest.approx((math.exp(1), math.exp(13)))
    assert verdicts.interval(logs[:5], [0] * 5) is None
