#pragma once

#include "results/results.h"

#include <string>
#include <vector>

namespace boxwood::bench {

/// What a run found, in words, losses first: for each scene, task, number of threads and class our
/// best against the best rival (a peer, or our reference where there is none), by build and query
/// together and by the query alone; for each family of kernels and panel the cheapest that is never
/// wrong; for each scene that is played, what a frame takes and what all stages would; for each
/// scene and task on a device, from which size on it wins against our fastest of 1, 2 and all
/// threads. A headline stands for its question: the largest size, and of several numbers of threads
/// the worst for us. Empty for a run that is too noisy. Needs all other derived tables.
std::vector<results::Finding> findings_of(const results::Results& results);

/// What the topics and the columns of their rows are called, in the order of a screen.
std::vector<results::TopicRow> topics();

} // namespace boxwood::bench
