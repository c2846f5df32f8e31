/// Which stages queries require, and what each did.

#include "trees/world/bodies/detail/world_state.h"

namespace boxwood {
namespace {

using detail::Stage;
using detail::stage_names;

struct Required {
    bool is;
    std::string why;
};

std::string counted(std::size_t n, const char* one, const char* many) {
    return std::to_string(n) + " " + (n == 1 ? one : many);
}

} // namespace

std::vector<PlannedStage> World::plan(std::span<const WorldQuery> queries) const {
    const auto wants = [&](WorldQuery query) {
        return std::ranges::find(queries, query) != queries.end();
    };
    const bool any = !queries.empty();
    const bool narrow =
        std::ranges::any_of(queries, [](WorldQuery q) { return q != WorldQuery::candidates; });
    const auto unbuilt = static_cast<std::size_t>(std::ranges::count_if(
        bodies_, [](const Body& body) { return body.shape && !body.shape->is_built(); }));
    const auto of = [&](Stage stage) -> Required {
        const std::string no_query = "no query";
        switch (stage) {
        case Stage::fit:
            return {count_ > 0, counted(count_, "body", "bodies") + ": when they come or move"};
        case Stage::update:
            return {any && count_ > 0, any ? "the tree follows the boxes that changed" : no_query};
        case Stage::groups:
            return {any && state_->filter.has_groups(),
                    any && state_->filter.has_groups()
                        ? "groups and masks keep bodies apart on the way down the tree"
                    : any ? "every body may meet every other by its groups"
                          : no_query};
        case Stage::sweep:
            return {wants(WorldQuery::first_contact),
                    wants(WorldQuery::first_contact) ? "boxes around the ways of first contacts"
                                                     : "no query of first contacts"};
        case Stage::pairs:
            return {any,
                    any ? counted(state_->filter.allowed(), "pair is", "pairs are") + " allowed"
                        : no_query};
        case Stage::mesh_trees:
            return {narrow && unbuilt > 0, !narrow ? "no query of shapes"
                                           : unbuilt > 0
                                               ? "of " + counted(unbuilt, "body", "bodies") +
                                                     ", when a pair first needs it"
                                               : "all are built, or there is no mesh"};
        default:
            break;
        }
        const auto query = static_cast<WorldQuery>(static_cast<std::size_t>(stage) -
                                                   static_cast<std::size_t>(Stage::collide) + 1);
        return {wants(query), wants(query) ? "queried" : "not queried"};
    };
    std::vector<PlannedStage> plan;
    for (std::size_t i = 0; i < stage_names.size(); ++i) {
        const Required required = of(static_cast<Stage>(i));
        plan.push_back({std::string(stage_names[i]), required.is, required.why});
    }
    return plan;
}

Ledger World::ledger(std::span<const WorldQuery> queries) const {
    Ledger ledger(plan(queries));
    for (std::size_t i = 0; i < stage_names.size(); ++i) {
        const auto& count = state_->counts.of(static_cast<Stage>(i));
        ledger.add(i, count.calls, count.items, static_cast<double>(count.ns));
    }
    const auto holds = [&](Stage stage, std::size_t bytes) {
        ledger.set_bytes(static_cast<std::size_t>(stage), bytes);
    };
    holds(Stage::fit, bodies_.capacity() * sizeof(Body));
    holds(Stage::update, state_->tree.bytes());
    holds(Stage::groups, state_->tree.group_bytes());
    holds(Stage::pairs, state_->filter.bytes());
    std::vector<const MeshTree*> trees;
    for (const Body& body : bodies_)
        if (body.shape && body.shape->shape_class() != ShapeClass::convex && body.shape->is_built())
            trees.push_back(&body.shape->tree());
    std::ranges::sort(trees);
    trees.erase(std::ranges::unique(trees).begin(), trees.end());
    std::size_t bytes = 0;
    for (const MeshTree* tree : trees)
        bytes += tree->bytes();
    holds(Stage::mesh_trees, bytes);
    return ledger;
}

void World::clear_ledger() { state_->counts.clear(); }

} // namespace boxwood
