#pragma once

#include "arrays.h"

#include "trees/world/bodies/body_shape.h"

namespace boxwood::python {

/// Of a boxwood.Shape or a boxwood.Mesh.
BodyShape body_shape_of(const py::object& given);

void add_shapes(py::module_& to);

} // namespace boxwood::python
