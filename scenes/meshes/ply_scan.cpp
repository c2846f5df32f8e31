#include "scenes/meshes/mesh_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <vector>

namespace boxwood {
namespace {

enum class Kind : std::uint8_t { integer, natural, real };
struct Type {
    std::string_view name;
    std::size_t size; ///< bytes
    Kind kind;
};
constexpr std::array types{Type{"char", 1, Kind::integer},   Type{"int8", 1, Kind::integer},
                           Type{"uchar", 1, Kind::natural},  Type{"uint8", 1, Kind::natural},
                           Type{"short", 2, Kind::integer},  Type{"int16", 2, Kind::integer},
                           Type{"ushort", 2, Kind::natural}, Type{"uint16", 2, Kind::natural},
                           Type{"int", 4, Kind::integer},    Type{"int32", 4, Kind::integer},
                           Type{"uint", 4, Kind::natural},   Type{"uint32", 4, Kind::natural},
                           Type{"float", 4, Kind::real},     Type{"float32", 4, Kind::real},
                           Type{"double", 8, Kind::real},    Type{"float64", 8, Kind::real}};

const Type* type_named(std::string_view name, std::size_t line) {
    const auto found = std::ranges::find(types, name, &Type::name);
    if (found == types.end())
        throw MeshError(fmt::format("line {}: '{}' is not a PLY type", line, name));
    return &*found;
}

struct Property {
    std::string_view name;
    const Type *length, *value; ///< length: of a list, null for a scalar
};
struct Element {
    std::string_view name;
    std::uint64_t count = 0;
    std::vector<Property> properties{};

    const Property* find(std::string_view property) const {
        const auto found = std::ranges::find(properties, property, &Property::name);
        return found == properties.end() ? nullptr : &*found;
    }
};
struct Header {
    std::string_view format;
    std::vector<Element> elements;
    std::size_t n_lines = 0;
};

template <class T> T number(std::string_view token, std::string_view place) {
    T value = 0;
    const auto [end, error] = std::from_chars(token.begin(), token.end(), value);
    if (token.empty() || error != std::errc{} || end != token.end())
        throw MeshError(fmt::format("{}: '{}' is not a count or an index", place, token));
    return value;
}

void check_vertex(const Element& vertex) {
    for (const std::string_view axis : {"x", "y", "z"}) {
        const Property* property = vertex.find(axis);
        if (!property || property->length)
            throw MeshError(fmt::format("the element vertex has no property '{}' of one number; it "
                                        "needs x, y and z",
                                        axis));
    }
}

/// Takes the header off the front. Elements without properties have no data: they count as none.
Header take_header(std::string_view& bytes) {
    Header header;
    while (!bytes.empty()) {
        std::string_view rest = take_line(bytes);
        const std::size_t line = ++header.n_lines;
        const std::string_view word = take_token(rest);
        if (word == "end_header") {
            std::erase_if(header.elements, [](const Element& e) { return e.properties.empty(); });
            return header;
        }
        if (word == "format") {
            header.format = take_token(rest);
            if (const std::string_view version = take_token(rest); version != "1.0")
                throw MeshError(fmt::format("line {}: PLY version '{}' is not 1.0", line, version));
        } else if (word == "element") {
            const std::string_view name = take_token(rest);
            if (std::ranges::find(header.elements, name, &Element::name) != header.elements.end())
                throw MeshError(fmt::format("line {}: a second element '{}'", line, name));
            header.elements.push_back(
                {name, number<std::uint64_t>(take_token(rest), fmt::format("line {}", line))});
        } else if (word == "property") {
            if (header.elements.empty())
                throw MeshError(fmt::format("line {}: a property before any element", line));
            const std::string_view type = take_token(rest);
            const bool is_list = type == "list";
            const Type* length = is_list ? type_named(take_token(rest), line) : nullptr;
            const Type* value = type_named(is_list ? take_token(rest) : type, line);
            Element& element = header.elements.back();
            const std::string_view name = take_token(rest);
            if (element.find(name))
                throw MeshError(fmt::format("line {}: a second property '{}' of element '{}'", line,
                                            name, element.name));
            element.properties.push_back({name, length, value});
        } else if (!bytes.empty() && word != "ply" && word != "comment" && word != "obj_info") {
            throw MeshError(fmt::format("line {}: '{}' is no word of a PLY header", line, word));
        }
    }
    throw MeshError("truncated PLY: the header does not end with 'end_header'");
}

/// The values after a header, one after another. As text one element stands on one line.
class Body {
  public:
    Body(std::string_view bytes, const Header& header, NotFinite not_finite)
        : bytes_(bytes), not_finite_(not_finite), is_text_(header.format == "ascii"),
          is_big_(header.format == "binary_big_endian"), line_(header.n_lines) {
        if (!is_text_ && !is_big_ && header.format != "binary_little_endian")
            throw MeshError(fmt::format("'{}' is not a PLY format", header.format));
    }

    void start(const Element& element, std::uint64_t i) {
        element_ = &element;
        i_ = i;
        if (!is_text_)
            return;
        if (bytes_.empty())
            throw_truncated();
        text_ = take_line(bytes_);
        ++line_;
    }

    /// Blanks may follow what the header announces.
    void end() const {
        if (bytes_.find_first_not_of(" \t\r\v\f\n") != bytes_.npos)
            throw MeshError(
                fmt::format("{} bytes follow the last element that the header has", bytes_.size()));
    }

    void skip(const Type& type) { take(type); }
    float coordinate(const Type& type) {
        const std::string_view raw = take(type);
        if (is_text_)
            return boxwood::coordinate(raw, line_, not_finite_);
        const auto x = static_cast<float>(value(raw, type));
        if (!std::isfinite(x) && not_finite_ == NotFinite::refuse)
            throw MeshError(fmt::format("{}: the coordinate {} is not a finite float", place(), x));
        return x;
    }
    std::int64_t integer(const Type& type) {
        const std::string_view raw = take(type);
        if (is_text_)
            return number<std::int64_t>(raw, place());
        const double x = value(raw, type);
        if (!(std::abs(x) < 0x1p53 && x == std::floor(x)))
            throw MeshError(fmt::format("{}: {} is not a count or an index", place(), x));
        return static_cast<std::int64_t>(x);
    }

    std::string place() const {
        return is_text_ ? fmt::format("line {}", line_) : fmt::format("{} {}", element_->name, i_);
    }

  private:
    [[noreturn]] void throw_truncated() const {
        throw MeshError(fmt::format("truncated PLY: {} of {} elements '{}' are there", i_,
                                    element_->count, element_->name));
    }

    /// The next value's token or bytes.
    std::string_view take(const Type& type) {
        if (is_text_) {
            const std::string_view token = take_token(text_);
            if (token.empty())
                throw MeshError(
                    fmt::format("line {}: {} {} ends too soon", line_, element_->name, i_));
            return token;
        }
        if (bytes_.size() < type.size)
            throw_truncated();
        const std::string_view raw = bytes_.substr(0, type.size);
        bytes_.remove_prefix(type.size);
        return raw;
    }

    double value(std::string_view raw, const Type& type) const {
        std::uint64_t bits = 0; // at the top
        for (std::size_t k = 0; k < type.size; ++k) {
            const auto byte = static_cast<unsigned char>(raw[is_big_ ? k : type.size - 1 - k]);
            bits |= std::uint64_t{byte} << (56 - 8 * k);
        }
        const auto unused = 64 - 8 * static_cast<int>(type.size);
        switch (type.kind) {
        case Kind::integer:
            return static_cast<double>(static_cast<std::int64_t>(bits) >> unused);
        case Kind::natural:
            return static_cast<double>(bits >> unused);
        case Kind::real:
            break;
        }
        return unused == 0 ? std::bit_cast<double>(bits)
                           : static_cast<double>(
                                 std::bit_cast<float>(static_cast<std::uint32_t>(bits >> 32)));
    }

    std::string_view bytes_, text_; ///< text_: the line's rest
    NotFinite not_finite_;
    bool is_text_, is_big_;
    std::size_t line_;
    const Element* element_ = nullptr;
    std::uint64_t i_ = 0;
};

/// A strip's corners as triangles, all wound alike; -1 begins another one.
void add_strip(PlyMesh& mesh, std::span<const std::int64_t> corners) {
    for (auto end = corners.begin(); end != corners.end();) {
        const auto begin = end;
        end = std::find(begin, corners.end(), -1);
        for (auto c = begin; end - c >= 3; ++c) {
            const bool is_odd = (c - begin) % 2 != 0;
            mesh.add_face(std::array{c[is_odd], c[!is_odd], c[2]});
        }
        end += end != corners.end();
    }
}

} // namespace

std::string scan_ply(std::string_view bytes, NotFinite not_finite) {
    const Header header = take_header(bytes);
    std::uint64_t n_vertices = 0; // faces may come first
    for (const Element& element : header.elements)
        if (element.name == "vertex") {
            check_vertex(element);
            n_vertices = element.count;
        }
    Body body(bytes, header, not_finite);
    PlyMesh mesh;
    std::vector<std::int64_t> corners;
    constexpr std::string_view axes = "xyz";
    for (const Element& element : header.elements) {
        const bool is_vertex = element.name == "vertex", is_strip = element.name == "tristrips";
        for (std::uint64_t i = 0; i < element.count; ++i) {
            body.start(element, i);
            std::array<float, 3> point{};
            for (const auto& [name, length, value] : element.properties) {
                if (!length) {
                    const std::size_t axis = name.size() == 1 ? axes.find(name) : axes.npos;
                    if (is_vertex && axis != axes.npos)
                        point[axis] = body.coordinate(*value);
                    else
                        body.skip(*value);
                    continue;
                }
                const bool is_face =
                    (element.name == "face" || is_strip) && name.starts_with("vertex_ind");
                corners.clear();
                const std::int64_t n = body.integer(*length);
                if (n < 0)
                    throw MeshError(fmt::format("{}: a list of {} values", body.place(), n));
                for (std::int64_t k = 0; k < n; ++k) {
                    if (!is_face) {
                        body.skip(*value);
                        continue;
                    }
                    const std::int64_t index = corners.emplace_back(body.integer(*value));
                    if ((index < 0 && !(is_strip && index == -1)) ||
                        (index >= 0 && static_cast<std::uint64_t>(index) >= n_vertices))
                        throw MeshError(
                            fmt::format("{}: vertex index {} is out of range; the file has {} "
                                        "vertices (counted from 0)",
                                        body.place(), index, n_vertices));
                }
                if (is_strip)
                    add_strip(mesh, corners);
                else
                    mesh.add_face(corners);
            }
            if (is_vertex)
                mesh.add_vertex(point);
        }
    }
    body.end();
    return mesh.bytes();
}

} // namespace boxwood
