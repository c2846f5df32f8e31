#include "bench/peers/answering.h"
#include "bench/peers/point_peers.h"
#include "bench/peers/query_order.h"
#include "scenes/moving/frames.h"

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/version.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace boxwood::bench {
namespace {

namespace bg = boost::geometry;
namespace bgi = boost::geometry::index;

using Point = bg::model::point<float, 3, bg::cs::cartesian>;
using Box = bg::model::box<Point>;
using Value = std::pair<Box, std::uint32_t>;

Point point_of(Vec3<float> p) { return {p.x, p.y, p.z}; }
Box box_of(const Aabb<float>& box) { return {point_of(box.min), point_of(box.max)}; }

/// Most values of a node. For 10,000 boxes 8 was best, build and query together: 8.9 ms packed
/// (6: 9.2, 16: 10.7, 32: 13.4) and 44 ms for R* (16: 55, 32: 90, and seconds for 6). Interleaved
/// minima on a shared machine.
constexpr std::size_t node_size = 8;
using Packed = bgi::rtree<Value, bgi::quadratic<node_size>>; ///< the packing is that of all kinds
using RStar = bgi::rtree<Value, bgi::rstar<node_size>>;

/// An output iterator that hands each value on.
template <class Take> class Output {
  public:
    using iterator_category = std::output_iterator_tag;
    using value_type = void;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = void;

    explicit Output(Take& take) : take_(&take) {}
    Output& operator=(const Value& value) {
        (*take_)(value.second);
        return *this;
    }
    Output& operator*() { return *this; }
    Output& operator++() { return *this; }
    Output operator++(int) { return *this; }

  private:
    Take* take_;
};

template <class Tree, class Predicate, class Take>
void each(const Tree& tree, const Predicate& predicate, Take take) {
    tree.query(predicate, Output<Take>(take));
}

/// How a tree comes to be.
enum class Made : std::uint8_t {
    packed,  ///< by the constructor, from all values; for each frame again
    inserted ///< one by one; in a frame each moved value is removed and inserted
};

template <class Tree, Made made> class Pairs final : public Contender {
  public:
    Pairs(const Job& job, Sides sides)
        : scene_(*job.scene),
          split_(sides == Sides::two_halves ? tree_pairs_split(scene_.boxes.size()) : 0),
          between_halves_(sides == Sides::two_halves), boxes_(scene_.boxes) {}

    void build() override {
        boxes_ = scene_.boxes;
        make();
    }

    void update(const Frame& now) override {
        if constexpr (made == Made::packed) {
            for (const std::uint32_t i : now.moved)
                boxes_[i] = now.boxes[i];
            make();
        } else {
            for (const std::uint32_t i : now.moved) {
                if (!boxes_[i].is_empty())
                    tree_->remove(Value{box_of(boxes_[i]), i});
                boxes_[i] = now.boxes[i];
                if (!boxes_[i].is_empty())
                    tree_->insert(Value{box_of(boxes_[i]), i});
            }
        }
    }

    void query(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        const auto ask = [&](const Box& box, std::uint32_t i) {
            each(*tree_, bgi::intersects(box), [&](std::uint32_t other) {
                if (i < other)
                    pairs.push_back({i, other});
            });
        };
        if (between_halves_)
            for (std::uint32_t i = 0; i < split_; ++i)
                ask(box_of(boxes_[i]), i);
        else
            for (const auto& [box, i] : *tree_) // neighbours ask after one another
                ask(box, i);
    }

  private:
    /// Of all boxes, or of the second half.
    void make() {
        tree_.reset();
        if constexpr (made == Made::packed) {
            std::vector<Value> values;
            values.reserve(boxes_.size());
            each_value([&](const Value& value) { values.push_back(value); });
            tree_ = std::make_unique<Tree>(values.begin(), values.end());
        } else {
            tree_ = std::make_unique<Tree>();
            each_value([&](const Value& value) { tree_->insert(value); });
        }
    }
    template <class Take> void each_value(Take take) const {
        for (std::size_t i = split_; i < boxes_.size(); ++i)
            if (!boxes_[i].is_empty())
                take(Value{box_of(boxes_[i]), static_cast<std::uint32_t>(i)});
    }

    const Scene& scene_;
    std::size_t split_;
    bool between_halves_;
    std::vector<Aabb<float>> boxes_; ///< as they are now
    std::unique_ptr<Tree> tree_;
};

class Points final : public Contender {
  public:
    Points(const Job& job, PointQuery query, Asked asked)
        : scene_(*job.scene), query_(query), k_(neighbours_of(scene_)), order_(job, query, asked) {
        for (const Aabb<float>& box : query_boxes(scene_, query))
            queries_.push_back(box_of(box));
    }

    void build() override {
        tree_.reset();
        std::vector<Value> values;
        values.reserve(scene_.boxes.size());
        for (std::uint32_t i = 0; i < scene_.boxes.size(); ++i)
            values.emplace_back(box_of(scene_.boxes[i]), i);
        tree_ = std::make_unique<Packed>(values.begin(), values.end());
    }

    void query(Answers& answers) override {
        order_.find();
        if (query_ == PointQuery::nearest)
            return find_nearest(list_of<Neighbour>(answers));
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        for (std::size_t place = 0; place < order_.size(); ++place) {
            const std::uint32_t i = order_[place];
            each(*tree_, bgi::intersects(queries_[i]), [&](std::uint32_t item) {
                if (scene_.spheres.empty() || meets(scene_.spheres[i], scene_.boxes[item]))
                    pairs.push_back({i, item});
            });
        }
    }

  private:
    void find_nearest(std::vector<Neighbour>& neighbours) const {
        neighbours.resize(k_ * queries_.size());
        for (std::size_t place = 0; place < order_.size(); ++place) {
            const std::uint32_t i = order_[place];
            const Vec3<float> p = scene_.points[i];
            NearestOfPeer nearest(std::span<Neighbour>(neighbours).subspan(i * k_, k_));
            each(*tree_, bgi::nearest(point_of(p), static_cast<unsigned>(k_)),
                 [&](std::uint32_t item) {
                     nearest.offer({item, squared_distance(p, scene_.boxes[item])});
                 });
        }
    }

    const Scene& scene_;
    PointQuery query_;
    std::size_t k_;
    QueryOrder order_;
    std::vector<Box> queries_;
    std::unique_ptr<Packed> tree_;
};

ContenderEntry entry(std::string name, std::string summary, std::string notes,
                     std::vector<Answering> answers) {
    ContenderEntry e;
    e.name = "boost." + std::move(name);
    e.library = "boost";
    e.summary = "Boost.Geometry's rtree, " + std::move(summary);
    e.notes = std::move(notes) + fmt::format("; at most {} values a node, which are pairs of a box "
                                             "of floats and a number; an output "
                                             "iterator takes what is found; one thread",
                                             node_size);
    e.precision = "f32";
    e.runs_on = RunsOn::one_thread;
    e.answers = std::move(answers);
    return e;
}

ContenderEntry queries(Asked asked) {
    ContenderEntry e =
        entry(fmt::format("rtree.queries{}", name_of(asked)),
              "packed, queried with one point or region after another",
              fmt::format("build = the packing constructor; {}; points are flat boxes, balls go "
                          "by their boxes and are tested in doubles; nearest by its own search, "
                          "distances found again in doubles",
                          words_for(asked)),
              {answering<Points>("points", PointQuery::containing, asked),
               answering<Points>("regions", PointQuery::overlapping, asked),
               answering<Points>("nearest", PointQuery::nearest, asked)});
    e.classes = classes_of(asked);
    return e;
}

} // namespace

Peer boost_peer() {
    Peer peer;
    peer.name = "boost";
    peer.title = "Boost";
    peer.summary = "Boost.Geometry: R-tree";
    peer.version = fmt::format("{}.{}.{}", BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000,
                               BOOST_VERSION % 100);
    peer.build = "headers compiled here in single precision";
    const std::string pairs =
        "query = one by intersects for each value in the order of the tree, of "
        "which pairs with a later item are kept";
    peer.contenders = {
        entry("rtree.packed", "packed",
              "build = the packing constructor; a frame: all packed again; " + pairs,
              answering_all_pairs<Pairs<Packed, Made::packed>>()),
        entry("rtree.rstar", "of the R* kind, values inserted one by one",
              "build = insert each; a frame: each moved value removed and inserted; " + pairs,
              answering_all_pairs<Pairs<RStar, Made::inserted>>()),
        queries(Asked::as_given), queries(Asked::along_a_curve)};
    return peer;
}

} // namespace boxwood::bench
