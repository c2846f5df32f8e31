#include "bench/tasks/ours.h"

#include "bench/tasks/points.h"
#include "bench/tasks/rays.h"
#include "bench/tasks/tree_builds.h"
#include "bench/tasks/tree_contender.h"
#include "bench/tasks/triangle_pairs.h"
#include "kernels/registry.h"
#include "kernels/suggest.h"
#include "trees/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace boxwood::bench {
namespace {

class SelfPairs final : public TreeContender {
  public:
    using TreeContender::TreeContender;
    void query(Answers& answers) override {
        layout_->self_pairs(*executor_, pairs_.to(answers.pairs));
    }
    std::optional<Work> counted_query(Answers& answers) override {
        return layout_->self_pairs_counted(pairs_.to(answers.pairs));
    }

  private:
    PairsInto pairs_;
};

/// A tree over each half of the boxes; the items of the second are numbered from its start, so its
/// half of the pairs is moved by the split afterwards.
class TreePairs final : public TreeContender {
  public:
    using TreeContender::TreeContender;
    void build() override {
        layout_.reset();
        other_.reset();
        const Boxes boxes = scene_.boxes;
        layout_ = make_layout(layout_entry_, build_, boxes.first(split_), *executor_, tree_);
        other_ = make_layout(layout_entry_, build_, boxes.subspan(split_), *executor_, tree_);
    }
    void query(Answers& answers) override {
        layout_->tree_pairs(*other_, *executor_, pairs_.to(answers.pairs));
        move_second(answers);
    }
    std::optional<Work> counted_query(Answers& answers) override {
        const Work work = layout_->tree_pairs_counted(*other_, pairs_.to(answers.pairs));
        move_second(answers);
        return work;
    }
    /// No tree: there are two, and a row of the tree table is about one.
    std::optional<StructureInfo> structure() const override {
        return StructureInfo{layout_->bytes() + other_->bytes(), nullptr};
    }

  private:
    void move_second(Answers& answers) const {
        for (Pair& pair : answers.pairs)
            pair.b += static_cast<std::uint32_t>(split_);
    }

    std::size_t split_ = tree_pairs_split(scene_.boxes.size());
    std::unique_ptr<AnyLayout> other_;
    PairsInto pairs_;
};

std::string_view traversal_of(Ask ask, const RayOrderEntry& order) {
    if (is_point_ask(ask) || ask == Ask::rays_all)
        return to_string(ask);
    return is_ray_ask(ask) ? order.traversal : ask == Ask::tree_pairs ? "tree_pairs" : "self_pairs";
}

/// What a task asks of a layout.
Query query_of(Ask ask) {
    switch (ask) {
    case Ask::pairs:
    case Ask::triangle_pairs:
        return Query::self_pairs;
    case Ask::tree_pairs:
        return Query::tree_pairs;
    case Ask::points:
        return Query::points;
    case Ask::regions:
        return Query::regions;
    case Ask::nearest:
        return Query::nearest;
    case Ask::closest_points:
        return Query::closest_points;
    default:
        return Query::rays;
    }
}

} // namespace

std::string word_with_settings(std::string word, const Settings& settings) {
    std::ranges::replace(word, '+', '_');
    for (const auto& [name, value] : settings) {
        word += fmt::format("_{}", name);
        for (const char c : to_text(value))
            if (c != '+')
                word += c == '.' ? '_' : c == '-' ? 'm' : c;
    }
    return word;
}

std::string settings_json(const Settings& settings) {
    std::string all;
    for (const auto& [name, value] : settings)
        all += fmt::format("{}\"{}\": {}", all.empty() ? "" : ", ", name,
                           std::holds_alternative<std::string>(value)
                               ? '"' + std::get<std::string>(value) + '"'
                               : to_text(value));
    return "{" + all + "}";
}

ContenderEntry our_contender(const Choice& choice, Ask ask) {
    if (ask == Ask::tree)
        return tree_contender(choice); // whatever the layout
    if (is_moving_ask(ask) || is_kernel_ask(ask))
        throw std::invalid_argument(fmt::format("no builder and layout answer {}", to_string(ask)));
    const std::string_view builder_name =
        std::string_view(choice.builder).substr(0, choice.builder.find('+'));
    const BuilderEntry& builder = entry_named(builder_name, builders(), "builder");
    const LayoutEntry& layout = entry_named(choice.layout, layouts(), "layout");
    const RayOrderEntry& order = entry_named(choice.ray_order, ray_orders(), "ray order");

    ContenderEntry entry;
    entry.library = "boxwood";
    entry.is_peer = false;
    entry.precision = layout.precision;
    entry.builder = word_with_settings(choice.builder, choice.settings);
    entry.layout = choice.layout;
    entry.traversal = traversal_of(ask, order);
    if (takes_kernel(ask)) {
        entry.kernel = choice.kernel;
        entry.promise =
            is_ray_ask(ask)
                ? entry_named(choice.kernel, ray_kernels(), "ray kernel").promise
                : entry_named(choice.kernel, triangle_kernels(), "triangle kernel").promise;
    }
    entry.name = fmt::format("{}.{}.{}", entry.builder, entry.layout, entry.traversal);
    if (!entry.kernel.empty())
        entry.name += "." + entry.kernel;
    entry.summary = fmt::format("{}; {}", builder.summary, layout.summary);
    entry.notes = "build: boxes to tree to layout; answers in the same order for any number of "
                  "threads";
    entry.params_json = settings_json(choice.settings);

    entry.unsupported = [&layout](const Job& job) -> std::optional<std::string> {
        if (const Query query = query_of(job.task); !layout.answers(query))
            return fmt::format("the layout {} does not answer {}", layout.name, to_string(query));
        if (takes_kernel(job.task) && job.scene->mesh.triangles.empty())
            return "the scene has no triangles";
        if (is_point_ask(job.task))
            if (auto why = no_queries(job.scene, job.task))
                return why;
        if (job.executor == "serial" && job.threads != 1)
            return "the executor serial has one thread";
        return std::nullopt;
    };
    entry.make = [build = make_builder(choice.builder, choice.settings), &layout,
                  kernel = choice.kernel, &order](const Job& job) -> std::unique_ptr<Contender> {
        switch (job.task) {
        case Ask::pairs:
            return std::make_unique<SelfPairs>(job, build, layout);
        case Ask::tree_pairs:
            return std::make_unique<TreePairs>(job, build, layout);
        case Ask::triangle_pairs:
            return make_triangle_pairs(job, build, layout, kernel);
        case Ask::points:
        case Ask::regions:
        case Ask::nearest:
        case Ask::closest_points:
            return make_point_queries(job, build, layout);
        default:
            return make_rays(job, build, layout, kernel, order);
        }
    };
    return entry;
}

} // namespace boxwood::bench
