// The CMake target of CGAL sets -frounding-math: this file alone is compiled with it.
#define CGAL_LINKED_WITH_TBB
#include "bench/peers/answering.h"
#include "bench/peers/kernel_peers.h"
#include "bench/peers/mesh_peers.h"
#include "bench/peers/point_peers.h"
#include "scenes/moving/frames.h"

#include <CGAL/box_intersection_d.h>
#include <CGAL/version.h>
#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <array>
#include <cstdint>

namespace boxwood::bench {
namespace {

/// The axes of the world in CGAL's order: it divides along the last one first.
using AxisOrder = std::array<int, 3>;
constexpr AxisOrder xyz{0, 1, 2};
/// For worlds that are flat in z: five times as quick there as xyz, and elsewhere as quick.
constexpr AxisOrder xzy{0, 2, 1};

struct Box {
    std::array<float, 3> min, max;
    std::uint32_t item;
};

/// CGAL's traits, so that it sorts 28-byte boxes and breaks ties by item.
struct BoxTraits {
    using NT = float;
    using ID = std::uint32_t;
    using Box_parameter = const Box&;
    static NT min_coord(Box_parameter b, int axis) { return b.min[static_cast<std::size_t>(axis)]; }
    static NT max_coord(Box_parameter b, int axis) { return b.max[static_cast<std::size_t>(axis)]; }
    static ID id(Box_parameter b) { return b.item; }
    static int dimension() { return 3; }
};

/// Below so many boxes CGAL scans instead of dividing. Of 10 (its default) to 10,000, at 100,000
/// boxes, 500 was best in clusters and for bars and 2000 for what is spread evenly.
constexpr std::ptrdiff_t usual_cutoff = 500;

struct Setting {
    std::ptrdiff_t cutoff = usual_cutoff;
    AxisOrder axes = xyz;

    std::string axes_word() const {
        return fmt::format("{:c}{:c}{:c}", 'x' + axes[0], 'x' + axes[1], 'x' + axes[2]);
    }
    std::string suffix() const {
        std::string all;
        if (axes != xyz)
            all += "." + axes_word();
        if (cutoff != usual_cutoff)
            all += fmt::format(".cutoff{}", cutoff);
        return all;
    }
};

class BoxIntersection final : public Contender {
  public:
    BoxIntersection(const Job& job, Sides sides, Setting setting)
        : scene_(*job.scene), between_halves_(sides == Sides::two_halves), setting_(setting),
          parallel_(job.executor == "tbb"), arena_(static_cast<int>(job.threads)) {}

    void build() override { take(scene_.boxes); }
    void update(const Frame& frame) override { take(frame.boxes); }

    void query(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        sorted_ = boxes_; // CGAL reorders its input; each query starts from the same order
        if (!parallel_) {
            intersect<CGAL::Sequential_tag>([out = &pairs](const Box& a, const Box& b) {
                out->push_back(ordered_pair(a.item, b.item));
            });
            return;
        }
        for (std::vector<Pair>& part : parts_)
            part.clear();
        arena_.execute([&] {
            intersect<CGAL::Parallel_tag>([parts = &parts_](const Box& a, const Box& b) {
                parts->local().push_back(ordered_pair(a.item, b.item));
            });
        });
        for (const std::vector<Pair>& part : parts_)
            pairs.insert(pairs.end(), part.begin(), part.end());
    }

  private:
    /// Those of bodies that are present.
    void take(std::span<const Aabb<float>> boxes) {
        boxes_.clear();
        boxes_.reserve(boxes.size());
        for (std::uint32_t i = 0; i < boxes.size(); ++i)
            if (const Aabb<float>& b = boxes[i]; !b.is_empty())
                boxes_.push_back({reordered(b.min), reordered(b.max), i});
    }

    std::array<float, 3> reordered(const Vec3<float>& p) const {
        return {p[setting_.axes[0]], p[setting_.axes[1]], p[setting_.axes[2]]};
    }

    template <class Tag, class Callback> void intersect(Callback append) {
        using namespace CGAL::Box_intersection_d;
        const auto middle =
            sorted_.begin() + static_cast<std::ptrdiff_t>(tree_pairs_split(sorted_.size()));
        if (between_halves_)
            CGAL::box_intersection_d<Tag>(sorted_.begin(), middle, middle, sorted_.end(), append,
                                          BoxTraits(), setting_.cutoff, CLOSED);
        else
            CGAL::box_self_intersection_d<Tag>(sorted_.begin(), sorted_.end(), append, BoxTraits(),
                                               setting_.cutoff, CLOSED);
    }

    const Scene& scene_;
    bool between_halves_;
    Setting setting_;
    bool parallel_;
    tbb::task_arena arena_;
    std::vector<Box> boxes_, sorted_;
    tbb::enumerable_thread_specific<std::vector<Pair>> parts_;
};

ContenderEntry entry(const std::string& name, std::string summary, const Setting& setting,
                     std::vector<Answering> answers) {
    ContenderEntry e;
    e.name = name + setting.suffix();
    e.library = "cgal";
    e.summary = std::move(summary);
    e.notes = fmt::format(
        "build and query are one: build only fills the box array, and a query copies and sorts "
        "it; a frame: the boxes of the bodies that are present copied again; closed boxes, axes in "
        "the order {}, cutoff {}; with TBB CGAL cuts its input into 4 x 4 parts, whatever the "
        "number of threads, and "
        "pairs go to one list per thread that are joined at the end",
        setting.axes_word(), setting.cutoff);
    e.precision = "f32";
    e.keeps_structure = false;
    e.runs_on = RunsOn::tbb;
    e.answers = std::move(answers);
    return e;
}

} // namespace

Peer cgal_peer() {
    Peer peer;
    peer.name = "cgal";
    peer.title = "CGAL";
    peer.summary = "CGAL: streamed segment tree, without a structure that is kept";
    peer.version = CGAL_VERSION_STR;
    peer.build = "headers compiled here with single-precision boxes and TBB";
    for (const Setting& setting : {Setting{}, Setting{.cutoff = 100}, Setting{.cutoff = 2000},
                                   Setting{.axes = xzy}, Setting{.cutoff = 2000, .axes = xzy}}) {
        peer.contenders.push_back(
            entry("cgal.box_self_intersection_d",
                  "CGAL's box_self_intersection_d (Zomorodian and Edelsbrunner)", setting,
                  {answering<BoxIntersection>("pairs", Sides::all, setting),
                   answering<BoxIntersection>("moving_pairs", Sides::all, setting)}));
        peer.contenders.push_back(
            entry("cgal.box_intersection_d", "CGAL's box_intersection_d between two sets of boxes",
                  setting, {answering<BoxIntersection>("tree_pairs", Sides::two_halves, setting)}));
    }
    for (ContenderEntry& e : cgal_points())
        peer.contenders.push_back(std::move(e));
    for (ContenderEntry& e : cgal_meshes())
        peer.contenders.push_back(std::move(e));
    for (ContenderEntry& e : cgal_kernels())
        peer.contenders.push_back(std::move(e));
    return peer;
}

} // namespace boxwood::bench
