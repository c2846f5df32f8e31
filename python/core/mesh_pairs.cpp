#include "arrays.h"
#include "core.h"
#include "poses.h"

#include "trees/world/mesh_contacts.h"

#include <pybind11/stl.h>

#include <optional>

namespace boxwood::python {
namespace {

/// 16 numbers, row by row.
Pose named_pose(std::span<const double> m, const std::string& name) {
    try {
        return pose_of_matrix(m.first<16>());
    } catch (const std::invalid_argument& error) {
        throw py::value_error(name + ": " + error.what());
    }
}

} // namespace

Pose pose_of(const py::object& given, const std::string& name) {
    if (given.is_none())
        return {};
    const Rows<double> rows(given, name, {4});
    if (rows.size() != 4)
        throw py::value_error(name + ": an array of shape (4, 4) is wanted, not (" +
                              std::to_string(rows.size()) + ", 4)");
    return named_pose(rows.numbers(), name);
}

std::vector<Pose> poses_of(const py::object& given, const std::string& name) {
    const Rows<double> rows(given, name, {4, 4});
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < rows.size(); ++i)
        poses.push_back(
            named_pose(rows.numbers().subspan(16 * i, 16), name + ": row " + std::to_string(i)));
    return poses;
}

PyMesh::PyMesh(const py::object& vertices, const py::object& faces, const std::string& builder) {
    TriangleMesh mesh = mesh_of(vertices, faces);
    MeshTreeOptions options;
    options.builder = make_builder(builder);
    without_gil([&] { tree_ = std::make_shared<const MeshTree>(std::move(mesh), options); });
}

namespace {

/// Two meshes, the second seen from the first.
struct Posed {
    Posed(const PyMesh& mesh, const PyMesh& other_mesh, const py::object& pose,
          const py::object& other_pose)
        : a(mesh.tree()), b(other_mesh.tree()), at(pose_of(pose, "pose")),
          b_in_a(relative_pose(at, pose_of(other_pose, "other_pose"))) {}
    Vec3<double> direction(const Vec3<double>& v) const { return at.rotated(v); }

    const MeshTree &a, &b;
    Pose at, b_in_a;
};

py::object distance_of(const PyMesh& mesh, const PyMesh& other, const py::object& pose,
                       const py::object& other_pose, double relative, double absolute) {
    const Posed posed(mesh, other, pose, other_pose);
    DistanceOptions options;
    options.relative = relative;
    options.absolute = absolute;
    const MeshDistance d =
        without_gil([&] { return distance(posed.a, posed.b, posed.b_in_a, options); });
    const auto triangle = [&](std::uint32_t i) {
        return d.found() ? static_cast<std::int64_t>(i) : -1;
    };
    return named_tuple("MeshDistance")(d.distance, d.lo, d.hi, point_of(posed.at(d.point_a)),
                                       point_of(posed.at(d.point_b)), triangle(d.triangles.a),
                                       triangle(d.triangles.b));
}

py::object contacts_of(const PyMesh& mesh, const PyMesh& other, const py::object& pose,
                       const py::object& other_pose, const std::optional<std::size_t>& most) {
    const Posed posed(mesh, other, pose, other_pose);
    ContactOptions options;
    options.max_contacts = most.value_or(options.max_contacts);
    std::vector<Contact> found =
        without_gil([&] { return contacts(posed.a, posed.b, posed.b_in_a, options); });
    for (Contact& contact : found) {
        contact.point = posed.at(contact.point);
        contact.normal = posed.direction(contact.normal);
    }
    const Owned<Contact> held(std::move(found));
    return named_tuple("Contacts")(held.column<double>(offsetof(Contact, point), 3),
                                   held.column<double>(offsetof(Contact, normal), 3),
                                   held.column<double>(offsetof(Contact, depth)),
                                   held.column<std::uint32_t>(offsetof(Contact, triangles), 2));
}

} // namespace

void add_mesh_pairs(py::module_& to) {
    using py::arg;
    const auto at = arg("pose") = py::none();
    const auto other_at = arg("other_pose") = py::none();
    py::class_<PyMesh>(to, "Mesh",
                       R"(A mesh for questions about two: do they touch, how far apart are they.

Vertices are held in float32. A pose is an array of shape (4, 4), a rotation
and a translation; None is no motion. The other mesh's corners are moved into
the first one's frame in float64 and rounded once; answers are exact, or
certified, for those. A mesh is its surface: what lies inside one without
touching it is apart.

Any number of threads may query one mesh at the same time (the GIL is released).)")
        .def(py::init<const py::object&, const py::object&, const std::string&>(), arg("vertices"),
             arg("faces"), py::kw_only(), arg("builder") = "binned_sah", R"(
vertices: shape (n, 3). faces: shape (m, 3), integers, each row the vertices of
    a triangle.
builder: a name that `boxwood list builders` prints.

Raises ValueError for a wrong shape, a face with a vertex that is not there, a
vertex with a NaN or a number of 2^60 or more, and for an unknown name.)")
        .def("__len__", [](const PyMesh& mesh) { return mesh.tree().size(); })
        .def("__repr__",
             [](const PyMesh& mesh) {
                 return "<boxwood.Mesh of " + std::to_string(mesh.tree().size()) + " triangles>";
             })
        .def_property_readonly(
            "nbytes", [](const PyMesh& mesh) { return mesh.tree().bytes(); },
            "Bytes of memory that the tree takes.")
        .def(
            "collides",
            [](const PyMesh& mesh, const PyMesh& other, const py::object& pose,
               const py::object& other_pose) {
                const Posed posed(mesh, other, pose, other_pose);
                return without_gil([&] { return collide(posed.a, posed.b, posed.b_in_a); });
            },
            arg("other"), at, other_at, "Whether the two share a point; touching counts. Exact.")
        .def(
            "touching",
            [](const PyMesh& mesh, const PyMesh& other, const py::object& pose,
               const py::object& other_pose) {
                const Posed posed(mesh, other, pose, other_pose);
                return array_of<std::uint32_t>(
                    without_gil([&] { return touching_triangles(posed.a, posed.b, posed.b_in_a); }),
                    2);
            },
            arg("other"), at, other_at,
            "The pairs of triangles, of this mesh and of the other, that touch: shape (m, 2), "
            "uint32.")
        .def("distance", &distance_of, arg("other"), at, other_at, py::kw_only(),
             arg("relative") = 0.0, arg("absolute") = 0.0,
             R"(How far apart the two are.

Returns MeshDistance(distance, lo, hi, point_a, point_b, triangle_a,
triangle_b): the true distance lies between lo and hi, 2^-32 of it apart, and
all three are 0 exactly where they touch. The points are in world coordinates.
relative, absolute: the answer may be farther than the least distance, so that
    hi <= (lo + absolute) / (1 - relative).)")
        .def(
            "within",
            [](const PyMesh& mesh, const PyMesh& other, double tolerance, const py::object& pose,
               const py::object& other_pose) {
                const Posed posed(mesh, other, pose, other_pose);
                return without_gil(
                    [&] { return within(posed.a, posed.b, posed.b_in_a, tolerance).within; });
            },
            arg("other"), arg("tolerance"), at, other_at,
            "Whether the two are at most `tolerance` apart.")
        .def("contacts", &contacts_of, arg("other"), at, other_at, py::kw_only(),
             arg("max_contacts") = py::none(),
             R"(Where the two touch, the deepest first.

Returns Contacts(points, normals, depths, triangles) of shape (n, 3), (n, 3),
(n,) and (n, 2), one for each pair of triangles: the other mesh has to move by
depth * normal for the two triangles to touch at most.
max_contacts: of more the deepest, and then those that span the most.)");
}

} // namespace boxwood::python
