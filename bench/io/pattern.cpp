#include "bench/io/pattern.h"
#include "bench/io/bad_input.h"

#include <fmt/format.h>

#include <regex>

namespace boxwood::bench {

struct Pattern::Compiled {
    std::regex regex;
};

Pattern::Pattern(const std::string& text) {
    try {
        compiled_ = std::make_shared<const Compiled>(Compiled{std::regex(text)});
    } catch (const std::regex_error& error) {
        throw BadInput(
            fmt::format("--only \"{}\" is not a regular expression: {}", text, error.what()));
    }
}

bool Pattern::is_in(std::string_view name) const {
    return std::regex_search(name.begin(), name.end(), compiled_->regex);
}

} // namespace boxwood::bench
