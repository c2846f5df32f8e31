#include "scenes/meshes/mesh_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

namespace boxwood {
namespace {

struct Property {
    std::string_view name;
    std::size_t count_size = 0; ///< bytes of a list's length, 0 for a scalar
    std::size_t size = 0;       ///< bytes of a value
};
struct Element {
    std::string_view name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};
struct Header {
    std::string_view format;
    std::vector<Element> elements;
    std::size_t n_lines = 0;

    std::uint64_t n_vertices() const {
        for (const Element& element : elements)
            if (element.name == "vertex")
                return element.count;
        return 0;
    }
};

std::uint64_t number(std::string_view token, std::size_t line) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(token.begin(), token.end(), value);
    if (token.empty() || error != std::errc{} || end != token.end())
        throw MeshError(fmt::format("line {}: '{}' is not a count or an index", line, token));
    return value;
}

std::size_t type_size(std::string_view type, std::size_t line) {
    struct Type {
        std::string_view name;
        std::size_t size;
    };
    static constexpr std::array types{
        Type{"char", 1},  Type{"uchar", 1},   Type{"int8", 1},   Type{"uint8", 1},
        Type{"short", 2}, Type{"ushort", 2},  Type{"int16", 2},  Type{"uint16", 2},
        Type{"int", 4},   Type{"uint", 4},    Type{"int32", 4},  Type{"uint32", 4},
        Type{"float", 4}, Type{"float32", 4}, Type{"double", 8}, Type{"float64", 8}};
    for (const auto& [name, size] : types)
        if (name == type)
            return size;
    throw MeshError(fmt::format("line {}: '{}' is not a PLY type", line, type));
}

/// Takes the header off the front.
Header take_header(std::string_view& bytes) {
    Header header;
    while (!bytes.empty()) {
        std::string_view rest = take_line(bytes);
        const std::size_t line = ++header.n_lines;
        const std::string_view whole = rest, word = take_token(rest);
        // A control character parts words here, but not for assimp, which then reads on for ever.
        if (word != "comment" && word != "obj_info" &&
            std::ranges::any_of(whole, [](char c) { return c != '\t' && (c < ' ' || c > '~'); }))
            throw MeshError(fmt::format("line {}: a PLY header is of printable ASCII", line));
        if (word == "end_header") {
            if (whole != word)
                throw MeshError(fmt::format("line {}: more than 'end_header'", line));
            // Without bytes of its own no end of the file would stop a count of 2^64.
            for (const Element& element : header.elements)
                if (element.count > 0 && element.properties.empty())
                    throw MeshError(fmt::format("the {} elements '{}' have no properties",
                                                element.count, element.name));
            return header;
        }
        if (word == "format") {
            header.format = take_token(rest);
        } else if (word == "element") {
            const std::string_view name = take_token(rest);
            header.elements.push_back({name, number(take_token(rest), line), {}});
        } else if (word == "property") {
            if (header.elements.empty())
                throw MeshError(fmt::format("line {}: a property before any element", line));
            Property property;
            std::string_view type = take_token(rest);
            if (type == "list") {
                property.count_size = type_size(take_token(rest), line);
                type = take_token(rest);
            }
            property.size = type_size(type, line);
            property.name = take_token(rest);
            header.elements.back().properties.push_back(property);
        } else if (!bytes.empty() && word != "ply" && word != "comment" && word != "obj_info") {
            throw MeshError(fmt::format("line {}: '{}' is no word of a PLY header", line, word));
        }
    }
    throw MeshError("truncated PLY: the header does not end with 'end_header'");
}

[[noreturn]] void throw_truncated(const Element& element, std::uint64_t found) {
    throw MeshError(fmt::format("truncated PLY: {} of {} elements '{}' are there", found,
                                element.count, element.name));
}

/// One element stands on one line.
void scan_text(std::string_view body, const Header& header) {
    std::size_t line = header.n_lines;
    for (const Element& element : header.elements)
        for (std::uint64_t i = 0; i < element.count; ++i) {
            if (body.empty())
                throw_truncated(element, i);
            std::string_view rest = take_line(body);
            ++line;
            for (const Property& property : element.properties) {
                const std::string_view token = take_token(rest);
                if (token.empty())
                    throw MeshError(fmt::format("line {}: {} {} ends before its property '{}'",
                                                line, element.name, i, property.name));
                const bool is_coordinate =
                    property.name == "x" || property.name == "y" || property.name == "z";
                if (element.name == "vertex" && is_coordinate)
                    coordinate(token, line);
                if (property.count_size == 0)
                    continue;
                for (std::uint64_t n = number(token, line); n > 0; --n) {
                    const std::string_view value = take_token(rest);
                    if (value.empty())
                        throw MeshError(fmt::format("line {}: the list '{}' of {} {} is too short",
                                                    line, property.name, element.name, i));
                    const bool corner =
                        element.name == "face" && property.name.starts_with("vertex_ind");
                    if (corner &&
                        (value.starts_with('-') || number(value, line) >= header.n_vertices()))
                        throw MeshError(
                            fmt::format("line {}: vertex index {} is out of range; the file has {} "
                                        "vertices (counted from 0)",
                                        line, value, header.n_vertices()));
                }
            }
        }
}

/// Goes over the bytes: only the lengths of lists are read.
void scan_binary(std::string_view body, const Header& header) {
    const bool big_endian = header.format == "binary_big_endian";
    const auto length = [&](std::size_t size) {
        std::uint64_t value = 0;
        for (std::size_t k = 0; k < size; ++k)
            value = value << 8 | static_cast<unsigned char>(body[big_endian ? k : size - 1 - k]);
        return value;
    };
    for (const Element& element : header.elements)
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (const auto& [name, count_size, size] : element.properties) {
                if (body.size() < count_size)
                    throw_truncated(element, i);
                const std::uint64_t n = count_size > 0 ? length(count_size) : 1;
                if ((body.size() - count_size) / size < n)
                    throw_truncated(element, i);
                body.remove_prefix(count_size + n * size);
            }
}

} // namespace

void scan_ply(std::string_view bytes) {
    const Header header = take_header(bytes);
    if (header.format == "ascii")
        scan_text(bytes, header);
    else if (header.format == "binary_little_endian" || header.format == "binary_big_endian")
        scan_binary(bytes, header);
    else
        throw MeshError(fmt::format("'{}' is not a PLY format", header.format));
}

} // namespace boxwood
