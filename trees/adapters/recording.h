#pragma once

/// What FclRecorder writes and `boxwood replay` reads: HDF5 tables, each a group with a column of
/// doubles for each name. Needs neither FCL nor HDF5.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace boxwood::recording {

inline constexpr std::uint32_t version = 2; ///< of the tables; /format/version. 1: without requests

enum class Call : std::uint8_t {
    add,    ///< objects are registered
    remove, ///< an object is
    clear,
    setup,
    update_all,
    update_some,
    collide_self,
    collide_object,
    collide_others, ///< with the objects of another manager
    distance_self,
    distance_object,
    distance_others
};
inline constexpr std::array<std::string_view, 12> call_names = {"register",
                                                                "unregister",
                                                                "clear",
                                                                "setup",
                                                                "update all",
                                                                "update some",
                                                                "collide self",
                                                                "collide object",
                                                                "collide others",
                                                                "distance of pairs",
                                                                "distance of object",
                                                                "distance to others"};

enum class Shape : std::uint8_t {
    other, ///< known by its bounds alone
    mesh,
    box,
    sphere,
    ellipsoid,
    capsule,
    cone,
    cylinder,
    convex, ///< its vertices; its faces as triangles
    plane,
    half_space
};
inline constexpr std::array<std::string_view, 11> shape_names = {
    "other", "mesh",     "box",    "sphere", "ellipsoid", "capsule",
    "cone",  "cylinder", "convex", "plane",  "half-space"};

/// A row for each call, in their order. `n_objects` rows of call_objects and `n_states` rows of
/// states belong to it and follow those of the calls before. Of queries: what callbacks were shown
/// (how many pairs of two objects, the sum of their keys), whether one ended the query (or it was
/// of a registered object that had moved since its update), and of distances what was the least at
/// the end, else infinity. One whose callback threw, or that was not done when the recording ended,
/// counts as ended. `ns`: nanoseconds, callbacks and the recorder's count in it.
inline constexpr std::array<std::string_view, 8> calls = {
    "call", "n_objects", "n_states", "shown", "keys", "ended", "min_distance", "ns"};
inline constexpr std::array<std::string_view, 1> call_objects = {"object"};
/// An object's bounds, and its pose (a rotation by rows, a translation), when they changed: of one
/// that is registered, by its registration or update.
inline constexpr std::array<std::string_view, 19> states = {
    "object", "min_x", "min_y", "min_z", "max_x", "max_y", "max_z", "xx", "xy", "xz",
    "yx",     "yy",    "yz",    "zx",    "zy",    "zz",    "x",     "y",  "z"};
/// By object.
inline constexpr std::array<std::string_view, 1> objects = {"geometry"};
/// By geometry: a Shape, its numbers (of a box its sides; of an ellipsoid its radii; of a sphere
/// its radius, of a capsule, cone and cylinder also its length; of a plane and a half-space normal
/// and offset), how many rows of vertices and triangles are its own, and a hash of all this.
inline constexpr std::array<std::string_view, 9> geometries = {
    "shape", "a", "b", "c", "d", "n_vertices", "n_triangles", "hash_high", "hash_low"};
inline constexpr std::array<std::string_view, 3> vertices = {"x", "y", "z"};
inline constexpr std::array<std::string_view, 3> triangles = {"a", "b", "c"};
/// Queries of callbacks about the shapes of pairs: whether they touch (0) or how far apart they are
/// (1), at most so many contacts, whether with contacts, nearest points and distances below 0.
inline constexpr std::array<std::string_view, 5> requests = {"question", "max_contacts", "contacts",
                                                             "points", "signed"};
using Request = std::array<double, requests.size()>; ///< a row
/// How often a call's callbacks made one, and how long these took, ns.
inline constexpr std::array<std::string_view, 4> request_counts = {"call", "request", "n", "ns"};
/// One row: version, and the bits of the program's numbers (32 or 64).
inline constexpr std::array<std::string_view, 2> format = {"version", "bits"};

/// Of a pair of objects in either order. Sums of keys, modulo 2^52, tell sets of pairs apart.
inline std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    std::uint64_t mixed = (std::uint64_t{std::min(a, b)} << 32 | std::max(a, b)) + 1;
    for (const std::uint64_t factor : {0xbf58476d1ce4e5b9u, 0x94d049bb133111ebu}) {
        mixed = (mixed ^ mixed >> 30) * factor;
        mixed ^= mixed >> 27;
    }
    return mixed >> 12;
}
inline std::uint64_t sum(std::uint64_t keys, std::uint64_t key) {
    return (keys + key) & ((std::uint64_t{1} << 52) - 1);
}

} // namespace boxwood::recording
