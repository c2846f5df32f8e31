#include "bench/peers/answering.h"
#include "bench/peers/comers.h"
#include "bench/peers/point_peers.h"
#include "bench/peers/warp/warp_tree.h"
#include "bench/tasks/detail/device_contender.h"
#include "bench/tasks/detail/point_classes.h"
#include "bench/tasks/detail/ray_classes.h"
#include "bench/tasks/task.h"
#include "scenes/moving/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace boxwood::bench {
namespace {

/// Boxes as Warp's users have them, in two arrays, and the same on the device.
class Corners {
  public:
    Corners() = default;
    explicit Corners(Boxes boxes) { take(boxes); }

    void take(Boxes boxes) {
        lowers_.clear();
        uppers_.clear();
        for (const Box& box : boxes) {
            constexpr float far = std::numeric_limits<float>::max(); // as Warp's empty bounds are
            const bool is_empty = box.is_empty();
            lowers_.push_back(is_empty ? Vec3<float>{far, far, far} : box.min);
            uppers_.push_back(is_empty ? Vec3<float>{-far, -far, -far} : box.max);
        }
    }
    std::uint64_t upload() {
        if (there_[0].size() != lowers_.size())
            for (DeviceArray<Vec3<float>>& array : there_)
                array = DeviceArray<Vec3<float>>(lowers_.size(), bench_place());
        there_[0].write(lowers_);
        there_[1].write(uppers_);
        return 2 * there_[0].size_bytes();
    }
    WarpBoxes there() const { return {there_[0].span(), there_[1].span()}; }

  private:
    std::vector<Vec3<float>> lowers_, uppers_;
    std::array<DeviceArray<Vec3<float>>, 2> there_;
};

enum class Asked { self_pairs, tree_pairs, points, regions };

/// A tree of all boxes, or of the second half.
class BoxQueries final : public DeviceContender {
  public:
    BoxQueries(const Job& job, Asked asked, WarpBuilder builder, WarpOrder order)
        : DeviceContender(job), asked_(asked), order_(order), tree_(builder) {
        const Boxes boxes = job.scene->boxes;
        first_item_ = asked == Asked::tree_pairs ? tree_pairs_split(boxes.size()) : 0;
        items_.take(boxes.subspan(first_item_));
        if (asked == Asked::tree_pairs)
            queries_.take(boxes.first(first_item_));
        else if (asked != Asked::self_pairs)
            queries_.take(query_boxes(*job.scene, asked == Asked::points
                                                      ? PointQuery::containing
                                                      : PointQuery::overlapping));
        n_boxes_ = boxes.size();
    }

    /// What Warp starts and moves itself is not counted.
    std::vector<NamedCount> more_counts() const override {
        if (asked_ != Asked::self_pairs)
            return {};
        return {{"query_bytes", n_boxes_ * sizeof(Box) + tree_.n_pairs() * sizeof(Pair)}};
    }

  protected:
    std::uint64_t upload() override { return items_.upload(); }
    void build_there() override { tree_.build(items_.there()); }
    std::uint64_t upload_queries() override { return queries_.upload(); }
    void query_there() override {
        if (asked_ == Asked::self_pairs)
            tree_.find_self_pairs(order_);
        else
            tree_.find(queries_.there(), static_cast<std::uint32_t>(first_item_));
    }
    std::uint64_t download(Answers& answers) override {
        tree_.read_pairs(list_of<Pair>(answers));
        return tree_.n_pairs() * sizeof(Pair);
    }

  private:
    Asked asked_;
    WarpOrder order_;
    std::size_t first_item_ = 0, n_boxes_ = 0;
    Corners items_, queries_;
    WarpTree tree_; // before what it is of
};

/// Frames come from the host, and their pairs go there.
class Follower final : public Contender {
  public:
    Follower(const Job& job, WarpBuilder builder, bool refits)
        : scene_(*job.scene), refits_(refits), tree_(builder) {}

    void build() override {
        take(scene_.boxes);
        tree_.build(boxes_.there());
    }
    void update(const Frame& frame) override {
        take(frame.boxes);
        if (refits_)
            tree_.refit();
        else
            tree_.build(boxes_.there());
    }
    void query(Answers& answers) override {
        tree_.find_self_pairs(WarpOrder::of_the_tree);
        tree_.read_pairs(list_of<Pair>(answers));
    }

  private:
    void take(Boxes boxes) {
        boxes_.take(boxes);
        boxes_.upload();
    }

    const Scene& scene_;
    bool refits_;
    Corners boxes_;
    WarpTree tree_;
};

class RayQueries final : public DeviceContender {
  public:
    RayQueries(const Job& job, WarpBuilder builder, bool any)
        : DeviceContender(job), scene_(*job.scene), any_(any), mesh_(builder) {}

  protected:
    std::uint64_t upload() override {
        vertices_ = DeviceArray<Vec3<float>>(scene_.mesh.vertices, place());
        triangles_ = DeviceArray<std::array<std::uint32_t, 3>>(scene_.mesh.triangles, place());
        return vertices_.size_bytes() + triangles_.size_bytes();
    }
    void build_there() override {
        mesh_.build(std::as_const(vertices_).span(), std::as_const(triangles_).span());
    }
    std::uint64_t upload_queries() override {
        rays_ = DeviceArray<Ray<float>>(scene_.rays, place());
        hits_ = DeviceArray<RayHit>(scene_.rays.size(), place());
        return rays_.size_bytes();
    }
    void query_there() override { mesh_.cast(std::as_const(rays_).span(), any_, hits_.span()); }
    std::uint64_t download(Answers& answers) override {
        hits_.read(list_of<RayHit>(answers));
        return hits_.size_bytes();
    }

  private:
    const Scene& scene_;
    bool any_;
    DeviceArray<Vec3<float>> vertices_;
    DeviceArray<std::array<std::uint32_t, 3>> triangles_;
    DeviceArray<Ray<float>> rays_;
    DeviceArray<RayHit> hits_;
    WarpMesh mesh_;
};

template <class C, class... More> Answering there(std::string task, More... more) {
    Answering on_device = answering<C>(task, more...);
    return {std::move(task), nullptr, std::move(on_device.make)};
}

ContenderEntry entry(std::string name, std::string summary, std::string notes,
                     std::vector<Answering> answers) {
    ContenderEntry e;
    e.name = "warp." + std::move(name);
    e.library = "warp";
    e.summary = std::move(summary);
    e.notes = std::move(notes);
    e.precision = "f32";
    e.runs_on = RunsOn::device;
    e.answers = std::move(answers);
    return e;
}

struct Builder {
    WarpBuilder builder;
    std::string name, title, build;
};

const std::string traversed =
    "; leaves of one box; query = bvh_query_aabb and bvh_query_next of its headers, a thread per "
    "box, pairs into room in any order in one pass; ";

/// So many boxes take Warp's sah two seconds.
constexpr std::size_t most_on_host = 1'000'000;

std::vector<ContenderEntry> of(const Builder& by) {
    const WarpBuilder b = by.builder;
    const bool on_host = b == WarpBuilder::sah;
    std::vector<Answering> answers{
        there<BoxQueries>("pairs", Asked::self_pairs, b, WarpOrder::of_the_tree),
        there<BoxQueries>("tree_pairs", Asked::tree_pairs, b, WarpOrder::as_given)};
    std::string notes = by.build + traversed +
                        "self pairs: threads in the order of the tree's leaves, which its Python "
                        "does not show; other queries in the order given";
    if (!on_host) { // its rebuild would make an lbvh
        answers.push_back(there<Follower>("moving_pairs", b, false));
        notes += "; a frame: all boxes uploaded, and a build";
    }
    std::vector<ContenderEntry> all;
    all.push_back(entry(by.name, "Warp's wp.Bvh, " + by.title, notes, std::move(answers)));
    all.push_back(entry(by.name + ".queries", "the same, asked for points and regions", notes,
                        {there<BoxQueries>("points", Asked::points, b, WarpOrder::as_given),
                         there<BoxQueries>("regions", Asked::regions, b, WarpOrder::as_given)}));
    all.back().classes = {point_class::batches};
    if (b == WarpBuilder::lbvh)
        all.push_back(
            entry(by.name + ".as_given", "the same, boxes as they come",
                  by.build + traversed + "threads in the order of the boxes",
                  {there<BoxQueries>("pairs", Asked::self_pairs, b, WarpOrder::as_given)}));
    all.push_back(entry(by.name + ".refit", "Warp's wp.Bvh, " + by.title + ", refitted",
                        by.build + traversed + "a frame: all boxes uploaded, wp_bvh_refit_device",
                        {there<Follower>("moving_pairs", b, true)}));
    for (ContenderEntry& e : all)
        e.cannot = [on_host, drops_empty = b == WarpBuilder::cubql](
                       const Job& job) -> std::optional<std::string> {
            if (on_host && job.scene->boxes.size() > most_on_host)
                return fmt::format("is built on one thread of the host: here for at most {} boxes",
                                   most_on_host);
            if (drops_empty && has_comers(job))
                return "cuBQL leaves out bodies that are not present, and does not say so";
            if (!job.scene->spheres.empty())
                return "takes boxes as regions, not balls";
            if (job.task->name() == "moving_pairs" && job.executor == resident_executor)
                return "has no form for a device where frames come from the host";
            return std::nullopt;
        };

    ContenderEntry rays = entry(
        by.name + ".mesh", "Warp's wp.Mesh, " + by.title,
        "build = wp_mesh_create_device; query = mesh_query_ray or mesh_query_ray_anyhit of its "
        "headers, a thread per ray in the order given; a hit at t_max itself is none",
        {there<RayQueries>("rays_closest", b, false), there<RayQueries>("rays_any", b, true)});
    rays.classes = {ray_class::batches};
    rays.cannot = [](const Job& job) -> std::optional<std::string> {
        if (std::holds_alternative<RayCases>(job.scene->cases))
            return "answers about the rays of a scene, not about cases";
        if (std::ranges::any_of(job.scene->rays, [](const auto& ray) { return ray.t_min > 0; }))
            return "takes rays that begin at t = 0";
        return std::nullopt;
    };
    all.push_back(std::move(rays));
    return all;
}

} // namespace

Peer warp_peer() {
    Peer peer;
    peer.name = "warp";
    peer.title = "NVIDIA Warp";
    peer.summary = "NVIDIA Warp: trees of boxes and meshes on a CUDA device";
    peer.version = warp_version();
    peer.build = "the Python package's library; queries compiled from its headers as Warp compiles "
                 "them, with fused multiply-add";
    for (const Builder& by :
         {Builder{WarpBuilder::lbvh, "lbvh", "linear along a Morton curve",
                  "build = wp_bvh_rebuild_device, in place"},
          Builder{WarpBuilder::sah, "sah", "by surface area, on the host",
                  "build = wp_bvh_create_device, which copies the boxes to the host, builds there "
                  "on one thread, and copies the tree back"},
          Builder{WarpBuilder::cubql, "cubql", "by cuBQL", "build = wp_bvh_rebuild_device"}})
        for (ContenderEntry& e : of(by))
            peer.contenders.push_back(std::move(e));
    return peer;
}

} // namespace boxwood::bench
