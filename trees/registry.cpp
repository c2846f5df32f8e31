/// The registries of this room. To add a builder, stage, layout or executor: write its file, which
/// defines `BuilderEntry NAME_builder()` (or NAME_stage, NAME_layout, NAME_executor), and add its
/// word here.

#include "trees/builder.h"
#include "trees/executor.h"
#include "trees/layout.h"
#include "trees/dynamic/update.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#define BOXWOOD_BUILDERS(X)                                                                        \
    X(median)                                                                                      \
    X(hilbert) X(binned_sah) X(sweep_sah) X(spatial_sah) X(bonsai) X(incremental) X(lbvh) X(ploc)
#define BOXWOOD_STAGES(X) X(reinsertion)
#define BOXWOOD_LAYOUTS(X)                                                                         \
    X(binary) X(wide4) X(wide8) X(wide16) X(packed) X(quantised8) X(binary_f64) X(wide8_f64)
#define BOXWOOD_EXECUTORS(X) X(serial) X(openmp) X(tbb)

#define BOXWOOD_UPDATES(X) X(refit) X(reinsert) X(refine) X(rebuild) X(merge) X(keep) X(auto)

namespace boxwood {

#define X(word) UpdateEntry word##_update();
BOXWOOD_UPDATES(X)
#undef X
#define X(word) BuilderEntry word##_builder();
BOXWOOD_BUILDERS(X)
#undef X
#define X(word) OptimizerEntry word##_stage();
BOXWOOD_STAGES(X)
#undef X
#define X(word) LayoutEntry word##_layout();
BOXWOOD_LAYOUTS(X)
#undef X
#define X(word) ExecutorEntry word##_executor();
BOXWOOD_EXECUTORS(X)
#undef X

namespace {

template <class Entry> const Entry* find(std::span<const Entry> entries, std::string_view name) {
    const auto it = std::ranges::find(entries, name, &Entry::name);
    return it == entries.end() ? nullptr : &*it;
}

template <class Entry> std::string joined(std::span<const Entry> entries) {
    std::string words;
    for (const Entry& entry : entries)
        words += (words.empty() ? "" : ", ") + std::string(entry.name);
    return words.empty() ? "none" : words;
}

} // namespace

std::span<const BuilderEntry> builders() {
#define X(word) word##_builder(),
    static const std::array entries{BOXWOOD_BUILDERS(X)};
#undef X
    return entries;
}

std::span<const OptimizerEntry> stages() {
#define X(word) word##_stage(),
    static const std::vector<OptimizerEntry> entries{BOXWOOD_STAGES(X)};
#undef X
    return entries;
}

std::span<const LayoutEntry> layouts() {
#define X(word) word##_layout(),
    static const std::array entries{BOXWOOD_LAYOUTS(X)};
#undef X
    return entries;
}

std::span<const ExecutorEntry> executors() {
#define X(word) word##_executor(),
    static const std::array entries{BOXWOOD_EXECUTORS(X)};
#undef X
    return entries;
}

std::span<const UpdateEntry> updates() {
#define X(word) word##_update(),
    static const std::array entries{BOXWOOD_UPDATES(X)};
#undef X
    return entries;
}

std::span<const TraversalEntry> traversals() {
    static constexpr std::array<TraversalEntry, 9> entries{{
        {"self_pairs", "every unordered pair of overlapping items of one tree, once"},
        {"tree_pairs", "every overlapping pair between the items of two trees, once"},
        {"rays", "for each ray the nearest triangle, or whether there is any, or all of them"},
        {"sorted_rays", "the same of a batch walked by direction and place, answers put back"},
        {"single_rays", "the same of one ray in a call, as fast alone as it can be"},
        {"points", "for each point all items that contain it"},
        {"regions", "for each box or sphere all items that share a point with it"},
        {"nearest", "for each point the k nearest items"},
        {"closest_points", "for each point the nearest point of a mesh"},
    }};
    return entries;
}

BuildFunction make_builder(std::string_view words, const Settings& settings) {
    const std::size_t plus = words.find('+');
    const std::string_view first = words.substr(0, plus);
    const BuilderEntry* builder = find_builder(first);
    if (!builder)
        throw std::invalid_argument("unknown builder '" + std::string(first) + "'; it is one of " +
                                    joined(builders()));
    if (plus == std::string_view::npos)
        return builder->make(settings);
    const std::string_view second = words.substr(plus + 1);
    const OptimizerEntry* stage = find(stages(), second);
    if (!stage)
        throw std::invalid_argument("unknown stage '" + std::string(second) + "' after '" +
                                    std::string(first) + "'; it is one of " + joined(stages()));
    Settings of_builder, of_stage;
    for (const auto& setting : settings) {
        const bool stages_own = std::ranges::find(stage->settings, setting.first,
                                                  &SettingInfo::name) != stage->settings.end();
        (stages_own ? of_stage : of_builder).insert(setting);
    }
    const auto improved = [improve = stage->make(of_stage)](const auto& build) {
        return [build, improve](const auto& of, const Executor& executor) {
            Tree tree = build(of, executor);
            improve(tree, executor);
            return tree;
        };
    };
    const BuildFunction before = builder->make(of_builder);
    BuildFunction made;
    made.build = improved(before.build);
    if (before.build_of_mesh)
        made.build_of_mesh = improved(before.build_of_mesh);
    return made;
}

std::unique_ptr<AnyLayout> make_layout(const LayoutEntry& layout, const BuildFunction& builder,
                                       Boxes boxes, const Executor& executor, Tree& tree) {
    if (layout.make_of_order && builder.order) {
        tree = {};
        return layout.make_of_order(boxes, builder.order(boxes, executor).span(), executor);
    }
    tree = builder(boxes, executor);
    return layout.make(tree, executor);
}

const BuilderEntry* find_builder(std::string_view name) { return find(builders(), name); }
const UpdateEntry* find_update(std::string_view name) { return find(updates(), name); }
const LayoutEntry* find_layout(std::string_view name) { return find(layouts(), name); }

std::unique_ptr<Executor> make_executor(std::string_view name, unsigned threads) {
    const ExecutorEntry* entry = find(executors(), name);
    if (!entry)
        throw std::invalid_argument("unknown executor '" + std::string(name) + "'");
    if (threads == 0)
        throw std::invalid_argument("an executor needs at least one thread");
    if (entry->name == "serial" && threads != 1)
        throw std::invalid_argument("the executor 'serial' has one thread, not " +
                                    std::to_string(threads) + "; choose openmp or tbb");
    return entry->make(threads);
}

} // namespace boxwood
