#pragma once

#include <pybind11/pybind11.h>

namespace boxwood::python {

void add_boxes(pybind11::module_& to);
void add_mesh_pairs(pybind11::module_& to);
void add_meshes(pybind11::module_& to);
void add_triangles(pybind11::module_& to);
void add_worlds(pybind11::module_& to); ///< after add_mesh_pairs

} // namespace boxwood::python
