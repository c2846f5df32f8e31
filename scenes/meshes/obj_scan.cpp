#include "scenes/meshes/mesh_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <vector>

namespace boxwood {
namespace {

struct Token {
    std::string_view text;
    std::size_t line;
};

/// The next statement's words, without its comment. A line that ends in '\' goes on in the next
/// one.
void take_statement(std::string_view& text, std::size_t& line, std::vector<Token>& words) {
    words.clear();
    for (bool continued = true; continued && !text.empty();) {
        std::string_view rest = take_line(text);
        ++line;
        rest = rest.substr(0, rest.find('#'));
        continued = rest.ends_with('\\');
        if (continued)
            rest.remove_suffix(1);
        for (std::string_view word; !(word = take_token(rest)).empty();)
            words.push_back({word, line});
    }
}

/// The vertex of a face's corner, counted from 1: "7", "7/1", "7//3", "7/1/3", or negative, counted
/// back from the last vertex before it. Corners of one face may differ in form, and a number may be
/// left out after a slash ("7/"), as some programs write: vertices alone are read.
std::int64_t vertex_of(Token corner, std::int64_t n_vertices) {
    const auto& [text, line] = corner;
    const std::string_view digits = text.substr(0, text.find('/'));
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(digits.begin(), digits.end(), index);
    const bool is_corner = text.find_first_not_of("-0123456789/") == std::string_view::npos &&
                           std::ranges::count(text, '/') <= 2;
    if (digits.empty() || error != std::errc{} || end != digits.end() || !is_corner)
        throw MeshError(fmt::format("line {}: '{}' is not a vertex index", line, text));
    if (index == 0)
        throw MeshError(fmt::format("line {}: vertex index 0; OBJ counts from 1", line));
    if (index < -n_vertices)
        throw MeshError(fmt::format("line {}: vertex index {} is out of range; {} vertices come "
                                    "before it",
                                    line, index, n_vertices));
    return index > 0 ? index : n_vertices + index + 1;
}

} // namespace

std::string scan_obj(std::string_view text, NotFinite not_finite) {
    PlyMesh mesh;
    std::vector<std::int64_t> corners;
    std::vector<Token> words;
    std::int64_t n_vertices = 0;
    std::int64_t farthest = 0; // an index may refer to a vertex that comes later
    std::size_t farthest_line = 0;
    if (constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
        text.starts_with(byte_order_mark))
        text.remove_prefix(byte_order_mark.size());
    for (std::size_t line = 0; !text.empty();) {
        take_statement(text, line, words);
        if (words.empty())
            continue;
        if (words[0].text == "v") {
            if (words.size() < 4)
                throw MeshError(
                    fmt::format("line {}: a vertex needs three coordinates, here are {}", line,
                                words.size() - 1));
            std::array<float, 3> point;
            for (std::size_t k = 0; k < 3; ++k)
                point[k] = coordinate(words[k + 1].text, words[k + 1].line, not_finite);
            mesh.add_vertex(point);
            ++n_vertices;
        } else if (words[0].text == "f") {
            corners.clear();
            for (std::size_t k = 1; k < words.size(); ++k) {
                const std::int64_t number = vertex_of(words[k], n_vertices);
                if (number > farthest) {
                    farthest = number;
                    farthest_line = words[k].line;
                }
                corners.push_back(number - 1);
            }
            mesh.add_face(corners);
        }
    }
    if (farthest > n_vertices)
        throw MeshError(fmt::format("line {}: vertex index {} is out of range; the file has {} "
                                    "vertices",
                                    farthest_line, farthest, n_vertices));
    return mesh.bytes();
}

} // namespace boxwood
