#include "trees/world/mesh_contacts.h"

#include "kernels/triangle_distance/certified.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace boxwood {
namespace {

using Corners = std::array<Vec3<double>, 3>;

Corners corners_of(const Triangle<double>& t) { return {t.a, t.b, t.c}; }

/// Of length 1, or nothing of a triangle without area.
std::optional<Vec3<double>> unit_normal(const Corners& t) {
    const Vec3<double> e = t[1] - t[0], f = t[2] - t[0];
    // At a size near 1, so that squares neither overflow nor vanish.
    const auto greatest = [](const Vec3<double>& v) {
        return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    };
    const double size_e = greatest(e), size_f = greatest(f);
    if (!(size_e > 0 && size_f > 0))
        return std::nullopt;
    const Vec3<double> n = cross((1 / size_e) * e, (1 / size_f) * f);
    const double size = length(n);
    if (!(size > 0))
        return std::nullopt;
    return (1 / size) * n;
}

struct Extent {
    double least, greatest;
};
Extent extent_along(const Vec3<double>& n, const Corners& t) {
    const double x = dot(n, t[0]), y = dot(n, t[1]), z = dot(n, t[2]);
    return {std::min({x, y, z}), std::max({x, y, z})};
}

/// The part of a triangle in another one's plane, by places along a line: its edges' points there.
/// Nothing if the plane does not part its corners.
struct Part {
    Vec3<double> from, to;
};
std::optional<Part> part_in_plane(const Corners& t, const Vec3<double>& n, double offset) {
    std::array<double, 3> h{};
    for (std::size_t k = 0; k < 3; ++k)
        h[k] = dot(n, t[k]) - offset;
    std::array<Vec3<double>, 2> found;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3 && count < 2; ++k) {
        const std::size_t next = (k + 1) % 3;
        if (h[k] == 0)
            found[count++] = t[k];
        else if (h[k] * h[next] < 0)
            found[count++] = t[k] + (h[k] / (h[k] - h[next])) * (t[next] - t[k]);
    }
    if (count == 0)
        return std::nullopt;
    return Part{found[0], found[count - 1]};
}

/// The middle of what two triangles share on the line of their planes, if that is to be had.
std::optional<Vec3<double>> middle_of_crossing(const Corners& a, const Vec3<double>& normal_a,
                                               const Corners& b, const Vec3<double>& normal_b) {
    const Vec3<double> line = cross(normal_a, normal_b);
    if (!(length(line) > 1e-9))
        return std::nullopt;
    const auto in_b = part_in_plane(a, normal_b, dot(normal_b, b[0]));
    const auto in_a = part_in_plane(b, normal_a, dot(normal_a, a[0]));
    if (!in_b || !in_a)
        return std::nullopt;
    std::array<Vec3<double>, 4> ends{in_b->from, in_b->to, in_a->from, in_a->to};
    const auto along = [&](const Vec3<double>& p) { return dot(line, p); };
    const auto sort_ends = [&](std::size_t i) {
        if (along(ends[i]) > along(ends[i + 1]))
            std::swap(ends[i], ends[i + 1]);
    };
    sort_ends(0);
    sort_ends(2);
    const Vec3<double>& low = along(ends[0]) > along(ends[2]) ? ends[0] : ends[2];
    const Vec3<double>& high = along(ends[1]) < along(ends[3]) ? ends[1] : ends[3];
    return 0.5 * (low + high);
}

/// Those that span the most, one after the other: the deepest, the farthest from it, the farthest
/// from all that are chosen.
std::vector<Contact> spread(const std::vector<Contact>& all, std::size_t count) {
    std::vector<Contact> chosen{all.front()};
    std::vector<double> nearest(all.size(), std::numeric_limits<double>::infinity());
    while (chosen.size() < count) {
        std::size_t farthest = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            nearest[i] = std::min(nearest[i], length(all[i].point - chosen.back().point));
            if (nearest[i] > nearest[farthest])
                farthest = i;
        }
        if (!(nearest[farthest] > 0))
            break; // all are at one place
        chosen.push_back(all[farthest]);
    }
    return chosen;
}

/// Of two that touch, or are apart. Where they are so near that rounding turns the way between
/// their nearest points, the normal is that of two that touch.
Contact near_contact(const Triangle<double>& a, const Triangle<double>& b) {
    const Distance d = CertifiedDistance::distance(a, b);
    if (d.lo == 0)
        return contact_of(a, b);
    const Vec3<double> apart = d.point_b - d.point_a;
    const double size = length(apart);
    if (!(size > 0x1p-40 * (length(d.point_a) + length(d.point_b)))) {
        Contact contact = contact_of(a, b);
        contact.depth = -d.distance;
        return contact;
    }
    return {0.5 * (d.point_a + d.point_b), (1 / size) * apart, -d.distance, {}};
}

bool deeper(const Contact& x, const Contact& y) {
    return std::tuple(-x.depth, x.triangles) < std::tuple(-y.depth, y.triangles);
}

} // namespace

void check(const ContactOptions& options) {
    if (!(options.margin >= 0 && options.margin < 0x1p100))
        throw std::invalid_argument("a margin must be at least 0, and below 2^100");
}

Contact contact_of(const Triangle<double>& a, const Triangle<double>& b) {
    const Corners corners_a = corners_of(a), corners_b = corners_of(b);
    const auto normal_a = unit_normal(corners_a), normal_b = unit_normal(corners_b);
    Contact contact;
    contact.depth = std::numeric_limits<double>::infinity();
    contact.normal = {0, 0, 1};
    for (const auto& normal : {normal_a, normal_b})
        if (normal) {
            const Extent of_a = extent_along(*normal, corners_a);
            const Extent of_b = extent_along(*normal, corners_b);
            const double forwards = of_a.greatest - of_b.least;
            const double backwards = of_b.greatest - of_a.least;
            if (std::min(forwards, backwards) < contact.depth) {
                contact.depth = std::min(forwards, backwards);
                // Both alike where they lie in one plane: then away from A's middle.
                const Vec3<double> apart = (b.a + b.b + b.c) - (a.a + a.b + a.c);
                const bool is_forwards =
                    forwards < backwards || (forwards == backwards && dot(*normal, apart) >= 0);
                contact.normal = is_forwards ? *normal : -*normal;
            }
        }
    // Segments and points only touch; and what touches may be rounded apart.
    contact.depth = std::isfinite(contact.depth) ? std::max(contact.depth, 0.0) : 0;
    std::optional<Vec3<double>> point;
    if (normal_a && normal_b)
        point = middle_of_crossing(corners_a, *normal_a, corners_b, *normal_b);
    if (!point) {
        const Distance touch = CertifiedDistance::distance(a, b);
        point = 0.5 * (touch.point_a + touch.point_b);
    }
    contact.point = *point;
    return contact;
}

std::vector<Contact> contacts(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                              const ContactOptions& options, Work* work) {
    check(options);
    std::vector<Contact> found;
    const bool is_near = options.margin > 0;
    const std::vector<Pair> pairs =
        is_near ? near_triangles(a, b, b_in_a, options.margin, options.max_pairs, work)
                : touching_triangles(a, b, b_in_a, options.max_pairs, work);
    for (const Pair pair : pairs) {
        const Triangle<double> of_a = a.triangle(pair.a, Pose{}), of_b = b.triangle(pair.b, b_in_a);
        found.push_back(is_near ? near_contact(of_a, of_b) : contact_of(of_a, of_b));
        found.back().triangles = pair;
    }
    return deepest_first(std::move(found), options);
}

std::vector<Contact> deepest_first(std::vector<Contact> contacts, const ContactOptions& options) {
    std::ranges::sort(contacts, deeper);
    if (options.max_contacts == 0)
        return {};
    if (contacts.size() > options.max_contacts) {
        contacts = spread(contacts, options.max_contacts);
        std::ranges::sort(contacts, deeper);
    }
    return contacts;
}

} // namespace boxwood
