"""boxwood choose and explain: bad input is refused before any work, with the name of the file and what to do."""

import shutil

import h5py
import pytest
from test_boxwood import ROOT, answer, boxwood, complaint, pytestmark  # noqa: F401

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


@pytest.fixture
def files(tmp_path):
    (tmp_path / "boxes.csv").write_text("0,0,0,1,1,1\n1,1,1,2,2,2\n3,3,3,4,4,4\n")
    (tmp_path / "mesh.obj").write_text(TETRAHEDRON)
    (tmp_path / "range.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
    (tmp_path / "empty.obj").write_bytes(b"")
    (tmp_path / "binary.obj").write_bytes(bytes(range(256)) * 9)
    shutil.copyfile(ROOT / "results/published/queries.h5", tmp_path / "sweep.h5")  # what boxwood sweep measured
    shutil.copyfile(tmp_path / "sweep.h5", tmp_path / "kept.h5")
    with h5py.File(tmp_path / "kept.h5", "r+") as own:  # as if choose had
        del own["text/argv"]
        own["text/argv"] = "boxwood choose"
    return tmp_path


@pytest.mark.parametrize(
    "arguments, said",
    [
        ((), "one of --mesh FILE, --boxes FILE"),
        (("--mesh", "mesh.obj", "--boxes", "boxes.csv"), "one of --mesh FILE, --boxes FILE"),
        (("--mesh", "absent.obj"), "absent.obj: no such file"),
        (("--mesh", "empty.obj"), "empty.obj: is empty"),
        (("--mesh", "binary.obj"), "binary.obj: holds no triangles"),
        (("--mesh", "range.obj"), "line 4: vertex index 9 is out of range"),
        (("--mesh", "mesh.obj", "--task", "rys"), "did you mean 'rays'"),
        (("--mesh", "mesh.obj", "--queries", "-5"), "--queries -5: a number above 0"),
        (("--mesh", "mesh.obj", "--queries", "nan"), "a number above 0"),
        (("--mesh", "mesh.obj", "--queries", "many"), "--queries"),
        (("--mesh", "mesh.obj", "--minutes", "0"), "--minutes"),
        (("--mesh", "mesh.obj", "--minuts", "1"), "did you mean '--minutes'"),
        (("--boxes", "boxes.csv", "--task", "rays"), "give --mesh FILE"),
        (("--boxes", "boxes.csv", "--task", "moving"), "--task moving is for --scene"),
        (("--boxes", "empty.obj"), "empty.obj: it holds no rows of min_x"),
        (("--scene", "warehous"), "unknown scene 'warehous'; did you mean 'warehouse'?"),
        (("--scene", "absent.toml"), "absent.toml: no such file"),
        (("--scene", "sphere_mesh"), "unknown scene 'sphere_mesh'"),
        (("--motion", "absent.csv"), "absent.csv"),
    ],
)
def test_choose_refuses(files, monkeypatch, arguments, said):
    monkeypatch.chdir(files)
    before = (files / "kept.h5").read_bytes()
    message = complaint_after_progress("choose", *arguments, "--out", "kept.h5")
    assert said in message, message
    assert "/tmp/boxwood-choose" not in message
    assert (files / "kept.h5").read_bytes() == before


def complaint_after_progress(*arguments):
    """The last line of a command that says what it tries first."""
    done = boxwood(*arguments)
    assert done.returncode == 2 and done.stdout == "", (done.returncode, done.stderr)
    return done.stderr.splitlines()[-1]


def test_choose_refuses_an_out_that_cannot_be(files, monkeypatch):
    monkeypatch.chdir(files)
    assert "ends in .h5" in complaint("choose", "--mesh", "mesh.obj", "--out", "a.csv")
    assert "there is no folder" in complaint("choose", "--mesh", "mesh.obj", "--out", "none/a.h5")
    before = (files / "sweep.h5").read_bytes()
    assert "holds what another command measured" in complaint("choose", "--mesh", "mesh.obj", "--out", "sweep.h5")
    assert (files / "sweep.h5").read_bytes() == before


@pytest.mark.parametrize(
    "arguments, said",
    [
        (("pair", 0, 9, "--boxes", "boxes.csv"), "0 and 9 are no two of 3 items"),
        (("pair", 1, 1, "--boxes", "boxes.csv"), "1 and 1 are no two"),
        (("pair", 0, 1), "give --boxes FILE or --mesh FILE"),
        (("pair", 0, 1, "--boxes", "boxes.csv", "--builder", "hilbrt"), "did you mean 'hilbert'"),
        (("pair", 0, 1, "--boxes", "absent.csv"), "absent.csv: no such file"),
        (("ray", "--mesh", "mesh.obj"), "give --ray ox,oy,oz,dx,dy,dz or --rays FILE"),
        (("ray", "--mesh", "mesh.obj", "--ray", "0,0,5,0,0,0"), "the direction is not zero"),
        (("ray", "--mesh", "mesh.obj", "--ray", "0,0,5"), "6 required"),
        (("ray", "--mesh", "range.obj", "--ray", "0,0,5,0,0,-1"), "line 4: vertex index 9"),
        (("ray", "--mesh", "mesh.obj", "--rays", "boxes.csv", 7), "there is no ray 7"),
        (("body", 99, "--scene", "four_link_arm"), "there is no body 99; they are 0 to 3"),
        (("body", 0, "--scene", "four_lnk_arm"), "did you mean 'four_link_arm'"),
    ],
)
def test_explain_refuses(files, monkeypatch, arguments, said):
    monkeypatch.chdir(files)
    message = complaint("explain", *arguments)
    assert said in message, message


def test_explain_says_why_and_draws_it(files, monkeypatch):
    monkeypatch.chdir(files)
    assert "0 and 1 are a pair: their boxes share (1, 1, 1)" in answer("explain", "pair", 0, 1, "--boxes", "boxes.csv")
    said = answer("explain", "pair", 0, 2, "--boxes", "boxes.csv", "--svg", "why.svg")
    assert "are not a pair: their boxes are apart along x by 2" in said and (files / "why.svg").read_text().startswith("<svg")
    assert "The nearest hit: triangle 3 at t = 4.4" in answer("explain", "ray", "--mesh", "mesh.obj", "--ray", "0.2,0.2,5,0,0,-1")
    assert "joint_motion" in answer("explain", "body", 0, "--scene", "four_link_arm", "--frame", 5)
