#include "bench/tasks/detail/ray_task.h"

#include "bench/io/ray_range.h"
#include "bench/tasks/detail/ray_classes.h"
#include "bench/tasks/detail/rays_on_device.h"
#include "bench/truth/hit_truth.h"
#include "bench/truth/judging/case_truths.h"
#include "kernels/registry.h"
#include "kernels/suggest.h"
#include "scenes/sampling/rays.h"
#include "trees/mesh_bvh.h"
#include "trees/queries/single_rays.h"
#include "trees/queries/sorted_rays.h"
#include "trees/queries/tiled_rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

namespace boxwood::bench {
namespace {

/// Of the picture that a scene's rays are; 0 if they are none.
std::size_t width_of(const Scene& scene) {
    return picture_width(scene.spec.rays, scene.rays.size());
}

/// Why a scene's rays have no tiles.
std::optional<std::string> no_picture(const Scene& scene) {
    if (width_of(scene) != 0)
        return std::nullopt;
    return "traces rays by tiles of a picture, which these are not";
}

class Hits final : public RayContender {
  public:
    Hits(const Job& job, BuildFunction build, const LayoutEntry& layout, std::string kernel,
         RayQuery query, std::string_view order)
        : RayContender(job, std::move(build), layout, std::move(kernel)), query_(query),
          order_(order) {}

    void build() override {
        single_.reset();
        RayContender::build();
        if (order_ == "single")
            single_.emplace(*layout_, kernel_, triangles_);
    }

    void query(Answers& answers) override {
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.resize(scene_.rays.size());
        if (single_)
            one_by_one(hits);
        else if (order_ == "sorted")
            sorted_rays(*layout_, scene_.rays, query_, kernel_, triangles_, *executor_, hits);
        else if (order_ == "tiled")
            tiled_rays(*layout_, scene_.rays, width_of(scene_), query_, kernel_, triangles_,
                       *executor_, hits);
        else
            layout_->rays(scene_.rays, query_, kernel_, triangles_, *executor_, hits);
    }

    /// The order in which rays are traced changes no count.
    std::optional<Work> counted_query(Answers& answers) override {
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.resize(scene_.rays.size());
        return layout_->rays_counted(scene_.rays, query_, kernel_, triangles_, hits);
    }

  private:
    /// Embree's share of rays per chunk; its any-hits do not say which triangle it was.
    void one_by_one(std::vector<RayHit>& hits) const {
        constexpr std::size_t chunk = 256;
        executor_->for_each((hits.size() + chunk - 1) / chunk, [&](std::size_t c) {
            const std::size_t end = std::min(hits.size(), (c + 1) * chunk);
            for (std::size_t i = c * chunk; i < end; ++i)
                if (query_ == RayQuery::closest) {
                    hits[i] = single_->closest(scene_.rays[i]);
                } else {
                    hits[i] = {};
                    if (single_->any(scene_.rays[i]))
                        hits[i].triangle = 0;
                }
        });
    }

    RayQuery query_;
    std::string_view order_;
    std::optional<SingleRays> single_; ///< of the order "single"
};

class HitsByFrontDoor final : public Contender {
  public:
    HitsByFrontDoor(const Job& job, BuildFunction build, const LayoutEntry& layout,
                    std::string_view kernel, RayQuery query, bool one_by_one)
        : scene_(*job.scene),
          options_(front_door_options<MeshBvhOptions>(job, std::move(build), layout)),
          query_(query), one_by_one_(one_by_one) {
        const auto row = std::ranges::find(ray_kernels(), kernel, &KernelInfo::name);
        options_.kernel = static_cast<RayKernelName>(row - ray_kernels().begin());
    }

    void build() override {
        mesh_.reset();
        mesh_.emplace(scene_.mesh, options_);
    }
    void query(Answers& answers) override {
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.resize(scene_.rays.size());
        if (one_by_one_)
            each(hits);
        else if (query_ == RayQuery::closest)
            mesh_->closest_hits(scene_.rays, hits);
        else
            mesh_->any_hits(scene_.rays, hits);
    }
    std::optional<StructureInfo> structure() const override {
        return StructureInfo{.bytes = mesh_->bytes()};
    }

  private:
    /// In the chunks of Hits::one_by_one.
    void each(std::vector<RayHit>& hits) const {
        constexpr std::size_t chunk = 256;
        options_.executor->for_each((hits.size() + chunk - 1) / chunk, [&](std::size_t c) {
            const std::size_t end = std::min(hits.size(), (c + 1) * chunk);
            for (std::size_t i = c * chunk; i < end; ++i)
                if (query_ == RayQuery::closest) {
                    hits[i] = mesh_->closest_hit(scene_.rays[i]).value_or(RayHit{});
                } else {
                    hits[i] = {};
                    if (mesh_->any_hit(scene_.rays[i]))
                        hits[i].triangle = 0;
                }
        });
    }

    const Scene& scene_;
    MeshBvhOptions options_;
    RayQuery query_;
    bool one_by_one_;
    std::optional<MeshBvh> mesh_;
};

class HitsOnDevice final : public RaysOnDevice {
  public:
    HitsOnDevice(const Job& job, const DeviceMeshBvhOptions& options, RayQuery query)
        : RaysOnDevice(job, options), query_(query) {}

  private:
    void query_there() override {
        hits_ = query_ == RayQuery::closest ? mesh_->closest_hits(rays()) : mesh_->any_hits(rays());
    }
    std::uint64_t download(Answers& answers) override {
        hits_.read(list_of<RayHit>(answers));
        return hits_.size_bytes();
    }

    RayQuery query_;
    DeviceArray<RayHit> hits_;
};

class HitsOfCases final : public TreesOfCases {
  public:
    HitsOfCases(const Job& job, const BuildFunction& build, const LayoutEntry& layout,
                std::string kernel, RayQuery query, std::string_view order)
        : TreesOfCases(job, build, layout), kernel_(std::move(kernel)), query_(query),
          order_(order) {}

    void query(Answers& answers) override {
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.assign(cases_.rays.size(), {});
        for (const Group& group : groups_) {
            const auto own = std::span(hits).subspan(group.first_ray, group.rays.size());
            if (order_ == "single")
                one_by_one(group, own);
            else if (order_ == "sorted")
                sorted_rays(*group.layout, group.rays, query_, kernel_, group.triangles, serial(),
                            own);
            else
                group.layout->rays(group.rays, query_, kernel_, group.triangles, serial(), own);
            for (RayHit& hit : own)
                if (hit.hit())
                    hit.triangle += group.first;
        }
    }

  private:
    void one_by_one(const Group& group, std::span<RayHit> hits) const {
        const SingleRays single(*group.layout, kernel_, group.triangles);
        for (std::size_t i = 0; i < hits.size(); ++i)
            if (query_ == RayQuery::closest)
                hits[i] = single.closest(group.rays[i]);
            else if (single.any(group.rays[i]))
                hits[i].triangle = 0;
    }

    std::string kernel_;
    RayQuery query_;
    std::string_view order_;
};

const std::array orders{
    RayOrderEntry{"given",
                  "a batch as it comes, some of its rays on their way at a time",
                  "rays",
                  {ray_class::batches}},
    RayOrderEntry{"sorted",
                  "a batch by direction and place, answers put back",
                  "sorted_rays",
                  {ray_class::batches}},
    RayOrderEntry{"tiled",
                  "a batch that is a picture, by tiles of 4 x 4 pixels, answers put back",
                  "tiled_rays",
                  {ray_class::batches}},
    RayOrderEntry{"single",
                  "one ray in a call, answered before the next",
                  "single_rays",
                  {ray_class::single}}};

} // namespace

std::span<const RayOrderEntry> ray_orders() { return orders; }

void RayContender::build() {
    triangles_ = {};
    if (build_.build_of_mesh) {
        layout_.reset();
        tree_ = build_.build_of_mesh(scene_.mesh, *executor_);
        layout_ = layout_entry_.make(tree_, *executor_);
    } else {
        TreeContender::build();
    }
    triangles_ = layout_->triangles(scene_.mesh, *executor_);
}

void TreesOfCases::build() {
    groups_.clear();
    for (std::size_t i = 0; i < cases_.rays.size(); ++i) {
        const RayCase& c = cases_.rays[i];
        if (groups_.empty() || groups_.back().first != c.first)
            add_group(c, i);
        groups_.back().rays.push_back(c.ray);
    }
}

void TreesOfCases::add_group(const RayCase& c, std::size_t first_ray) {
    TriangleMesh mesh;
    std::vector<Box> boxes;
    for (std::uint32_t k = c.first; k < c.first + c.count; ++k) {
        const Triangle<float>& t = cases_.triangles[k];
        const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), {t.a, t.b, t.c});
        mesh.triangles.push_back({n, n + 1, n + 2});
        boxes.push_back(t.bounds());
    }
    Tree tree;
    Group& group = groups_.emplace_back();
    group.first = c.first;
    group.first_ray = first_ray;
    if (build_.build_of_mesh)
        group.layout = layout_.make(build_.build_of_mesh(mesh, serial()), serial());
    else
        group.layout = make_layout(layout_, build_, boxes, serial(), tree);
    group.triangles = group.layout->triangles(mesh);
}

std::vector<std::string_view> RayTask::keys() const {
    std::vector<std::string_view> all = TreeTask::keys();
    all.insert(all.end(), {"rays", "n_rays", "kernels"});
    return all;
}

bool RayTask::fits(const Cases& cases) const {
    const auto* rays = std::get_if<RayCases>(&cases);
    return rays && std::ranges::any_of(rays->rays, &RayCase::is_closed);
}

std::vector<ContenderEntry> RayTask::contenders_on_cases() const {
    std::vector<ContenderEntry> all;
    for (const KernelInfo& kernel : ray_kernels()) {
        if (kernel.promise == Promise::none)
            continue;
        const std::vector<CaseWay> ways = ways_on_cases(kernel.promise);
        for (const LayoutEntry& layout : layouts())
            for (const CaseWay& way : ways)
                if (layout.answers(Query::rays))
                    all.push_back(contender({.builder = way.builder,
                                             .settings = {},
                                             .layout = std::string(layout.name),
                                             .kernel = std::string(kernel.name),
                                             .ray_order = way.ray_order}));
    }
    return all;
}

std::optional<std::string> RayTask::missing(const Scene& scene) const {
    if (fits(scene.cases))
        return std::nullopt;
    if (const auto vertex = beyond_ray_range(scene.mesh))
        return "the mesh " + out_of_ray_range(scene.mesh, *vertex);
    return TreeTask::missing(scene);
}

std::vector<SceneSpec> RayTask::with_queries(const BlockReader& block,
                                             const SceneSpec& scene) const {
    const std::vector<std::string> kinds = block.names("rays", names_of(ray_kinds()));
    if (kinds.empty())
        block.fail(fmt::format("the task {} needs rays: one or more of {}", name(),
                               fmt::join(names_of(ray_kinds()), ", ")));
    std::vector<SceneSpec> all;
    if (!scene.file.empty() && !block.inputs().own_rays.empty()) {
        for (const OwnRays& own : block.inputs().own_rays) {
            all.push_back(scene);
            all.back().rays = own_rays;
            all.back().rays_file = own.file;
            all.back().n_rays = own.n;
        }
        return all;
    }
    for (const std::string& kind : kinds) {
        all.push_back(scene);
        all.back().rays = kind;
        all.back().n_rays = block.integer("n_rays", 1, 1'000'000'000).value_or(10'000);
    }
    return all;
}

std::vector<Choice> RayTask::variants(const BlockReader& block, const Choice& choice) const {
    std::vector<Choice> all;
    for (const std::string& kernel : block.kernels(names_of(ray_kernels()), {"watertight"})) {
        all.push_back(choice);
        all.back().kernel = kernel;
    }
    return all;
}

std::vector<std::string_view> HitTask::keys() const {
    std::vector<std::string_view> all = RayTask::keys();
    all.insert(all.end(), {"ray_order", "front_door"});
    return all;
}

std::unique_ptr<Answers> HitTask::make_answers() const {
    return std::make_unique<AnswerList<RayHit>>();
}

std::vector<NamedCount> HitTask::counters(const Answers& answers, const Work* work) const {
    const auto hits = std::ranges::count_if(list_of<RayHit>(answers), &RayHit::hit);
    std::vector<NamedCount> counts{{"hits", static_cast<std::uint64_t>(hits)}};
    append_work(counts, work, true);
    return counts;
}

/// One that rounds also one ray at a time, and in trees of cut triangles.
std::vector<RayTask::CaseWay> HitTask::ways_on_cases(Promise promise) const {
    std::vector<CaseWay> ways{{"binned_sah", "given"}, {"binned_sah", "sorted"}};
    if (promise == Promise::never_leaks)
        ways.insert(ways.end(), {{"binned_sah", "single"}, {"spatial_sah", "given"}});
    return ways;
}

std::unique_ptr<Truth> HitTask::make_truth(const Scene& scene, unsigned threads) const {
    if (fits(scene.cases))
        return make_fan_truth({scene, name(), threads});
    return make_hit_truth(scene, query_, threads);
}

std::vector<Choice> HitTask::variants(const BlockReader& block, const Choice& choice) const {
    std::vector<Choice> all;
    for (const Choice& of_kernel : RayTask::variants(block, choice))
        for (const std::string& order :
             block.names("ray_order", names_of(ray_orders()), {"given"})) {
            all.push_back(of_kernel);
            all.back().ray_order = order;
        }
    return all;
}

TreeTask::Way HitTask::way(const Choice& choice) const {
    const RayOrderEntry& order = entry_named(choice.ray_order, ray_orders(), "ray order");
    const KernelInfo& kernel = entry_named(choice.kernel, ray_kernels(), "ray kernel");
    const auto make = [kernel = choice.kernel, query = query_, order = order.name](
                          const Job& job, BuildFunction build,
                          const LayoutEntry& layout) -> std::unique_ptr<Contender> {
        if (std::holds_alternative<RayCases>(job.scene->cases))
            return std::make_unique<HitsOfCases>(job, build, layout, kernel, query, order);
        return std::make_unique<Hits>(job, std::move(build), layout, kernel, query, order);
    };
    TreeTask::Way::Make by_front_door; // which traces rays one by one or as given
    if (order.name == "given" || order.name == "single")
        by_front_door = maker<HitsByFrontDoor>(choice.kernel, query_, order.name == "single");
    return {.traversal = order.traversal,
            .kernel = choice.kernel,
            .promise = kernel.promise,
            .make = make,
            .query = Query::rays,
            .classes = ray_class::of_ours(order.classes, choice.kernel),
            .make_on_device = on_device(choice),
            .make_by_front_door = by_front_door,
            .cannot = order.name == "tiled" ? no_picture : nullptr};
}

Answering::Make HitTask::on_device(const Choice& choice) const {
    const std::optional<DeviceMeshBvhOptions> options = device_options(choice);
    if (!options || choice.ray_order == "single" || choice.ray_order == "tiled")
        return nullptr;
    return [options = *options, query = query_](const Job& job) {
        return std::make_unique<HitsOnDevice>(job, options, query);
    };
}

std::optional<std::string> RayTask::missing_on_device(const Scene& scene) const {
    if (std::holds_alternative<RayCases>(scene.cases))
        return "has no form for a device on families of hard cases";
    return std::nullopt;
}

} // namespace boxwood::bench
