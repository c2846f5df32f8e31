"""Result files made once for all tests."""

import subprocess

import pytest
import synthetic
from synthetic import SCRIPTS


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
