#pragma once

#include "arrays.h"

#include "trees/world/bodies/body_shape.h"

namespace boxwood::python {

/// Of a boxwood.Shape or a boxwood.Mesh, the argument of this name.
BodyShape body_shape_of(const py::object& given, const std::string& name = "shape");

void add_shapes(py::module_& to);

} // namespace boxwood::python
