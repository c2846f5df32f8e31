#include "bench/stages/plan_stages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

constexpr std::string_view advance = "advance_"; ///< and an effect: the name of its stage

/// What the plan is made from.
struct Wants {
    explicit Wants(const MovingScene& scene) {
        const Bodies& bodies = scene.bodies();
        n = bodies.size();
        meshed = static_cast<std::size_t>(
            std::ranges::count_if(bodies.mesh, [](std::uint32_t m) { return m != no_mesh; }));
        for (const SceneQuery& query : scene.file().queries) {
            names.push_back(query.name);
            if (const Probes probes = probes_of(query.name);
                probes == Probes::points || probes == Probes::regions)
                box_queries.push_back(query.name);
        }
        moves = !scene.effects().empty();
        pairs = queries("pairs") || (queries("triangle_pairs") && meshed >= 2);
        triangles = queries("triangle_pairs") && meshed >= 2;
        filters = scene.ignored().size();
    }
    bool queries(std::string_view name) const {
        return std::ranges::find(names, name) != names.end();
    }

    std::size_t n = 0, meshed = 0, filters = 0;
    std::vector<std::string_view> names, box_queries; ///< of queries
    bool moves = false, pairs = false, triangles = false;
};

std::string counted(std::size_t n, std::string_view one, std::string_view many) {
    return n == 1 ? fmt::format("1 {}", one) : fmt::format("{} {}", n, many);
}

class Plan {
  public:
    Plan(const MovingScene& scene, Extent extent, Where where)
        : scene_(scene), wants_(scene), all_(extent == Extent::all_stages), where_(where) {}

    std::vector<PlannedStage> stages() {
        if (where_ == Where::resident)
            add_only("upload", true, "bodies, once at the start");
        changing();
        boxes_and_trees();
        meetings();
        queries();
        for (PlannedStage& stage : stages_) {
            stage.host_only = host_only(stage);
            stage.on_device =
                stage.runs && stage.host_only.empty() &&
                (where_ == Where::resident || (where_ == Where::device && is_of_trees(stage.name)));
        }
        return std::move(stages_);
    }

  private:
    /// A stage that the extent all_stages runs all the same.
    void add(std::string_view name, bool required, std::string why) {
        stages_.push_back({{std::string(name), required, std::move(why)}, "", required || all_});
    }
    /// One that cannot run unless it is required.
    void add_only(std::string_view name, bool required, std::string why) {
        stages_.push_back({{std::string(name), required, std::move(why)}, "", required});
    }

    static bool is_of_trees(std::string_view stage) {
        constexpr std::string_view all[] = {"upload", "tree", "update", "pairs", "download"};
        return std::ranges::find(all, stage) != std::end(all);
    }
    std::string host_only(const PlannedStage& stage) const {
        const std::string none = "has no device form";
        if (!stage.effect.empty())
            return effect_of(stage.effect).is_step ? "" : none;
        if (stage.name == "fit")
            return scene_.margins().empty() ? "" : none + " where margins widen boxes";
        if (stage.name == "tree" || stage.name == "update")
            return scene_.changes().presence ? none + " where bodies come and go" : "";
        return stage.name == "move" || is_of_trees(stage.name) ? "" : none;
    }

    void changing() {
        for (const EffectEntry& effect : boxwood::effects()) {
            std::size_t chosen = 0;
            for (const MovingScene::Laid& laid : scene_.effects())
                if (laid.entry->name == effect.name)
                    chosen += laid.chosen.size();
            add_only(fmt::format("{}{}", advance, effect.name), chosen > 0,
                     chosen > 0 ? fmt::format("laid on {} of {} bodies", chosen, wants_.n)
                                : "no body has this effect");
            stages_.back().effect = effect.name;
        }
        const std::size_t fast = scene_.with_velocity().size();
        add("move", fast > 0,
            fast > 0 ? fmt::format("effects give {} a velocity", counted(fast, "body", "bodies"))
                     : "no effect gives a body a velocity");
    }

    void boxes_and_trees() {
        const bool boxes = wants_.pairs || !wants_.box_queries.empty();
        std::string fit = "no query needs boxes";
        if (boxes)
            fit = wants_.moves ? "all at the start, then the bodies that have changed"
                               : "once at the start: nothing moves";
        if (boxes && !scene_.margins().empty() && wants_.pairs)
            fit += "; widened by margins for pairs";
        add("fit", boxes, fit);
        if (where_ == Where::device)
            add_only("upload", wants_.pairs,
                     !wants_.pairs  ? "no query needs pairs"
                     : wants_.moves ? "all boxes of each frame that changes one"
                                    : "boxes, once at the start: nothing moves");
        add("tree", wants_.pairs,
            wants_.pairs ? "made once at the start, to find pairs with" : "no query needs pairs");
        add("update", wants_.pairs && wants_.moves,
            !wants_.pairs ? "no query needs pairs"
            : wants_.moves
                ? fmt::format("{}: {}",
                              counted(scene_.effects().size(), "effect changes bodies",
                                      "effects change bodies"),
                              where_ == Where::host ? "given the bodies that have changed"
                                                    : "made again")
                : "nothing moves");
        const bool box_tree = !wants_.box_queries.empty();
        add_only("box_tree", box_tree,
                 box_tree ? fmt::format("{} of boxes{}", fmt::join(wants_.box_queries, ", "),
                                        wants_.moves ? "" : "; made once, as nothing moves")
                          : "no queries of points, regions or nearest");
    }

    void meetings() {
        std::string why = "not queried";
        if (wants_.pairs)
            why = wants_.queries("pairs") ? "queried" : "the candidates of triangle_pairs";
        if (wants_.pairs && !wants_.moves)
            why += "; found once and given again, as nothing moves";
        add("pairs", wants_.pairs, why);
        if (where_ != Where::host)
            add_only("download", wants_.pairs,
                     wants_.pairs ? "pairs, when they were found" : "no query needs pairs");
        const bool filter = wants_.pairs && wants_.filters > 0;
        add("filter", filter,
            filter               ? fmt::format("pairs within {} are ignored",
                                               counted(wants_.filters, "group", "groups"))
            : wants_.filters > 0 ? "no query needs pairs"
                                 : "no pairs are ignored");
        const std::string no_triangles = wants_.queries("triangle_pairs")
                                             ? "fewer than two bodies have meshes"
                                             : "no query of triangle_pairs";
        add("transform", wants_.triangles,
            wants_.triangles ? fmt::format("vertices of those of {} bodies with meshes that are in "
                                           "a pair, if they have changed",
                                           wants_.meshed)
                             : no_triangles);
        add("mesh_trees", wants_.triangles,
            wants_.triangles ? "made when a mesh is first in a pair, refitted when it has changed"
                             : no_triangles);
        add_only("triangle_pairs", wants_.triangles,
                 wants_.triangles ? "queried; those of two bodies at rest are cached"
                                  : no_triangles);
    }

    void queries() {
        const bool rays = wants_.queries("rays"), aim = rays || !wants_.box_queries.empty();
        add_only("surface", rays,
                 !rays          ? "no query of rays"
                 : wants_.moves ? "rays meet it; bodies that have changed are written in place"
                                : "rays meet it; made once, as nothing moves");
        add_only("aim", aim, aim ? "queries go with the frame" : "no queries to place");
        for (const SceneQueryEntry& entry : scene_queries()) {
            if (entry.probes == Probes::none)
                continue;
            const SceneQuery* query = query_named(scene_.file(), entry.name);
            add_only(entry.name, query != nullptr,
                     query ? fmt::format("{} {}", query->n, query->kind) : "not queried");
        }
    }

    const MovingScene& scene_;
    Wants wants_;
    bool all_;
    Where where_;
    std::vector<PlannedStage> stages_;
};

} // namespace

std::vector<PlannedStage> plan_stages(const MovingScene& scene, Extent extent, Where where) {
    return Plan(scene, extent, where).stages();
}

std::optional<std::string> why_not(const MovingScene& scene, Extent extent, Where where) {
    if (where == Where::host)
        return std::nullopt;
    if (extent == Extent::all_stages)
        return "all stages have no device form";
    const std::vector<PlannedStage> plan = plan_stages(scene, extent, where);
    if (!stage_of(plan, "pairs").runs)
        return "no stage that the scene requires has a device form: it does not need pairs";
    for (const PlannedStage& stage : plan)
        if (stage.runs && !stage.host_only.empty() &&
            (where == Where::resident || stage.name == "tree"))
            return fmt::format("stage {} {}", stage.name, stage.host_only);
    return std::nullopt;
}

std::string_view advanced_effect(std::string_view stage) {
    return stage.starts_with(advance) ? stage.substr(advance.size()) : std::string_view();
}

const PlannedStage& stage_of(std::span<const PlannedStage> plan, std::string_view name) {
    return *std::ranges::find(plan, name, &PlannedStage::name);
}

} // namespace boxwood::bench
