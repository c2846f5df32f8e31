#include "bench/truth/point_truth.h"

#include "bench/truth/sample.h"
#include "kernels/features/point_triangle.h"
#include "kernels/oracle/exact_answers.h"
#include "trees/executor.h"
#include "trees/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace boxwood::bench {
namespace {

using Vec = Vec3<double>;

double squared(Vec p, const Aabb<float>& box) {
    double squares = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = static_cast<double>(box.min[axis]),
                     high = static_cast<double>(box.max[axis]);
        const double off = p[axis] < low ? low - p[axis] : p[axis] > high ? p[axis] - high : 0;
        squares += off * off;
    }
    return squares;
}
double distance(Vec p, const Aabb<float>& box) { return std::sqrt(squared(p, box)); }

Triangle<double> triangle_of(const TriangleMesh& mesh, std::size_t i) {
    const Triangle<float> t = mesh.triangle(i);
    return {Vec(t.a), Vec(t.b), Vec(t.c)};
}

double size_of(const Triangle<double>& t) {
    return std::max({length(t.b - t.a), length(t.c - t.b), length(t.a - t.c)});
}

/// The distance, rounded from the exact rational number.
double exact_distance(Vec p, const Triangle<double>& t) {
    return std::sqrt(oracle::squared_distance(p, t).get_d());
}

/// What a sampled query must be answered.
struct Answer {
    std::vector<std::uint32_t> items; ///< points, regions: ascending; else the nearest
    std::vector<double> distances;    ///< nearest, closest_points
};

class PointTruth final : public Truth {
  public:
    PointTruth(const Scene& scene, PointQuery query, unsigned threads)
        : scene_(scene), query_(query),
          k_(query == PointQuery::nearest ? neighbours_of(scene) : 1) {
        const std::size_t n = n_queries(), items = std::max<std::size_t>(1, scene.boxes.size());
        const std::size_t m = std::min(n, std::clamp<std::size_t>(100'000'000 / items, 64, 4096));
        sample_ = sampled_queries(n, m, scene.spec.seed);
        answers_.resize(sample_.size());
        make_executor("tbb", threads)->for_each(sample_.size(), [&](std::size_t s) {
            answers_[s] = answer_of(sample_[s]);
        });
    }

    Judgement judge(const Answers& answers, const ContenderEntry&) override {
        Judgement judgement;
        results::Check& check = judgement.check;
        check.oracle = query_ == PointQuery::surface_point ? "rational" : "brute_force_f64";
        check.n_checked = sample_.size();
        bool exact = true;
        if (is_pairs()) {
            check_pairs(list_of<Pair>(answers), check);
        } else {
            check.max_abs_err = check.max_rel_err = 0;
            if (answers.size() != k_ * n_queries()) {
                check.n_got = answers.size();
                check.n_expected = check.missing = k_ * n_queries();
                check.witness =
                    fmt::format("{} answers for {} points", answers.size(), n_queries());
            } else if (query_ == PointQuery::nearest) {
                check_nearest(list_of<Neighbour>(answers), check, exact);
            } else {
                check_surface(list_of<SurfacePoint>(answers), check, exact);
            }
        }
        judgement.conclude(exact);
        return judgement;
    }

  private:
    bool is_pairs() const {
        return query_ == PointQuery::containing || query_ == PointQuery::overlapping;
    }
    std::size_t n_queries() const {
        return query_ == PointQuery::overlapping ? scene_.regions.size() + scene_.spheres.size()
                                                 : scene_.points.size();
    }

    bool meets(std::size_t query, const Aabb<float>& box) const {
        if (query_ == PointQuery::containing)
            return distance(Vec(scene_.points[query]), box) == 0;
        if (!scene_.spheres.empty()) {
            const Sphere<float>& ball = scene_.spheres[query];
            const double radius = static_cast<double>(ball.radius);
            return squared(Vec(ball.centre), box) <= radius * radius;
        }
        for (int axis = 0; axis < 3; ++axis)
            if (box.max[axis] < scene_.regions[query].min[axis] ||
                box.min[axis] > scene_.regions[query].max[axis])
                return false;
        return true;
    }

    Answer answer_of(std::size_t query) const {
        Answer answer;
        if (is_pairs()) {
            for (std::uint32_t i = 0; i < scene_.boxes.size(); ++i)
                if (meets(query, scene_.boxes[i]))
                    answer.items.push_back(i);
            return answer;
        }
        const Vec p(scene_.points[query]);
        if (query_ == PointQuery::nearest) {
            std::vector<std::pair<double, std::uint32_t>> all;
            for (std::uint32_t i = 0; i < scene_.boxes.size(); ++i)
                all.emplace_back(distance(p, scene_.boxes[i]), i);
            const std::size_t k = std::min(k_, all.size());
            std::ranges::partial_sort(all, all.begin() + static_cast<std::ptrdiff_t>(k));
            for (std::size_t i = 0; i < k; ++i) {
                answer.distances.push_back(all[i].first);
                answer.items.push_back(all[i].second);
            }
            return answer;
        }
        // By another way to the nearest point than that of the library's queries.
        double min_distance = std::numeric_limits<double>::infinity();
        for (std::uint32_t i = 0; i < scene_.mesh.triangles.size(); ++i) {
            if (distance(p, scene_.boxes[i]) > min_distance)
                continue;
            const double d =
                length(point_triangle::Foot::nearest(p, triangle_of(scene_.mesh, i)).offset);
            if (d < min_distance) {
                min_distance = d;
                answer.items = {i};
            }
        }
        answer.distances = {exact_distance(p, triangle_of(scene_.mesh, answer.items[0]))};
        return answer;
    }

    void check_pairs(const std::vector<Pair>& pairs, results::Check& check) const {
        std::vector<Pair> got = pairs;
        std::ranges::sort(got);
        for (std::size_t s = 0; s < sample_.size(); ++s) {
            const auto query = static_cast<std::uint32_t>(sample_[s]);
            std::vector<std::uint32_t> items, missing, extra;
            for (auto pair = std::ranges::lower_bound(got, query, {}, &Pair::a);
                 pair != got.end() && pair->a == query; ++pair)
                items.push_back(pair->b);
            std::ranges::set_difference(answers_[s].items, items, std::back_inserter(missing));
            std::ranges::set_difference(items, answers_[s].items, std::back_inserter(extra));
            check.n_got += items.size();
            check.n_expected += answers_[s].items.size();
            check.missing += missing.size();
            check.extra += extra.size();
            if (check.witness.empty() && !(missing.empty() && extra.empty()))
                check.witness = fmt::format("query {}: {} item {}", query,
                                            missing.empty() ? "extra" : "missing",
                                            missing.empty() ? extra[0] : missing[0]);
        }
        if (!got.empty() && got.back().a >= n_queries()) {
            ++check.extra;
            check.witness = fmt::format("there is no query {}", got.back().a);
        }
    }

    /// Notes an error, and whether it is too large; `size`: of what a distance is computed from.
    static bool off(double got, double expected, double size, results::Check& check) {
        const double error = std::abs(got - expected);
        check.max_abs_err = std::max(check.max_abs_err, error);
        if (error > 0 && expected > 0)
            check.max_rel_err = std::max(check.max_rel_err, error / expected);
        const bool too_far = !(error <= point_bound * (expected + size));
        check.bound_violations += too_far;
        return too_far;
    }

    void check_nearest(const std::vector<Neighbour>& got, results::Check& check,
                       bool& exact) const {
        for (std::size_t s = 0; s < sample_.size(); ++s) {
            const Vec p(scene_.points[sample_[s]]);
            std::set<std::uint32_t> seen;
            for (std::size_t j = 0; j < k_; ++j) {
                const Neighbour& near = got[k_ * sample_[s] + j];
                const bool wanted = j < answers_[s].items.size();
                const bool given = near.item < scene_.boxes.size();
                check.n_expected += wanted;
                check.n_got += given;
                if (wanted != given) {
                    ++(wanted ? check.missing : check.extra);
                } else if (given) {
                    const double d = answers_[s].distances[j];
                    exact &= near.item == answers_[s].items[j];
                    if (seen.insert(near.item).second &&
                        !off(distance(p, scene_.boxes[near.item]), d, 0, check) &&
                        !off(std::sqrt(near.squared_distance), d, 0, check))
                        continue;
                    ++check.extra;
                } else {
                    continue;
                }
                if (check.witness.empty())
                    check.witness = fmt::format("neighbour {} of point {}: item {}", j, sample_[s],
                                                static_cast<std::int64_t>(near.item));
            }
        }
    }

    void check_surface(const std::vector<SurfacePoint>& got, results::Check& check,
                       bool& exact) const {
        for (std::size_t s = 0; s < sample_.size(); ++s) {
            const Vec p(scene_.points[sample_[s]]);
            const SurfacePoint& near = got[sample_[s]];
            ++check.n_expected;
            if (near.triangle >= scene_.mesh.triangles.size()) {
                ++check.missing;
            } else {
                ++check.n_got;
                const Triangle<double> t = triangle_of(scene_.mesh, near.triangle);
                const double d = answers_[s].distances[0], size = size_of(t);
                const Vec at(near.point);
                const double rounded = 0x1p-22 * (length(at) + size); // of the point, to floats
                exact &= near.triangle == answers_[s].items[0];
                if (!off(exact_distance(p, t), d, size, check) &&
                    !off(std::sqrt(near.squared_distance), d, size, check) &&
                    exact_distance(at, t) <= rounded + point_bound * (d + size) &&
                    std::abs(length(at - p) - d) <= rounded + point_bound * (d + size))
                    continue;
                ++check.extra;
            }
            if (check.witness.empty())
                check.witness = fmt::format("point {}: triangle {}", sample_[s],
                                            static_cast<std::int64_t>(near.triangle));
        }
    }

    const Scene& scene_;
    PointQuery query_;
    std::size_t k_;
    std::vector<std::size_t> sample_;
    std::vector<Answer> answers_;
};

} // namespace

std::unique_ptr<Truth> make_point_truth(const Scene& scene, PointQuery query, unsigned threads) {
    return std::make_unique<PointTruth>(scene, query, threads);
}

} // namespace boxwood::bench
