/// Every builder, alone and with each optimizer, under every layout: pairs, points, regions and
/// nearest items of the boxes that the bytes hold against brute force.

#include "bench/fuzz/fuzz.h"
#include "trees/inspect/validate.h"
#include "trees/layout.h"
#include "trees/queries/box_distance.h"
#include "trees/testing/brute_force.h"
#include "trees/testing/ways_to_build.h"

#include <algorithm>
#include <optional>

namespace boxwood::fuzz {
namespace {

constexpr std::size_t max_boxes = 48;

std::vector<Box> read_boxes(Bytes bytes) {
    Coordinates in(bytes);
    std::vector<Box> boxes;
    while (!in.at_end() && boxes.size() < max_boxes) {
        Vec3<float> corner[2];
        for (Vec3<float>& c : corner)
            for (int axis = 0; axis < 3; ++axis)
                c[axis] = in.next<float>();
        Box box{corner[0], corner[1]};
        if (is_finite(box.min) && is_finite(box.max)) // else it stays a bad one
            for (int axis = 0; axis < 3; ++axis)
                if (box.min[axis] > box.max[axis])
                    std::swap(box.min[axis], box.max[axis]);
        boxes.push_back(box);
    }
    return boxes;
}

/// The index of the first bad box, if there is one.
std::optional<std::size_t> refused(auto&& call) {
    try {
        call();
    } catch (const InvalidBox& error) {
        return error.index;
    }
    return {};
}

/// What a query gives, sorted.
template <class Query> std::vector<Pair> found(const Query& query) {
    std::vector<Pair> pairs;
    AppendPairs sink(pairs);
    query(sink);
    std::ranges::sort(pairs);
    return pairs;
}

struct Truth {
    std::vector<Pair> pairs, among, containing; ///< self, tree with itself, corners in boxes
    std::vector<Vec3<float>> points;
};

Truth truth_of(Boxes boxes) {
    Truth truth{brute_force(boxes), {}, {}, {}};
    for (std::uint32_t a = 0; a < boxes.size(); ++a) {
        truth.points.push_back(boxes[a].max);
        for (std::uint32_t b = 0; b < boxes.size(); ++b) {
            if (overlaps(boxes[a], boxes[b]))
                truth.among.push_back({a, b});
            if (overlaps(Box{boxes[a].max, boxes[a].max}, boxes[b]))
                truth.containing.push_back({a, b});
        }
    }
    return truth;
}

void judge(const AnyLayout& layout, Boxes boxes, const Truth& truth, const std::string& name) {
    if (layout.answers(Query::self_pairs))
        require(found([&](PairSink& to) { layout.self_pairs(serial(), to); }) == truth.pairs,
                name + ": wrong self pairs");
    if (layout.answers(Query::tree_pairs))
        require(found([&](PairSink& to) { layout.tree_pairs(layout, serial(), to); }) ==
                    truth.among,
                name + ": wrong tree pairs");
    if (layout.answers(Query::regions))
        require(found([&](PairSink& to) { layout.regions(boxes, serial(), to); }) == truth.among,
                name + ": wrong regions");
    if (layout.answers(Query::points))
        require(found([&](PairSink& to) { layout.points(truth.points, serial(), to); }) ==
                    truth.containing,
                name + ": wrong points");
    if (layout.answers(Query::nearest)) {
        std::vector<Neighbour> near(truth.points.size());
        layout.nearest(truth.points, 1, serial(), near);
        for (std::uint32_t i = 0; i < near.size(); ++i) { // its own box, or a lower item
            const auto own = std::ranges::lower_bound(truth.containing, Pair{i, 0});
            require(near[i].item == own->b, name + ": not the nearest item");
        }
    }
}

} // namespace

void box_trees(Bytes bytes) {
    const std::vector<Box> boxes = read_boxes(bytes);
    const auto bad = refused([&] { require_valid(boxes); });
    static const std::vector<std::string> ways = ways_to_build();
    const Truth truth = bad ? Truth{} : truth_of(boxes);
    for (const std::string& way : ways) {
        Tree tree;
        const auto refuses = refused([&] { tree = make_builder(way)(boxes, serial()); });
        require(refuses == bad, way + (bad ? " takes a bad box" : " refuses good boxes"));
        if (bad)
            continue;
        require(!validate(tree, boxes), way + " makes no valid tree");
        for (const LayoutEntry& entry : layouts())
            judge(*entry.make(tree, serial()), boxes, truth, way + "." + std::string(entry.name));
    }
}

} // namespace boxwood::fuzz
