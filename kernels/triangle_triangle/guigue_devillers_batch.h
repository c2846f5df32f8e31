#pragma once

#include "kernels/detail/concatenated.h"
#include "kernels/triangle_triangle/exact.h"
#include "kernels/triangle_triangle/guigue_devillers.h"
#include "kernels/triangle_triangle/triangle_kernel.h"

#include <type_traits>

namespace boxwood {

/// The interval test of guigue_devillers.h on 16 pairs at a time, without a branch, in floats (to
/// which doubles are rounded, as seen from a corner). Lanes with a sign that is not certain pass
/// up: of doubles, to the same in doubles; then to the kernel `Up`. If Up is exact, certain means
/// proven, and so is the batch; else it means not zero, NaN or infinite. Tiers in this order. The
/// decisions are the same for every instruction set, and for one pair. Source: Guigue, Devillers
/// 2003.
template <class R, TriangleKernel Up> struct GuigueDevillersBatch {
  private:
    static constexpr bool exact = Up::info.promise == Promise::exact;
    static constexpr bool widened = !std::is_same_v<R, typename Up::Real>;
    static constexpr std::string_view suffix = widened ? "_f32_batch" : "_batch";
    static constexpr std::string_view begin =
        std::is_same_v<R, float>
            ? "16 pairs at a time: interval overlap on the common line (2003), uncertain lanes to "
            : "16 pairs at a time, rounded: interval overlap on the common line (2003), uncertain "
              "lanes in doubles, then to ";

  public:
    using Real = R;
    static constexpr std::string_view name = Concatenated<Up::name, suffix>::value;
    static constexpr KernelInfo info{
        "triangle_triangle",
        name,
        Concatenated<begin, Up::name>::value,
        Up::info.promise,
        exact ? "270u * (product of the largest |differences| per axis), else the kernel above; "
                "derived in triangle_triangle/guigue_devillers_batch.cpp"
              : Up::info.bound,
        "about 230 vector operations for 16"};

    static Decision intersect(const Triangle<Real>& a, const Triangle<Real>& b) {
        TrianglePairBlock<Real> block{};
        block.set(0, a, b);
        Decision decision;
        intersect({&block, 1}, {&decision, 1});
        return decision;
    }
    static void intersect(std::span<const TrianglePairBlock<Real>> blocks,
                          std::span<Decision> decisions);
};

using GuigueDevillersF32Batch = GuigueDevillersBatch<float, GuigueDevillersF32>;
using GuigueDevillersExactF32Batch = GuigueDevillersBatch<float, GuigueDevillersExact>;
using GuigueDevillersExactBatch = GuigueDevillersBatch<double, GuigueDevillersExact>;

} // namespace boxwood
