"""Result files of the command `boxwood`: bw.results.read("quick.h5").tidy(). Needs h5py, and tidy() pandas."""

import numpy as np

from .reader import BadFile, load

__all__ = ["BadFile", "Results", "read"]

_CELL = ("name", "task", "class", "n_items", "n_queries", "precision", "executor", "threads", "status")
_SAMPLE = ("phase", "round", "position", "wall_ns", "off_median", "flags")


class Results:
    """One result file: tables as structured arrays, by name. results/README.md lists them and their columns."""

    def __init__(self, tables):
        self._tables = tables

    def __repr__(self):
        return f"<boxwood.results.Results of {self.path}: {len(self['samples'])} samples>"

    @property
    def path(self):
        return self._tables.path

    @property
    def attrs(self):
        """What holds for the whole file: commit, uuid, when it was made ..."""
        return self._tables.attrs

    @property
    def names(self):
        """The names of the tables."""
        return sorted(self._tables.tables)

    def __getitem__(self, name):
        if name not in self._tables.tables:
            raise KeyError(f"no table '{name}'; there are {', '.join(self.names)}")
        return self._tables[name]

    def table(self, name):
        """A table as a pandas DataFrame."""
        import pandas

        rows = self[name]
        return pandas.DataFrame({column: rows[column] for column in rows.dtype.names})

    def tidy(self):
        """A pandas DataFrame with a row per sample, names joined.

        Columns: phase, round, position, wall_ns (nanoseconds), off_median and flags of the sample; cell, task,
        class, n_items, n_queries, precision, executor, threads and status of its cell; scene and seed; contender,
        library, builder and is_peer of what was timed; host and cpu of the machine.
        """
        samples = self["samples"]
        cells = self._rows("cells", "cell_id", samples["cell_id"])
        scenes = self._rows("scenes", "scene_id", cells["scene_id"])
        variants = self._rows("variants", "variant_id", cells["variant_id"])
        machines = self._rows("env", "env_id", self._rows("shards", "shard_id", samples["shard_id"])["env_id"])
        columns = {"cell" if name == "name" else name: cells[name] for name in _CELL}
        columns |= {"scene": scenes["name"], "seed": scenes["seed"], "contender": variants["name"]}
        columns |= {name: variants[name] for name in ("library", "builder", "is_peer")}
        columns |= {name: samples[name] for name in _SAMPLE}
        columns |= {name: machines[name] for name in ("host", "cpu")}
        import pandas

        return pandas.DataFrame(columns)

    def _rows(self, name, column, ids):
        """Of each id its row of the table."""
        rows = self[name]
        order = np.argsort(rows[column])
        return rows[order[np.searchsorted(rows[column][order], ids)]]


def read(path):
    """Reads a result file. Raises BadFile, which says why and what to do, for one that is missing, damaged, foreign or
    of another schema."""
    return Results(load(path))
