#include "bench/commands/queries/bodies.h"

#include "bench/io/bad_input.h"
#include "kernels/suggest.h"
#include "scenes/meshes/mesh_file.h"
#include "scenes/text/csv.h"
#include "trees/world/box_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace boxwood::bench {
namespace {

/// The numbers of a primitive, all at least 0.
std::vector<double> numbers_of(const std::string& text, std::string_view numbers, std::size_t count,
                               std::string_view form) {
    std::vector<double> found;
    const auto take = [&](std::span<const double> row, std::size_t) {
        found.assign(row.begin(), row.end());
    };
    if (read_csv(numbers, text, {form, count, count}, take) != 1)
        throw BadInput(fmt::format("{}: it is {}", text, form));
    for (const double x : found)
        if (!(x >= 0 && x < 0x1p60))
            throw BadInput(
                fmt::format("{}: a length is {}; it must be at least 0 and finite", text, x));
    return found;
}

} // namespace

std::optional<convex::Shape> read_primitive(const std::string& text) {
    struct Kind {
        std::string_view name;
        std::size_t numbers;
        std::string_view form;
        convex::Shape (*make)(std::span<const double>);
    };
    static constexpr Kind kinds[] = {
        {"box", 3, "box:x,y,z, its full side lengths",
         [](std::span<const double> n) -> convex::Shape {
             return convex::Box{{n[0] / 2, n[1] / 2, n[2] / 2}};
         }},
        {"sphere", 1, "sphere:radius",
         [](std::span<const double> n) -> convex::Shape { return convex::Sphere{n[0]}; }},
        {"capsule", 2, "capsule:radius,length, the length without the round ends",
         [](std::span<const double> n) -> convex::Shape {
             return convex::Capsule{n[0], n[1] / 2};
         }},
        {"cylinder", 2, "cylinder:radius,length",
         [](std::span<const double> n) -> convex::Shape {
             return convex::Cylinder{n[0], n[1] / 2};
         }},
    };
    const std::size_t colon = text.find(':');
    const std::string_view name = std::string_view(text).substr(0, colon);
    const auto kind = std::ranges::find(kinds, name, &Kind::name);
    if (colon == std::string::npos)
        return std::nullopt;
    if (kind == std::ranges::end(kinds)) {
        const bool is_word = std::ranges::all_of(name, [](char c) { return c >= 'a' && c <= 'z'; });
        if (is_word && name.size() > 1 && !std::filesystem::exists(text))
            throw BadInput(fmt::format("{}: no such file, and {}", text,
                                       unknown_name("shape", name, names_of(kinds))));
        return std::nullopt;
    }
    return kind->make(
        numbers_of(text, std::string_view(text).substr(colon + 1), kind->numbers, kind->form));
}

TriangleMesh read_body(const std::string& body) {
    const std::optional<convex::Shape> primitive = read_primitive(body);
    if (!primitive)
        return load_mesh(body);
    if (const auto* box = primitive->get_if<convex::Box>())
        return box_mesh(2.0 * box->half);
    throw BadInput(fmt::format("{}: of primitives only boxes are meshes", body));
}

double rounding_of_mesh(const convex::Shape& shape) {
    const auto* box = shape.get_if<convex::Box>();
    return box ? length(Vec3<double>(Vec3<float>(box->half)) - box->half) * (1 + 0x1p-40) : 0;
}

Pose read_pose(const std::string& text, const std::string& option) {
    if (text.empty())
        return {};
    std::string row;
    for (const char c : text) {
        const bool parts = c == ' ' || c == ',' || c == '\t' || c == '\n';
        if (!parts)
            row += c;
        else if (!row.empty() && row.back() != ',')
            row += ',';
    }
    if (!row.empty() && row.back() == ',')
        row.pop_back();
    std::vector<double> matrix;
    const auto take_matrix = [&](std::span<const double> m, std::size_t) {
        matrix.assign(m.begin(), m.end());
    };
    if (read_csv(row, option, {"16 numbers, a 4 x 4 matrix row by row", 16, 16}, take_matrix) == 0)
        throw BadInput(option + " is empty; it takes 16 numbers, a 4 x 4 matrix row by row");
    try {
        return pose_of_matrix(std::span(matrix).first<16>());
    } catch (const std::invalid_argument& error) {
        throw BadInput(fmt::format("{}: {}", option, error.what()));
    }
}

} // namespace boxwood::bench
