#pragma once

#include "bench/tasks/contender.h"
#include "bench/tasks/one_by_one.h"
#include "bench/tasks/kernels/kernels.h"

#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// What rungs.cpp knows of a rung.
struct Rung {
    KernelInfo info;
    std::string precision;   ///< f32 | f64: what the kernel reads
    std::string_view asides; ///< what the notes say of how it is called
    std::function<std::unique_ptr<Contender>(const Cases&)> make;
};

/// One file of this folder per family of kernels.
std::vector<Rung> triangle_rungs();
std::vector<Rung> distance_rungs(Ask ask);
std::vector<Rung> ray_rungs();
std::vector<Rung> ray_box_rungs();
std::vector<Rung> continuous_rungs(Ask ask);
std::vector<Rung> obb_rungs();
std::vector<Rung> box_fit_rungs();

/// f(std::type_identity<K>{}) for each K of a tuple.
template <class Kernels, class F> void for_each_kernel(F&& f) {
    [&]<class... K>(std::type_identity<std::tuple<K...>>) {
        (f(std::type_identity<K>{}), ...);
    }(std::type_identity<Kernels>{});
}

template <class... Tuples> using Concatenated = decltype(std::tuple_cat(std::declval<Tuples>()...));

/// The number type that a kernel reads: K::Real, or `Default` if its concept has no such member.
template <class K, class Default> struct RealOf { using type = Default; };
template <class K, class Default>
requires requires { typename K::Real; }
struct RealOf<K, Default> {
    using type = typename K::Real;
};
template <class Real> std::string precision_of() {
    return std::is_same_v<Real, float> ? "f32" : "f64";
}

/// Calls `kernel` once for all blocks; the last one may hold fewer cases than it has lanes.
template <class Block, auto answers, class Kernel> class InBlocks final : public Contender {
  public:
    InBlocks(std::vector<Block> blocks, std::size_t n, Kernel kernel)
        : blocks_(std::move(blocks)), n_(n), kernel_(std::move(kernel)) {}

    void build() override {}
    void query(Answers& all) override {
        auto& out = all.*answers;
        out.resize(n_);
        kernel_(std::span<const Block>(blocks_), std::span(out));
    }

  private:
    std::vector<Block> blocks_;
    std::size_t n_;
    Kernel kernel_;
};
template <auto answers, class Block, class Kernel>
std::unique_ptr<Contender> in_blocks(std::vector<Block> blocks, std::size_t n, Kernel kernel) {
    return std::make_unique<InBlocks<Block, answers, Kernel>>(std::move(blocks), n,
                                                              std::move(kernel));
}

inline constexpr std::string_view called_one_by_one = "one case per call";
inline constexpr std::string_view called_in_blocks = "all cases in one call, side by side";

template <class To, class From> Triangle<To> converted(const Triangle<From>& t) {
    return {static_cast<Vec3<To>>(t.a), static_cast<Vec3<To>>(t.b), static_cast<Vec3<To>>(t.c)};
}

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

} // namespace boxwood::bench
