#include "bench/truth/judging/truths.h"

#include <algorithm>
#include <cmath>

namespace boxwood::bench {
namespace {

/// Rounds numbers to float in place and remembers whether one changed.
class ToFloats {
  public:
    ToFloats& operator()(Vec3<double>& v) {
        for (int k = 0; k < 3; ++k) {
            const double rounded = static_cast<double>(static_cast<float>(v[k]));
            changed_ |= !(rounded == v[k] || std::isnan(v[k]));
            v[k] = rounded;
        }
        return *this;
    }
    ToFloats& operator()(Triangle<double>& t) { return (*this)(t.a)(t.b)(t.c); }
    ToFloats& operator()(Obb<double>& box) {
        for (Vec3<double>& axis : box.axis)
            (*this)(axis);
        return (*this)(box.centre)(box.half);
    }
    bool changed() const { return changed_; }

  private:
    bool changed_ = false;
};

template <class PairCase> std::optional<PairCase> rounded_pair(PairCase c) {
    if (!ToFloats()(c.a)(c.b).changed())
        return std::nullopt;
    c.touch = Known::unknown;
    return c;
}

bool finite(const Triangle<double>& t) {
    return is_finite(t.a) && is_finite(t.b) && is_finite(t.c);
}
bool finite(const Obb<double>& box) {
    return is_finite(box.centre) && is_finite(box.axis[0]) && is_finite(box.axis[1]) &&
           is_finite(box.axis[2]) && is_finite(box.half);
}
/// A ray without an end is an ordinary one.
bool finite(const Ray<float>& ray) {
    return is_finite(ray.origin) && is_finite(ray.direction) && std::isfinite(ray.t_min) &&
           !std::isnan(ray.t_max);
}

} // namespace

std::optional<TrianglePairCase> rounded_to_floats(const TrianglePairCase& c) {
    return rounded_pair(c);
}
std::optional<ObbPairCase> rounded_to_floats(const ObbPairCase& c) { return rounded_pair(c); }

std::optional<FitCase> rounded_to_floats(const FitCase& c) {
    FitCase rounded = c;
    ToFloats to_floats;
    for (Vec3<double>& row : rounded.transform.rotation)
        to_floats(row);
    to_floats(rounded.transform.translation)(rounded.box.min)(rounded.box.max);
    return to_floats.changed() ? std::optional(rounded) : std::nullopt;
}

double size_of(const ShapeOfPair& of) {
    double size = 0;
    for (const double length : lengths_of(of.shape))
        size = std::max(size, std::abs(length));
    return size;
}

std::optional<ShapePairCase> rounded_to_floats(const ShapePairCase& c) {
    ShapePairCase rounded = c;
    double size = 0;
    for (const ShapeOfPair* side : {&c.a, &c.b})
        size += 4 * size_of(*side) + length(side->pose.translation);
    rounded.lo -= 0x1p-22 * size;
    rounded.hi += 0x1p-22 * size;
    return rounded;
}

bool is_finite(const TrianglePairCase& c) { return finite(c.a) && finite(c.b); }
bool is_finite(const ObbPairCase& c) { return finite(c.a) && finite(c.b); }
bool is_finite(const ShapePairCase& c) {
    if (!(c.lo > 0 || c.hi < 0))
        return false;
    for (const ShapeOfPair* side : {&c.a, &c.b}) {
        const auto& [x, y, z] = side->pose.rotation;
        if (!is_finite(x) || !is_finite(y) || !is_finite(z) || !is_finite(side->pose.translation))
            return false;
        for (const double length : lengths_of(side->shape))
            if (!std::isfinite(length))
                return false;
    }
    return true;
}
bool is_finite(const FitCase& c) {
    const auto& [x, y, z] = c.transform.rotation;
    return is_finite(x) && is_finite(y) && is_finite(z) && is_finite(c.transform.translation) &&
           is_finite(c.box.min) && is_finite(c.box.max);
}
bool is_finite(const RayBoxCase& c) {
    return finite(c.ray) && (c.box.is_empty() || (is_finite(c.box.min) && is_finite(c.box.max)));
}
bool is_finite(const RayCase& c) { return finite(c.ray); }
bool is_finite(const MotionCase& c) {
    const auto all = [](const auto& points) {
        for (const Vec3<double>& p : points)
            if (!is_finite(p))
                return false;
        return true;
    };
    return all(c.motion.start) && all(c.motion.end);
}

} // namespace boxwood::bench
