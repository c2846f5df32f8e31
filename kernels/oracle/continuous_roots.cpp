#include "kernels/oracle/continuous_roots.h"

#include "kernels/oracle/roots.h"

#include <utility>

namespace boxwood::oracle {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Integer shifted(const Integer& n, unsigned bits) {
    Integer r;
    mpz_mul_2exp(r.get_mpz_t(), n.get_mpz_t(), bits);
    return r;
}

/// Divided by the greatest common divisor of its coefficients.
Polynomial primitive(Polynomial f) {
    Integer content = 0;
    for (const Integer& c : f.c)
        content = gcd(content, c);
    if (content > 1)
        for (Integer& c : f.c)
            mpz_divexact(c.get_mpz_t(), c.get_mpz_t(), content.get_mpz_t());
    return f;
}

Polynomial derivative(const Polynomial& f) {
    return {{f.c[1], Integer(2 * f.c[2]), Integer(3 * f.c[3]), 0}};
}

struct Division {
    Polynomial quotient, remainder;
};
/// lead(g)^k f = quotient g + remainder for some k, with the degree of the remainder below g's.
Division divide(Polynomial f, const Polynomial& g) {
    const int m = g.degree();
    const Integer& lead = g.c[at(m)];
    Polynomial quotient;
    for (int n = f.degree(); n >= m; n = f.degree()) {
        const Integer top = f.c[at(n)];
        for (int i = 0; i <= Polynomial::max_degree; ++i) {
            f.c[at(i)] *= lead;
            quotient.c[at(i)] *= lead;
        }
        quotient.c[at(n - m)] += top;
        for (int i = 0; i <= m; ++i)
            f.c[at(i + n - m)] -= top * g.c[at(i)];
    }
    return {quotient, f};
}

/// Up to a constant; f is not 0.
Polynomial greatest_common_divisor(Polynomial f, Polynomial g) {
    while (!g.is_zero())
        f = std::exchange(g, primitive(divide(f, g).remainder));
    return primitive(f);
}

/// The roots of f in the open interval (0, 1), appended in ascending order. The sign changes on the
/// two halves of a cell are no more than on the cell, so at most one half has two of them or more,
/// and there is one cell to go on with, however near to one another two roots are.
void isolate(const Polynomial& f, Bernstein local, std::vector<Root>& roots) {
    std::vector<Root> later; // above the cell, descending
    Cell cell;
    while (local.changes() > 1) {
        Bernstein upper = local.halve();
        Cell lower_cell{2 * cell.index, cell.level + 1};
        Cell upper_cell{lower_cell.index + 1, lower_cell.level};
        const bool go_up = upper.changes() > 1;
        if (go_up && local.changes() == 1)
            roots.push_back(Root::inside(f, std::move(lower_cell), std::move(local)));
        if (!go_up && upper.changes() == 1)
            later.push_back(Root::inside(f, upper_cell, upper));
        if (upper.b[0] == 0)
            (go_up ? roots : later).push_back(Root::at_lower_end(f, upper_cell));
        if (go_up)
            local = std::move(upper);
        cell = std::move(go_up ? upper_cell : lower_cell);
    }
    if (local.changes() == 1)
        roots.push_back(Root::inside(f, std::move(cell), std::move(local)));
    roots.insert(roots.end(), later.rbegin(), later.rend());
}

mpq_class fraction(const Integer& index, unsigned level) {
    mpq_class q(index);
    mpq_div_2exp(q.get_mpq_t(), q.get_mpq_t(), level);
    return q;
}

/// The largest double <= x, for 0 <= x <= 1.
double down(const mpq_class& x) {
    const double near = nearest_double(x);
    return exact(near) <= x ? near : next_below(near);
}

} // namespace

int Polynomial::degree() const {
    int d = max_degree;
    while (d >= 0 && c[at(d)] == 0)
        --d;
    return d;
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
    Polynomial sum;
    for (std::size_t i = 0; i < sum.c.size(); ++i)
        sum.c[i] = a.c[i] + b.c[i];
    return sum;
}
Polynomial operator-(const Polynomial& a, const Polynomial& b) {
    Polynomial difference;
    for (std::size_t i = 0; i < difference.c.size(); ++i)
        difference.c[i] = a.c[i] - b.c[i];
    return difference;
}
Polynomial operator*(const Polynomial& a, const Polynomial& b) {
    Polynomial product;
    const int m = a.degree(), n = b.degree();
    for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= n; ++j)
            product.c[at(i + j)] += a.c[at(i)] * b.c[at(j)];
    return product;
}

Bernstein::Bernstein(const Polynomial& f, const Cell& cell) : b(f.c), degree(f.degree()) {
    // 2^(level degree) f(index + s over 2^level), by Horner's scheme in s.
    for (int i = 0; i < degree; ++i)
        b[at(i)] = shifted(b[at(i)], cell.level * static_cast<unsigned>(degree - i));
    if (cell.index != 0)
        for (int i = 0; i < degree; ++i)
            for (int j = degree - 1; j >= i; --j)
                b[at(j)] += cell.index * b[at(j + 1)];
    // Power basis to Bernstein, times the degree (1, 2, 3) or 1.
    if (degree == 1) {
        b[1] += b[0];
    } else if (degree == 2) {
        b[2] = 2 * (b[0] + b[1] + b[2]);
        b[1] += 2 * b[0];
        b[0] *= 2;
    } else if (degree == 3) {
        b[3] = 3 * (b[0] + b[1] + b[2] + b[3]);
        b[2] += 3 * b[0] + 2 * b[1];
        b[1] += 3 * b[0];
        b[0] *= 3;
    }
}

int Bernstein::changes() const {
    int n = 0, last = 0;
    for (int i = 0; i <= degree; ++i)
        if (const int sign = sgn(b[at(i)]); sign != 0) {
            n += last != 0 && sign != last;
            last = sign;
        }
    return n;
}

int Bernstein::first_sign() const {
    for (int i = 0; i <= degree; ++i)
        if (const int sign = sgn(b[at(i)]); sign != 0)
            return sign;
    return 0;
}

Bernstein Bernstein::halve() {
    // De Casteljau without the divisions: the row of the triangle that is k sums deep is 2^k times
    // too large. In place: memory is what a deep cell's long numbers cost.
    Bernstein upper = *this;
    const auto n = static_cast<unsigned>(std::max(degree, 0));
    const auto shift = [](Integer& to, const Integer& from, unsigned bits) {
        mpz_mul_2exp(to.get_mpz_t(), from.get_mpz_t(), bits);
    };
    for (unsigned k = 0; k <= n; ++k) {
        shift(b[k], upper.b[0], n - k);
        for (unsigned i = 0; i + k < n; ++i)
            upper.b[i] += upper.b[i + 1];
    }
    // What is left in place i has been summed n - i times.
    for (unsigned i = 0; i <= n; ++i)
        shift(upper.b[i], upper.b[i], i);
    return upper;
}

Root Root::zero() {
    const Polynomial t{{0, 1, 0, 0}};
    return at_lower_end(t, {});
}
Root Root::at_lower_end(Polynomial f, Cell cell) {
    return {std::move(f), std::move(cell), Bernstein(Polynomial{}, Cell{}), true};
}
Root Root::inside(Polynomial f, Cell cell, Bernstein local) {
    return {std::move(f), std::move(cell), std::move(local), false};
}

void Root::refine() {
    if (is_lower_end_)
        return;
    const int before = local_.first_sign();
    const Integer first = abs(local_.b[0]), last = abs(local_.b[at(local_.degree)]);
    if (first != 0 && last != 0) {
        const Integer guess = shifted(first, jump_) / (first + last);
        Cell cell{shifted(cell_.index, jump_) + guess, cell_.level + jump_};
        Bernstein local(f_, cell);
        const int lower = sgn(local.b[0]), upper = sgn(local.b[at(local.degree)]);
        if (lower != -before && upper != before) {
            if (upper == 0)
                ++cell.index;
            is_lower_end_ = lower == 0 || upper == 0;
            cell_ = std::move(cell);
            local_ = std::move(local);
            jump_ *= 2;
            return;
        }
        jump_ = std::max(jump_ / 2, 1u);
    }
    Bernstein upper = local_.halve();
    ++cell_.level;
    cell_.index *= 2;
    const int middle = sgn(upper.b[0]);
    if (middle != 0 && middle != before)
        return;
    ++cell_.index;
    local_ = std::move(upper);
    is_lower_end_ = middle == 0;
}

int Root::sign_of(const Polynomial& g) {
    for (bool may_be_zero = true;; refine()) {
        const Bernstein local(g, cell_);
        if (is_lower_end_)
            return local.degree < 0 ? 0 : sgn(local.b[0]);
        if (local.changes() == 0)
            return local.first_sign();
        // A common divisor has at most this root in the open cell, and it is simple.
        if (std::exchange(may_be_zero, false) &&
            Bernstein(greatest_common_divisor(f_, g), cell_).changes() % 2 != 0)
            return 0;
    }
}

int compare(Root& a, Root& b) {
    for (bool may_be_equal = true;;) {
        // One cell is within the other, or they are apart but for a common end.
        const unsigned coarse = std::min(a.cell_.level, b.cell_.level);
        const unsigned fine = std::max(a.cell_.level, b.cell_.level);
        const Integer m = a.cell_.index >> (a.cell_.level - coarse);
        const Integer n = b.cell_.index >> (b.cell_.level - coarse);
        if (m != n)
            return m < n ? -1 : 1;
        const int ends = sgn(Integer(shifted(a.cell_.index, fine - a.cell_.level) -
                                     shifted(b.cell_.index, fine - b.cell_.level)));
        if (a.is_lower_end_ && b.is_lower_end_)
            return ends;
        if (a.is_lower_end_ && ends <= 0)
            return -1;
        if (b.is_lower_end_ && ends >= 0)
            return 1;
        Root& wider = a.cell_.level == coarse ? a : b;
        Root& narrower = &wider == &a ? b : a;
        if (!narrower.is_lower_end_ && std::exchange(may_be_equal, false) &&
            Bernstein(greatest_common_divisor(a.f_, b.f_), narrower.cell_).changes() % 2 != 0)
            return 0;
        wider.refine();
    }
}

std::array<double, 2> Root::bracket() {
    while (true) {
        const mpq_class lower = fraction(cell_.index, cell_.level);
        const double below = down(lower);
        if (is_lower_end_)
            return {below, exact(below) == lower ? below : next_above(below)};
        if (fraction(cell_.index + 1, cell_.level) <= exact(next_above(below)))
            return {below, next_above(below)};
        refine();
    }
}

std::vector<Root> roots_in_unit_interval(const Polynomial& given) {
    std::vector<Root> roots;
    Polynomial f = primitive(given);
    if (f.is_zero())
        return roots;
    const Cell all;
    Bernstein local(f, all);
    if (local.changes() > 1) { // else what lies inside is one simple root, or none
        const Polynomial repeated = greatest_common_divisor(f, derivative(f));
        if (repeated.degree() > 0) {
            f = primitive(divide(f, repeated).quotient);
            local = Bernstein(f, all);
        }
    }
    if (local.b[0] == 0)
        roots.push_back(Root::at_lower_end(f, all));
    const bool one_is_root = local.b[at(local.degree)] == 0;
    isolate(f, std::move(local), roots);
    if (one_is_root)
        roots.push_back(Root::at_lower_end(f, {1, 0}));
    return roots;
}

} // namespace boxwood::oracle
