"""What no sweep measures, and is published all the same: Python's module and the drop-in, of JSON files."""

import dataclasses
import subprocess

import pytest
import synthetic
from synthetic import SCRIPTS, file_of

from boxwood_results import dropin_times, published, python_times

ROOT = SCRIPTS.parent
TABLES = "results/published/tables.md"


def test_what_python_takes_is_shown_with_its_intervals(root):
    rows = [python_times.Row("pairs of boxes", 1000, [200, 210, 190, 205, 195, 200, 200, 200, 200], [100] * 9,
                             {"rtree": [400, 420, 380, 410, 390, 400, 400, 400, 900], "SciPy": [150, 300, 150, 300, 200, 200, 200, 200, 100]})]
    env = {"host": "h", "cpu": "a CPU", "ncpu": 2, "git_commit": "abcdef012345", "git_dirty": 0, "created_utc": "2026-11-26T10:00:00",
           "versions": {"python": "3.11", "rtree": "1.4"}}
    python_times.PythonTimes(rows, env).write(root / published.PYTHON)
    assert any("lacks questions or rounds" in line for line in published.problems(root))
    rows += [python_times.Row(f"question {i}", 1000, [200] * 9, [100] * 9, {}) for i in range(13)]
    python_times.PythonTimes(rows, env).write(root / published.PYTHON)
    published.write(root)
    text = (root / "README.md").read_text()
    assert "| pairs of boxes | 1,000 | 200 ns | 100 ns, 100 % | rtree 2.00x (2.00 to 2.00), SciPy 1.00x (0.750 to 1.43) ? |" in text
    assert "a CPU, 2 cores, commit abcdef01, python 3.11, rtree 1.4" in text and published.problems(root) == []
    file_of(root, "effects", synthetic.full(wrong=False))
    assert any("more than one machine" in line for line in published.problems(root))
    broken = [python_times.Row("cut", 1000, [200] * 8, [100] * 9, {}), python_times.Row("silent", 1000, [200] * 9, [0] * 9, {})]
    for row in broken:
        python_times.PythonTimes([row], env).write(root / published.PYTHON)
        with pytest.raises(published.BadFile, match=f"'{row.question}' has not a time above 0 of each round"):
            published.problems(root)
    for text in ("{}", '{"rows": [], "env": {}}', "not JSON"):
        (root / published.PYTHON).write_text(text)
        with pytest.raises(published.BadFile, match="no file of scripts/python_bench"):
            published.problems(root)


def problems(root):
    """But for what the drop-in's file lacks, which is here of a program or two."""
    return [line for line in published.problems(root) if "it lacks" not in line]


def test_what_the_drop_in_gains_is_shown_by_its_fastest_rival(root):
    def manager(name, ratio, wrong=0):
        spread = [1.0] * 9 if ratio == 1 else [0.8, 0.9, 1, 1, 1, 1, 1, 1.1, 1.2]
        return {"manager": name, "shapes": False, "wrong": wrong, "rounds_ns": [1e6 * ratio * factor for factor in spread],
                "over_first": {"mid": ratio, "lo": 0.9 * ratio, "hi": 1.1 * ratio}}

    named = {"boxwood.fcl_manager": 1, "fcl.slow": 9, "fcl.fast": 4, "fcl.liar": 2, "boxwood.coal_manager": 2, "coal.array": 2.1}
    runs = [dropin_times.Run(1000, 0.01, 50, [manager(name, ratio, wrong=int(name == "fcl.liar")) for name, ratio in named.items()],
                             queries=50, checked=40)]
    env = {"host": "h", "cpu": "a CPU", "ncpu": 2, "git_commit": "abcdef012345", "git_dirty": 0, "created_utc": "2026-11-26T10", "versions": {}}
    runs[0].managers[-2]["rounds_ns"].reverse()  # a round's times belong together
    dropin_times.DropinTimes(9, runs, env).write(root / published.DROPIN)
    published.write(root)
    text = (root / "README.md").read_text()
    assert "| 1.00 ms for 50 frames | 4.00x (3.60 to 4.40) fcl.fast | 2.00 ms for 50 frames | 1.05x (0.859 to 1.28) ? coal.array | 40 of 50 |" in text
    assert "9 rounds in turns within one process, a CPU, 2 cores, commit abcdef01" in text and problems(root) == []
    assert "dropin.json --rounds 9 --bodies 1000 --meshes`" in text

    world = [manager("boxwood.world", 1), manager("boxwood.fcl_manager, FCL's shapes", 5), manager("boxwood.fcl_manager_f32, FCL's shapes", 4),
             manager("fcl.tree, FCL's shapes", 8), manager("coal.tree, Coal's shapes", 6, wrong=1)]
    runs.append(dropin_times.Run(1000, 1, 10, world, triangles=500, distances=20, queries=210, checked=200))
    dropin_times.DropinTimes(9, runs, env).write(root / published.DROPIN)
    published.write(root)
    text = (root / TABLES).read_text()
    assert ("| 1,000 | 500 | all | 20 | 200 of 210 | 1.00 ms for 10 frames | 8.00x (7.20 to 8.80) tree | 1 wrong | 4.00x (3.60 to 4.40) |  |"
            ) in text
    assert "dropin.json --rounds 9 --bodies 1000 --meshes 1000`" in text and problems(root) == []

    world[-1].update(wrong=0, differ=3)
    assert [runs[1].why_not([name]) for name in ("boxwood.world", "nobody", "coal.tree, Coal's shapes")] == ["", "", "3 unlike ours"]

    def refused(why):
        dropin_times.DropinTimes(9, runs, env).write(root / published.DROPIN)
        with pytest.raises(published.BadFile, match=why):
            published.problems(root)

    runs[0].managers[2]["rounds_ns"] = [1.01 * ns for ns in runs[0].managers[2]["rounds_ns"]]
    refused("fcl.fast: its ratio does not follow from its rounds")
    runs[0].managers[1]["rounds_ns"].pop()
    refused("fcl.slow has not a time above 0 of each of 9 rounds")
    for run in runs:  # more are said than there are
        for row in run.managers:
            row["rounds_ns"] = [*row["rounds_ns"], *row["rounds_ns"]][:9]
    with pytest.raises(published.BadFile, match="of each of 900 rounds"):
        dropin_times.DropinTimes(900, runs, env).write(root / published.DROPIN)
        published.problems(root)
    for key in ("differ", "wrong"):
        runs[0].managers[0][key] = 1
        refused("boxwood.fcl_manager is wrong")
        runs[0].managers[0][key] = 0
    for triangles in (0, 500):
        runs[:] = [dropin_times.Run(1000, 1, 10, world, triangles)]
        refused("no answer was checked")


def test_what_the_drop_in_was_not_held_against_is_said():
    times = dropin_times.read(ROOT / published.DROPIN)
    assert dropin_times.lacks(times) == []
    bounds, meshes = times.runs[0], times.runs[-1]
    bounds.managers[:] = [row for row in bounds.managers if "morton" not in row["manager"]]
    assert len(dropin_times.lacks(times)) == 4 and "fcl.dynamic_aabb_tree.morton with 1,000 bodies" in dropin_times.lacks(times)
    times.runs[0] = dataclasses.replace(bounds, frames=1)
    assert "the program of 1,000 bodies in 50 frames: it has one of 1" in dropin_times.lacks(times)
    times.runs.remove(meshes)
    assert "the program of 10,000 meshes of which 1% move" in dropin_times.lacks(times)


def test_the_drop_in_is_measured_with_the_sweeps(root):
    managers = [{"manager": "boxwood.fcl_manager", "wrong": 0, "rounds_ns": [1e6] * 9, "over_first": {"mid": 1}}]

    def said(dropin, isa):
        file_of(root, "effects", synthetic.full(wrong=False), git_commit="a" * 40)
        env = {"host": "testhost", "cpu": "Test CPU & <Core> 9", "ncpu": 2, "git_commit": dropin, "git_dirty": 0, "created_utc": "2026-11-26T10", "versions": {}}
        dropin_times.DropinTimes(9, [dropin_times.Run(1000, 1, 50, managers, queries=9, checked=9)], env | isa).write(root / published.DROPIN)
        published.freeze(root)
        published.write(root)
        return problems(root)

    assert said("a" * 40, {}) == said("a" * 40, {"isa_max": "AVX3"}) == []
    (another,) = said("b" * 40, {})
    assert "more than one commit" in another
    (another,) = said("a" * 40, {"isa_max": "AVX2"})
    assert "more than one machine" in another and "AVX2" in another and "AVX3" in another


@pytest.mark.parametrize("n, cut", [(1, 0), (5, 0), (6, 0), (8, 0), (9, 1), (11, 1), (12, 2), (30, 9)])
def test_intervals_of_medians_are_those_of_the_sign_test(n, cut):
    _, lo, hi = python_times.median_interval(range(n))
    assert (lo, hi) == (cut, n - 1 - cut)
