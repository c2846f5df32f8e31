"""A result file as tables: the one place that opens HDF5. What it refuses, the program refuses in the same words."""

import math
from dataclasses import dataclass
from pathlib import Path

try:
    import h5py
except ImportError as error:
    raise ImportError("boxwood.results reads files by h5py, which is not installed: pip install h5py pandas") from error
import numpy as np

from .words import FAMILIES, PHASES, REASONS, STATUSES, TOPICS, VERDICTS

SCHEMA_MAJOR = 2
AGAIN = "use another copy, or measure again"
NO_ID, NO_COUNT = 2**32 - 1, 2**64 - 1  # what stands for none in columns of ids and of counts

# The columns that the figures stand on; other columns and tables are skipped.
MEASURED = {
    "env": ("env_id", "host", "cpu", "ncpu"),
    "scenes": ("scene_id", "name", "n_items", "seed", "content_hash"),
    "tasks": ("task", "title", "total", "total_title"),
    "variants": ("variant_id", "name", "library", "builder", "traversal", "kernel", "is_peer", "place",
                 "is_plain", "answers_from_cache", "keeps_structure", "stages", "notes", "library_title"),
    "cells": (
        "cell_id", "name", "scene_id", "variant_id", "task", "n_items", "n_queries", "precision",
        "executor", "threads", "class", "status",
    ),
    "shards": ("shard_id", "round", "env_id", "load1"),
    "samples": ("cell_id", "shard_id", "round", "position", "phase", "wall_ns", "flags", "off_median"),
    "checks": ("cell_id", "status", "n_checked", "missing", "extra", "witness"),
    "packages": ("env_id", "library", "version", "build", "present"),
    "counters": ("cell_id", "counter", "value"),
    "trees": ("cell_id", "sah_cost", "epo", "depth_max", "bytes", "on_front"),
    "kernels": (
        "cell_id", "family", "panel", "task", "kernel", "promise", "n", "false_pos", "false_neg", "maybe", "max_ulp",
        "max_rel_err", "bound_violations", "tier_0", "tier_1", "tier_2", "tier_3", "status", "witness", "is_broken",
        "label", "ns", "wrong", "wrong_per_million", "maybe_per_million",
    ),
    "frames": ("cell_id", "shard_id"),
    "effects": ("cell_id", "shard_id"),
    "conditions": ("cell_id",),
}
# What `boxwood` derived when it wrote the file: nothing of it is derived here.
DERIVED = {
    "medians": (
        "cell_id", "phase", "n", "median_ns", "mad_ns", "min_ns", "p95_ns", "p99_ns", "limit_ns", "times_limit",
    ),
    "compare": (
        "cell_a", "cell_b", "phase", "class", "n_pairs", "ratio", "ci_lo", "ci_hi", "p_adj", "floor", "delta", "family",
        "verdict", "reason", "words",
    ),
    "size_scaling": ("cell_id", "phase", "exponent", "exponent_lo", "exponent_hi", "off_line"),
    "break_even": ("cell_a", "cell_b", "queries"),
    "kernel_costs": (
        "task", "panel", "kernel", "library", "promise", "is_peer", "ns", "n", "wrong", "maybe", "max_rel_err",
        "wrong_per_million", "unexcluded_per_million", "by_error", "badness", "on_front",
    ),
    "topics": ("topic", "title", "question", "together", "alone", "certainty"),
    "findings": (
        "place", "topic", "is_headline", "is_loss", "task", "threads", "class", "question", "together", "alone", "certainty",
        "ours", "rival", "ours_alone", "rival_alone",
    ),
    "health": (
        "rounds", "samples", "disturbed", "floor", "delta", "is_too_noisy", "answers", "wrong_ours", "wrong_peers",
        "broken_promises", "trust", "correctness", "advice",
    ),
    "frame_medians": ("cell_id", "frame", "frame_ns", "query_ns", "over_fresh", "box_tests_per_item", "sah"),
    "frame_stats": (
        "cell_id", "fresh_cell", "n", "p50_ns", "p95_ns", "p99_ns", "max_ns", "over_1_ms", "over_16_6_ms", "degradation",
    ),
    "stage_costs": ("cell_id", "stage", "effect", "required", "calls", "items", "bytes", "ns", "until_ns", "share"),
    "effect_costs": (
        "cell_with", "cell_without", "what", "with_ns", "without_ns", "ratio", "ci_lo", "ci_hi", "extra_ns",
    ),
    "kernel_conditions": (
        "task", "kernel", "library", "promise", "is_peer", "log10_condition", "n", "max_rel_err", "bound",
    ),
    "escalations": ("cell_id", "task", "kernel", "share_0", "share_1", "share_2", "share_3"),
    "query_kernels": ("cell_id", "group", "tree", "times_fastest"),
    "work": ("cell_id", "node_visits", "box_tests", "query_ns"),
    "drift": ("shard_id", "n", "disturbed", "off_median", "is_farthest"),
    "device_gains": (
        "scene_id", "task", "n", "cpu_1_ns", "cpu_2_ns", "cpu_all_ns", "threads", "end_to_end_ns", "resident_ns",
        "graph_ns", "device_ns", "limit_ns", "cell_1", "cell_2", "cell_all", "cell_cpu", "cell_device", "cell_resident", "cell_graph", "ratio", "verdict",
    ),
    "device_break_even": ("scene_id", "task", "wins_from", "loses_to", "words", "cell_cpu", "cell_device"),
}
SINCE = {"device_gains": 2, "device_break_even": 2}  # minor versions; of older files they are taken as empty
DERIVED_COLUMNS = {  # in tables that are measured
    "cells.status", "samples.off_median", "trees.on_front", "kernels.is_broken", "kernels.label", "kernels.ns",
    "kernels.wrong", "kernels.wrong_per_million", "kernels.maybe_per_million",
}
# Columns of ids, wherever they stand, and whose they are; results/schema.h has the same.
REFERENCES = {
    "env_id": "env", "scene_id": "scenes", "variant_id": "variants", "cell_id": "cells", "shard_id": "shards",
    "cell_a": "cells", "cell_b": "cells", "ours": "cells", "rival": "cells", "ours_alone": "cells",
    "rival_alone": "cells", "fresh_cell": "cells", "cell_with": "cells", "cell_without": "cells", "cell_1": "cells",
    "cell_2": "cells", "cell_all": "cells", "cell_device": "cells", "cell_resident": "cells",
    "cell_graph": "cells", "cell_cpu": "cells",
}
# Columns of few words, by name, and what they may hold.
WORDS = {"phase": PHASES, "status": STATUSES, "verdict": VERDICTS, "reason": REASONS, "topic": TOPICS}
WORDS_OF_ONE = {("compare", "family"): FAMILIES}


class BadFile(Exception):
    """The file cannot be read as a result file; the message says which, why, and what to do."""

    def __init__(self, path, cause):
        super().__init__(f"cannot read result file '{path}': {cause}")


@dataclass
class Tables:
    """One result file. Tables are structured arrays with text as str."""

    path: Path
    attrs: dict
    texts: dict
    tables: dict
    is_sealed: bool  # else another program changed the file after it was written

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


def fnv_1a(data):
    fnv = 0xCBF29CE484222325
    for byte in data:
        fnv = (fnv ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return fnv


def is_sealed(path):
    """Whether the seal behind the HDF5 data fits, as results/detail/seal.h has it; a program that changes the file
    drops the seal. Raises BadFile for a seal that does not fit."""
    data = path.read_bytes()
    if not data:
        raise BadFile(path, "the file is empty")
    body, mark, seal = data[:-16], data[-16:-8], data[-8:]
    if mark != b"boxwseal":
        return False
    if fnv_1a(body) != int.from_bytes(seal, "little"):
        raise BadFile(path, "it is damaged: its content is not what was written (checksum); use another copy")
    return True


def read_table(file, path, name, columns, minor):
    def remedy(is_derived):
        return f"`boxwood merge {path} --out NEW.h5` derives it" if is_derived else AGAIN

    if name not in file and minor < SINCE.get(name, 0):
        return np.zeros(0, dtype=[(column, object) for column in columns])
    if name not in file:
        raise BadFile(path, f"table {name} is missing; {remedy(name in DERIVED)}")
    fields = file[name].dtype.fields or {}
    for column in columns:
        if column not in fields:
            is_derived = name in DERIVED or f"{name}.{column}" in DERIVED_COLUMNS
            raise BadFile(path, f"column {name}.{column} is missing; {remedy(is_derived)}")
    try:
        return with_text(file[name][:])
    except OSError as error:
        raise BadFile(path, f"table {name}: {error}; {AGAIN}") from error


def check_words(path, name, table):
    for column in table.dtype.names:
        known = WORDS.get(column) or WORDS_OF_ONE.get((name, column))
        for word in dict.fromkeys(table[column]) if known else ():
            if word not in known:
                raise BadFile(path, f'column {name}.{column} holds the unknown word "{word}"; {AGAIN}')


def check_ids(path, tables):
    """Every id names a row, and one alone; of what is derived it may name none."""
    ids = {target: np.array([]) for target in REFERENCES.values()}
    for column, target in REFERENCES.items():
        if column in tables[target].dtype.names and column == tables[target].dtype.names[0]:
            ids[target], counts = np.unique(tables[target][column], return_counts=True)
            for twice in ids[target][counts > 1]:
                raise BadFile(path, f"column {target}.{column} holds {twice}, which stands there twice; {AGAIN}")
    for name, table in tables.items():
        for column in [column for column in table.dtype.names if column in REFERENCES]:
            target = REFERENCES[column]
            known = np.isin(table[column], ids[target])
            if name in DERIVED:
                known |= table[column] == NO_ID
            for stray in table[column][~known]:
                raise BadFile(path, f"column {name}.{column} holds {stray}, which no row of {target} has; {AGAIN}")


def check_times(path, samples):
    """NaN stands for a time that is missing."""
    for row in np.flatnonzero((samples["wall_ns"] <= 0) | np.isinf(samples["wall_ns"]))[:1]:
        wall_ns = f"{samples['wall_ns'][row]:g}"
        raise BadFile(path, f"column samples.wall_ns holds {wall_ns} in row {row}, which is no time; {AGAIN}")


def check_header(path, attrs):
    if as_text(attrs.get("format", "")) != "boxwood-results":
        raise BadFile(path, 'an HDF5 file, but not a Boxwood result file (no attribute format="boxwood-results")')
    major = int(attrs.get("schema_major", -1))
    if major != SCHEMA_MAJOR:
        raise BadFile(path, f"it is of schema {major}, and this program reads schema {SCHEMA_MAJOR}; measure again with "
                            "this version")
    if not attrs.get("complete", 0):
        raise BadFile(path, "it is incomplete: its writer did not finish")


def load(path):
    """Reads a whole result file. Raises BadFile for one that is missing, damaged, foreign, incomplete, of another major
    version, or without what the figures need; and for words and ids that mean nothing."""
    path = Path(path)
    if path.exists() and not path.is_file():
        raise BadFile(path, "that is no file of results, which scripts/sweep --quick makes")
    if not path.exists():
        raise BadFile(path, "no such file; scripts/sweep --quick makes one")
    try:
        return load_tables(path)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise BadFile(path, f"damaged, or made by something else: {type(error).__name__}: {error}; {AGAIN}") from error


def load_tables(path):
    """As load, but for damage that h5py and numpy say in their own ways."""
    sealed = is_sealed(path)
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        raise BadFile(path, f"not a readable HDF5 file: {error}; {AGAIN}") from error
    with file:
        attrs = {key: as_text(value) for key, value in file.attrs.items()}
        check_header(path, attrs)
        minor = attrs.get("schema_minor", math.inf)  # one that does not say it is taken for the newest
        tables = {name: read_table(file, path, name, columns, minor) for name, columns in {**MEASURED, **DERIVED}.items()}
        for name, table in tables.items():
            check_words(path, name, table)
        check_ids(path, tables)
        check_times(path, tables["samples"])
        if len(tables["health"]) != 1:
            raise BadFile(path, f"not analysed; `boxwood merge {path} --out NEW.h5` does that")
        texts = {name: as_text(text[()]) for name, text in file.get("text", {}).items()}
    return Tables(path, attrs, texts, tables, sealed)
