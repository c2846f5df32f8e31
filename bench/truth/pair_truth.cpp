#include "bench/truth/pair_truth.h"

#include "bench/peers/brute_force.h"
#include "bench/tasks/detail/halves.h"
#include "bench/truth/column_sweep.h"
#include "bench/truth/pairs_digest.h"
#include "kernels/oracle/oracle.h"
#include "trees/executor.h"

#include <algorithm>

namespace boxwood::bench {
namespace {

/// Up to here every pair is tested, in some tenth of a second. Beyond, those of one column.
constexpr std::size_t max_boxes_for_all_pairs = 20'000;

/// Calls body(i, part) for each i < n on `threads` threads and joins the parts, sorted.
template <class Body> std::vector<Pair> gather(std::size_t n, unsigned threads, const Body& body) {
    std::vector<std::vector<Pair>> parts(n);
    make_executor("tbb", threads)->for_each(n, [&](std::size_t i) { body(i, parts[i]); });
    return sorted_pairs(std::move(parts));
}

constexpr std::size_t rows_per_part = 4 * BruteForce::tile;

std::size_t parts_of(std::size_t n) { return (n + rows_per_part - 1) / rows_per_part; }

/// Columns [begin, n) against the rows before min(column, row_end).
std::vector<Pair> all_pairs(std::span<const Aabb<float>> boxes, std::size_t begin,
                            std::size_t row_end, unsigned threads) {
    const BruteForce columns(boxes);
    const std::size_t n = boxes.size();
    return gather(parts_of(n - begin), threads, [&](std::size_t part, std::vector<Pair>& out) {
        const std::size_t first = begin + part * rows_per_part;
        columns.append_columns(first, std::min(n, first + rows_per_part), row_end, out);
    });
}

/// Of the pairs whose boxes overlap, those whose triangles share a point: a corner of the mesh by
/// number, else by the rational oracle.
std::vector<Pair> touching(const TriangleMesh& mesh, std::vector<Pair> candidates,
                           unsigned threads) {
    const auto triangle = [&](std::uint32_t i) {
        const Triangle<float> t = mesh.triangle(i);
        return Triangle<double>{Vec3<double>(t.a), Vec3<double>(t.b), Vec3<double>(t.c)};
    };
    const auto share_a_corner = [&](Pair p) {
        return std::ranges::any_of(mesh.triangles[p.a], [&](std::uint32_t corner) {
            return std::ranges::find(mesh.triangles[p.b], corner) != mesh.triangles[p.b].end();
        });
    };
    std::vector<std::uint8_t> touch(candidates.size());
    make_executor("tbb", threads)->for_each(candidates.size(), [&](std::size_t i) {
        const Pair p = candidates[i];
        touch[i] = share_a_corner(p) || oracle::intersect(triangle(p.a), triangle(p.b));
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i)
        if (touch[i])
            candidates[kept++] = candidates[i];
    candidates.resize(kept);
    return candidates;
}

class PairTruth final : public Truth {
  public:
    PairTruth(const Scene& scene, PairsOf what, unsigned threads)
        : scene_(scene), what_(what), threads_(threads),
          is_small_(scene.boxes.size() <= max_boxes_for_all_pairs) {
        if (what == PairsOf::triangles) {
            touching_ = touching(scene.mesh, overlapping(), threads);
            expected_ = digest_of(touching_);
        } else {
            expected_ = is_small_ ? digest_of(overlapping())
                                  : ColumnSweep(scene.boxes, threads).digest(left_out());
        }
    }

    Judgement judge(const Answers& answers, const ContenderEntry&) override {
        const std::vector<Pair>& pairs = list_of<Pair>(answers);
        Judgement judgement;
        results::Check& check = judgement.check;
        check.oracle = what_ == PairsOf::triangles ? "rational"
                       : is_small_                 ? "brute_force"
                                                   : "sweep";
        check.n_checked = check.n_got = pairs.size();
        check.n_expected = expected_.count;
        if (digest_of(pairs) == expected_)
            return judgement;
        const PairsDifference wrong =
            difference(what_ == PairsOf::triangles ? touching_ : overlapping(), pairs);
        judgement.status = Status::wrong;
        check.missing = wrong.missing;
        check.extra = wrong.extra;
        check.witness = wrong.witness;
        return judgement;
    }

  private:
    /// Pairs of boxes of one side.
    std::function<bool(Pair)> left_out() const {
        if (what_ != PairsOf::two_halves)
            return {};
        return [split = tree_pairs_split(scene_.boxes.size())](Pair p) {
            return p.a >= split || p.b < split;
        };
    }
    std::vector<Pair> overlapping() const {
        const std::size_t n = scene_.boxes.size(), split = tree_pairs_split(n);
        if (is_small_)
            return what_ == PairsOf::two_halves ? all_pairs(scene_.boxes, split, split, threads_)
                                                : all_pairs(scene_.boxes, 0, n, threads_);
        std::vector<Pair> pairs = ColumnSweep(scene_.boxes, threads_).pairs();
        if (what_ == PairsOf::two_halves)
            std::erase_if(pairs, left_out());
        return pairs;
    }

    const Scene& scene_;
    PairsOf what_;
    unsigned threads_;
    bool is_small_;
    std::vector<Pair> touching_; ///< of triangles, ascending
    PairsDigest expected_;
};

} // namespace

std::unique_ptr<Truth> make_pair_truth(const Scene& scene, PairsOf what, unsigned threads) {
    return std::make_unique<PairTruth>(scene, what, threads);
}

} // namespace boxwood::bench
