#include "arrays.h"
#include "core.h"

#include "kernels/registry.h"
#include "trees/executor.h"

#include <algorithm>
#include <array>

namespace boxwood::python {
namespace {

/// Two rows of triangles, as many on each side, in doubles.
struct Pairs {
    Rows<double> first, second;

    Pairs(const py::object& a, const py::object& b)
        : first(a, "a", {3, 3}), second(b, "b", {3, 3}) {
        if (first.size() != second.size())
            throw py::value_error("a has " + std::to_string(first.size()) + " triangles, b has " +
                                  std::to_string(second.size()));
        first.require_finite();
        second.require_finite();
    }
    std::size_t size() const { return first.size(); }
    const Triangle<double>& a(std::size_t i) const { return first.as<Triangle<double>>()[i]; }
    const Triangle<double>& b(std::size_t i) const { return second.as<Triangle<double>>()[i]; }
};

/// body(begin, end) for parts of n pairs, on so many threads, without the GIL.
template <class Body> void in_parts(std::size_t n, std::int64_t given_threads, const Body& body) {
    constexpr std::size_t part = 1024; // a multiple of the lanes of a block
    const unsigned threads = threads_of(given_threads);
    const auto executor = make_executor(default_executor(threads), threads);
    without_gil([&] {
        executor->for_each((n + part - 1) / part,
                           [&](std::size_t i) { body(i * part, std::min(n, (i + 1) * part)); });
    });
}

py::array triangles_intersect(const py::object& a, const py::object& b, std::int64_t threads) {
    using Kernel = GuigueDevillersExactBatch;
    using Block = TrianglePairBlock<double>;
    const Pairs pairs(a, b);
    py::array_t<bool> answers(static_cast<py::ssize_t>(pairs.size()));
    bool* const out = answers.mutable_data();
    in_parts(pairs.size(), threads, [&](std::size_t begin, std::size_t end) {
        std::array<Block, 16> blocks{};
        std::array<Decision, 16 * Block::lanes> decisions;
        for (std::size_t i = begin; i < end; i += decisions.size()) {
            const std::size_t n = std::min(decisions.size(), end - i);
            for (std::size_t k = 0; k < n; ++k)
                blocks[k / Block::lanes].set(k % Block::lanes, pairs.a(i + k), pairs.b(i + k));
            Kernel::intersect(blocks, std::span(decisions).first(n));
            for (std::size_t k = 0; k < n; ++k)
                out[i + k] = decisions[k].answer == Answer::yes;
        }
    });
    return answers;
}

py::object triangle_distances(const py::object& a, const py::object& b, std::int64_t threads) {
    const Pairs pairs(a, b);
    std::vector<Distance> found(pairs.size());
    in_parts(pairs.size(), threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            found[i] = CertifiedDistance::distance(pairs.a(i), pairs.b(i));
    });
    const Owned<Distance> held(std::move(found));
    return named_tuple("Distances")(held.column<double>(offsetof(Distance, distance)),
                                    held.column<double>(offsetof(Distance, lo)),
                                    held.column<double>(offsetof(Distance, hi)));
}

} // namespace

void add_triangles(py::module_& to) {
    using py::arg;
    to.def("triangles_intersect", &triangles_intersect, arg("a"), arg("b"), py::kw_only(),
           arg("threads") = 1,
           R"(Whether triangle i of a shares a point with triangle i of b: exact.

a, b: shape (n, 3, 3), the corners of each; held in float64. Triangles may be
    degenerate.

Returns shape (n,), bool. Raises ValueError for shapes that do not fit and for
a NaN or infinity.)");
    to.def("triangle_distances", &triangle_distances, arg("a"), arg("b"), py::kw_only(),
           arg("threads") = 1,
           R"(How far triangle i of a is from triangle i of b: certified.

a, b: as triangles_intersect.

Returns Distances(distance, lo, hi), each of shape (n,): the true distance is
in [lo, hi], and so is `distance`; hi - lo <= 2^-32 hi + 2^-1073.)");
}

} // namespace boxwood::python
