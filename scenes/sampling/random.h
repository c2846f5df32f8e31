#pragma once

#include "kernels/arithmetic/on_both.h"
#include "kernels/primitives/vec3.h"

#if defined(__CUDACC__)
#define R123_CUDA_DEVICE BOXWOOD_BOTH // its own word leaves out the host
#endif
#include <Random123/philox.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace boxwood {

/// The random numbers of one item, drawn one after another. Only + - * / and sqrt, which IEEE 754
/// rounds the same way everywhere, so that every machine draws the same bits.
/// Arguments of a call are evaluated in no fixed order: draw into named values or braces.
class Draws {
  public:
    BOXWOOD_BOTH Draws(r123::Philox4x32::key_type key, std::uint32_t stream, std::uint64_t item)
        : key_(key), counter_{{static_cast<std::uint32_t>(item),
                               static_cast<std::uint32_t>(item >> 32), 0, stream}} {}

    BOXWOOD_BOTH std::uint32_t word() {
        if (used_ == 4) {
            block_ = r123::Philox4x32()(counter_, key_);
            ++counter_[2];
            used_ = 0;
        }
        return block_[used_++];
    }

    /// Uniform in [0, 1): a multiple of 2^-53.
    BOXWOOD_BOTH double uniform() {
        const std::uint64_t high = word();
        return static_cast<double>((high << 32 | word()) >> 11) * 0x1p-53;
    }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }

    /// Uniform in the unit cube.
    BOXWOOD_BOTH Vec3<double> in_cube() { return {uniform(), uniform(), uniform()}; }

    /// Uniform in the unit ball less a pinhole at its centre (radius 2^-10), by rejection from the
    /// cube around it: about two tries a point.
    BOXWOOD_BOTH Vec3<double> in_ball() {
        for (;;) {
            const Vec3<double> p = 2.0 * in_cube() - Vec3<double>{1, 1, 1};
            const double square = dot(p, p);
            if (square <= 1 && square >= 0x1p-20)
                return p;
        }
    }

    /// A direction, uniform on the unit sphere; of length 1 up to rounding.
    Vec3<double> unit_vector() {
        const Vec3<double> p = in_ball();
        return p * (1 / length(p));
    }

  private:
    r123::Philox4x32::key_type key_;
    r123::Philox4x32::ctr_type counter_; ///< item (two words), block, stream
    r123::Philox4x32::ctr_type block_{};
    std::size_t used_ = 4;
};

/// Counter-based random numbers: what `item(i)` draws depends on the seed, the stream and i alone,
/// not on n and not on the order of the calls.
/// Source: Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3" (Philox4x32-10).
class Random {
  public:
    Random(std::uint64_t seed, std::uint32_t stream)
        : key_{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}},
          stream_(stream) {}
    /// A stream by its name, so that each use of a seed names its own.
    Random(std::uint64_t seed, std::string_view stream) : Random(seed, stream_of(stream)) {}

    BOXWOOD_BOTH Draws item(std::uint64_t i) const { return {key_, stream_, i}; }

    /// FNV-1a, 32 bits.
    static constexpr std::uint32_t stream_of(std::string_view word) {
        std::uint32_t hash = 0x811c9dc5u;
        for (const char c : word)
            hash = (hash ^ static_cast<unsigned char>(c)) * 0x01000193u;
        return hash;
    }

  private:
    r123::Philox4x32::key_type key_;
    std::uint32_t stream_;
};

} // namespace boxwood
