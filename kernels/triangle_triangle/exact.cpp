#include "kernels/triangle_triangle/exact.h"

#include "kernels/arithmetic/float_mode.h"
#include "kernels/predicates/detail/accumulated.h"
#include "kernels/predicates/detail/grid.h"

namespace boxwood {
namespace {

using namespace detail;

/// The filtered signs of a pair of finite triangles, and where they are undecided the exact ones,
/// from the narrowest numbers that the corners fit in. Denormals are kept (float_mode.h).
class ExactSigns {
  public:
    using Real = double;

    explicit ExactSigns(const FilteredPair& filtered) : filtered_(filtered) {}

    Sides sides(int of) const { return filtered_.sides(of); }

    Sides decided_sides(int of) {
        Sides s = filtered_.sides(of);
        if (s.unknown() == 0)
            return s;
        if (s.unknown() == 7 && filtered_.in_coordinate_plane())
            return {};
        const Corner t = of == 0 ? 0 : 3, other = 3 - t;
        if (tier() == 1) {
            const auto normal = narrow_.normal(t, t + 1, t + 2);
            return decided(s, [&](Corner k) { return narrow_.side(normal, t, other + k); });
        }
        return decided(s, [&](Corner k) { return exact3d(t, t + 1, t + 2, other + k); });
    }
    Answer overlap_along_line(const Turned& a, const Turned& b) {
        const Answer answer = filtered_.overlap_along_line(a, b);
        return answer != Answer::maybe ? answer : overlap_by_orient3d(*this, a, b);
    }
    int orient3d(Corner a, Corner b, Corner c, Corner d) {
        const int sign = filtered_.orient3d(a, b, c, d);
        return sign != undecided ? sign : exact3d(a, b, c, d);
    }
    int orient2d(int dropped, Corner a, Corner b, Corner c) {
        const int sign = filtered_.orient2d(dropped, a, b, c);
        return sign != undecided ? sign : exact2d(dropped, a, b, c);
    }
    Answer overlap_in_plane(int dropped, int turn_a, int turn_b) {
        const Answer answer = filtered_.overlap_in_plane(dropped, turn_a, turn_b);
        return answer != Answer::maybe ? answer
                                       : overlap_by_orient2d(*this, dropped, {turn_a, turn_b});
    }
    Projection project(int of, Projection like) {
        const Projection projection = filtered_.project(of, like);
        return projection ? projection : project_by_orient2d(*this, of, 0);
    }
    Vec3<double> point(Corner k) const { return filtered_.point(k); }

    /// The last that was needed.
    std::uint8_t used() const { return tier_; }

  private:
    std::uint8_t tier() {
        if (tier_ == 0) [[unlikely]]
            tier_ = narrow_.place(filtered_.points()) ? 1 : wide_.place(filtered_.points()) ? 2 : 3;
        return tier_;
    }

    template <class Side> static Sides decided(Sides s, Side side) {
        for (Corner k = 0; k < 3; ++k)
            if ((s.unknown() >> k & 1) != 0)
                s.decide(k, side(k));
        return s;
    }

    int exact3d(Corner a, Corner b, Corner c, Corner d) {
        switch (tier()) {
        case 1:
            return narrow_.orient3d(a, b, c, d);
        case 2:
            return wide_.orient3d(a, b, c, d);
        default:
            return Accumulated::orient3d(point(a), point(b), point(c), point(d));
        }
    }
    int exact2d(int dropped, Corner a, Corner b, Corner c) {
        const int u = plane_axes[dropped].u, v = plane_axes[dropped].v;
        const auto at = [&](Corner k) { return Point2<double>{point(k)[u], point(k)[v]}; };
        switch (tier()) {
        case 1:
            return narrow_.orient2d(u, v, a, b, c);
        case 2:
            return wide_.orient2d(u, v, a, b, c);
        default:
            return Accumulated::orient2d(at(a), at(b), at(c));
        }
    }

    const FilteredPair& filtered_;
    std::uint8_t tier_ = 0;
    Grid<1, 6> narrow_;
    Grid<2, 6> wide_;
};

bool finite(const FilteredPair& pair) {
    bool all = true;
    for (const Vec3<double>* p : pair.points())
        all &= is_finite_bits(p->x) && is_finite_bits(p->y) && is_finite_bits(p->z);
    return all;
}

/// What the filter has left as `maybe`.
Decision decide(FilteredPair& pair) {
    using Plain = Determinants<double>;
    pair.narrow();
    const auto sums = pair.sums();
    if (!pair.surely_finite(sums)) {
        if (!finite(pair))
            return {Answer::maybe, 0};
        if (pair.boxes_apart())
            return {Answer::no, 0};
        if (pair.share_a_vertex(sums))
            return {Answer::yes, 0};
    }
    if (pair.rounds_nothing())
        return {IntervalTest<const Plain>::meet(Plain(pair)), 0};
    ExactSigns signs(pair);
    const Answer answer = IntervalTest<ExactSigns>::meet(signs);
    return {answer, signs.used()};
}

} // namespace

Decision GuigueDevillersExact::decide_exactly(FilteredPair& filtered, const Triangle<double>& a,
                                              const Triangle<double>& b) {
    if (!flushes_denormals())
        return decide(filtered);
    return without_flushing([&] {
        FilteredPair pair(a, b);
        const Answer answer = GuigueDevillersFiltered::meet(pair);
        return answer != Answer::maybe ? Decision{answer, 0} : decide(pair);
    });
}

} // namespace boxwood
