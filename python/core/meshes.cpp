#include "arrays.h"
#include "core.h"
#include "kernels/suggest.h"

#include "trees/mesh_bvh.h"

#include <algorithm>
#include <optional>

namespace boxwood::python {
namespace {

/// One number for all rays, or one for each.
class PerRay {
  public:
    PerRay(const py::object& given, const std::string& name, std::size_t n) {
        const py::array array = numbers_of(given, name);
        if (array.ndim() == 0) {
            all_ = given.cast<float>();
            return;
        }
        each_.emplace(array, name, std::initializer_list<py::ssize_t>{});
        if (each_->size() != n)
            throw py::value_error(name + ": one number, or one for each of the " +
                                  std::to_string(n) + " rays is wanted, not " +
                                  std::to_string(each_->size()));
    }
    float operator[](std::size_t i) const { return each_ ? each_->numbers()[i] : all_; }

  private:
    float all_ = 0;
    std::optional<Rows<float>> each_;
};

std::vector<Ray<float>> rays_of(const py::object& origins, const py::object& directions,
                                const py::object& t_min, const py::object& t_max) {
    const Rows<float> from(origins, "origins", {3}), along(directions, "directions", {3});
    if (from.size() != along.size())
        throw py::value_error("there are " + std::to_string(from.size()) + " origins and " +
                              std::to_string(along.size()) + " directions");
    from.require([](float x) { return std::abs(x) < max_ray_coordinate; },
                 "has a NaN, or a number of 2^126 or more");
    along.require([](float x) { return std::abs(x) < max_ray_coordinate; },
                  "has a NaN, or a number of 2^126 or more");
    const auto o = from.as<Vec3<float>>(), d = along.as<Vec3<float>>();
    const PerRay low(t_min, "t_min", o.size()), high(t_max, "t_max", o.size());
    std::vector<Ray<float>> rays(o.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (d[i] == Vec3<float>{})
            throw py::value_error("directions: row " + std::to_string(i) + " is zero");
        if (!(low[i] >= 0) || std::isnan(high[i]))
            throw py::value_error("t_min, t_max: of ray " + std::to_string(i) +
                                  ": 0 <= t_min is wanted, and no NaN");
        rays[i] = {o[i], d[i], low[i], high[i]};
    }
    return rays;
}

py::object hits_of(std::vector<RayHit> found) {
    const Owned<RayHit> held(std::move(found));
    return named_tuple("Hits")(held.column<float>(offsetof(RayHit, t)),
                               held.column<std::int32_t>(offsetof(RayHit, triangle)),
                               held.column<float>(offsetof(RayHit, u)),
                               held.column<float>(offsetof(RayHit, v)));
}

class PyMeshBvh {
  public:
    PyMeshBvh(const py::object& vertices, const py::object& faces, const std::string& builder,
              const std::string& layout, const std::string& kernel, std::int64_t threads) {
        MeshBvhOptions options;
        options.builder = make_builder(builder);
        options.layout = static_cast<LayoutName>(&find_layout(layout) - layouts().data());
        options.kernel = kernel_named(kernel);
        options.threads = threads_of(threads);
        TriangleMesh mesh = mesh_of(vertices, faces);
        require_corners(mesh.vertices, mesh);
        without_gil([&] { bvh_.emplace(std::move(mesh), options); });
    }

    const MeshBvh& bvh() const { return *bvh_; }

    void update(const py::object& vertices) {
        const Rows<float> points(vertices, "vertices", {3});
        const auto corners = points.as<Vec3<float>>();
        if (corners.size() == bvh_->mesh().vertices.size()) // else update() says so
            require_corners(corners, bvh_->mesh());
        without_gil([&] { bvh_->update(corners); });
    }

    py::object closest_hits(const py::object& origins, const py::object& directions,
                            const py::object& t_min, const py::object& t_max) const {
        const std::vector<Ray<float>> rays = rays_of(origins, directions, t_min, t_max);
        return hits_of(without_gil([&] { return bvh_->closest_hits(rays); }));
    }
    py::object any_hits(const py::object& origins, const py::object& directions,
                        const py::object& t_min, const py::object& t_max) const {
        const std::vector<Ray<float>> rays = rays_of(origins, directions, t_min, t_max);
        const std::vector<RayHit> found = without_gil([&] { return bvh_->any_hits(rays); });
        py::array_t<bool> hits(static_cast<py::ssize_t>(found.size()));
        std::ranges::transform(found, hits.mutable_data(), &RayHit::hit);
        return hits;
    }
    py::object all_hits(const py::object& origins, const py::object& directions,
                        const py::object& t_min, const py::object& t_max) const {
        const std::vector<Ray<float>> rays = rays_of(origins, directions, t_min, t_max);
        AnswersOf<RayHit> found = without_gil([&] { return bvh_->all_hits(rays); });
        return py::make_tuple(array_of<std::uint64_t>(std::move(found.offsets)),
                              hits_of(std::move(found.of)));
    }

    py::object closest_points(const py::object& points) const {
        const Rows<float> given = finite(points);
        std::vector<SurfacePoint> found =
            without_gil([&] { return bvh_->closest_points(given.as<Vec3<float>>()); });
        std::vector<double> distances(found.size());
        std::ranges::transform(found, distances.begin(), [](const SurfacePoint& nearest) {
            return std::sqrt(nearest.squared_distance);
        });
        const Owned<SurfacePoint> held(std::move(found));
        return named_tuple("ClosestPoints")(
            held.column<float>(offsetof(SurfacePoint, point), 3),
            held.column<std::int32_t>(offsetof(SurfacePoint, triangle)),
            array_of<double>(std::move(distances)));
    }
    py::object contains(const py::object& points) const {
        const Rows<float> given = finite(points);
        const std::vector<Side> found =
            without_gil([&] { return bvh_->sides(given.as<Vec3<float>>()); });
        py::array_t<bool> inside(static_cast<py::ssize_t>(found.size()));
        std::ranges::transform(found, inside.mutable_data(),
                               [](Side side) { return side != Side::outside; });
        return inside;
    }
    py::object signed_distance(const py::object& points) const {
        const Rows<float> given = finite(points);
        return array_of<double>(
            without_gil([&] { return bvh_->signed_distances(given.as<Vec3<float>>()); }));
    }

  private:
    /// Of vertices that no triangle has it does not matter what they are.
    static void require_corners(std::span<const Vec3<float>> vertices, const TriangleMesh& mesh) {
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
            for (const std::uint32_t corner : mesh.triangles[i])
                for (int axis = 0; axis < 3; ++axis)
                    if (!(std::abs(vertices[corner][axis]) < max_ray_coordinate))
                        throw py::value_error("vertices: row " + std::to_string(corner) +
                                              ", of face " + std::to_string(i) +
                                              ", has a NaN, or a number of 2^126 or more");
    }
    static RayKernelName kernel_named(const std::string& name) {
        const std::span<const KernelInfo> kernels = ray_kernels();
        return static_cast<RayKernelName>(&entry_named(name, kernels, "kernel") - kernels.data());
    }
    static Rows<float> finite(const py::object& points) {
        Rows<float> given(points, "points", {3});
        given.require_finite();
        return given;
    }

    std::optional<MeshBvh> bvh_;
};

} // namespace

void add_meshes(py::module_& to) {
    const char* const rays = R"(
origins, directions: shape (n, 3); directions need no unit length, t counts in
    lengths of them.
t_min, t_max: one number, or one for each ray.

Raises ValueError for shapes that do not fit, a NaN or infinity, a direction
of zero.)";
    const auto doc = [rays](const char* what) { return std::string(what) + rays; };
    using py::arg;
    const auto from = arg("t_min") = 0.0;
    const auto up_to = arg("t_max") = std::numeric_limits<double>::infinity();
    py::class_<PyMeshBvh> made(
        to, "MeshBvh",
        R"(A tree of the triangles of a mesh: for rays, nearest points, inside and outside.

Vertices are held in float32: others are rounded to nearest. Rays with the
default kernel are watertight: none slips between triangles with a common edge.

Any number of threads may query one tree at the same time (the GIL is
released); who calls update() is alone with it meanwhile.)");
    refuse_copies(made);
    made.def(py::init<const py::object&, const py::object&, const std::string&, const std::string&,
                      const std::string&, std::int64_t>(),
             arg("vertices"), arg("faces"), py::kw_only(), arg("builder") = "binned_sah",
             arg("layout") = "wide8", arg("kernel") = "watertight", arg("threads") = 1, R"(
vertices: shape (n, 3). faces: shape (m, 3), integers, each row the vertices of
    a triangle.
builder, layout: names of boxwood.builders() and boxwood.layouts().
kernel: how a ray meets a triangle; a misspelt one is answered by their names.
threads: how many a query of many, or a build, may use.

Raises ValueError for a wrong shape, a face with a vertex that is not there, a
vertex with a NaN or a number of 2^126 or more, and for an unknown name.)")
        .def("__len__", [](const PyMeshBvh& mesh) { return mesh.bvh().size(); })
        .def("__repr__",
             [](const PyMeshBvh& mesh) {
                 return "<boxwood.MeshBvh of " + std::to_string(mesh.bvh().size()) + " triangles>";
             })
        .def_property_readonly(
            "nbytes", [](const PyMeshBvh& mesh) { return mesh.bvh().bytes(); },
            "Bytes of memory that mesh and tree take.")
        .def_property_readonly(
            "threads", [](const PyMeshBvh& mesh) { return mesh.bvh().options().threads; },
            "How many a query of many, or a build, may use.")
        .def_property_readonly(
            "open_edges", [](const PyMeshBvh& mesh) { return mesh.bvh().open_edges(); },
            "How many edges have an odd number of triangles, vertices at one place taken for one.")
        .def_property_readonly(
            "is_closed", [](const PyMeshBvh& mesh) { return mesh.bvh().open_edges() == 0; },
            "Whether open_edges is 0: contains() and signed_distance() need it.")
        .def("update", &PyMeshBvh::update, arg("vertices"),
             "The vertices moved: as many as there were. The tree is built again.")
        .def("closest_hits", &PyMeshBvh::closest_hits, arg("origins"), arg("directions"), from,
             up_to,
             doc(R"(Where each ray first meets the mesh.

Returns Hits(t, triangle, u, v), each of shape (n,): the hit is at
origin + t * direction = (1 - u - v) a + u b + v c of the triangle a, b, c.
A miss has triangle -1 and an infinite t.
)")
                 .c_str())
        .def("any_hits", &PyMeshBvh::any_hits, arg("origins"), arg("directions"), from, up_to,
             doc("Whether each ray meets the mesh: shape (n,), bool.\n").c_str())
        .def("all_hits", &PyMeshBvh::all_hits, arg("origins"), arg("directions"), from, up_to,
             doc(R"(Every hit of each ray, by t and then by triangle.

Returns (offsets, Hits): those of ray i are [offsets[i]:offsets[i + 1]] of
each array of the Hits.
)")
                 .c_str())
        .def("closest_points", &PyMeshBvh::closest_points, arg("points"),
             R"(The point of the mesh that is nearest to each of the points, shape (n, 3).

Returns ClosestPoints(points, triangle, distance) of shape (n, 3), (n,), (n,);
triangle is -1 if the mesh is empty; of triangles at the same distance, as it
is computed, the lowest.)")
        .def("contains", &PyMeshBvh::contains, arg("points"),
             R"(Whether each of the points, shape (n, 3), is inside the closed mesh or on it:
shape (n,), bool. Exact for the float32 coordinates, also in line with edges
and vertices. Even-odd rule: where two parts overlap is outside.

Raises ValueError for a mesh that is not closed.)")
        .def("signed_distance", &PyMeshBvh::signed_distance, arg("points"),
             R"(How far the mesh is from each of the points, shape (n, 3); negative inside,
0 on the surface alone: shape (n,), float64. Signs as contains().)");
}

} // namespace boxwood::python
