#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/exact_vector.h"

#include <vector>

namespace boxwood::oracle {

// The boxes share a point iff the vector between their centres is a sum of s_i g_i, |s_i| <= 1,
// over the six half edges g_i of both: iff it lies between each pair of opposite faces of that
// solid, |n.c| <= sum |n.g_i|, where n is normal to two of the g_i. If the solid is flat, all these
// n are normal to its plane, and its edges in the plane count as well; if it is a segment or point,
// the line itself.
bool boxes_touch(const std::array<Vec3<double>, 4>& a, Vec3<double> half_a,
                 const std::array<Vec3<double>, 4>& b, Vec3<double> half_b) {
    const Unit unit(a[0], a[1], a[2], a[3], half_a, b[0], b[1], b[2], b[3], half_b, 1.0);
    const Integer one = unit(1.0); // half edges are products of two numbers in these units
    const Point between = one * (unit(b[0]) - unit(a[0]));
    std::vector<Point> edges;
    for (int k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(k + 1);
        edges.push_back(unit(half_a[k]) * unit(a[i]));
        edges.push_back(unit(half_b[k]) * unit(b[i]));
    }
    std::erase_if(edges, is_zero);

    const auto apart_along = [&](const Point& n) {
        Integer reach = 0;
        for (const Point& edge : edges)
            reach += abs(dot(n, edge));
        return abs(dot(n, between)) > reach;
    };
    Point plane{}; // normal of some two half edges
    for (std::size_t i = 0; i < edges.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const Point n = cross(edges[i], edges[j]);
            if (is_zero(n))
                continue;
            if (apart_along(n))
                return false;
            plane = n;
        }
    const bool is_flat = !is_zero(plane);
    for (const Point& edge : edges) {
        if (is_flat ? apart_along(cross(plane, edge))
                    : !is_zero(cross(between, edge)) || apart_along(edge))
            return false;
    }
    return !edges.empty() || is_zero(between);
}

RationalBox image(const RigidTransform<double>& transform, const Aabb<double>& box) {
    RationalBox out;
    for (int i = 0; i < 3; ++i) {
        const auto row = static_cast<std::size_t>(i);
        mpq_class low = exact(transform.translation[i]), high = low;
        for (int j = 0; j < 3; ++j) {
            const mpq_class r = exact(transform.rotation[row][j]), x = r * exact(box.min[j]),
                            y = r * exact(box.max[j]);
            low += x < y ? x : y;
            high += x < y ? y : x;
        }
        out.min[row] = low;
        out.max[row] = high;
    }
    return out;
}

} // namespace boxwood::oracle
