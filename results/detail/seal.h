#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace boxwood::results::detail {

/// Sixteen bytes behind the end of the HDF5 data, where HDF5 does not look: a mark, and FNV-1a of
/// all before it. HDF5 leaves its heaps (texts) unguarded and may crash on a damaged one, so a
/// reader looks at the seal first. A program that changes the file in place drops the seal, which
/// is how a reader knows.
class Seal {
  public:
    void add(std::span<const std::byte> bytes);
    std::array<std::byte, 16> bytes() const;

  private:
    std::uint64_t hash_ = 0xcbf29ce484222325;
};

enum class SealState : std::uint8_t { fits, absent, broken };

/// Whether the file has a seal that fits its content. Throws std::system_error if the file cannot
/// be read.
SealState state_of_seal(const std::filesystem::path& file);

} // namespace boxwood::results::detail
