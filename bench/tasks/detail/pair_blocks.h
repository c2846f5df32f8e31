#pragma once

#include "bench/tasks/detail/kernel_task.h"

namespace boxwood::bench {

template <class Real> struct TwoTriangles {
    Triangle<Real> a, b;
    explicit TwoTriangles(const TrianglePairCase& c)
        : a(converted<Real>(c.a)), b(converted<Real>(c.b)) {}
};

/// Pairs of triangles in the lanes of blocks. Lanes beyond the last case repeat it.
template <class Real>
std::vector<TrianglePairBlock<Real>> pair_blocks(const std::vector<TrianglePairCase>& cases) {
    constexpr std::size_t lanes = TrianglePairBlock<Real>::lanes;
    std::vector<TrianglePairBlock<Real>> blocks((cases.size() + lanes - 1) / lanes);
    for (std::size_t i = 0; i < blocks.size() * lanes; ++i) {
        const TrianglePairCase& c = cases[std::min(i, cases.size() - 1)];
        blocks[i / lanes].set(i % lanes, converted<Real>(c.a), converted<Real>(c.b));
    }
    return blocks;
}

/// Calls a kernel once for all blocks; the last one may hold fewer cases than it has lanes.
template <class T, class Real, class Function> class InBlocks final : public Contender {
  public:
    InBlocks(const std::vector<TrianglePairCase>& cases, Function function)
        : blocks_(pair_blocks<Real>(cases)), n_(cases.size()), function_(std::move(function)) {}

    void build() override {}
    void query(Answers& answers) override {
        std::vector<T>& out = list_of<T>(answers);
        out.resize(n_);
        function_(std::span<const TrianglePairBlock<Real>>(blocks_), std::span(out));
    }

  private:
    std::vector<TrianglePairBlock<Real>> blocks_;
    std::size_t n_;
    Function function_;
};

template <class K, class T, class Function> CaseKernel block_kernel(Function function) {
    using Real = typename K::Real;
    return {K::info, precision_of<Real>(), "all cases in one call, side by side",
            [function](const Cases& cases) {
                return std::make_unique<InBlocks<T, Real, Function>>(
                    std::get<std::vector<TrianglePairCase>>(cases), function);
            }};
}

} // namespace boxwood::bench
