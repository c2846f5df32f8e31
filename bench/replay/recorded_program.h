#pragma once

#include "kernels/primitives/vec3.h"
#include "trees/adapters/recording.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace boxwood::bench {

/// The calls of a program to its manager, as FclRecorder wrote it (trees/adapters/recording.h).
struct RecordedProgram {
    /// An object as it is from a call on.
    struct State {
        std::uint32_t object = 0;
        std::array<double, 6> bounds{}; ///< min, max
        std::array<double, 12> pose{};  ///< a rotation by rows, a translation
    };
    struct Call {
        recording::Call what{};
        std::size_t first_object = 0, n_objects = 0; ///< of call_objects
        std::size_t first_state = 0, n_states = 0;
        std::uint64_t shown = 0, keys = 0;
        bool ended = false; ///< by the program's callback
        double min_distance = 0, ns = 0;
    };
    struct Geometry {
        recording::Shape shape{};
        std::array<double, 4> numbers{};
        std::size_t first_vertex = 0, n_vertices = 0, first_triangle = 0, n_triangles = 0;
        std::uint64_t hash = 0;
    };

    /// How often a call's callbacks made a request about shapes, and how long these took.
    struct RequestCount {
        std::size_t call = 0, request = 0;
        double n = 0, ns = 0;
    };

    /// A query of two shapes that may touch: a yes or no, or contacts.
    struct Touch {
        std::size_t max_contacts = 1;
        bool contacts = false;
    };

    unsigned bits = 64; ///< of the program's numbers
    std::vector<Call> calls;
    std::vector<State> states;
    std::vector<std::uint32_t> call_objects;
    std::vector<std::uint32_t> geometry_of; ///< by object
    std::vector<Geometry> geometries;
    std::vector<Vec3<double>> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles; ///< vertices of their geometry
    std::vector<recording::Request> requests;
    std::vector<RequestCount> request_counts;
    Touch touch{}; ///< the most frequent; a yes or no where that is not known

    std::size_t n_objects() const { return geometry_of.size(); }
    std::span<const State> states_of(const Call& call) const {
        return std::span(states).subspan(call.first_state, call.n_states);
    }
    std::span<const std::uint32_t> objects_of(const Call& call) const {
        return std::span(call_objects).subspan(call.first_object, call.n_objects);
    }
    std::span<const Vec3<double>> vertices_of(const Geometry& of) const {
        return std::span(vertices).subspan(of.first_vertex, of.n_vertices);
    }
    std::span<const std::array<std::uint32_t, 3>> triangles_of(const Geometry& of) const {
        return std::span(triangles).subspan(of.first_triangle, of.n_triangles);
    }
    /// Whether every shape is known, and not by its bounds alone.
    bool knows_shapes() const {
        return std::ranges::none_of(
            geometries, [](const Geometry& of) { return of.shape == recording::Shape::other; });
    }
    /// Whether all are finite and within 1e18. Trees of FCL and Coal crash on bounds that are not,
    /// as those of a half-space, and their narrow phases on poses.
    bool has_near_bounds() const;
    bool has_near_poses() const;
};

inline bool is_query(recording::Call call) { return call >= recording::Call::collide_self; }
/// A query of one object, or its removal; without one, as of a null pointer, nothing is done.
inline bool is_of_one(recording::Call call) {
    return call == recording::Call::remove || call == recording::Call::collide_object ||
           call == recording::Call::distance_object;
}
inline bool is_with_others(recording::Call call) {
    return call == recording::Call::collide_others || call == recording::Call::distance_others;
}
inline bool is_distance(recording::Call call) { return call >= recording::Call::distance_self; }

/// Of `requests` and `request_counts`.
RecordedProgram::Touch most_frequent_touch(const RecordedProgram& program);

/// Throws std::runtime_error, "FILE: cause and what to do", for what is no recording, or a damaged
/// one.
RecordedProgram read_program(const std::filesystem::path& file);

} // namespace boxwood::bench
