"""README.md and CONTRIBUTING.md are true: their paths, links, commands, names and example scene."""

import json
import re
import shlex

import pytest
from test_boxwood import PROGRAM, ROOT, answer, boxwood, words

README = (ROOT / "README.md").read_text()
needs_program = pytest.mark.skipif(not PROGRAM.exists(), reason=f"{PROGRAM} is not built")


@pytest.mark.parametrize("document", ["README.md", "CONTRIBUTING.md"])
def test_links_and_paths_exist(document):
    text = re.sub(r"```.*?```", "", (ROOT / document).read_text(), flags=re.S)
    links = [link for link in re.findall(r"\]\(([^)#]+)[^)]*\)", text) if "://" not in link]
    folders = "kernels|trees|scenes|bench|results|python|scripts"
    paths = [path for path in re.findall(rf"`((?:{folders})/[\w./-]*)`", text) if not re.search(r"NAME|FAMILY|halving", path)]
    assert links and paths
    missing = [path for path in links + paths if not (ROOT / path).exists()]
    assert not missing


def commands():
    """The command lines of README.md, without their comments."""
    lines = [line.split(" #")[0].strip() for block in re.findall(r"```sh\n(.*?)```", README, re.S) for line in block.splitlines()]
    return [line.split() for line in lines if line]


@needs_program
def test_commands_and_their_options_exist():
    lines = [line[1:] for line in commands() if line[0] == "build/release/boxwood"]
    assert len(lines) > 10
    for line in lines:
        of_two = line[0] in ("query", "demo") and len(line) > 1
        said = answer(*line[: 2 if of_two else 1], "--help")
        assert all(option in said for option in line if option.startswith("--")), line
    for line in [line for line in commands() if line[0].startswith("./scripts/")]:
        assert (ROOT / line[0]).exists(), line


@needs_program
def test_the_first_lines_run_as_they_stand(tmp_path):
    first = README.split("## The first ten minutes")[1].split("```")[1]
    lines = [shlex.split(line, comments=True)[1:] for line in first.splitlines()[1:] if line]
    assert len(lines) > 14
    used = {path for line in lines for path in line if path.startswith("scenes/examples/")}
    assert used == {str(path.relative_to(ROOT)) for path in (ROOT / "scenes/examples").iterdir()}
    for line in [line for line in lines if line[0] not in ("choose", "check", "doctor")]:  # minutes, or the machine's
        words = [str(ROOT / word) if word in used else word for word in line]
        done = boxwood(*words, cwd=tmp_path)
        assert done.returncode == 0 and len(done.stdout) > 1, (line, done.stderr)


@needs_program
def test_effects_and_queries_of_a_scene_are_all_named():
    moving = README.split("## Scenes that move")[1].split("## ")[0]
    assert set(words("effects")) | set(words("scene_queries")) <= set(re.findall(r"`(\w+)`", moving))
    assert len(words("moving_scenes")) == 18 and "Eighteen scenes" in " ".join(moving.split())
    assert f"{len(words('families'))} families of hard cases" in README
    named = re.findall(r"Policy `(\w+)`", moving)
    assert len(named) == 2 and set(named) <= set(words("updates"))


@needs_program
def test_the_example_scene_is_a_scene(tmp_path):
    (example,) = re.findall(r"```toml\n(.*?)```", README, re.S)
    file = tmp_path / "mine.toml"
    file.write_text(example)
    plan = json.loads(answer("plan", file, "--json"))
    assert plan["bodies"] == 10000
    required = {stage["stage"] for stage in plan["stages"] if stage["required"]}
    assert {"advance_drift", "advance_spin", "pairs"} <= required
    assert boxwood("scene", file, "--frame", "0,30").returncode == 0
