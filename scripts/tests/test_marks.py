"""Marks stand beside what was measured, reached or not."""

import functools
import re
import subprocess
from types import SimpleNamespace

import pytest
from synthetic import PROGRAM, SCRIPTS

from boxwood_results import dropin_times, marks, published, robots
from boxwood_results.findings import Comparison, Ratio
from boxwood_results.run import Job, Where

ROOT = SCRIPTS.parent
KNOWN = 'work = "w"\nagainst = "a"\nmean = 12\nleast = 6\nsweep = "narrow"\ntasks = ["collide"]\n'


def cell(cell_id, contender, ns, scene="sphere_mesh_near"):
    job = Job(scene, 10_000, 1, "collide", Where("", 1))
    return SimpleNamespace(cell_id=cell_id, contender=contender, job=job, scene_title=scene, task=SimpleNamespace(title="touch"),
                           median=lambda phase: ns)


def row(rival, ours, gain, phase="query", verdict="faster", family="peers", contender_class=""):
    ratio = Ratio(gain, 0.9 * gain, 1.1 * gain).inverse()
    return Comparison(rival, ours, phase, contender_class, 15, ratio, 0, 0, family, verdict, "", "")


def run_of(*rows):
    return SimpleNamespace(kernels=[], family=lambda family, phase: [row for row in rows if (row.family, row.phase) == (family, phase)])


def one(tmp_path, text=KNOWN):
    path = tmp_path / "marks.toml"
    path.write_text(f"[[marks]]\n{text}")
    return marks.read(path)


def shown(tmp_path, *rows, text=KNOWN):
    return marks.table(one(tmp_path, text), {"narrow": run_of(*rows)}, None)[1]


def test_the_best_of_ours_is_held_against_its_best_rival(tmp_path):
    fast, slow, far = cell(1, "binned_sah.obb.collide", 100), cell(2, "lbvh.obb.collide", 200), cell(3, "lbvh.obb.collide", 50, "sphere_mesh_far")
    fcl, coal = cell(4, "fcl.obb", 900), cell(5, "coal.obb", 800)
    rows = [row(fcl, fast, 9), row(coal, fast, 8), row(fcl, slow, 4.5), row(coal, slow, 4), row(fcl, far, 18.1),
            row(coal, fast, 3, phase="build"), row(coal, fast, 2, verdict="wrong"), row(coal, fast, 1, contender_class="warm start"),
            row(fast, slow, 0.5, family="ours")]
    assert shown(tmp_path, *rows) == ["w", "a", "12x, least 6x", "2", "12.0x", "8.00x (7.20 to 8.80): sphere_mesh_near", "open: the mean"]
    assert shown(tmp_path, *rows, text=KNOWN + "rivals = '^fcl'\n")[4] == "12.8x"
    assert shown(tmp_path, *rows, text=KNOWN + "scenes = '_far$'\n")[3:5] == ["1", "18.1x"]
    assert shown(tmp_path, *rows, text=KNOWN + "ours = '^lbvh'\n")[5] == "4.00x (3.60 to 4.40): sphere_mesh_near"
    assert shown(tmp_path, *rows, text=KNOWN + 'phase = "build"\n')[6] == "no: the mean and the least"
    assert shown(tmp_path, *rows, text=KNOWN + 'class = "warm start"\n')[6] == "no: the mean and the least"
    assert shown(tmp_path, *rows, text=KNOWN + 'phase = "cold_query"\n')[3:] == ["", "", "", "not measured yet"]


def test_some_may_be_at_most_so_much(tmp_path):
    at_most = 'work = "w"\nagainst = "a"\nhighest = 1.15\nsweep = "narrow"\ntasks = ["collide"]\nfamily = "errors"\n'

    def rows(*gains):
        return [row(cell(2 * i, "obb", 1, f"s{i}"), cell(2 * i + 1, "obb.plain", 1, f"s{i}"), gain, family="errors")
                for i, gain in enumerate(gains)]
    assert shown(tmp_path, *rows(1.01, 1.04), text=at_most)[2:] == ["at most 1.15x", "2", "1.02x", "1.04x (0.936 to 1.14): s1", "yes"]
    assert shown(tmp_path, *rows(1.1, 1.0), text=at_most)[5:] == ["1.10x (0.990 to 1.21): s0", "open: the greatest"]
    assert shown(tmp_path, *rows(1.0, 1.2), text=at_most)[6] == "no: the greatest"


def test_what_is_missed_is_said(tmp_path):
    ours, rival = cell(1, "lbvh", 1), cell(2, "fcl", 1)
    assert shown(tmp_path, row(rival, ours, 13.4))[6] == "yes"
    assert shown(tmp_path, row(rival, ours, 12))[6] == "open: the mean"  # 10.8 to 13.2
    needs = KNOWN + "needs = {near = '_near/n10000$', scans = '^scan'}\n"
    assert shown(tmp_path, row(rival, ours, 13.4), text=needs)[6] == "yes, without scans: not measured yet"
    assert shown(tmp_path, row(rival, ours, 11.9))[6] == "no: the mean"
    assert shown(tmp_path, row(rival, ours, 5, verdict="cannot_tell"))[5:] == ["5.00x (4.50 to 5.50) ?: sphere_mesh_near", "no: the mean and the least"]
    far = cell(3, "lbvh", 1, "far")
    assert shown(tmp_path, row(rival, ours, 5.9), row(rival, far, 100))[6] == "no: the least"
    assert marks.table(one(tmp_path), {}, None)[1][6] == "not measured yet"
    text = 'work = "w"\nagainst = "a"\nmissing = "no sweep has it"\n'
    assert marks.table(one(tmp_path, text), {}, None)[1][3:] == ["", "", "", "no sweep has it"]


def test_managers_are_held_by_programs(tmp_path):
    def program(bodies, ratio, triangles=0):
        names = ["boxwood.world"] if triangles else []
        names += ["boxwood.fcl_manager", "fcl.tree"]
        of = [{"manager": name, "wrong": 0, "rounds_ns": [ratio if name == "fcl.tree" else 1.0] * 9} for name in names]
        return dropin_times.Run(bodies, 1, 10, of, triangles=triangles)

    times = dropin_times.DropinTimes(9, [program(1000, 4), program(10_000, 9), program(10_000, 8, triangles=500)], {})

    def dropin(more):
        return marks.table(one(tmp_path, f'work = "w"\nagainst = "a"\nmean = 6\n{more}'), {}, times)[1]

    assert dropin('dropin = "bounds"\n')[3:] == ["2", "6.00x", "4.00x (4.00 to 4.00): 1,000 bodies, all moved", "yes"]
    assert dropin('dropin = "bounds"\nbodies = [1000]\n')[6] == "no: the mean"
    assert dropin('dropin = "worlds"\n')[3:5] == ["1", "8.00x"]


@pytest.mark.parametrize("text, fault", [
    (KNOWN + "leest = 3\n", "key 'leest' is not known"), (KNOWN + "scenes = 3\n", "key 'scenes' is not known, or of another kind"),
    ('work = "w"\nmean = 3\nsweep = "narrow"\n', "key 'against' is missing"), ('work = "w"\nagainst = "a"\nmean = 3\n', "one of the keys"),
    (KNOWN + 'dropin = "bounds"\n', "one of the keys"), ('work = "w"\nagainst = "a"\nmean = 3\ndropin = "all"\n', "bounds or worlds"),
    ('work = "w"\nagainst = "a"\nsweep = "narrow"\n', "none of 'mean', 'least', 'highest'"), ("work = \n", "Invalid value")])
def test_a_faulty_mark_is_refused(tmp_path, text, fault):
    with pytest.raises(marks.BadFile, match=fault):
        one(tmp_path, text)


def test_the_marks_of_the_project_name_what_is_there():
    found = marks.read(ROOT / marks.FILE)
    assert len(found) > 12
    for mark in found:
        for pattern in (mark.scenes, mark.ours, mark.rivals):
            re.compile(pattern)
        assert not mark.sweep or (ROOT / "bench" / "configs" / f"{mark.sweep}.toml").exists()
    assert not {mark.sweep for mark in found} - {one.sweep for one in published.ALL} - {""}


@functools.cache
def cells_of(sweep):
    """[(job, task, contender), ...] of the sweep as it is shipped, with all robots."""
    brought, missing = robots.options(ROOT, robots.folder_beside(ROOT)) if sweep == robots.SWEEP else ([], [])
    if missing:
        pytest.skip(f"{missing[0]} is not here: the sample robots are no part of the project")
    listed = subprocess.run([PROGRAM, "sweep", "--config", ROOT / "bench" / "configs" / f"{sweep}.toml", "--dry-run", *brought],
                            capture_output=True, text=True, check=True).stdout
    names = [name.split("/") for name in listed.split()]
    return [(f"{scene}/{n.split('-s')[0]}", task, contender) for scene, n, task, contender, *_ in names]


@pytest.mark.skipif(not PROGRAM.exists(), reason=f"{PROGRAM} is not built: scripts/setup builds it")
@pytest.mark.parametrize("mark", [mark for mark in marks.read(ROOT / marks.FILE) if mark.sweep], ids=lambda mark: mark.work)
def test_each_mark_finds_cells_in_its_sweep(mark):
    """Of what it names: else a slip in a pattern would read as 'not measured yet'."""
    def jobs(pattern):
        return {job for job, task, contender in cells_of(mark.sweep)
                if task in mark.tasks and re.search(mark.scenes, job.split("/")[0]) and re.search(pattern, contender)}

    found = jobs(mark.ours) & jobs(mark.rivals)
    assert found
    assert [what for what, pattern in mark.needs.items() if not any(re.search(pattern, job) for job in found)] == []
