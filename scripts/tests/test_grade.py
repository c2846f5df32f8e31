"""boxwood grade: the same tree as CSV and as HDF5 in its forms; what is no tree is refused with its file and row."""

import json

import h5py
import numpy as np
import pandas
import pytest
from test_boxwood import answer, complaint, pytestmark  # noqa: F401

COLUMNS = ["node", "parent", "item", "min_x", "min_y", "min_z", "max_x", "max_y", "max_z"]
ROWS = [
    [0, -1, -1, 0, 0, 0, 4, 1, 1],
    [1, 0, -1, 0, 0, 0, 1, 1, 1],
    [-1, 1, 0, 0, 0, 0, 1, 1, 1],
    [-1, 0, 1, 3, 0, 0, 4, 1, 1],
]


def structured(rows):
    kinds = np.dtype([(name, "i8" if i < 3 else "f4") for i, name in enumerate(COLUMNS)])
    return np.array([tuple(row) for row in rows], kinds)


def write(file, rows, form):
    frame = pandas.DataFrame(rows, columns=COLUMNS)
    if form == "csv":
        np.savetxt(file, rows, "%g", ",")
    elif form == "pandas":
        frame.to_hdf(file, key="nodes", format="table", data_columns=True)
    elif form == "pandas without names":
        frame.astype(float).to_hdf(file, key="nodes", format="table")
    else:
        with h5py.File(file, "w") as out:
            if form == "compound":
                out["nodes"] = structured(rows)
            for name in COLUMNS if form == "group" else ():
                out[f"nodes/{name}"] = frame[name].to_numpy()


def test_every_form_says_the_same(tmp_path):
    said = {}
    for form in ("csv", "compound", "group", "pandas"):
        file = tmp_path / f"{form}.{'csv' if form == 'csv' else 'h5'}"
        write(file, ROWS, form)
        grade = json.loads(answer("grade", file, "--json"))
        assert grade["items"] == 2 and grade["trees"][0]["nodes"] == 2
        grade["trees"][0]["name"] = "theirs"
        said[form] = grade
    assert said["csv"] == said["compound"] == said["group"] == said["pandas"]


def changed(at, column, value):
    rows = [row[:] for row in ROWS]
    rows[at][COLUMNS.index(column)] = value
    return rows


@pytest.mark.parametrize(
    "rows, said",
    [
        (changed(1, "node", 0), "node 0 has two rows, rows 0 and 1"),
        (changed(3, "item", 0), "item 0 has two rows, rows 2 and 3"),
        (changed(2, "parent", 7), "there is no node 7, the parent of item 0 (row 2)"),
        (changed(2, "max_x", np.nan), "row 2 of nodes: coordinates must be numbers"),
        (changed(3, "min_x", 5), "row 3 of nodes: min 5 is above max 4"),
        (changed(0, "item", 3), "row 0 of nodes: a row is of a node, with item -1"),
        (changed(0, "parent", -2), "row 0 of nodes: parent is a whole number from 0 to below 2^53, or -1; -2 is none"),
        ([], "table nodes has no rows"),
    ],
)
def test_what_is_no_tree_names_its_row(tmp_path, rows, said):
    file = tmp_path / "theirs.h5"
    write(file, rows, "compound")
    message = complaint("grade", file)
    assert str(file) in message and said in message, message


def test_other_files_are_refused(tmp_path):
    file = tmp_path / "a.h5"
    for write_it, said in (
        (lambda: None, "no such file"),
        (lambda: file.write_bytes(b""), "empty"),
        (lambda: file.write_bytes(b"\x89HD"), "not an HDF5 file"),
        (lambda: write(file, ROWS, "compound"), "it has no table tree; it has nodes"),
        (lambda: write(file, ROWS, "pandas without names"), ""),
    ):
        write_it()
        message = complaint("grade", file, "--table", "tree")
        assert str(file) in message and said in message, message
    message = complaint("grade", file)
    assert "no column node" in message and "data_columns=True" in message, message
    csv = tmp_path / "a.csv"
    np.savetxt(csv, changed(1, "node", 0), "%g", ",", header="a tree")
    assert "node 0 has two rows, lines 2 and 3" in complaint("grade", csv)
