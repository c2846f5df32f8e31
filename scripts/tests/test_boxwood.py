"""The boxwood program from the outside: answers against numpy, bad input, and where output goes.

BOXWOOD_BUILD names the build folder (build/release if not set).
"""

import json
import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("BOXWOOD_BUILD", ROOT / "build" / "release")) / "boxwood"
FOUR_LINK = "".join(f"{x - 0.32},-0.1,-0.1,{x + 0.32},0.1,0.1\n" for x in (0, 0.5, 1.2, 1.8))

pytestmark = pytest.mark.skipif(not PROGRAM.exists(), reason=f"{PROGRAM} is not built")


def boxwood(*arguments, stdin="", cwd=None):
    return subprocess.run(
        [PROGRAM, *map(str, arguments)], input=stdin, capture_output=True, text=True, timeout=300, cwd=cwd
    )


def answer(*arguments, stdin=""):
    done = boxwood(*arguments, stdin=stdin)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return done.stdout


def complaint(*arguments, stdin=""):
    """The one line on stderr of a command that fails as it should."""
    done = boxwood(*arguments, stdin=stdin)
    assert done.returncode == 2, (done.returncode, done.stdout, done.stderr)
    assert done.stdout == ""
    assert done.stderr.startswith("boxwood: error: ") and done.stderr.count("\n") == 1, done.stderr
    return done.stderr


def words(registry):
    return [row["name"] for row in json.loads(answer("list", registry, "--json"))]


def choices():
    """Every builder x layout x executor x threads, as options."""
    if not PROGRAM.exists():
        return []
    return [
        ("--builder", b, "--layout", v, "--executor", e, "--threads", t)
        for b in words("builders")
        for v in words("layouts")
        for e in words("executors")
        for t in ((1,) if e == "serial" else (1, 2, 5))
    ]


def brute_force(boxes):
    """All pairs (i, j), i < j, sorted: closed boxes in doubles."""
    low, high = boxes[:, :3], boxes[:, 3:]
    rows = [np.empty((0, 2), int)]
    for i in range(len(boxes)):
        meets = np.all((low[i] <= high[i + 1 :]) & (low[i + 1 :] <= high[i]), axis=1)
        j = np.flatnonzero(meets) + i + 1
        rows.append(np.column_stack([np.full(len(j), i), j]))
    return np.concatenate(rows)


def csv(rows, form=repr):
    return "".join(",".join(form(float(x)) for x in row) + "\n" for row in rows)


def lines(pairs):
    return "".join(f"{i},{j}\n" for i, j in pairs)


def random_boxes(n, seed, size=0.15):
    rng = np.random.default_rng(seed)
    low = rng.uniform(-1, 1, (n, 3))
    return np.hstack([low, low + rng.uniform(0, size, (n, 3))])


@pytest.fixture(scope="module")
def boxes_file(tmp_path_factory):
    boxes = np.concatenate(
        [
            random_boxes(2500, 1),
            np.round(random_boxes(1500, 2), 1),  # on a grid: touching, identical, flat
            np.tile(random_boxes(1, 3), (20, 1)),
        ]
    )
    file = tmp_path_factory.mktemp("query") / "boxes.csv"
    file.write_text("# min and max\n" + csv(boxes))
    return file, lines(brute_force(boxes))


@pytest.mark.parametrize("how", choices(), ids=lambda how: "-".join(str(w) for w in how[1::2]))
def test_pairs_are_those_of_brute_force(boxes_file, how):
    file, expected = boxes_file
    assert answer("query", "pairs", file, *how) == expected
    assert answer("query", "pairs", file, "--count", *how) == f"{expected.count(chr(10))}\n"


@pytest.mark.parametrize("scale", [1e300, 1e38, 1e-310, 1e-45])
def test_pairs_beyond_the_range_of_floats(scale):
    boxes = random_boxes(300, 4, size=0.5) * scale
    assert answer("query", "pairs", "-", stdin=csv(boxes)) == lines(brute_force(boxes))


def test_pairs_closer_than_floats_can_tell():
    rng = np.random.default_rng(5)
    low = 1 + rng.integers(0, 40, (300, 3)) * 2.0**-52
    boxes = np.hstack([low, low + rng.integers(0, 12, (300, 3)) * 2.0**-52])
    expected = lines(brute_force(boxes))
    assert 0 < expected.count("\n") < 300 * 299 // 2
    assert answer("query", "pairs", "-", stdin=csv(boxes, float.hex)) == expected


def test_no_boxes_have_no_pairs():
    done = boxwood("query", "pairs", "-")
    assert (done.returncode, done.stdout) == (0, "")
    assert done.stderr == "boxwood: warning: standard input holds no rows of min_x,min_y,min_z,max_x,max_y,max_z\n"


@pytest.mark.parametrize("n", [1, 2, 3])
def test_few_boxes(n):
    boxes = np.tile([0.0, 0, 0, 1, 1, 1], (n, 1))
    assert answer("query", "pairs", "-", stdin=csv(boxes)) == lines(brute_force(boxes))


def test_four_link_has_two_pairs():
    assert answer("query", "pairs", "-", stdin=FOUR_LINK) == "0,1\n2,3\n"


def test_numbers_are_read_as_python_reads_them():
    # Half-way cases, subnormals and the ends of the range: each box touches the next at one number.
    numbers = ["1e-400", "4.9e-324", "1e-320", "0.1", "0x1.00000000000008p+0", "9007199254740993", "1e308"]
    value = [float.fromhex(t) if t.startswith("0x") else float(t) for t in numbers]
    text = "".join(f"{t},0,0,{repr(v)},1,1\n" for t, v in zip(numbers, value))
    text += "".join(f"{repr(v)},0,0,{t},1,1\n" for t, v in zip(numbers, value))
    boxes = np.array([[v, 0, 0, v, 1, 1] for v in value] * 2)
    assert answer("query", "pairs", "-", stdin=text) == lines(brute_force(boxes))


def test_forms_of_output():
    assert answer("query", "pairs", "-", "--header", stdin=FOUR_LINK) == "i,j\n0,1\n2,3\n"
    answered = json.loads(answer("query", "pairs", "-", "--json", stdin=FOUR_LINK))
    assert answered == {"boxes": 4, "count": 2, "pairs": [[0, 1], [2, 3]]}


@pytest.mark.parametrize(
    "text, said",
    [
        ("0,0,0,1,1,1\nnan,0,0,1,1,1\n", "boxes.csv:2: min_x is nan"),
        ("# a\n\n0,0,0,1,-inf,1\n", "boxes.csv:3: max_y is -inf"),
        ("0,3,0,1,1,1\n", "boxes.csv:1: min_y 3 is larger than max_y 1"),
        ("0,0,0,1,1\n", "boxes.csv:1: 5 columns, expected 6"),
        ("0,0,0,1,1,1,1\n", "boxes.csv:1: 7 columns, expected 6"),
        ("min_x,a,b,c,d,e\n", "boxes.csv:1: column 1 is 'min_x', not a number"),
        ("0,0,0,1,1,1e999\n", "boxes.csv:1: column 6 is '1e999', larger than every double"),
        ("0,0,0,1,,1\n", "boxes.csv:1: column 5 is empty"),
    ],
)
def test_bad_boxes_are_named_by_file_and_line(tmp_path, text, said):
    file = tmp_path / "boxes.csv"
    file.write_text(text)
    assert said in complaint("query", "pairs", file)


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["lst"], "did you mean 'list'"),
        (["list", "bilders"], "did you mean 'builders'"),
        (["query", "piars"], "did you mean 'pairs'"),
        (["query"], "pairs, rays"),
        (["demo", "for-link"], "did you mean 'four-link'"),
        (["query", "pairs"], "required"),
        (["query", "pairs", "/no/such/file"], "/no/such/file: no such file"),
        (["query", "pairs", "/"], "/: is a folder"),
        (["query", "pairs", "-", "--buidler", "median"], "did you mean '--builder'"),
        (["query", "pairs", "-", "--builder", "medain"], "did you mean 'median'"),
        (["query", "pairs", "-", "--layout", "wyde8"], "did you mean 'wide8'"),
        (["query", "pairs", "-", "--executor", "tb"], "did you mean 'tbb'"),
        (["query", "pairs", "-", "--executor", "serial", "--threads", "2"], "serial"),
        (["query", "pairs", "-", "--threads", "0"], "--threads"),
        (["query", "pairs", "-", "--threads", "many"], "--threads"),
        (["query", "rays", "/no/such/mesh.obj", "-"], "/no/such/mesh.obj"),
    ],
)
def test_bad_usage_says_what_and_how(arguments, said):
    assert said in complaint(*arguments, stdin="")


def test_no_command_shows_the_help_and_fails():
    done = boxwood()
    assert done.returncode == 2 and done.stdout == "" and "boxwood demo four-link" in done.stderr


def test_every_help_has_an_example():
    commands = ["list", "sweep", "check", "show", "compare", "merge", "doctor", "demo", "scene", "plan", "query"]
    for command in [*([c] for c in commands), ["demo", "four-link"], ["demo", "robot"], *(["query", q] for q in ("pairs", "rays", "triangles", "ccd"))]:
        assert "xample" in answer(*command, "--help"), command
    assert all(command in answer("--help") for command in commands)


def test_scene_describes_and_draws(tmp_path):
    said = answer("scene", "warehouse", "--n", "1000", "--frame", "0,5")
    assert "1000 bodies" in said and "frame 5: 1000 present, " in said
    own = tmp_path / "own.toml"
    own.write_text('[[bodies]]\ngenerator = "cubes"\neffects = ["drift", "spin"]\n')
    svg = tmp_path / "own.svg"
    answer("scene", str(own), "--n", "20", "--frame", "3", "--svg", str(svg), "--depth", "1")
    assert "frame 3: 20 bodies, 20 changed" in svg.read_text()
    done = boxwood("scene", "rubble", "--svg", str(svg))
    assert done.returncode == 0 and re.fullmatch(r"drawing \d+ instead of \d+ bodies; --n \d+ draws them all\n", done.stderr)
    own.write_text('[[bodies]]\ngenerator = "cubes"\neffects = "drfit"\n')
    done = boxwood("scene", str(own))
    assert done.returncode == 2 and f"{own}:3: " in done.stderr and "did you mean 'drift'?" in done.stderr


def test_scene_draws_a_strip(tmp_path):
    svg = tmp_path / "strip.svg"
    assert "queries: rays (4096 flying), " in answer("scene", "fly_through", "--n", "50", "--strip", str(svg))
    assert [f"frame {k}: 50 bodies" in svg.read_text() for k in (0, 33, 66, 100)] == [True] * 4
    own = tmp_path / "own.toml"
    own.write_text('queries = {name = "rays", kind = "flyng"}\n[[bodies]]\ngenerator = "cubes"\n')
    done = boxwood("scene", str(own))
    assert done.returncode == 2 and f"{own}:1: " in done.stderr and "did you mean 'flying'?" in done.stderr


def test_plan_says_what_the_scene_requires():
    plan = json.loads(answer("plan", "still_life", "--json"))
    assert [row["stage"] for row in plan["stages"] if row["required"]] == ["fit", "tree", "pairs"]
    assert all(row["why"] and row["runs"] == row["required"] for row in plan["stages"])
    whole = json.loads(answer("plan", "still_life", "--all-stages", "--json"))
    assert "filter" in [row["stage"] for row in whole["stages"] if row["runs"]]
    assert "the same answers" in answer("plan", "tumbling_rocks", "--n", "100", "--play", "5", "--threads", "2")
    done = boxwood("plan", "warehose")
    assert done.returncode == 2 and "did you mean 'warehouse'?" in done.stderr


def test_version_says_how_it_was_built():
    text = answer("--version")
    assert text.startswith("boxwood ") and all(w in text for w in ("commit", "compiler", "packages", "hdf5"))


def test_list_is_the_same_whole_and_in_parts():
    whole = json.loads(answer("list", "--json"))
    assert list(whole) == (
        "builders optimizers layouts volumes queries updates executors devices kernels families scenes moving_scenes effects "
        "scene_queries query_kinds tasks peers".split()
    )
    for name, rows in whole.items():
        assert json.loads(answer("list", name, "--json")) == rows
        assert all(row["name"] and row["summary"] for row in rows)
        text = answer("list", name)
        assert all(row["name"] in text for row in rows) and text
    assert {"median", "binned_sah", "incremental"} <= {row["name"] for row in whole["builders"]}


def test_list_alone_is_a_summary_of_one_screen():
    lines = answer("list").splitlines()
    assert len(lines) <= 24 and max(map(len, lines)) <= 100
    counts = {line.split()[0]: int(line.split()[1]) for line in lines[1:] if line and line[0] != "`"}
    assert counts == {name: len(rows) for name, rows in json.loads(answer("list", "--json")).items()}


def test_doctor_never_fails():
    found = json.loads(answer("doctor", "--json"))
    assert {f["level"] for f in found["findings"]} <= {"ok", "note", "warn"}
    assert found["isa"]["used"] in found["isa"]["supported"]
    assert found["triad_gbs"]["one"] > 0
    assert "What may spoil timings" in answer("doctor")


def test_demo_alone_lists_the_demos():
    said = answer("demo")
    assert "boxwood demo four-link " in said and "boxwood demo robot " in said


def test_the_demo_explains_the_four_link_robot():
    text = answer("demo", "four-link")
    for fact in (
        "= 6 box tests",
        "{base, shoulder} against {elbow, wrist}: apart -> 4 pairs pruned by one test",
        "Pairs found: (base, shoulder), (elbow, wrist).",
        "3 box tests instead of 6",
        "Left to report: 0.",
        "Not allowed, so reported: (base, wrist).",
    ):
        assert fact in text, fact


@pytest.mark.parametrize("command", [["list"], ["demo", "four-link"], ["--help"], ["query", "pairs", "-"]])
def test_a_full_disk_is_an_error(command):
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [PROGRAM, *command], stdout=full, stderr=subprocess.PIPE, input=FOUR_LINK, text=True, timeout=60
        )
    assert done.returncode == 2 and "disk full" in done.stderr


def test_a_reader_who_leaves_is_no_error(boxes_file):
    with subprocess.Popen(
        [PROGRAM, "query", "pairs", boxes_file[0]], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        process.stdout.close()
        assert process.wait(timeout=60) == 0 and process.stderr.read() == b""


TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


@pytest.fixture
def tetrahedron(tmp_path):
    file = tmp_path / "tetrahedron.obj"
    file.write_text(TETRAHEDRON)
    return file


def tetrahedron_hit(o, d):
    """Nearest (triangle, t, u, v) by Cramer's rule in doubles, or None; and how far from an edge."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    best, margin = None, np.inf
    for k, (a, b, c) in enumerate([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]):
        a, b, c = corners[[a, b, c]]
        t, u, v = np.linalg.solve(np.column_stack([-d, b - a, c - a]), o - a)
        margin = min(margin, abs(u), abs(v), abs(1 - u - v), abs(t))
        if min(t, u, v, 1 - u - v) >= 0 and (best is None or t < best[1]):
            best = (k, t, u, v)
    return best, margin


@pytest.mark.parametrize("how", choices(), ids=lambda how: "-".join(str(w) for w in how[1::2]))
def test_rays_against_the_same_in_doubles(tetrahedron, how):
    rng = np.random.default_rng(6)
    rays = np.hstack([rng.uniform(-1, 2, (400, 3)), rng.normal(size=(400, 3))]).astype(np.float32)
    got = answer("query", "rays", tetrahedron, "-", *how, stdin=csv(rays)).splitlines()
    hit = answer("query", "rays", tetrahedron, "-", "--any", *how, stdin=csv(rays)).splitlines()
    assert len(got) == len(hit) == len(rays)
    sure = 0
    for ray, line, any_hit in zip(rays.astype(float), got, hit):
        expected, margin = tetrahedron_hit(ray[:3], ray[3:])
        assert (line == "miss") == (any_hit == "0")
        if margin < 1e-4:
            continue
        sure += 1
        assert (line == "miss") == (expected is None)
        if expected:
            triangle, *numbers = line.split(",")
            assert int(triangle) == expected[0]
            np.testing.assert_allclose([float(x) for x in numbers], expected[1:], rtol=1e-4, atol=1e-5)
    assert sure > 350 and 20 < sum(h == "1" for h in hit) < 380


@pytest.mark.parametrize(
    "text, said",
    [
        ("0,0,0,0,0,0\n", "standard input:1: the direction dx,dy,dz is zero"),
        ("1,1,1,1,0,0\n1,1,1,1e39,0,0\n", "standard input:2: dx is 1e+39"),
        ("1,1,inf,1,0,0\n", "standard input:1: oz is inf"),
        ("1,1,1,1,0,0,-2\n", "standard input:1: tmax is -2"),
        ("1,1,1,1,0\n", "standard input:1: 5 columns, expected 6 to 7"),
    ],
)
def test_bad_rays_are_named(tetrahedron, text, said):
    assert said in complaint("query", "rays", tetrahedron, "-", stdin=text)


def test_tmax_and_json(tetrahedron):
    stdin = "0.1,0.1,-1,0,0,2\n0.1,0.1,-1,0,0,2,0.25\n"
    answered = json.loads(answer("query", "rays", tetrahedron, "-", "--json", stdin=stdin))
    assert answered["rays"] == 2 and answered["hits"] == 1 and answered["answers"][1] is None
    assert answered["answers"][0]["triangle"] == 0 and answered["answers"][0]["t"] == 0.5
