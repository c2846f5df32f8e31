#include "arrays.h"
#include "core.h"
#include "poses.h"
#include "shapes.h"

#include "trees/world/continuous.h"
#include "trees/world/mesh_contacts.h"
#include "trees/world/mesh_shape.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
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

MotionPath path_of(const std::string& name) {
    if (name == "linear")
        return MotionPath::linear;
    if (name == "screw")
        return MotionPath::screw;
    throw py::value_error("path: linear or screw is wanted, not '" + name + "'");
}

PyMesh::PyMesh(const py::object& vertices, const py::object& faces, const std::string& builder) {
    TriangleMesh mesh = mesh_of(vertices, faces);
    MeshTreeOptions options;
    options.builder = make_builder(builder);
    without_gil([&] { tree_ = std::make_shared<const MeshTree>(std::move(mesh), options); });
}

namespace {

/// What a mesh is asked about: a mesh or a convex shape.
class Other {
  public:
    explicit Other(const py::object& given) {
        if (py::isinstance<PyMesh>(given)) {
            mesh_ = py::cast<const PyMesh&>(given).shared_tree();
            return;
        }
        shape_ = body_shape_of(given, "other");
        if (shape_->shape_class() != ShapeClass::convex)
            throw py::type_error("other: a boxwood.Mesh or a convex boxwood.Shape is wanted; a "
                                 "World takes every shape");
    }
    bool is_mesh() const { return mesh_ != nullptr; }
    template <class F> auto answer(F&& f) const {
        return mesh_ ? f(*mesh_) : f(shape_->convex_shape());
    }

  private:
    std::shared_ptr<const MeshTree> mesh_;
    std::optional<BodyShape> shape_; ///< where mesh_ is null
};

/// A mesh, and the other seen from it.
class Posed {
  public:
    Posed(const PyMesh& mesh, const py::object& other, const py::object& pose,
          const py::object& other_pose)
        : at(pose_of(pose, "pose")), a_(mesh.shared_tree()), b_(other),
          b_in_a_(relative_pose(at, pose_of(other_pose, "other_pose"))) {}
    bool is_mesh() const { return b_.is_mesh(); }
    Vec3<double> direction(const Vec3<double>& v) const { return at.rotated(v); }
    /// f(mesh, the other, its pose in the mesh's frame) without the interpreter's lock.
    template <class F> auto answer(F&& f) const {
        return without_gil(
            [&] { return b_.answer([&](const auto& b) { return f(*a_, b, b_in_a_); }); });
    }

    Pose at;

  private:
    std::shared_ptr<const MeshTree> a_;
    Other b_;
    Pose b_in_a_;
};

bool is_yes(bool yes) { return yes; }
bool is_yes(Decision decision) { return decision.answer != Answer::no; }

std::vector<Pair> touching(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                           std::size_t limit) {
    return touching_triangles(a, b, b_in_a, limit);
}
std::vector<Pair> touching(const MeshTree& a, const convex::Shape& b, const Pose& b_in_a,
                           std::size_t limit) {
    std::vector<Pair> pairs;
    for (const Contact& contact : contacts(a, b, b_in_a))
        pairs.push_back(contact.triangles);
    std::ranges::sort(pairs);
    pairs.resize(std::min(limit, pairs.size()));
    return pairs;
}

/// The pair of triangles to start from: two numbers.
std::optional<Pair> start_of(const py::object& given, const PyMesh& mesh, const py::object& other) {
    if (given.is_none())
        return std::nullopt;
    if (!py::isinstance<PyMesh>(other))
        throw py::type_error("start: only two meshes have triangles to start from");
    const auto [a, b] = py::cast<std::pair<std::int64_t, std::int64_t>>(given);
    const auto n_a = static_cast<std::int64_t>(mesh.tree().size());
    const auto n_b = static_cast<std::int64_t>(py::cast<const PyMesh&>(other).tree().size());
    if (a < 0 || a >= n_a || b < 0 || b >= n_b)
        throw py::value_error("start: triangles (" + std::to_string(a) + ", " + std::to_string(b) +
                              ") are not those of meshes of " + std::to_string(n_a) + " and " +
                              std::to_string(n_b));
    return Pair{static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)};
}

py::object distance_of(const PyMesh& mesh, const py::object& other, const py::object& pose,
                       const py::object& other_pose, double relative, double absolute,
                       const py::object& start, double limit) {
    const Posed posed(mesh, other, pose, other_pose);
    DistanceOptions options;
    options.relative = relative;
    options.absolute = absolute;
    options.start = start_of(start, mesh, other);
    options.limit = limit;
    const MeshDistance d = posed.answer([&](const MeshTree& a, const auto& b, const Pose& b_in_a) {
        return distance(a, b, b_in_a, options);
    });
    const auto triangle = [&](std::uint32_t i, bool is_mesh = true) {
        return is_mesh && d.found() ? static_cast<std::int64_t>(i) : -1;
    };
    return named_tuple("MeshDistance")(d.distance, d.lo, d.hi, point_of(posed.at(d.point_a)),
                                       point_of(posed.at(d.point_b)), triangle(d.triangles.a),
                                       triangle(d.triangles.b, posed.is_mesh()));
}

py::object first_contact_of(const PyMesh& mesh, const py::object& other, const py::object& to,
                            const py::object& other_to, const py::object& pose,
                            const py::object& other_pose, const std::string& path,
                            double tolerance) {
    const auto motion = [&](const py::object& from, const char* from_name, const py::object& end,
                            const char* end_name) {
        const Pose start = pose_of(from, from_name);
        return Motion(start, end.is_none() ? start : pose_of(end, end_name), path_of(path));
    };
    const Motion a = motion(pose, "pose", to, "to"),
                 b = motion(other_pose, "other_pose", other_to, "other_to");
    ContinuousOptions options;
    options.tolerance = tolerance;
    const Other of(other);
    const FirstContact found = without_gil([&] {
        return of.answer(
            [&](const auto& what) { return first_contact(mesh.tree(), a, what, b, options); });
    });
    if (found.hit == Answer::no)
        return py::none();
    const auto triangle = [](std::uint32_t i, bool is_mesh = true) {
        return is_mesh && i != ~0u ? std::int64_t{i} : -1;
    };
    return named_tuple("MeshFirstContact")(found.t_free, found.t_hit, found.hit == Answer::yes,
                                           triangle(found.triangles.a),
                                           triangle(found.triangles.b, of.is_mesh()));
}

py::object contacts_of(const PyMesh& mesh, const py::object& other, const py::object& pose,
                       const py::object& other_pose, const std::optional<std::size_t>& most) {
    const Posed posed(mesh, other, pose, other_pose);
    ContactOptions options;
    options.max_contacts = most.value_or(options.max_contacts);
    std::vector<Contact> found =
        posed.answer([&](const MeshTree& a, const auto& b, const Pose& b_in_a) {
            return contacts(a, b, b_in_a, options);
        });
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
    py::class_<PyMesh> made(
        to, "Mesh",
        R"(A mesh for questions about two: do they touch, how far apart are they.

The other is a Mesh, or a convex Shape (sphere, box, capsule, cylinder, cone,
ellipsoid, half-space, plane, hull), which is solid: a mesh inside touches it.

Vertices are held in float32. A pose is an array of shape (4, 4), a rotation
and a translation; None is no motion. The other mesh's corners are moved into
the first one's frame in float64 and rounded once; answers are exact, or
certified, for those. A mesh is its surface: what lies inside one without
touching it is apart.

Any number of threads may query one mesh at the same time (the GIL is released).)");
    refuse_copies(made);
    made.def(py::init<const py::object&, const py::object&, const std::string&>(), arg("vertices"),
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
            [](const PyMesh& mesh, const py::object& other, const py::object& pose,
               const py::object& other_pose) {
                const Posed posed(mesh, other, pose, other_pose);
                return posed.answer([](const MeshTree& a, const auto& b, const Pose& b_in_a) {
                    return is_yes(collide(a, b, b_in_a));
                });
            },
            arg("other"), at, other_at,
            "Whether the two share a point; touching counts. Exact; of a Shape true, too, where "
            "they are apart by no more than rounding.")
        .def(
            "touching",
            [](const PyMesh& mesh, const py::object& other, const py::object& pose,
               const py::object& other_pose, const std::optional<std::size_t>& most) {
                const Posed posed(mesh, other, pose, other_pose);
                return array_of<std::uint32_t>(
                    posed.answer([&](const MeshTree& a, const auto& b, const Pose& b_in_a) {
                        return touching(a, b, b_in_a,
                                        most.value_or(std::numeric_limits<std::size_t>::max()));
                    }),
                    2);
            },
            arg("other"), at, other_at, py::kw_only(), arg("max_pairs") = py::none(),
            "The pairs of triangles, of this mesh and of the other (of a Shape 0, and also those "
            "that are apart by no more than rounding), that touch: shape (m, 2), uint32. "
            "max_pairs: at most so many; between two meshes the search ends there.")
        .def("distance", &distance_of, arg("other"), at, other_at, py::kw_only(),
             arg("relative") = 0.0, arg("absolute") = 0.0, arg("start") = py::none(),
             arg("limit") = std::numeric_limits<double>::infinity(),
             R"(How far apart the two are.

Returns MeshDistance(distance, lo, hi, point_a, point_b, triangle_a,
triangle_b): the true distance lies between lo and hi, 2^-32 of it apart, and
all three are 0 exactly where they touch. Of a Shape triangle_b is -1, and
the bounds are 2e-14 of the size of both wider (of cylinders, cones and
ellipsoids in rare cases 2^-19 of the distance). The points are in world
coordinates.
relative, absolute: the answer may be farther than the least distance, so that
    hi <= (lo + absolute) / (1 - relative).
start: the triangles of the last answer along a motion (two meshes): the search
    is then quicker, the answer as good.
limit: nothing at this distance or beyond is looked for; lo is then at least
    this, the others infinite and the triangles -1.)")
        .def("first_contact", &first_contact_of, arg("other"), arg("to") = py::none(),
             arg("other_to") = py::none(), arg("pose") = py::none(), arg("other_pose") = py::none(),
             py::kw_only(), arg("path") = "linear", arg("tolerance") = 0.0,
             R"(When this mesh and the other first touch on their ways, t from 0 to 1.

to, other_to: where each goes from pose and other_pose; None is that it stays.
path: linear (the origin on a line, turning about it at a constant rate) or
    screw (about one axis of space and along it).
tolerance: nearer than this they touch; 0 is 2^-36 of their sizes.
A Shape is solid, but for a plane, and its triangle_b is -1.
Returns MeshFirstContact(t_free, t_hit, is_certain, triangle_a, triangle_b):
until t_free they surely do not touch, nothing thin is passed through, and at
t_hit they do if is_certain; None if they never touch.)")
        .def(
            "within",
            [](const PyMesh& mesh, const py::object& other, double tolerance,
               const py::object& pose, const py::object& other_pose) {
                const Posed posed(mesh, other, pose, other_pose);
                return posed.answer([&](const MeshTree& a, const auto& b, const Pose& b_in_a) {
                    return within(a, b, b_in_a, tolerance).within;
                });
            },
            arg("other"), arg("tolerance"), at, other_at,
            "Whether the two are at most `tolerance` apart; of a Shape also where they are farther "
            "by "
            "no more than the bounds of `distance` are wide.")
        .def("contacts", &contacts_of, arg("other"), at, other_at, py::kw_only(),
             arg("max_contacts") = py::none(),
             R"(Where the two touch, the deepest first.

Returns Contacts(points, normals, depths, triangles) of shape (n, 3), (n, 3),
(n,) and (n, 2), one for each pair of triangles: the other mesh has to move by
depth * normal for the two triangles to touch at most. A Shape counts as one
triangle, 0.
max_contacts: of more the deepest, and then those that span the most.)");
}

} // namespace boxwood::python
