"""Cells of a device: jobs of their own, and one figure that holds them beside processors."""

import synthetic

from boxwood_results import page, registry, run, style
from boxwood.results.reader import load


def test_a_device_is_a_job_of_its_own(full):
    results = run.read(full)
    of = {str(job): {cell.executor for cell in results.of(job)} for job in results.jobs if job.scene == "needles" and job.n == 1000}
    assert of == {"needles 1,000 · pairs · 1 thread": {"serial"}, "needles 1,000 · pairs · 2 threads": {"tbb"},
                  "needles 1,000 · pairs · 16 threads": {"tbb"},
                  "needles 1,000 · pairs · a device, end to end": {"cuda"},
                  "needles 1,000 · pairs · a device, resident": {"cuda_resident"},
                  "needles 1,000 · pairs · a device, by a graph": {"cuda_graph"}}


def test_the_figure_has_the_times_and_the_size_of_the_file(full):
    results = run.read(full)
    made, = registry.draw("device_gains", results).pictures
    rows = [dict(zip(made.columns, row)) for row in made.rows]
    at_least = {row["what"]: row["time_ns"] for row in rows if row["n"] == 1000000}
    assert at_least["resident"] < at_least["end to end"] < at_least["all threads"] < at_least["2 threads"] < at_least["1 thread"]
    assert at_least["resident, by a graph"] < at_least["resident"]
    assert at_least["the device alone"] < at_least["end to end"]
    found, = load(full)["device_break_even"]
    assert {(row["wins_from"], row["loses_to"]) for row in rows} == {(int(found["wins_from"]), int(found["loses_to"]))} == {(100000, 10000)}
    assert any(str(found["words"]) in note for note in made.notes) and "100k" in str(found["words"])
    assert {row["threads"] for row in rows if row["what"] == "all threads"} == {16}
    style.plt.close(made.figure)
    assert "device Test Device 5000, " in page.trust_html(results)


def test_files_of_before_there_were_devices_are_read(tmp_path, small):
    older = tmp_path / "older.h5"
    older.write_bytes(small.read_bytes())
    with synthetic.h5py.File(older, "r+") as file:
        for table in ("device_gains", "device_break_even"):
            del file[table]
        file.attrs["schema_minor"] = synthetic.np.uint32(0)
    results = run.read(older)
    assert results.jobs and "nothing was timed on a device" in registry.draw("device_gains", results).skipped
