"""Derived tables of a published file, held against what `boxwood merge` derives today from what the file measured."""

import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from .checkout import PROGRAM
from boxwood.results.reader import DERIVED, DERIVED_COLUMNS, BadFile, load

ROOT = Path(__file__).resolve().parents[2]
NEAR = 1e-9  # of numbers: libraries of other machines round exp and log otherwise


def program():
    """Of this checkout, or of the build folder that BOXWOOD_BUILD names; None if none is built."""
    build = os.environ.get("BOXWOOD_BUILD")
    file = Path(build) / Path(PROGRAM).name if build else ROOT / PROGRAM
    return file if file.is_file() else None


def derived_again(file):
    with tempfile.TemporaryDirectory() as folder:
        again = Path(folder) / file.name
        done = subprocess.run([program(), "merge", file, "--out", again], capture_output=True, text=True, check=False)
        if done.returncode:
            raise BadFile(file, f"boxwood merge: {done.stderr.strip()}")
        return load(again)


def is_alike(a, b):
    if len(a) != len(b):
        return False
    if a.dtype.kind == "f":
        return np.allclose(a, b, rtol=NEAR, atol=0, equal_nan=True)
    return bool(np.all(a == b))


def differences(file, source):
    """Columns of a file's derived tables that it does not have from its measured ones, as texts. Without a program nothing is known."""
    if not program():
        return []
    try:
        again = derived_again(file)
    except (BadFile, OSError) as error:
        return [f"{program()} does not derive it again: {error}"]
    columns = [(table, column) for table in DERIVED for column in again[table].dtype.names if column in (source[table].dtype.names or ())]
    columns += [tuple(name.split(".")) for name in DERIVED_COLUMNS if name.split(".")[1] in source[name.split(".")[0]].dtype.names]
    return [f"/{table}, {column}: not what `{program()} merge` derives" for table, column in sorted(columns)
            if not is_alike(source[table][column], again[table][column])]
