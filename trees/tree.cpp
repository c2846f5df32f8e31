#include "trees/tree.h"

#include <cmath>

namespace boxwood {

void require_valid(const Box& box, std::size_t index) {
    // x - x is 0 for finite x and NaN otherwise: one sum finds any bad coordinate.
    const Vec3<float> d = (box.min - box.min) + (box.max - box.max);
    if (d.x + d.y + d.z == 0 && !box.is_empty())
        return;
    for (const Vec3<float>& p : {box.min, box.max})
        for (int axis = 0; axis < 3; ++axis) {
            if (std::isnan(p[axis]))
                throw InvalidBox(index, std::string("NaN in ") + "xyz"[axis]);
            if (std::isinf(p[axis]))
                throw InvalidBox(index, std::string("infinite in ") + "xyz"[axis]);
        }
    throw InvalidBox(index, "min is greater than max");
}

void require_at_most_max_items(std::size_t n_boxes) {
    if (n_boxes > max_items)
        throw std::length_error("a tree holds at most " + std::to_string(max_items) +
                                " boxes, not " + std::to_string(n_boxes));
}

void require_valid(Boxes boxes) {
    require_at_most_max_items(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        require_valid(boxes[i], i);
}

} // namespace boxwood
