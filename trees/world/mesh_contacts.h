#pragma once

#include "trees/world/mesh_pairs.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace boxwood {

/// Where a triangle of A and one of B that touch meet. Of the two normals and their opposites, the
/// one along which B has to move least to leave A: it moves by depth * normal, and then the two
/// touch at most. Neither winding nor the order of corners counts. 0 deep where they only touch.
/// Of two that are apart, where a margin is wanted, midway between their nearest points; the normal
/// is from A's to B's, and the depth minus their distance.
struct Contact {
    Vec3<double> point;  ///< of both, rounded, in A's frame
    Vec3<double> normal; ///< of length 1, in A's frame
    double depth = 0;    ///< scene units, of these two triangles alone
    Pair triangles{};    ///< of A, of B
};

struct ContactOptions {
    /// Of more touching pairs of triangles only these many, the first that are found, are looked
    /// at.
    std::size_t max_pairs = std::numeric_limits<std::size_t>::max();
    /// Of more contacts the deepest, and then those that span the most: for a solver, 4.
    std::size_t max_contacts = std::numeric_limits<std::size_t>::max();
    /// Triangles that are apart, but not more than this, are contacts, too. At least 0, and below
    /// 2^100; else contacts() throws std::invalid_argument.
    double margin = 0;
};
void check(const ContactOptions& options);

/// The contacts of two surfaces, one of each pair of triangles that share a point or are within the
/// margin, the deepest first and then by triangles. B stands at `b_in_a`, as in mesh_pairs.h.
std::vector<Contact> contacts(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                              const ContactOptions& options = {}, Work* work = nullptr);

/// Of one pair of triangles that touch.
Contact contact_of(const Triangle<double>& a, const Triangle<double>& b);

/// The deepest first and then by triangles, max_contacts of them at most.
std::vector<Contact> deepest_first(std::vector<Contact> contacts, const ContactOptions& options);

} // namespace boxwood
