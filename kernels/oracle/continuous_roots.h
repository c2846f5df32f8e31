#pragma once

#include "kernels/oracle/exact_vector.h"

#include <array>
#include <vector>

/// Polynomials of one variable over the integers and their roots in [0, 1], under the exact
/// continuous kernel. Nothing rounds.
namespace boxwood::oracle {

/// c[0] + c[1] t + c[2] t^2 + c[3] t^3.
struct Polynomial {
    static constexpr int max_degree = 3;
    std::array<Integer, max_degree + 1> c;

    int degree() const; ///< -1 for the polynomial 0
    bool is_zero() const { return degree() < 0; }
};
Polynomial operator+(const Polynomial& a, const Polynomial& b);
Polynomial operator-(const Polynomial& a, const Polynomial& b);
/// The degrees may add up to 3 at most.
Polynomial operator*(const Polynomial& a, const Polynomial& b);

/// The cell [index, index + 1] / 2^level of [0, 1].
struct Cell {
    Integer index; ///< 0 at first
    unsigned level = 0;
};

/// Coefficients on a cell, up to a positive factor, in the Bernstein basis of the degree: on the
/// open cell the sign changes among them (zeros skipped) bound the number of roots, counted
/// with multiplicity, and differ from it by an even number (Descartes' rule).
struct Bernstein {
    std::array<Integer, Polynomial::max_degree + 1> b;
    int degree = -1;

    Bernstein(const Polynomial& f, const Cell& cell);
    int changes() const;
    /// The sign just right of the cell's lower end; 0 for the polynomial 0.
    int first_sign() const;
    /// Becomes the coefficients on the lower half; those on the upper half are returned.
    Bernstein halve();
};

/// A real root in [0, 1] of a polynomial: the lower end of its cell, or else the only root in the
/// open cell, and a simple one.
class Root {
  public:
    static Root zero();
    static Root at_lower_end(Polynomial f, Cell cell);
    static Root inside(Polynomial f, Cell cell, Bernstein local);

    bool is_lower_end() const { return is_lower_end_; }
    const Cell& cell() const { return cell_; }

    /// Makes the cell 2^-jump as wide around where the secant meets 0, jump twice as large each
    /// time that the root is there, else halves it: so d levels take some log d steps (quadratic
    /// interval refinement, Abbott 2006). For a root that is a lower end: nothing.
    void refine();
    /// The sign of g at the root. May refine.
    int sign_of(const Polynomial& g);
    /// The order of two roots, perhaps of two polynomials: -1, 0 or 1. May refine.
    friend int compare(Root& a, Root& b);
    /// The largest double <= the root and the least >= it. May refine.
    std::array<double, 2> bracket();

  private:
    Root(Polynomial f, Cell cell, Bernstein local, bool is_lower_end)
        : f_(std::move(f)), cell_(std::move(cell)), local_(std::move(local)),
          is_lower_end_(is_lower_end) {}

    Polynomial f_;
    Cell cell_;
    Bernstein local_; ///< f on the cell, unless the root is its lower end
    bool is_lower_end_;
    unsigned jump_ = 1;
};

/// The distinct roots of f in [0, 1], ascending; none for the polynomial 0.
std::vector<Root> roots_in_unit_interval(const Polynomial& f);

} // namespace boxwood::oracle
