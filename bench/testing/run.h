#pragma once

#include "bench/running/record.h"
#include "results/results.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>

namespace boxwood::bench {

/// A result file made up cell by cell, for tests of what is said about one.
struct RunForTest {
    results::Results results;
    std::uint32_t rounds = 9;

    RunForTest() {
        results.env.resize(1);
        results.env[0].stream_triad_gbs_1 = results.env[0].stream_triad_gbs_all = 1;
        results.env[0].core_ghz = 1;
        results.shards.resize(1);
    }

    /// Of a scene with n items and a variant, both made where they are new; right when checked.
    std::uint32_t cell(const std::string& scene, std::uint64_t n, const std::string& task,
                       const std::string& variant, std::uint32_t threads = 1) {
        results::Cell cell;
        cell.cell_id = static_cast<std::uint32_t>(results.cells.size());
        cell.name = scene + "/" + variant;
        cell.scene_id = scene_id(scene, n);
        cell.variant_id = variant_id(variant);
        cell.task = task;
        if (std::ranges::find(results.tasks, task, &results::TaskRow::task) == results.tasks.end())
            results.tasks.push_back(task_row(*find_task(task)));
        cell.n_items = n;
        cell.executor = std::string(default_executor(threads));
        cell.threads = threads;
        results.cells.push_back(cell);
        results::Check check;
        check.cell_id = cell.cell_id;
        check.status = results::Status::exact;
        results.checks.push_back(check);
        return cell.cell_id;
    }

    void time(std::uint32_t cell, results::Phase phase,
              const std::function<double(std::uint32_t round)>& ns) {
        for (std::uint32_t round = 0; round < rounds; ++round) {
            results::Sample sample;
            sample.cell_id = cell;
            sample.round = round;
            sample.phase = phase;
            sample.wall_ns = ns(round);
            results.samples.push_back(sample);
        }
    }
    void time(std::uint32_t cell, results::Phase phase, double ns) {
        time(cell, phase, [ns](std::uint32_t) { return ns; });
    }

    results::Variant& variant_of(std::uint32_t cell) {
        return results.variants[results.cells[cell].variant_id];
    }

  private:
    std::uint32_t scene_id(const std::string& name, std::uint64_t n) {
        for (const auto& scene : results.scenes)
            if (scene.name == name && scene.n_items == n)
                return scene.scene_id;
        results::SceneRow row;
        row.scene_id = static_cast<std::uint32_t>(results.scenes.size());
        row.name = name;
        row.generator = name.substr(0, name.find('_'));
        row.n_items = n;
        results.scenes.push_back(row);
        return row.scene_id;
    }
    /// "fcl.tree" is a peer of the library fcl; of ours "median.wide8.rays.watertight" names
    /// builder, layout, traversal and kernel, and "required",
    /// "all_stages" and "required.without_drift" are ways to play a scene.
    std::uint32_t variant_id(const std::string& name) {
        for (const auto& variant : results.variants)
            if (variant.name == name)
                return variant.variant_id;
        results::Variant row;
        row.variant_id = static_cast<std::uint32_t>(results.variants.size());
        row.name = name;
        std::string words = name + ".";
        const auto next = [&] {
            const std::string word = words.substr(0, words.find('.'));
            words.erase(0, words.find('.') + 1);
            return word;
        };
        const std::string first = next();
        row.is_peer = first == "fcl" || first == "embree" || first == "bullet";
        row.library = row.is_peer ? first : "boxwood";
        row.library_title = first == "fcl" ? "FCL" : first == "embree" ? "Embree" : "Bullet";
        if (!row.is_peer) {
            row.builder = first;
            row.is_reference = first == "hilbert";
            row.layout = next();
            row.traversal = next();
            row.kernel = next();
        }
        const std::string left_out = "required.without_";
        if (name == "required" || name == "all_stages")
            row.stages = name == "required" ? results::required_stages : results::all_stages;
        else if (name.starts_with(left_out))
            row.stages = name.substr(left_out.size());
        results.variants.push_back(row);
        return row.variant_id;
    }
};

} // namespace boxwood::bench
