#include "kernels/oracle/second_opinion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace boxwood::oracle::second_opinion {
namespace {

/// Numbers as whole multiples of one unit, the greatest there is.
struct Whole {
    std::vector<mpz_class> numbers;
    mpq_class unit = 1;

    explicit Whole(const std::vector<double>& given) {
        mpz_class denominator = 1, divisor = 0;
        for (const double x : given)
            denominator = lcm(denominator, mpq_class(x).get_den());
        for (const double x : given) {
            numbers.push_back(mpq_class(mpq_class(x) * denominator).get_num());
            divisor = gcd(divisor, numbers.back());
        }
        if (divisor == 0)
            return;
        for (mpz_class& n : numbers)
            n /= divisor;
        unit = mpq_class(divisor, denominator);
        unit.canonicalize();
    }
};

template <class T> using Three = std::array<T, 3>;

template <class T> Three<T> minus(const Three<T>& a, const Three<T>& b) {
    return {T(a[0] - b[0]), T(a[1] - b[1]), T(a[2] - b[2])};
}
template <class T> T inner(const Three<T>& a, const Three<T>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T> Three<T> outer(const Three<T>& a, const Three<T>& b) {
    return {T(a[1] * b[2] - a[2] * b[1]), T(a[2] * b[0] - a[0] * b[2]),
            T(a[0] * b[1] - a[1] * b[0])};
}

using Vector = Three<mpz_class>;

/// c[0] + c[1] t + ...; no leading zeros.
struct Polynomial {
    std::vector<mpz_class> c;

    Polynomial() = default;
    explicit Polynomial(std::vector<mpz_class> coefficients) : c(std::move(coefficients)) {
        while (!c.empty() && c.back() == 0)
            c.pop_back();
    }
    bool is_zero() const { return c.empty(); }

    /// Of the value at t.
    int sign_at(const mpq_class& t) const {
        mpz_class value = 0, power = 1;
        for (std::size_t i = c.size(); i-- > 0;) {
            value = value * t.get_num() + c[i] * power;
            power *= t.get_den();
        }
        return sgn(value);
    }
};
Polynomial combined(const Polynomial& a, const Polynomial& b, int sign_of_b) {
    std::vector<mpz_class> c(std::max(a.c.size(), b.c.size()));
    std::copy(a.c.begin(), a.c.end(), c.begin());
    for (std::size_t i = 0; i < b.c.size(); ++i)
        c[i] += sign_of_b * b.c[i];
    return Polynomial(std::move(c));
}
Polynomial operator+(const Polynomial& a, const Polynomial& b) { return combined(a, b, 1); }
Polynomial operator-(const Polynomial& a, const Polynomial& b) { return combined(a, b, -1); }
Polynomial operator*(const Polynomial& a, const Polynomial& b) {
    std::vector<mpz_class> c(a.c.size() + b.c.size());
    for (std::size_t i = 0; i < a.c.size(); ++i)
        for (std::size_t j = 0; j < b.c.size(); ++j)
            c[i + j] += a.c[i] * b.c[j];
    return Polynomial(std::move(c));
}
Polynomial derivative(const Polynomial& f) {
    std::vector<mpz_class> c;
    for (std::size_t i = 1; i < f.c.size(); ++i)
        c.push_back(f.c[i] * i);
    return Polynomial(std::move(c));
}
/// -(f mod g), times a positive number.
Polynomial negative_remainder(Polynomial f, const Polynomial& g) {
    const mpz_class lead = abs(g.c.back());
    while (f.c.size() >= g.c.size()) {
        const mpz_class top = sgn(g.c.back()) * f.c.back();
        const std::size_t shift = f.c.size() - g.c.size();
        for (mpz_class& c : f.c)
            c *= lead;
        for (std::size_t i = 0; i < g.c.size(); ++i)
            f.c[i + shift] -= top * g.c[i];
        f = Polynomial(std::move(f.c));
    }
    mpz_class content = 0;
    for (const mpz_class& c : f.c)
        content = gcd(content, c);
    for (mpz_class& c : f.c)
        c /= -content;
    return f;
}
/// f / (q t - p) for its root p / q.
Polynomial without_root(const Polynomial& f, const mpq_class& root) {
    std::vector<mpz_class> c(f.c.size() - 1);
    mpz_class above = 0;
    for (std::size_t i = f.c.size() - 1; i > 0; --i)
        c[i - 1] = above = (f.c[i] + root.get_num() * above) / root.get_den();
    return Polynomial(std::move(c));
}

using Time = mpq_class;

/// The sum of the signs of g over the distinct roots of f in (from, to), neither of which is one.
int tarski(const Polynomial& f, const Polynomial& g, const Time& from, const Time& to) {
    int changes = 0, last_from = 0, last_to = 0;
    Polynomial a = f, b = derivative(f) * g;
    for (;;) {
        for (auto [t, last, way] : {std::tuple(&from, &last_from, 1), {&to, &last_to, -1}}) {
            const int sign = a.sign_at(*t);
            if (sign == 0)
                continue;
            changes += *last == -sign ? way : 0;
            *last = sign;
        }
        if (b.is_zero())
            return changes;
        Polynomial next = negative_remainder(std::move(a), b);
        a = std::exchange(b, std::move(next));
    }
}

/// Signs of polynomials at one time.
using Signs = std::function<int(const Polynomial&)>;

/// When two features of linear motion touch: where `coplanar` is 0 and what `touch` says holds, a
/// formula of the signs of `others`.
struct Feature {
    Polynomial coplanar;
    std::vector<Polynomial> others;
    std::function<bool(const Signs&)> touch;

    bool touch_at(const Time& t) const {
        const Signs sign = [&](const Polynomial& f) { return f.sign_at(t); };
        return sign(coplanar) == 0 && touch(sign);
    }
    /// At some time strictly between, where some polynomial has a root that is the first touch.
    bool touch_within(const Time& from, const Time& to) const {
        if (!coplanar.is_zero())
            return touch_at_roots(coplanar, from, to);
        return touch_at(Time((from + to) / 2)) ||
               std::ranges::any_of(others, [&](const Polynomial& f) {
                   return !f.is_zero() && touch_at_roots(f, from, to);
               });
    }
    bool confirms(const Impact& claimed) const {
        if (claimed.answer != Answer::yes)
            return claimed.answer == Answer::no && !touch_at(0) && !touch_within(0, 1) &&
                   !touch_at(1);
        const double infinity = std::numeric_limits<double>::infinity();
        if (!(claimed.t_free >= 0 && claimed.t_free <= claimed.t_hit && claimed.t_hit <= 1 &&
              claimed.t_hit <= std::nextafter(claimed.t_free, infinity)))
            return false;
        const Time from(claimed.t_free), to(claimed.t_hit);
        if (from > 0 && (touch_at(0) || touch_within(0, from)))
            return false;
        return touch_at(from) ? from == to : from < to && touch_within(from, to);
    }

  private:
    bool touch_at_roots(Polynomial f, const Time& from, const Time& to) const {
        for (const Time* end : {&from, &to})
            while (f.sign_at(*end) == 0)
                f = without_root(f, *end);
        const int n = tarski(f, Polynomial(std::vector<mpz_class>{1}), from, to);
        if (n == 0)
            return false;
        if (n == 1)
            return touch(
                [&](const Polynomial& g) { return g.is_zero() ? 0 : tarski(f, g, from, to); });
        const Time middle((from + to) / 2);
        return (f.sign_at(middle) == 0 && touch_at(middle)) || touch_at_roots(f, from, middle) ||
               touch_at_roots(f, middle, to);
    }
};

using Path = Three<Polynomial>;

std::array<Path, 4> paths(const LinearMotion& motion) {
    std::vector<double> given;
    for (const auto* points : {&motion.start, &motion.end})
        for (const Vec3<double>& p : *points)
            given.insert(given.end(), {p.x, p.y, p.z});
    const Whole whole(given);
    std::array<Path, 4> all;
    for (std::size_t i = 0; i < 12; ++i)
        all[i / 3][i % 3] =
            Polynomial({whole.numbers[i], mpz_class(whole.numbers[12 + i] - whole.numbers[i])});
    return all;
}

/// p on the segment a b: in line with both, and not on one side of them.
struct OnSegment {
    Polynomial off_line, beyond;
    OnSegment(const Path& p, const Path& a, const Path& b)
        : beyond(inner(minus(p, a), minus(p, b))) {
        const Path turn = outer(minus(p, a), minus(p, b));
        off_line = inner(turn, turn);
    }
    bool holds(const Signs& sign) const { return sign(off_line) == 0 && sign(beyond) <= 0; }
};

/// `square` is that of the normal: where it is 0 one of `ends` must hold, else no sign of `sides`
/// may be negative.
Feature feature(Polynomial coplanar, Polynomial square, std::vector<Polynomial> sides,
                std::vector<OnSegment> ends) {
    Feature f;
    f.coplanar = std::move(coplanar);
    f.others = sides;
    f.others.push_back(square);
    for (const OnSegment& end : ends)
        f.others.insert(f.others.end(), {end.off_line, end.beyond});
    f.touch = [square, sides, ends](const Signs& sign) {
        if (sign(square) == 0)
            return std::ranges::any_of(ends, [&](const OnSegment& e) { return e.holds(sign); });
        return std::ranges::none_of(sides, [&](const Polynomial& s) { return sign(s) < 0; });
    };
    return f;
}

Feature vertex_and_face(const LinearMotion& motion) {
    const auto [p, a, b, c] = paths(motion);
    const Path e = minus(b, a), f = minus(c, a), w = minus(p, a), n = outer(e, f);
    const Polynomial square = inner(n, n), u = inner(n, outer(w, f)), v = inner(n, outer(e, w));
    return feature(inner(n, w), square, {u, v, square - u - v}, {{p, a, b}, {p, b, c}, {p, c, a}});
}

Feature two_edges(const LinearMotion& motion) {
    const auto [a, b, c, d] = paths(motion);
    const Path u = minus(b, a), v = minus(d, c), w = minus(c, a), n = outer(u, v);
    const Polynomial square = inner(n, n), x = inner(n, outer(w, v)), y = inner(n, outer(w, u));
    return feature(inner(n, w), square, {x, square - x, y, square - y},
                   {{a, c, d}, {b, c, d}, {c, a, b}, {d, a, b}});
}

} // namespace

mpq_class squared_distance(std::span<const Vec3<double>> a, std::span<const Vec3<double>> b) {
    std::vector<double> given;
    for (const auto& side : {a, b})
        for (const Vec3<double>& p : side)
            given.insert(given.end(), {p.x, p.y, p.z});
    const Whole whole(given);
    std::vector<Vector> at;
    for (std::size_t i = 0; i < given.size(); i += 3)
        at.push_back({whole.numbers[i], whole.numbers[i + 1], whole.numbers[i + 2]});

    mpz_class best = 0, of = 1; // best / of
    const auto offer = [&](const Vector& n) {
        mpz_class low_a, high_a, low_b, high_b;
        for (std::size_t i = 0; i < at.size(); ++i) {
            const mpz_class height = inner(n, at[i]);
            const bool is_a = i < a.size(), is_first = i == 0 || i == a.size();
            mpz_class &low = is_a ? low_a : low_b, &high = is_a ? high_a : high_b;
            low = is_first ? height : std::min(low, height);
            high = is_first ? height : std::max(high, height);
        }
        const mpz_class gap = std::max(mpz_class(low_a - high_b), mpz_class(low_b - high_a));
        const mpz_class square = inner(n, n);
        if (gap > 0 && gap * gap * of > best * square) {
            best = gap * gap;
            of = square;
        }
    };
    std::vector<Vector> edges;
    for (std::size_t i = 0; i < at.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if ((i < a.size()) == (j < a.size()))
                edges.push_back(minus(at[i], at[j]));
    for (std::size_t i = 0; i < edges.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            offer(outer(edges[i], edges[j]));
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = a.size(); j < at.size(); ++j) {
            const Vector between = minus(at[j], at[i]);
            offer(between);
            for (const Vector& edge : edges)
                offer(outer(edge, outer(between, edge)));
        }
    mpq_class squared(best, of);
    squared.canonicalize();
    return squared * whole.unit * whole.unit;
}

std::optional<RayPoint> ray_triangle(const Ray<float>& ray, const Triangle<float>& triangle) {
    const auto number = [](float x) { return mpq_class(static_cast<double>(x)); };
    // Rows (-d, b - a, c - a | o - a): unknowns t, u, v.
    std::array<std::array<mpq_class, 4>, 3> row;
    for (int k = 0; k < 3; ++k) {
        const mpq_class a = number(triangle.a[k]);
        row[static_cast<std::size_t>(k)] = {-number(ray.direction[k]), number(triangle.b[k]) - a,
                                            number(triangle.c[k]) - a, number(ray.origin[k]) - a};
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto pivot = std::find_if(row.begin() + static_cast<std::ptrdiff_t>(i), row.end(),
                                        [i](const auto& r) { return r[i] != 0; });
        if (pivot == row.end())
            return std::nullopt;
        std::swap(*pivot, row[i]);
        for (std::size_t j = 0; j < 3; ++j) {
            if (j == i)
                continue;
            const mpq_class factor = row[j][i] / row[i][i];
            for (std::size_t k = i; k < 4; ++k)
                row[j][k] -= factor * row[i][k];
        }
    }
    const RayPoint p{row[0][3] / row[0][0], row[1][3] / row[1][1], row[2][3] / row[2][2]};
    const bool inside = p.u >= 0 && p.v >= 0 && p.u + p.v <= 1;
    const bool in_range = p.t >= number(ray.t_min) &&
                          (std::isinf(ray.t_max) ? ray.t_max > 0 : p.t <= number(ray.t_max));
    return inside && in_range ? std::optional(p) : std::nullopt;
}

bool confirms_vertex_face(const LinearMotion& motion, const Impact& claimed) {
    return vertex_and_face(motion).confirms(claimed);
}
bool confirms_edge_edge(const LinearMotion& motion, const Impact& claimed) {
    return two_edges(motion).confirms(claimed);
}

} // namespace boxwood::oracle::second_opinion
