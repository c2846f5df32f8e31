#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace boxwood {

/// Strings put together at compile time, for the names of kernels that are templates.
template <const std::string_view&... parts> struct Concatenated {
  private:
    static constexpr auto chars = [] {
        std::array<char, (parts.size() + ...)> all{};
        auto out = all.begin();
        ((out = std::copy(parts.begin(), parts.end(), out)), ...);
        return all;
    }();

  public:
    static constexpr std::string_view value{chars.data(), chars.size()};
};

} // namespace boxwood
