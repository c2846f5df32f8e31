"""`boxwood record` on a program that knows nothing of it: what it prints stays as it was, and what it asked can be replayed."""

import json
import resource
import signal
import subprocess

import h5py
import pytest
from synthetic import SCRIPTS
from test_boxwood import PROGRAM

USES_FCL = PROGRAM.parent / "bench" / "boxwood_program_of_fcl"
PUBLISHED = SCRIPTS.parent / "results" / "published" / "effects.h5"
MANAGERS = ("dynamic_tree", "dynamic_tree_array", "sap", "ssap", "interval_tree", "naive")
SETUP, COLLIDE_SELF, DISTANCE_SELF = 3, 6, 9  # trees/adapters/recording.h

pytestmark = pytest.mark.skipif(
    not USES_FCL.exists(), reason=f"{USES_FCL} is not here: the build has no FCL, or no tests"
)


def run(*command, **options):
    return subprocess.run([*map(str, command)], capture_output=True, text=True, **{"timeout": 300, **options})


def test_what_it_prints_is_as_without(tmp_path):
    alone = run(USES_FCL, "--a", "b c")
    recorded = run(PROGRAM, "record", "--out", tmp_path / "program.h5", USES_FCL, "--a", "b c")
    assert recorded.returncode == 0, recorded.stderr
    assert recorded.stdout == alone.stdout
    files = sorted(tmp_path.iterdir())
    # Two managers of each kind; the last ones are where others were, or elsewhere.
    assert 2 * len(MANAGERS) <= len(files) <= 2 * len(MANAGERS) + 4
    for file in files:
        assert f"boxwood replay {file}" in recorded.stderr


def test_it_can_be_replayed(tmp_path):
    file = tmp_path / "program.h5"
    recorded = run(PROGRAM, "record", "--out", file, USES_FCL)
    assert recorded.returncode == 0, recorded.stderr
    shown = {line.split()[0]: line.split()[1:] for line in recorded.stdout.splitlines()}
    for i, manager in enumerate(MANAGERS):
        of_manager = file if i == 0 else tmp_path / f"program-{2 * i + 1}.h5"
        replayed = run(PROGRAM, "replay", of_manager, "--rounds", 1, "--json")
        assert replayed.returncode == 0, replayed.stderr
        report = json.loads(replayed.stdout)
        # FCL's array tree and its sweep lose pairs of this program, as the replay tells.
        assert (report["missed"] > 0) == (manager in ("dynamic_tree_array", "sap")), manager
        assert report["queries"] == report["checked"], manager
        assert report["queries"] >= 4, manager
        ours = [one for one in report["managers"] if one["manager"].startswith("boxwood") and not one["shapes"]]
        assert ours and all(one["wrong"] == 0 for one in ours), manager
    with h5py.File(file) as tables:
        calls = tables["calls"]
        own_pairs = calls["shown"][:][calls["call"][:] == COLLIDE_SELF]
    assert own_pairs[0] == int(shown["dynamic_tree"][0])  # those of later managers may follow


def test_calls_of_a_known_class_are_seen(tmp_path):
    recorded = run(PROGRAM, "record", "--out", tmp_path / "a.h5", USES_FCL)
    printed = [line.split() for line in recorded.stdout.splitlines() if line.startswith("direct")]
    assert len(printed) == 2 and printed[0][1:] == printed[1][1:]
    found = 0
    for file in tmp_path.iterdir():
        with h5py.File(file) as tables:
            calls = tables["calls"]
            kinds, shown = list(calls["call"][:]), [int(n) for n in calls["shown"][:]]
        # setup, and then its two queries; the managers may stand where others did, or each other.
        found += sum(kinds[i:i + 3] == [SETUP, COLLIDE_SELF, COLLIDE_SELF + 1] and shown[i + 1:i + 3] == [int(n) for n in printed[0][1:]]
                     for i in range(len(kinds)))
    assert found == 2, printed


def test_queries_of_shapes_by_callbacks_are_known(tmp_path):
    file = tmp_path / "a.h5"
    recorded = run(PROGRAM, "record", "--out", file, USES_FCL)
    printed = next(line.split()[1:] for line in recorded.stdout.splitlines() if line.startswith("dynamic_tree "))
    with h5py.File(file) as tables:
        requests = list(zip(*(tables["requests"][name][:] for name in ("question", "max_contacts", "contacts", "points", "signed"))))
        calls = tables["calls/call"][:]
        rows = [(int(calls[int(call)]), requests[int(request)], int(n), ns)
                for call, request, n, ns in zip(*(tables["request_counts"][name][:] for name in ("call", "request", "n", "ns")))]
    n = len(rows) // (2 if len(rows) > 4 else 1)  # the last manager of this kind may stand where the first one was, and make the same queries
    assert [row[:3] for row in rows[:n]] == [row[:3] for row in rows[-n:]]
    rows = rows[:n]
    touch, far = (0, 4, 1, 0, 0), (1, 0, 0, 0, 0)
    assert sorted(requests) == [touch, far]
    assert [(call, n) for call, request, n, _ in rows if request == touch] == [(COLLIDE_SELF, int(printed[5]))]
    assert [call for call, request, _, _ in rows if request == far] == [DISTANCE_SELF, DISTANCE_SELF + 1, DISTANCE_SELF + 2]
    assert sum(n for _, request, n, _ in rows if request == far) == int(printed[7])
    assert all(ns > 0 for _, _, _, ns in rows)
    shown = run(PROGRAM, "replay", file, "--rounds", 1)
    assert "do they touch, at most 4 contacts" in shown.stdout and "how far apart" in shown.stdout
    assert "which pairs touch, with their contacts" in shown.stdout


def test_threads_are_as_free_as_without(tmp_path):
    recorded = run(PROGRAM, "record", "--out", tmp_path / "a.h5", USES_FCL, timeout=60)  # not ended: one waits for the other
    (crossed,) = (line.split()[1:] for line in recorded.stdout.splitlines() if line.startswith("crossed"))
    shown, inner, others_shown, others_inner = map(int, crossed)
    assert min(shown, inner, others_shown, others_inner) > 0
    found = []
    for file in tmp_path.iterdir():
        with h5py.File(file) as tables:
            calls = tables["calls"]
            kinds, numbers = calls["call"][:], calls["shown"][:]
        own = [i for i, call in enumerate(kinds) if call == COLLIDE_SELF][-1:]
        # After its own last query those that the other's callback made of it while that one ran.
        found += [(numbers[i], sum(numbers[i + 1:])) for i in own if set(kinds[i + 1:]) == {COLLIDE_SELF + 1}]
    assert (shown, others_inner) in found and (others_shown, inner) in found, (crossed, found)


def test_a_full_disk_is_told_and_leaves_the_program_alone(tmp_path):
    alone = run(USES_FCL)
    run(PROGRAM, "record", "--out", tmp_path / "whole.h5", USES_FCL)
    little = (tmp_path / "whole.h5").stat().st_size - 1000  # enough for its begin

    def little_space():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (little, little))

    recorded = run(PROGRAM, "record", "--out", tmp_path / "a.h5", USES_FCL, preexec_fn=little_space)
    assert recorded.stdout == alone.stdout
    assert recorded.returncode == 1  # of the recording, which cannot be read
    assert "cannot be written" in recorded.stderr


def test_the_status_is_the_programs(tmp_path):
    assert run(PROGRAM, "record", "--out", tmp_path / "a.h5", USES_FCL, "--fail").returncode == 7
    assert run(PROGRAM, "record", "--out", tmp_path / "b.h5", USES_FCL, "other").returncode == 3
    assert run(PROGRAM, "record", "--out", tmp_path / "c.h5", tmp_path / "none").returncode == 127
    nothing = run(PROGRAM, "record", "--out", tmp_path / "d.h5", "true")
    assert nothing.returncode == 1
    assert "called no manager" in nothing.stderr


def test_a_result_file_is_told_from_a_recording():
    told = run(PROGRAM, "replay", PUBLISHED)
    assert told.returncode == 2
    assert "effects.h5 is a result file, for `boxwood show`" in told.stderr


def test_half_a_recording_is_not_called_a_result_file(tmp_path):
    whole, half = tmp_path / "a.h5", tmp_path / "b.h5"
    assert run(PROGRAM, "record", "--out", whole, USES_FCL).returncode == 0
    half.write_bytes(whole.read_bytes()[:20_000])
    told = run(PROGRAM, "replay", half)
    assert told.returncode == 2
    assert "b.h5" in told.stderr and "result file" not in told.stderr


def test_bad_usage_is_told(tmp_path):
    there = tmp_path / "there.h5"
    there.write_text("mine")
    for arguments, said in (
        (("--out", there, USES_FCL), "is there already"),
        (("--out", tmp_path / "no" / "a.h5", USES_FCL), "a.h5: cannot be written: No such file or directory"),
        (("--out", "/proc/a.h5", USES_FCL), "/proc/a.h5: cannot be written"),
        ((), "name a program"),
    ):
        told = run(PROGRAM, "record", *arguments)
        assert told.returncode == 2, told.stderr
        assert said in told.stderr
    assert there.read_text() == "mine"
