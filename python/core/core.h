#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace boxwood::python {

void add_boxes(pybind11::module_& to);
void add_mesh_pairs(pybind11::module_& to);
void add_meshes(pybind11::module_& to);
void add_triangles(pybind11::module_& to);
void add_worlds(pybind11::module_& to); ///< after add_mesh_pairs

/// copy and pickle say what to do instead.
template <class Class> void refuse_copies(Class& of) {
    of.def("__reduce__", [](const pybind11::object& self) -> pybind11::object {
        throw pybind11::type_error(
            std::string(pybind11::str(pybind11::type::of(self).attr("__name__"))) +
            " is neither copied nor pickled: keep the arrays, and make another of them");
    });
}

} // namespace boxwood::python
