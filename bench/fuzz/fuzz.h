#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

/// Entry points of the fuzzers: one file NAME.cpp and one row here each. libFuzzer calls them
/// (main.cpp, scripts/fuzz), and replay_test.cpp with the inputs of corpus/NAME/.
#define BOXWOOD_FUZZ_TARGETS(X)                                                                    \
    X(triangle_triangle)                                                                           \
    X(ray_triangle)                                                                                \
    X(vertex_face)                                                                                 \
    X(edge_edge)                                                                                   \
    X(box_trees)                                                                                   \
    X(mesh_obj)                                                                                    \
    X(mesh_ply)                                                                                    \
    X(mesh_stl)                                                                                    \
    X(scene_toml)                                                                                  \
    X(urdf)                                                                                        \
    X(srdf)                                                                                        \
    X(result_file)                                                                                 \
    X(box_csv)                                                                                     \
    X(ray_csv)                                                                                     \
    X(triangle_csv)                                                                                \
    X(ccd_file)                                                                                    \
    X(sweep_toml)

namespace boxwood::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// Takes any bytes. What it throws is a finding: input that is refused as promised is not.
#define BOXWOOD_FUZZ_TARGET(name) void name(Bytes bytes);
BOXWOOD_FUZZ_TARGETS(BOXWOOD_FUZZ_TARGET)
#undef BOXWOOD_FUZZ_TARGET

/// A wrong answer.
class Finding : public std::logic_error {
    using std::logic_error::logic_error;
};
inline void require(bool right, const std::string& what) {
    if (!right)
        throw Finding(what);
}

inline std::string_view text_of(Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Reads values off the front; zeros where the bytes are at an end.
class Reader {
  public:
    explicit Reader(Bytes bytes) : bytes_(bytes) {}
    bool at_end() const { return bytes_.empty(); }
    template <class T> T take() {
        std::array<std::uint8_t, sizeof(T)> raw{};
        const std::size_t n = bytes_.size() < sizeof(T) ? bytes_.size() : sizeof(T);
        if (n > 0)
            std::memcpy(raw.data(), bytes_.data(), n);
        bytes_ = bytes_.subspan(n);
        return std::bit_cast<T>(raw);
    }

  private:
    Bytes bytes_;
};

/// How coordinates stand in the bytes, as the first of them says: in full, or one byte each, so
/// that equal and collinear ones are common, some of them one rounding off.
class Coordinates {
  public:
    explicit Coordinates(Bytes bytes) : reader_(bytes), mode_(reader_.take<std::uint8_t>()) {}
    bool at_end() const { return reader_.at_end(); }
    template <class Real> Real next() {
        if (mode_ % 4 == 0)
            return reader_.take<Real>();
        const int byte = reader_.take<std::int8_t>();
        if (mode_ % 4 == 1)
            return static_cast<Real>(byte);
        using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
        const auto whole = static_cast<Real>(byte >> 3);
        const auto near = static_cast<Bits>(std::bit_cast<Bits>(whole) +
                                            static_cast<Bits>((byte & 7) - (mode_ % 4 == 2)));
        return byte % 8 == 0 ? whole : std::bit_cast<Real>(near);
    }

  private:
    Reader reader_;
    std::uint8_t mode_;
};

} // namespace boxwood::fuzz
