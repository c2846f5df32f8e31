#pragma once

#include "trees/tree.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace boxwood {

/// Whether the box is the empty one: its item is absent from this frame.
inline bool is_absent(const Box& box) { return box == Box{}; }

/// Throws InvalidBox for the first box that is neither valid nor absent, and std::length_error as
/// `require_valid`.
void require_present_or_absent(Boxes boxes);
/// Throws the same for one item.
void require_present_or_absent(std::uint32_t item, const Box& box);

/// Whether these are the items 0, 1, 2 ...
bool are_all(std::span<const std::uint32_t> items);

/// The most that a face of the box moved: 0 only if the boxes are the same, +inf if one of them is
/// absent and the other is not. Rounded: at most 2^-23 of it, and FLT_MIN, too small.
float box_step(const Box& now, const Box& before);

/// Boxes are followed sixteen at a time.
inline constexpr std::size_t follow_block = 16;

/// Takes the boxes of the blocks [begin, end) over to `kept`, all of a block if none of its boxes
/// went farther than `most`, else none. The largest step of block b goes to steps[b]; the numbers
/// of the blocks not taken over go to `far`. Returns how many these are.
std::size_t follow_blocks(Boxes now, Box* kept, std::size_t begin, std::size_t end, float most,
                          float* steps, std::uint32_t* far);

} // namespace boxwood
