#pragma once

// How every kernel is started: by nvcc on a device, by g++ on the host (on_host.h), from one source.
// A kernel is a `__global__ void` function of plain values and pointers; its grid is a line of blocks.

#if defined(__CUDACC__)
#include "trees/cuda/detail/stream.h"
#else
#include "trees/cuda/on_host.h"
#endif

#include <cstddef>
#include <cstdint>
