#include "kernels/triangle_triangle/exact.h"

#include "kernels/float_mode.h"
#include "kernels/predicates/accumulated.h"
#include "kernels/predicates/grid.h"

namespace boxwood {
namespace {

using Corners = std::array<const Vec3<double>*, 6>;

/// The filtered signs of a pair of finite triangles, and where they are undecided the exact ones,
/// from the narrowest numbers that the corners fit in. Denormals are kept (float_mode.h).
class ExactSigns {
  public:
    using Real = double;

    ExactSigns(const FilteredPair& filtered, const Corners& corners)
        : filtered_(filtered), corners_(corners) {}

    Sides sides(int of) const { return filtered_.sides(of); }

    Sides decided_sides(int of) {
        const Sides s = filtered_.sides(of);
        if (s.unknown == 0)
            return s;
        if (s.unknown == 7 && in_coordinate_plane())
            return {};
        place();
        return tier_ == 1   ? decide(narrow_, s, of)
               : tier_ == 2 ? decide(wide_, s, of)
                            : decide(*this, s, of);
    }
    Answer overlap_along_line(const Turned& a, const Turned& b) {
        const Answer answer = filtered_.overlap_along_line(a, b);
        return answer != Answer::maybe ? answer : overlap_by_orient3d(*this, a, b);
    }
    int orient3d(Corner a, Corner b, Corner c, Corner d) {
        const int sign = filtered_.orient3d(a, b, c, d);
        if (sign != undecided)
            return sign;
        place();
        return tier_ == 1   ? narrow_.orient3d(a, b, c, d)
               : tier_ == 2 ? wide_.orient3d(a, b, c, d)
                            : accumulated3d(a, b, c, d);
    }
    int orient2d(int dropped, Corner a, Corner b, Corner c) {
        const int sign = filtered_.judged2d(dropped, a, b, c);
        if (sign != undecided)
            return sign;
        place();
        const auto u = static_cast<std::size_t>((dropped + 1) % 3);
        const auto v = static_cast<std::size_t>((dropped + 2) % 3);
        return tier_ == 1   ? narrow_.orient2d(u, v, a, b, c)
               : tier_ == 2 ? wide_.orient2d(u, v, a, b, c)
                            : accumulated2d(u, v, a, b, c);
    }
    Answer overlap_in_plane(int dropped, int turn_a, int turn_b) {
        const Answer answer = filtered_.overlap_in_plane(dropped, turn_a, turn_b);
        if (answer != Answer::maybe)
            return answer;
        return overlap_by_orient2d(*this, dropped, {turn_a, turn_b}) ? Answer::yes : Answer::no;
    }
    Projection project(int of, int preferred) {
        const Corner t = of == 0 ? 0 : 3;
        const int first = preferred != Projection::none
                              ? preferred
                              : largest_axis(cross(*corners_[t + 1] - *corners_[t],
                                                   *corners_[t + 2] - *corners_[t]));
        for (int k = 0; k < 3; ++k) {
            const int axis = (first + k) % 3;
            if (const int turn = orient2d(axis, t, t + 1, t + 2); turn != 0)
                return {axis, turn};
        }
        return {};
    }
    Vec3<double> point(Corner k) const { return *corners_[k]; }
    static bool unsure() { return false; }

    std::uint8_t tier() const { return tier_; }

  private:
    void place() {
        if (tier_ != 0)
            return;
        tier_ = narrow_.place(corners_) ? 1 : wide_.place(corners_) ? 2 : 3;
    }

    template <std::size_t digits>
    static Sides decide(const Grid<digits, 6>& grid, Sides s, int of) {
        const Corner t = of == 0 ? 0 : 3, other = 3 - t;
        const auto normal = grid.normal(t, t + 1, t + 2);
        for (Corner k = 0; k < 3; ++k)
            if ((s.unknown >> k & 1) != 0)
                set(s, k, grid.side(normal, t, other + k));
        s.unknown = 0;
        return s;
    }
    static Sides decide(const ExactSigns& signs, Sides s, int of) {
        const Corner t = of == 0 ? 0 : 3, other = 3 - t;
        for (Corner k = 0; k < 3; ++k)
            if ((s.unknown >> k & 1) != 0)
                set(s, k, signs.accumulated3d(t, t + 1, t + 2, other + k));
        s.unknown = 0;
        return s;
    }
    static void set(Sides& s, Corner k, int sign) {
        s.above |= unsigned{sign > 0} << k;
        s.below |= unsigned{sign < 0} << k;
    }

    int accumulated3d(Corner a, Corner b, Corner c, Corner d) const {
        return Accumulated::orient3d(point(a), point(b), point(c), point(d));
    }
    int accumulated2d(std::size_t u, std::size_t v, Corner a, Corner b, Corner c) const {
        const auto at = [&](Corner k) {
            return Point2<double>{point(k)[static_cast<int>(u)], point(k)[static_cast<int>(v)]};
        };
        return Accumulated::orient2d(at(a), at(b), at(c));
    }

    /// All corners have a coordinate in common: no determinant is needed.
    bool in_coordinate_plane() const {
        for (const int axis : {0, 1, 2}) {
            if (!filtered_.seems_flat(axis))
                continue;
            bool same = true;
            for (const Vec3<double>* p : corners_)
                same &= (*p)[axis] == (*corners_[0])[axis];
            if (same)
                return true;
        }
        return false;
    }

    const FilteredPair& filtered_;
    const Corners& corners_;
    std::uint8_t tier_ = 0;
    Grid<1, 6> narrow_;
    Grid<2, 6> wide_;
};

bool finite(const Corners& corners) {
    bool all = true;
    for (const Vec3<double>* p : corners)
        all &= is_finite_bits(p->x) && is_finite_bits(p->y) && is_finite_bits(p->z);
    return all;
}

bool share_a_vertex(const Corners& p) {
    bool any = false;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 3; j < 6; ++j)
            any |= *p[i] == *p[j];
    return any;
}

Verdict decide(const FilteredPair& filtered, const Corners& corners) {
    if (!finite(corners))
        return {Answer::maybe, 0};
    if (share_a_vertex(corners))
        return {Answer::yes, 0};
    ExactSigns signs(filtered, corners);
    const Answer answer = IntervalTest<ExactSigns>::meet(signs);
    return {answer, signs.tier()};
}

} // namespace

Verdict GuigueDevillersExact::decide_exactly(const FilteredPair& filtered,
                                             const Triangle<double>& a, const Triangle<double>& b) {
    const Corners corners{&a.a, &a.b, &a.c, &b.a, &b.b, &b.c};
    return without_flushing([&] { return decide(filtered, corners); });
}

} // namespace boxwood
