#pragma once

#include "kernels/continuous/continuous_kernel.h"
#include "kernels/convex/shapes.h"
#include "kernels/primitives/aabb.h"
#include "kernels/primitives/obb.h"
#include "kernels/primitives/ray.h"
#include "kernels/primitives/rigid_transform.h"
#include "kernels/primitives/triangle.h"
#include "scenes/hard_cases/shape_lengths.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace boxwood {

/// What is known of a case by its construction. `unknown`: an exact oracle decides.
enum class Known : std::uint8_t { no, yes, unknown };

/// Two triangles. Kernels of smaller things take what they need of them: segments a.a a.b and
/// b.a b.b, the point a.a, the triangle b.
struct TrianglePairCase {
    Triangle<double> a, b;
    Known touch = Known::unknown;
};

/// A ray and the triangles [first, first + count) of `RayCases::triangles`: one, or a closed fan or
/// mesh, which the next rays may share. `hit`: whether it must hit at least one of them.
struct RayCase {
    Ray<float> ray;
    std::uint32_t first = 0, count = 1;
    Known hit = Known::unknown;

    bool is_closed() const { return count > 1; }
};
struct RayCases {
    std::vector<Triangle<float>> triangles;
    std::vector<RayCase> rays;
};

struct RayBoxCase {
    Ray<float> ray;
    Aabb<float> box;
    Known hit = Known::unknown;
};

enum class MotionKind : std::uint8_t { vertex_face, edge_edge };
struct MotionCase {
    LinearMotion motion;
    Known touch = Known::unknown;
};
struct MotionCases {
    MotionKind kind = MotionKind::vertex_face;
    std::vector<MotionCase> motions;
};

struct ObbPairCase {
    Obb<double> a, b;
    Known touch = Known::unknown;
};

/// A convex polyhedron by its corners and its faces, which turn counter-clockwise seen from
/// outside.
struct Polyhedron {
    std::vector<Vec3<double>> points;
    std::vector<std::array<std::uint32_t, 3>> faces;
};
/// One of a pair of convex shapes, where it is put. A hull has the points of `polyhedron`.
struct ShapeOfPair {
    convex::Shape shape;
    convex::Pose pose;
    std::shared_ptr<const Polyhedron> polyhedron{};
};
/// Two convex shapes. Their distance, below 0 the depth of one in the other (as
/// convex::SignedDistance says it), is in [lo, hi] by construction; 0 is not. Where they are apart
/// that is as narrow as rounding, of depths it is between bounds.
struct ShapePairCase {
    ShapeOfPair a, b;
    double lo = 0, hi = 0;
};

/// A box and a transform after which it is fitted again.
struct FitCase {
    RigidTransform<double> transform;
    Aabb<double> box;
};

/// Boxes whose number of overlapping pairs is known.
struct BoxCases {
    std::vector<Aabb<float>> boxes;
    std::uint64_t n_pairs = 0;
};

/// The cases of one family. Their type says which kernels they are for.
using Cases = std::variant<std::monostate, std::vector<TrianglePairCase>, RayCases,
                           std::vector<RayBoxCase>, MotionCases, std::vector<ObbPairCase>,
                           std::vector<ShapePairCase>, std::vector<FitCase>, BoxCases>;

std::size_t n_cases(const Cases& cases); ///< pairs, rays, motions, fits or boxes

/// How ordinary the input is: the panels of the accuracy figures.
enum class Panel : std::uint8_t { generic, touching, degenerate };
inline constexpr Panel all_panels[] = {Panel::generic, Panel::touching, Panel::degenerate};
std::string_view to_string(Panel panel);

/// What a family makes. The same spec gives the same bits on every machine.
struct HardCaseSpec {
    std::size_t n = 1000;       ///< wanted number of cases
    std::uint64_t seed = 1;     ///< key of the counter-based random numbers
    std::optional<int> k;       ///< the family's own parameter; its default if not given
    int scale = 0;              ///< every coordinate is multiplied by 2^scale, exactly
    std::filesystem::path file; ///< for families that read their cases from a file or folder
};

class Random;

/// A family of hard cases: `boxwood list families`. A name of BOXWOOD_FAMILIES in hard_cases.cpp
/// and a function that makes this row.
struct HardCaseFamily {
    std::string_view name;    ///< registry name
    std::string_view summary; ///< one line
    Panel panel = Panel::generic;
    std::string_view k_meaning{};            ///< what k is; empty if there is none
    std::string (*k_words)(int k) = nullptr; ///< a k for readers, where "k = 5" would say little
    int k_default = 0, k_min = 0, k_max = 0;
    int scale_min = 0, scale_max = 0; ///< where every coordinate stays exact
    bool reads_file = false;
    /// Called by `make_cases`, with k given and the random numbers of (seed, name).
    Cases (*generate)(const HardCaseSpec& spec, const Random& random) = nullptr;
};

std::span<const HardCaseFamily> hard_case_families();
/// The family by its registry name, or nullptr.
const HardCaseFamily* find_hard_case_family(std::string_view name);

/// Throws std::invalid_argument naming family, parameter and range for a bad spec.
void check_hard_case_spec(const HardCaseFamily& family, const HardCaseSpec& spec);

/// Throws as `check_hard_case_spec`, and std::runtime_error naming file and line for a bad file.
Cases make_cases(const HardCaseFamily& family, const HardCaseSpec& spec);

} // namespace boxwood
