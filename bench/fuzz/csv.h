#pragma once

#include "bench/commands/queries/query.h"
#include "bench/fuzz/scratch_file.h"
#include "bench/io/bad_input.h"

#include <optional>
#include <sstream>
#include <utility>

namespace boxwood::fuzz {

inline bench::TreeChoice tree_of(std::string builder, std::string layout) {
    bench::TreeChoice choice;
    choice.builder = std::move(builder);
    choice.layout = std::move(layout);
    choice.executor = "serial";
    return choice;
}

/// What the command prints; nothing if it refuses its input.
template <class Query> std::optional<std::string> printed(const Query& query) {
    std::ostringstream out;
    try {
        bench::run(query, out);
    } catch (const bench::BadInput&) {
        return {};
    }
    return out.str();
}

} // namespace boxwood::fuzz
