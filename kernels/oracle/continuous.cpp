#include "kernels/oracle/continuous.h"
#include "kernels/oracle/rational.h"

#include "kernels/oracle/continuous_roots.h"

#include <algorithm>
#include <optional>

/// At a fixed time whether two features touch is a formula of signs of polynomials in t. The times
/// of touch are closed, so the first of them is 0 or a root of one of these polynomials: at each
/// such candidate the formula is evaluated exactly. Where the coplanarity cubic is not identically
/// 0, the candidates are its roots.
namespace boxwood::oracle {
namespace {

/// Four points whose coordinates are linear polynomials in t. Each axis has a scale of its own,
/// which moves no touch.
struct Motion {
    std::array<std::array<Polynomial, 3>, 4> point;
};
using Vector = std::array<Polynomial, 3>;

Vector operator-(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Polynomial dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The sign of a polynomial at the time in question.
class Signs {
  public:
    explicit Signs(Root& time) : time_(time) {}
    int operator()(const Polynomial& f) const { return time_.sign_of(f); }
    /// An axis along which the vector is not 0, if there is one.
    std::optional<std::size_t> nonzero_axis(const Vector& v) const {
        for (std::size_t k = 0; k < 3; ++k)
            if ((*this)(v[k]) != 0)
                return k;
        return std::nullopt;
    }

  private:
    Root& time_;
};

/// p lies on the closed segment a b, which may be a point: on its line and in its box.
class PointOnSegment {
  public:
    PointOnSegment(const Vector& p, const Vector& a, const Vector& b)
        : from_a_(p - a), from_b_(p - b), turn_(cross(from_a_, from_b_)) {}

    bool operator()(const Signs& sign) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (sign(from_a_[k]) * sign(from_b_[k]) > 0)
                return false;
        return !sign.nonzero_axis(turn_);
    }
    void add_polynomials(std::vector<const Polynomial*>& all) const {
        for (const Vector* v : {&from_a_, &from_b_, &turn_})
            for (const Polynomial& f : *v)
                all.push_back(&f);
    }

  private:
    Vector from_a_, from_b_, turn_;
};

/// Point 0 in the closed triangle 1, 2, 3. At a time when all four are coplanar:
/// in a true triangle iff it is on no edge's outer side, seen along an axis that its normal has a
/// part of; in a degenerate triangle iff it is on one of its edges.
class VertexOnFace {
  public:
    static Polynomial coplanar(const Motion& m) {
        return dot(normal_of(m), m.point[0] - m.point[1]);
    }
    explicit VertexOnFace(const Motion& m)
        : normal_(normal_of(m)), edges_{PointOnSegment{m.point[0], m.point[1], m.point[2]},
                                        {m.point[0], m.point[2], m.point[3]},
                                        {m.point[0], m.point[3], m.point[1]}} {
        for (std::size_t i = 0; i < 3; ++i)
            side_[i] = cross(m.point[1 + i] - m.point[0], m.point[1 + (i + 1) % 3] - m.point[0]);
    }

    bool operator()(const Signs& sign) const {
        if (const auto axis = sign.nonzero_axis(normal_)) {
            const int up = sign(normal_[*axis]);
            return std::ranges::all_of(
                side_, [&](const Vector& side) { return sign(side[*axis]) * up >= 0; });
        }
        return std::ranges::any_of(edges_, [&](const auto& edge) { return edge(sign); });
    }
    void add_polynomials(std::vector<const Polynomial*>& all) const {
        for (const Vector* v : {&normal_, &side_[0], &side_[1], &side_[2]})
            for (const Polynomial& f : *v)
                all.push_back(&f);
        for (const PointOnSegment& edge : edges_)
            edge.add_polynomials(all);
    }

  private:
    static Vector normal_of(const Motion& m) {
        return cross(m.point[2] - m.point[1], m.point[3] - m.point[1]);
    }

    Vector normal_;
    std::array<Vector, 3> side_;
    std::array<PointOnSegment, 3> edges_;
};

/// The closed segments 0 1 and 2 3 share a point. At a time when all four points are coplanar:
/// if they are not parallel, iff neither has both ends strictly on one side of the other's line,
/// seen along an axis that the common normal has a part of; if they are parallel, or one is a
/// point, iff an end of one is on the other.
class EdgesMeet {
  public:
    static Polynomial coplanar(const Motion& m) {
        return dot(normal_of(m), m.point[2] - m.point[0]);
    }
    explicit EdgesMeet(const Motion& m)
        : normal_(normal_of(m)), ends_{PointOnSegment{m.point[0], m.point[2], m.point[3]},
                                       {m.point[1], m.point[2], m.point[3]},
                                       {m.point[2], m.point[0], m.point[1]},
                                       {m.point[3], m.point[0], m.point[1]}} {
        for (std::size_t i = 0; i < 2; ++i) {
            const Vector &a = m.point[2 * i], &b = m.point[2 * i + 1];
            for (std::size_t j = 0; j < 2; ++j)
                side_[i][j] = cross(b - a, m.point[2 * (1 - i) + j] - a);
        }
    }

    bool operator()(const Signs& sign) const {
        if (const auto axis = sign.nonzero_axis(normal_))
            return std::ranges::all_of(side_, [&](const auto& ends_of_other) {
                return sign(ends_of_other[0][*axis]) * sign(ends_of_other[1][*axis]) <= 0;
            });
        return std::ranges::any_of(ends_, [&](const auto& end) { return end(sign); });
    }
    void add_polynomials(std::vector<const Polynomial*>& all) const {
        for (const Vector* v : {&normal_, &side_[0][0], &side_[0][1], &side_[1][0], &side_[1][1]})
            for (const Polynomial& f : *v)
                all.push_back(&f);
        for (const PointOnSegment& end : ends_)
            end.add_polynomials(all);
    }

  private:
    static Vector normal_of(const Motion& m) {
        return cross(m.point[1] - m.point[0], m.point[3] - m.point[2]);
    }

    Vector normal_;
    std::array<std::array<Vector, 2>, 2> side_; ///< of each line: the ends of the other
    std::array<PointOnSegment, 4> ends_;
};

Impact impact_at(Root& time, std::uint8_t tier) {
    const auto [below, above] = time.bracket();
    return {Answer::yes, below, above, tier};
}

template <class Touch> Impact first_touch(const Motion& motion) {
    const Polynomial coplanar = Touch::coplanar(motion);
    if (!coplanar.is_zero()) {
        std::vector<Root> times = roots_in_unit_interval(coplanar);
        if (times.empty())
            return {};
        const Touch touch(motion);
        for (Root& time : times)
            if (touch(Signs(time)))
                return impact_at(time, 1);
        return {.tier = 1};
    }
    const Touch touch(motion);
    Root start = Root::zero();
    if (touch(Signs(start)))
        return impact_at(start, 2);
    std::vector<const Polynomial*> polynomials;
    touch.add_polynomials(polynomials);
    std::optional<Root> first;
    for (const Polynomial* f : polynomials)
        for (Root& time : roots_in_unit_interval(*f))
            if ((!first || compare(time, *first) < 0) && touch(Signs(time)))
                first = time;
    return first ? impact_at(*first, 2) : Impact{.tier = 2};
}

/// From integer coordinates, one axis of one point.
Polynomial line(const Integer& start, const Integer& end) {
    return {{start, Integer(end - start), 0, 0}};
}

Motion integral(const RationalMotion& given) {
    Motion motion;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Integer scale = 1;
        for (std::size_t i = 0; i < 4; ++i)
            for (const RationalPoint* p : {&given.start[i], &given.end[i]})
                scale = lcm(scale, (*p)[axis].get_den());
        const auto whole = [&](const mpq_class& x) -> Integer {
            return x.get_num() * (scale / x.get_den());
        };
        for (std::size_t i = 0; i < 4; ++i)
            motion.point[i][axis] = line(whole(given.start[i][axis]), whole(given.end[i][axis]));
    }
    return motion;
}

Motion integral(const LinearMotion& given) {
    Motion motion;
    for (int axis = 0; axis < 3; ++axis) {
        const auto x = [&](std::size_t i) { return given.start[i][axis]; };
        const auto y = [&](std::size_t i) { return given.end[i][axis]; };
        const Unit unit(x(0), x(1), x(2), x(3), y(0), y(1), y(2), y(3));
        for (std::size_t i = 0; i < 4; ++i)
            motion.point[i][static_cast<std::size_t>(axis)] = line(unit(x(i)), unit(y(i)));
    }
    return motion;
}

template <class Touch> Impact first_touch_of_doubles(const LinearMotion& motion) {
    for (const auto& points : {motion.start, motion.end})
        for (const Vec3<double>& p : points)
            if (!is_finite(p))
                return {Answer::maybe, 0, 1, 0};
    return first_touch<Touch>(integral(motion));
}

} // namespace

Impact vertex_face(const RationalMotion& motion) {
    return first_touch<VertexOnFace>(integral(motion));
}
Impact edge_edge(const RationalMotion& motion) { return first_touch<EdgesMeet>(integral(motion)); }

Impact ExactContinuous::vertex_face(const LinearMotion& motion) const {
    return first_touch_of_doubles<VertexOnFace>(motion);
}
Impact ExactContinuous::edge_edge(const LinearMotion& motion) const {
    return first_touch_of_doubles<EdgesMeet>(motion);
}

} // namespace boxwood::oracle
