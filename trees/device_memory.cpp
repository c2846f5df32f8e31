#include "trees/device_memory.h"

#include <cstdio>

namespace boxwood {
namespace {

std::string in_gb(std::uint64_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g GB", static_cast<double>(bytes) * 1e-9);
    return text;
}

} // namespace

DeviceOutOfMemory::DeviceOutOfMemory(const std::string& what, std::uint64_t needed_,
                                     std::uint64_t free_)
    : DeviceError(what + " needs " + in_gb(needed_) + " of the device's memory, and " +
                  in_gb(free_) + " are free"),
      needed(needed_), free(free_) {}

void detail::require_as_many(std::size_t given, std::size_t there) {
    if (given != there)
        throw std::invalid_argument("DeviceArray::write of " + std::to_string(given) +
                                    " elements, where there are " + std::to_string(there));
}

} // namespace boxwood
