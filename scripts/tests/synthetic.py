"""Result files that look like real ones: samples made by formula, analysed by `boxwood merge`."""

import json
import math
import os
import random
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest

from boxwood.results.reader import fnv_1a

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = ROOT / "scripts"
PROGRAM = Path(os.environ.get("BOXWOOD_BUILD", ROOT / "build" / "release")) / "boxwood"
GPU_RATES = {"gpu_copy_gbs": 4300, "gpu_upload_gbs": 52, "gpu_download_gbs": 54, "gpu_upload_pageable_gbs": 11,
             "gpu_download_pageable_gbs": 10, "gpu_launch_ns": 1900}
WORD, NAME, TEXT = "S64", "S160", "S1024"
U4, U8, F8 = "u4", "u8", "f8"
COLUMNS = {
    "env": [("env_id", U4), ("env_hash", WORD), ("host", NAME), ("cpu", NAME), ("ncpu", U4), ("l1d_bytes", U8),
            ("isa_max", WORD), ("isa_used", WORD), ("compiler", NAME), ("git_commit", WORD), ("stream_triad_gbs_1", F8), ("stream_triad_gbs_all", F8),
            ("core_ghz", F8), ("seed", U8), ("gpu", NAME), ("gpu_sm", U4), ("gpu_memory_bytes", U8),
            ("gpu_clock_ghz", F8), ("gpu_driver", WORD), ("gpu_l2_bytes", U8)],
    "packages": [("env_id", U4), ("library", WORD), ("version", WORD), ("build", TEXT), ("present", U4)],
    "scenes": [("scene_id", U4), ("name", NAME), ("generator", WORD), ("n_items", U8), ("seed", U8),
               ("n_frames", U8), ("content_hash", U8), ("params_json", TEXT), ("human_name", NAME)],
    "tasks": [("task", WORD), ("title", NAME), ("total", WORD), ("total_title", NAME)],
    "variants": [("variant_id", U4), ("name", NAME), ("library", WORD), ("library_title", WORD), ("builder", WORD),
                 ("layout", WORD), ("traversal", WORD), ("kernel", WORD), ("is_peer", U4), ("is_reference", U4),
                 ("place", U4), ("is_plain", U4), ("answers_from_cache", U4), ("keeps_structure", U4), ("stages", WORD),
                 ("notes", TEXT)],
    "cells": [("cell_id", U4), ("name", "S320"), ("scene_id", U4), ("variant_id", U4), ("task", WORD), ("class", NAME),
              ("n_items", U8), ("n_queries", U8), ("precision", WORD), ("executor", WORD), ("threads", U4),
              ("isa", WORD), ("iterations", U8)],
    "shards": [("shard_id", U4), ("round", U4), ("env_id", U4), ("pid", U4), ("order_seed", U8), ("t0_utc_ns", U8),
               ("load1", F8), ("steal_ticks", U8), *((name, F8) for name in GPU_RATES)],
    "samples": [("cell_id", U4), ("shard_id", U4), ("round", U4), ("position", U4), ("phase", WORD), ("wall_ns", F8),
                ("cpu_ns", F8), ("iterations", U8), ("nvcsw", U8), ("nivcsw", U8), ("minflt", U8), ("flags", U4)],
    "frames": [("cell_id", U4), ("shard_id", U4), ("round", U4), ("frame", U4), ("update_ns", F8), ("query_ns", F8),
               ("pairs", U8), ("box_tests", U8), ("sah", F8)],
    "effects": [("cell_id", U4), ("shard_id", U4), ("round", U4), ("stage", WORD), ("effect", WORD), ("required", U4),
                ("calls", U8), ("items", U8), ("total_ns", F8), ("bytes", U8)],
    "counters": [("cell_id", U4), ("counter", WORD), ("value", U8)],
    "checks": [("cell_id", U4), ("oracle", WORD), ("status", WORD), ("n_checked", U8), ("n_expected", U8),
               ("n_got", U8), ("missing", U8), ("extra", U8), ("max_ulp", F8), ("witness", TEXT)],
    "kernels": [("cell_id", U4), ("family", WORD), ("panel", WORD), ("task", WORD), ("kernel", WORD),
                ("promise", WORD), ("n", U8), ("ns_per_call", F8), ("false_pos", U8), ("false_neg", U8), ("maybe", U8),
                ("max_ulp", F8), ("max_rel_err", F8), ("bound_violations", U8), ("escalation_rate", F8), ("tier_0", U8),
                ("tier_1", U8), ("tier_2", U8), ("tier_3", U8), ("status", WORD), ("witness", TEXT)],
    "conditions": [("cell_id", U4), ("log10_condition", F8), ("n", U8), ("max_rel_err", F8), ("bound", F8)],
    "trees": [("cell_id", U4), ("n_nodes", U8), ("depth_max", U8), ("bytes", U8), ("sah_cost", F8), ("epo", F8)],
}
# name -> (library, builder, traversal?, build ns per item, query ns per item, box tests per item)
PAIR_CONTENDERS = {
    "binned_sah.wide8": ("boxwood", "binned_sah", 130, 95, 41),
    "binned_sah.binary": ("boxwood", "binned_sah", 120, 190, 44),
    "median.wide8": ("boxwood", "median", 62, 128, 63),
    "median.binary": ("boxwood", "median", 55, 260, 70),
    "incremental.wide8": ("boxwood", "incremental", 900, 110, 50),
    "incremental.binary": ("boxwood", "incremental", 880, 230, 54),
    "fcl.dynamic_aabb_tree": ("fcl", "", 410, 1500, 0),
    "fcl.dynamic_aabb_tree_array": ("fcl", "", 430, 1650, 0),
    "embree.rtc_collide.low": ("embree", "", 60, 480, 0),
    "embree.rtc_collide.medium": ("embree", "", 110, 390, 0),
    "cgal.box_self_intersection_d": ("cgal", "", 1, 700, 0),
    "bullet.dbvt": ("bullet", "", 700, 620, 0),
}
RAY_CONTENDERS = {
    "binned_sah.wide8": ("boxwood", "binned_sah", 150, 1.15, 30),
    "median.wide8": ("boxwood", "median", 70, 1.9, 55),
    "embree.rtc_intersect1.default": ("embree", "", 90, 0.8, 0),
    "embree.rtc_intersect1.robust": ("embree", "", 90, 0.9, 0),
}
DEVICE_TIMES = {  # ns per box and ns of every use, by threads or executor
    1: (210, 0), 2: (110, 4e3), 16: (20, 20e3), "cuda": (7, 220e3), "cuda_resident": (1.1, 40e3), "cuda_graph": (1.1, 15e3),
}
TREE_CONTENDERS = {  # the last: SAH cost / 2.5
    "binned_sah": ("boxwood", "binned_sah", 200, 0, 50),
    "lbvh": ("boxwood", "lbvh", 30, 0, 60),
    "embree.rtc_build_bvh.low": ("embree", "", 100, 0, 61),
}
# contender -> (builder, ns of an update per box moved and per box at rest, ns of a query per box, growth per frame)
POLICIES = {
    "auto": ("auto", 25, 1, 60, 0.001),
    "cached": ("cached", 18, 3, 9, 0.0),
    "merge": ("merge", 24, 4, 62, 0.0),
    "rebuild.trigger0": ("rebuild_trigger0", 50, 50, 58, 0.0),
    "reinsert": ("reinsert", 210, 1, 60, 0.012),
    "fcl.dynamic_aabb_tree.moved": ("", 400, 5, 700, 0.01),
    "bullet.dbvt.margin": ("", 260, 4, 480, 0.02),
    "embree.rtc_collide.low": ("", 60, 60, 390, 0.0),
}
SHARES = (0.01, 0.1, 1.0)
# stage -> (ns of a frame where it is required, ns with all stages, MiB)
STAGES = {
    "warehouse": {"advance_drift": (40e3, 40e3, 1), "advance_teleport": (3e3, 3e3, 0), "move": (0, 90e3, 0),
                  "fit": (12e3, 310e3, 1), "update": (90e3, 260e3, 4), "pairs": (210e3, 400e3, 2), "filter": (4e3, 45e3, 0),
                  "transform": (0, 600e3, 24), "mesh_trees": (0, 210e3, 30), "triangle_pairs": (0, 0, 0), "surface": (0, 0, 0),
                  "rays": (0, 0, 0), "points": (0, 0, 0), "regions": (0, 0, 0), "nearest": (0, 0, 0)},
    "arm_in_clutter": {"advance_joint_motion": (1e3, 1e3, 0), "fit": (2e3, 30e3, 0), "update": (3e3, 20e3, 1),
                       "pairs": (6e3, 25e3, 1), "filter": (1e3, 1e3, 0), "transform": (30e3, 60e3, 2),
                       "mesh_trees": (0, 0, 3), "triangle_pairs": (80e3, 80e3, 1), "rays": (0, 0, 0)},
}
STAGES_OF = {"required": "required", "all_stages": "all"}
# kernel -> (library, promise, ns, wrong share on touching input, share that goes beyond tier 0 there)
TRIANGLE_KERNELS = {
    "moller_f32": ("boxwood", "no promise", 5.1, 0.3, 0),
    "guigue_devillers_f64": ("boxwood", "no promise", 9.4, 0.2, 0),
    "sat_certified": ("boxwood", "never-miss", 71.0, 0.05, 0),
    "guigue_devillers_exact": ("boxwood", "exact", 22.0, 0, 0.14),
    "rational": ("boxwood", "exact", 36000.0, 0, 0),
    "fcl.intersect_triangle": ("fcl", "no promise", 161.0, 0.25, 0),
    "cgal.epick.do_intersect": ("cgal", "no promise", 93.0, 0, 0),
}
DISTANCE_KERNELS = {  # kernel -> (library, promise, ns, error at condition 1, power of the condition)
    "features_f64": ("boxwood", "no promise", 90.0, 1e-16, 2),
    "cross_product_f64": ("boxwood", "no promise", 110.0, 1e-16, 1),
    "certified": ("boxwood", "certified", 160.0, 1e-16, 1),
    "rational": ("boxwood", "exact", 150000.0, 0, 0),
    "fcl.tri_distance": ("fcl", "no promise", 216.0, 1e-16, 2),
}
TASKS = {  # title, and the phase that says what one use costs
    "pairs": ("overlapping pairs", "build+query"), "rays_closest": ("nearest hit", "build+query"),
    "triangle_pairs": ("touching triangles", "build+query"), "build": ("tree build", "build"),
    "moving_pairs": ("moving boxes", "update+query"), "scene_queries": ("a whole scene", "update+query"),
    "triangle_triangle": ("triangle triangle", "query"), "triangle_distance": ("triangle distance", "query"),
}
CASES = {"generic_pairs": "generic", "parallel_planes": "generic", "vertex_on_face": "touching",
         "shared_edge": "touching", "slivers_k6": "degenerate", "zero_area": "degenerate"}


class Maker:
    """Collects rows; `write` gives the file."""

    def __init__(self, rounds, seed=7):
        self.rounds = rounds
        self.random = random.Random(seed)
        self.rows = {name: [] for name in COLUMNS}
        self.ids = {}
        self.texts = {}
        self.rows["env"].append(dict(env_id=0, host="testhost", cpu="Test CPU & <Core> 9", ncpu=2, l1d_bytes=2**64 - 1,
                                     compiler="gcc 12.2.0", isa_max="AVX3", isa_used="AVX2", git_commit="abc", stream_triad_gbs_1=12.5,
                                     stream_triad_gbs_all=20, core_ghz=3, seed=1, gpu="Test Device 5000", gpu_sm=132,
                                     gpu_memory_bytes=80 << 30, gpu_clock_ghz=1.98, gpu_driver="13.0", gpu_l2_bytes=50 << 20))
        for library, version in (("embree", "3.13.5"), ("fcl", "0.7.0"), ("cgal", "5.5.1"), ("bullet", "")):
            self.rows["packages"].append(dict(library=library, version=version, build=f"a package of {library}; what is compiled here: -O2" if version else "",
                                              present=bool(version)))
        for round_ in range(rounds):
            self.rows["shards"].append(dict(shard_id=round_, round=round_, load1=0.3, pid=100 + round_, **GPU_RATES))
        self.rows["tasks"] = [dict(task=task, title=title, total=total, total_title=total.replace("+", " and "))
                              for task, (title, total) in TASKS.items()]
        self.speed = [math.exp(self.random.gauss(0, 0.03)) for _ in range(rounds)]

    def id_of(self, table, key, **row):
        ids = self.ids.setdefault(table, {})
        if key not in ids:
            ids[key] = len(ids)
            self.rows[table].append({**row, table[:-1] + "_id": ids[key]})
        return ids[key]

    def place_of(self, library, builder, registry="builders"):
        """Columns of a variant: where it stands in its registry, here by first use."""
        places = self.ids.setdefault(registry if library == "boxwood" else "peers", {})
        return dict(place=places.setdefault(builder or library, len(places)), is_plain=1)

    def cell(self, scene, n, task, contender, spec, threads, factor=1.0, status="exact", twin=False, queries=0, kernel=""):
        library, builder, build, query, tests = spec
        traversal = {"pairs": "self_pairs", "rays_closest": "rays", "triangle_pairs": "self_pairs", "build": "tree"}[task]
        traversal = traversal if builder else ""
        name = f"{contender}.{traversal or task}" if builder else contender
        name = f"{name}.{kernel}" if kernel else name
        executor = "serial" if threads == 1 else "tbb"
        scene_id = self.id_of("scenes", (scene, n), name=scene, n_items=n, seed=1)
        variant_id = self.id_of("variants", name, name=name, library=library, library_title=library.title(), builder=builder,
                                layout=contender.partition(".")[2] if builder else "", traversal=traversal, kernel=kernel,
                                is_peer=not builder, keeps_structure=library != "cgal",
                                **self.place_of(library, builder), notes="double precision" if library == "fcl" else "")
        full = f"{scene}/n{n}-s1/{task}/{name}/f32/{executor}-{threads}"
        classes = ("watertight batches" if "robust" in name else "batches" if not builder else
                   "batches,watertight batches" if kernel == "watertight" else "batches") if task == "rays_closest" else ""
        cell_id = self.id_of("cells", full, name=full, scene_id=scene_id, variant_id=variant_id, task=task, n_items=n,
                             n_queries=queries, **{"class": classes}, precision="f32", executor=executor, threads=threads)
        gain = threads**0.8
        grow = math.log2(n) / 16
        phases = [("query", query * (queries or n) * grow * factor / gain)] if task != "build" else []
        if build is not None:
            phases.append(("build", build * n * grow / gain))
        for phase, ns in phases:
            self.samples(cell_id, phase, ns, twin)
        self.rows["checks"].append(dict(cell_id=cell_id, oracle="brute_force", status=status, n_checked=n,
                                        n_expected=10, n_got=10 - 2 * (status == "wrong"),
                                        missing=2 * (status == "wrong"),
                                        witness="pair 3,8" if status == "wrong" else ""))
        if task == "build":
            self.rows["trees"].append(dict(cell_id=cell_id, n_nodes=2 * n - 1, sah_cost=tests * 2.5))
        elif builder:
            items = queries or n
            for counter, value in (("box_tests", tests * items), ("node_visits", tests * items // 3), ("pairs", 5 * n)):
                self.rows["counters"].append(dict(cell_id=cell_id, counter=counter, value=value))
            self.rows["trees"].append(dict(cell_id=cell_id, n_nodes=2 * n - 1, depth_max=20, bytes=64 * n,
                                           sah_cost=tests * 2.5, epo=0.1))
        return cell_id

    def device_cells(self, n):
        """Our best on threads and on a device: it wins from where 16 threads take longer than its constant."""
        scene_id = self.id_of("scenes", ("needles", n), name="needles", n_items=n, seed=1)
        name = "hilbert.packed.self_pairs"
        variant_id = self.id_of("variants", name, name=name, library="boxwood", library_title="Boxwood", builder="hilbert",
                                layout="packed", traversal="self_pairs", keeps_structure=1, **self.place_of("boxwood", "hilbert"))
        for where, (each, always) in DEVICE_TIMES.items():
            executor, threads = (where, 1) if isinstance(where, str) else ("tbb" if where > 1 else "serial", where)
            full = f"needles/n{n}-s1/pairs/{name}/f32/{executor}-{threads}"
            of_device = {"cuda": "on a device", "cuda_resident": "resident", "cuda_graph": "resident by a graph"}.get(executor, "")
            cell_id = self.id_of("cells", full, name=full, scene_id=scene_id, variant_id=variant_id, task="pairs", n_items=n,
                                 **{"class": of_device}, precision="f32", executor=executor, threads=threads)
            ns = each * n + always
            phases = {"build": 0.3, "query": 0.7}
            if executor == "cuda":
                phases |= {"upload": 0.2, "device_build": 0.05, "device_query": 0.1, "download": 0.6}
            for phase, share in phases.items():
                self.samples(cell_id, phase, share * ns)
            counts = {"pairs": 5 * n, "box_tests": 41 * n} if not of_device else {
                "pairs": 5 * n, "build_bytes": 213 * n, "build_launches": 12, "query_bytes": 124 * n, "query_launches": 3}
            if executor == "cuda":
                counts |= {"upload_bytes": 24 * n, "query_upload_bytes": 0, "download_bytes": 40 * n}
            self.rows["counters"] += [dict(cell_id=cell_id, counter=name, value=value) for name, value in counts.items()]
            self.rows["checks"].append(dict(cell_id=cell_id, oracle="brute_force", status="exact", n_checked=n,
                                            n_expected=10, n_got=10))

    def moving_cell(self, scene, n, task, contender, builder, update, query, growth=0.0, frames=20, params="", status="exact"):
        """A cell of frames: update and query take so many ns in frame 0, and the query grows."""
        library = "boxwood" if builder else contender.split(".")[0]
        scene_id = self.id_of("scenes", (scene, n), name=scene, n_items=n, seed=1, n_frames=frames, params_json=params)
        variant_id = self.id_of("variants", contender, name=contender, library=library, is_peer=library != "boxwood",
                                builder="" if task == "scene_queries" else builder, keeps_structure=1,
                                answers_from_cache=contender == "cached", **self.place_of(library, builder, "policies"),
                                stages=STAGES_OF.get(contender, contender.removeprefix("required.without_"))
                                if task == "scene_queries" else "")
        full = f"{scene}/n{n}-s1/{task}/{contender}/f32/serial-1"
        cell_id = self.id_of("cells", full, name=full, scene_id=scene_id, variant_id=variant_id, task=task, n_items=n,
                             precision="f32", executor="serial", threads=1)
        middle = 1 + growth * (frames - 1) / 2
        for phase, ns in (("build", 80.0 * n), ("update", update), ("query", query * middle)):
            self.samples(cell_id, phase, ns)
        for round_ in range(self.rounds):
            for frame in range(frames):
                slow = 1 + 0.05 * self.random.random() + 2.0 * (frame % 10 == 7 and contender == "auto")
                self.rows["frames"].append(dict(
                    cell_id=cell_id, shard_id=round_, round=round_, frame=frame, update_ns=update * slow * self.speed[round_],
                    query_ns=query * (1 + growth * frame) * self.speed[round_], pairs=7,
                    **self.frame_counts(task, builder, round_, n, 1 + 2 * growth * frame)))
        self.rows["checks"].append(dict(cell_id=cell_id, oracle="sweep", status=status, n_checked=n, n_expected=n, n_got=n))
        return cell_id

    def frame_counts(self, task, builder, round_, n, grown):
        """What round 0 counts of ours: 40 box tests per item and 200 of a ray, times how far it has grown."""
        if task != "moving_pairs" or not builder or round_:
            return dict(box_tests=2**64 - 1, sah=math.nan)
        return dict(box_tests=round(40 * n * grown), sah=200 * grown)

    def moving(self, n=10000):
        """Every policy on one scene with several shares that move, and two scenes with their queries."""
        for share in SHARES:
            name = "uniform_drift" + ("" if share == 1 else f"_share{share:g}".replace(".", "_"))
            params = json.dumps({"frames_per_second": 30, "groups": [
                {"generator": "uniform", "effects": [{"name": "drift", "share": share, "speed": 1}]}]})
            for contender, (builder, moved, rest, query, growth) in POLICIES.items():
                update = n * (share * moved + (1 - share) * rest)
                self.moving_cell(name, n, "moving_pairs", contender, builder, update, n * query, growth, params=params)
        for scene, stages in STAGES.items():
            effects = [stage.removeprefix("advance_") for stage in stages if stage.startswith("advance_")]
            for contender in ("required", "all_stages", *(f"required.without_{effect}" for effect in effects)):
                all_stages = contender == "all_stages"
                took = {stage: ns[all_stages] for stage, ns in stages.items()}
                if "without" in contender:
                    took["advance_" + contender.split("without_")[1]] = 0
                    took["update"] *= 0.6
                query = sum(took[stage] for stage in ("pairs", "filter", "triangle_pairs") if stage in took)
                cell_id = self.moving_cell(scene, n, "scene_queries", contender, "ours", sum(took.values()) - query, query)
                for round_ in range(self.rounds):
                    self.rows["effects"] += [
                        dict(cell_id=cell_id, shard_id=round_, round=round_, stage=stage, required=ns[0] > 0,
                             effect=stage.partition("advance_")[2],
                             calls=20 * (took[stage] > 0), items=20 * n * (took[stage] > 0),
                             total_ns=20 * took[stage] * self.speed[round_],
                             bytes=(ns[2] << 20) if took[stage] else 0)
                        for stage, ns in stages.items()]

    def samples(self, cell_id, phase, ns, twin=False):
        for round_ in range(self.rounds):
            for flags in (0, 4) if twin else (0,):
                disturbed = self.random.random() < 0.04
                wall = ns * self.speed[round_] * math.exp(self.random.gauss(0, 0.012) + 0.1 * disturbed)
                self.rows["samples"].append(dict(cell_id=cell_id, shard_id=round_, round=round_, phase=phase,
                                                 wall_ns=wall, cpu_ns=wall, iterations=3,
                                                 flags=flags | (2 if disturbed else 0)))

    def kernel(self, cases, task, kernel, library, promise, ns, n=4000, **row):
        """A kernel on a family of hard cases, as its cell, its samples and its row."""
        scene_id = self.id_of("scenes", (cases, n), name=cases, n_items=n, seed=1)
        variant_id = self.id_of("variants", (task, kernel), name=kernel, library=library, kernel=kernel,
                                is_peer=library != "boxwood", keeps_structure=1, **self.place_of(library, ""))
        full = f"{cases}/n{n}-s1/{task}/{kernel}/f64/serial-1"
        cell_id = self.id_of("cells", full, name=full, scene_id=scene_id, variant_id=variant_id, task=task,
                             n_items=n, n_queries=n, precision="f64", executor="serial", threads=1)
        self.samples(cell_id, "query", ns * n)
        wrong = row.get("false_neg", 0) + row.get("false_pos", 0) * (promise != "never-miss")
        self.rows["kernels"].append({**dict(cell_id=cell_id, family=cases.split("_k")[0], panel=CASES[cases],
                                            task=task, kernel=kernel, promise=promise, n=n,
                                            ns_per_call=1.1 * ns, max_ulp=math.nan, max_rel_err=math.nan, tier_0=n,
                                            status="wrong" if wrong else "conservative" if row.get("false_pos") else "exact"), **row})
        return cell_id

    def kernels(self):
        """Two kernel families on all cases."""
        for cases, panel in CASES.items():
            hard = panel != "generic"
            for kernel, (library, promise, ns, share, up) in TRIANGLE_KERNELS.items():
                wrong, tier_1 = round(4000 * share * hard), round(4000 * up * hard)
                self.kernel(cases, "triangle_triangle", kernel, library, promise, ns * (1 + hard * up * 20),
                            false_pos=wrong // 3, false_neg=0 if promise == "never-miss" else wrong - wrong // 3,
                            maybe=9 * hard if kernel == "sat_certified" else 0, tier_0=4000 - tier_1, tier_1=tier_1)
            for kernel, (library, promise, ns, error, power) in DISTANCE_KERNELS.items():
                cell_id = self.kernel(cases, "triangle_distance", kernel, library, promise, ns,
                                      max_rel_err=error * 10.0 ** (power * (6 if hard else 1)))
                for decade in range(7 if hard else 2):
                    self.rows["conditions"].append(dict(
                        cell_id=cell_id, log10_condition=decade, n=500, max_rel_err=error * 10.0 ** (power * decade),
                        bound=4 * error * 10.0 ** (power * decade) if promise == "certified" else math.nan))

    def place_samples(self):
        """A shuffled order per round; a cell's query comes right after its build."""
        for round_ in range(self.rounds):
            rows = [row for row in self.rows["samples"] if row["round"] == round_]
            keys = sorted({(row["cell_id"], row["flags"] & 4) for row in rows})
            self.random.shuffle(keys)
            place = {key: 2 * index for index, key in enumerate(keys)}
            for row in rows:
                row["position"] = place[row["cell_id"], row["flags"] & 4] + (row["phase"] == "query")

    def write(self, path, attrs=(), drop=()):
        """A file as the program writes it; attributes are changed, tables and columns dropped afterwards."""
        self.place_samples()
        raw = path.with_suffix(".raw.h5")
        with h5py.File(raw, "w") as file:
            for name, columns in COLUMNS.items():
                dtype = [(c, h5py.string_dtype("utf-8", int(kind[1:])) if kind[0] == "S" else kind)
                         for c, kind in columns]
                data = np.zeros(len(self.rows[name]), dtype=dtype)
                for index, row in enumerate(self.rows[name]):
                    for column, value in row.items():
                        data[index][column] = value.encode() if isinstance(value, str) else value
                file.create_dataset(name, data=data)
            file["text/argv"] = "boxwood sweep --config x.toml"
            for text, value in self.texts.items():
                file["text/" + text] = value
            file.attrs.update({"format": "boxwood-results", "schema_major": np.uint32(2), "schema_minor": np.uint32(2),
                               "run_uuid": "u", "created_utc": "2025-01-01T00:00:00Z", "sweep_hash": "h",
                               "generator": "synthetic", "complete": np.uint32(1)})
        seal(raw)
        merged(path, raw)
        raw.unlink()
        if not attrs and not drop:
            return path  # with its seal
        with h5py.File(path, "a") as file:
            for key, value in dict(attrs).items():
                file.attrs[key] = value
            for name in drop:
                table, _, column = name.partition(".")
                rows = file[table][:]
                del file[table]
                if column:
                    file[table] = rows[[kept for kept in rows.dtype.names if kept != column]]
        return path


def answer(*arguments):
    """The finished process of the program."""
    if not PROGRAM.exists():
        pytest.skip(f"{PROGRAM} is not built")
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=120)


def seal(path):
    """As results/detail/seal.h has it, behind the data of an HDF5 file."""
    with path.open("rb+") as file:
        file.write(b"boxwseal" + fnv_1a(file.read()).to_bytes(8, "little"))


def merged(path, *parts):
    """Joins files, and derives what the program derives when it writes one."""
    done = answer("merge", *parts, "--out", path)
    assert done.returncode == 0, done.stderr
    return path


def full(rounds=15, wrong=True):
    """A sweep as the default one: sizes, threads, pairs and rays; one wrong peer and one wrong kernel of ours, one unsupported cell."""
    made = Maker(rounds)
    for scene, hard in (("uniform", 1.0), ("clusters", 1.4), ("bars", 2.2)):
        for n in (1000, 3000, 10000, 100000) if scene == "uniform" else (100000,):
            for threads in (1, 2):
                for contender, spec in PAIR_CONTENDERS.items():
                    if threads == 2 and spec[0] in ("fcl", "bullet", "cgal"):
                        continue
                    bad = wrong and scene == "bars" and contender == "bullet.dbvt"
                    twin = scene == "uniform" and n == 10000 and contender == "median.binary" and threads == 1
                    made.cell(scene, n, "pairs", contender, spec, threads, hard, "wrong" if bad else "exact", twin)
    for threads in (1, 2):
        for contender, spec in RAY_CONTENDERS.items():
            for kernel, factor in (("moller_trumbore_f32", 1.0), ("watertight", 1.1)) if spec[1] else (("", 1.0),):
                made.cell("mesh_stanford_bunny_primary", 69451, "rays_closest", contender,
                          (*spec[:3], 1000 * spec[3], spec[4]), threads, factor, queries=100000, kernel=kernel)
    for n in (1000, 10000, 100000, 1000000):
        made.device_cells(n)
    made.moving()
    for contender, spec in TREE_CONTENDERS.items():
        made.cell("uniform", 100000, "build", contender, spec, 1)
    for kernel, factor in (("moller_f32", 1.0), ("guigue_devillers_f64", 1.1), ("guigue_devillers_exact", 1.3)):
        made.cell("triangle_soup", 20000, "triangle_pairs", "median.wide8", PAIR_CONTENDERS["median.wide8"], 1, factor,
                  "wrong" if wrong and kernel == "moller_f32" else "exact", kernel=kernel)
    made.kernels()
    made.id_of("variants", "fcl.dynamic_aabb_tree_2", name="fcl.dynamic_aabb_tree", library="fcl", is_peer=1)
    lost = made.id_of("cells", "lost", name="uniform/n1000-s1/pairs/fcl.dynamic_aabb_tree/f64/serial-2", scene_id=0,
                      variant_id=made.ids["variants"]["fcl.dynamic_aabb_tree"], task="pairs", n_items=1000, threads=2,
                      precision="f64", executor="serial")
    made.rows["checks"].append(dict(cell_id=lost, status="unsupported", witness="FCL's manager runs on one thread"))
    return made


def small(rounds=1, twin=False):
    """One scene, one size, one thread: what a first try gives. twin: the first contender is timed twice."""
    made = Maker(rounds)
    for contender in ("binned_sah.wide8", "median.binary", "fcl.dynamic_aabb_tree", "cgal.box_self_intersection_d"):
        made.cell("uniform", 2000, "pairs", contender, PAIR_CONTENDERS[contender], 1,
                  twin=twin and contender == "binned_sah.wide8")
    return made


def file_of(root, sweep, made, toml=None, **env):
    """Writes what was made as the published file of a sweep below a root."""
    made.rows["env"][0].update({"git_commit": "abcdef012345", **env})
    made.texts["sweep_toml"] = (root / "bench" / "configs" / f"{sweep}.toml").read_text() if toml is None else toml
    return made.write(root / "results" / "published" / f"{sweep}.h5")
