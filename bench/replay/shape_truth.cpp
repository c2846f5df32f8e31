#include "bench/replay/shape_truth.h"

#include "bench/truth/column_sweep.h"
#include "bench/truth/link_solid.h"
#include "bench/truth/nearest_triangles.h"
#include "kernels/arithmetic/rounding.h"
#include "trees/executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

namespace boxwood::bench {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double thinner = 1 - 0x1p-20; ///< of a solid that surely touches what touches it

void scale(PosedTriangles& triangles, double by) {
    for (Triangle<double>& t : triangles)
        t = {by * t.a, by * t.b, by * t.c};
}

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
    LinkShape shape;
    switch (of.shape) {
    case recording::Shape::mesh: { // libraries hold its corners in doubles, ours in floats
        LinkSolid surface;
        surface.inner = triangles_of(program, of, false);
        surface.outer = triangles_of(program, of, true);
        return surface;
    }
    case recording::Shape::box:
        shape = LinkBox{{a, b, c}};
        break;
    case recording::Shape::sphere:
        shape = LinkSphere{a};
        break;
    case recording::Shape::capsule:
        shape = LinkCapsule{a, b};
        break;
    case recording::Shape::cylinder:
        shape = LinkCylinder{a, b};
        break;
    default:
        return {};
    }
    LinkSolid solid = link_solid({shape, {}}, {});
    scale(solid.inner, thinner);
    scale(solid.outer, 1 / thinner);
    return solid;
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
double reach(const Aabb<double>& a, const Aabb<double>& b) {
    return length(max(a.max, b.max) - min(a.min, b.min));
}

} // namespace

/// Plays the program.
class ShapeTruth::Builder {
  public:
    Builder(ShapeTruth& truth, double max_tests)
        : truth_(truth), program_(truth.program_), left_(max_tests), pose_(program_.n_objects()),
          is_there_(program_.n_objects(), 0), placed_(program_.n_objects()) {
        for (const RecordedProgram::Geometry& geometry : program_.geometries) {
            std::optional<LinkSolid>& solid = solids_.emplace_back(solid_of(program_, geometry));
            truth_.is_of_meshes_ &= geometry.shape == recording::Shape::mesh;
            is_exact_.push_back(solid && solid->inner == solid->outer);
            Nearest& nearest = nearest_.emplace_back();
            if (solid) {
                nearest.inner = std::make_unique<NearestTriangles>(solid->inner);
                nearest.outer = std::make_unique<NearestTriangles>(solid->outer);
            }
        }
    }

    void run(const std::function<bool()>& goes_on) {
        for (std::size_t i = 0; i < program_.calls.size() && left_ > 0; ++i) {
            const RecordedProgram::Call& call = program_.calls[i];
            bool is_stale = false;
            for (const RecordedProgram::State& state : program_.states_of(call)) {
                is_stale |= is_there_[state.object] != 0;
                pose_[state.object] = pose_of(state);
                placed_[state.object].reset();
            }
            if (!is_query(call.what)) {
                change(call);
                continue;
            }
            if (is_stale || is_with_others(call.what) || (is_of_one(call.what) && !call.n_objects))
                continue;
            if (!goes_on())
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
    struct Nearest {
        std::unique_ptr<NearestTriangles> inner, outer;
    };
    struct Touch {
        bool surely = false, maybe = false;
    };
    struct Candidate {
        double gap; ///< of their boxes
        Pair pair;
    };

    void change(const RecordedProgram::Call& call) {
        for (const std::uint32_t object : program_.objects_of(call))
            if (call.what == recording::Call::add || call.what == recording::Call::remove)
                is_there_[object] = call.what == recording::Call::add;
        if (call.what == recording::Call::clear)
            is_there_.assign(is_there_.size(), 0);
    }

    const LinkSolid& solid(std::uint32_t object) const {
        return *solids_[program_.geometry_of[object]];
    }
    /// False: an object is not known, or too many pairs of triangles are to be looked at.
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
        for (const std::uint32_t object : objects) {
            if (!solids_[program_.geometry_of[object]] || !place(object))
                return false;
        }
        if (is_distance(call.what))
            return find_nearest(objects, one, query);
        return find_touching(candidates(objects, one), query);
    }
    /// False: it is too far away, or nowhere.
    bool place(std::uint32_t object) {
        std::optional<PlacedSolid>& placed = placed_[object];
        if (placed)
            return true;
        placed.emplace(solid(object), pose_[object]);
        const double size = size_of(placed->outer) + size_of(placed->inner);
        if (!(size <= 0x1p100)) { // NaN, too
            placed.reset();
            return false;
        }
        truth_.size_ = std::max(truth_.size_, size);
        return true;
    }
    const PlacedSolid& at(std::uint32_t object) const { return *placed_[object]; }

    std::vector<Pair> candidates(const std::vector<std::uint32_t>& objects,
                                 std::optional<std::uint32_t> one) const {
        std::vector<Pair> pairs;
        if (one) {
            for (const std::uint32_t other : objects)
                if (other != *one && overlaps(at(*one).box, at(other).box))
                    pairs.push_back({std::min(*one, other), std::max(*one, other)});
            std::ranges::sort(pairs);
            return pairs;
        }
        std::vector<Aabb<float>> boxes;
        for (const std::uint32_t object : objects)
            boxes.push_back(round_outward(at(object).box));
        for (const Pair p : ColumnSweep(boxes, threads()).pairs())
            pairs.push_back({objects[p.a], objects[p.b]}); // both ascend
        return pairs;
    }

    bool find_touching(std::vector<Pair> pairs, Query& query) {
        for (const Pair p : pairs)
            left_ -= tests(p);
        if (left_ < 0)
            return false;
        std::vector<std::uint8_t> surely(pairs.size()), maybe(pairs.size());
        make_executor("tbb", threads())->for_each(pairs.size(), [&](std::size_t i) {
            const Touch touch = touch_of(pairs[i]);
            surely[i] = touch.surely;
            maybe[i] = touch.maybe;
        });
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            if (surely[i])
                query.touching.push_back(pairs[i]);
            if (maybe[i])
                query.maybe.push_back(pairs[i]);
        }
        return true;
    }

    bool are_exact(Pair p) const {
        return is_exact_[program_.geometry_of[p.a]] && is_exact_[program_.geometry_of[p.b]];
    }
    Touch touch_of(Pair p) const {
        const bool inner = surely_touch(at(p.a), at(p.b));
        if (are_exact(p))
            return {inner, inner};
        const bool outer = may_touch(at(p.a), at(p.b)); // of rounded meshes either holds the other
        return {inner && outer, inner || outer};
    }

    bool find_nearest(const std::vector<std::uint32_t>& objects, std::optional<std::uint32_t> one,
                      Query& query) {
        std::vector<Candidate> near;
        double enough = infinity; // a pair is no farther apart
        const auto each_pair = [&](const auto& take) {
            for (std::size_t i = 0; i < objects.size(); ++i)
                for (std::size_t j = one ? objects.size() : i + 1; j < objects.size(); ++j)
                    take(objects[i], objects[j]);
            for (std::size_t i = 0; i < objects.size() && one; ++i)
                if (objects[i] != *one)
                    take(*one, objects[i]);
        };
        const auto n = static_cast<double>(objects.size());
        left_ -= one ? n : n * n / 2;
        if (left_ < 0)
            return false;
        each_pair([&](std::uint32_t a, std::uint32_t b) {
            enough = std::min(enough, reach(at(a).box, at(b).box));
        });
        each_pair([&](std::uint32_t a, std::uint32_t b) {
            const double apart = gap(at(a).box, at(b).box);
            if (apart <= enough)
                near.push_back({apart, {a, b}});
        });
        std::ranges::sort(near, {}, &Candidate::gap);
        query.lo = query.hi = infinity;
        for (const Candidate& candidate : near)
            if (candidate.gap <= 0)
                query.hi = std::min(query.hi, no_farther(candidate.pair));
        for (const Candidate& candidate : near) {
            if (candidate.gap > query.hi || query.hi <= 0)
                break;
            left_ -= tests(candidate.pair);
            if (left_ < 0)
                return false;
            take_distance(candidate.pair, query);
        }
        query.lo = std::min(query.lo, query.hi);
        return true;
    }
    /// By some of the corners.
    double no_farther(Pair pair) const {
        const auto of = [&](const PosedTriangles& a, const PosedTriangles& b) {
            double squared = infinity;
            for (const Triangle<double>& s : a)
                for (const Triangle<double>& t : b)
                    squared = std::min(squared, dot(s.a - t.a, s.a - t.a));
            return std::sqrt(squared) * (1 + 0x1p-40);
        };
        const PlacedSolid &a = at(pair.a), &b = at(pair.b);
        return std::max(of(a.inner, b.inner), are_exact(pair) ? 0 : of(a.outer, b.outer));
    }
    /// Of surfaces; solids in one another are 0 apart.
    void take_distance(Pair pair, Query& query) const {
        const PlacedSolid &a = at(pair.a), &b = at(pair.b);
        const bool is_solid = a.solid->level || b.solid->level;
        const Touch touch = is_solid ? touch_of(pair) : Touch{};
        const auto least = [&](auto side, auto triangles) {
            NearestTriangles of_a = *(nearest_[program_.geometry_of[pair.a]].*side),
                             of_b = *(nearest_[program_.geometry_of[pair.b]].*side);
            of_a.move(a.*triangles);
            of_b.move(b.*triangles);
            return of_a.to(of_b, query.hi);
        };
        const NearestTriangles::Least none{0, 0};
        const auto inner = touch.surely ? none : least(&Nearest::inner, &PlacedSolid::inner);
        const auto outer = are_exact(pair) ? inner
                           : touch.maybe   ? none
                                           : least(&Nearest::outer, &PlacedSolid::outer);
        query.lo = std::min({query.lo, inner.lo, outer.lo});
        query.hi = std::min(query.hi, std::max(inner.distance, outer.distance));
    }

    double tests(Pair p) const {
        return static_cast<double>(at(p.a).outer.size()) *
               static_cast<double>(at(p.b).outer.size());
    }
    static unsigned threads() { return std::max(1u, std::thread::hardware_concurrency()); }

    ShapeTruth& truth_;
    const RecordedProgram& program_;
    double left_;                                    ///< tests that may be made
    std::vector<std::optional<LinkSolid>> solids_;   ///< by geometry
    std::vector<char> is_exact_;                     ///< by geometry: no two stand in for it
    std::vector<Nearest> nearest_;                   ///< by geometry, in its frame
    std::vector<RigidTransform<double>> pose_;       ///< by object
    std::vector<char> is_there_;                     ///< by object
    std::vector<std::optional<PlacedSolid>> placed_; ///< by object, where it was last looked at
};

ShapeTruth::ShapeTruth(const RecordedProgram& program, double max_tests,
                       const std::function<bool()>& goes_on)
    : program_(program), queries_(program.calls.size()) {
    Builder(*this, max_tests).run(goes_on);
}

std::string ShapeTruth::fault(std::size_t call, const ReplayedCall& found, bool in_floats) const {
    const Query& query = queries_[call];
    if (!query.is_checked)
        return "";
    if (is_distance(program_.calls[call].what)) {
        const double slack = in_floats ? 0x1p-20 : is_of_meshes_ ? 1e-9 : 1e-6;
        const auto near = [&](double x) { return (in_floats ? slack : 1e-6) * x + slack * size_; };
        const double got = found.min_distance;
        const bool is_far = got == query.lo || got >= query.lo - near(query.lo); // both infinite
        const bool is_near = got == query.hi || got <= query.hi + near(query.hi);
        if (is_far && is_near)
            return "";
        return fmt::format("said to be {} apart, and it is {}{}", got, query.lo,
                           query.hi > query.lo ? fmt::format(" to {}", query.hi) : "");
    }
    std::vector<Pair> got = found.touching;
    std::ranges::sort(got);
    std::vector<Pair> wrong;
    std::ranges::set_difference(got, query.maybe, std::back_inserter(wrong)); // or shown twice
    if (!wrong.empty())
        return fmt::format("objects {} and {} do not touch, or were shown twice", wrong[0].a,
                           wrong[0].b);
    if (program_.calls[call].ended && !got.empty())
        return "";
    std::ranges::set_difference(query.touching, got, std::back_inserter(wrong));
    return wrong.empty() ? "" : fmt::format("objects {} and {} touch", wrong[0].a, wrong[0].b);
}

} // namespace boxwood::bench
