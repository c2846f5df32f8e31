/// The registries of trees/. To add a builder, optimizer, update policy or executor: write its
/// file, which defines `BuilderEntry NAME_builder()` (or NAME_optimizer, NAME_update,
/// NAME_executor), and add its name here; of a layout, NAME_layout, to the list in
/// layouts/layouts.h.

#include "kernels/suggest.h"
#include "trees/builder.h"
#include "trees/dynamic/update.h"
#include "trees/executor.h"
#include "trees/layout.h"
#include "trees/layouts/layouts.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#define BOXWOOD_BUILDERS(X)                                                                        \
    X(median)                                                                                      \
    X(hilbert) X(binned_sah) X(sweep_sah) X(spatial_sah) X(bonsai) X(incremental) X(lbvh) X(ploc)
#define BOXWOOD_OPTIMIZERS(X) X(reinsertion)
#define BOXWOOD_EXECUTORS(X) X(serial) BOXWOOD_OPENMP(X) BOXWOOD_TBB(X)
#define BOXWOOD_UPDATES(X) X(refit) X(reinsert) X(refine) X(rebuild) X(merge) X(cached) X(auto)

// Defined by trees/CMakeLists.txt where the package was found.
#ifdef BOXWOOD_HAS_OPENMP
#define BOXWOOD_OPENMP(X) X(openmp)
#else
#define BOXWOOD_OPENMP(X)
#endif
#ifdef BOXWOOD_HAS_TBB
#define BOXWOOD_TBB(X) X(tbb)
#else
#define BOXWOOD_TBB(X)
#endif

namespace boxwood {

#define X(name) UpdateEntry name##_update();
BOXWOOD_UPDATES(X)
#undef X
#define X(name) BuilderEntry name##_builder();
BOXWOOD_BUILDERS(X)
#undef X
#define X(name) OptimizerEntry name##_optimizer();
BOXWOOD_OPTIMIZERS(X)
#undef X
#define X(name, ...) LayoutEntry name##_layout();
BOXWOOD_LAYOUTS(X)
#undef X
#define X(name) ExecutorEntry name##_executor();
BOXWOOD_EXECUTORS(X)
#undef X

std::span<const BuilderEntry> builders() {
#define X(name) name##_builder(),
    static const std::array entries{BOXWOOD_BUILDERS(X)};
#undef X
    return entries;
}

std::span<const OptimizerEntry> optimizers() {
#define X(name) name##_optimizer(),
    static const std::vector<OptimizerEntry> entries{BOXWOOD_OPTIMIZERS(X)};
#undef X
    return entries;
}

std::span<const LayoutEntry> layouts() {
#define X(name, ...) name##_layout(),
    static const std::array entries{BOXWOOD_LAYOUTS(X)};
#undef X
    return entries;
}

std::span<const ExecutorEntry> executors() {
#define X(name) name##_executor(),
    static const std::array entries{BOXWOOD_EXECUTORS(X)};
#undef X
    return entries;
}

std::span<const UpdateEntry> updates() {
#define X(name) name##_update(),
    static const std::array entries{BOXWOOD_UPDATES(X)};
#undef X
    return entries;
}

std::span<const TraversalEntry> traversals() {
    static constexpr std::array<TraversalEntry, 10> entries{{
        // in the order of `Query`
        {"self_pairs", "every unordered pair of overlapping items of one tree, once"},
        {"tree_pairs", "every overlapping pair between the items of two trees, once"},
        {"rays", "for each ray the nearest triangle, or whether there is any, or all of them"},
        {"points", "for each point all items that contain it"},
        {"regions", "for each box or sphere all items that share a point with it"},
        {"nearest", "for each point the k nearest items"},
        {"closest_points", "for each point the nearest point of a mesh"},
        // further ways to answer rays
        {"sorted_rays", "rays of a batch taken by direction and place, answers put back"},
        {"tiled_rays", "rays of a picture taken by tiles of 4 x 4 pixels, answers put back"},
        {"single_rays", "one ray in a call, as fast alone as it can be"},
    }};
    return entries;
}

std::string_view to_string(Query query) {
    return traversals()[static_cast<std::size_t>(query)].name;
}

BuildFunction make_builder(std::string_view name, const Settings& settings) {
    const std::size_t plus = name.find('+');
    const BuilderEntry& builder = find_builder(name.substr(0, plus));
    if (plus == std::string_view::npos)
        return builder.make(settings);
    const OptimizerEntry& optimizer = entry_named(name.substr(plus + 1), optimizers(), "optimizer");
    Settings of_builder, of_optimizer;
    for (const auto& setting : settings) {
        const bool optimizers_own =
            std::ranges::find(optimizer.settings, setting.first, &SettingInfo::name) !=
            optimizer.settings.end();
        (optimizers_own ? of_optimizer : of_builder).insert(setting);
    }
    const auto improved = [improve = optimizer.make(of_optimizer)](const auto& build) {
        return [build, improve](const auto& of, const Executor& executor) {
            Tree tree = build(of, executor);
            improve(tree, executor);
            return tree;
        };
    };
    const BuildFunction before = builder.make(of_builder);
    BuildFunction made;
    made.build = improved(before.build);
    if (before.build_of_mesh)
        made.build_of_mesh = improved(before.build_of_mesh);
    return made;
}

bool LayoutEntry::answers(Query query) const {
    return std::ranges::find(queries, query) != queries.end();
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

const BuilderEntry& find_builder(std::string_view name) {
    return entry_named(name, builders(), "builder");
}
const UpdateEntry& find_update(std::string_view name) {
    return entry_named(name, updates(), "update policy");
}
const LayoutEntry& find_layout(std::string_view name) {
    return entry_named(name, layouts(), "layout");
}

std::unique_ptr<Executor> make_executor(std::string_view name, unsigned threads) {
    const ExecutorEntry& entry = entry_named(name, executors(), "executor");
    if (threads == 0)
        throw std::invalid_argument("an executor needs at least one thread");
    if (threads > entry.max_threads)
        throw std::invalid_argument("the executor '" + std::string(name) + "' cannot have " +
                                    std::to_string(threads) + " threads; " +
                                    (executors().size() > 1
                                         ? "choose " + std::string(default_executor(threads))
                                         : "Boxwood was built without OpenMP and TBB"));
    return entry.make(threads);
}

std::string_view default_executor(unsigned threads) {
    return threads == 1 ? "serial" : executors().back().name;
}

} // namespace boxwood
