#include "bench/tasks/detail/mesh_pair_answers.h"
#include "bench/truth/mesh_pair_truth.h"
#include "bench/truth/posed_triangles.h"
#include "kernels/oracle/nearest.h"
#include "kernels/oracle/oracle.h"
#include "trees/executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

Triangle<double> moved_by(const Triangle<double>& t, Vec3<double> by) {
    return {t.a + by, t.b + by, t.c + by};
}

/// How far b has to go along n until it is beyond a, rounded.
double overlap_along(Vec3<double> n, const Triangle<double>& a, const Triangle<double>& b) {
    return std::max({dot(n, a.a), dot(n, a.b), dot(n, a.c)}) -
           std::min({dot(n, b.a), dot(n, b.b), dot(n, b.c)});
}

double distance_to(Vec3<double> p, const Triangle<double>& t) {
    return std::sqrt(oracle::nearest(p, t).squared.get_d());
}

/// What is wrong with a contact of two triangles that touch; nothing if it is right.
std::string fault_of(const PosedContact& c, const Triangle<double>& a, const Triangle<double>& b,
                     double slack) {
    if (!is_finite(c.point) || !is_finite(c.normal) || !std::isfinite(c.depth))
        return "a number is not finite";
    if (std::abs(length(c.normal) - 1) > 1e-6)
        return fmt::format("the normal is {} long", length(c.normal));
    if (c.depth < -slack)
        return fmt::format("its depth is {}", c.depth);
    if (std::min(distance_to(c.point, a), distance_to(c.point, b)) > c.depth + slack)
        return "the point is on neither";
    if (c.depth > overlap_along(c.normal, a, b) + slack)
        return fmt::format("said to be {} deep, and along the normal they overlap by {}", c.depth,
                           overlap_along(c.normal, a, b));
    if (oracle::intersect(a, moved_by(b, (c.depth + slack) * c.normal)))
        return fmt::format("moved by its depth, {}, along the normal they still touch", c.depth);
    return {};
}

class ContactTruth final : public Truth {
  public:
    ContactTruth(const Scene& scene, unsigned threads)
        : scene_(scene), threads_(threads), mesh_(triangles_at(scene.mesh, {})),
          size_(size_of(mesh_)) {
        for (std::uint32_t i = 0; i < scene.poses.size(); ++i)
            for (const Pair p :
                 touching_pairs(mesh_, triangles_at(scene.copy(), scene.poses[i]), threads))
                touching_.push_back({i, p.a, p.b});
    }

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        const std::vector<PosedContact>& got = list_of<PosedContact>(answers);
        Judgement judgement;
        results::Check& check = judgement.check;
        check.oracle = "rational";
        check.n_checked = check.n_got = got.size();
        check.n_expected = touching_.size();
        judge_pairs(got, check);
        judge_order(got, check);
        judge_each(got, (contender.is_peer ? 0x1p-19 : 0x1p-30) * size_, check);
        judgement.conclude(false);
        return judgement;
    }

  private:
    static void complain(results::Check& check, std::uint64_t& count, const PosedPair& of,
                         const std::string& what) {
        ++count;
        if (check.witness.empty())
            check.witness =
                fmt::format("pose {}: triangles {} and {}: {}", of.pose, of.a, of.b, what);
    }

    bool touch(const PosedPair& pair) const { return std::ranges::binary_search(touching_, pair); }

    void judge_pairs(const std::vector<PosedContact>& got, results::Check& check) const {
        std::vector<PosedPair> named;
        for (const PosedContact& c : got) {
            named.push_back(c.triangles);
            if (!touch(c.triangles))
                complain(check, check.extra, c.triangles, "they are apart");
        }
        std::ranges::sort(named);
        for (const PosedPair& pair : touching_)
            if (!std::ranges::binary_search(named, pair))
                complain(check, check.missing, pair, "a contact is missing");
    }
    void judge_order(const std::vector<PosedContact>& got, results::Check& check) const {
        for (std::size_t i = 1; i < got.size(); ++i)
            if (got[i].triangles.pose < got[i - 1].triangles.pose ||
                (got[i].triangles.pose == got[i - 1].triangles.pose &&
                 got[i].depth > got[i - 1].depth))
                complain(check, check.extra, got[i].triangles, "it is deeper than one before it");
    }
    void judge_each(const std::vector<PosedContact>& got, double slack,
                    results::Check& check) const {
        std::vector<std::string> faults(got.size());
        make_executor("tbb", threads_)->for_each(got.size(), [&](std::size_t i) {
            const PosedPair& of = got[i].triangles;
            if (touch(of))
                faults[i] =
                    fault_of(got[i], mesh_[of.a],
                             triangle_at(scene_.copy(), of.b, scene_.poses[of.pose]), slack);
        });
        for (std::size_t i = 0; i < got.size(); ++i)
            if (!faults[i].empty())
                complain(check, check.extra, got[i].triangles, faults[i]);
    }

    const Scene& scene_;
    unsigned threads_;
    PosedTriangles mesh_;
    double size_;
    std::vector<PosedPair> touching_; ///< ascending
};

} // namespace

std::unique_ptr<Truth> make_contact_truth(const Scene& scene, unsigned threads) {
    return std::make_unique<ContactTruth>(scene, threads);
}

} // namespace boxwood::bench
