#include "results/detail/seal.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

namespace boxwood::results::detail {
namespace {

constexpr std::string_view mark = "boxwseal";

} // namespace

void Seal::add(std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes)
        hash_ = (hash_ ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3;
}

std::array<std::byte, 16> Seal::bytes() const {
    std::array<std::byte, 16> all;
    std::memcpy(all.data(), mark.data(), mark.size());
    for (std::size_t i = 0; i < 8; ++i)
        all[8 + i] = static_cast<std::byte>(hash_ >> (8 * i));
    return all;
}

SealState state_of_seal(const std::filesystem::path& file) {
    Seal seal;
    std::array<std::byte, 16> found{};
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw std::system_error(errno ? errno : EIO, std::generic_category());
    const auto read = [&](std::span<std::byte> to) {
        errno = 0;
        if (!in.read(reinterpret_cast<char*>(to.data()), static_cast<std::streamsize>(to.size())))
            throw std::system_error(errno ? errno : EIO, std::generic_category());
    };
    const std::uint64_t size = std::filesystem::file_size(file);
    if (size < found.size())
        return SealState::absent;
    std::array<std::byte, 1 << 16> block;
    for (std::uint64_t left = size - found.size(); left > 0;) {
        const auto part = std::span(block).first(std::min<std::uint64_t>(left, block.size()));
        read(part);
        seal.add(part);
        left -= part.size();
    }
    read(found);
    if (std::memcmp(found.data(), mark.data(), mark.size()) != 0)
        return SealState::absent;
    return found == seal.bytes() ? SealState::fits : SealState::broken;
}

} // namespace boxwood::results::detail
