#pragma once

#include "trees/tree.h"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// "(0, 0, 0) to (1, 1, 1)", so that no two boxes look alike.
template <class T> std::string box_text(const Aabb<T>& box) {
    return fmt::format("({}, {}, {}) to ({}, {}, {})", box.min.x, box.min.y, box.min.z, box.max.x,
                       box.max.y, box.max.z);
}

/// Boxes, seen along z, on one scale: an SVG with real text.
class Drawing {
  public:
    explicit Drawing(std::string title) : title_(std::move(title)) {}
    /// kind: node, first, second, item-a or item-b.
    void box(const Box& box, std::string_view kind, std::string label = {});
    /// From p to q.
    void line(Vec3<float> p, Vec3<float> q);
    std::string svg() const;

  private:
    struct Drawn {
        Box box;
        std::string_view kind;
        std::string label;
    };
    std::string title_;
    Box all_;
    std::vector<Drawn> boxes_;
    std::vector<std::pair<Vec3<float>, Vec3<float>>> lines_;
};

} // namespace boxwood::bench
