"""The sources as they stand, with the core that was built: build/release/python, or that of BOXWOOD_BUILD."""

import os
import sys
from pathlib import Path

import pytest

PYTHON = Path(__file__).resolve().parents[1]
BUILT = Path(os.environ.get("BOXWOOD_BUILD", PYTHON.parent / "build" / "release")) / "python" / "boxwood"
HAS_CORE = any(BUILT.glob("_core*.so"))

if str(PYTHON) not in sys.path:
    sys.path.insert(0, str(PYTHON))
import boxwood  # noqa: E402

boxwood.__path__.append(str(BUILT))


def pytest_collection_modifyitems(items):
    for item in items:
        if not HAS_CORE and PYTHON in item.path.parents:
            item.add_marker(pytest.mark.skip(reason=f"no Python module in {BUILT} (pybind11-dev and python3-dev make one)"))
