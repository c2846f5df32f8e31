#include "bench/replay/shape_truth.h"

#include "bench/truth/column_sweep.h"
#include "bench/truth/nearest_triangles.h"
#include "kernels/arithmetic/rounding.h"
#include "trees/executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <thread>
#include <utility>

namespace boxwood::bench {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double max_size = 0x1p100;

PosedTriangles triangles_of(const RecordedProgram& program, const RecordedProgram::Geometry& of,
                            bool in_floats) {
    const auto corner = [&](std::uint32_t vertex) {
        const Vec3<double> p = program.vertices_of(of)[vertex];
        return in_floats ? Vec3<double>(Vec3<float>(p)) : p;
    };
    PosedTriangles all;
    for (const auto& [a, b, c] : program.triangles_of(of))
        all.push_back({corner(a), corner(b), corner(c)});
    return all;
}

/// Nothing for what link_solid does not know.
std::optional<LinkSolid> solid_of(const RecordedProgram& program,
                                  const RecordedProgram::Geometry& of) {
    const auto [a, b, c, d] = of.numbers;
    switch (of.shape) {
    case recording::Shape::mesh: { // libraries hold its corners in doubles, ours in floats
        LinkSolid surface;
        surface.inner = triangles_of(program, of, false);
        surface.outer = triangles_of(program, of, true);
        return surface;
    }
    case recording::Shape::box:
        return link_solid({LinkBox{{a, b, c}}, {}}, {});
    case recording::Shape::sphere:
        return link_solid({LinkSphere{a}, {}}, {});
    case recording::Shape::capsule:
        return link_solid({LinkCapsule{a, b}, {}}, {});
    case recording::Shape::cylinder:
        return link_solid({LinkCylinder{a, b}, {}}, {});
    default:
        return {};
    }
}

bool is_placeable(Vec3<double> p) { // NaN is not
    return std::abs(p.x) <= max_size && std::abs(p.y) <= max_size && std::abs(p.z) <= max_size;
}
bool are_placeable(const PosedTriangles& triangles) {
    return !triangles.empty() && std::ranges::all_of(triangles, [](const Triangle<double>& t) {
        return is_placeable(t.a) && is_placeable(t.b) && is_placeable(t.c);
    });
}

RigidTransform<double> pose_of(const RecordedProgram::State& state) {
    RigidTransform<double> pose;
    for (std::size_t row = 0; row < 3; ++row) {
        pose.rotation[row] = {state.pose[3 * row], state.pose[3 * row + 1],
                              state.pose[3 * row + 2]};
        pose.translation[static_cast<int>(row)] = state.pose[9 + row];
    }
    return pose;
}

/// How far its matrix is from a rotation.
double defect(const RigidTransform<double>& pose) {
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j <= i; ++j)
            most = std::max(most,
                            std::abs(dot(pose.rotation[i], pose.rotation[j]) - (i == j ? 1 : 0)));
    return most;
}

/// Rounding down.
double gap(const Aabb<double>& a, const Aabb<double>& b) {
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = std::max({0., a.min[axis] - b.max[axis], b.min[axis] - a.max[axis]});
        squared += d * d;
    }
    return std::sqrt(squared) * (1 - 0x1p-50);
}

/// From any point of one to any of the other.
double farthest(const Aabb<double>& a, const Aabb<double>& b) {
    return length(max(a.max, b.max) - min(a.min, b.min));
}

unsigned all_cores() { return std::max(1u, std::thread::hardware_concurrency()); }

} // namespace

/// Plays the program.
class ShapeTruth::Builder {
  public:
    Builder(ShapeTruth& truth, double max_tests, const std::function<bool()>& goes_on)
        : truth_(truth), program_(truth.program_), left_(max_tests), goes_on_(goes_on),
          pose_(program_.n_objects()), is_there_(program_.n_objects(), 0),
          is_stale_(program_.n_objects(), 0), boxes_(program_.n_objects()) {}

    void run() {
        for (std::size_t i = 0; i < program_.calls.size() && left_ > 0; ++i) {
            const RecordedProgram::Call& call = program_.calls[i];
            for (const RecordedProgram::State& state : program_.states_of(call)) {
                is_stale_[state.object] = is_there_[state.object] && is_query(call.what);
                pose_[state.object] = pose_of(state);
                boxes_[state.object].reset();
            }
            if (!is_query(call.what)) {
                change(call);
                continue;
            }
            if (is_with_others(call.what) || (is_of_one(call.what) && call.n_objects == 0))
                continue;
            if (!goes_on_())
                return;
            Query query;
            if (!answer(call, query))
                continue;
            query.is_checked = true;
            ++truth_.n_checked_;
            truth_.queries_[i] = std::move(query);
        }
    }

  private:
    struct Candidate {
        double gap; ///< of their boxes
        Pair pair;
    };

    void change(const RecordedProgram::Call& call) {
        for (const std::uint32_t object : program_.objects_of(call)) {
            is_stale_[object] = 0;
            if (call.what == recording::Call::add || call.what == recording::Call::remove)
                is_there_[object] = call.what == recording::Call::add;
        }
        if (call.what == recording::Call::clear)
            is_there_.assign(is_there_.size(), 0);
        if (call.what == recording::Call::clear || call.what == recording::Call::update_all)
            is_stale_.assign(is_stale_.size(), 0);
    }

    /// False: an object is not known, or too many tests were to be made.
    bool answer(const RecordedProgram::Call& call, Query& query) {
        std::vector<std::uint32_t> objects;
        for (std::uint32_t object = 0; object < is_there_.size(); ++object)
            if (is_there_[object])
                objects.push_back(object);
        std::optional<std::uint32_t> one;
        if (is_of_one(call.what)) {
            one = program_.objects_of(call)[0];
            if (!is_there_[*one])
                objects.push_back(*one);
        }
        for (const std::uint32_t object : objects)
            if (is_stale_[object] || !find_box(object))
                return false;
        const bool is_answered = is_distance(call.what)
                                     ? find_nearest(objects, one, query)
                                     : find_touching(candidates(objects, one), query);
        truth_.n_too_dear_ += !is_answered;
        return is_answered;
    }
    /// False: it is not known, or nowhere.
    bool find_box(std::uint32_t object) {
        std::optional<Aabb<double>>& box = boxes_[object];
        const RigidTransform<double>& pose = pose_[object];
        if (!truth_.known_[program_.geometry_of[object]])
            return false;
        if (box)
            return true;
        Aabb<double> found;
        bool is_somewhere = true;
        for (const PosedTriangles* side : sides(object))
            for (const Triangle<double>& t : *side)
                for (const Vec3<double> corner : {pose(t.a), pose(t.b), pose(t.c)}) {
                    is_somewhere = is_somewhere && is_placeable(corner);
                    found.extend(corner);
                }
        if (is_somewhere)
            box = found;
        return is_somewhere;
    }
    std::span<const PosedTriangles* const> sides(std::uint32_t object) {
        const Known& known = truth_.known(object);
        sides_[0] = &known.solid.inner;
        sides_[1] = &known.solid.outer;
        return std::span(sides_).first(known.is_exact ? 1 : 2);
    }
    const Aabb<double>& box(std::uint32_t object) const { return *boxes_[object]; }
    PlacedSolid placed(std::uint32_t object) const {
        return {truth_.known(object).solid, pose_[object]};
    }
    bool are_exact(Pair p) const {
        return truth_.known(p.a).is_exact && truth_.known(p.b).is_exact;
    }

    std::vector<Pair> candidates(const std::vector<std::uint32_t>& objects,
                                 std::optional<std::uint32_t> one) const {
        std::vector<Pair> pairs;
        if (one) {
            for (const std::uint32_t other : objects)
                if (other != *one && overlaps(box(*one), box(other)))
                    pairs.push_back({std::min(*one, other), std::max(*one, other)});
            std::ranges::sort(pairs);
            return pairs;
        }
        std::vector<Aabb<float>> rounded;
        for (const std::uint32_t object : objects)
            rounded.push_back(round_outward(box(object)));
        for (const Pair p : ColumnSweep(rounded, all_cores()).pairs())
            pairs.push_back({objects[p.a], objects[p.b]}); // both ascend
        return pairs;
    }

    bool find_touching(const std::vector<Pair>& pairs, Query& query) {
        double cost = 0;
        for (const Pair p : pairs)
            cost += tests(p);
        if (cost > left_)
            return false;
        left_ -= cost;
        constexpr std::size_t some = 1024; // between two looks at goes_on
        std::vector<Touch> touch(pairs.size());
        const auto executor = make_executor("tbb", all_cores());
        for (std::size_t from = 0; from < pairs.size(); from += some) {
            if (!goes_on_())
                return false;
            executor->for_each(std::min(some, pairs.size() - from), [&](std::size_t i) {
                const Pair p = pairs[from + i];
                touch[from + i] = touch_of(placed(p.a), placed(p.b), are_exact(p));
            });
        }
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            if (touch[i].surely)
                query.touching.push_back(pairs[i]);
            if (touch[i].maybe)
                query.maybe.push_back(pairs[i]);
        }
        return true;
    }

    bool find_nearest(const std::vector<std::uint32_t>& objects, std::optional<std::uint32_t> one,
                      Query& query) {
        const auto n = static_cast<double>(objects.size());
        const double cost = one ? n : n * n / 2;
        if (cost > left_)
            return false;
        left_ -= cost;
        const auto each_pair = [&](const auto& take) {
            for (std::size_t i = 0; i < objects.size(); ++i)
                for (std::size_t j = one ? objects.size() : i + 1; j < objects.size(); ++j)
                    take(objects[i], objects[j]);
            for (std::size_t i = 0; i < objects.size() && one; ++i)
                if (objects[i] != *one)
                    take(*one, objects[i]);
        };
        double enough = infinity; // a pair is no farther apart
        each_pair([&](std::uint32_t a, std::uint32_t b) {
            enough = std::min(enough, farthest(box(a), box(b)));
        });
        std::vector<Candidate> near;
        each_pair([&](std::uint32_t a, std::uint32_t b) {
            const double apart = gap(box(a), box(b));
            if (apart <= enough)
                near.push_back({apart, {a, b}});
        });
        std::ranges::sort(near, {}, &Candidate::gap);
        query.lo = query.hi = infinity;
        for (const Candidate& candidate : near) {
            if (candidate.gap > query.hi || query.hi <= 0)
                break;
            left_ -= searched_of * std::sqrt(tests(candidate.pair));
            if (left_ < 0 || !goes_on_())
                return false;
            take_distance(candidate.pair, query);
        }
        query.lo = std::min(query.lo, query.hi);
        return true;
    }
    /// Of surfaces; solids in one another are 0 apart.
    void take_distance(Pair pair, Query& query) const {
        const PlacedSolid a = placed(pair.a), b = placed(pair.b);
        const bool is_solid = a.solid->level || b.solid->level;
        const Touch touch = is_solid ? touch_of(a, b, are_exact(pair)) : Touch{};
        const auto least = [&](const PosedTriangles& s, const PosedTriangles& t) {
            return NearestTriangles(s).to(NearestTriangles(t), query.hi);
        };
        const NearestTriangles::Least none{0, 0};
        const auto inner = touch.surely ? none : least(a.inner, b.inner);
        const auto outer = are_exact(pair) ? inner : touch.maybe ? none : least(a.outer, b.outer);
        query.lo = std::min({query.lo, inner.lo, outer.lo});
        query.hi = std::min(query.hi, std::max(inner.distance, outer.distance));
        const auto off = [&](bool in_floats) {
            return truth_.rounding(pair, pose_[pair.a], pose_[pair.b], in_floats);
        };
        query.off = std::max(query.off, off(false));
        query.off_in_floats = std::max(query.off_in_floats, off(true));
    }

    double tests(Pair p) const {
        const auto n = [&](std::uint32_t object) {
            return static_cast<double>(truth_.known(object).solid.outer.size());
        };
        return n(p.a) * n(p.b);
    }
    static constexpr double searched_of = 100; ///< tests for a triangle, of branch and bound

    ShapeTruth& truth_;
    const RecordedProgram& program_;
    double left_; ///< tests that may be made
    const std::function<bool()>& goes_on_;
    std::vector<RigidTransform<double>> pose_; ///< by object
    std::vector<char> is_there_, is_stale_;    ///< by object; stale: it moved, and no one was told
    std::vector<std::optional<Aabb<double>>> boxes_; ///< by object, where it was last looked at
    const PosedTriangles* sides_[2] = {};
};

ShapeTruth::ShapeTruth(const RecordedProgram& program, double max_tests,
                       const std::function<bool()>& goes_on)
    : program_(program), queries_(program.calls.size()) {
    if (!(max_tests > 0))
        return;
    for (const RecordedProgram::Geometry& geometry : program.geometries) {
        std::optional<Known>& known = known_.emplace_back();
        std::optional<LinkSolid> solid = solid_of(program, geometry);
        if (!solid || !are_placeable(solid->inner) || !are_placeable(solid->outer))
            continue;
        known.emplace();
        known->is_exact = solid->inner == solid->outer;
        known->reach = std::sqrt(3.) * size_of(solid->outer);
        known->solid = *std::move(solid);
    }
    Builder(*this, max_tests, goes_on).run();
}

ShapeTruth::Touch ShapeTruth::touch_of(const PlacedSolid& a, const PlacedSolid& b, bool are_exact) {
    const bool inner = surely_touch(a, b);
    if (are_exact)
        return {inner, inner};
    const bool outer = may_touch(a, b);
    return {inner && outer, inner || outer};
}

double ShapeTruth::rounding(Pair pair, const RigidTransform<double>& a,
                            const RigidTransform<double>& b, bool in_floats) const {
    double off = 0, size = 0;
    for (const auto& [object, pose] : {std::pair{pair.a, &a}, {pair.b, &b}}) {
        const Known& of = known(object);
        size += of.reach + length(pose->translation);
        off += 2 * defect(*pose) * of.reach;
        if (of.solid.level)
            off += 1e-6 * of.reach;
        else if (!of.is_exact)
            off += 0x1p-22 * of.reach;
    }
    return off + (in_floats || program_.bits == 32 ? 0x1p-20 : 0x1p-40) * size;
}

/// Touching ones that a shift takes apart, or others that are as near as that.
bool ShapeTruth::may_be_either(std::size_t call, Pair pair, bool touches, bool in_floats) const {
    const auto pose_at = [&](std::uint32_t object) {
        const RecordedProgram::Call& last = program_.calls[call];
        for (std::size_t i = last.first_state + last.n_states; i-- > 0;)
            if (program_.states[i].object == object)
                return pose_of(program_.states[i]);
        return RigidTransform<double>{};
    };
    const RigidTransform<double> at_a = pose_at(pair.a), at_b = pose_at(pair.b);
    const double off = rounding(pair, at_a, at_b, in_floats);
    const PlacedSolid a(known(pair.a).solid, at_a);
    if (!touches) {
        const PlacedSolid b(known(pair.b).solid, at_b);
        if (overlaps(a.box, b.box) && touch_of(a, b, false).maybe)
            return false; // one of them is not there
        const NearestTriangles of_a(a.outer), of_b(b.outer);
        return of_a.to(of_b).lo <= off;
    }
    for (int axis = 0; axis < 3; ++axis)
        for (const double shift : {-2 * off, 2 * off}) {
            RigidTransform<double> moved = at_b;
            moved.translation[axis] += shift;
            const PlacedSolid b(known(pair.b).solid, moved);
            if (!touch_of(a, b, false).surely)
                return true;
        }
    return false;
}

std::string ShapeTruth::fault(std::size_t call, const ReplayedCall& found, bool in_floats) const {
    const Query& query = queries_[call];
    if (!query.is_checked)
        return "";
    if (is_distance(program_.calls[call].what)) {
        const double got = found.min_distance, off = in_floats ? query.off_in_floats : query.off;
        const auto near = [&](double x) { return 1e-6 * x + off; };
        const bool is_far = got == query.lo || got >= query.lo - near(query.lo); // both infinite
        const bool is_near = got == query.hi || got <= query.hi + near(query.hi);
        if (is_far && is_near)
            return "";
        return fmt::format("said to be {} apart, and it is {}{}", got, query.lo,
                           query.hi > query.lo ? fmt::format(" to {}", query.hi) : "");
    }
    std::vector<Pair> got = found.touching, extra, missing;
    std::ranges::sort(got);
    if (const auto twice = std::ranges::adjacent_find(got); twice != got.end())
        return fmt::format("objects {} and {} were shown twice", twice->a, twice->b);
    std::ranges::set_difference(got, query.maybe, std::back_inserter(extra));
    for (const Pair p : extra)
        if (p.a == p.b || !known_[program_.geometry_of[p.a]] ||
            !known_[program_.geometry_of[p.b]] || !may_be_either(call, p, false, in_floats))
            return fmt::format("objects {} and {} do not touch", p.a, p.b);
    if (program_.calls[call].ended && !got.empty())
        return "";
    std::ranges::set_difference(query.touching, got, std::back_inserter(missing));
    for (const Pair p : missing)
        if (!may_be_either(call, p, true, in_floats))
            return fmt::format("objects {} and {} touch", p.a, p.b);
    return "";
}

} // namespace boxwood::bench
