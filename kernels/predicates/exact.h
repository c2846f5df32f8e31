#pragma once

#include "kernels/arithmetic/float_mode.h"
#include "kernels/predicates/detail/accumulated.h"
#include "kernels/predicates/detail/grid.h"
#include "kernels/predicates/filtered.h"

namespace boxwood {

/// Exact orientation signs of all finite doubles, denormals and mixed magnitudes included, in any
/// floating-point mode that rounds to nearest. In tiers: the filter; integers below 2^60, then
/// 2^120, per axis, in 128-bit arithmetic; the superaccumulator. NaN and infinity are undecided.
struct Exact {
    using Real = double;
    static constexpr std::string_view name = "exact";
    static constexpr std::string_view summary =
        "determinants in double where their error bound decides, else in integers";
    static constexpr std::string_view bound = "exact";
    static constexpr std::string_view cost = "filter, then 128-bit integers";
    static constexpr Promise promise = Promise::exact;
    static constexpr std::uint8_t tier = 3; ///< the last it may need

    static int orient3d(Vec3<double> a, Vec3<double> b, Vec3<double> c, Vec3<double> d) {
        const int sign = Filtered::orient3d(a, b, c, d);
        return sign != undecided ? sign : in_integers(a, b, c, d);
    }
    static int orient2d(Point2<double> a, Point2<double> b, Point2<double> c) {
        const int sign = Filtered::orient2d(a, b, c);
        return sign != undecided ? sign : in_integers(a, b, c);
    }

  private:
    template <std::size_t n> static bool finite(const std::array<const Vec3<double>*, n>& points) {
        bool all = true;
        for (const Vec3<double>* p : points)
            all &= detail::is_finite_bits(p->x) && detail::is_finite_bits(p->y) &&
                   detail::is_finite_bits(p->z);
        return all;
    }

    [[gnu::noinline]] static int in_integers(const Vec3<double>& a, const Vec3<double>& b,
                                             const Vec3<double>& c, const Vec3<double>& d) {
        const std::array<const Vec3<double>*, 4> points{&a, &b, &c, &d};
        if (!finite(points))
            return undecided;
        return without_flushing([&] {
            const int sign = on_grids(points, [](auto& g) { return g.orient3d(0, 1, 2, 3); });
            return sign != undecided ? sign : detail::Accumulated::orient3d(a, b, c, d);
        });
    }
    [[gnu::noinline]] static int in_integers(Point2<double> a, Point2<double> b, Point2<double> c) {
        const Vec3<double> p{a.x, a.y, 0}, q{b.x, b.y, 0}, r{c.x, c.y, 0};
        const std::array<const Vec3<double>*, 3> points{&p, &q, &r};
        if (!finite(points))
            return undecided;
        return without_flushing([&] {
            const int sign = on_grids(points, [](auto& g) { return g.orient2d(0, 1, 0, 1, 2); });
            return sign != undecided ? sign : detail::Accumulated::orient2d(a, b, c);
        });
    }

    /// sign(grid) of the first that the points fit on.
    template <std::size_t n, class Sign>
    [[gnu::noinline]] static int on_grids(const std::array<const Vec3<double>*, n>& points,
                                          Sign sign_on) {
        if (detail::Grid<1, n> narrow; narrow.place(points))
            return sign_on(narrow);
        if (detail::Grid<2, n> wide; wide.place(points))
            return sign_on(wide);
        return undecided;
    }
};

static_assert(OrientationPredicates<Exact> && OrientationPredicates<Filtered> &&
              OrientationPredicates<detail::Accumulated>);

} // namespace boxwood
