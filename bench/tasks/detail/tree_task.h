#pragma once

#include "bench/plan/block_reader.h"
#include "bench/tasks/task.h"
#include "trees/layout.h"

#include <functional>
#include <string>
#include <vector>

namespace boxwood::bench {

/// "binned_sah_bins16": [a-z0-9_] alone, so 1.5 is written 1_5, a minus m and a plus _.
std::string name_with_settings(std::string text, const Settings& settings);
/// As one JSON object.
std::string settings_json(const Settings& settings);

/// The builder that a choice names, with or without an optimizer behind it. Throws
/// std::invalid_argument, with a suggestion, for an unknown one.
const BuilderEntry& builder_of(const Choice& choice);

/// What a contender of ours has of its builder and settings alone.
ContenderEntry entry_of_ours(const BuilderEntry& builder, const Choice& choice);

/// Adds the cells of ours wherever the block says, and those of peers on its threads.
void add_cells(const BlockReader& block, const SceneSpec& scene,
               const std::vector<ContenderEntry>& ours, const std::vector<ContenderEntry>& peers,
               AddCell add);

/// A task on a scene that stands still, which every builder and layout of ours answers by the
/// contender "<builder>[_<setting><value>...].<layout>.<traversal>[.<kernel>]".
class TreeTask : public Task {
  public:
    std::vector<std::string_view> keys() const override;
    SceneKind scenes() const override { return SceneKind::still; }
    void expand(const BlockReader& block, AddCell add) const override;
    ContenderEntry contender(const Choice& choice) const override;
    std::optional<std::string> missing(const Scene& scene) const override;

  protected:
    /// What follows builder and layout.
    struct Way {
        std::string_view traversal;
        std::string kernel{};
        Promise promise = Promise::none;
        using Make = std::function<std::unique_ptr<Contender>(const Job&, BuildFunction,
                                                              const LayoutEntry&)>;
        Make make;
        std::optional<Query> query{}; ///< what a layout must answer for it
        std::vector<std::string> classes{};
        Answering::Make make_on_device{}; ///< null if it has no form for a device
        Answering::Make make_by_graph{};  ///< or for a graph
        std::string why_not_on_device{};  ///< if there is a reason to tell
        Make make_by_front_door{}; ///< by Bvh or MeshBvh, where the task has the key front_door
        std::function<std::optional<std::string>(const Scene&)> cannot{}; ///< why, if so
    };
    virtual Way way(const Choice& choice) const = 0;
    /// Why a contender that has a form for a device cannot take this scene there.
    virtual std::optional<std::string> missing_on_device(const Scene&) const {
        return std::nullopt;
    }
    /// What triangles are needed for ("aim rays at"); empty if boxes are enough.
    virtual std::string_view mesh_is_for() const { return {}; }
    /// The choices that a block makes beyond builder and layout.
    virtual std::vector<Choice> variants(const BlockReader&, const Choice& choice) const {
        return {choice};
    }
    /// The scenes that it makes of one by keys of the task's own.
    virtual std::vector<SceneSpec> with_queries(const BlockReader&, const SceneSpec& scene) const {
        return {scene};
    }
};

/// Makes a contender of class C from job, builder and layout, and further arguments.
template <class C, class... More> auto maker(More... more) {
    return [more...](const Job& job, BuildFunction build,
                     const LayoutEntry& layout) -> std::unique_ptr<Contender> {
        return std::make_unique<C>(job, std::move(build), layout, more...);
    };
}

} // namespace boxwood::bench
