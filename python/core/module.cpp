#include "core.h"

#include "arrays.h"

#include "trees/builder.h"
#include "trees/layout.h"

#include <boxwood/version.h>

namespace boxwood::python {

py::object named_tuple(const char* name) {
    return py::module_::import("boxwood._answers").attr(name);
}

std::vector<std::uint32_t> indices_of(const py::handle& given, const std::string& name,
                                      std::size_t limit, py::ssize_t columns) {
    const py::array array = numbers_of(given, name);
    if (array.dtype().kind() != 'i' && array.dtype().kind() != 'u' && array.size() > 0)
        throw py::type_error(name + ": integers are wanted, not " +
                             std::string(py::str(array.dtype())));
    const auto numbers = [&](const Rows<std::int64_t>& rows) {
        std::vector<std::uint32_t> indices;
        for (const std::int64_t i : rows.numbers()) {
            if (i < 0 || static_cast<std::uint64_t>(i) >= limit)
                throw py::value_error(
                    name + ": row " +
                    std::to_string(indices.size() /
                                   static_cast<std::size_t>(columns ? columns : 1)) +
                    " names " + std::to_string(i) + ", but there are " + std::to_string(limit));
            indices.push_back(static_cast<std::uint32_t>(i));
        }
        return indices;
    };
    return columns ? numbers({array, name, {columns}}) : numbers({array, name, {}});
}

/// pybind11 before 2.12 takes numpy 2 for numpy 1, and gives wrong answers.
void require_known_numpy() {
    const std::string numpy(py::str(py::module_::import("numpy").attr("__version__")));
    if (PYBIND11_VERSION_HEX < 0x020C0000 && !numpy.starts_with("1."))
        throw py::import_error(
            "boxwood was built with a pybind11 older than 2.12, which does not know numpy " +
            numpy + ": build it by `pip install .`, which takes a newer one, or use numpy 1");
}

TriangleMesh mesh_of(const py::handle& vertices, const py::handle& faces) {
    const Rows<float> points(vertices, "vertices", {3});
    const auto corners = points.as<Vec3<float>>();
    TriangleMesh mesh{{corners.begin(), corners.end()}, {}};
    const std::vector<std::uint32_t> indices = indices_of(faces, "faces", points.size(), 3);
    for (std::size_t i = 0; i < indices.size(); i += 3)
        mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    return mesh;
}

} // namespace boxwood::python

PYBIND11_MODULE(_core, module) {
    using namespace boxwood::python;
    require_known_numpy();
    module.doc() = "What boxwood/__init__.py offers, in C++.";
    module.attr("__version__") = BOXWOOD_VERSION;
    module.attr("_pybind11_version") =
        py::make_tuple(PYBIND11_VERSION_HEX >> 24, PYBIND11_VERSION_HEX >> 16 & 0xff);
    module.def(
        "_inside_ns", [] { return inside_ns.load(); },
        "Nanoseconds that the library took of all calls so far.");
    const auto names = [&module](const char* name, auto entries, const char* of) {
        module.def(
            name,
            [entries] {
                py::dict all;
                for (const auto& entry : entries())
                    all[py::str(std::string(entry.name))] = std::string(entry.summary);
                return all;
            },
            of);
    };
    names("builders", boxwood::builders, "The builders of trees: {name: what it does}.");
    names("layouts", boxwood::layouts, "How trees lie in memory: {name: how}.");
    add_boxes(module);
    add_meshes(module);
    add_mesh_pairs(module);
    add_triangles(module);
    add_worlds(module);
}
