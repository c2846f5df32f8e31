#pragma once

#include <string>
#include <vector>

/// The classes of contenders of points and regions: one query in a call, answered before the next;
/// or a batch that is known as a whole, and may be put in order.
namespace boxwood::bench::point_class {

inline const std::string single = "one query a call", batches = "batches";

/// Of a peer that takes one after another as they are given.
inline std::vector<std::string> of_single_calls() { return {single, batches}; }

} // namespace boxwood::bench::point_class
