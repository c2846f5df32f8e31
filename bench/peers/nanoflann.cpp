#include "bench/peers/answering.h"
#include "bench/peers/point_peers.h"
#include "bench/peers/query_order.h"

#include <fmt/format.h>
#include <nanoflann.hpp>

#include <algorithm>

namespace boxwood::bench {
namespace {

/// The points of a scene in the words of the library.
struct Points {
    std::vector<Vec3<float>> points;

    std::size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return points[i][static_cast<int>(axis)];
    }
    template <class Box> bool kdtree_get_bbox(Box&) const { return false; } // it finds it itself
};
using KdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                   Points, 3, std::uint32_t>;

constexpr std::size_t leaf_size = 20; // the library's default of 10 is 1.05 times slower

class NearestPoints final : public Contender {
  public:
    NearestPoints(const Job& job, Asked asked)
        : scene_(*job.scene), k_(neighbours_of(scene_)), order_(job, PointQuery::nearest, asked),
          found_(k_), distances_(k_) {
        for (const Aabb<float>& box : scene_.boxes)
            points_.points.push_back(box.min);
    }

    void build() override {
        tree_.reset();
        tree_ = std::make_unique<KdTree>(3, points_, leaf_size);
    }

    void query(Answers& answers) override {
        std::vector<Neighbour>& neighbours = list_of<Neighbour>(answers);
        neighbours.resize(k_ * scene_.points.size());
        order_.find();
        for (std::size_t place = 0; place < order_.size(); ++place) {
            const std::uint32_t i = order_[place];
            const Vec3<float> p = scene_.points[i];
            const float query[3] = {p.x, p.y, p.z};
            const std::size_t n = tree_->knnSearch(query, k_, found_.data(), distances_.data());
            NearestOfPeer nearest(std::span<Neighbour>(neighbours).subspan(i * k_, k_));
            for (std::size_t j = 0; j < n; ++j)
                nearest.offer({found_[j], distance_to(found_[j], p)});
        }
    }

  private:
    /// In doubles, which the library's floats are not.
    double distance_to(std::uint32_t item, Vec3<float> p) const {
        const Vec3<double> offset = Vec3<double>(points_.points[item]) - Vec3<double>(p);
        return dot(offset, offset);
    }

    const Scene& scene_;
    std::size_t k_;
    QueryOrder order_;
    Points points_;
    std::vector<std::uint32_t> found_;
    std::vector<float> distances_;
    std::unique_ptr<KdTree> tree_;
};

std::optional<std::string> needs_points(const Job& job) {
    const bool are_points = std::ranges::all_of(
        job.scene->boxes, [](const Aabb<float>& box) { return box.min == box.max; });
    return are_points ? std::nullopt
                      : std::optional<std::string>("its tree holds points, and these boxes have a "
                                                   "size: scene = \"point_cloud\" has none");
}

ContenderEntry kd_tree(Asked asked) {
    ContenderEntry e;
    e.name = fmt::format("nanoflann.kd_tree{}", name_of(asked));
    e.library = "nanoflann";
    e.summary = "nanoflann's KDTreeSingleIndexAdaptor";
    e.notes = fmt::format("build = the constructor, over an array of points; leaves of at most "
                          "{} points; query = knnSearch, {}, whose distances are found again in "
                          "doubles; one thread",
                          leaf_size, words_for(asked));
    e.precision = "f32";
    e.runs_on = RunsOn::one_thread;
    e.classes = classes_of(asked);
    e.cannot = needs_points;
    e.answers = {answering<NearestPoints>("nearest", asked)};
    return e;
}

} // namespace

Peer nanoflann_peer() {
    Peer peer;
    peer.name = "nanoflann";
    peer.title = "nanoflann";
    peer.summary = "nanoflann: k-d tree of points";
    peer.version = fmt::format("{:x}.{:x}.{:x}", NANOFLANN_VERSION >> 8,
                               NANOFLANN_VERSION >> 4 & 0xf, NANOFLANN_VERSION & 0xf);
    peer.build = "headers compiled here in single precision";
    peer.contenders = {kd_tree(Asked::as_given), kd_tree(Asked::along_a_curve)};
    return peer;
}

} // namespace boxwood::bench
