"""Is a result file whole? Tables filled, times finite, every answer of ours right."""

import sys

import h5py
import numpy as np


def problems(file):
    for table in ("env", "scenes", "variants", "cells", "shards", "samples", "checks"):
        if table not in file or len(file[table]) == 0:
            yield f"table {table} is missing or empty"
            return
    samples, cells, checks = file["samples"][:], file["cells"][:], file["checks"][:]
    for column in ("wall_ns", "cpu_ns"):
        bad = np.flatnonzero(~np.isfinite(samples[column]))
        if len(bad):
            yield f"{len(bad)} samples have no finite {column}; the first is row {bad[0]}"
    library = {row["variant_id"]: row["library"].decode() for row in file["variants"][:]}
    cell = {row["cell_id"]: row for row in cells}
    for check in checks:
        row = cell[check["cell_id"]]
        if check["status"] == b"wrong" and library[row["variant_id"]] == "boxwood":
            yield f"{row['name'].decode()} is wrong: {check['witness'].decode()}"
    unchecked = set(samples["cell_id"]) - set(checks["cell_id"])
    if unchecked:
        yield f"{len(unchecked)} timed cells were never checked"


with h5py.File(sys.argv[1], "r") as file:
    found = list(problems(file))
    for problem in found:
        print(f"check_result: {problem}", file=sys.stderr)
    if not found:
        print(f"check_result: {len(file['cells'])} cells, {len(file['samples'])} samples: all is well")
sys.exit(1 if found else 0)
