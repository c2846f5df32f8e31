"""A result file as tables: the one place that opens HDF5."""

from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

SCHEMA_MAJOR = 2
REMEDY = "run the sweep again (it keeps its finished rounds)"

# The columns that the figures stand on; other columns and tables are skipped.
REQUIRED = {
    "env": ("env_id", "host", "cpu", "ncpu"),
    "scenes": ("scene_id", "name", "n_items", "seed"),
    "tasks": ("task", "title", "total"),
    "variants": ("variant_id", "name", "library", "builder", "traversal", "kernel", "keeps_structure", "stages", "notes"),
    "cells": (
        "cell_id", "name", "scene_id", "variant_id", "task", "n_items", "n_queries", "precision",
        "executor", "threads", "class", "status",
    ),
    "shards": ("shard_id", "round", "env_id", "load1"),
    "samples": ("cell_id", "shard_id", "round", "position", "phase", "wall_ns", "flags"),
    "checks": ("cell_id", "status", "n_checked", "missing", "extra", "witness"),
    "packages": ("env_id", "library", "version", "build", "present"),
    "counters": ("cell_id", "counter", "value"),
    "trees": ("cell_id", "sah_cost", "epo", "depth_max", "bytes"),
    "kernels": (
        "cell_id", "family", "panel", "task", "kernel", "promise", "n", "ns_per_call", "false_pos",
        "false_neg", "maybe", "max_ulp", "max_rel_err", "bound_violations", "tier_0", "tier_1", "tier_2",
        "tier_3", "status", "witness", "is_broken",
    ),
    "frames": ("cell_id", "shard_id", "frame", "update_ns", "query_ns", "box_tests", "sah"),
    "effects": ("cell_id", "shard_id", "stage", "required", "calls", "items", "total_ns", "bytes"),
    "conditions": ("cell_id", "log10_condition", "n", "max_rel_err", "bound"),
    # What `boxwood` derived when it wrote the file: nothing of it is derived here.
    "medians": ("cell_id", "phase", "n", "median_ns", "mad_ns", "min_ns", "p95_ns", "p99_ns", "limit_ns"),
    "compare": (
        "cell_a", "cell_b", "phase", "class", "n_pairs", "ratio", "ci_lo", "ci_hi", "p_adj", "floor", "delta", "family",
        "verdict", "reason", "words",
    ),
    "size_scaling": ("cell_id", "phase", "exponent", "exponent_lo", "exponent_hi", "off_line"),
    "break_even": ("cell_a", "cell_b", "queries"),
    "kernel_costs": (
        "task", "panel", "kernel", "library", "promise", "is_peer", "ns", "n", "wrong", "maybe", "max_rel_err",
    ),
    "topics": ("topic", "title", "question", "together", "alone", "certainty"),
    "findings": (
        "place", "topic", "is_headline", "task", "threads", "class", "question", "together", "alone", "certainty",
        "ours", "rival", "ours_alone", "rival_alone",
    ),
    "health": (
        "rounds", "samples", "disturbed", "floor", "delta", "is_too_noisy", "answers", "wrong_ours", "wrong_peers",
        "broken_promises", "trust", "correctness", "advice",
    ),
}


class BadFile(Exception):
    """The file cannot be read as a result file; the message says which, why, and what to do."""


@dataclass
class Tables:
    """One result file. Tables are structured arrays with text as str."""

    path: Path
    attrs: dict
    texts: dict
    tables: dict

    def __getitem__(self, name):
        return self.tables[name]


def as_text(value):
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else value


def with_text(array):
    """The same table with its byte strings decoded."""
    kinds = [
        (name, object if kind[0].kind == "S" or kind[0].hasobject else kind[0])
        for name, kind in array.dtype.fields.items()
    ]
    decoded = np.empty(array.shape, dtype=kinds)
    for name, kind in kinds:
        decoded[name] = [as_text(v) for v in array[name]] if kind is object else array[name]
    return decoded


def read_table(file, path, name, columns):
    dataset = file[name]
    fields = dataset.dtype.fields or {}
    absent = [column for column in columns if column not in fields]
    if absent:
        raise BadFile(f"{path}: table '{name}' has no column '{absent[0]}'; {REMEDY}")
    try:
        return with_text(dataset[:])
    except OSError as error:
        raise BadFile(f"{path}: table '{name}' is damaged ({error}); {REMEDY}") from error


def check_header(path, attrs):
    if as_text(attrs.get("format", "")) != "boxwood-results":
        raise BadFile(f"{path}: an HDF5 file, but not a Boxwood result file (no format attribute)")
    major = int(attrs.get("schema_major", -1))
    if major != SCHEMA_MAJOR:
        raise BadFile(
            f"{path}: of schema {major}, and these scripts read schema {SCHEMA_MAJOR}; "
            "measure again with this version"
        )
    if not attrs.get("complete", 0):
        raise BadFile(f"{path}: incomplete: it is still being written, or the writer was killed; {REMEDY}")


def load(path):
    """Reads a whole result file. Raises BadFile for one that is missing, cut off, foreign, incomplete,
    of another major version, or without a table that the figures need."""
    path = Path(path)
    if not path.is_file():
        raise BadFile(f"{path}: no such file; scripts/sweep --quick makes one")
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        raise BadFile(f"{path}: cannot be read as HDF5, perhaps cut off ({error}); {REMEDY}") from error
    with file:
        attrs = {key: as_text(value) for key, value in file.attrs.items()}
        check_header(path, attrs)
        tables = {}
        for name, columns in REQUIRED.items():
            if name not in file:
                raise BadFile(f"{path}: table '{name}' is missing; {REMEDY}")
            tables[name] = read_table(file, path, name, columns)
        if len(tables["health"]) != 1:
            raise BadFile(f"{path}: not analysed; boxwood merge {path} --out NEW.h5 does that")
        texts = {name: as_text(text[()]) for name, text in file.get("text", {}).items()}
    return Tables(path, attrs, texts, tables)
