#pragma once

#include <cstdint>
#include <string>

namespace boxwood::bench {

/// The parts of a cell's name
/// `<scene>/n<items>-s<seed>/<task>/<contender>/<precision>/<executor>-<threads>`, and `/<isa>` for
/// a cell that is held to an instruction set.
/// Each part is of [a-z0-9_]+; a contender is such parts joined by dots.
struct CellName {
    std::string scene;
    std::uint64_t n_items = 0, seed = 0;
    std::string task, contender, precision, executor;
    unsigned threads = 1;
    std::string isa{};
};

/// Throws std::invalid_argument naming the part that is not made of [a-z0-9_]+.
std::string format_cell_name(const CellName& name);

} // namespace boxwood::bench
