#pragma once

#include "kernels/triangle_triangle/triangle_kernel.h"
#include "trees/queries/filters.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace boxwood {

/// How many pairs of triangles each tier of a kernel decided (3: the third and higher), and how
/// many none did.
struct TierCounts {
    std::array<std::uint64_t, 4> decided{};
    std::uint64_t undecided = 0;

    void add(Decision v) {
        ++decided[std::min<std::size_t>(v.tier, 3)];
        undecided += v.answer == Answer::maybe ? 1 : 0;
    }
};

/// Hands on to another sink the pairs whose triangles share a point by the kernel K, in the same
/// order and chunks. A `maybe` is handed on as well: the policy of never-miss. Items are triangles
/// of `mesh`, or those of a pair of `a` and of `b`, which have triangle(i) as a TriangleMesh does.
/// Batch kernels are given whole blocks; the decisions are the same as one by one. `tiers`, if
/// given, is added to, and then all must happen on one thread.
template <TriangleKernel K, class Mesh = TriangleMesh>
class TouchingPairs final : public PairFilter {
  public:
    TouchingPairs(const Mesh& mesh, PairSink& sink, TierCounts* tiers = nullptr)
        : TouchingPairs(mesh, mesh, sink, tiers) {}
    TouchingPairs(const Mesh& a, const Mesh& b, PairSink& sink, TierCounts* tiers = nullptr)
        : PairFilter(sink), a_(a), b_(b), tiers_(tiers) {}

    bool take(std::size_t chunk, std::span<const Pair> pairs) override {
        while (!pairs.empty()) {
            const auto piece = pairs.first(std::min(pairs.size(), piece_size));
            if (!take_piece(chunk, piece))
                return false;
            pairs = pairs.subspan(piece.size());
        }
        return true;
    }

  private:
    using Real = typename K::Real;
    static constexpr std::size_t piece_size = 64;

    static Triangle<Real> triangle(const Mesh& mesh, std::uint32_t item) {
        const Triangle<float> t = mesh.triangle(item);
        return {Vec3<Real>(t.a), Vec3<Real>(t.b), Vec3<Real>(t.c)};
    }

    bool take_piece(std::size_t chunk, std::span<const Pair> pairs) const {
        std::array<Decision, piece_size> decisions;
        judge(pairs, std::span(decisions).first(pairs.size()));
        std::array<Pair, piece_size> kept;
        std::size_t n = 0;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            kept[n] = pairs[i];
            n += decisions[i].answer != Answer::no ? 1 : 0;
            if (tiers_)
                tiers_->add(decisions[i]);
        }
        return n == 0 || sink_.take(chunk, {kept.data(), n});
    }

    void judge(std::span<const Pair> pairs, std::span<Decision> decisions) const {
        if constexpr (TriangleBatchKernel<K>) {
            using Block = TrianglePairBlock<Real>;
            std::array<Block, piece_size / Block::lanes> blocks;
            const std::size_t n_blocks = (pairs.size() + Block::lanes - 1) / Block::lanes;
            for (std::size_t i = 0; i < n_blocks * Block::lanes; ++i) {
                const Pair p = pairs[std::min(i, pairs.size() - 1)]; // the last one fills the block
                blocks[i / Block::lanes].set(i % Block::lanes, triangle(a_, p.a),
                                             triangle(b_, p.b));
            }
            K::intersect(std::span<const Block>(blocks.data(), n_blocks), decisions);
        } else {
            for (std::size_t i = 0; i < pairs.size(); ++i)
                decisions[i] = K::intersect(triangle(a_, pairs[i].a), triangle(b_, pairs[i].b));
        }
    }

    const Mesh& a_;
    const Mesh& b_;
    TierCounts* tiers_;
};

} // namespace boxwood
