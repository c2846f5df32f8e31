#include "bench/truth/judging/case_text.h"

#include <fmt/format.h>

#include <cmath>

namespace boxwood::bench {
namespace {

/// Numbers one after the other, commas between them.
class Row {
  public:
    template <class Real> Row& operator<<(Vec3<Real> v) { return *this << v.x << v.y << v.z; }
    Row& operator<<(float x) { return *this << static_cast<double>(x); }
    Row& operator<<(double x) {
        // "0x1.8p-3"; whole numbers and zeros of either sign stay short.
        const bool is_short = std::abs(x) < 1e4 && x == std::trunc(x);
        text_ += fmt::format("{}{}", text_.empty() ? "" : ",",
                             is_short ? fmt::format("{}", x) : fmt::format("{:a}", x));
        return *this;
    }
    template <class Real> Row& operator<<(const Ray<Real>& ray) {
        return *this << ray.origin << ray.direction << ray.t_min << ray.t_max;
    }
    template <class Real> Row& operator<<(const Triangle<Real>& t) {
        return *this << t.a << t.b << t.c;
    }
    template <class Real> Row& operator<<(const Obb<Real>& box) {
        return *this << box.centre << box.axis[0] << box.axis[1] << box.axis[2] << box.half;
    }
    std::string text() const { return text_; }

  private:
    std::string text_;
};

} // namespace

std::string text_of(std::span<const Vec3<double>> points) {
    Row row;
    for (const Vec3<double>& p : points)
        row << p;
    return row.text();
}
std::string text_of(const TrianglePairCase& c) { return (Row() << c.a << c.b).text(); }

std::string text_of(const Triangle<float>& t) { return (Row() << t).text(); }

std::string text_of(const RayCase& c) { return (Row() << c.ray).text(); }

std::string text_of(const RayBoxCase& c) {
    return (Row() << c.ray << c.box.min << c.box.max).text();
}

std::string text_of(const MotionCase& c) {
    Row row;
    for (const auto& points : {c.motion.start, c.motion.end})
        for (const Vec3<double>& p : points)
            row << p;
    return row.text();
}

std::string text_of(const ObbPairCase& c) { return (Row() << c.a << c.b).text(); }

std::string text_of(const ShapePairCase& c) {
    const auto side = [](const ShapeOfPair& of) {
        Row row;
        if (const auto* hull = of.shape.get_if<convex::Hull>())
            row << static_cast<double>(hull->points().size());
        else
            for (const double length : lengths_of(of.shape))
                row << length;
        for (const Vec3<double>& of_rotation : of.pose.rotation)
            row << of_rotation;
        return fmt::format("{},{}", to_string(of.shape.kind()),
                           (row << of.pose.translation).text());
    };
    return side(c.a) + ',' + side(c.b);
}

std::string text_of(const FitCase& c) {
    const auto& [x, y, z] = c.transform.rotation;
    return (Row() << x << y << z << c.transform.translation << c.box.min << c.box.max).text();
}

} // namespace boxwood::bench
