#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace boxwood::bench {

/// A regular expression searched for in names: the value of --only.
class Pattern {
  public:
    /// Throws BadInput, naming --only, if the text is no regular expression.
    explicit Pattern(const std::string& text);

    bool is_in(std::string_view name) const;

  private:
    struct Compiled; // <regex> is the slowest of all headers to compile
    std::shared_ptr<const Compiled> compiled_;
};

} // namespace boxwood::bench
