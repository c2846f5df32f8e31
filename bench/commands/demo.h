#pragma once

#include <string>

namespace boxwood::bench {

/// What `boxwood demo four-link` prints: the idea of a box tree, step by step, on a robot of four
/// links. Every number in it is computed as it is written.
std::string four_link_demo();

} // namespace boxwood::bench
