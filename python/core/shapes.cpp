#include "shapes.h"

#include "core.h"
#include "poses.h"

#include <string>

namespace boxwood::python {
namespace {

Vec3<double> vector_of(const py::handle& given, const std::string& name) {
    const py::array numbers = numbers_of(given, name);
    if (numbers.ndim() != 1 || numbers.shape(0) != 3)
        throw py::value_error(name + ": three numbers are wanted, not " + shape_of(numbers));
    const py::array_t<double, py::array::c_style | py::array::forcecast> xyz(numbers);
    return {xyz.at(0), xyz.at(1), xyz.at(2)};
}

std::string described(const BodyShape& shape) {
    if (shape.shape_class() == ShapeClass::convex)
        return std::string(to_string(shape.convex_shape().kind()));
    return shape.shape_class() == ShapeClass::solid ? "solid" : "surface";
}

} // namespace

BodyShape body_shape_of(const py::object& given, const std::string& name) {
    if (py::isinstance<PyMesh>(given))
        return BodyShape::surface(py::cast<const PyMesh&>(given).shared_tree());
    if (!py::isinstance<BodyShape>(given))
        throw py::type_error(name + ": a boxwood.Shape or boxwood.Mesh is wanted, not " +
                             std::string(py::str(py::type::of(given))));
    return py::cast<BodyShape>(given);
}

void add_shapes(py::module_& to) {
    using py::arg;
    py::class_<BodyShape> made(to, "Shape",
                               R"(What a body of a World is made of, in a frame of its own.

Made by one of the functions below; any number of bodies may share one. The tree
of a mesh is built when two bodies first need it.)");
    refuse_copies(made);
    made.def_static(
            "surface",
            [](const py::object& vertices, const py::object& faces) {
                return BodyShape::surface(mesh_of(vertices, faces));
            },
            arg("vertices"), arg("faces"),
            "The surface of a mesh: what lies inside without touching it is apart. "
            "vertices: (n, 3), held in float32; faces: (m, 3). A boxwood.Mesh will do as well.")
        .def_static(
            "solid",
            [](const py::object& vertices, const py::object& faces) {
                return BodyShape::solid(mesh_of(vertices, faces));
            },
            arg("vertices"), arg("faces"),
            "A closed mesh and what is inside. Raises ValueError for an open one.")
        .def_static(
            "sphere", [](double radius) { return BodyShape(convex::Sphere{radius}); },
            arg("radius"), "A ball around the origin.")
        .def_static(
            "box",
            [](const py::object& sides) {
                return BodyShape(convex::Box{0.5 * vector_of(sides, "sides")});
            },
            arg("sides"), "About the origin; sides: three full lengths.")
        .def_static(
            "capsule",
            [](double radius, double length) {
                return BodyShape(convex::Capsule{radius, 0.5 * length});
            },
            arg("radius"), arg("length"), "Along z; length: of the segment, without round ends.")
        .def_static(
            "cylinder",
            [](double radius, double length) {
                return BodyShape(convex::Cylinder{radius, 0.5 * length});
            },
            arg("radius"), arg("length"), "Along z.")
        .def_static(
            "cone",
            [](double radius, double length) {
                return BodyShape(convex::Cone{radius, 0.5 * length});
            },
            arg("radius"), arg("length"), "Along z, its tip up.")
        .def_static(
            "ellipsoid",
            [](const py::object& radii) {
                return BodyShape(convex::Ellipsoid{vector_of(radii, "radii")});
            },
            arg("radii"), "Around the origin: radii along x, y and z.")
        .def_static(
            "half_space",
            [](const py::object& normal, double offset) {
                return BodyShape(convex::HalfSpace{vector_of(normal, "normal"), offset});
            },
            arg("normal"), arg("offset") = 0.0, "The points with normal . p <= offset.")
        .def_static(
            "plane",
            [](const py::object& normal, double offset) {
                return BodyShape(convex::Plane{vector_of(normal, "normal"), offset});
            },
            arg("normal"), arg("offset") = 0.0, "The points with normal . p = offset.")
        .def_static(
            "hull",
            [](const py::object& points) {
                const Rows<double> rows(points, "points", {3});
                const auto all = rows.as<Vec3<double>>();
                return BodyShape::hull({all.begin(), all.end()});
            },
            arg("points"), "The convex hull of points of shape (n, 3).")
        .def_static(
            "points",
            [](const py::object& points, double radius) {
                const Rows<float> rows(points, "points", {3});
                return BodyShape::points(rows.as<Vec3<float>>(), radius);
            },
            arg("points"), arg("radius"),
            "Balls about points of shape (n, 3), held in float32; answers name them by index.")
        .def_static(
            "height_field",
            [](const py::object& heights, double step_x, double step_y) {
                const py::array given = numbers_of(heights, "heights");
                if (given.ndim() != 2)
                    throw py::value_error("heights: an array of shape (rows, columns) is wanted, "
                                          "not " +
                                          shape_of(given));
                const py::array_t<float, py::array::c_style | py::array::forcecast> z(given);
                return BodyShape::height_field(static_cast<std::size_t>(z.shape(1)),
                                               {z.data(), static_cast<std::size_t>(z.size())},
                                               static_cast<float>(step_x),
                                               static_cast<float>(step_y));
            },
            arg("heights"), arg("step_x") = 1.0, arg("step_y") = 1.0,
            "The surface over a grid: heights[j, i] is at (i step_x, j step_y).")
        .def("__repr__",
             [](const BodyShape& shape) { return "<boxwood.Shape: " + described(shape) + ">"; })
        .def_property_readonly("is_built", &BodyShape::is_built,
                               "Whether the tree of its mesh is there.");
}

} // namespace boxwood::python
