/// The catalogues of this room. To add a builder, layout or executor: write its file, which defines
/// `BuilderEntry NAME_builder()` (or NAME_layout, NAME_executor), and add its word here.

#include "trees/builder.h"
#include "trees/executor.h"
#include "trees/layout.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#define BOXWOOD_BUILDERS(X) X(median) X(binned_sah) X(incremental)
#define BOXWOOD_LAYOUTS(X) X(binary) X(wide8)
#define BOXWOOD_EXECUTORS(X) X(serial) X(openmp) X(tbb)

namespace boxwood {

#define X(word) BuilderEntry word##_builder();
BOXWOOD_BUILDERS(X)
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

} // namespace

std::span<const BuilderEntry> builders() {
#define X(word) word##_builder(),
    static const std::array entries{BOXWOOD_BUILDERS(X)};
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

std::span<const TraversalEntry> traversals() {
    static constexpr std::array<TraversalEntry, 3> entries{{
        {"self_pairs", "every unordered pair of overlapping items of one tree, once"},
        {"tree_pairs", "every overlapping pair between the items of two trees, once"},
        {"rays", "for each ray the nearest triangle, or whether there is any"},
    }};
    return entries;
}

const BuilderEntry* find_builder(std::string_view name) { return find(builders(), name); }
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

void throw_unknown_setting(std::string_view builder, std::string_view setting,
                           std::span<const SettingInfo> known) {
    std::string message = "builder '" + std::string(builder) + "' has no setting '" +
                          std::string(setting) + "'; it has ";
    for (std::size_t i = 0; i < known.size(); ++i)
        message += (i ? ", " : "") + std::string(known[i].name);
    throw std::invalid_argument(known.empty() ? message + "none" : message);
}

void throw_setting_range(std::string_view builder, const SettingInfo& setting, double value) {
    throw std::invalid_argument("setting '" + std::string(setting.name) + "' of builder '" +
                                std::string(builder) + "' must lie between " +
                                std::to_string(setting.least) + " and " +
                                std::to_string(setting.most) + ", not " + std::to_string(value));
}

} // namespace boxwood
