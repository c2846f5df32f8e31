"""boxwood.results, as a data scientist has it: tables joined, row by row."""

import pytest
from boxwood import results


def test_a_row_per_sample_with_names_joined(full):
    read = results.read(full)
    frame = read.tidy()
    assert len(frame) == len(read["samples"]) > 100
    assert not frame[["cell", "task", "scene", "contender", "library", "phase", "host", "cpu"]].isna().any().any()
    cells = read.table("cells").set_index("cell_id")
    variants, scenes = (read.table(name) for name in ("variants", "scenes"))
    variants, scenes = variants.set_index("variant_id"), scenes.set_index("scene_id")
    for sample, row in list(zip(read["samples"], frame.itertuples()))[:: len(frame) // 50]:
        cell = cells.loc[sample["cell_id"]]
        assert row.cell == cell["name"] and row.wall_ns == sample["wall_ns"] and row.phase == sample["phase"]
        assert row.contender == variants.loc[cell["variant_id"]]["name"]
        assert (row.scene, row.seed) == tuple(scenes.loc[cell["scene_id"]][["name", "seed"]])


def test_tables_by_name(full):
    read = results.read(full)
    assert "compare" in read.names and read.attrs["format"] == "boxwood-results"
    with pytest.raises(KeyError, match="no table 'cell'; there are "):
        read["cell"]
    with pytest.raises(results.BadFile, match="no such file"):
        results.read("nothing.h5")
