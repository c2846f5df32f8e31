#pragma once

#include "kernels/triangle_triangle/guigue_devillers.h"

namespace boxwood {

/// Whether two closed triangles share a point, exactly, for all finite doubles, in any floating-
/// point mode that rounds to nearest. Tier 0: bounding boxes, filtered determinants, shared
/// vertices, grids so coarse that doubles round nothing; 1 and 2: integers below 2^60 and 2^120 per
/// axis; 3: the superaccumulator. Non-finite input: maybe.
class GuigueDevillersExact {
  public:
    using Real = double;
    static constexpr std::string_view name = "guigue_devillers_exact";
    static constexpr KernelInfo info{
        "triangle_triangle",
        name,
        "interval overlap on the common line by exact orientation signs (2003): filter, then "
        "128-bit integers, then fixed point",
        Promise::exact,
        "exact for all finite doubles",
        "1.4 times f64; 2 to 5 times where the filter fails"};

    static Decision intersect(const Triangle<double>& a, const Triangle<double>& b) {
        detail::FilteredPair pair(a, b);
        const Answer answer = GuigueDevillersFiltered::meet(pair);
        return answer != Answer::maybe ? Decision{answer, 0} : decide_exactly(pair, a, b);
    }

  private:
    static Decision decide_exactly(detail::FilteredPair& filtered, const Triangle<double>& a,
                                   const Triangle<double>& b);
};

} // namespace boxwood
