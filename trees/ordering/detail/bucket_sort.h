#pragma once

#include "trees/executor.h"
#include "trees/function_ref.h"

#include <cstdint>
#include <span>

namespace boxwood::detail {

/// Codes of the items that follow `first`, as many as fit.
using CodesOfItems = FunctionRef<void(std::size_t first, std::span<std::uint32_t> codes)>;
/// Takes the records from slot `first` on, the code of each above its item; called for parts in any
/// order, perhaps at the same time. No run of one code lies in two parts. alike: how many of them
/// are in runs of more than eight that agree in all bits (in blocks: of those come across).
using PutRecords =
    FunctionRef<void(std::size_t first, std::span<const std::uint64_t> records, std::size_t alike)>;

/// How well a sort has to do.
enum class Sorted : std::uint8_t {
    exactly,  ///< by code, then by item
    in_blocks ///< items of less than a block of sixteen that are next to each other by code may
              ///< stand in any order, the same on every executor
};

/// Sorts n items by codes of `bits` bits (13 to 32). Returns the sum of all `alike`.
/// One pass shares the items out among at most a thousand parts of about equal size, then each part
/// is sorted where it lies, in the first or second level of cache. O(n) for any codes.
std::size_t bucket_sort(std::size_t n, int bits, CodesOfItems codes, Sorted how,
                        const Executor& executor, PutRecords put);

} // namespace boxwood::detail
