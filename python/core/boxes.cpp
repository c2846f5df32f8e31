#include "arrays.h"
#include "core.h"

#include "trees/bvh.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <type_traits>
#include <variant>

namespace boxwood::python {
namespace {

/// Boxes of shape (n, 6), or corners of shape (n, 3) each, as one span of Aabb<Real>.
template <class Real> class GivenBoxes {
  public:
    GivenBoxes(const py::handle& given, const std::string& name) {
        if (py::isinstance<py::list>(given) && py::len(given) == 2 &&
            numbers_of(given, name).ndim() == 3)
            throw py::value_error(name +
                                  ": mins and maxs are given as a tuple, (mins, maxs), not a list");
        if (!py::isinstance<py::tuple>(given)) {
            rows_.emplace(given, name, std::initializer_list<py::ssize_t>{6});
            boxes_ = rows_->template as<Aabb<Real>>();
            return;
        }
        const auto corners = py::cast<py::tuple>(given);
        if (corners.size() != 2)
            throw py::value_error(name + ": a tuple of boxes is (mins, maxs), not one of " +
                                  std::to_string(corners.size()));
        const Rows<Real> mins(corners[0], name + "[0]", {3}), maxs(corners[1], name + "[1]", {3});
        if (mins.size() != maxs.size())
            throw py::value_error(name + ": there are " + std::to_string(mins.size()) +
                                  " mins and " + std::to_string(maxs.size()) + " maxs");
        const auto low = mins.template as<Vec3<Real>>(), high = maxs.template as<Vec3<Real>>();
        for (std::size_t i = 0; i < mins.size(); ++i)
            joined_.push_back({low[i], high[i]});
        boxes_ = joined_;
    }
    std::span<const Aabb<Real>> get() const { return boxes_; }

  private:
    std::optional<Rows<Real>> rows_;
    std::vector<Aabb<Real>> joined_;
    std::span<const Aabb<Real>> boxes_;
};

/// Whether numbers are to be held in doubles: all but float32 and float16.
bool are_doubles(const py::handle& given, const std::string& name) {
    if (py::isinstance<py::tuple>(given)) {
        for (const py::handle part : py::cast<py::tuple>(given))
            if (are_doubles(part, name))
                return true;
        return false;
    }
    const py::dtype type = numbers_of(given, name).dtype();
    return type.kind() != 'f' || type.itemsize() > 4;
}

constexpr std::size_t max_neighbours = std::size_t{1} << 32; ///< of one call: 64 GiB

/// A tree of float boxes, or of doubles where the boxes are.
class PyBvh {
    template <class Tree>
    using RealOf = std::conditional_t<std::is_same_v<Tree, BvhF64>, double, float>;

    bool is_double() const { return std::holds_alternative<BvhF64>(tree_); }
    template <class Ask> auto visit(const Ask& ask) const { return std::visit(ask, tree_); }
    template <class Real> static void require_no_nan(std::span<const Aabb<Real>> boxes) {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            for (int axis = 0; axis < 3; ++axis)
                if (std::isnan(boxes[i].min[axis]) || std::isnan(boxes[i].max[axis]))
                    throw py::value_error("boxes: row " + std::to_string(i) + " has a NaN");
    }
    static void require_floats(std::span<const Aabb<double>> boxes) {
        const auto is_rounded = [](double x) {
            return static_cast<double>(static_cast<float>(x)) < x ||
                   static_cast<double>(static_cast<float>(x)) > x;
        };
        for (std::size_t i = 0; i < boxes.size(); ++i)
            for (int axis = 0; axis < 3; ++axis)
                if (is_rounded(boxes[i].min[axis]) || is_rounded(boxes[i].max[axis]))
                    throw py::value_error("boxes: row " + std::to_string(i) +
                                          " is float64 for a tree of float32, which would round "
                                          "it; give float32, or make a Bvh of float64");
    }
    static py::object items(AnswersOf<std::uint32_t> found) {
        return named_tuple("Items")(array_of<std::uint64_t>(std::move(found.offsets)),
                                    array_of<std::uint32_t>(std::move(found.of)));
    }

    template <class Tree> void make(const py::object& boxes, const BvhOptions& options) {
        const GivenBoxes<RealOf<Tree>> given(boxes, "boxes");
        without_gil([&] { tree_.emplace<Tree>(given.get(), options); });
    }

    template <class Tree>
    void take(Tree& tree, const py::object& boxes, const std::optional<py::object>& moved) {
        const GivenBoxes<RealOf<Tree>> given(boxes, "boxes");
        if (!moved)
            return without_gil([&] { tree.update(given.get()); });
        const std::vector<std::uint32_t> items = indices_of(*moved, "moved", given.get().size());
        without_gil([&] { tree.update(given.get(), items); });
    }

    template <class Ask> auto ask(const PyBvh* other, const Ask& ask) const {
        if (other && other->is_double() != is_double())
            throw py::value_error("other: its boxes are held in another dtype; make both of "
                                  "float32 or both of float64");
        return visit([&]<class Tree>(const Tree& tree) {
            const Tree* const with = other ? &std::get<Tree>(other->tree_) : nullptr;
            return without_gil([&] { return ask(tree, with); });
        });
    }

  public:
    PyBvh(const py::object& boxes, const std::string& builder, const std::string& layout,
          std::int64_t threads) {
        BvhOptions options;
        options.builder = make_builder(builder);
        options.layout = static_cast<LayoutName>(&find_layout(layout) - layouts().data());
        options.threads = threads_of(threads);
        if (are_doubles(boxes, "boxes"))
            make<BvhF64>(boxes, options);
        else
            make<Bvh>(boxes, options);
    }

    std::size_t size() const {
        return visit([](const auto& tree) { return tree.size(); });
    }
    std::size_t bytes() const {
        return visit([](const auto& tree) { return tree.bytes(); });
    }
    unsigned threads() const {
        return visit([](const auto& tree) { return tree.options().threads; });
    }
    py::dtype dtype() const {
        return is_double() ? py::dtype::of<double>() : py::dtype::of<float>();
    }

    void update(const py::object& boxes, const std::optional<py::object>& moved) {
        if (!is_double() && are_doubles(boxes, "boxes"))
            require_floats(GivenBoxes<double>(boxes, "boxes").get());
        std::visit([&](auto& tree) { take(tree, boxes, moved); }, tree_);
    }

    py::array pairs(const PyBvh* other) const {
        std::vector<Pair> found = ask(other, [](const auto& tree, const auto* with) {
            return with ? tree.pairs(*with) : tree.self_pairs();
        });
        return array_of<std::uint32_t>(std::move(found), 2);
    }
    std::uint64_t pair_count(const PyBvh* other) const {
        return ask(other, [](const auto& tree, const auto* with) {
            return with ? tree.pair_count(*with) : tree.self_pair_count();
        });
    }

    py::object overlapping(const py::object& boxes) const {
        return visit([&]<class Tree>(const Tree& tree) {
            const GivenBoxes<RealOf<Tree>> given(boxes, "boxes");
            const auto asked = given.get();
            require_no_nan(asked);
            return items(without_gil([&] { return tree.overlapping(asked); }));
        });
    }

    py::object containing(const py::object& points) const {
        return visit([&]<class Tree>(const Tree& tree) {
            using Real = RealOf<Tree>;
            const Rows<Real> given(points, "points", {3});
            given.require_finite();
            const auto asked = given.template as<Vec3<Real>>();
            return items(without_gil([&] { return tree.containing(asked); }));
        });
    }

    py::object nearest(const py::object& points, py::ssize_t number) const {
        if (number < 1)
            throw py::value_error("k: at least 1 is wanted");
        const auto k = static_cast<std::size_t>(number);
        return visit([&]<class Tree>(const Tree& tree) {
            using Real = RealOf<Tree>;
            const Rows<Real> given(points, "points", {3});
            given.require_finite();
            if (k > max_neighbours / std::max<std::size_t>(1, given.size()))
                throw py::value_error("k: " + std::to_string(k) + " for each of " +
                                      std::to_string(given.size()) +
                                      " points are more than 2^32 answers; there are " +
                                      std::to_string(tree.size()) + " items");
            const auto asked = given.template as<Vec3<Real>>();
            std::vector<Neighbour> found = without_gil([&] { return tree.nearest(asked, k); });
            std::vector<double> distances(found.size());
            std::ranges::transform(found, distances.begin(), [](const Neighbour& near) {
                return std::sqrt(near.squared_distance);
            });
            const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(given.size()),
                                                 static_cast<py::ssize_t>(k)};
            const Owned<Neighbour> held(std::move(found));
            return named_tuple("Nearest")(
                held.column<std::int32_t>(offsetof(Neighbour, item)).reshape(shape),
                array_of<double>(std::move(distances)).reshape(shape));
        });
    }

  private:
    std::variant<Bvh, BvhF64> tree_;
};

} // namespace

void add_boxes(py::module_& to) {
    py::class_<PyBvh> made(to, "Bvh", R"(A tree of axis-aligned boxes (AABB tree, BVH).

Boxes are closed: one shared point counts. float32 and float16 are held in
float32, all other numbers in float64; answers are exact for what is held.
Queries of another dtype are converted to that of the tree.

Any number of threads may query one tree at the same time (the GIL is
released); who calls update() is alone with it meanwhile.)");
    refuse_copies(made);
    made.def(py::init<const py::object&, const std::string&, const std::string&, std::int64_t>(),
             py::arg("boxes"), py::kw_only(), py::arg("builder") = "hilbert",
             py::arg("layout") = "packed", py::arg("threads") = 1, R"(
boxes: shape (n, 6), each row min x, y, z, max x, y, z; or a tuple
    (mins, maxs) of shape (n, 3) each.
builder, layout: names of boxwood.builders() and boxwood.layouts(). The
    defaults are the fastest for pairs; many points and regions gain from
    "binned_sah" with "wide8", which take longer to make.
threads: how many a query of many, or a build, may use.

Raises ValueError for a wrong shape, for the first box with a NaN, an
infinity or min > max, and for an unknown name; TypeError for no numbers.)")
        .def("__len__", &PyBvh::size)
        .def("__repr__",
             [](const PyBvh& bvh) {
                 return "<boxwood.Bvh of " + std::to_string(bvh.size()) + " boxes, " +
                        std::string(py::str(bvh.dtype())) + ">";
             })
        .def_property_readonly("nbytes", &PyBvh::bytes, "Bytes of memory that the tree takes.")
        .def_property_readonly("dtype", &PyBvh::dtype, "float32 or float64: how boxes are held.")
        .def_property_readonly("threads", &PyBvh::threads,
                               "How many a query of many, or a build, may use.")
        .def("update", &PyBvh::update, py::arg("boxes"), py::arg("moved") = py::none(),
             R"(The boxes moved: as many as there were are fitted into the tree, and it is
built again where that made it too loose; of another number it is built again.

moved: shape (m,), the items that moved, ascending, if only these did. The
    others' boxes are compared with those held.

Raises ValueError for a bad box, for numbers that are no float32 where the tree
holds these, and where an item that is not listed moved; the tree then is as
before.)")
        .def("pairs", &PyBvh::pairs, py::arg("other") = py::none(),
             R"(Every two boxes that overlap, once: shape (m, 2), uint32, the lower first.
With another tree: every overlapping (item here, item of `other`).)")
        .def("pair_count", &PyBvh::pair_count, py::arg("other") = py::none(),
             "How many pairs() would find.")
        .def("overlapping", &PyBvh::overlapping, py::arg("boxes"),
             R"(The items that share a point with each of the given boxes.

boxes: shape (n, 6), or (mins, maxs). One with min > max shares none.

Returns Items(offsets, items): those of box i are
items[offsets[i]:offsets[i + 1]], ascending; offsets has n + 1 entries.)")
        .def("containing", &PyBvh::containing, py::arg("points"),
             R"(The items whose boxes contain each of the points, shape (n, 3).

Returns Items(offsets, items), as overlapping().)")
        .def("nearest", &PyBvh::nearest, py::arg("points"), py::arg("k") = 1,
             R"(The k items nearest to each of the points, shape (n, 3), by distance and then
by item; a box that contains the point has distance 0.

Returns Nearest(items, distances), each of shape (n, k), filled up with -1
and infinity if there are fewer. Raises ValueError for k < 1, and for more
than 2^32 answers.)");
}

} // namespace boxwood::python
