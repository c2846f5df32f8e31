#pragma once

#include "bench/plan/block_reader.h"

#include <toml++/toml.h>

#include <memory>

namespace boxwood::bench {

/// A block within its file: a copy would lose the numbers of its lines.
struct BlockReader::Table {
    std::shared_ptr<const toml::table> file;
    const toml::table& toml;
};

} // namespace boxwood::bench
