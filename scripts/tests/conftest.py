"""Result files made once for all tests."""

import re
import shutil
import subprocess

import pytest
import synthetic
from synthetic import SCRIPTS

from boxwood_results import published


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("results")


@pytest.fixture(scope="session")
def full(folder):
    """15 rounds of all kinds of cells."""
    return synthetic.full().write(folder / "full.h5")


@pytest.fixture(scope="session")
def small(folder):
    """One round of one job."""
    return synthetic.small().write(folder / "small.h5")


@pytest.fixture(scope="session")
def script():
    """script(name, *args): runs one of scripts/; gives the finished process."""

    def run(name, *arguments, **options):
        return subprocess.run(
            [SCRIPTS / name, *map(str, arguments)], capture_output=True, text=True, timeout=120, **options
        )

    return run


@pytest.fixture
def root(tmp_path):
    """A repository of which README is all that was published."""
    shutil.copytree(SCRIPTS.parent / "bench" / "configs", tmp_path / "bench" / "configs")
    shutil.copytree(SCRIPTS.parent / "results" / "published", tmp_path / "results" / "published", ignore=shutil.ignore_patterns("*.[!t]*"))  # marks.toml
    for page in published.PAGES:
        text = re.sub(r"(<!-- published: \w+ -->\n).*?(<!-- /published)", r"\1\2", (SCRIPTS.parent / page).read_text(), flags=re.S)
        (tmp_path / page).write_text(text)
    return tmp_path
