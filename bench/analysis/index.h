#pragma once

#include "results/results.h"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace boxwood::bench {

/// The rows of a file by id or name, and what a cell is by them.
class Index {
  public:
    explicit Index(const results::Results& results) : results_(results) {
        for (const results::SceneRow& scene : results.scenes)
            scenes_[scene.scene_id] = &scene;
        for (const results::Variant& variant : results.variants)
            variants_[variant.variant_id] = &variant;
        for (const results::Cell& cell : results.cells)
            cells_[cell.cell_id] = &cell;
        for (const results::TaskRow& task : results.tasks)
            tasks_[task.task] = &task;
        for (const results::KernelRow& row : results.kernels)
            kernels_.insert(row.cell_id);
        for (const results::TreeRow& tree : results.trees)
            if (const auto found = cells_.find(tree.cell_id); found != cells_.end())
                tree_costs_[builder_of(*found->second)] = tree.sah_cost;
    }
    const results::Results& results() const { return results_; }
    const results::Cell& cell(std::uint32_t id) const { return *cells_.at(id); }
    const results::SceneRow& scene(std::uint32_t id) const { return *scenes_.at(id); }
    const results::Variant& variant(const results::Cell& cell) const {
        return *variants_.at(cell.variant_id);
    }
    const results::TaskRow& task(const std::string& name) const {
        const auto found = tasks_.find(name);
        if (found == tasks_.end())
            throw std::runtime_error(fmt::format("the table tasks has no row '{}'", name));
        return *found->second;
    }
    bool is_peer(const results::Cell& cell) const { return variant(cell).is_peer != 0; }
    /// Whether two contenders do the same work in the same phase: not where one keeps no structure,
    /// or has its answers before it is queried, and the other does not.
    bool divide_alike(const results::Cell& a, const results::Cell& b) const {
        const results::Variant &of_a = variant(a), &of_b = variant(b);
        return of_a.keeps_structure == of_b.keeps_structure &&
               of_a.answers_from_cache == of_b.answers_from_cache;
    }
    /// Of a way to play a moving scene, else empty.
    const std::string& stages(const results::Cell& cell) const { return variant(cell).stages; }
    /// The surface-area cost of the tree that a cell's builder makes of its scene; NaN if unknown.
    double tree_cost(const results::Cell& cell) const {
        const auto found = tree_costs_.find(builder_of(cell));
        return found == tree_costs_.end() ? results::missing : found->second;
    }
    /// A kernel on hard cases.
    bool is_kernel(const results::Cell& cell) const { return kernels_.contains(cell.cell_id); }

  private:
    /// Whose tree is measured once a scene: ours by builder, peers' by contender.
    using Builder = std::pair<std::uint32_t, std::string>;
    Builder builder_of(const results::Cell& cell) const {
        const results::Variant& own = variant(cell);
        return {cell.scene_id, own.is_peer ? own.name : own.builder};
    }

    const results::Results& results_;
    std::map<std::uint32_t, const results::SceneRow*> scenes_;
    std::map<std::uint32_t, const results::Variant*> variants_;
    std::map<std::uint32_t, const results::Cell*> cells_;
    std::map<std::string, const results::TaskRow*> tasks_;
    std::set<std::uint32_t> kernels_;
    std::map<Builder, double> tree_costs_;
};

} // namespace boxwood::bench
