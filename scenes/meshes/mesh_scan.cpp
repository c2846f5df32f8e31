#include "scenes/meshes/mesh_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace boxwood {

float coordinate(std::string_view token, std::size_t line, NotFinite not_finite) {
    std::string_view digits = token;
    if (digits.starts_with('+') && !digits.starts_with("+-"))
        digits.remove_prefix(1);
    float value = 0;
    const auto [end, error] = std::from_chars(digits.begin(), digits.end(), value);
    if (digits.empty() || error == std::errc::invalid_argument || end != digits.end())
        throw MeshError(fmt::format("line {}: '{}' is not a number", line, token));
    // Out of range is above the largest float, or below the smallest, which rounds to 0.
    const bool tiny = error == std::errc::result_out_of_range &&
                      std::abs(std::strtod(std::string(digits).c_str(), nullptr)) < 1;
    if (tiny)
        return 0;
    if (error == std::errc{} && std::isfinite(value))
        return value;
    if (not_finite == NotFinite::refuse)
        throw MeshError(
            fmt::format("line {}: the coordinate '{}' is not a finite float", line, token));
    return std::isnan(value) ? value : std::numeric_limits<float>::infinity();
}

/// assimp skips line ends between the header and the first byte, so that is none.
constexpr char mark = 'v';

void PlyMesh::add_vertex(const std::array<float, 3>& point) {
    vertices_ += mark;
    vertices_.append(reinterpret_cast<const char*>(point.data()), sizeof point);
}

void PlyMesh::add_face(std::span<const std::int64_t> corners) {
    if (corners.size() < 3)
        return;
    ++n_faces_;
    const auto put = [&](std::uint32_t value) {
        faces_.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    put(static_cast<std::uint32_t>(corners.size()));
    for (const std::int64_t corner : corners)
        put(static_cast<std::uint32_t>(corner));
}

std::string PlyMesh::bytes() const {
    static_assert(std::endian::native == std::endian::little);
    if (n_faces_ == 0)
        throw MeshError("holds no triangles");
    return fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
                       "property uchar mark\nproperty float x\nproperty float y\n"
                       "property float z\nelement face {}\n"
                       "property list uint uint vertex_indices\nend_header\n{}{}",
                       vertices_.size() / (1 + sizeof(std::array<float, 3>)), n_faces_, vertices_,
                       faces_);
}

std::string_view take_token(std::string_view& text) {
    constexpr std::string_view blanks = " \t\r\v\f";
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    const std::string_view token = text.substr(0, text.find_first_of(blanks));
    text.remove_prefix(token.size());
    return token;
}

std::string_view take_line(std::string_view& text) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    if (line.ends_with('\r'))
        line.remove_suffix(1);
    return line;
}

} // namespace boxwood
